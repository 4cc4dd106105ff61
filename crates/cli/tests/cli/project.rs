//! `cruisefit.toml`: options that a project's commands have in common.

use std::path::Path;
use std::process::Command;

use crate::support::{cruisefit, fixture, init, initial_model};

fn project(folder: &Path, text: &str) -> std::path::PathBuf {
    let path = folder.join("cruisefit.toml");
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_project_file_stands_for_options_and_the_command_line_wins() {
    let folder = tempfile::tempdir().unwrap();
    initial_model(folder.path());
    let file = project(
        folder.path(),
        "# what we always use\nmodel = \"MODEL.ron\"\ncriteria = \"airbus-report-02\"\nthreads = 1\n",
    );
    let reports = fixture("reports");
    let evaluate = |criteria: &[&str]| {
        let mut arguments = vec!["evaluate".as_ref(), reports.as_os_str()];
        arguments.extend(["--project".as_ref(), file.as_os_str()]);
        arguments.extend(criteria.iter().map(std::ffi::OsStr::new));
        cruisefit(&arguments).expect(0)
    };
    let by_project = evaluate(&[]);
    by_project.says("cruisefit.toml: model, criteria, threads");
    let by_option = evaluate(&["--criteria", "ghazi-2020-table-4"]);
    by_option.says("cruisefit.toml: model, threads");
    assert_ne!(by_project.stdout, by_option.stdout);
    // The same as without the file; in the working folder it needs no option.
    let without = cruisefit(&[
        "evaluate".as_ref(),
        reports.as_os_str(),
        "--model".as_ref(),
        folder.path().join("MODEL.ron").as_os_str(),
    ]);
    assert_eq!(without.expect(0).stdout, by_option.stdout);
    let inside = Command::new(env!("CARGO_BIN_EXE_cruisefit"))
        .args(["evaluate".as_ref(), reports.canonicalize().unwrap().as_os_str()])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(String::from_utf8(inside.stdout).unwrap(), by_project.stdout);
}

/// `help` takes the name of a command, and no option of its.
#[test]
fn a_project_file_adds_nothing_to_a_request_for_help() {
    let folder = tempfile::tempdir().unwrap();
    let model = initial_model(folder.path());
    let project_of = |text: &str| project(folder.path(), text);
    for text in ["model = \"MODEL.ron\"\nlaw = \"paper\"\n", "model = [\"MODEL.ron\", \"M.ron\"]\n"]
    {
        let file = project_of(text);
        let file = file.to_str().unwrap();
        let ran = cruisefit(&["help", "adapt", "--project", file]).expect(0);
        assert!(ran.stdout.contains("--relearn") && ran.stderr.is_empty(), "{}", ran.stderr);
    }
    // Of several models a command of one takes none.
    let points = folder.path().join("points.csv");
    std::fs::write(&points, "mass_kg,pressure_altitude_ft,mach\n30000,41000,0.8\n").unwrap();
    let (points, model) = (points.to_str().unwrap(), model.to_str().unwrap());
    let file = folder.path().join("cruisefit.toml");
    let file = file.to_str().unwrap();
    cruisefit(&["predict", points, "--model", model, "--project", file]).expect(0);
    cruisefit(&["predict", points, "--project", file]).expect(2).says("--model <MODEL.ron>");
}

#[test]
fn keys_that_no_command_has_are_refused_and_others_left_to_those_that_have_them() {
    let folder = tempfile::tempdir().unwrap();
    let file = project(folder.path(), "model = \"M.ron\"\ncriterias = \"airbus-report-02\"\n");
    let show = ["effects".as_ref(), "--project".as_ref(), file.as_os_str()];
    cruisefit(&show)
        .expect(2)
        .says("line 2: found \"criterias\"")
        .says("did you mean \"criteria\"?");
    // `effects` has no model.
    project(folder.path(), "model = \"M.ron\"\n");
    let ran = cruisefit(&show).expect(0);
    assert_eq!(ran.stderr, "");
}

#[test]
fn sensors_of_a_project_take_the_place_of_those_of_the_aircraft() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("SENSORS.ron"), "(fuel_flow_percent: 0.25)").unwrap();
    let file = project(folder.path(), "sensors = \"SENSORS.ron\"\n");
    let model = folder.path().join("M.ron");
    let of_project = ["--project".as_ref(), file.as_os_str()];
    init(&model, &of_project).expect(0);
    assert!(std::fs::read_to_string(&model).unwrap().contains("fuel_flow_percent: 0.25"));
    std::fs::write(folder.path().join("SENSORS.ron"), "(fuel_flow: 0.25)").unwrap();
    init(&model, &of_project).expect(2).says("SENSORS.ron");
}
