//! The figures of commands that have no schema of their own: `--json` has those of the text.

use std::path::Path;

use serde_json::Value;

use crate::support::{adapt, bytes_below, copy_of, cruisefit, fixture, initial_model, root};

/// The figures that a command prints with `--json`; its document has what every such document has.
fn figures(arguments: &[&str]) -> Value {
    let with_json = [arguments, &["--json"]].concat();
    let document: Value = serde_json::from_str(&cruisefit(&with_json).expect(0).stdout).unwrap();
    assert_eq!(document["schema"], "cruisefit.done/1", "{arguments:?}");
    assert!(document["text"].is_array() && document["refused"].is_array(), "{arguments:?}");
    document["figures"].clone()
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

#[test]
fn init_has_the_figures_of_its_text() {
    let scratch = tempfile::tempdir().unwrap();
    let model = text(&scratch.path().join("MODEL.ron"));
    let (aircraft, guide) = (text(&fixture("AIRCRAFT.ron")), text(&fixture("guide.csv")));
    let arguments = ["init", "--aircraft", &aircraft, "--guide", &guide, "-o", &model];
    let found = figures(&arguments);
    // Counted in the guide by hand: its rows without the heading.
    let rows = std::fs::read_to_string(&guide)
        .unwrap()
        .lines()
        .filter(|line| line.starts_with(|letter: char| letter.is_ascii_digit()))
        .count();
    assert_eq!(found["guide_points"], rows);
    assert_eq!(found["written"][0], model);
    let said = cruisefit(&[&arguments[..], &["--force"]].concat()).expect(0).stdout;
    let nodes = found["table_lift_coefficients"].as_u64().unwrap()
        * found["table_mach_numbers"].as_u64().unwrap();
    assert!(said.contains(&format!("{nodes} nodes")), "{said}");
    let percent = found["fit_residual_rms_percent"].as_f64().unwrap();
    assert!(said.contains(&format!("{percent:.2} % of drag")), "{said}");
}

#[test]
fn merge_tune_and_forget_count_flights() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let reports: Vec<_> = (1..=4).map(|k| fixture("reports").join(format!("{k:04}.txt"))).collect();
    let halves = [scratch.path().join("one"), scratch.path().join("other")];
    for (folder, half) in halves.iter().zip(reports.chunks(2)) {
        adapt(&model, folder, half, &[]).expect(0);
    }
    let learnt = |folder: &Path| text(&folder.join("models/SIM-01.ron"));
    let merged = text(&scratch.path().join("merged.ron"));
    let found = figures(&["merge", &learnt(&halves[0]), &learnt(&halves[1]), "-o", &merged]);
    assert_eq!((&found["models"], &found["flights"]), (&Value::from(2), &Value::from(4)));

    let shown = cruisefit(&["show", &text(&halves[0]), "--json"]).expect(0).stdout;
    assert!(shown.contains("SIM-01"), "{shown}");
    let flights = std::fs::read_to_string(halves[0].join("flights/SIM-01.csv")).unwrap();
    let first = flights.lines().nth(1).unwrap().split(',').next().unwrap().to_owned();
    let found = figures(&["forget", &text(&halves[0]), "--tail", "SIM-01", "--flight", &first]);
    assert_eq!((&found["flight"], &found["flights_left"]), (&Value::from(first), &Value::from(1)));

    let tuned = text(&scratch.path().join("tuned.ron"));
    let reports: Vec<String> = reports.iter().map(|path| text(path)).collect();
    let mut arguments: Vec<&str> = vec!["tune", "--model"];
    let model = text(&model);
    arguments.extend([model.as_str(), "-o", &tuned]);
    arguments.extend(reports.iter().map(String::as_str));
    let found = figures(&arguments);
    assert_eq!(found["flights"], 4);
    assert!(found["search"][0]["ln_evidence"].is_number(), "{found}");
    assert!(found["settings"].is_object(), "{found}");
}

#[test]
fn files_of_others_are_counted() {
    let scratch = tempfile::tempdir().unwrap();
    let out = |name: &str| text(&scratch.path().join(name));
    let types = figures(&["guide", "--list"]);
    assert!(types["types"].as_array().unwrap().iter().any(|one| one["type"] == "A320"));
    let found = figures(&["guide", "--type", "A320", "-o", &out("a320")]);
    assert_eq!((&found["type"], &found["represented_by"]), (&"A320".into(), &"A320".into()));
    assert_eq!(found["written"].as_array().unwrap().len(), 2);

    let recording = text(&root().join("fixtures/layouts/01_named_units.csv"));
    let mapping = out("mapping.ron");
    let found = figures(&["mapping", &recording, "-o", &mapping]);
    let said = cruisefit(&["mapping", recording.as_str()]).expect(0);
    let (flights, samples) = (&found["flights"], &found["samples"]);
    assert_eq!(flights, 1);
    said.says(&format!("it reads {flights} flight with {samples} samples"));
    said.says(&format!("{} guess", found["guesses"]));
    let arguments = ["convert", &recording, "--mapping", &mapping, "-o", &out("reports")];
    assert_eq!(figures(&arguments)["reports_written"], 1);

    let study = figures(&["simulate", "ghazi-2020", "-o", &out("study")]);
    let reports = bytes_below(&scratch.path().join("study"));
    let is_report = |name: &&String| Path::new(name).extension().is_some_and(|end| end == "txt");
    let written = reports.keys().filter(is_report).count();
    assert_eq!((&study["flights"], &study["drawn_again"]), (&Value::from(written), &0.into()));

    let found = figures(&["mapping", "--presets"]);
    assert!(found["presets"].as_array().unwrap().len() > 5, "{found}");
    let found = figures(&["plot", &text(&initial_model(scratch.path())), "-o", &out("m.pdf")]);
    assert_eq!((&found["format"], &found["unknown_characters"]), (&"pdf".into(), &"".into()));
}

#[test]
fn what_is_for_programs_as_it_is_has_figures_too() {
    let scratch = tempfile::tempdir().unwrap();
    let out = |name: &str| text(&scratch.path().join(name));
    assert_eq!(figures(&["completions", "bash"])["shell"], "bash");
    let pages = figures(&["man", &out("man")]);
    let written = pages["written"].as_array().unwrap();
    assert_eq!(pages["pages"], written.len());
    assert!(written.iter().all(|page| Path::new(page.as_str().unwrap()).is_file()), "{pages}");
    let page = cruisefit(&["man", "-"]).expect(0).stdout;
    let beside = std::fs::read_to_string(scratch.path().join("man/cruisefit.1")).unwrap();
    assert_eq!(page, beside);

    let model = text(&initial_model(scratch.path()));
    let csv = out("table.csv");
    let found = figures(&["export", &model, "-o", &csv]);
    assert_eq!((&found["format"], &found["written"][0]), (&"csv".into(), &csv.into()));
    // Without a file the model itself is the document; a table beside it has no place there.
    let document = cruisefit(&["export", &model, "--json"]).expect(0).stdout;
    let as_format = cruisefit(&["export", &model, "--format", "json"]).expect(0).stdout;
    assert_eq!(document, as_format);
    assert_eq!(serde_json::from_str::<Value>(&document).unwrap()["schema"], "cruisefit.model/1");
    cruisefit(&["export", &model, "--json", "--format", "csv"]).expect(2).says("--json");
}

#[test]
fn values_out_of_tolerance_are_in_the_document() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("golden");
    copy_of(&root().join("fixtures/global5000"), &folder);
    let golden = text(&folder);
    let found = figures(&["golden", "check", &golden]);
    assert_eq!((&found["folders"], &found["differences"]), (&1.into(), &Value::Array(vec![])));
    let table = folder.join("expected/SIM-01_table.csv");
    let before = std::fs::read_to_string(&table).unwrap();
    let line = before.lines().nth(40).unwrap();
    std::fs::write(&table, before.replace(line, &line.replacen("0.0", "0.1", 1))).unwrap();
    let ran = cruisefit(&["golden", "check", &golden, "--json"]).expect(2);
    ran.says("1 value out of tolerance");
    let document: Value = serde_json::from_str(&ran.stdout).unwrap();
    let difference = &document["figures"]["differences"][0];
    assert_eq!(difference["file"], text(&table));
    assert_eq!(difference["line"], 41);
    assert_ne!(difference["expected"], difference["found"]);
    let blessed = figures(&["golden", "bless", &golden]);
    assert!(blessed["written"].as_array().unwrap().contains(&text(&table).into()), "{blessed}");
    assert_eq!(std::fs::read_to_string(&table).unwrap(), before);
}
