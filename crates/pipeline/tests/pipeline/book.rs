//! What a guide predicts: the oracle is the guide itself, its rows flown as they are printed.

#![expect(clippy::unwrap_used, reason = "fixtures are whole")]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

use diagnose::{FlightRecord, Input, Options, diagnose};
use effects::{BetweenNodes, ExtendedModel};
use flight::{Cruise, FlightIdentity, Segment, SegmentMeans};
use lut::{Outside, SmoothCell};
use perf_model::initial::observe_guide_point;
use perf_model::{
    Aircraft, FlightPoint, Guide, GuideLevels, GuidePlace, LevelFlights, initial_model,
};
use pipeline::evaluation::{BookEffects, evaluate, evaluate_book};
use pipeline::model_file::ModelFile;
use pipeline::segments_table::Evaluated;
use pipeline::whole_model::{HeldAgainst, Predicts};
use test_support::Random;
use units::{Mach, Mass, PressureAltitude};

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
    let (model, segments) = of_two_thirds();
    let rms = |model: &ModelFile| {
        let by_book = evaluate_book(model, BookEffects::OfModel, &segments).into_iter();
        let errors: Vec<f64> = by_book.flatten().filter_map(|of| of.error_percent).collect();
        assert!(errors.len() > 60, "{}", errors.len());
        (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
    };
    let by_level = rms(&model);
    let reference = model.reference().base();
    let without = reference.clone().with_levels(GuideLevels::default());
    let by_table = rms(&ModelFile { by_guide: Some(Box::new(without.into())), ..model.clone() });
    assert!(by_level < 0.2 && by_table > 0.5, "{by_level} against {by_table}");
    // As it is written.
    let read = ModelFile::from_text(&model.to_text().unwrap()).unwrap();
    assert_eq!(read.reference(), model.reference());
}

/// The oracle is the book, whose fuel flow each row burns: predictions of everything that refers to it have its factor by level, too,
/// whoever is asked, and so have observations, which are of the table.
#[test]
fn all_that_refers_to_the_guide_has_its_levels() {
    let (model, segments) = of_two_thirds();
    let reference = model.reference();
    let levels = reference.base().levels().unwrap();
    let by_book = evaluate_book(&model, BookEffects::OfModel, &segments);
    let mut asked = 0;
    for (segment, by_book) in segments.iter().zip(by_book) {
        let Some(error) = by_book.and_then(|of| of.error_percent) else { continue };
        asked += 1;
        let means = &segment.means;
        let recorded = means.fuel_flow_total_kg_s;
        let found = reference.predict_segment(segment, reference.drag_table()).unwrap();
        // Tables are bilinear there and the book is smooth.
        let table = reference.drag_table();
        let smooth = SmoothCell::locate(table.grid(), found.state.lift_coefficient, means.mach);
        let chord = table.interpolate(&found.cell) / smooth.unwrap().value_of(table);
        let by_segment = found.fuel_flow_total.to_kilograms_per_second() / chord;
        let by_book = recorded * (1.0 - error / 100.0);
        assert!((by_segment / by_book - 1.0).abs() < 1e-12, "{by_segment} {by_book}");
        let point = FlightPoint::new(
            Mass::kilograms(means.mass_kg),
            PressureAltitude::meters(means.pressure_altitude_m),
            Mach::new(means.mach),
        );
        let by_point = reference.predict(&point).unwrap().fuel_flow_total;
        let by_effects = reference.response(&point).unwrap().ln_fuel_flow_total.exp();
        let columns = LevelFlights {
            mass_kg: &[means.mass_kg],
            pressure_altitude_m: &[means.pressure_altitude_m],
            mach: &[means.mach],
            isa_deviation_k: &[0.0],
        };
        let mut by_columns = reference.base().fuel_flows_kg_s(columns);
        reference.base().predict_level(columns, |_, found| {
            by_columns.push(found.fuel_flow_total.to_kilograms_per_second());
        });
        let by_point = by_point.to_kilograms_per_second() / chord;
        for by_column in by_columns {
            assert!((by_column / chord / by_point - 1.0).abs() < 1e-11, "{by_column} {by_point}");
        }
        assert!((by_point / by_book - 1.0).abs() < 1e-9, "{by_point} {by_book}");
        assert!((by_effects / chord / by_book - 1.0).abs() < 1e-9, "{by_effects} {by_book}");
        let observed = reference.observe(segment).unwrap();
        let factor = levels.factor(GuidePlace {
            lift_coefficient: observed.lift_coefficient,
            mach: observed.mach,
            pressure_altitude: PressureAltitude::meters(means.pressure_altitude_m),
        });
        let plain = model.initial.observe(segment).unwrap();
        assert!((observed.drag_coefficient * factor / plain.drag_coefficient - 1.0).abs() < 1e-12);
    }
    assert!(asked > 60, "{asked}");
}

/// The same aircraft's model by two thirds of the rows of its guide, and what an aircraft burns that flies the others.
fn of_two_thirds() -> (ModelFile, Vec<Segment>) {
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
    (model, rows.points().iter().map(flown).collect())
}

/// Flights that burn what the guide prints have no gap to a model that has learnt nothing: it is held against them by the guide, smooth
/// between the nodes and level by level. By chords of the same table, and by the table of the middle level, they have one.
#[test]
fn a_guide_that_is_flown_has_no_gap() {
    let (model, segments) = of_two_thirds();
    let records: Vec<FlightRecord<'_>> =
        segments.chunks(6).map(|segments| FlightRecord { segments, gauges: None }).collect();
    let HeldAgainst { model: reference, drag_table, between_nodes } =
        model.held_against(Predicts::WholeModel);
    let options = Options { skip_closure: true, skip_where: true, ..Options::default() };
    let rms_percent = |reference: &ExtendedModel, between_nodes| {
        let input = Input { drag_table, between_nodes, ..Input::against(reference, &records) };
        diagnose(&input, &options).unwrap().gap.rms_percent
    };
    let without = reference.base().clone().with_levels(GuideLevels::default()).into();
    let found = rms_percent(reference, between_nodes);
    let (by_chords, by_table) =
        (rms_percent(reference, BetweenNodes::Straight), rms_percent(&without, between_nodes));
    assert!(found < 0.2 && by_chords > 0.3 && by_table > 0.5, "{found} {by_chords} {by_table}");
}

/// Rows that scatter by more than levels differ, as those of a guide made of flights, have no levels.
#[test]
fn rows_that_scatter_have_no_levels() {
    let aircraft = Aircraft::from_ron(AIRCRAFT).unwrap();
    let printed = Guide::from_csv(GUIDE).unwrap();
    let has_levels = |scatter_percent: f64| {
        let mut random = Random::new(11, 0);
        let mut text =
            String::from("mass_kg,pressure_altitude_ft,true_airspeed_kt,fuel_flow_kg_h\n");
        for row in printed.points() {
            let kg_h = row.fuel_flow_total.to_kilograms_per_second()
                * 3600.0
                * (1.0 + 0.01 * random.normal(0.0, scatter_percent));
            let (mass_kg, altitude_ft) = (row.mass.to_kilograms(), row.pressure_altitude.to_feet());
            let true_airspeed_kt = row.true_airspeed.to_knots();
            writeln!(text, "{mass_kg},{altitude_ft},{true_airspeed_kt},{kg_h}").unwrap();
        }
        let guide = Guide::from_csv(text.as_bytes()).unwrap();
        let model = ModelFile::from_initial(&initial_model(&aircraft, &guide).unwrap(), &guide);
        model.reference().base().levels().is_some()
    };
    assert!(has_levels(0.0) && has_levels(0.3) && !has_levels(6.0));
}
