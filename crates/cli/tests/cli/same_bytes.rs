//! Same input, same bytes: whatever the number of threads, the order of arguments, or the number of runs.

use std::path::PathBuf;

use crate::support::{adapt, bytes_below, fixture, initial_model};

fn reports() -> Vec<PathBuf> {
    (1..=12).map(|flight| fixture(&format!("reports/{flight:04}.txt"))).collect()
}

#[test]
fn threads_and_order_of_arguments() {
    for law in ["bayes", "paper"] {
        threads_and_order(law);
    }
}

fn threads_and_order(law: &str) {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let one = scratch.path().join("one");
    adapt(&model, &one, &reports(), &["--law", law, "--threads", "1"]).expect(0);
    let expected = bytes_below(&one);
    assert!(expected.contains_key("models/SIM-01.ron"), "{:?}", expected.keys());
    for threads in ["2", "8"] {
        let mut turned = reports();
        turned.reverse();
        turned.rotate_left(5);
        let output = scratch.path().join(threads);
        adapt(&model, &output, &turned, &["--law", law, "--threads", threads]).expect(0);
        assert_eq!(bytes_below(&output), expected, "{threads} threads");
    }
    let folder = scratch.path().join("folder");
    adapt(&model, &folder, &[fixture("reports")], &["--law", law]).expect(0);
    assert_eq!(bytes_below(&folder), expected, "a folder instead of files");
}

/// Flights are learnt in the order of START, whatever their files are called: names in the opposite order give the same state.
#[test]
fn the_order_of_flying_counts_not_that_of_names() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let turned = scratch.path().join("turned");
    std::fs::create_dir(&turned).unwrap();
    for (place, report) in reports().iter().rev().enumerate() {
        std::fs::copy(report, turned.join(format!("{place:04}.txt"))).unwrap();
    }
    for law in ["bayes", "paper"] {
        let (one, other) = (scratch.path().join(law), scratch.path().join(format!("{law}-turned")));
        adapt(&model, &one, &[fixture("reports")], &["--law", law]).expect(0);
        adapt(&model, &other, std::slice::from_ref(&turned), &["--law", law]).expect(0);
        let (one, other) = (bytes_below(&one), bytes_below(&other));
        for name in ["models/SIM-01.ron", "segments/SIM-01.csv", "flights/SIM-01.csv"] {
            assert_eq!(one[name], other[name], "law {law}, {name}");
        }
    }
}

#[test]
fn two_runs_learn_what_one_learns() {
    for law in ["bayes", "paper"] {
        two_runs(law);
    }
}

fn two_runs(law: &str) {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let whole = scratch.path().join("whole");
    adapt(&model, &whole, &reports(), &["--law", law]).expect(0);
    let parts = scratch.path().join("parts");
    adapt(&model, &parts, &reports()[..5], &["--law", law]).expect(0);
    // The second batch repeats two flights: they are known, and change nothing.
    adapt(&model, &parts, &reports()[3..], &["--law", law]).expect(0);
    let (whole, parts) = (bytes_below(&whole), bytes_below(&parts));
    for name in ["models/SIM-01.ron", "segments/SIM-01.csv", "deviations/SIM-01.csv"] {
        assert!(whole[name] == parts[name], "{name}");
    }
}

/// One report a night, or all of them at once: the posterior over all of them is the same.
#[test]
fn every_night_learns_what_one_run_learns() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (whole, nights) = (scratch.path().join("whole"), scratch.path().join("nights"));
    adapt(&model, &whole, &reports(), &[]).expect(0);
    for report in reports() {
        adapt(&model, &nights, &[report], &[]).expect(0);
    }
    let (whole, nights) = (bytes_below(&whole), bytes_below(&nights));
    let text = String::from_utf8_lossy(&whole["models/SIM-01.ron"]);
    assert!(text.contains("drag_nodes"), "twelve flights teach more than the table");
    for folder in ["models", "segments", "flights", "deviations"] {
        let name = format!("{folder}/SIM-01.{}", if folder == "models" { "ron" } else { "csv" });
        assert!(whole[&name] == nights[&name], "{name}");
    }
}

/// What a tail keeps, in memory and on disk, does not grow with its table: a legal one of 301 × 301 nodes is learnt in seconds.
#[test]
fn a_table_of_ninety_thousand_nodes_is_learnt() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let aircraft = std::fs::read_to_string(fixture("AIRCRAFT.ron")).unwrap();
    let start = aircraft.find("table:").unwrap();
    let fine = "table: (lift_coefficient: (0.10, 0.70, 0.002), mach: (0.50, 0.95, 0.0015)),\n)\n";
    std::fs::write(folder.join("AIRCRAFT.ron"), format!("{}{fine}", &aircraft[..start])).unwrap();
    let model = folder.join("FINE.ron");
    let guide = fixture("guide.csv");
    let (aircraft, output) = (folder.join("AIRCRAFT.ron"), folder.join("out"));
    let words: [&std::ffi::OsStr; 7] = [
        "init".as_ref(),
        "--aircraft".as_ref(),
        aircraft.as_ref(),
        "--guide".as_ref(),
        guide.as_ref(),
        "-o".as_ref(),
        model.as_ref(),
    ];
    crate::support::cruisefit(&words).expect(0);
    adapt(&model, &output, &reports(), &[]).expect(0);
    let learnt = std::fs::read_to_string(output.join("models/SIM-01.ron")).unwrap();
    assert!(learnt.contains("thinned: true") && learnt.contains("drag_nodes"));
}
