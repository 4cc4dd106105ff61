//! Flights learnt apart and put together, and flights that arrive in any order: what learning all of them at once gives.

use std::path::{Path, PathBuf};

use crate::check::column;
use crate::support::{
    Ran, adapt, bytes_below, cruisefit, csv_columns, fixture, initial_model, numbers,
};

fn reports(which: impl Fn(u32) -> bool) -> Vec<PathBuf> {
    let all = (1..=12).filter(|flight| which(*flight));
    all.map(|flight| fixture(&format!("reports/{flight:04}.txt"))).collect()
}

/// A folder that has learnt these flights; its model.
fn learn(scratch: &Path, name: &str, reports: &[PathBuf]) -> PathBuf {
    let output = scratch.join(name);
    adapt(&initial_model(scratch), &output, reports, &[]).expect(0);
    output.join("models/SIM-01.ron")
}

fn merge(models: &[&PathBuf], into: &Path) -> Ran {
    let mut words: Vec<&std::ffi::OsStr> = vec!["merge".as_ref()];
    words.extend(models.iter().map(|model| model.as_os_str()));
    words.extend(["-o".as_ref(), into.as_os_str()]);
    cruisefit(&words)
}

fn drag(model: &Path, scratch: &Path) -> Vec<f64> {
    let csv = scratch.join("table.csv");
    cruisefit(&["export".as_ref(), model.as_os_str(), "-o".as_ref(), csv.as_os_str()]).expect(0);
    numbers(&csv_columns(&csv), "drag_coefficient")
}

/// The oracle is one run over all flights: the merged model has its bytes, table and all that is learnt in addition.
#[test]
fn merged_models_are_the_model_of_all_flights() {
    let scratch = tempfile::tempdir().unwrap();
    let scratch = scratch.path();
    let learn = |name: &str, which: &dyn Fn(u32) -> bool| learn(scratch, name, &reports(which));
    let whole = std::fs::read_to_string(learn("whole", &|_| true)).unwrap();
    assert!(whole.contains("drag_nodes"), "twelve flights teach more than the table");
    let (first, second) = (learn("first", &|k| k <= 7), learn("second", &|k| k > 7));
    let (odd, even) = (learn("odd", &|k| k % 2 == 1), learn("even", &|k| k % 2 == 0));
    let thirds = [0, 1, 2].map(|rest| learn(&format!("third-{rest}"), &|k| k % 3 == rest));
    let cases: [&[&PathBuf]; 6] = [
        &[&first, &second],
        &[&second, &first],
        &[&odd, &even],
        &[&even, &odd],
        &[&thirds[0], &thirds[1], &thirds[2]],
        &[&thirds[2], &thirds[0], &thirds[1]],
    ];
    for (place, case) in cases.into_iter().enumerate() {
        let merged = scratch.join(format!("merged-{place}.ron"));
        merge(case, &merged).expect(0).prints("All flights were learnt again");
        assert_eq!(std::fs::read_to_string(merged).unwrap(), whole, "case {place}");
    }
    // A folder of one tail stands for its model.
    let merged = scratch.join("of-folders.ron");
    merge(&[&scratch.join("first"), &scratch.join("second/models")], &merged).expect(0);
    assert_eq!(std::fs::read_to_string(merged).unwrap(), whole);
    merge(&[&odd, &first], &scratch.join("twice.ron")).expect(2).says("it would count twice");
}

/// Without their segments the sums of two models are added: nearly the same table, whatever the order, and nothing more.
#[test]
fn models_out_of_their_folders_add_up() {
    let scratch = tempfile::tempdir().unwrap();
    let scratch = scratch.path();
    let whole = learn(scratch, "whole", &reports(|_| true));
    let alone = |name: &str, which: &dyn Fn(u32) -> bool| {
        let model = scratch.join(format!("{name}.ron"));
        std::fs::copy(learn(scratch, name, &reports(which)), &model).unwrap();
        model
    };
    let (first, second) = (alone("first", &|k| k <= 7), alone("second", &|k| k > 7));
    let (merged, turned) = (scratch.join("merged.ron"), scratch.join("turned.ron"));
    merge(&[&first, &second], &merged).expect(0).prints("the segments of");
    merge(&[&second, &first], &turned).expect(0);
    for (one, other) in drag(&merged, scratch).iter().zip(drag(&turned, scratch)) {
        assert!((one - other).abs() <= 1e-9 * other, "order: {one} {other}");
    }
    let thirds = [0, 1, 2].map(|rest| alone(&format!("third-{rest}"), &|k| k % 3 == rest));
    let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let texts = orders.map(|order| {
        let merged = scratch.join("thirds.ron");
        let _ = std::fs::remove_file(&merged);
        merge(&order.map(|k: usize| &thirds[k]), &merged).expect(0);
        std::fs::read_to_string(merged).unwrap()
    });
    for text in &texts[1..] {
        assert_eq!(text, &texts[0], "sums are rounded in the order of flying");
    }
    // Outlier weights are judged against what a model knows: the two halves know less than the whole.
    for (merged, whole) in drag(&merged, scratch).iter().zip(drag(&whole, scratch)) {
        assert!((merged - whole).abs() <= 3e-3 * whole, "{merged} {whole}");
    }
    assert!(!std::fs::read_to_string(&merged).unwrap().contains("drag_nodes"));
}

/// A night whose flights are older than those that were learnt: every flight is learnt in its place.
#[test]
fn nights_that_arrive_late_are_learnt_in_their_place() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (whole, late) = (scratch.path().join("whole"), scratch.path().join("late"));
    adapt(&model, &whole, &reports(|_| true), &[]).expect(0);
    adapt(&model, &late, &reports(|k| k % 3 == 0), &[]).expect(0);
    adapt(&model, &late, &reports(|k| k % 3 == 2), &[]).expect(0).says("is older than");
    adapt(&model, &late, &reports(|k| k % 3 == 1), &[]).expect(0);
    let (whole, late) = (bytes_below(&whole), bytes_below(&late));
    for folder in ["models", "segments", "flights", "deviations"] {
        let name = format!("{folder}/SIM-01.{}", if folder == "models" { "ron" } else { "csv" });
        assert!(whole[&name] == late[&name], "{name}");
    }
}

/// The same flights by two tails, of which one burns 3 % more: by hand, ln 1.03/√2 = 2.09 % of standard deviation. Halves of one tail
/// are not told.
#[test]
fn how_tails_that_are_merged_differ_is_told() {
    let scratch = tempfile::tempdir().unwrap();
    let scratch = scratch.path();
    let one = learn(scratch, "one", &reports(|_| true));
    let thirsty = scratch.join("thirsty");
    std::fs::create_dir(&thirsty).unwrap();
    for (place, report) in reports(|_| true).into_iter().enumerate() {
        let text = std::fs::read_to_string(report).unwrap().replace("SIM-01", "SIM-02");
        let text = column(&text, "WF", |flow| 1.03 * flow);
        std::fs::write(thirsty.join(format!("{place:04}.txt")), text).unwrap();
    }
    let output = scratch.join("other");
    adapt(&initial_model(scratch), &output, &[thirsty], &[]).expect(0);
    let other = output.join("models/SIM-02.ron");
    let told = merge(&[&one, &other], &scratch.join("both.ron")).expect(0).stderr;
    let (_, behind) = told.split_once("which differ by ").unwrap_or_else(|| panic!("{told}"));
    let percent: f64 = behind.split_once(" %").unwrap().0.parse().unwrap();
    assert!((percent - 2.09).abs() < 0.05, "{percent}");
    let halves = [|k: u32| k <= 6, |k: u32| k > 6].map(reports);
    let [first, second] = &halves;
    let (first, second) = (learn(scratch, "first", first), learn(scratch, "second", second));
    let told = merge(&[&first, &second], &scratch.join("whole.ron")).expect(0).stderr;
    assert!(!told.contains("differ by"), "{told}");
}
