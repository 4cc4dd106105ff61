//! What is too little or too odd for a name gets none, and no number is ever NaN.
#![expect(clippy::unwrap_used, reason = "a test")]

use diagnose::{
    Baseline, BaselineRecord, DiagnoseError, Diagnosis, FlightRecord, Input, LeftOutReason, Note,
    Options, Verdict, diagnose,
};
use effects::ExtendedModel;
use flight::effect::{EffectId, NeededInput};
use test_support::fleet::{Background, Fleet, Planted, Setup, exact_model, fly};

/// What the fleet recorded, as the diagnosis takes it.
fn records(fleet: &Fleet) -> Vec<FlightRecord<'_>> {
    fleet.flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect()
}

fn run(model: &ExtendedModel, fleet: &Fleet) -> Diagnosis {
    let records = records(fleet);
    let input = Input::against(model, &records);
    let found = diagnose(&input, &Options { skip_closure: true, ..Options::default() }).unwrap();
    let text = format!("{found:?}");
    let mut words = text.split(|c: char| !c.is_alphanumeric());
    assert!(words.all(|word| word != "NaN" && word != "inf"), "{text}");
    found
}

fn is_insufficient(found: &Diagnosis) -> bool {
    matches!(found.verdict, Verdict::InsufficientData(_))
}

fn planted() -> Vec<Planted> {
    vec![Planted { id: EffectId::ZeroLiftDrag, size: 5.0 }]
}

fn small(flights: usize, segments: usize) -> Fleet {
    fly(11, &Setup { flights, segments, ..Setup::default() }, &planted(), &Background::default())
}

#[test]
fn too_few_flights_or_segments() {
    let model = exact_model();
    for (flights, segments) in [(1, 10), (1, 3), (3, 1), (5, 20), (6, 4)] {
        let found = run(&model, &small(flights, segments));
        assert!(is_insufficient(&found), "{flights} × {segments}: {:?}", found.verdict);
        assert!(found.causes.is_empty());
    }
}

#[test]
fn all_at_one_condition() {
    let model = exact_model();
    let mut fleet = small(20, 5);
    let one = fleet.flights[0][0].means.clone();
    for segment in fleet.flights.iter_mut().flatten() {
        segment.means = one.clone();
    }
    let found = run(&model, &fleet);
    assert!(is_insufficient(&found), "{:?}", found.verdict);
}

#[test]
fn outside_the_table_nothing_is_used_and_the_reason_is_kept() {
    let model = exact_model();
    let mut fleet = small(20, 5);
    for segment in fleet.flights.iter_mut().flatten() {
        segment.means.mass_kg *= 4.0; // the reports of a larger type
    }
    assert!(is_insufficient(&run(&model, &fleet)));

    let mut fleet = small(60, 5);
    for segment in fleet.flights.iter_mut().take(20).flatten() {
        segment.means.mass_kg *= 4.0;
    }
    let found = run(&model, &fleet);
    let outside = found.left_out.get(&LeftOutReason::OutsideTable);
    assert_eq!(outside, Some(&100), "{:?}", found.left_out);
    assert_eq!(found.flights, 40);
}

#[test]
fn missing_optional_columns_are_said_and_the_rest_is_found() {
    let model = exact_model();
    let mut fleet = small(60, 10);
    for means in fleet.flights.iter_mut().flatten().map(|segment| &mut segment.means) {
        means.fuel_flow_engine_kg_s.clear();
        means.n2_percent.clear();
        means.roll_deg = None;
        means.roll_squared_deg2 = None;
        means.drift_deg = None;
        means.latitude_deg = None;
        means.true_heading_deg = None;
        means.center_of_gravity_percent_mac = None;
    }
    let found = run(&model, &fleet);
    let lacking: Vec<EffectId> = found.not_testable.iter().map(|n| n.effect).collect();
    for effect in [
        EffectId::TrimDragCg,
        EffectId::AsymmetryDrag,
        EffectId::LoadFactor,
        EffectId::TsfcEngine(1),
        EffectId::IsobaricSlope,
    ] {
        assert!(lacking.contains(&effect), "{effect} in {lacking:?}");
    }
    assert!(found.verdict.class().contains(&EffectId::ZeroLiftDrag), "{:?}", found.verdict);
}

/// What is recorded is not named among what is missing.
#[test]
fn needed_inputs_are_those_that_are_missing() {
    let model = exact_model();
    let mut fleet = small(60, 10);
    for means in fleet.flights.iter_mut().flatten().map(|segment| &mut segment.means) {
        means.latitude_deg = None;
    }
    let found = run(&model, &fleet);
    let earth = found.not_testable.iter().find(|entry| entry.effect == EffectId::RotatingEarth);
    assert_eq!(earth.unwrap().needs, [NeededInput::Latitude]);
}

/// Of a temperature that nobody recorded nothing can be learnt, and anti-ice bleed that is not recorded is said to be guessed.
#[test]
fn what_stands_for_a_recording_is_said() {
    let model = exact_model();
    let mut fleet = small(60, 10);
    for (flight, segments) in fleet.flights.iter_mut().enumerate() {
        for segment in segments {
            segment.temperature_assumed = true;
            segment.means.anti_ice = (flight % 2 == 0).then_some(0.0);
        }
    }
    let found = run(&model, &fleet);
    let lacking: Vec<EffectId> = found.not_testable.iter().map(|n| n.effect).collect();
    assert_eq!(lacking, [EffectId::TsfcTemperatureExponent, EffectId::TemperatureBias]);
    for entry in &found.not_testable {
        assert_eq!(entry.needs, [NeededInput::StaticAirTemperature]);
    }
    let note = Note::AntiIceByTemperature { segments: 300, of_segments: 600 };
    assert!(found.notes.contains(&note), "{:?}", found.notes);

    for segment in fleet.flights.iter_mut().flatten() {
        segment.temperature_assumed = false;
        segment.means.anti_ice = Some(0.0);
    }
    let found = run(&model, &fleet);
    assert!(found.not_testable.is_empty(), "{:?}", found.not_testable);
    let is_guessed = |note: &&Note| matches!(note, Note::AntiIceByTemperature { .. });
    assert_eq!(found.notes.iter().find(is_guessed), None);
}

#[test]
fn numbers_that_are_none_are_left_out() {
    let model = exact_model();
    let mut fleet = small(60, 5);
    fleet.flights[3][2].means.mach = f64::NAN;
    fleet.flights[4][1].means.static_air_temperature_k = f64::INFINITY;
    fleet.flights[5][0].means.fuel_flow_total_kg_s = f64::NAN;
    fleet.flights[6][0].means.fuel_flow_total_kg_s = 0.0;
    fleet.flights[7][0].means.mass_kg = -1.0;
    let found = run(&model, &fleet);
    assert_eq!(found.segments, 295);
    assert_eq!(found.left_out.values().sum::<usize>(), 5, "{:?}", found.left_out);
}

#[test]
fn a_baseline_of_nothing_is_refused() {
    let model = exact_model();
    let mut fleet = fly(13, &Setup { flights: 2, ..Setup::default() }, &[], &Background::default());
    for segment in fleet.flights.iter_mut().flatten() {
        segment.means.fuel_flow_total_kg_s = 0.0;
    }
    let learn = Baseline::learn(&model, model.drag_table(), None, &records(&fleet), None);
    assert_eq!(learn.unwrap_err(), DiagnoseError::NoFlights);
}

#[test]
fn a_baseline_reads_back_to_the_same_bits() {
    let model = exact_model();
    let fleet = fly(12, &Setup { flights: 20, ..Setup::default() }, &[], &Background::default());
    let records = records(&fleet);
    let taught = Baseline::learn(&model, model.drag_table(), None, &records, None).unwrap();
    let text = ron::to_string(taught.record()).unwrap();
    let read = |text: &str| {
        ron::from_str::<BaselineRecord>(text).map(|record| Baseline::new(record, None))
    };
    assert_eq!(read(&text).unwrap().unwrap(), taught);
    assert!(read(&text.replacen("mean:[", "mean:[1.0,", 1)).unwrap().is_err());
    assert!(read(&text.replacen("length:", "length:-", 1)).is_err());
    // The first number of a field, changed by hand.
    let with = |field: &str, value: &str| {
        let start = text.find(&format!("{field}:")).unwrap() + field.len() + 1;
        let start = start + text[start..].find(|sign: char| !"([".contains(sign)).unwrap();
        let end = start + text[start..].find([',', ')', ']']).unwrap();
        read(&format!("{}{value}{}", &text[..start], &text[end..]))
    };
    // Fuel flow and N2 may be seen to err the other way round than is stated.
    assert!(with("fuel_flow_with_n2", "-0.1").unwrap().is_ok());
    assert!((with("rms", "0.01").unwrap().unwrap().remaining_rms() - 0.01).abs() < 1e-15);
    for (field, value) in [
        ("contrasts", "18446744073709551615"),
        ("scales", "NaN"),
        ("scales", "0.0"),
        ("mean", "NaN"),
        ("factor", "inf"),
        ("within", "-1.0"),
        ("interval_factor", "0.0"),
        ("thrust_share", "NaN"),
        ("fuel_flow_with_n2", "NaN"),
    ] {
        let error = with(field, value).unwrap().expect_err(field).to_string();
        assert!(error.contains("expected"), "{field}: {error}");
    }
    let with_guide =
        |reach: &str| read(&text.replacen("count:", &format!("guide:{reach},count:"), 1));
    assert!(with_guide("(0.5,0.0)").is_ok() && with_guide("(0.5,-30.0)").is_err());
}

/// What one to eight flights show of noise may be anything: a file that learning has written is one that can be read.
#[test]
fn what_few_flights_teach_reads_back() {
    let model = exact_model();
    let mut taught_of = 0;
    for seed in 100..140 {
        let setup = Setup { flights: 1 + (seed % 8) as usize, ..Setup::default() };
        let fleet = fly(seed, &setup, &[], &Background::default());
        let learnt = Baseline::learn(&model, model.drag_table(), None, &records(&fleet), None);
        let Ok(taught) = learnt else { continue };
        let text = ron::to_string(taught.record()).unwrap();
        taught_of += 1;
        let record = ron::from_str::<BaselineRecord>(&text).unwrap();
        assert_eq!(Baseline::new(record, None).as_ref(), Ok(&taught), "seed {seed}");
    }
    assert!(taught_of >= 35, "{taught_of}");
}

#[test]
fn same_input_same_bytes() {
    let model = exact_model();
    let fleet = small(30, 6);
    let once = format!("{:?}", run(&model, &fleet));
    let twice = format!("{:?}", run(&model, &fleet));
    assert_eq!(once, twice);
}
