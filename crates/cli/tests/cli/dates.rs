//! One wrong date among many, in a model whose knowledge ages.

use std::path::{Path, PathBuf};

use crate::support::{adapt, cruisefit, csv_columns, fixture, initial_model};

fn report(flight: u32) -> PathBuf {
    fixture(&format!("reports/{flight:04}.txt"))
}

/// An initial model that forgets half of what it knows in a year.
fn ageing_model(folder: &Path) -> PathBuf {
    let model = initial_model(folder);
    let aged = folder.join("AGED.ron");
    let reports = fixture("reports");
    let arguments = [
        "tune".as_ref(),
        reports.as_os_str(),
        "--model".as_ref(),
        model.as_os_str(),
        "--half-life".as_ref(),
        "365".as_ref(),
        "-o".as_ref(),
        aged.as_os_str(),
    ];
    cruisefit(&arguments).expect(0);
    aged
}

/// The fixture's twelve reports, of which the last one's START is of another year.
fn reports_with_the_last_of(folder: &Path, year: &str) -> Vec<PathBuf> {
    let text = std::fs::read_to_string(report(12)).unwrap();
    assert!(text.contains("START    2019-04-08"));
    let changed = folder.join("0012.txt");
    let new = text.replacen("START    2019-04-08", &format!("START    {year}-04-08"), 1);
    std::fs::write(&changed, new).unwrap();
    (1..12).map(report).chain([changed]).collect()
}

/// Effective number of observations at each node of the table that a folder holds.
fn confidence(folder: &Path) -> Vec<f64> {
    let table = folder.join("table.csv");
    let model = folder.join("models/SIM-01.ron");
    let arguments = ["export".as_ref(), model.as_os_str(), "-o".as_ref(), table.as_os_str()];
    cruisefit(&arguments).expect(0);
    csv_columns(&table)["confidence"].iter().map(|field| field.parse().unwrap()).collect()
}

#[test]
fn a_start_in_the_future_is_refused_and_forgets_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    let model = ageing_model(scratch.path());
    let eleven: Vec<PathBuf> = (1..12).map(report).collect();
    let (good, with_future) = (scratch.path().join("good"), scratch.path().join("future"));
    adapt(&model, &good, &eleven, &[]).expect(0);
    let reports = reports_with_the_last_of(scratch.path(), "2109");
    adapt(&model, &with_future, &reports, &[])
        .expect(1)
        .says("found START 2109-04-08T07:44:00Z, expected an instant before now");
    assert_eq!(confidence(&with_future), confidence(&good));
}

#[test]
fn a_start_that_stands_alone_ages_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    let model = ageing_model(scratch.path());
    let twelve: Vec<PathBuf> = (1..=12).map(report).collect();
    let (good, alone) = (scratch.path().join("good"), scratch.path().join("alone"));
    adapt(&model, &good, &twelve, &[]).expect(0);
    let reports = reports_with_the_last_of(scratch.path(), "2024");
    adapt(&model, &alone, &reports, &[])
        .expect(0)
        .says("no other flight of tail SIM-01 within 400 days")
        .says("as if flown on 2019-04-06T06:35:00Z");
    // Two days instead of five years: half a per cent of what is known, where the wrong date takes 97 %.
    for (wrong, right) in confidence(&alone).iter().zip(confidence(&good)) {
        assert!((wrong - right).abs() <= 0.005 * right, "{wrong} observations, {right} before");
    }
}

/// A pause of five years: the first flight after it stands alone until the second one confirms its date. The folder is then the one
/// that all reports at once make.
#[test]
fn a_date_that_a_later_flight_confirms_is_learnt_as_it_is() {
    let scratch = tempfile::tempdir().unwrap();
    let model = ageing_model(scratch.path());
    let after_the_pause = |flight: u32| {
        let moved = scratch.path().join(format!("{flight:04}.txt"));
        let text = std::fs::read_to_string(report(flight)).unwrap();
        std::fs::write(&moved, text.replacen("START    2019-", "START    2024-", 1)).unwrap();
        moved
    };
    let [first, second] = [6, 7].map(after_the_pause);
    let before: Vec<PathBuf> = (1..=5).map(report).collect();
    let (at_once, nights) = (scratch.path().join("once"), scratch.path().join("nights"));
    let all = [&before[..], &[first.clone(), second.clone()]].concat();
    adapt(&model, &at_once, &all, &[]).expect(0);
    adapt(&model, &nights, &before, &[]).expect(0);
    adapt(&model, &nights, &[first], &[]).expect(0).says("within 400 days");
    adapt(&model, &nights, &[second], &[]).expect(0);
    for name in ["models/SIM-01.ron", "flights/SIM-01.csv", "deviations/SIM-01.csv"] {
        let [one, other] = [&at_once, &nights].map(|folder| std::fs::read(folder.join(name)));
        assert_eq!(one.unwrap(), other.unwrap(), "{name}");
    }
}
