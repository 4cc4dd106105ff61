use effects::EffectModel;
use flight::Segment;
use test_support::fleet::{Background, Setup, exact_model, fly};

use super::*;
use crate::library::dates::DateGrid;
use crate::residuals::reference::Reference;
use crate::search::system::WhitenedSystem;
use crate::signals::record::FlightRecord;
use crate::signals::references::references_of;

fn with_flights<T>(
    flights: &[Vec<Segment>],
    look: impl FnOnce(&PreparedFlights<'_>, &Design<'_>, &Library) -> T,
) -> T {
    let model = exact_model();
    let records: Vec<FlightRecord<'_>> =
        flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    let references = references_of(&model, model.drag_table(), &records).unwrap();
    let effects = EffectModel::new(&model, model.drag_table(), references).unwrap();
    let (data, library) = PreparedFlights::prepare(
        &effects,
        &records,
        Reference::Table,
        |points, engines, starts| {
            Library::new(&effects, points, engines, DateGrid::coarse(starts, &[], None), |_| true)
        },
    );
    let design = Design::new(&data, &references, None, None);
    look(&data, &design, &library)
}

/// Which of the segments, counted through all flights, are outliers.
fn found(flights: &[Vec<Segment>]) -> Vec<usize> {
    with_flights(flights, |data, design, library| {
        assert_eq!(data.segments.len(), flights.iter().flatten().count());
        let refused = outliers(data, design, library, &RowsWithinSegments::new(data, design));
        (0..refused.len()).filter(|&place| refused[place]).collect()
    })
}

fn fleet(seed: u64, flights: usize) -> Vec<Vec<Segment>> {
    let setup = Setup { flights, ..Setup::default() };
    fly(seed, &setup, &[], &Background::default()).flights
}

fn burn(segment: &mut Segment, by: f64) {
    segment.means.fuel_flow_total_kg_s *= by;
    for flow in &mut segment.means.fuel_flow_engine_kg_s {
        *flow *= by;
    }
}

/// Those that were spoilt are found, and no other: a tenth of them up or down, one tenfold, one whole flight.
#[test]
fn what_was_spoilt_is_found_and_nothing_else() {
    let clean = fleet(74, 24);
    assert_eq!(found(&clean), [0; 0]);
    let mut tenth = clean.clone();
    let spoilt: Vec<usize> = (3..240).step_by(11).collect();
    for &place in &spoilt {
        burn(&mut tenth[place / 10][place % 10], if place % 2 == 0 { 1.12 } else { 0.88 });
    }
    assert_eq!(found(&tenth), spoilt);
    let mut tenfold = clean.clone();
    burn(&mut tenfold[8][4], 10.0);
    assert_eq!(found(&tenfold), [84]);
    let mut flight = clean;
    for segment in &mut flight[13] {
        burn(segment, 1.10);
    }
    assert_eq!(found(&flight), (130..140).collect::<Vec<_>>());
}

/// A gap of conditions that were flown, or of a time, is none of a recording: everything above a Mach number, and the last two
/// flights.
#[test]
fn what_neighbors_show_too_is_no_outlier() {
    let clean = fleet(75, 24);
    let mut fast = clean.clone();
    for segment in fast.iter_mut().flatten().filter(|segment| segment.means.mach > 0.89) {
        burn(segment, 1.08);
    }
    let share = fast.iter().flatten().filter(|s| s.means.mach > 0.89).count();
    assert!((8..40).contains(&share), "{share}");
    // The slowest of them has as many neighbors without the gap as with it, and may be taken for one.
    assert!(found(&fast).len() <= 1, "{:?}", found(&fast));
    let mut last = clean;
    for segment in last[22..].iter_mut().flatten() {
        burn(segment, 1.10);
    }
    assert_eq!(found(&last), [0; 0]);
}

/// With nothing far the sizes are those of the fit to rows that were whitened flight by flight.
#[test]
fn the_fit_is_the_one_of_the_search() {
    with_flights(&fleet(76, 6), |data, design, library| {
        let rows = RowsWithinSegments::new(data, design);
        let judge = Judge::new(data, design, library, &rows);
        let sizes = judge.fit(&vec![None; data.segments.len()]).unwrap();
        let system = WhitenedSystem::new(data, design);
        let columns = &judge.columns[..sizes.len()];
        let expected =
            system.gram(None).fit(columns, &judge.deviations, design.residual()).unwrap();
        for (k, size) in sizes.iter().enumerate() {
            let (other, scale) = (expected[(k, 0)], judge.deviations[k]);
            assert!((size - other).abs() < 1e-6 * scale, "{k}: {size} {other}");
        }
    });
}

/// Rows and sum of squares of whitened residuals.
fn noise_of(flights: &[Vec<Segment>]) -> (f64, f64) {
    noise_with(flights, 1.0)
}

/// The same where every segment has this weight.
fn noise_with(flights: &[Vec<Segment>], weight: f64) -> (f64, f64) {
    with_flights(flights, |data, design, _| {
        let mut data = data.clone();
        data.weigh(&vec![weight; data.segments.len()]);
        let data = &data;
        let system = WhitenedSystem::new(data, design);
        let gram = system.gram(None);
        (gram.rows, gram.matrix[(design.residual(), design.residual())])
    })
}

/// By hand: rows and squares of flights with N2 and of flights without are those of each kind alone, added. A channel
/// that is not recorded is no perfect residual of zero, and makes no other segment an outlier.
#[test]
fn what_is_not_recorded_is_not_counted() {
    let mut flights = fleet(5, 24);
    let with_n2 = 13;
    for segment in flights[with_n2..].iter_mut().flatten() {
        segment.means.n2_percent.clear();
    }
    let (rows, square) = noise_of(&flights);
    let (rows_with, square_with) = noise_of(&flights[..with_n2]);
    let (rows_without, square_without) = noise_of(&flights[with_n2..]);
    assert!((square / (square_with + square_without) - 1.0).abs() < 1e-9);
    assert!((rows - rows_with - rows_without).abs() < 1e-9, "{rows}");
    for segment in flights[with_n2..].iter_mut().flatten() {
        segment.means.fuel_flow_engine_kg_s.clear();
    }
    assert_eq!(found(&flights), [0; 0]);
}

/// By hand: with a weight of a half everywhere squares and values are a quarter, and the noise between them is as before.
#[test]
fn weights_do_not_make_the_noise_smaller() {
    let flights = fleet(6, 8);
    let (rows, square) = noise_of(&flights);
    let (weighted_rows, weighted_square) = noise_with(&flights, 0.5);
    assert!((weighted_square / square - 0.25).abs() < 1e-12);
    assert!((weighted_rows / rows - 0.25).abs() < 1e-12, "{rows} {weighted_rows}");
}
