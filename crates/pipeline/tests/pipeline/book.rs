//! What a guide predicts: the oracle is the guide itself, its rows flown as they are printed.

#![expect(clippy::unwrap_used, reason = "fixtures are whole")]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

use flight::{Cruise, FlightIdentity, Segment, SegmentMeans};
use lut::{Outside, SmoothCell};
use perf_model::initial::observe_guide_point;
use perf_model::{Aircraft, Guide, initial_model};
use pipeline::evaluation::{BookEffects, evaluate, evaluate_book};
use pipeline::model_file::ModelFile;
use pipeline::segments_table::Evaluated;

const AIRCRAFT: &str = include_str!("../../../../fixtures/global5000/AIRCRAFT.ron");
const GUIDE: &[u8] = include_bytes!("../../../../fixtures/global5000/guide.csv");

/// A segment that burns what a row prints.
fn flown(row: &perf_model::GuidePoint) -> Segment {
    let isa = atmos::isa::temperature(row.pressure_altitude).unwrap();
    let mach = atmos::airspeed::true_airspeed_to_mach(row.true_airspeed, isa);
    let means = SegmentMeans::cruise(&Cruise {
        pressure_altitude: row.pressure_altitude,
        static_air_temperature: isa,
        mach,
        true_airspeed: row.true_airspeed,
        mass: row.mass,
        fuel_flow_total: row.fuel_flow_total,
    });
    let identity = FlightIdentity {
        tail: "GUIDE".into(),
        start: "2026-01-01T00:00:00Z".parse().unwrap(),
        flight: row.line.to_string(),
    };
    Segment { identity: Arc::new(identity), rows: vec![0, 1, 2], means, temperature_assumed: false }
}

/// Root mean square over Mach numbers of the mean error at each, %: what depends on the level, of which drag is no function, is in
/// both.
fn rms_by_mach(segments: &[Segment], evaluated: &[Option<Evaluated>]) -> f64 {
    let mut of_mach: BTreeMap<u32, Vec<f64>> = BTreeMap::new();
    for (segment, evaluated) in segments.iter().zip(evaluated) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 1")]
        let hundredths = (100.0 * segment.means.mach).round() as u32;
        let error = evaluated.and_then(|of| of.error_percent);
        of_mach.entry(hundredths).or_default().extend(error);
    }
    let mean = |errors: &Vec<f64>| errors.iter().sum::<f64>() / errors.len() as f64;
    let well_known: Vec<f64> =
        of_mach.values().filter(|errors| errors.len() >= 20).map(mean).collect();
    assert!(well_known.len() >= 4, "{of_mach:?}");
    (well_known.iter().map(|mean| mean * mean).sum::<f64>() / well_known.len() as f64).sqrt()
}

#[test]
fn the_book_is_the_guide_and_not_the_polynomial_through_it() {
    let aircraft = Aircraft::from_ron(AIRCRAFT).unwrap();
    let guide = Guide::from_csv(GUIDE).unwrap();
    let model = ModelFile::from_initial(&initial_model(&aircraft, &guide).unwrap(), &guide);
    let segments: Vec<Segment> = guide.points().iter().map(flown).collect();
    let by_book = rms_by_mach(&segments, &evaluate_book(&model, BookEffects::OfModel, &segments));
    let by_initial = evaluate(&model.initial, model.initial.drag_table(), &segments);
    let by_initial = rms_by_mach(&segments, &by_initial);
    assert!(by_book < 0.5 && by_initial > 0.6, "{by_book} against {by_initial}");
    // Without what the model contains: the same, as it contains nothing; and the initial table where a file has no rows.
    let without = evaluate_book(&model, BookEffects::None, &segments);
    assert_eq!(without, evaluate_book(&model, BookEffects::OfModel, &segments));
    let older = ModelFile { by_guide: None, ..model };
    let of_table = evaluate(&older.initial, older.initial.drag_table(), &segments);
    assert_eq!(evaluate_book(&older, BookEffects::OfModel, &segments), of_table);
}

/// Oracle: the polynomial that the rows were made of. They are read back to 0.02 % by tables of any step, though between nodes
/// 0.05 apart a chord lies half a per cent above the polynomial.
#[test]
fn rows_of_a_polynomial_come_back_whatever_the_grid() {
    let aircraft = Aircraft::from_ron(AIRCRAFT).unwrap();
    let printed = Guide::from_csv(GUIDE).unwrap();
    let polynomial = initial_model(&aircraft, &printed).unwrap().model;
    let mut text = String::from("mass_kg,pressure_altitude_ft,true_airspeed_kt,fuel_flow_kg_h\n");
    let mut chord_percent = 0.0_f64;
    for row in printed.points() {
        let of_row = observe_guide_point(polynomial.aircraft(), row).unwrap();
        let table = polynomial.drag_table();
        let place = (of_row.lift_coefficient, of_row.mach);
        let smooth = SmoothCell::locate(table.grid(), place.0, place.1).unwrap().value_of(table);
        let cell = table.grid().locate(place.0, place.1, Outside::Error).unwrap();
        chord_percent = chord_percent.max(100.0 * (table.interpolate(&cell) / smooth - 1.0));
        let kg_h = row.fuel_flow_total.to_kilograms_per_second() * 3600.0 * smooth
            / of_row.drag_coefficient;
        let (mass_kg, altitude_ft) = (row.mass.to_kilograms(), row.pressure_altitude.to_feet());
        let true_airspeed_kt = row.true_airspeed.to_knots();
        writeln!(text, "{mass_kg},{altitude_ft},{true_airspeed_kt},{kg_h}").unwrap();
    }
    assert!(chord_percent > 0.5, "{chord_percent}");
    let guide = Guide::from_csv(text.as_bytes()).unwrap();
    for step in ["0.01", "0.025", "0.05"] {
        let of_step =
            AIRCRAFT.replace("mach: (0.50, 0.95, 0.05)", &format!("mach: (0.50, 0.95, {step})"));
        let aircraft = Aircraft::from_ron(&of_step).unwrap();
        let model = ModelFile::from_initial(&initial_model(&aircraft, &guide).unwrap(), &guide);
        let segments: Vec<Segment> = guide.points().iter().map(flown).collect();
        let by_book = evaluate_book(&model, BookEffects::OfModel, &segments);
        let errors: Vec<f64> =
            by_book.into_iter().flatten().filter_map(|of| of.error_percent).collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let worst = errors.iter().fold(0.0_f64, |worst, error| worst.max(error.abs()));
        assert!(mean.abs() < 0.02 && errors.len() > 100, "step {step}: mean {mean}, worst {worst}");
    }
}

/// Oracle: a third of the guide's rows, of which neither table nor levels know. A table over lift coefficient and Mach number is
/// 0.65 % off them, one with a factor by level 0.1 %.
#[test]
fn rows_that_were_left_out_are_read_by_level() {
    let aircraft = include_str!("../../../../fixtures/a320-generic/AIRCRAFT.ron");
    let aircraft = Aircraft::from_ron(aircraft).unwrap();
    let text = include_str!("../../../../fixtures/a320-generic/guide.csv");
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let header = lines.next().unwrap();
    let (mut kept, mut left_out) = (header.to_owned(), header.to_owned());
    for (at, line) in lines.enumerate() {
        let of = if at % 3 == 1 { &mut left_out } else { &mut kept };
        write!(of, "\n{line}").unwrap();
    }
    let guide = Guide::from_csv(kept.as_bytes()).unwrap();
    let model = ModelFile::from_initial(&initial_model(&aircraft, &guide).unwrap(), &guide);
    let rows = Guide::from_csv(left_out.as_bytes()).unwrap();
    let segments: Vec<Segment> = rows.points().iter().map(flown).collect();
    let rms = |model: &ModelFile| {
        let by_book = evaluate_book(model, BookEffects::OfModel, &segments).into_iter();
        let errors: Vec<f64> = by_book.flatten().filter_map(|of| of.error_percent).collect();
        assert!(errors.len() > 60, "{}", errors.len());
        (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
    };
    let by_level = rms(&model);
    let by_table = rms(&ModelFile { guide_book: None, ..model.clone() });
    assert!(by_level < 0.2 && by_table > 0.5, "{by_level} against {by_table}");
    // As it is written.
    let read = ModelFile::from_text(&model.to_text().unwrap()).unwrap();
    assert_eq!(read.guide_book, model.guide_book);
    assert!(model.guide_book.is_some());
}
