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
    for name in ["models/SIM-01.ron", "segments/SIM-01.csv"] {
        assert_eq!(whole[name], parts[name], "{name}");
    }
}
