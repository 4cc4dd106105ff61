use std::path::Path;

use perf_model::{Aircraft, Guide, LevelFlights};
use segmenter::TrimCriteria;
use units::{Mach, Mass, PressureAltitude, TemperatureDifference};

use super::*;
use crate::learning::{LawChoice, begin};
use crate::reading::FlightReader;
use crate::whole_model::belief_before_flights;

const BAYES: &str = include_str!("../../../../fixtures/global5000/bayes/expected/SIM-01.ron");
const AIRCRAFT: &str = include_str!("../../../../fixtures/global5000/AIRCRAFT.ron");
const GUIDE: &str = include_str!("../../../../fixtures/global5000/guide.csv");
const PAPER: &str = include_str!("../../../../fixtures/global5000/expected/SIM-01.ron");

/// How near columns of a whole model are to single predictions: fuel flows, and their standard deviations.
const MEAN_TOLERANCE: f64 = 1e-9;
const DEVIATION_TOLERANCE: f64 = 1e-5;

/// The step in altitude by which single predictions differentiate: `ALTITUDE_STEP_M` of `diagnose`, which is its own.
const SINGLE_ALTITUDE_STEP_M: f64 = 1e-3;

fn points() -> Vec<FlightPoint> {
    let share = |step: u32, of: u32| f64::from(step % of) / f64::from(of);
    (0..2000)
        .map(|step| FlightPoint {
            isa_deviation: TemperatureDifference::kelvin(-15.0 + 30.0 * share(step, 7)),
            measured_fuel_flow_total: (step % 3 == 0)
                .then(|| FuelFlowTotal::kilograms_per_second(0.4 + share(step, 11))),
            ..FlightPoint::new(
                Mass::kilograms(24_000.0 + 16_000.0 * share(step, 37)),
                PressureAltitude::feet(30_000.0 + 18_000.0 * share(step, 61)),
                Mach::new(0.70 + 0.4 * share(step, 23)),
            )
        })
        .collect()
}

/// The model of law `bayes` with what its flights show beyond its table.
pub(crate) fn whole() -> ModelFile {
    whole_and_segments().0
}

fn whole_and_segments() -> (ModelFile, Vec<Segment>) {
    let mut file = ModelFile::from_text(BAYES).unwrap();
    let segments = segments();
    let learnt = file.learnt.as_mut().unwrap();
    crate::learning::remember_remainder((&file.initial, None), learnt, &segments);
    assert!(learnt.baseline.is_some());
    (file, segments)
}

/// The same flights by an aircraft of which something else is stated.
fn whole_where(stated: &str, instead: &str) -> ModelFile {
    let text = AIRCRAFT.replace(stated, instead);
    assert_ne!(text, AIRCRAFT);
    let aircraft = Aircraft::from_ron(&text).unwrap();
    let guide = Guide::from_csv(GUIDE.as_bytes()).unwrap();
    let initial = perf_model::initial_model(&aircraft, &guide).unwrap();
    let mut file = ModelFile::from_initial(&initial, &guide);
    let law = LawChoice::Bayes(file.settings.bayes);
    let mut learnt = begin(&file.initial, "SIM-01", TrimCriteria::PRESETS[0], law).unwrap();
    crate::learning::remember_remainder((&file.initial, None), &mut learnt, &segments());
    assert!(learnt.baseline.is_some());
    file.learnt = Some(learnt);
    file
}

#[expect(clippy::disallowed_methods, reason = "a test reads the repository's fixture")]
fn segments() -> Vec<Segment> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/global5000/reports");
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let criteria = TrimCriteria::preset(TrimCriteria::PRESETS[0]).unwrap();
    let mut reader = FlightReader::default();
    paths
        .iter()
        .flat_map(|path| reader.read(path, &std::fs::read(path).unwrap(), None, &criteria).0)
        .flat_map(|flight| flight.reduced.segments)
        .collect()
}

/// The oracle is each prediction on its own.
fn columns_are_single_predictions(file: &ModelFile, predicts: Predicts) {
    columns_are_near_single_predictions(file, predicts, DEVIATION_TOLERANCE);
}

fn columns_are_near_single_predictions(
    file: &ModelFile,
    predicts: Predicts,
    deviation_tolerance: f64,
) {
    let predictor = Predictor::new(file, predicts).unwrap();
    assert_eq!(predictor.is_whole(), predicts == Predicts::WholeModel);
    let points = points();
    let measured = measured_kg_s(&points);
    let found = predictor.at_points(&points, Some(&measured));
    let column = |name: &str| {
        let named = found.columns.iter().find(|(known, _)| *known == name);
        named.map(|(_, values)| &values[..])
    };
    let near = |name: &str, place: usize, single: Option<f64>| {
        let value = column(name).unwrap()[place];
        // A percentage is a difference of two flows: what is equal is the flow, 100 % of it.
        let scale = if name.ends_with("_percent") { 100.0 } else { 1e-3 };
        // What a whole model has learnt is tabulated; slopes of its noise are differences over small steps.
        let tolerance = match (predictor.is_whole(), name) {
            (true, "fuel_flow_std_kg_s") => deviation_tolerance,
            (true, _) => MEAN_TOLERANCE,
            (false, _) => 1e-12,
        };
        let agrees = single.map_or(value.is_nan(), |single| {
            (value - single).abs() <= tolerance * single.abs().max(scale)
        });
        assert!(agrees, "{name} of point {place}: {value}, on its own {single:?}");
    };
    let (mut inside, mut refused) = (0, found.refused.iter());
    for (place, point) in points.iter().enumerate() {
        let single = predictor.at(point);
        if let Err(reason) = &single {
            assert_eq!(refused.next(), Some(&(place, reason.clone())));
        }
        let single = single.ok();
        inside += usize::from(single.is_some());
        let of = |of: fn(&Prediction) -> f64| single.as_ref().map(|one| of(&one.prediction));
        near("fuel_flow_kg_s", place, of(|p| p.fuel_flow_total.to_kilograms_per_second()));
        near("specific_range_m_kg", place, of(|p| p.specific_range.to_meters_per_kilogram()));
        near("lift_coefficient", place, of(|p| p.lift_coefficient));
        near("drag_coefficient", place, of(|p| p.drag_coefficient));
        near("extrapolated", place, of(|p| f64::from(u8::from(p.extrapolated))));
        near("error_percent", place, single.as_ref().and_then(|one| one.prediction.error_percent));
        near("fuel_flow_std_kg_s", place, single.as_ref().and_then(|one| one.fuel_flow_std_kg_s));
        if predictor.is_whole() {
            let beside = single.and_then(|one| one.beside_table);
            let remainder = beside.map(|beside| 100.0 * beside.ln_fuel_flow.exp_m1());
            near("remainder_percent", place, remainder);
            let beyond = beside.map(|beside| f64::from(u8::from(beside.beyond_flights)));
            near("beyond_flights", place, beyond);
        } else {
            assert_eq!(column("remainder_percent"), None);
        }
    }
    assert!(refused.next().is_none());
    assert!((300..1900).contains(&inside), "{inside} of {} are inside the table", points.len());
}

#[test]
fn columns_of_an_initial_model_and_of_both_laws_are_single_predictions() {
    columns_are_single_predictions(&ModelFile::from_text(PAPER).unwrap(), Predicts::TableOnly);
    columns_are_single_predictions(&ModelFile::from_text(BAYES).unwrap(), Predicts::TableOnly);
    columns_are_single_predictions(&whole(), Predicts::WholeModel);
    // TSFC that depends on Mach number, air data that drift: neither is so in the fixture.
    let with_mach_exponent = whole_where("mach_exponent: 0.0", "mach_exponent: 0.6");
    columns_are_single_predictions(&with_mach_exponent, Predicts::WholeModel);
    let drift = "engines: 2, sensors: (air_data_drift: (share: 0.7)),";
    columns_are_single_predictions(&whole_where("engines: 2,", drift), Predicts::WholeModel);
}

/// A model whose functions bend over far shorter lengths than any that is learnt: many points lie where columns do not hold, or
/// come there by a sensor's error, and are predicted one by one.
#[test]
fn points_far_beyond_what_columns_hold_are_single_predictions_too() {
    let file = whole();
    let middle_m = PressureAltitude::feet(30_000.0 + 18_000.0 * 30.0 / 61.0).to_meters();
    for shorter in [40.0, 12_000.0] {
        let mut file = file.clone();
        let learnt = file.learnt.as_mut().unwrap();
        let text = ron::to_string(learnt.baseline.as_ref().unwrap().record()).unwrap();
        let length = "variable:pressure_altitude,middle:";
        let (before, rest) = text.split_once(length).unwrap();
        let (_, rest) = rest.split_once(",length:").unwrap();
        let (known, rest) = rest.split_once(',').unwrap();
        let known: f64 = known.parse().unwrap();
        let length_m = known / shorter;
        let text = format!("{before}{length}{middle_m},length:{length_m},{rest}");
        let record: diagnose::BaselineRecord = ron::from_str(&text).unwrap();
        let bayes = file.settings.bayes;
        let belief = belief_before_flights(&file.initial, bayes, record.drag_nodes()).unwrap();
        learnt.baseline = Some(diagnose::Baseline::new(record, Some(belief)).unwrap());
        // Of a function that bends within a length, a difference over a step on either side is off by its square at the worst.
        let step = SINGLE_ALTITUDE_STEP_M / length_m;
        let tolerance = DEVIATION_TOLERANCE.max(step * step);
        columns_are_near_single_predictions(&file, Predicts::WholeModel, tolerance);
        let bare = Predictor::new(&file, Predicts::WholeModel).unwrap().without_deviations();
        let points = points();
        let found = bare.at_points(&points, None);
        assert!(!points.is_empty());
        assert_eq!(found.columns[0].1.len(), points.len());
        for (point, found_kg_s) in points.iter().zip(&found.columns[0].1) {
            let alone = bare.at(point).ok();
            let alone = alone.map(|one| one.prediction.fuel_flow_total.to_kilograms_per_second());
            let is_same = alone.map_or(found_kg_s.is_nan(), |kg_s| {
                (found_kg_s - kg_s).abs() <= MEAN_TOLERANCE * kg_s.abs().max(1e-3)
            });
            assert!(is_same, "{point:?}: {found_kg_s}, on its own {alone:?}");
        }
    }
}

#[test]
fn points_of_which_more_is_known_are_predicted_one_by_one_among_the_others() {
    let file = whole();
    let predictor = Predictor::new(&file, Predicts::WholeModel).unwrap();
    assert!(predictor.predicts_columns() && predictor.is_whole());
    let mut points = points();
    for point in points.iter_mut().step_by(5) {
        point.anti_ice = Some(true);
    }
    let all = predictor.at_points(&points, None);
    for (place, point) in points.iter().enumerate() {
        let alone = predictor.at_points(std::slice::from_ref(point), None);
        for ((name, values), (_, value)) in all.columns.iter().zip(&alone.columns) {
            assert_eq!(values[place].to_bits(), value[0].to_bits(), "{name} of point {place}");
        }
        if place % 5 == 0 {
            let single = predictor.at(point).ok();
            let flow = single.map(|one| one.prediction.fuel_flow_total.to_kilograms_per_second());
            assert_eq!(flow.map(f64::to_bits), flow.map(|_| all.columns[0].1[place].to_bits()));
        }
    }
    assert!(all.refused.is_sorted_by_key(|(place, _)| *place));
}

#[test]
fn without_deviations_the_rest_is_the_same_to_the_bit() {
    for (file, predicts) in [
        (whole(), Predicts::WholeModel),
        (ModelFile::from_text(BAYES).unwrap(), Predicts::TableOnly),
    ] {
        let with = Predictor::new(&file, predicts).unwrap();
        let without = Predictor::new(&file, predicts).unwrap().without_deviations();
        let points = points();
        let (with, without) = (with.at_points(&points, None), without.at_points(&points, None));
        assert_eq!(with.refused, without.refused);
        for ((name, all), (_, some)) in with.columns.iter().zip(&without.columns) {
            for (place, (one, other)) in all.iter().zip(some).enumerate() {
                if *name == "fuel_flow_std_kg_s" {
                    assert!(other.is_nan());
                } else {
                    assert_eq!(one.to_bits(), other.to_bits(), "{name} of point {place}");
                }
            }
        }
    }
}

/// Whatever columns are asked for: each alone is what it is among all.
#[test]
fn a_column_alone_is_the_same_to_the_bit() {
    for (file, predicts) in [
        (whole(), Predicts::WholeModel),
        (ModelFile::from_text(BAYES).unwrap(), Predicts::TableOnly),
    ] {
        let points = points();
        let measured = measured_kg_s(&points);
        let all =
            Predictor::new(&file, predicts).unwrap().at_points(&points, Some(&measured)).columns;
        let mut found = Vec::new();
        for column in PredictedColumn::ALL {
            assert_eq!(PredictedColumn::of_name(column.name()), Some(column));
            let only = Predictor::new(&file, predicts).unwrap().with_columns(&[column]);
            found.extend(only.at_points(&points, Some(&measured)).columns);
        }
        let names = |columns: &[(&'static str, Vec<f64>)]| -> Vec<&'static str> {
            columns.iter().map(|(name, _)| *name).collect()
        };
        assert_eq!(names(&found), names(&all));
        for ((name, alone), (_, among)) in found.iter().zip(&all) {
            let bits = |values: &[f64]| -> Vec<u64> {
                values.iter().map(|value| value.to_bits()).collect()
            };
            assert_eq!(bits(alone), bits(among), "{name}");
        }
    }
    assert_eq!(PredictedColumn::of_name("fuel_flow"), None);
}

/// By the ranges of what was flown, found in the segments.
#[test]
fn points_beyond_the_flights_are_marked_and_less_sure() {
    let (file, segments) = whole_and_segments();
    let predictor = Predictor::new(&file, Predicts::WholeModel).unwrap();
    let at = |segment: &Segment, heavier: f64| {
        let means = &segment.means;
        let altitude = PressureAltitude::meters(means.pressure_altitude_m);
        let isa_k = atmos::isa::temperature(altitude).unwrap().to_kelvin();
        let deviation = means.static_air_temperature_k - isa_k;
        let point = FlightPoint {
            isa_deviation: TemperatureDifference::kelvin(deviation),
            ..FlightPoint::new(
                Mass::kilograms(heavier * means.mass_kg),
                altitude,
                Mach::new(means.mach),
            )
        };
        let found = predictor.at(&point).unwrap();
        let total_kg_s = found.prediction.fuel_flow_total.to_kilograms_per_second();
        let relative = found.fuel_flow_std_kg_s.unwrap() / total_kg_s;
        (found.beside_table.unwrap().beyond_flights, relative)
    };
    let heaviest = segments.iter().map(|one| one.means.mass_kg).fold(0.0, f64::max);
    // What was flown with acceleration can lie beyond level flight's thrust by a little: most of it does not.
    let marked = segments.iter().filter(|one| at(one, 1.0).0).count();
    assert!(marked * 10 < segments.len(), "{marked} of {}", segments.len());
    let middle = &segments[segments.len() / 2];
    let beyond = 1.02 * heaviest / middle.means.mass_kg;
    let ((flown, flown_std), (far, far_std)) = (at(middle, 1.0), at(middle, beyond));
    assert!(!flown && far && far_std > flown_std, "{flown_std} {far_std}");
}

#[test]
fn columns_do_not_depend_on_where_they_are_cut() {
    let file = whole();
    for predicts in [Predicts::TableOnly, Predicts::WholeModel] {
        are_the_same_wherever_they_are_cut(&Predictor::new(&file, predicts).unwrap());
    }
}

fn are_the_same_wherever_they_are_cut(predictor: &Predictor<'_>) {
    assert!(predictor.predicts_columns());
    let mut points = points();
    points[70].mass = Mass::kilograms(f64::NAN);
    points[71].isa_deviation = TemperatureDifference::kelvin(f64::NAN);
    let column = |of: fn(&FlightPoint) -> f64| points.iter().map(of).collect::<Vec<_>>();
    let mass_kg = column(|point| point.mass.to_kilograms());
    let pressure_altitude_m = column(|point| point.pressure_altitude.to_meters());
    let mach = column(|point| point.mach.value());
    let isa_deviation_k = column(|point| point.isa_deviation.to_kelvin());
    let from = |first: usize| LevelFlights {
        mass_kg: &mass_kg[first..],
        pressure_altitude_m: &pressure_altitude_m[first..],
        mach: &mach[first..],
        isa_deviation_k: &isa_deviation_k[first..],
    };
    let whole = predictor.at_points(&points, None);
    for first in [0, 1, 7, 8, 31, 32, 33, 63, 64, 1000] {
        let cut = predictor.at_level_flights(from(first), None);
        for ((name, all), (_, some)) in whole.columns.iter().zip(&cut.columns) {
            let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&all[first..]), bits(some), "{name} from {first}");
        }
    }
}
