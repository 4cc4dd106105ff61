//! What a folder holds after the program died, or the power was cut, before or within any of its steps.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use pipeline::checksum::sha256;
use pipeline::summary::TailSummary;

use super::lock::Busy;
use super::state::{self, TailState};
use super::{Beginning, Folder};
use crate::files::steps::faults;

const TAILS: [&str; 3] = ["A", "B", "C"];

fn summary(tail: &str) -> TailSummary {
    let errors = r#"{"before": {"mean": null, "std": null, "max_abs": null, "n": 0}}"#;
    let json = format!(
        r#"{{"tail": "{tail}", "flights": 1, "flights_new": 0, "samples": 1, "segments": 0, "outside_table": 0,
        "fuel_flow_error_percent": {errors}}}"#
    );
    serde_json::from_str(&json).unwrap()
}

/// The last tail is forgotten in version 2.
fn tails_of(version: u32) -> &'static [&'static str] {
    if version == 2 { &TAILS[..2] } else { &TAILS }
}

/// Stores a version of every tail. Files are not models here: a folder does not look into them.
fn store(folder: Folder, version: u32) -> Result<(), crate::failure::Failure> {
    let mut tails = BTreeMap::new();
    for tail in tails_of(version) {
        let text = |kind: &str| format!("{kind} of {tail}, version {version}\n").repeat(20);
        let state = TailState {
            begun: String::new(),
            model: folder.stage(&format!("models/{tail}.ron"), text("model").as_bytes())?,
            segments: folder.stage(&format!("segments/{tail}.csv"), text("segments").as_bytes())?,
            flights: folder.stage(&format!("flights/{tail}.csv"), text("flights").as_bytes())?,
            deviations: None,
            summary: summary(tail),
        };
        tails.insert((*tail).to_owned(), state);
    }
    folder.stage("summary.json", version.to_string().as_bytes())?;
    folder.commit(tails)
}

fn open(path: &Path) -> Folder {
    Folder::open(path, Beginning::Continue, Busy::Refuse).unwrap()
}

/// The version that a reader sees: all files of all tails, or a panic.
fn version_seen(path: &Path) -> u32 {
    let state = state::read(path).unwrap().unwrap();
    let mut seen = Vec::new();
    for tail in state.tails.values() {
        for file in [&tail.model, &tail.segments, &tail.flights] {
            let bytes = state::bytes_of(&state, path, file).unwrap();
            let text = String::from_utf8(bytes).unwrap();
            let digit = text.trim_end().rsplit(' ').next().unwrap();
            seen.push(digit.parse::<u32>().unwrap());
        }
    }
    assert!(seen.iter().all(|version| *version == seen[0]), "{seen:?}");
    assert_eq!(seen.len(), 3 * tails_of(seen[0]).len());
    seen[0]
}

/// Stores version 1, then begins to store version 2 and dies at a step; with `lost`, the power fails too.
fn interrupted(step: usize, cut: u8, lost: Option<&mut dyn FnMut() -> bool>) -> (u32, u32) {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("out");
    faults::die_at(None, 0);
    store(open(&path), 1).unwrap();
    faults::die_at(Some(step), cut);
    // Opening takes steps of its own; whoever dies there has changed nothing.
    let stored = Folder::open(&path, Beginning::Continue, Busy::Refuse)
        .and_then(|folder| store(folder, 2))
        .is_ok();
    let died = faults::died();
    if let Some(lost) = lost {
        faults::lose_unsynced(lost);
    }
    faults::die_at(None, 0);
    let seen = version_seen(&path);
    // A run that lived to say that it is stored finds it stored, also after a power cut.
    assert!(died || (stored && seen == 2), "step {step}");
    // The next run clears up and stores what it has.
    let folder = open(&path);
    assert_eq!(version_seen(&path), seen, "step {step}: opening changes nothing");
    let of_tails = names_below(&path).into_iter().filter(|name| name.contains("C."));
    assert_eq!(of_tails.count(), if seen == 2 { 0 } else { 3 }, "step {step}: {seen}");
    store(folder, 3).unwrap();
    let left: Vec<String> = names_below(&path);
    assert!(left.iter().all(|name| !name.contains(".cruisefit-")), "step {step}: {left:?}");
    assert_eq!(left.len(), 3 * TAILS.len() + 2, "step {step}: {left:?}");
    (seen, version_seen(&path))
}

fn names_below(folder: &Path) -> Vec<String> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            names.extend(names_below(&path));
        } else {
            names.push(path.display().to_string());
        }
    }
    names
}

fn steps_of_a_run() -> usize {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("out");
    faults::die_at(None, 0);
    store(open(&path), 1).unwrap();
    faults::die_at(None, 0);
    store(open(&path), 2).unwrap();
    faults::steps()
}

#[test]
fn whoever_dies_before_any_step_leaves_one_generation() {
    let steps = steps_of_a_run();
    assert!(steps > 30, "{steps}");
    let mut seen = Vec::new();
    for step in 0..=steps {
        // Writes are cut at other bytes at every step.
        let cut = u8::try_from(step * 37 % 256).unwrap();
        let (before, after) = interrupted(step, cut, None);
        assert_eq!(after, 3);
        seen.push(before);
    }
    // The old generation up to some step, the new one from there on.
    assert!(seen.is_sorted() && seen[0] == 1 && seen[steps] == 2, "{seen:?}");
}

#[test]
fn a_power_cut_loses_what_was_not_synced_and_nothing_else() {
    let steps = steps_of_a_run();
    // A linear congruential generator (Knuth): which of the unsynced writes and renames are lost.
    let mut random = 20_261_122_u64;
    for step in 0..=steps {
        for _ in 0..2 {
            let mut lost = || {
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                random >> 63 == 1
            };
            let (_, after) = interrupted(step, 128, Some(&mut lost));
            assert_eq!(after, 3);
        }
    }
}

#[test]
fn a_changed_byte_is_noticed() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("out");
    faults::die_at(None, 0);
    store(open(&path), 1).unwrap();
    let file = path.join("segments/B.csv");
    let mut bytes = std::fs::read(&file).unwrap();
    bytes[5] ^= 1;
    std::fs::write(&file, bytes).unwrap();
    let folder = open(&path);
    let state = folder.state_of("B").unwrap();
    assert_ne!(state.segments.sha256, sha256(&std::fs::read(&file).unwrap()));
    let failure = folder.load("B").unwrap_err().to_string();
    assert!(failure.contains("models/B.ron") || failure.contains("segments/B.csv"), "{failure}");
}

#[test]
fn a_restart_keeps_the_old_folder_or_changes_nothing() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("out");
    faults::die_at(None, 0);
    store(open(&path), 1).unwrap();
    drop(Folder::open(&path, Beginning::Restart, Busy::Refuse).unwrap());
    assert_eq!(version_seen(&path), 1);
    assert!(!scratch.path().join("out.1").exists());
    let folder = Folder::open(&path, Beginning::Restart, Busy::Refuse).unwrap();
    assert!(folder.tails().is_empty());
    store(folder, 2).unwrap();
    assert_eq!((version_seen(&path), version_seen(&scratch.path().join("out.1"))), (2, 1));
    assert_eq!(names_below(&scratch.path().join("out.1")).len(), 3 * TAILS.len() + 2);
}

#[test]
fn what_is_out_of_date_goes_when_the_new_is_in_place_and_not_before() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("out");
    store(open(&path), 1).unwrap();
    let page = path.join("pages").join("A.html");
    fs::create_dir_all(path.join("pages")).unwrap();
    fs::write(&page, "old figures").unwrap();
    let named = || ["pages/A.html", "pages/B.html"].map(str::to_owned);
    let mut left = open(&path);
    left.removes(named());
    drop(left);
    assert!(page.is_file());
    let mut folder = open(&path);
    folder.removes(named());
    store(folder, 2).unwrap();
    assert!(!page.exists());
    assert_eq!(version_seen(&path), 2);
}
