//! What `export` writes, read by the programs that it is for. They are Python packages: the variable `CRUISEFIT_PYTHON`
//! names a Python that has them; without one a test is skipped visibly.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::json_schema::violations;
use crate::support::{adapt, cruisefit, csv_columns, fixture, initial_model};

/// A Python that can import a module.
fn python_with(module: &str) -> Option<String> {
    let python = std::env::var("CRUISEFIT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let imported = Command::new(&python).args(["-c", &format!("import {module}")]).output();
    if imported.is_ok_and(|output| output.status.success()) {
        return Some(python);
    }
    test_support::outside::skip(&format!("needs {module} in {python} (variable CRUISEFIT_PYTHON)"));
    None
}

/// Runs a script of this folder and gives its numbers, one per line.
fn numbers(python: &str, script: &str, arguments: &[&Path]) -> Vec<f64> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/read_back").join(script);
    let output = Command::new(python).arg(script).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let values = text.lines().filter_map(|line| line.strip_prefix("value "));
    values.map(|value| value.parse().unwrap()).collect()
}

/// A model that has learnt the fixture's twelve flights, and its table.
fn learnt(folder: &Path) -> (PathBuf, PathBuf) {
    let model = initial_model(folder);
    let output = folder.join("out");
    adapt(&model, &output, &[fixture("reports")], &["--no-remainder"]).expect(0);
    let learnt = output.join("models/SIM-01.ron");
    let table = folder.join("table.csv");
    export(&learnt, "csv", &table, &[]);
    (learnt, table)
}

fn export(model: &Path, format: &str, output: &Path, more: &[&str]) {
    let mut arguments: Vec<std::ffi::OsString> = vec!["export".into(), model.into()];
    arguments.extend(["--format".into(), format.into(), "-o".into(), output.into()]);
    arguments.extend(more.iter().map(Into::into));
    cruisefit(&arguments).expect(0);
}

/// JSBSim, flown at lift coefficients and Mach numbers of nodes, has the drag coefficients of the table.
#[test]
fn jsbsim_reads_its_table() {
    let Some(python) = python_with("jsbsim") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let (model, table) = learnt(scratch.path());
    let xml = scratch.path().join("drag.xml");
    export(&model, "jsbsim", &xml, &[]);
    let found = numbers(&python, "jsbsim_table.py", &[&xml, &table, scratch.path()]);
    assert!(found.len() > 10, "{} nodes compared", found.len());
    assert!(found.iter().all(|error| error.abs() < 1e-6), "relative errors {found:?}");
}

/// OpenAP's drag in cruise is that of the polar, and the polar's that of the model within what the file's comment states.
#[test]
fn openap_reads_its_polar() {
    let Some(python) = python_with("openap") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let (model, _) = learnt(scratch.path());
    let polar = scratch.path().join("gl5t.yml");
    export(&model, "openap", &polar, &["--mach", "0.8"]);
    let points = scratch.path().join("points.csv");
    std::fs::write(
        &points,
        "mass_kg,pressure_altitude_ft,mach\n27000,41000,0.8\n30000,39000,0.8\n33000,41000,0.8\n",
    )
    .unwrap();
    let predicted = scratch.path().join("predicted.csv");
    let arguments: [&std::ffi::OsStr; 6] = [
        "predict".as_ref(),
        "--model".as_ref(),
        model.as_os_str(),
        points.as_os_str(),
        "-o".as_ref(),
        predicted.as_os_str(),
    ];
    cruisefit(&arguments).expect(0);
    let found = numbers(&python, "openap_polar.py", &[&polar, &predicted]);
    assert_eq!(found.len(), 3);
    let comment = std::fs::read_to_string(&polar).unwrap();
    let stated: f64 =
        comment.split(" % rms, ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    // Chords of the table between its nodes: 0.3 %.
    assert!(found.iter().all(|percent| percent.abs() < stated + 0.3), "{found:?}, stated {stated}");
}

/// Forty lines of Python that know the JSON alone predict the fuel flow that `predict` does.
#[test]
fn another_language_reads_the_json() {
    let Some(python) = python_with("json") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let (model, _) = learnt(scratch.path());
    let json = scratch.path().join("model.json");
    export(&model, "json", &json, &[]);
    let document: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&json).unwrap()).unwrap();
    let schema = crate::support::root().join("docs/schemas/model-1.json");
    let schema: serde_json::Value =
        serde_json::from_slice(&std::fs::read(schema).unwrap()).unwrap();
    assert_eq!(violations(&schema, &document), Vec::<String>::new());
    let predicted = scratch.path().join("predicted.csv");
    let static_points = fixture("static.csv");
    let arguments: [&std::ffi::OsStr; 3] =
        ["predict".as_ref(), "--table-only".as_ref(), "--model".as_ref()];
    let more = [model.as_os_str(), static_points.as_os_str(), "-o".as_ref(), predicted.as_os_str()];
    cruisefit(&[&arguments[..], &more[..]].concat());
    assert!(!csv_columns(&predicted)["fuel_flow_kg_s"].is_empty());
    let found = numbers(&python, "json_model.py", &[&json, &predicted]);
    assert!(found.len() > 10, "{} points compared", found.len());
    assert!(found.iter().all(|error| error.abs() < 1e-12), "relative errors {found:?}");
}

#[test]
fn formats_have_their_options() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let run = |more: &[&str]| {
        let mut arguments: Vec<std::ffi::OsString> = vec!["export".into(), model.clone().into()];
        arguments.extend(more.iter().map(Into::into));
        cruisefit(&arguments)
    };
    run(&["--mach", "0.8"]).expect(2).says("only --format openap");
    run(&["--format", "openap", "--mach", "2"]).expect(2).says("inform fewer than two");
    let same = run(&["--polynomial"]).expect(0).stdout;
    assert_eq!(same, run(&["--format", "polynomial"]).expect(0).stdout);
}

/// A model that has learnt more than its table says so on standard error and in the file; one that has not, does not.
#[test]
fn what_is_left_out_is_said() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[fixture("reports")], &[]).expect(0);
    let learnt = output.join("models/SIM-01.ron");
    let run = |model: &Path, format: &str| {
        let words = ["export".as_ref(), model.as_os_str(), "--format".as_ref(), format.as_ref()];
        cruisefit(&words).expect(0)
    };
    for format in ["csv", "polynomial", "openap", "jsbsim", "json"] {
        run(&learnt, format).says("what else the model has learnt is left out");
        let initial = run(&model, format);
        assert!(!initial.stderr.contains("left out"), "{format}: {}", initial.stderr);
    }
    run(&learnt, "polynomial").says("the polynomial misses the informed nodes");
    assert!(run(&learnt, "openap").stdout.contains("# Drag alone"), "a comment");
    assert!(run(&learnt, "jsbsim").stdout.contains("<!-- Drag alone"), "a comment");
    let document: serde_json::Value = serde_json::from_str(&run(&learnt, "json").stdout).unwrap();
    assert!(document["remainder_left_out"]["rms_percent"].as_f64().unwrap() > 0.0);
    let schema = crate::support::root().join("docs/schemas/model-1.json");
    let schema: serde_json::Value =
        serde_json::from_slice(&std::fs::read(schema).unwrap()).unwrap();
    assert_eq!(violations(&schema, &document), Vec::<String>::new());
}
