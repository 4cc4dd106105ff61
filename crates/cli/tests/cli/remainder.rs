//! `predict` with what a model has learnt in addition to its table.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::support::{adapt, bytes_below, cruisefit, csv_columns, fixture, initial_model, numbers};

/// Fleets that are flown.
const SEEDS: std::ops::Range<u32> = 11..15;
/// Flights of one virtual aircraft with the sensors, wind and scatter of the default, and with all that no table holds.
const PLAN: &str = r#"(seed: SEED, tails: [(tail: "V", flights: Designed((flights: 60)))])"#;

fn run(words: &[&dyn AsRef<std::ffi::OsStr>]) -> crate::support::Ran {
    let arguments: Vec<&std::ffi::OsStr> = words.iter().map(AsRef::as_ref).collect();
    cruisefit(&arguments)
}

/// Flight points of recorded segments; measured fuel flow is the recorded one less what accelerates the aircraft, by the
/// TSFC of the aircraft file: 0.3616 lb/(lbf h)·√θ·(1 + M)^1.25.
fn points_of(segments: &Path, points: &Path) {
    let columns = csv_columns(segments);
    let of = |name: &str| numbers(&columns, name);
    let (mass, altitude, mach) = (of("mass_kg"), of("pressure_altitude_m"), of("mach"));
    let (sat, acceleration) = (of("static_air_temperature_k"), of("acceleration_m_s2"));
    let flow = of("fuel_flow_kg_s");
    let mut text = "mass_kg,pressure_altitude_ft,mach,isa_deviation_c,fuel_flow_kg_h\n".to_owned();
    for k in 0..mass.len() {
        let isa = if altitude[k] < 11_000.0 { 288.15 - 0.0065 * altitude[k] } else { 216.65 };
        let tsfc =
            0.3616 / 3600.0 / 9.806_65 * (sat[k] / 288.15).sqrt() * (1.0 + mach[k]).powf(1.25);
        let level = flow[k] - mass[k] * acceleration[k] * tsfc;
        let _ = writeln!(
            text,
            "{},{},{},{},{}",
            mass[k],
            altitude[k] / 0.3048,
            mach[k],
            sat[k] - isa,
            3600.0 * level
        );
    }
    std::fs::write(points, text).unwrap();
}

fn rms(errors: impl Iterator<Item = f64>) -> f64 {
    let squares: Vec<f64> = errors.map(|error| error * error).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// Errors of predictions for flights that no model has seen, by the table alone and by the whole model, and the share of the
/// latter within their stated 95 %.
struct Judged {
    table_rms: f64,
    whole_rms: f64,
    covered: f64,
}

/// Thirty flights teach, thirty others judge.
fn judged(folder: &Path, initial: &Path, seed: u32) -> Judged {
    let at = |name: &str| folder.join(format!("{seed}-{name}"));
    std::fs::write(at("PLAN.ron"), PLAN.replace("SEED", &seed.to_string())).unwrap();
    run(&[&"simulate", &at("PLAN.ron"), &"-o", &at("flown")]).expect(0);
    let flown = at("flown").join("V");
    let reports: Vec<PathBuf> =
        bytes_below(&flown).into_keys().map(|name| flown.join(name)).collect();
    let (teaching, judging) = reports.split_at(30);
    adapt(initial, &at("out"), teaching, &[]).expect(0);
    let model = at("out").join("models/V.ron");
    let segments = at("segments.csv");
    let mut words: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&"segment", &"-o", &segments];
    words.extend(judging.iter().map(|path| path as &dyn AsRef<std::ffi::OsStr>));
    run(&words).expect(0);
    let points = at("points.csv");
    points_of(&segments, &points);

    let (with, table) = (at("with.csv"), at("table.csv"));
    let ran = run(&[&"predict", &"--model", &model, &points, &"-o", &with]);
    assert!(ran.stdout.contains("by all that the model has learnt"), "{}", ran.stdout);
    let bare = at("bare.csv");
    run(&[&"predict", &"--model", &model, &points, &"-o", &bare, &"--without-deviations"])
        .expect(0);
    let (mut whole, mut without) = (csv_columns(&with), csv_columns(&bare));
    let stated = whole.remove("fuel_flow_std_kg_s").unwrap();
    assert!(stated.iter().any(|deviation| !deviation.is_empty()));
    assert!(without.remove("fuel_flow_std_kg_s").unwrap().iter().all(String::is_empty));
    assert_eq!(whole, without);
    let ran = run(&[&"predict", &"--model", &model, &points, &"-o", &table, &"--table-only"]);
    assert!(!ran.stdout.contains("all that the model has learnt"), "{}", ran.stdout);
    let (with, table) = (csv_columns(&with), csv_columns(&table));
    assert!(!table.contains_key("remainder_percent"));
    let rows = with["remainder_percent"].len();
    let predicted = |row: &usize| !table["error_percent"][*row].is_empty();
    let known: Vec<usize> = (0..rows).filter(predicted).collect();
    assert!(known.iter().all(|&row| !with["remainder_percent"][row].is_empty()));
    let number = |text: &str| text.parse::<f64>().unwrap();
    let errors = |of: &std::collections::BTreeMap<String, Vec<String>>| {
        rms(known.iter().map(|&row| number(&of["error_percent"][row])))
    };
    let inside = |row: &&usize| {
        let relative =
            number(&with["fuel_flow_std_kg_s"][**row]) / number(&with["fuel_flow_kg_s"][**row]);
        number(&with["error_percent"][**row]).abs() < 196.0 * relative
    };
    let covered = known.iter().filter(inside).count() as f64 / known.len() as f64;
    Judged { table_rms: errors(&table), whole_rms: errors(&with), covered }
}

/// Segments of one flight err together, so that of thirty flights between 87 and 100 % lie inside (standard deviation 4 to 6 %
/// over fleets): four fleets tell whether intervals hold what they say, one does not.
#[test]
fn flights_that_no_model_has_seen_are_predicted_better_with_the_remainder() {
    let scratch = tempfile::tempdir().unwrap();
    let at = |name: &str| scratch.path().join(name);
    run(&[&"simulate", &"ghazi-2020", &"-o", &at("study")]).expect(0);
    let (aircraft, guide) = (at("study/AIRCRAFT.ron"), at("study/guide.csv"));
    let initial = at("MODEL.ron");
    run(&[&"init", &"--aircraft", &aircraft, &"--guide", &guide, &"-o", &initial]).expect(0);
    let mut covered = 0.0;
    for seed in SEEDS {
        let found = judged(scratch.path(), &initial, seed);
        let Judged { table_rms, whole_rms, .. } = found;
        assert!(whole_rms < 0.93 * table_rms, "{seed}: {whole_rms} of {table_rms}");
        covered += found.covered / f64::from(SEEDS.end - SEEDS.start);
    }
    // 95 % less one standard deviation of the mean of four fleets.
    assert!(covered > 0.925, "{covered}");
}

#[test]
fn a_model_without_a_remainder_has_no_column_of_it() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let ran = run(&[&"predict", &"--model", &model, &fixture("static.csv")]);
    assert!(ran.status < 2 && !ran.stdout.contains("remainder"), "{}", ran.stdout);
}
