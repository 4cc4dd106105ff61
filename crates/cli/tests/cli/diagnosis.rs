//! `diagnose` from outside: what it refuses, and that too little data gets no name.

use std::path::{Path, PathBuf};

use crate::support::{adapt, cruisefit, diagnosis_document, fixture, initial_model};

fn reports(flights: std::ops::RangeInclusive<u32>) -> Vec<PathBuf> {
    flights.map(|flight| fixture(&format!("reports/{flight:04}.txt"))).collect()
}

fn diagnose(
    model: &Path,
    output: &Path,
    reports: &[PathBuf],
    more: &[&str],
) -> crate::support::Ran {
    let mut arguments: Vec<std::ffi::OsString> = vec!["diagnose".into()];
    arguments.extend(reports.iter().map(|path| path.as_os_str().to_owned()));
    arguments.extend(["--model".into(), model.as_os_str().to_owned()]);
    arguments.extend(["-o".into(), output.as_os_str().to_owned()]);
    arguments.extend(more.iter().map(Into::into));
    cruisefit(&arguments)
}

#[test]
fn flights_in_the_ledger_are_refused_by_name() {
    let scratch = tempfile::tempdir().unwrap();
    let initial = initial_model(scratch.path());
    let learnt = scratch.path().join("learnt");
    adapt(&initial, &learnt, &reports(1..=3), &[]).expect(0);
    let model = learnt.join("models/SIM-01.ron");
    let output = scratch.path().join("diagnosis");
    diagnose(&model, &output, &reports(1..=3), &[])
        .expect(2)
        .says("tail SIM-01 flight 0001 of 2019-03-14T10:45:00Z is in the model's ledger");
    assert!(!output.exists());
    // A night of them is a line: what is wrong is the same of all.
    let all = scratch.path().join("all");
    adapt(&initial, &all, &reports(1..=12), &[]).expect(0);
    let ran = diagnose(&all.join("models/SIM-01.ron"), &output, &reports(1..=12), &[]).expect(2);
    assert_eq!(ran.stderr.matches("is in the model's ledger").count(), 1, "{}", ran.stderr);
    ran.says("(and 11 more of tail SIM-01 like this)").says("the initial model of its type");
    // Asked for, they are used, and the output reports it.
    diagnose(&model, &output, &reports(1..=3), &["--allow-learnt"])
        .expect(0)
        .says("diagnosed anyway, as asked");
}

#[test]
fn too_little_data_gets_no_name() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("diagnosis");
    let ran = diagnose(&model, &output, &reports(1..=2), &[]).expect(0);
    assert!(ran.stdout.contains("insufficient data"), "{}", ran.stdout);
    let text = std::fs::read_to_string(output.join("diagnosis.json")).unwrap();
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    let document = diagnosis_document(&output);
    let diagnosis = &document["diagnoses"][0];
    assert_eq!(diagnosis["tail"], "SIM-01");
    assert_eq!(diagnosis["verdict"]["kind"], "insufficient_data");
    assert!(diagnosis["verdict"]["effects"].as_array().unwrap().is_empty());
    // Nothing was computed, and no number says that the model fits: not in the document, not in what prints it, not in a drawing.
    let gap = diagnosis["gap"].as_object().unwrap();
    assert_eq!(gap["detected"], false);
    for (name, value) in gap.iter().filter(|(name, _)| *name != "detected") {
        assert!(value.is_null(), "{name}: {value}");
    }
    let document = output.join("diagnosis.json");
    let shown = cruisefit(&["show".as_ref(), document.as_os_str()]).expect(0);
    assert!(shown.stdout.contains("Too little data: no gap was computed"), "{}", shown.stdout);
    let drawing = scratch.path().join("gap.svg");
    cruisefit(&["plot".as_ref(), document.as_os_str(), "-o".as_ref(), drawing.as_os_str()])
        .expect(2);
    assert!(output.join("diagnosis.html").exists());
}

#[test]
fn tails_with_events_and_no_flight_are_named_once() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let events = scratch.path().join("EVENTS.csv");
    let text = "date,tail,kind,note\n2019-03-20,SIM-01,wash,\n2019-03-20,SIM-77,wash,\n\
                2019-03-21,SIM-77,engine change,\n";
    std::fs::write(&events, text).unwrap();
    let output = scratch.path().join("diagnosis");
    let more = ["--events", events.to_str().unwrap()];
    let ran = diagnose(&model, &output, &reports(1..=2), &more).expect(0);
    assert_eq!(ran.stderr.matches("has events, but no flight").count(), 1, "{}", ran.stderr);
    assert!(ran.stderr.contains("SIM-77"), "{}", ran.stderr);
}

#[test]
fn unknown_effects_are_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("diagnosis");
    diagnose(&model, &output, &reports(1..=2), &["--without", "drag_faktor"])
        .expect(2)
        .says("no effect \"drag_faktor\"")
        .says("drag_factor");
}
