use super::sweeps::TestFlight;
use super::*;
use crate::library::dates::DateGrid;
use effects::ExtendedModel;
use effects::{EffectReferences, Effects};
use flight::Segment;
use flight::effect::EffectId;

use crate::advice::distances::squared;
use crate::hypotheses::design::Design;
use crate::residuals::reference::Reference;
use crate::residuals::segments::PreparedFlights;
use crate::signals::record::FlightRecord;
use crate::signals::references::references_of;
use crate::thresholds::{ADVISED_SEGMENTS, CONFUSED};

use test_support::fleet::{Background, Setup, exact_model, fly, isa};

/// Flights ready for advice; everything borrows, so it is handed on.
fn with<R>(
    model: &ExtendedModel,
    flights: &[Vec<Segment>],
    then: impl FnOnce(&WhitenedSystem<'_>, &EffectModel<'_>, &Library, &Distances) -> R,
) -> R {
    let records: Vec<FlightRecord<'_>> =
        flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    let references: EffectReferences = references_of(model, model.drag_table(), &records).unwrap();
    let effects = EffectModel::new(model, model.drag_table(), references).unwrap();
    let (data, library) = PreparedFlights::prepare(
        &effects,
        &records,
        Reference::Table,
        |points, engines, starts| {
            Library::new(&effects, points, engines, DateGrid::coarse(starts, &[], None), |_| true)
        },
    );
    let design = Design::new(&data, &references, None, None);
    let system = WhitenedSystem::new(&data, &design);
    let leading = library.effects.iter().map(|effect| effect.representative).collect();
    let distances = Distances::from_gram(system.gram(None), &design, leading).unwrap();
    then(&system, &effects, &library, &distances)
}

fn fleet(flights: usize) -> Vec<Vec<Segment>> {
    fly(11, &Setup { flights, ..Setup::default() }, &[], &Background::default()).flights
}

fn column(library: &Library, id: EffectId) -> usize {
    library.effects.iter().find(|effect| effect.id == id).unwrap().representative
}

#[test]
fn every_candidate_keeps_to_what_was_flown() {
    let model = exact_model();
    let flights = fleet(30);
    let means = || flights.iter().flatten().map(|segment| &segment.means);
    let range = |of: &dyn Fn(&flight::SegmentMeans) -> f64| {
        means().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    };
    with(&model, &flights, |system, effects, _, _| {
        let envelope = Envelope::from_flights(system.data, effects).unwrap();
        let candidates = test_flights(&envelope, effects);
        for kind in [None, Some(Kind::Mach), Some(Kind::Level)] {
            let is_of_kind = |flight: &TestFlight| flight.sweep.map(Kind::from) == kind;
            assert!(candidates.iter().any(is_of_kind), "{kind:?}");
        }
        let (_, fastest) = range(&|m| m.mach);
        let (lowest, highest) = range(&|m| m.pressure_altitude_m);
        let (lightest, heaviest) = range(&|m| m.mass_kg);
        // Lift coefficient by hand: m·g/(0.7·p·M²·S) with the fleet's own atmosphere and wing.
        let lift = |m: f64, h: f64, mach: f64| m * 9.80665 / (0.7 * isa(h).1 * mach * mach * 48.96);
        let (_, most_lift) = range(&|m| lift(m.mass_kg, m.pressure_altitude_m, m.mach));
        let pressure = |h: f64, mach: f64| isa(h).1 * mach * mach;
        let (_, most_pressure) = range(&|m| pressure(m.pressure_altitude_m, m.mach));
        for flight in &candidates {
            assert_eq!(flight.points.len(), ADVISED_SEGMENTS, "{:?}", flight.sweep);
            for p in &flight.points {
                let response = effects.response(p, &Effects::none()).unwrap();
                assert!(response.net_thrust_n > 0.0);
                assert!(p.mach <= fastest && p.mach >= 0.50, "{:?}", flight.sweep);
                assert!(
                    p.pressure_altitude_m >= lowest - 30.5
                        && p.pressure_altitude_m <= highest + 30.5
                );
                assert!(p.mass_kg >= lightest && p.mass_kg <= heaviest, "{:?}", flight.sweep);
                let cl = lift(p.mass_kg, p.pressure_altitude_m, p.mach);
                assert!(cl <= 1.0001 * most_lift, "{:?} {cl}", flight.sweep);
                assert!(pressure(p.pressure_altitude_m, p.mach) <= 1.0001 * most_pressure);
            }
        }
    });
}

/// A planned flight that is a flight of the data, in every condition, has the rows that the flight has: signatures, noise,
/// nuisance, whitening. Only flow shares and residuals differ, and no effect of this test looks at shares.
#[test]
fn a_planned_flight_has_the_rows_of_a_flown_one() {
    let model = exact_model();
    let flights = fleet(12);
    with(&model, &flights, |system, effects, library, _| {
        let data = system.data;
        let columns = [EffectId::ZeroLiftDrag, EffectId::MachBias, EffectId::TsfcMachExponent]
            .map(|id| column(library, id));
        let few = Library {
            effects: library.effects.clone(),
            columns: columns.iter().map(|&at| library.columns[at]).collect(),
            dates: library.dates.clone(),
            not_testable: vec![],
            heating_value: false,
            spikes: library.spikes,
            agnostic_spikes: library.agnostic_spikes,
            spikes_of_right_table: library.spikes_of_right_table,
        };
        let flown = &data.flights[3];
        let points: Vec<_> =
            data.segments[flown.segments.clone()].iter().map(|row| row.point).collect();
        let recorded = envelope::Envelope::from_flights(data, effects).unwrap().recorded;
        let planned = data.planned(effects, &few, &points, recorded).unwrap();
        let design = system.design.of_nuisance(columns.len());
        let rows = design.whitened(&planned, &planned.flights[0]);
        let expected = system.design.whitened(data, flown);
        assert_eq!(rows.nrows(), expected.nrows());
        for row in 0..rows.nrows() {
            for (k, &column) in columns.iter().enumerate() {
                let (found, known) = (rows[(row, k)], expected[(row, column)]);
                assert!((found - known).abs() <= 1e-9 * known.abs().max(1.0), "{found} {known}");
            }
            for (k, column) in system.design.nuisance.clone().enumerate() {
                let (found, known) = (rows[(row, columns.len() + k)], expected[(row, column)]);
                assert!((found - known).abs() <= 1e-9 * known.abs().max(1.0), "{found} {known}");
            }
        }
    });
}

/// More flights of any sort never tell less, and neither do ordinary ones.
#[test]
fn flights_never_tell_less() {
    let model = exact_model();
    let flights = fleet(20);
    with(&model, &flights, |system, effects, library, distances| {
        let columns: Vec<usize> = library.effects.iter().map(|e| e.representative).collect();
        let conditions =
            Conditions::from_flights(system, effects, library, distances, columns).unwrap();
        assert!(conditions.programs.len() > 20);
        let grams = conditions.programs.iter().map(|program| &program.gram);
        for gram in grams.chain(&conditions.ordinary) {
            for k in 0..conditions.columns.len() {
                for l in (0..conditions.columns.len()).filter(|&l| l != k) {
                    let (now, _) = squared(&conditions.now, k, l, 1.0);
                    let (then, _) = squared(gram, k, l, 1.0);
                    let scale = conditions.now[(k, k)].max(1e-9);
                    assert!(then >= now - 1e-7 * scale, "{k} {l}: {then} {now}");
                }
            }
        }
    });
}

/// A fleet flown at Mach 0.80 and nothing else says nothing of TSFC's exponent of Mach number: `ln((1 + M)/(1 + M_ref))`
/// is zero. Whatever the level, only another Mach number can tell the exponent from a constant factor, and it must: at
/// Mach 0.70 against 0.80 the exponent's typical size 0.1 makes 0.1·ln(1.70/1.80) = −0.57 % of fuel flow.
#[test]
fn a_fleet_at_one_mach_number_is_told_to_sweep_it() {
    let model = exact_model();
    let mut flights = fleet(30);
    for segment in flights.iter_mut().flatten() {
        let means = &mut segment.means;
        let mach = 0.80 + 0.002 * (means.mach - 0.8);
        means.true_airspeed_m_s *= mach / means.mach;
        means.mach = mach;
    }
    with(&model, &flights, |system, effects, library, distances| {
        let exponent = column(library, EffectId::TsfcMachExponent);
        let factor = column(library, EffectId::TsfcFactor);
        let conditions =
            Conditions::from_flights(system, effects, library, distances, vec![factor, exponent])
                .unwrap();
        let size = 0.1;
        assert!(distances.squared(exponent, factor, size).0 < 0.1 * CONFUSED);
        let advised = conditions.advised(exponent, factor..factor + 1, size);
        let best = advised.first().expect("a Mach sweep");
        let is_slower =
            |sweep: &Sweep| matches!(sweep, Sweep::Mach { below_slowest_flown: Some(_), .. });
        assert!(sweeps(best).iter().any(is_slower), "{best:?}");
        assert!(sweeps(best).iter().all(|sweep| Kind::from(*sweep) == Kind::Mach), "{best:?}");
        assert!(best.after > 2.0 && best.ordinary < 0.5 && best.before <= best.ordinary);
        // A level sweep at that Mach number tells nothing of it and is not offered.
        let is_level = |sweep: &Sweep| Kind::from(*sweep) == Kind::Level;
        assert!(!advised.iter().flat_map(sweeps).any(|sweep| is_level(&sweep)), "{advised:?}");
    });
}

fn sweeps(advised: &Advised) -> Vec<Sweep> {
    match advised.flights {
        FlightsOnPurpose::OneSort(sweep) => vec![sweep],
        FlightsOnPurpose::TwoSorts(sweeps) => sweeps.to_vec(),
    }
}

/// What is advised gains clearly on six ordinary flights, the best comes first, and the same is advised every time.
#[test]
fn advice_is_ranked_and_repeats() {
    let model = exact_model();
    let flights = fleet(20);
    with(&model, &flights, |system, effects, library, distances| {
        let columns: Vec<usize> = (0..library.columns.len()).collect();
        let again = || {
            Conditions::from_flights(system, effects, library, distances, columns.clone()).unwrap()
        };
        let (conditions, other) = (again(), again());
        let mut offered = 0;
        for k in &library.effects {
            for l in library.effects.iter().filter(|l| l.id != k.id) {
                let advised = conditions.advised(k.representative, l.all_columns(), k.typical);
                let once_more = other.advised(k.representative, l.all_columns(), k.typical);
                assert_eq!(advised, once_more);
                assert!(advised.iter().all(|one| one.after > 1.1 * one.ordinary + 0.1));
                assert!(advised.iter().all(|one| one.after >= 1.0));
                assert!(advised.is_sorted_by(|a, b| a.after >= b.after));
                offered += usize::from(!advised.is_empty());
            }
        }
        assert!(offered > 0);
    });
}

/// Without a recorded N2 and without a baseline no nuisance column is one of a deck: measuring a deck changes no distance.
#[test]
fn a_measured_deck_shrinks_nothing_but_the_deck() {
    let model = exact_model();
    let mut flights = fleet(12);
    for segment in flights.iter_mut().flatten() {
        segment.means.n2_percent.clear();
    }
    with(&model, &flights, |system, _, library, distances| {
        assert!(!system.data.channels.n2);
        let largest = (0..library.columns.len())
            .map(|k| distances.with_deck[(k, k)] / distances.gram[(k, k)] - 1.0)
            .fold(0.0, f64::max);
        assert!(largest.abs() < 1e-12, "information grows by up to {largest}");
    });
}
