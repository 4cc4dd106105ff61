//! A folder every night: nothing lost, nothing learnt twice, whatever happens to processes, files and copies.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use crate::json_schema::assert_held;
use crate::support::{Ran, adapt, bytes_below, cruisefit, fixture, initial_model};

fn report(flight: u32) -> PathBuf {
    fixture(&format!("reports/{flight:04}.txt"))
}

fn reports(flights: std::ops::RangeInclusive<u32>) -> Vec<PathBuf> {
    flights.map(report).collect()
}

/// A report with some words replaced.
fn changed(folder: &Path, flight: u32, name: &str, changes: &[(&str, &str)]) -> PathBuf {
    let mut text = std::fs::read_to_string(report(flight)).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

fn flights_of(output: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(output.join("flights/SIM-01.csv")).unwrap();
    text.lines().skip(1).map(|line| line.split(',').next().unwrap().to_owned()).collect()
}

fn summary(output: &Path) -> serde_json::Value {
    let bytes = std::fs::read(output.join("summary.json")).unwrap();
    let summary = serde_json::from_slice(&bytes).unwrap();
    assert_held("summary-1.json", &summary);
    summary
}

fn same_tail(one: &Path, other: &Path) {
    for name in ["models/SIM-01.ron", "segments/SIM-01.csv", "flights/SIM-01.csv"] {
        let (one, other) = (std::fs::read(one.join(name)), std::fs::read(other.join(name)));
        assert_eq!(one.unwrap(), other.unwrap(), "{name}");
    }
}

fn start(model: &Path, output: &Path, reports: &[PathBuf], more: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_cruisefit"))
        .arg("adapt")
        .args(reports)
        .arg("--model")
        .arg(model)
        .arg("-o")
        .arg(output)
        .args(more)
        .env_remove("RUST_LOG")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Its checksum is not that of a model: read as one, every healthy state was called damaged.
#[test]
fn the_state_of_a_folder_is_shown_as_one() {
    let folder = tempfile::tempdir().unwrap();
    let model = initial_model(folder.path());
    let output = folder.path().join("out");
    adapt(&model, &output, &[fixture("reports")], &[]).expect(0);
    let state = output.join("STATE.ron");
    let shown = cruisefit(&["show".as_ref(), state.as_os_str()]).expect(0).stdout;
    assert!(
        shown.starts_with("State of a folder that adapt keeps: generation 1, 1 tail, "),
        "{shown}"
    );
    assert!(shown.contains("models/SIM-01.ron"), "{shown}");
    let changed = std::fs::read_to_string(&state).unwrap().replacen("SIM-01", "SIM-02", 1);
    std::fs::write(&state, changed).unwrap();
    cruisefit(&["show".as_ref(), state.as_os_str()]).expect(2).says("STATE.ron");
}

#[test]
fn processes_at_once_lose_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    for processes in [2, 4, 8] {
        let output = scratch.path().join(format!("wait-{processes}"));
        let children: Vec<(u32, Child)> = (1..=processes)
            .map(|flight| (flight, start(&model, &output, &[report(flight)], &["--wait"])))
            .collect();
        for (flight, mut child) in children {
            assert!(child.wait().unwrap().success(), "flight {flight} of {processes}");
        }
        let mut flights = flights_of(&output);
        flights.sort();
        let expected: Vec<String> = (1..=processes).map(|flight| format!("{flight:04}")).collect();
        assert_eq!(flights, expected, "{processes} processes that wait");

        // Without --wait the later ones are refused: what was stored is what those with status 0 learnt.
        let output = scratch.path().join(format!("refuse-{processes}"));
        let children: Vec<(u32, Child)> = (1..=processes)
            .map(|flight| (flight, start(&model, &output, &[report(flight)], &[])))
            .collect();
        let mut expected = Vec::new();
        for (flight, mut child) in children {
            match child.wait().unwrap().code() {
                Some(0) => expected.push(format!("{flight:04}")),
                status => assert_eq!(status, Some(2)),
            }
        }
        let mut flights = flights_of(&output);
        flights.sort();
        assert_eq!(flights, expected, "{processes} processes that do not");
    }
}

#[test]
fn whoever_holds_the_folder_is_named() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[report(1)], &[]).expect(0);
    let before = bytes_below(&output);
    let lock = std::fs::File::create(output.join(".cruisefit-lock")).unwrap();
    lock.lock().unwrap();
    std::fs::write(output.join(".cruisefit-lock"), "process 77 on host").unwrap();
    adapt(&model, &output, &[report(2)], &[])
        .expect(2)
        .says("is being written by process 77 on host")
        .says("--wait");
    drop(lock);
    std::fs::remove_file(output.join(".cruisefit-lock")).unwrap();
    assert_eq!(bytes_below(&output), before);
}

#[test]
fn killed_at_any_moment_the_folder_is_one_that_a_run_passes_through() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (first, all) = (scratch.path().join("first"), scratch.path().join("all"));
    adapt(&model, &first, &reports(1..=5), &["--law", "paper"]).expect(0);
    adapt(&model, &all, &reports(1..=12), &["--law", "paper"]).expect(0);
    // The moments differ from run to run; they are printed, so that a failure can be looked at.
    for kill in 0..12_u64 {
        let output = scratch.path().join(format!("out-{kill}"));
        adapt(&model, &output, &reports(1..=5), &["--law", "paper"]).expect(0);
        let mut child = start(&model, &output, &reports(1..=12), &["--law", "paper"]);
        let moment = std::time::Duration::from_micros(500 + kill * 2_500);
        std::thread::sleep(moment);
        child.kill().unwrap();
        child.wait().unwrap();
        println!("killed after {moment:?}");
        let learnt = flights_of_state(&output);
        assert!(learnt == 5 || learnt == 12, "{learnt} flights after {moment:?}");
        adapt(&model, &output, &reports(1..=12), &["--law", "paper"]).expect(0);
        same_tail(&output, &all);
        let left: Vec<String> = bytes_below(&output).into_keys().collect();
        assert!(left.iter().all(|name| !name.contains(".cruisefit-")), "{left:?}");
    }
}

/// How many flights a reader of the folder finds: as `evaluate` reads the model.
fn flights_of_state(output: &Path) -> u64 {
    let ran = cruisefit(&[
        "evaluate".as_ref(),
        report(1).as_os_str(),
        "--model".as_ref(),
        output.as_os_str(),
    ]);
    ran.expect(0);
    let state = std::fs::read_to_string(output.join("STATE.ron")).unwrap();
    let (_, rest) = state.split_once("flights: ").unwrap();
    let rest = rest.rsplit_once("flights: ").map_or(rest, |(_, last)| last);
    rest.split(',').next().unwrap().trim().parse().unwrap()
}

#[cfg(unix)]
#[test]
fn signals_end_a_run_and_lose_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let all = scratch.path().join("all");
    adapt(&model, &all, &reports(1..=12), &[]).expect(0);
    for signal in ["INT", "TERM", "HUP"] {
        let output = scratch.path().join(signal);
        let mut child = start(&model, &output, &reports(1..=12), &[]);
        std::thread::sleep(std::time::Duration::from_millis(12));
        let _ = Command::new("kill").arg(format!("-{signal}")).arg(child.id().to_string()).status();
        child.wait().unwrap();
        adapt(&model, &output, &reports(1..=12), &[]).expect(0);
        same_tail(&output, &all);
    }
}

#[test]
fn a_copy_of_a_model_in_the_folder_is_no_state() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (output, whole) = (scratch.path().join("out"), scratch.path().join("whole"));
    adapt(&model, &output, &reports(1..=5), &[]).expect(0);
    for copy in ["SIM-01-backup.ron", "A.ron", "SIM-01 (1).ron", "zzz.ron"] {
        std::fs::copy(output.join("models/SIM-01.ron"), output.join("models").join(copy)).unwrap();
    }
    adapt(&model, &output, &reports(6..=10), &[]).expect(0);
    adapt(&model, &output, &[report(11)], &[])
        .expect(0)
        .says("SIM-01-backup.ron is ignored: STATE.ron does not name it");
    adapt(&model, &whole, &reports(1..=11), &[]).expect(0);
    same_tail(&output, &whole);
    // Neither is it to those who only read.
    let models = output.join("models");
    for given in [&output, &models] {
        cruisefit(&[
            "evaluate".as_ref(),
            report(12).as_os_str(),
            "--model".as_ref(),
            given.as_os_str(),
        ])
        .expect(0)
        .says("zzz.ron is ignored");
    }
}

#[test]
fn a_changed_digit_of_the_segments_is_noticed() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &reports(1..=5), &[]).expect(0);
    let path = output.join("segments/SIM-01.csv");
    let good = std::fs::read(&path).unwrap();
    let digits: Vec<usize> =
        (0..good.len()).filter(|place| good[*place].is_ascii_digit()).step_by(997).collect();
    assert!(digits.len() > 10);
    for place in digits {
        let mut bytes = good.clone();
        bytes[place] = if bytes[place] == b'9' { b'1' } else { bytes[place] + 1 };
        std::fs::write(&path, &bytes).unwrap();
        let before = bytes_below(&output);
        adapt(&model, &output, &[report(6)], &[])
            .expect(2)
            .says("tail SIM-01 is not touched")
            .says("it was changed or damaged");
        assert_eq!(bytes_below(&output), before);
    }
    // Put right, it goes on.
    std::fs::write(&path, &good).unwrap();
    adapt(&model, &output, &[report(6)], &[]).expect(0);
}

#[test]
fn a_damaged_or_long_tail_costs_itself_only() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let tail =
        |flight, name: &str, tail: &str| changed(scratch.path(), flight, name, &[("SIM-01", tail)]);
    let long = "L".repeat(300);
    adapt(&model, &output, &[tail(1, "a1.txt", "A"), tail(1, "b1.txt", "B")], &[]).expect(0);
    std::fs::write(output.join("models/A.ron"), "no model").unwrap();
    // Told in the night in which it is found, though nothing is new.
    adapt(&model, &output, &[tail(1, "b1.txt", "B")], &[])
        .expect(1)
        .says("models/A.ron: tail A is not on the page: its SHA-256 is not that of STATE.ron");
    let next = [tail(2, "a2.txt", "A"), tail(2, "b2.txt", "B"), tail(2, "l2.txt", &long)];
    adapt(&model, &output, &next, &[])
        .expect(1)
        .says("a2.txt: tail A is not touched")
        .says("models/A.ron: its SHA-256 is not that of STATE.ron");
    let tails = summary(&output)["tails"].as_array().unwrap().clone();
    let flights: Vec<u64> = tails.iter().map(|tail| tail["flights"].as_u64().unwrap()).collect();
    assert_eq!(flights, [1, 2, 1]);
}

/// The reproducer of one flight under nine names.
#[test]
fn copies_are_found_by_every_command_and_said_once() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let copies = scratch.path().join("copies");
    std::fs::create_dir(&copies).unwrap();
    for k in 1..=8 {
        std::fs::copy(report(5), copies.join(format!("c{k}.txt"))).unwrap();
    }
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    std::io::Write::write_all(&mut encoder, &std::fs::read(report(5)).unwrap()).unwrap();
    std::fs::write(copies.join("c1.txt.gz"), encoder.finish().unwrap()).unwrap();
    let output = |name: &str| scratch.path().join(name);
    let run = |command: &str, more: &[&std::ffi::OsStr]| -> Ran {
        let mut arguments = vec![command.as_ref(), copies.as_os_str()];
        arguments.extend(more);
        let ran = cruisefit(&arguments).expect(0);
        let said = ran.stderr.matches("8 reports are copies of others and used once").count();
        assert_eq!(said, 1, "{command}: {}", ran.stderr);
        assert!(!ran.stderr.contains("flight-copied"), "{command}: {}", ran.stderr);
        ran
    };
    let with_model = ["--model".as_ref(), model.as_os_str()];
    let (diagnosis, tuned) = (output("d"), output("t.ron"));
    let diagnosed =
        run("diagnose", &[with_model[0], with_model[1], "-o".as_ref(), diagnosis.as_os_str()]);
    assert!(diagnosed.stdout.contains("insufficient data"), "{}", diagnosed.stdout);
    let ran = run("tune", &[with_model[0], with_model[1], "-o".as_ref(), tuned.as_os_str()]);
    assert!(ran.stdout.starts_with("1 flight, "), "{}", ran.stdout);
    let ran = run("evaluate", &with_model);
    assert!(ran.stdout.contains("1 report read, 0 already known, 8 copies"), "{}", ran.stdout);
    let (segments, learnt) = (output("s.csv"), output("o"));
    let ran = run("segment", &["-o".as_ref(), segments.as_os_str()]);
    assert!(ran.stdout.contains("of 1 flight written"), "{}", ran.stdout);
    run("adapt", &[with_model[0], with_model[1], "-o".as_ref(), learnt.as_os_str()]);
    assert_eq!(flights_of(&learnt), ["0005"]);
    let reports = &summary(&learnt)["reports"];
    assert_eq!((&reports["already_known"], &reports["copies"]), (&0.into(), &8.into()));
    // All nine are copies of what the folder knows now.
    std::fs::write(copies.join("readme.md"), "").unwrap();
    std::fs::write(copies.join("c9.txt.part"), "").unwrap();
    let ran = cruisefit(&[
        "adapt".as_ref(),
        copies.as_os_str(),
        with_model[0],
        with_model[1],
        "-o".as_ref(),
        learnt.as_os_str(),
    ])
    .expect(0);
    let words = "0 reports read, 9 already known, 0 refused, 2 other files skipped";
    assert!(ran.stdout.contains(words), "{}", ran.stdout);
    let reports = &summary(&learnt)["reports"];
    assert_eq!((&reports["already_known"], &reports["other_files"]), (&9.into(), &2.into()));
    assert!(reports.get("copies").is_none(), "{reports}");
    let ran =
        cruisefit(&["segment".as_ref(), copies.as_os_str(), "-o".as_ref(), segments.as_os_str()])
            .expect(0);
    assert!(ran.stdout.contains(", 2 other files skipped"), "{}", ran.stdout);
    let ran = cruisefit(&["check".as_ref(), copies.as_os_str()]).expect(0);
    assert!(ran.stdout.contains("0 refused, 2 other files skipped"), "{}", ran.stdout);
}

/// What is wrong with a report is wrong with its copies: none of them counts as known.
#[test]
fn copies_of_a_refused_report_are_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[report(5)], &[]).expect(0);
    let text = std::fs::read_to_string(report(5)).unwrap();
    let fuel = text.lines().find(|line| line.starts_with("ZFW")).unwrap().to_owned();
    let other = ["a.txt", "b.txt", "c.txt"]
        .map(|name| changed(scratch.path(), 5, name, &[(&fuel, "ZFW 54321 lb")]));
    let ran = adapt(&model, &output, &other, &[]).expect(1);
    for name in ["a.txt", "b.txt", "c.txt"] {
        assert!(ran.stderr.contains(&format!("{name}: ")), "{}", ran.stderr);
    }
    assert_eq!(ran.stderr.matches("already known with different content").count(), 3);
    assert!(!ran.stderr.contains("copies of others"), "{}", ran.stderr);
    let reports = &summary(&output)["reports"];
    assert_eq!(reports["refused"].as_array().unwrap().len(), 3);
    assert_eq!(reports["already_known"], 0);
}

#[test]
fn the_same_hours_or_samples_are_not_learnt_again() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let text = std::fs::read_to_string(report(5)).unwrap();
    let line = |key: &str| text.lines().find(|line| line.starts_with(key)).unwrap().to_owned();
    let renamed = changed(scratch.path(), 5, "renamed.txt", &[(&line("FLIGHT"), "FLIGHT   X-5")]);
    let hour = line("START").split('T').nth(3).unwrap()[..2].parse::<u32>().unwrap();
    let later = line("START").replace(&format!("T{hour:02}:"), &format!("T{:02}:", hour + 5));
    let shifted = changed(scratch.path(), 5, "shifted.txt", &[(&line("START"), &later)]);
    adapt(&model, &output, &reports(4..=6), &[]).expect(0);
    let before = bytes_below(&output);
    let ran = adapt(&model, &output, &[renamed.clone(), shifted.clone()], &[]).expect(1);
    ran.says("flight X-5 of").says("overlaps flight 0005 of").says("has the same samples as");
    for name in ["STATE.ron", "models/SIM-01.ron", "segments/SIM-01.csv"] {
        assert_eq!(bytes_below(&output)[name], before[name], "{name}");
    }
    // In one batch too, and for commands that learn nothing.
    let other = scratch.path().join("other");
    adapt(&model, &other, &[report(5), renamed.clone(), shifted.clone()], &[]).expect(1);
    assert_eq!(flights_of(&other).len(), 1);
    let csv = scratch.path().join("s.csv");
    cruisefit(&[
        "segment".as_ref(),
        report(5).as_os_str(),
        renamed.as_os_str(),
        shifted.as_os_str(),
        "-o".as_ref(),
        csv.as_os_str(),
    ])
    .expect(1)
    .says("one aircraft does not fly twice at a time");
}

#[test]
fn a_half_copied_report_is_replaced_by_the_whole_one() {
    for law in ["bayes", "paper"] {
        let scratch = tempfile::tempdir().unwrap();
        let model = initial_model(scratch.path());
        let (output, right) = (scratch.path().join("out"), scratch.path().join("right"));
        let text = std::fs::read_to_string(report(2)).unwrap();
        let half: String = text.lines().take(60).flat_map(|line| [line, "\n"]).collect();
        let path = scratch.path().join("half.txt");
        std::fs::write(&path, half).unwrap();
        let batch = [report(1), path, report(3)];
        adapt(&model, &output, &batch, &["--law", law]).expect(0);
        adapt(&model, &output, &[report(2)], &["--law", law])
            .expect(1)
            .says("already known with different content (--relearn learns this one in its place)");
        adapt(&model, &output, &[report(2)], &["--law", law, "--relearn"]).expect(0);
        adapt(&model, &right, &reports(1..=3), &["--law", law]).expect(0);
        same_tail(&output, &right);
        // Told again, it is known.
        adapt(&model, &output, &[report(2)], &["--law", law, "--relearn"]).expect(0);
        assert_eq!(summary(&output)["reports"]["already_known"], 1);
    }
}

#[test]
fn a_forgotten_flight_was_never_learnt() {
    let laws: [&[&str]; 3] =
        [&["--law", "bayes"], &["--law", "paper"], &["--law", "bayes", "--no-remainder"]];
    for law in laws {
        let scratch = tempfile::tempdir().unwrap();
        let model = initial_model(scratch.path());
        let (output, without) = (scratch.path().join("out"), scratch.path().join("without"));
        adapt(&model, &output, &reports(1..=8), law).expect(0);
        let forget = |flight: &str, tail: &str| {
            cruisefit(&["forget", output.to_str().unwrap(), "--tail", tail, "--flight", flight])
        };
        forget("0099", "SIM-01").expect(2).says("has not learnt a flight \"0099\"");
        forget("0004", "SIM-99").expect(2).says("it holds SIM-01");
        let show = || cruisefit(&["show", output.to_str().unwrap()]);
        assert!(!show().stdout.contains("forgotten"));
        forget("0004", "SIM-01").expect(0);
        assert!(show().stdout.contains("forgotten: tail SIM-01 has learnt 7 now"));
        let others: Vec<PathBuf> = (1..=8).filter(|flight| *flight != 4).map(report).collect();
        adapt(&model, &without, &others, law).expect(0);
        same_tail(&output, &without);
        // It can be learnt again.
        adapt(&model, &output, &[report(4)], law).expect(0);
        assert_eq!(flights_of(&output).len(), 8);
    }
}

#[test]
fn forgetting_the_last_flight_removes_the_tail() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[report(1)], &[]).expect(0);
    // As a fleet of many tails has one.
    std::fs::create_dir_all(output.join("pages")).unwrap();
    std::fs::write(output.join("pages/SIM-01.html"), "old").unwrap();
    let forget = ["forget", output.to_str().unwrap(), "--tail", "SIM-01", "--flight", "0001"];
    cruisefit(&forget).expect(0);
    assert!(!output.join("models/SIM-01.ron").exists());
    assert!(!output.join("pages/SIM-01.html").exists());
    cruisefit(&forget).expect(2).says("which holds none");
    let report_1 = report(1);
    let evaluate = ["evaluate", report_1.to_str().unwrap(), "--model", output.to_str().unwrap()];
    cruisefit(&evaluate).expect(2).says("expected a model: there is none");
    // It is a folder of `adapt` all the same.
    cruisefit(&["monitor", output.to_str().unwrap()]).expect(2).says("holds no tail");
    adapt(&model, &output, &[report(2)], &[]).expect(0);
    assert_eq!(flights_of(&output), ["0002"]);
}

#[test]
fn a_folder_of_an_older_program_is_carried_over() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (output, whole) = (scratch.path().join("out"), scratch.path().join("whole"));
    adapt(&model, &whole, &reports(1..=6), &[]).expect(0);
    adapt(&model, &output, &reports(1..=4), &[]).expect(0);
    // As it was before there was a STATE.ron.
    std::fs::remove_file(output.join("STATE.ron")).unwrap();
    std::fs::remove_dir_all(output.join("flights")).unwrap();
    adapt(&model, &output, &reports(3..=6), &[]).expect(0);
    assert!(output.join("STATE.ron").exists());
    for name in ["models/SIM-01.ron", "segments/SIM-01.csv"] {
        assert_eq!(bytes_below(&output)[name], bytes_below(&whole)[name], "{name}");
    }
}

#[test]
fn an_infinite_mass_is_refused_and_bricks_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let text = std::fs::read_to_string(report(1)).unwrap();
    let line = |key: &str| text.lines().find(|line| line.starts_with(key)).unwrap().to_owned();
    let heavy = changed(
        scratch.path(),
        1,
        "heavy.txt",
        &[(&line("ZFW"), "ZFW 1e308 kg"), (&line("FOB"), "FOB 1e308 kg")],
    );
    adapt(&model, &output, &[heavy, report(2)], &[]).expect(1).says("at most 1000000 kg");
    adapt(&model, &output, &[report(3)], &[]).expect(0);
    assert_eq!(flights_of(&output), ["0002", "0003"]);
}

#[test]
fn a_corrected_mapping_is_other_content() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (recording, mapping) = crate::support::recording(scratch.path());
    let output = scratch.path().join("out");
    let run = |mapping: &Path, more: &[&str]| {
        let mut all = vec!["--mapping", mapping.to_str().unwrap()];
        all.extend(more);
        adapt(&model, &output, std::slice::from_ref(&recording), &all)
    };
    run(&mapping, &[]).expect(0);
    run(&mapping, &[]).expect(0);
    assert_eq!(summary(&output)["reports"]["already_known"], 1);
    let text = std::fs::read_to_string(&mapping).unwrap();
    let corrected = scratch.path().join("corrected.ron");
    std::fs::write(&corrected, text.replacen("\"lb/h\"", "\"kg/h\"", 1)).unwrap();
    // The other unit is 41 % off the book, which is accepted here: it is the content that matters.
    run(&corrected, &["--accept"]).expect(1).says("already known with different content");
    run(&corrected, &["--accept", "--relearn"]).expect(0);
    run(&corrected, &["--accept"]).expect(0);
    assert_eq!(summary(&output)["reports"]["already_known"], 1);
    assert_eq!(summary(&output)["tails"][0]["flights"], 1);
}

#[test]
fn outputs_are_written_where_a_path_leads() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let evaluate = |json: &str| {
        cruisefit(&[
            "evaluate",
            report(1).to_str().unwrap(),
            "--model",
            model.to_str().unwrap(),
            "--json",
            json,
        ])
    };
    let ran = evaluate("-").expect(0);
    assert!(ran.stdout.contains("\"schema\": \"cruisefit.summary/1\""), "{}", ran.stdout);
    if cfg!(unix) {
        let ran = evaluate("/dev/stdout").expect(0);
        assert!(ran.stdout.contains("\"schema\""), "{}", ran.stdout);
        evaluate("/dev/null").expect(0);
        assert!(!Path::new("/dev/null").metadata().unwrap().is_file());
    }
}

/// A device and a pipe have no ending that chooses a format: a table is CSV there, as on standard output.
#[cfg(unix)]
#[test]
fn tables_go_to_devices_and_unnamed_pipes_as_csv() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let model = model.to_str().unwrap();
    let flown = report(1);
    let flown = flown.to_str().unwrap();
    let points = scratch.path().join("points.csv");
    std::fs::write(&points, "mass_kg,pressure_altitude_ft,mach\n28000,39000,0.8\n").unwrap();
    let plain = cruisefit(&["segment", flown]).expect(0).stdout;
    assert!(plain.starts_with("tail,"), "{plain}");
    let device = cruisefit(&["segment", flown, "-o", "/dev/stdout"]).expect(0).stdout;
    assert!(device.starts_with(&plain), "{device}");
    for command in [
        &["predict", "--model", model, points.to_str().unwrap(), "-o", "/dev/null"][..],
        &["evaluate", flown, "--model", model, "-o", "/dev/null"],
        &["optimum", "--model", model, "--mass-kg", "28000", "-o", "/dev/null"],
        &["plot", model, "-o", "/dev/null"],
    ] {
        cruisefit(command).expect(0);
    }
    let pipe = scratch.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let read = std::thread::spawn({
        let pipe = pipe.clone();
        move || std::fs::read_to_string(pipe).unwrap()
    });
    cruisefit(&["segment", flown, "-o", pipe.to_str().unwrap()]).expect(0);
    assert_eq!(read.join().unwrap(), plain);
    // A file of that name is refused as before.
    let file = scratch.path().join("table.dat");
    cruisefit(&["segment", flown, "-o", file.to_str().unwrap()]).expect(2).says("ends neither in");
}

#[test]
fn what_a_command_did_not_make_is_not_replaced() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &reports(1..=3), &[]).expect(0);
    let learnt = output.join("models/SIM-01.ron");
    let before = bytes_below(&output);
    let init = |target: &Path, more: &[&str]| {
        let (aircraft, guide) = (fixture("AIRCRAFT.ron"), fixture("guide.csv"));
        let mut arguments = vec!["init", "--aircraft", aircraft.to_str().unwrap(), "--guide"];
        arguments.extend([guide.to_str().unwrap(), "-o", target.to_str().unwrap()]);
        arguments.extend(more);
        cruisefit(&arguments)
    };
    init(&learnt, &[]).expect(2).says("part of what a folder has learnt");
    assert_eq!(bytes_below(&output), before);
    init(&model, &[]).expect(0);
    cruisefit(&[
        "tune".as_ref(),
        report(1).as_os_str(),
        "--model".as_ref(),
        model.as_os_str(),
        "-o".as_ref(),
        model.as_os_str(),
    ])
    .expect(2)
    .says("was not made by this command");
    // A folder's model by nothing: the next run would find it damaged. Elsewhere it is the user's own.
    init(&learnt, &["--force"]).expect(2).says("part of what a folder has learnt");
    assert_eq!(bytes_below(&output), before);
    let copy = scratch.path().join("COPY.ron");
    std::fs::copy(&learnt, &copy).unwrap();
    init(&copy, &[]).expect(2).says("was not made by this command").says("--force");
    init(&copy, &["--force"]).expect(0);
}

/// A page or a document of somebody's own is not that of a run.
#[test]
fn pages_of_others_are_not_replaced() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    for (name, text) in [("report.html", "mine"), ("summary.json", "{\"mine\": 1}")] {
        let own = scratch.path().join(name.split('.').next().unwrap());
        std::fs::create_dir(&own).unwrap();
        std::fs::write(own.join(name), text).unwrap();
        adapt(&model, &own, &[report(1)], &[]).expect(2).says(name).says("was not made by this");
        assert_eq!(bytes_below(&own).len(), 1);
        assert_eq!(std::fs::read_to_string(own.join(name)).unwrap(), text);
    }
    // What a run left that learnt nothing is its own.
    let output = scratch.path().join("out");
    adapt(&model, &output, &[report(1)], &[]).expect(0);
    for file in ["models", "segments", "flights", "deviations"] {
        std::fs::remove_dir_all(output.join(file)).unwrap();
    }
    std::fs::remove_file(output.join("STATE.ron")).unwrap();
    adapt(&model, &output, &[report(1)], &[]).expect(0);
}

/// A registration that was corrected: the flight is on the old tail still.
#[test]
fn a_flight_on_two_tails_is_said_with_what_mends_it() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let tail = [("SIM-01", "SIM-02")];
    let corrected = changed(scratch.path(), 2, "0002.txt", &tail);
    let other = changed(scratch.path(), 3, "0003.txt", &tail);
    adapt(&model, &output, &reports(1..=3), &[]).expect(0);
    let ran = adapt(&model, &output, std::slice::from_ref(&corrected), &[]).expect(0);
    ran.says("flight 0002 of tail SIM-01 and flight 0002 of tail SIM-02");
    ran.says("forget");
    ran.says("--tail SIM-01 --flight 0002");
    // Said in the night in which it is learnt, of that flight alone.
    let silent = adapt(&model, &output, std::slice::from_ref(&corrected), &[]).expect(0);
    assert!(!silent.stderr.contains("learnt twice"), "{}", silent.stderr);
    // Two tails in one run, too.
    let at_once = scratch.path().join("at_once");
    let both = adapt(&model, &at_once, &[report(3), other], &[]).expect(0);
    both.says("flight 0003 of tail SIM-01 and flight 0003 of tail SIM-02");
    // The same hours alone are no sign: other samples.
    let fuller = [("SIM-01", "SIM-03"), ("ZFW", "ZFW ")];
    let mut text = std::fs::read_to_string(changed(scratch.path(), 2, "f.txt", &fuller)).unwrap();
    let load = text.lines().find(|line| line.starts_with("ZFW")).unwrap().to_owned();
    let word = load.split_whitespace().nth(1).unwrap();
    let heavier = format!("{}", word.parse::<f64>().unwrap() + 100.0);
    text = text.replacen(&load, &load.replace(word, &heavier), 1);
    let same_hours = scratch.path().join("same_hours.txt");
    std::fs::write(&same_hours, text).unwrap();
    let silent = adapt(&model, &output, &[same_hours], &[]).expect(0);
    assert!(!silent.stderr.contains("learnt twice"), "{}", silent.stderr);
}

#[cfg(unix)]
#[test]
fn few_handles_and_many_threads_refuse_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let script = format!(
        "ulimit -n 32; exec {} adapt {} --model {} -o {} --threads 1024",
        env!("CARGO_BIN_EXE_cruisefit"),
        fixture("reports").display(),
        model.display(),
        output.display()
    );
    let status = Command::new("sh").arg("-c").arg(script).stdout(Stdio::null()).status().unwrap();
    assert!(status.success());
    assert_eq!(flights_of(&output).len(), 12);
}

#[cfg(unix)]
#[test]
fn files_follow_the_umask() {
    use std::os::unix::fs::PermissionsExt;
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let script = format!(
        "umask 027; exec {} adapt {} --model {} -o {}",
        env!("CARGO_BIN_EXE_cruisefit"),
        report(1).display(),
        model.display(),
        output.display()
    );
    assert!(Command::new("sh").arg("-c").arg(script).status().unwrap().success());
    for name in ["STATE.ron", "models/SIM-01.ron", "segments/SIM-01.csv", "summary.json"] {
        let mode = output.join(name).metadata().unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o640, "{name}");
    }
}
