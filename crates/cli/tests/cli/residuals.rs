//! Residuals and fuel factors of `evaluate`.

use std::path::{Path, PathBuf};

use crate::support::{adapt, cruisefit, csv_columns, fixture, initial_model};

fn report(flight: u32) -> PathBuf {
    fixture(&format!("reports/{flight:04}.txt"))
}

fn evaluate(model: &Path, reports: &[PathBuf], option: &str, output: &Path) {
    let mut arguments: Vec<std::ffi::OsString> = vec!["evaluate".into()];
    arguments.extend(reports.iter().map(|path| path.as_os_str().to_owned()));
    arguments.extend(["--model".into(), model.as_os_str().to_owned()]);
    arguments.extend([option.into(), output.as_os_str().to_owned()]);
    cruisefit(&arguments).expect(0);
}

fn numbers(columns: &std::collections::BTreeMap<String, Vec<String>>, name: &str) -> Vec<f64> {
    columns[name].iter().map(|field| field.parse().unwrap()).collect()
}

/// The model before it learnt the third flight is the one that learnt the first two: both predict it alike.
#[test]
fn a_learnt_flight_is_predicted_by_the_model_before_it() {
    for law in ["bayes", "paper"] {
        let scratch = tempfile::tempdir().unwrap();
        let initial = initial_model(scratch.path());
        let (two, three) = (scratch.path().join("two"), scratch.path().join("three"));
        let reports: Vec<PathBuf> = (1..=3).map(report).collect();
        let options = ["--law", law, "--no-remainder"];
        adapt(&initial, &two, &reports[..2], &options).expect(0);
        adapt(&initial, &three, &reports, &options).expect(0);
        let (before, again) = (scratch.path().join("before.csv"), scratch.path().join("again.csv"));
        evaluate(&two.join("models/SIM-01.ron"), &reports[2..], "-o", &before);
        evaluate(&three.join("models/SIM-01.ron"), &reports, "-o", &again);
        let (before, again) = (csv_columns(&before), csv_columns(&again));
        assert!(before["predicted_by"].iter().all(|by| by == "not_learnt"));
        assert!(again["predicted_by"].iter().all(|by| by == "before_learning"));
        let third: Vec<usize> =
            (0..again["flight"].len()).filter(|row| again["flight"][*row] == "0003").collect();
        assert_eq!(third.len(), before["flight"].len());
        for name in ["error_percent", "predicted_fuel_flow_kg_s", "flight_mean_error_percent"] {
            let again: Vec<f64> = numbers(&again, name).split_off(third[0]);
            for (one, other) in numbers(&before, name).iter().zip(&again) {
                assert!(
                    (one - other).abs() < 1e-9 * one.abs().max(1.0),
                    "{law} {name}: {one} {other}"
                );
            }
        }
    }
}

/// Without the first report of the ledger nothing can be learnt again: the rows say that the model knows the flights.
#[test]
fn without_an_earlier_report_a_learnt_flight_says_so() {
    let scratch = tempfile::tempdir().unwrap();
    let initial = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let reports: Vec<PathBuf> = (1..=4).map(report).collect();
    adapt(&initial, &output, &reports[..3], &[]).expect(0);
    let table = scratch.path().join("residuals.csv");
    evaluate(&output.join("models/SIM-01.ron"), &reports[1..], "-o", &table);
    let columns = csv_columns(&table);
    for (flight, by) in columns["flight"].iter().zip(&columns["predicted_by"]) {
        assert_eq!(by, if flight == "0004" { "not_learnt" } else { "learnt" });
    }
}

/// Against the book whatever the model has learnt.
#[test]
fn fuel_factors_are_against_the_book() {
    let scratch = tempfile::tempdir().unwrap();
    let initial = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let reports: Vec<PathBuf> = (1..=4).map(report).collect();
    adapt(&initial, &output, &reports, &[]).expect(0);
    let [by_initial, by_learnt] =
        ["initial.csv", "learnt.csv"].map(|name| scratch.path().join(name));
    evaluate(&initial, &reports, "--fuel-factors", &by_initial);
    evaluate(&output.join("models/SIM-01.ron"), &reports, "--fuel-factors", &by_learnt);
    assert_eq!(std::fs::read(&by_initial).unwrap(), std::fs::read(&by_learnt).unwrap());
    // That the book is the guide: crates/pipeline/tests/pipeline/book.rs.
    let factors = csv_columns(&by_initial);
    assert_eq!(factors["condition"][0], "all");
    let factor = numbers(&factors, "fuel_factor_percent_of_predicted")[0];
    // By hand: 1.05 of predicted is 4.76 % of recorded.
    let error = numbers(&factors, "error_percent_of_recorded")[0];
    assert!((100.0 * factor / (100.0 + factor) - error).abs() < 1e-9, "{factor} {error}");
    let entered = numbers(&factors, "perf_factor_percent")[0];
    assert!(entered >= factor && entered - factor < 0.1);
    assert!(numbers(&factors, "error_percent_of_recorded")[0] < factor);
    assert!(numbers(&factors, "specific_range_deviation_percent")[0] < 0.0);
    // The summary of `adapt`, and with it the page, has the same.
    let summary = std::fs::read_to_string(output.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let stated = &summary["tails"][0]["fuel_factor_percent"];
    let stated = [&stated["value"], &stated["ci95"][0], &stated["ci95"][1]];
    let names =
        ["fuel_factor_percent_of_predicted", "fuel_factor_ci95_low", "fuel_factor_ci95_high"];
    for (stated, name) in stated.into_iter().zip(names) {
        let written: f64 = factors[name][0].parse().unwrap();
        assert!((stated.as_f64().unwrap() - written).abs() < 1e-9, "{name}: {stated} {written}");
    }
}

fn assert_coverage_is_the_share_inside(
    summary: &serde_json::Value,
    errors: &[f64],
    halves: &[f64],
) {
    let inside = errors.iter().zip(halves).filter(|(error, half)| error.abs() <= **half).count();
    let stated = summary["tails"][0]["interval95_coverage"].as_f64().unwrap();
    assert!((inside as f64 / errors.len() as f64 - stated).abs() < 1e-9, "{inside} {stated}");
}

/// How far the whole model expects to err: the share of errors within it is the coverage that the summary states; a flight's mean
/// is expected nearer than a lone segment of it, and not nearer than its segments' common part allows.
#[test]
fn residuals_state_how_far_the_whole_model_expects_to_err() {
    let scratch = tempfile::tempdir().unwrap();
    let initial = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let reports: Vec<PathBuf> = (1..=12).map(report).collect();
    adapt(&initial, &output, &reports[..8], &[]).expect(0);
    let model = output.join("models/SIM-01.ron");
    let (table, json) = (scratch.path().join("residuals.csv"), scratch.path().join("summary.json"));
    let mut arguments: Vec<std::ffi::OsString> = vec!["evaluate".into()];
    arguments.extend(reports[8..].iter().map(|path| path.as_os_str().to_owned()));
    for (option, path) in [("--model", &model), ("-o", &table), ("--json", &json)] {
        arguments.extend([option.into(), path.as_os_str().to_owned()]);
    }
    cruisefit(&arguments).expect(0);
    let columns = csv_columns(&table);
    let (errors, halves) =
        (numbers(&columns, "error_percent"), numbers(&columns, "error_half_width95_percent"));
    let flights = numbers(&columns, "flight_mean_half_width95_percent");
    let summary: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(&json).unwrap()).unwrap();
    crate::json_schema::assert_held("summary-1.json", &summary);
    assert_coverage_is_the_share_inside(&summary, &errors, &halves);
    for (flight, of_flight) in columns["flight"].iter().zip(&flights) {
        let of_segments = columns["flight"].iter().zip(&halves).filter(|(name, _)| *name == flight);
        let widest = of_segments.map(|(_, half)| *half).fold(0.0, f64::max);
        assert!(*of_flight > 0.0 && *of_flight <= widest + 1e-9, "{flight}: {of_flight} {widest}");
    }
    assert!(columns["beyond_flights"].iter().all(|flag| flag == "0" || flag == "1"));
    let beyond = columns["beyond_flights"].iter().filter(|flag| *flag == "1").count();
    assert!(beyond > 0);
    assert_eq!(summary["tails"][0]["beyond_flights"], beyond);
    evaluate(&initial, &reports[8..], "-o", &table);
    assert!(csv_columns(&table)["error_half_width95_percent"].iter().all(String::is_empty));
}

/// The share of errors within what a table alone states of each segment is the coverage of the summary.
#[test]
fn a_table_alone_states_how_far_it_expects_to_err() {
    let scratch = tempfile::tempdir().unwrap();
    let initial = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let reports: Vec<PathBuf> = (1..=12).map(report).collect();
    adapt(&initial, &output, &reports[..2], &["--no-remainder"]).expect(0);
    let model = output.join("models/SIM-01.ron");
    let (table, json) = (scratch.path().join("residuals.csv"), scratch.path().join("summary.json"));
    evaluate(&model, &reports[8..], "-o", &table);
    evaluate(&model, &reports[8..], "--json", &json);
    let columns = csv_columns(&table);
    let (errors, halves) =
        (numbers(&columns, "error_percent"), numbers(&columns, "error_half_width95_percent"));
    let summary: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(&json).unwrap()).unwrap();
    assert_coverage_is_the_share_inside(&summary, &errors, &halves);
    for unknown in ["beyond_flights", "flight_mean_half_width95_percent"] {
        assert!(columns[unknown].iter().all(String::is_empty), "{unknown}");
    }
}
