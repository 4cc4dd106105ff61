//! Bad input: the message that a person gets, and that the rest continues.

use std::path::{Path, PathBuf};

use crate::json_schema::assert_held;
use crate::support::{Ran, adapt, bytes_below, cruisefit, fixture, initial_model};

/// Adapts to one good report and one bad one: the bad one is refused with this message, the good one is learnt.
fn refused_beside_a_good_one(name: &str, bytes: &[u8], words: &str) {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let bad = scratch.path().join(name);
    std::fs::write(&bad, bytes).unwrap();
    let output = scratch.path().join("out");
    let ran = adapt(&model, &output, &[bad.clone(), fixture("reports/0002.txt")], &[]).expect(1);
    ran.says(&format!("refused: {}", bad.display())).says(words);
    let summary: serde_json::Value =
        serde_json::from_slice(&std::fs::read(output.join("summary.json")).unwrap()).unwrap();
    assert_held("summary-1.json", &summary);
    assert_eq!(summary["reports"]["read"], 1);
    assert_eq!(summary["reports"]["refused"][0]["path"], bad.display().to_string());
    assert_eq!(summary["tails"][0]["flights"], 1);
    // Alone, nothing can be done; with --strict, nothing is.
    let alone = scratch.path().join("alone");
    adapt(&model, &alone, std::slice::from_ref(&bad), &[]).expect(2).says(words);
    let strict = scratch.path().join("strict");
    adapt(&model, &strict, &[bad, fixture("reports/0002.txt")], &["--strict"]).expect(2);
    assert!(!strict.exists(), "--strict writes nothing");
}

fn good() -> String {
    std::fs::read_to_string(fixture("reports/0001.txt")).unwrap()
}

fn with_line(line: usize, change: impl Fn(&str) -> String) -> Vec<u8> {
    let text = good();
    let lines: Vec<String> = text
        .lines()
        .enumerate()
        .map(|(i, l)| if i + 1 == line { change(l) } else { l.to_owned() })
        .collect();
    (lines.join("\n") + "\n").into_bytes()
}

#[test]
fn empty_folder() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let empty = scratch.path().join("empty");
    std::fs::create_dir(&empty).unwrap();
    std::fs::write(empty.join("notes.md"), "x").unwrap();
    adapt(&model, &scratch.path().join("out"), &[empty], &[])
        .expect(2)
        .says("no cruise report in")
        .says("1 other file skipped")
        .says("reports end in .txt, .rpt or .gz");
}

#[test]
fn unreadable_file() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    adapt(&model, &scratch.path().join("out"), &[PathBuf::from("/no/such/report.txt")], &[])
        .expect(2)
        .says("/no/such/report.txt: no such file or folder");
    // A folder named like a report cannot be read as a file, whoever asks.
    let odd = scratch.path().join("reports");
    std::fs::create_dir_all(odd.join("0000.txt")).unwrap();
    std::fs::copy(fixture("reports/0001.txt"), odd.join("0001.txt")).unwrap();
    adapt(&model, &scratch.path().join("out"), &[odd], &[]).expect(0);
}

#[test]
fn binary_file() {
    refused_beside_a_good_one(
        "photo.txt",
        &[0xff, 0xd8, 0xff, 0xe0, 0x00, 0x10],
        ":1:5: found byte 0x00",
    );
    refused_beside_a_good_one("nul.txt", b"CRUISE-REPORT 1\n\0\n", ":2:1: found byte 0x00");
    refused_beside_a_good_one("latin1.txt", b"CRUISE-REPORT 1\n# caf\xe9\n", ":2:6: ");
}

#[test]
fn truncated_gzip() {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    std::io::Write::write_all(&mut encoder, good().as_bytes()).unwrap();
    let packed = encoder.finish().unwrap();
    refused_beside_a_good_one("0001.txt.gz", &packed[..packed.len() / 2], "gzip");
}

#[test]
fn cut_off_last_line() {
    let text = good();
    let cut = &text[..text.trim_end().len() - 30];
    refused_beside_a_good_one("cut.txt", cut.as_bytes(), "fields");
}

#[test]
fn unknown_column() {
    let bytes = with_line(9, |line| line.replace("DRIFT", "SLIP"));
    refused_beside_a_good_one("column.txt", &bytes, ":9:");
    refused_beside_a_good_one("column.txt", &bytes, "\"SLIP\"");
}

#[test]
fn wrong_unit() {
    let bytes = with_line(10, |line| line.replacen("ft", "fathom", 1));
    refused_beside_a_good_one("unit.txt", &bytes, "\"fathom\"");
}

#[test]
fn not_a_number() {
    let bytes = with_line(12, |line| line.replacen("0.7665", "NaN", 1));
    refused_beside_a_good_one("nan.txt", &bytes, ":12:23: found \"NaN\"");
}

#[test]
fn time_going_back() {
    let bytes = with_line(13, |line| line.replacen("120", " 60", 1));
    refused_beside_a_good_one("time.txt", &bytes, ":13:");
}

#[test]
fn fuel_used_falling() {
    let bytes = with_line(14, |line| {
        let fields: Vec<&str> = line.split_whitespace().collect();
        line.replacen(fields[12], "2000", 1)
    });
    refused_beside_a_good_one("fuel.txt", &bytes, ":14:");
}

#[test]
fn another_aircraft_type() {
    let text = good().replace("global5000", "C750");
    refused_beside_a_good_one(
        "type.txt",
        text.as_bytes(),
        "found aircraft type \"C750\", expected \"global5000\"",
    );
}

#[test]
fn model_with_a_damaged_digit() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let text = std::fs::read_to_string(&model).unwrap();
    let place = text.find("drag_coefficient: [0.0").unwrap() + "drag_coefficient: [0.0".len();
    let mut bytes = text.into_bytes();
    bytes[place] = if bytes[place] == b'9' { b'1' } else { bytes[place] + 1 };
    std::fs::write(&model, &bytes).unwrap();
    let output = scratch.path().join("out");
    adapt(&model, &output, &[fixture("reports")], &[])
        .expect(2)
        .says("MODEL.ron: checksum")
        .says("was changed or damaged");
    cruisefit(&["show".as_ref(), model.as_os_str()]).expect(2);
    // Cut off, newer, and no model at all.
    let half = &bytes[..bytes.len() / 2];
    std::fs::write(&model, half).unwrap();
    cruisefit(&["show".as_ref(), model.as_os_str()]).expect(2).says("it is cut off");
    std::fs::write(&model, "(\n    format: 999,\n)\n").unwrap();
    cruisefit(&["show".as_ref(), model.as_os_str()]).expect(2).says("model format 999");
    cruisefit(&["show".as_ref(), fixture("guide.csv").as_os_str()])
        .expect(2)
        .says("not a model file");
}

fn init_with(guide: &Path, folder: &Path) -> Ran {
    cruisefit(&[
        "init".as_ref(),
        "--aircraft".as_ref(),
        fixture("AIRCRAFT.ron").as_os_str(),
        "--guide".as_ref(),
        guide.as_os_str(),
        "-o".as_ref(),
        folder.join("M.ron").as_os_str(),
    ])
}

#[test]
fn guide_with_one_altitude_and_one_weight_only() {
    let scratch = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(fixture("guide.csv")).unwrap();
    let guide = scratch.path().join("guide.csv");
    let mut lines = text.lines();
    let header = lines.next().unwrap();
    let one: Vec<&str> = lines.filter(|line| line.starts_with("54000,25000,")).collect();
    // Doubled, so that there are points enough: they still lie on one curve of (lift coefficient, Mach number).
    std::fs::write(&guide, format!("{header}\n{}\n{}\n", one.join("\n"), one.join("\n"))).unwrap();
    init_with(&guide, scratch.path()).expect(2).says("guide.csv");
    assert!(!scratch.path().join("M.ron").exists());
}

#[test]
fn guide_with_a_wrong_field() {
    let scratch = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(fixture("guide.csv")).unwrap();
    let guide = scratch.path().join("guide.csv");
    std::fs::write(&guide, text.replacen("54000,25000,446,4980", "54000,25000,fast,4980", 1))
        .unwrap();
    init_with(&guide, scratch.path()).expect(2).says("line 2").says("\"fast\"");
}

#[test]
fn output_folder_not_writable() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    // A file where a folder must be: refused for every user, also for one that may write anywhere.
    let output = scratch.path().join("out");
    std::fs::write(&output, "in the way").unwrap();
    adapt(&model, &output, &[fixture("reports")], &[]).expect(2).says("cannot be written");
    assert_eq!(bytes_below(scratch.path())["out"], b"in the way");
}

#[test]
fn threshold_that_is_none() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    adapt(
        &model,
        &scratch.path().join("o"),
        &[fixture("reports")],
        &["--law", "paper", "--threshold=-1"],
    )
    .expect(2)
    .says("--threshold");
    adapt(&model, &scratch.path().join("o"), &[fixture("reports")], &["--threshold", "5"])
        .expect(2)
        .says("law bayes has no threshold");
}
