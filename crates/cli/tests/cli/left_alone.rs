//! What commands leave alone: files that they did not make, what a folder has learnt, and flights beside one that is wrong.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use crate::check::unit;
use crate::support::{Ran, adapt, bytes_below, cruisefit, fixture, init, initial_model};

fn report(flight: u32) -> PathBuf {
    fixture(&format!("reports/{flight:04}.txt"))
}

fn run<'a>(words: &[&'a (impl AsRef<OsStr> + ?Sized + 'a)]) -> Ran {
    cruisefit(words)
}

fn taught(scratch: &Path, reports: &[PathBuf]) -> (PathBuf, PathBuf) {
    let (model, output) = (initial_model(scratch), scratch.join("out"));
    adapt(&model, &output, reports, &[]).expect(0);
    (model, output)
}

/// A flow in another unit made the flights after it wait, and was learnt itself once these were many enough.
#[test]
fn one_flight_in_another_unit_costs_itself() {
    let scratch = tempfile::tempdir().unwrap();
    let known: Vec<PathBuf> = (1..=3).map(report).collect();
    let (model, output) = taught(scratch.path(), &known);
    let text = std::fs::read_to_string(report(4)).unwrap();
    let wrong = scratch.path().join("0004.txt");
    std::fs::write(&wrong, unit(&text, "WF", "kg/h")).unwrap();
    for night in 5..=8 {
        let mut reports = known.clone();
        reports.push(wrong.clone());
        reports.extend((5..=night).map(report));
        let ran = adapt(&model, &output, &reports, &[]).expect(1);
        ran.says("0004.txt").says("other flights of the tail");
        let learnt = std::fs::read_to_string(output.join("flights/SIM-01.csv")).unwrap();
        assert_eq!(learnt.lines().count(), 1 + 3 + (5..=night).count(), "{learnt}");
    }
    // The same flights at once, in whatever split of nights.
    let at_once = scratch.path().join("at_once");
    let mut all: Vec<PathBuf> = (1..=3).chain(5..=8).map(report).collect();
    all.push(wrong);
    adapt(&model, &at_once, &all, &[]).expect(1).says("other flights of the tail");
    let model_of = |folder: &Path| std::fs::read(folder.join("models/SIM-01.ron")).unwrap();
    assert!(model_of(&output) == model_of(&at_once), "the split of nights shows");
}

#[test]
fn what_a_folder_has_learnt_is_replaced_by_adapt_alone() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = taught(scratch.path(), &[report(1), report(2)]);
    let learnt = output.join("models/SIM-01.ron");
    let before = bytes_below(&output);
    let said = "part of what a folder has learnt";
    let (force, to) = (OsStr::new("--force"), OsStr::new("-o"));
    let other = scratch.path().join("other");
    adapt(&model, &other, &[report(3)], &[]).expect(0);
    let second = other.join("models/SIM-01.ron");
    let words = [OsStr::new("merge"), learnt.as_os_str(), second.as_os_str(), to];
    cruisefit(&[&words[..], &[learnt.as_os_str(), force]].concat()).expect(2).says(said);
    init(&output.join("STATE.ron"), &[force]).expect(2).says(said);
    init(&learnt, &[force]).expect(2).says(said);
    // Of a table that is exact the named effect is applied.
    let aircraft = scratch.path().join("AIRCRAFT.ron");
    let text = std::fs::read_to_string(fixture("AIRCRAFT.ron")).unwrap();
    let exact = text.replacen("    table:", "    table_uncertainty_percent: 0,\n    table:", 1);
    std::fs::write(&aircraft, exact).unwrap();
    let exact = scratch.path().join("EXACT.ron");
    let (guide, reports) = (fixture("guide.csv"), fixture("reports"));
    let [guide, reports, aircraft, exact] =
        [&guide, &reports, &aircraft, &exact].map(|path| path.to_str().unwrap());
    run(&["init", "--aircraft", aircraft, "--guide", guide, "-o", exact]).expect(0);
    let models = output.join("models");
    let found = scratch.path().join("found");
    let words = ["diagnose", reports, "--model", exact, "-o", found.to_str().unwrap(), "--apply"];
    let effects = [models.to_str().unwrap(), "--effects", "zero_lift_drag"];
    run(&[&words[..], &effects].concat()).expect(2).says(said);
    assert_eq!(bytes_below(&output), before);
}

/// The flag of one early night, before a remainder could be learnt, decided of the tail for good.
#[test]
fn a_folder_that_is_to_learn_more_than_the_table_goes_on_so() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = taught(scratch.path(), &[report(1), report(2)]);
    let before = bytes_below(&output);
    adapt(&model, &output, &[report(3)], &["--no-remainder"])
        .expect(2)
        .says("more than the table was learnt, which --no-remainder would drop");
    assert_eq!(bytes_below(&output), before);
}

/// A revised book makes every new tail look better or worse than the others by the revision.
#[test]
fn a_new_tail_with_another_book_is_named() {
    let scratch = tempfile::tempdir().unwrap();
    let (_, output) = taught(scratch.path(), &[report(1), report(2)]);
    let text = std::fs::read_to_string(fixture("guide.csv")).unwrap();
    let guide = scratch.path().join("guide.csv");
    // The last row left out.
    std::fs::write(&guide, text.trim_end().rsplit_once('\n').unwrap().0).unwrap();
    let revised = scratch.path().join("REVISED.ron");
    let aircraft = fixture("AIRCRAFT.ron");
    let words = [
        OsStr::new("init"),
        OsStr::new("--aircraft"),
        aircraft.as_os_str(),
        OsStr::new("--guide"),
        guide.as_os_str(),
        OsStr::new("-o"),
        revised.as_os_str(),
    ];
    cruisefit(&words).expect(0);
    let other = scratch.path().join("other.txt");
    let report = std::fs::read_to_string(report(3)).unwrap();
    std::fs::write(&other, report.replace("SIM-01", "SIM-02")).unwrap();
    adapt(&revised, &output, &[other], &[])
        .expect(0)
        .says("tail SIM-02 begins with another initial model than tail SIM-01 of its type");
}

#[test]
fn reports_are_not_moved_away_with_the_folder_that_they_lie_in() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let reports = scratch.path().join("reports");
    std::fs::create_dir(&reports).unwrap();
    std::fs::copy(report(1), reports.join("0001.txt")).unwrap();
    adapt(&model, &reports, std::slice::from_ref(&reports), &["--restart"])
        .expect(2)
        .says("would be moved out of the way");
    assert!(reports.join("0001.txt").exists());
    adapt(&model, &reports, std::slice::from_ref(&reports), &[]).expect(0);
}

/// JSON and page of a new diagnosis beside the table of another program: two results in one folder.
#[test]
fn of_several_results_all_are_written_or_none() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("diagnosis");
    std::fs::create_dir(&output).unwrap();
    std::fs::write(output.join("gaps.csv"), "owner,notes\nme,mine\n").unwrap();
    let before = bytes_below(&output);
    let reports = fixture("reports");
    let words = ["diagnose", reports.to_str().unwrap(), "--model", model.to_str().unwrap(), "-o"];
    let words = [&words[..], &[output.to_str().unwrap()]].concat();
    run(&words).expect(2).says("gaps.csv");
    assert_eq!(bytes_below(&output), before);
}

/// A run that was killed between its commit and the last move leaves the new model in the waiting folder.
#[test]
fn a_model_named_by_its_path_is_that_of_the_state() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = taught(scratch.path(), &[report(1)]);
    let old = std::fs::read(output.join("models/SIM-01.ron")).unwrap();
    adapt(&model, &output, &[report(2)], &[]).expect(0);
    let generation = std::fs::read_to_string(output.join("STATE.ron")).unwrap();
    let generation: String = generation
        .split_once("generation:")
        .unwrap()
        .1
        .trim_start()
        .chars()
        .take_while(char::is_ascii_digit)
        .collect();
    let waiting = output.join(format!(".cruisefit-next-{generation}"));
    std::fs::create_dir_all(waiting.join("models")).unwrap();
    std::fs::rename(output.join("models/SIM-01.ron"), waiting.join("models/SIM-01.ron")).unwrap();
    std::fs::write(output.join("models/SIM-01.ron"), old).unwrap();
    let path = output.join("models/SIM-01.ron");
    run(&["show", path.to_str().unwrap()]).expect(0).prints("2 flights");
}

#[test]
fn messages_name_what_was_found_and_expected() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = taught(scratch.path(), &[report(1)]);
    adapt(&model, &model, &[report(1)], &[]).expect(2).says("a folder was expected");
    let state = output.join("STATE.ron");
    run(&["monitor", state.to_str().unwrap()]).expect(2).says("a folder of `adapt` was expected");
    run(&["mapping", output.to_str().unwrap()]).expect(2).says("a file was expected");
    let first = report(1);
    run(&["mapping", first.to_str().unwrap()]).expect(2).says("read without a mapping");
    let words = ["optimum", "--model", model.to_str().unwrap(), "--isa-deviation", "-10,10"];
    run(&words).expect(0);
    let words = ["optimum", "--model", model.to_str().unwrap(), "--cost-index", "-5"];
    run(&words).expect(2).says("0 or more");
}
