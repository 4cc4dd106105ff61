//! `diagnose --fleet`: whose an effect is, what is written, and that threads and order change nothing.

use std::path::{Path, PathBuf};

use crate::support::{adapt, bytes_below, cruisefit, csv_columns, diagnosis_document};

/// A tail of the type as it was when its model was learnt. Its physics is the model's, its sensors are those of a transport.
const CLEAN: &str = r#"(
    seed: 16,
    physics: (reynolds_number: Off, trim_drag: Off, asymmetry: Off, part_load: Off, temperature_exponent: Off, offtake: Off),
    earth: (load_factor: Off, local_gravity: Off, rotating_earth: Off, isobaric_slope: Off, coriolis_along_path: Off),
    tails: [(tail: "CLEAN", flights: Designed((flights: 30)))],
)"#;

/// Six tails whose zero-lift drag has grown by eight counts; `F-3` has a temperature probe that reads 3 K high too.
const FLEET: &str = r#"(
    seed: 17,
    physics: (reynolds_number: Off, trim_drag: Off, asymmetry: Off, part_load: Off, temperature_exponent: Off, offtake: Off),
    earth: (load_factor: Off, local_gravity: Off, rotating_earth: Off, isobaric_slope: Off, coriolis_along_path: Off),
    effects: [(id: "zero_lift_drag", size: 8)],
    tails: [
        (tail: "F-1", flights: Designed((flights: 7))),
        (tail: "F-2", flights: Designed((flights: 7))),
        (tail: "F-3", effects: [(id: "temperature_bias", size: 3)], flights: Designed((flights: 7))),
        (tail: "F-4", flights: Designed((flights: 7))),
        (tail: "F-5", flights: Designed((flights: 7))),
        (tail: "F-6", flights: Designed((flights: 7))),
    ],
)"#;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The book of the type.
fn model_of_the_type(folder: &Path) -> PathBuf {
    let (study, initial) = (folder.join("study"), folder.join("MODEL.ron"));
    cruisefit(&["simulate", "ghazi-2020", "-o", text(&study)]).expect(0);
    let (aircraft, guide) = (study.join("AIRCRAFT.ron"), study.join("guide.csv"));
    let (aircraft, guide) = (text(&aircraft), text(&guide));
    cruisefit(&["init", "--aircraft", aircraft, "--guide", guide, "-o", text(&initial)]).expect(0);
    initial
}

#[test]
fn what_all_share_is_the_models_and_what_one_has_is_its_own() {
    let scratch = tempfile::tempdir().unwrap();
    let at = |name: &str| scratch.path().join(name);
    for (name, plan) in [("clean", CLEAN), ("fleet", FLEET)] {
        let file = at(&format!("{name}.ron"));
        std::fs::write(&file, plan).unwrap();
        cruisefit(&["simulate", text(&file), "-o", text(&at(name))]).expect(0);
    }
    let initial = model_of_the_type(scratch.path());
    adapt(&initial, &at("learnt"), &[at("clean/CLEAN")], &[]).expect(0);
    let model = at("learnt/models/CLEAN.ron");
    let events = at("EVENTS.csv");
    std::fs::write(&events, "date,tail,kind,note\n2018-06-01,F-9,wash,\n").unwrap();

    let diagnose = |output: &str, tails: [&str; 6], threads: &str| {
        let folders = tails.map(|tail| at(&format!("fleet/{tail}")));
        let mut arguments = vec!["diagnose"];
        arguments.extend(folders.iter().map(|folder| text(folder)));
        let (out, applied) = (at(output), at(&format!("{output}-applied")));
        arguments.extend([
            "--model",
            text(&model),
            "-o",
            text(&out),
            "--apply",
            text(&applied),
            "--fleet",
        ]);
        arguments.extend(["--events", text(&events), "--threads", threads]);
        cruisefit(&arguments)
    };
    let ran = diagnose("found", ["F-1", "F-2", "F-3", "F-4", "F-5", "F-6"], "2");
    assert!(ran.stdout.contains("The model of the type lacks zero_lift_drag"), "{}", ran.stdout);
    // Events of a tail that was not flown are not passed over in silence.
    ran.says("F-9");

    let document = diagnosis_document(&at("found"));
    let fleet = &document["fleets"][0];
    assert_eq!(fleet["model_of"], "type");
    assert_eq!(fleet["tails"].as_array().unwrap().len(), 6);
    let findings = fleet["findings"].as_array().unwrap();
    let of_type: Vec<_> = findings.iter().filter(|found| found["level"] == "type").collect();
    let drag = of_type.iter().find(|found| found["effect"] == "zero_lift_drag");
    let drag = drag.unwrap_or_else(|| panic!("{findings:?}"));
    let size = drag["magnitude"]["value"].as_f64().unwrap();
    assert!((size - 8.0).abs() < 3.0, "{size}");
    let of_sensors: Vec<_> = findings.iter().filter(|found| found["level"] == "sensor").collect();
    assert_eq!(of_sensors.len(), 1, "{findings:?}");
    assert_eq!(of_sensors[0]["tail"], "F-3");
    assert_eq!(of_sensors[0]["effect"], "temperature_bias");
    assert_eq!(of_sensors[0]["levels"], serde_json::json!(["sensor"]));
    assert!(fleet["false_share"].as_f64().unwrap() <= 0.05);

    // One row per tail, and one for the type, of every effect.
    let table = csv_columns(&at("found/fleet.csv"));
    let effects = fleet["effects"].as_array().unwrap().len();
    assert_eq!(table["tail"].len(), 7 * effects);
    assert_eq!(table["tail"].iter().filter(|tail| *tail == "*").count(), effects);

    check_page(&at("found/fleet.html"), fleet);

    // The order of reports and the number of threads change no byte.
    diagnose("again", ["F-4", "F-6", "F-5", "F-3", "F-2", "F-1"], "1");
    assert_eq!(bytes_below(&at("found")), bytes_below(&at("again")));
    assert_eq!(bytes_below(&at("found-applied")), bytes_below(&at("again-applied")));
    assert_eq!(fleet["taught"], true);
    assert!(!ran.stdout.contains("has learnt no flight:"), "{}", ran.stdout);

    // Against the guide, which no flight has taught, what all share may be the guide's error.
    let (flown, out) = (at("fleet"), at("of-guide"));
    let untaught =
        ["diagnose", text(&flown), "--model", text(&initial), "--fleet", "-o", text(&out)];
    let ran = cruisefit(&untaught);
    assert!(ran.stdout.contains("The model has learnt no flight"), "{}", ran.stdout);
    let page = std::fs::read_to_string(out.join("fleet.html")).unwrap();
    assert!(page.contains("The model has learnt no flight"));
    assert!(!page.contains("the model can stay as it is"));
}

/// Every size, count and probability of the document is on the page, and every tail leads to its diagnosis.
fn check_page(page: &Path, fleet: &serde_json::Value) {
    let diagnoses = std::fs::read_to_string(page.with_file_name("diagnosis.html")).unwrap();
    let page = std::fs::read_to_string(page).unwrap();
    let shown: Vec<f64> = page
        .split("data-v=\"")
        .skip(1)
        .filter_map(|rest| rest.split('"').next()?.parse().ok())
        .collect();
    let has = |value: &serde_json::Value| {
        let number = value.as_f64().unwrap();
        // A number read from JSON may differ in its last bit.
        let is_shown = shown.iter().any(|one| (one - number).abs() <= 1e-12 * number.abs());
        assert!(is_shown, "{number}");
    };
    let list = |value: &serde_json::Value| value.as_array().unwrap().clone();
    for found in list(&fleet["findings"]) {
        has(&found["magnitude"]["value"]);
        list(&found["magnitude"]["ci95"]).iter().for_each(has);
        has(&found["probability"]);
    }
    for effect in list(&fleet["effects"]) {
        has(&effect["magnitude"]["value"]);
    }
    for tail in list(&fleet["tails"]) {
        for name in ["flights", "segments", "noise"] {
            has(&tail[name]);
        }
        for effect in list(&tail["effects"]) {
            has(&effect["magnitude"]["value"]);
        }
        let name = tail["tail"].as_str().unwrap();
        let (before, _) = page.split_once(&format!("\">{name}</a>")).unwrap();
        let (_, anchor) = before.rsplit_once("diagnosis.html#").unwrap();
        let section = diagnoses.split(&format!("id=\"{anchor}\"")).nth(1).unwrap();
        // The section's heading, or the charts under it, have the tail's name.
        assert!(section[..4000].contains(name), "{name} is not at {anchor}");
    }
}

#[test]
fn two_tails_are_refused_as_a_fleet() {
    let scratch = tempfile::tempdir().unwrap();
    let at = |name: &str| scratch.path().join(name);
    let plan =
        FLEET.lines().filter(|line| !["F-3", "F-4", "F-5", "F-6"].iter().any(|t| line.contains(t)));
    std::fs::write(at("PLAN.ron"), plan.collect::<Vec<_>>().join("\n")).unwrap();
    cruisefit(&["simulate", text(&at("PLAN.ron")), "-o", text(&at("flown"))]).expect(0);
    let model = model_of_the_type(scratch.path());
    let (flown, found) = (at("flown"), at("found"));
    let (flown, found, model) = (text(&flown), text(&found), text(&model));
    let arguments = ["diagnose", flown, "--model", model, "-o", found, "--fleet", "--accept"];
    cruisefit(&arguments).expect(2).says("at least 3 are needed for a fleet");
}
