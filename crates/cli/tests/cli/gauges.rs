//! Tank gauges that are learnt with the flights.

use std::path::{Path, PathBuf};

use crate::support::{adapt, cruisefit, csv_columns, fixture, initial_model};

/// A report of the fixture with tank gauges that read 1.5 % less burnt than the meters.
fn with_gauges(folder: &Path, flight: u32) -> PathBuf {
    let text = std::fs::read_to_string(fixture(&format!("reports/{flight:04}.txt"))).unwrap();
    let on_board: f64 = text
        .lines()
        .find_map(|line| line.strip_prefix("FOB"))
        .unwrap()
        .trim_end_matches("lb")
        .trim()
        .parse()
        .unwrap();
    let mut used_column = None;
    let line_of = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        if words.first() == Some(&"TIME") {
            used_column = words.iter().position(|word| *word == "FU");
            return format!("{line} FQ");
        }
        let Some(used) = used_column.and_then(|column| words.get(column)) else {
            return line.to_owned();
        };
        match used.parse::<f64>() {
            Ok(used_lb) => format!("{line} {:.1}", on_board - 0.985 * used_lb),
            Err(_) => format!("{line} lb"),
        }
    };
    let lines: Vec<String> = text.lines().map(line_of).collect();
    let path = folder.join(format!("{flight:04}.txt"));
    std::fs::write(&path, lines.join("\n") + "\n").unwrap();
    path
}

fn same_tail(one: &Path, other: &Path) {
    for name in ["models/SIM-01.ron", "flights/SIM-01.csv"] {
        let (one, other) = (std::fs::read(one.join(name)), std::fs::read(other.join(name)));
        assert_eq!(one.unwrap(), other.unwrap(), "{name}");
    }
}

/// What gauges show goes with the flight: by night or at once, and forgotten with it.
#[test]
fn what_gauges_show_is_kept_with_each_flight() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let reports: Vec<PathBuf> = (1..=8).map(|flight| with_gauges(scratch.path(), flight)).collect();
    let at = |name: &str| scratch.path().join(name);
    adapt(&model, &at("once"), &reports, &[]).expect(0);
    adapt(&model, &at("nights"), &reports[..5], &[]).expect(0);
    adapt(&model, &at("nights"), &reports[5..], &[]).expect(0);
    same_tail(&at("once"), &at("nights"));

    let table = csv_columns(&at("once").join("flights/SIM-01.csv"));
    let ratio = |row: usize| -> f64 {
        let number = |name: &str| table[name][row].parse::<f64>().unwrap();
        number("gauged_kg") / number("metered_kg")
    };
    for row in 0..8 {
        assert!((ratio(row) - 0.985).abs() < 2e-3, "row {row}: {}", ratio(row));
    }
    let learnt = at("once").join("models/SIM-01.ron");
    let shown = cruisefit(&["show".as_ref(), learnt.as_os_str()]).expect(0).stdout;
    // ln 0.985 = −1.51 %; nine tenths of what eight flights of 25 kg show against a belief of 1 %.
    let (_, told) = shown.split_once("tank gauges against the flow meters: ").unwrap();
    let percent: f64 = told.split_whitespace().next().unwrap().parse().unwrap();
    assert!((-1.55..-1.40).contains(&percent), "{shown}");

    let nights = at("nights");
    cruisefit(&["forget", nights.to_str().unwrap(), "--tail", "SIM-01", "--flight", "0003"])
        .expect(0);
    let others = [&reports[..2], &reports[3..]].concat();
    adapt(&model, &at("without"), &others, &[]).expect(0);
    same_tail(&nights, &at("without"));
}
