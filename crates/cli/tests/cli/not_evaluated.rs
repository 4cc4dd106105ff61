//! What cannot be judged for want of a recording is said, once, by every command that depends on it.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::json_schema::assert_held;
use crate::support::{adapt, cruisefit, fixture, initial_model};

const LINE: &str = "Trim criteria not evaluated for want of data: N2, DRIFT, ROLL in ";

fn document(path: &Path) -> Value {
    let document: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let schema =
        if document["schema"] == "cruisefit.check/1" { "check-1.json" } else { "summary-1.json" };
    assert_held(schema, &document);
    document
}

/// A report without rotor speeds, drift and roll angle.
fn without_channels(folder: &Path, flight: u32) -> PathBuf {
    let text = std::fs::read_to_string(fixture(&format!("reports/{flight:04}.txt"))).unwrap();
    let path = folder.join(format!("without-{flight}.txt"));
    std::fs::write(&path, text.replacen("TIME ", "MISSING N2 ROLL DRIFT\nTIME ", 1)).unwrap();
    path
}

fn whole(flight: u32) -> PathBuf {
    fixture(&format!("reports/{flight:04}.txt"))
}

fn run(command: &str, reports: &[PathBuf], more: &[&Path]) -> crate::support::Ran {
    let paths = reports.iter().map(PathBuf::as_path).chain(more.iter().copied());
    let words: Vec<&std::ffi::OsStr> =
        [command.as_ref()].into_iter().chain(paths.map(Path::as_os_str)).collect();
    cruisefit(&words).expect(0)
}

fn listed(flights: u32) -> Value {
    let one = |criterion| json!({"criterion": criterion, "flights": flights});
    json!([one("N2"), one("DRIFT"), one("ROLL")])
}

#[test]
fn adapt_and_evaluate_say_it_in_text_and_document() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    let summary = output.join("summary.json");
    let one = without_channels(scratch.path(), 1);
    adapt(&model, &output, &[one.clone(), whole(2)], &[])
        .expect(0)
        .prints(&format!("{LINE}1 of 2 flights."));
    assert_eq!(document(&summary)["tails"][0]["not_evaluated"], listed(1));
    // Flights of earlier nights count.
    let other = without_channels(scratch.path(), 3);
    let ran = adapt(&model, &output, std::slice::from_ref(&other), &[]).expect(0);
    ran.prints(&format!("{LINE}2 of 3 flights."));
    assert_eq!(ran.stdout.matches("not evaluated").count(), 1);
    assert_eq!(document(&summary)["tails"][0]["not_evaluated"], listed(2));

    let json = scratch.path().join("evaluated.json");
    let words = ["--model".as_ref(), model.as_path(), "--json".as_ref(), &json];
    let reports = [one, whole(2), other];
    run("evaluate", &reports, &words).prints(&format!("{LINE}2 of 3 flights."));
    assert_eq!(document(&json)["tails"][0]["not_evaluated"], listed(2));

    // Where nothing is missing nothing is said.
    let ran = run("evaluate", &[whole(1), whole(2)], &words);
    assert!(!ran.stdout.contains("not evaluated"), "{}", ran.stdout);
    assert_eq!(document(&json)["tails"][0].get("not_evaluated"), None);
}

#[test]
fn segment_says_it_without_an_explanation() {
    let scratch = tempfile::tempdir().unwrap();
    let csv = scratch.path().join("segments.csv");
    let reports = [without_channels(scratch.path(), 1), whole(2)];
    let said = format!("{LINE}1 of 2 flights.");
    run("segment", &reports, &["-o".as_ref(), &csv]).prints(&said);
    run("segment", &reports, &[]).says(&said);
    let ran = run("segment", &[whole(1)], &["-o".as_ref(), &csv]);
    assert!(!ran.stdout.contains("not evaluated"), "{}", ran.stdout);
}

#[test]
fn check_notes_it_once_for_each_tail() {
    let scratch = tempfile::tempdir().unwrap();
    let json = scratch.path().join("check.json");
    let reports = [without_channels(scratch.path(), 1), without_channels(scratch.path(), 2)];
    run("check", &reports, &["--json".as_ref(), &json]).prints("0 serious, 0 warnings, 1 note");
    let found = &document(&json)["findings"][0];
    let said = ["severity", "code", "flight"].map(|key| found[key].as_str().unwrap());
    assert_eq!(said, ["note", "not-evaluated", ""]);
    assert_eq!(found["size"], 2.0);
}
