//! What a folder keeps, and what it refuses.

use std::path::{Path, PathBuf};

use crate::json_schema::assert_held;
use crate::support::{adapt, bytes_below, fixture, initial_model};

fn report(flight: u32) -> PathBuf {
    fixture(&format!("reports/{flight:04}.txt"))
}

fn changed_copy(folder: &Path, flight: u32, from: &str, to: &str) -> PathBuf {
    let text = std::fs::read_to_string(report(flight)).unwrap();
    assert!(text.contains(from));
    let path = folder.join(format!("changed-{flight}.txt"));
    std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
    path
}

fn summary(output: &Path) -> serde_json::Value {
    let bytes = std::fs::read(output.join("summary.json")).unwrap();
    let summary = serde_json::from_slice(&bytes).unwrap();
    assert_held("summary-1.json", &summary);
    summary
}

#[test]
fn known_flights_change_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[report(1), report(2)], &[]).expect(0);
    let before = bytes_below(&output);
    adapt(&model, &output, &[report(1), report(2)], &[]).expect(0);
    let after = bytes_below(&output);
    assert_eq!(before["models/SIM-01.ron"], after["models/SIM-01.ron"]);
    assert_eq!(before["segments/SIM-01.csv"], after["segments/SIM-01.csv"]);
    let summary = summary(&output);
    assert_eq!(summary["reports"]["already_known"], 2);
    assert_eq!(summary["reports"]["read"], 0);
    assert_eq!(summary["tails"][0]["flights"], 2);
    assert_eq!(summary["tails"][0]["flights_new"], 0);
}

#[test]
fn the_same_report_packed_is_the_same_report() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[report(1)], &[]).expect(0);
    let packed = scratch.path().join("0001.txt.gz");
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    std::io::Write::write_all(&mut encoder, &std::fs::read(report(1)).unwrap()).unwrap();
    std::fs::write(&packed, encoder.finish().unwrap()).unwrap();
    adapt(&model, &output, &[packed], &[]).expect(0);
    assert_eq!(summary(&output)["reports"]["already_known"], 1);
}

#[test]
fn the_same_flight_with_other_content_is_refused_by_name() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[report(1)], &[]).expect(0);
    let changed = changed_copy(scratch.path(), 1, "ZFW      52960 lb", "ZFW      52970 lb");
    adapt(&model, &output, std::slice::from_ref(&changed), &[]).expect(1).says(
        "tail SIM-01 flight 0001 of 2019-03-14T10:45:00Z is already known with different content",
    );
    // Within one batch too.
    let other = scratch.path().join("other");
    adapt(&model, &other, &[report(1), changed], &[]).expect(1);
    assert_eq!(summary(&other)["reports"]["refused"].as_array().unwrap().len(), 1);
}

#[test]
fn an_older_flight_is_learnt_with_a_warning_or_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[report(3)], &[]).expect(0);
    adapt(&model, &output, &[report(1)], &["--strict"]).expect(2).says("nothing was written");
    assert_eq!(summary(&output)["tails"][0]["flights"], 1);
    adapt(&model, &output, &[report(1)], &[])
        .expect(0)
        .says("is older than the newest one that tail SIM-01 has learnt");
    assert_eq!(summary(&output)["tails"][0]["flights"], 2);
}

#[test]
fn another_setting_or_initial_model_is_refused_unless_restarted() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[report(1)], &["--law", "paper"]).expect(0);
    let before = bytes_below(&output);
    adapt(&model, &output, &[report(2)], &[])
        .expect(2)
        .says("was started with another law or setting: law paper, threshold 5 %");
    adapt(&model, &output, &[report(2)], &["--law", "paper", "--threshold", "1"])
        .expect(2)
        .says("was started with another law or setting: law paper, threshold 5 %, criteria ghazi-2020-table-4 against law paper, threshold 1 %, criteria ghazi-2020-table-4");
    assert_eq!(bytes_below(&output), before);
    adapt(&model, &output, &[report(2)], &["--law", "paper", "--threshold", "1", "--restart"])
        .expect(0);
    assert_eq!(summary(&output)["tails"][0]["flights"], 1);
    assert_eq!(
        bytes_below(&scratch.path().join("out.1")),
        before,
        "the old folder is kept under another name"
    );

    // The same guide with one figure changed is another initial model.
    let guide = std::fs::read_to_string(fixture("guide.csv")).unwrap();
    let changed = scratch.path().join("guide.csv");
    std::fs::write(&changed, guide.replacen("54000,25000,446,4980", "54000,25000,446,4990", 1))
        .unwrap();
    let other = scratch.path().join("OTHER.ron");
    crate::support::cruisefit(&[
        "init".as_ref(),
        "--aircraft".as_ref(),
        fixture("AIRCRAFT.ron").as_os_str(),
        "--guide".as_ref(),
        changed.as_os_str(),
        "-o".as_ref(),
        other.as_os_str(),
    ])
    .expect(0);
    adapt(&other, &output, &[report(3)], &["--law", "paper", "--threshold", "1"])
        .expect(2)
        .says("was started with another initial model");
}

/// The name is that of the type, and says nothing of what differs.
#[test]
fn another_aircraft_file_is_refused_by_the_fields_that_differ() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[report(1)], &[]).expect(0);
    let text = std::fs::read_to_string(fixture("AIRCRAFT.ron")).unwrap();
    let guide = fixture("guide.csv");
    let changed = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let (aircraft, other) = (scratch.path().join("A.ron"), scratch.path().join("OTHER.ron"));
        std::fs::write(&aircraft, text.replacen(from, to, 1)).unwrap();
        let (aircraft, other) = (aircraft.to_str().unwrap(), other.to_str().unwrap());
        let guide = guide.to_str().unwrap();
        let words = ["init", "--aircraft", aircraft, "--guide", guide, "-o", other, "--force"];
        crate::support::cruisefit(&words.map(std::ffi::OsStr::new)).expect(0);
        adapt(Path::new(other), &output, &[report(2)], &[]).expect(2)
    };
    let said = "was started with another aircraft file: ";
    changed("0.657", "0.66").says(&format!(
        "{said}tsfc.static_lb_per_lbf_h: 0.657 against tsfc.static_lb_per_lbf_h: 0.66"
    ));
    changed("(0.50, 0.95, 0.05)", "(0.50, 0.94, 0.04)").says(&format!(
        "{said}table.mach: (0.5, 0.95, 0.05) against table.mach: (0.5, 0.94, 0.04)"
    ));
    changed("engines: 2,", "engines: 2, sensors: (mach: 0.002), drag_divergence_mach: 0.88,").says(
        &format!(
            "{said}sensors.mach: 0.001, no drag_divergence_mach against drag_divergence_mach: 0.88, sensors.mach: 0.002"
        ),
    );
}

/// A nightly line that lost the option would change what every prediction means.
#[test]
fn a_folder_of_the_table_alone_goes_on_so() {
    let scratch = tempfile::tempdir().unwrap();
    let (model, output) = (initial_model(scratch.path()), scratch.path().join("out"));
    adapt(&model, &output, &[report(1), report(2)], &["--no-remainder"]).expect(0);
    let before = bytes_below(&output);
    let said = "was started with another setting: the table alone was learnt, and more would be now; add --no-remainder";
    adapt(&model, &output, &[report(3)], &[]).expect(2).says(said);
    // A tail that is new has no setting of its own.
    let other_tail = changed_copy(scratch.path(), 4, "SIM-01", "SIM-02");
    adapt(&model, &output, std::slice::from_ref(&other_tail), &[]).expect(2).says(said);
    assert_eq!(bytes_below(&output), before);
    adapt(&model, &output, &[report(3), other_tail], &["--no-remainder"]).expect(0);
    let flights = ["--tail", "SIM-01", "--flight", "0003"];
    let words = [&["forget", output.to_str().unwrap()][..], &flights].concat();
    let words: Vec<&std::ffi::OsStr> = words.into_iter().map(std::ffi::OsStr::new).collect();
    crate::support::cruisefit(&words).expect(0);
    adapt(&model, &output, &[report(3)], &[]).expect(2).says(said);
    adapt(&model, &output, &[report(3)], &["--restart"]).expect(0);
    // Law paper has no remainder: the option makes no difference to it.
    let paper = scratch.path().join("paper");
    adapt(&model, &paper, &[report(1)], &["--law", "paper", "--no-remainder"]).expect(0);
    adapt(&model, &paper, &[report(2)], &["--law", "paper"]).expect(0);
}
