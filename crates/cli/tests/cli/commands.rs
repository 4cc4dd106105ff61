//! Each command once on real input.

use std::path::Path;

use crate::json_schema::assert_held;
use crate::support::{
    adapt, bytes_below, copy_of, cruisefit, csv_columns, fixture, initial_model, numbers, root,
};

#[test]
fn segment_needs_no_model_and_explains() {
    let scratch = tempfile::tempdir().unwrap();
    let csv = scratch.path().join("segments.csv");
    let reports = fixture("reports");
    let ran = cruisefit(&[
        "segment".as_ref(),
        reports.as_os_str(),
        "-o".as_ref(),
        csv.as_os_str(),
        "--explain".as_ref(),
    ])
    .expect(0);
    let columns = csv_columns(&csv);
    assert!(ran.stdout.contains("SIM-01 0012:"), "{}", ran.stdout);
    assert!(ran.stdout.contains("GSPD"), "{}", ran.stdout);
    assert!(!columns.contains_key("error_percent"));
    // Without -o the table, and nothing else, goes to standard output.
    let plain = cruisefit(&["segment".as_ref(), reports.as_os_str()]).expect(0);
    assert_eq!(plain.stdout.as_bytes(), bytes_below(scratch.path())["segments.csv"]);
    // Parquet holds the same segments.
    let parquet = scratch.path().join("segments.parquet");
    cruisefit(&["segment".as_ref(), reports.as_os_str(), "-o".as_ref(), parquet.as_os_str()])
        .expect(0);
    let file = std::fs::File::open(&parquet).unwrap();
    let reader = parquet::file::reader::SerializedFileReader::new(file).unwrap();
    let rows = parquet::file::reader::FileReader::metadata(&reader).file_metadata().num_rows();
    assert_eq!(rows, i64::try_from(columns["tail"].len()).unwrap());
}

#[test]
fn predict_meets_the_static_points_after_adaptation_better_than_before() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[fixture("reports")], &[]).expect(0);
    let error_of = |model: &std::path::Path| {
        let csv = scratch.path().join("predicted.csv");
        cruisefit(&[
            "predict".as_ref(),
            "--model".as_ref(),
            model.as_os_str(),
            fixture("static.csv").as_os_str(),
            "-o".as_ref(),
            csv.as_os_str(),
        ])
        .expect(0);
        let columns = csv_columns(&csv);
        for name in ["fuel_flow_kg_s", "specific_range_m_kg", "lift_coefficient", "extrapolated"] {
            assert_eq!(columns[name].len(), 45, "{name}");
        }
        let errors = numbers(&columns, "error_percent");
        errors.iter().sum::<f64>() / errors.len() as f64
    };
    let (before, after) = (error_of(&model), error_of(&output.join("models/SIM-01.ron")));
    assert!(before > 2.0 && after.abs() < before.abs(), "{before} {after}");
}

#[test]
fn predict_writes_the_columns_that_are_wanted() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let predict = |more: &[&str]| {
        let points = fixture("static.csv");
        let mut arguments = vec!["predict".as_ref(), "--model".as_ref(), model.as_os_str()];
        arguments.push(points.as_os_str());
        arguments.extend(more.iter().map(std::ffi::OsStr::new));
        cruisefit(&arguments)
    };
    let columns = |ran: &crate::support::Ran, wanted: &[&str]| -> Vec<String> {
        let names: Vec<&str> = ran.stdout.lines().next().unwrap().split(',').collect();
        let place = |name: &&str| names.iter().position(|known| known == name).unwrap();
        let places: Vec<usize> = wanted.iter().map(place).collect();
        let cells = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            places.iter().map(|place| cells[*place]).collect::<Vec<_>>().join(",")
        };
        ran.stdout.lines().map(cells).collect()
    };
    let (all, some) =
        (predict(&[]).expect(0), predict(&["--columns", "error_percent,fuel_flow_kg_s"]).expect(0));
    let wanted = ["fuel_flow_kg_s", "error_percent"];
    assert_eq!(columns(&some, &wanted), columns(&all, &wanted));
    assert!(some.stdout.lines().next().unwrap().ends_with(",fuel_flow_kg_s,error_percent"));
    assert!(!some.stdout.contains("lift_coefficient"), "{}", some.stdout);
    predict(&["--columns", "fuel_flow"]).expect(2).says("fuel_flow_kg_s");
}

#[test]
fn a_point_outside_the_table_keeps_its_row_and_is_told() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let points = scratch.path().join("points.csv");
    std::fs::write(
        &points,
        "weight_lb,pressure_altitude_ft,mach\n68000,41000,0.80\n68000,41000,0.98\n",
    )
    .unwrap();
    let ran =
        cruisefit(&["predict".as_ref(), "--model".as_ref(), model.as_os_str(), points.as_os_str()])
            .expect(1);
    ran.says("points.csv:3: ");
    let lines: Vec<&str> = ran.stdout.lines().collect();
    assert_eq!(lines.len(), 3);
    assert!(lines[2].starts_with("68000,41000,0.98,,"), "{}", lines[2]);
}

#[test]
fn evaluate_changes_nothing_and_tells_the_error() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let json = scratch.path().join("summary.json");
    let before = std::fs::read(&model).unwrap();
    let ran = cruisefit(&[
        "evaluate".as_ref(),
        fixture("reports").as_os_str(),
        "--model".as_ref(),
        model.as_os_str(),
        "--json".as_ref(),
        json.as_os_str(),
    ])
    .expect(0);
    assert!(ran.stdout.contains("SIM-01"), "{}", ran.stdout);
    assert_eq!(std::fs::read(&model).unwrap(), before);
    let summary: serde_json::Value = serde_json::from_slice(&std::fs::read(json).unwrap()).unwrap();
    assert_held("summary-1.json", &summary);
    let errors = &summary["tails"][0]["fuel_flow_error_percent"];
    assert!(errors["before"]["mean"].as_f64().unwrap() > 3.0);
    assert!(errors["after"].is_null());
}

#[test]
fn show_and_export_tell_what_the_model_holds() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let shown = cruisefit(&["show".as_ref(), model.as_os_str()]).expect(0);
    assert!(shown.stdout.contains("Global 5000"), "{}", shown.stdout);
    assert!(shown.stdout.contains("It has learnt nothing yet."));
    let exported = cruisefit(&["export".as_ref(), model.as_os_str()]).expect(0);
    assert_eq!(exported.stdout.lines().count(), 1 + 15 * 10);
}

#[test]
fn golden_check_finds_a_changed_value() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("golden");
    copy_of(&root().join("fixtures/global5000"), &folder);
    cruisefit(&["golden".as_ref(), "check".as_ref(), folder.as_os_str()]).expect(0);
    let table = folder.join("expected/SIM-01_table.csv");
    let text = std::fs::read_to_string(&table).unwrap();
    let line = text.lines().nth(40).unwrap().to_owned();
    let changed = line.replacen("0.0", "0.1", 1);
    assert_ne!(line, changed);
    std::fs::write(&table, text.replace(&line, &changed)).unwrap();
    let ran = cruisefit(&["golden".as_ref(), "check".as_ref(), folder.as_os_str()]).expect(2);
    assert!(ran.stdout.contains("SIM-01_table.csv:41: value"), "{}", ran.stdout);
    ran.says("1 value out of tolerance");
    // Blessing is deliberate, and makes the check pass again.
    cruisefit(&["golden".as_ref(), "bless".as_ref(), folder.as_os_str()]).expect(0);
    assert_eq!(std::fs::read_to_string(&table).unwrap(), text);
}

/// A folder whose description is missing, moved or misspelt must not count as checked.
#[test]
fn golden_check_refuses_a_folder_without_a_description() {
    let scratch = tempfile::tempdir().unwrap();
    let check = |folders: &[&std::path::Path]| {
        let mut words: Vec<&std::ffi::OsStr> = vec!["golden".as_ref(), "check".as_ref()];
        words.extend(folders.iter().map(|folder| folder.as_os_str()));
        cruisefit(&words).expect(2).says("golden.ron");
    };
    check(&[scratch.path()]);
    check(&[&root().join("fixtures/global5000"), scratch.path()]);
}

#[test]
fn the_real_a320_recording() {
    let recording = root().join("fixtures/a320-traffic/fuelflow_a320.csv.gz");
    let scratch = tempfile::tempdir().unwrap();
    let csv = scratch.path().join("segments.csv");
    let segment = |criteria: &str| {
        cruisefit(&[
            "segment".as_ref(),
            recording.as_os_str(),
            "--mapping".as_ref(),
            "traffic-a320".as_ref(),
            "--criteria".as_ref(),
            criteria.as_ref(),
            "-o".as_ref(),
            csv.as_os_str(),
            "--explain".as_ref(),
        ])
        .expect(0)
    };
    // Drift of 5 degrees and more, and a pressure altitude that swings by 20 ft: table 4 leaves no segment, and the
    // program reports that.
    let strict = segment("ghazi-2020-table-4");
    assert!(strict.stdout.contains("0 kept in 0 segments"), "{}", strict.stdout);
    assert!(strict.stdout.contains("not evaluated: SAT, N2"), "{}", strict.stdout);
    segment("airbus-report-02");
    let columns = csv_columns(&csv);
    assert!(columns["tail"].len() > 10, "{}", columns["tail"].len());
    for mach in numbers(&columns, "mach") {
        // What is public about this flight: its level cruise at FL360 lies between Mach 0.750 and 0.780.
        assert!((0.745..0.785).contains(&mach), "{mach}");
    }
    assert!(columns["temperature_assumed"].iter().all(|assumed| assumed == "1"));
}

#[test]
fn demo_does_the_whole_chain_on_embedded_data() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("demo");
    let ran = cruisefit(&["demo".as_ref(), "-o".as_ref(), folder.as_os_str()]).expect(0);
    assert!(ran.stdout.contains("flights that no model has seen:"), "{}", ran.stdout);
    // The later period: named, or in its class, before the seal was opened.
    let (before, after) = ran.stdout.split_once("The seal is opened (unchanged)").unwrap();
    assert!(before.contains("tsfc_engine_2"), "{before}");
    assert!(after.contains("tsfc_engine_2 +3"), "{after}");
    for file in [
        "MODEL.ron",
        "adapted-bayes/models/N750CF.ron",
        "adapted-paper/report.html",
        "reports/TRUTH.json",
        "later/TRUTH.json",
        "diagnosis/diagnosis.json",
        "diagnosis/diagnosis.html",
    ] {
        assert!(folder.join(file).exists(), "{file}");
    }
    for truth in ["reports/TRUTH.json", "later/TRUTH.json"] {
        let truth = std::fs::read(folder.join(truth)).unwrap();
        assert_held("truth-1.json", &serde_json::from_slice(&truth).unwrap());
    }
    crate::pages::check_numbers(&folder);
    // Once more into the same folder: the same output.
    let again = cruisefit(&["demo".as_ref(), "-o".as_ref(), folder.as_os_str()]).expect(0);
    assert_eq!(again.stdout, ran.stdout);
}

#[test]
fn the_study_is_simulated_as_it_is_kept() {
    // Our own output: detects change. Numbers are compared loosely, for the mathematical library of another machine
    // may round a sample the other way.
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("study");
    cruisefit(&["simulate".as_ref(), "ghazi-2020".as_ref(), "-o".as_ref(), folder.as_os_str()])
        .expect(0);
    let kept = bytes_below(&root().join("fixtures/ghazi-2020"));
    let tolerance = pipeline::difference::Tolerance { relative: 1e-3, absolute: 1.0 };
    for (name, bytes) in bytes_below(&folder) {
        let (expected, found) =
            (String::from_utf8_lossy(&kept[&name]), String::from_utf8_lossy(&bytes));
        let differences = pipeline::difference::differences(&expected, &found, tolerance);
        assert!(differences.is_empty(), "{name}: {:?}", differences.first());
    }
}

#[test]
fn simulated_reports_do_not_depend_on_threads() {
    let scratch = tempfile::tempdir().unwrap();
    let plan = scratch.path().join("PLAN.ron");
    std::fs::write(
        &plan,
        "(seed: 3, aircraft: Preset(a320), tails: [(tail: \"X\", flights: Designed((flights: 6)))])",
    )
    .unwrap();
    let run = |threads: &str| {
        let folder = scratch.path().join(threads);
        cruisefit(&[
            "simulate".as_ref(),
            plan.as_os_str(),
            "--states".as_ref(),
            "--threads".as_ref(),
            threads.as_ref(),
            "-o".as_ref(),
            folder.as_os_str(),
        ])
        .expect(0);
        bytes_below(&folder)
    };
    let one = run("1");
    assert_eq!(one.len(), 6 + 6 + 1, "{:?}", one.keys());
    assert_eq!(run("3"), one);
}

#[test]
fn a_simulated_fleet_has_its_events_and_one_truth() {
    let scratch = tempfile::tempdir().unwrap();
    let (plan, folder) = (scratch.path().join("PLAN.ron"), scratch.path().join("fleet"));
    std::fs::write(
        &plan,
        r#"(seed: 3, fleet: (
            tails: 4,
            flights: (flights: 2, duration_h: (0.4, 0.4)),
            type_effects: [(effect: (id: "induced_drag"))],
            tail_effects: [(effects: [(id: "drag_factor", size: -1.0)], of: Share(0.5),
                between: ("2018-06-01T00:00:00Z", "2018-12-01T00:00:00Z"), event: "retrofit")],
            events: [(of: Tails(["T-002"]), at: "2018-09-01T00:00:00Z", what: Wash)],
        ))"#,
    )
    .unwrap();
    let simulate =
        || cruisefit(&["simulate".as_ref(), plan.as_os_str(), "-o".as_ref(), folder.as_os_str()]);
    let said = simulate().expect(0);
    assert!(said.stdout.contains("8 flights") && said.stdout.contains("EVENTS.csv"), "{said:?}");
    let files = bytes_below(&folder);
    assert_eq!(files.len(), 8 + 2, "{:?}", files.keys());
    // What `monitor`, `adapt` and `diagnose` read.
    let events = pipeline::monitoring::read_events(&files["EVENTS.csv"]).unwrap();
    let kinds: Vec<&str> = events.iter().map(|event| event.kind.as_str()).collect();
    assert_eq!(kinds.iter().filter(|kind| **kind == "retrofit").count(), 2);
    assert_eq!(kinds.iter().filter(|kind| **kind == "wash").count(), 1);
    let truth: serde_json::Value = serde_json::from_slice(&files["TRUTH.json"]).unwrap();
    assert_held("truth-1.json", &truth);
    let levels: Vec<&str> = truth["planted"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["level"].as_str().unwrap())
        .collect();
    assert_eq!(levels, ["type", "tail", "tail"]);
    // Its own files are not strangers in the folder.
    simulate().expect(0);
    assert_eq!(bytes_below(&folder), files);
}

#[test]
fn tuned_settings_are_kept_by_the_model() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let tuned = scratch.path().join("TUNED.ron");
    let ran = cruisefit(&[
        "tune".as_ref(),
        fixture("reports").as_os_str(),
        "--model".as_ref(),
        model.as_os_str(),
        "-o".as_ref(),
        tuned.as_os_str(),
    ])
    .expect(0);
    assert!(ran.stdout.contains("ln evidence"), "{}", ran.stdout);
    // Twelve flights are few, and what is printed are settings with units.
    ran.says("fewer than 20 flights");
    assert!(
        ran.stdout.contains("a prior that keeps each setting near its start"),
        "{}",
        ran.stdout
    );
    assert!(
        ran.stdout.contains("  correction_std                              10 % of drag\n"),
        "{}",
        ran.stdout
    );
    assert!(ran.stdout.contains("none (knowledge does not age)"), "{}", ran.stdout);
    let output = scratch.path().join("out");
    adapt(&tuned, &output, &[fixture("reports/0001.txt")], &[]).expect(0);
    // Other settings are another initial state.
    adapt(&model, &output, &[fixture("reports/0002.txt")], &[])
        .expect(2)
        .says("was started with another setting");
}

/// Cruise reports and tables of segments need no mapping, and none hurts them. What is refused is counted in flights by every command.
#[test]
fn own_files_are_read_as_what_they_are_where_a_mapping_is_in_force() {
    let scratch = tempfile::tempdir().unwrap();
    let path = |name: &str| scratch.path().join(name).to_str().unwrap().to_owned();
    let reports = fixture("reports").to_str().unwrap().to_owned();
    let (plain, mapped, again) = (path("plain.csv"), path("mapped.csv"), path("again.csv"));
    let mapping = "--mapping=cruise-points";
    cruisefit(&["segment", &reports, "-o", &plain]).expect(0);
    cruisefit(&["segment", &reports, mapping, "-o", &mapped]).expect(0);
    cruisefit(&["segment", &mapped, mapping, "-o", &again]).expect(0);
    for table in [&mapped, &again] {
        assert_eq!(std::fs::read(table).unwrap(), std::fs::read(&plain).unwrap());
    }
    // Twelve flights of one file, whose type is open between two models.
    let model = initial_model(scratch.path()).to_str().unwrap().to_owned();
    let (a320, other) = (path("a320"), path("OTHER.ron"));
    cruisefit(&["guide", "--type", "A320", "-o", &a320]).expect(0);
    let (aircraft, guide) = (path("a320/AIRCRAFT.ron"), path("a320/guide.csv"));
    cruisefit(&["init", "--aircraft", &aircraft, "--guide", &guide, "-o", &other]).expect(0);
    let output = path("out");
    for command in [&["evaluate"][..], &["adapt", "-o", &output]] {
        let words = [command, &[&plain, "--model", &model, "--model", &other]].concat();
        cruisefit(&words).expect(2).says("no report could be used, 12 refused");
    }
}

/// Flights that show nothing of the noise, and those of another aircraft, make no settings.
#[test]
fn tune_refuses_what_it_finds_no_settings_from() {
    let scratch = tempfile::tempdir().unwrap();
    let path = |name: &str| scratch.path().join(name);
    let model = initial_model(scratch.path());
    let tune = |reports: &Path| {
        let tuned = path("TUNED.ron");
        let words = [
            "tune".as_ref(),
            reports.as_os_str(),
            "--model".as_ref(),
            model.as_os_str(),
            "-o".as_ref(),
            tuned.as_os_str(),
        ];
        let ran = cruisefit(&words).expect(2);
        assert!(!tuned.exists());
        ran
    };
    let report = std::fs::read_to_string(fixture("reports/0001.txt")).unwrap();
    let rows = report.lines().position(|line| line.starts_with("TIME ")).unwrap() + 6;
    let short: Vec<&str> = report.lines().take(rows).collect();
    std::fs::write(path("short.txt"), short.join("\n") + "\n").unwrap();
    tune(&path("short.txt")).says("1 flight and no segment inside the model's table");
    std::fs::create_dir(path("other")).unwrap();
    for name in ["0001.txt", "0002.txt"] {
        let report = std::fs::read_to_string(fixture("reports").join(name)).unwrap();
        std::fs::write(path("other").join(name), report.replace("global5000", "A320")).unwrap();
    }
    tune(&path("other"))
        .says("found aircraft type \"A320\", expected \"global5000\"")
        .says("no report could be used, 2 refused");
    // `check` says that it has compared them with nothing.
    let other = path("other");
    let words = ["check".as_ref(), other.as_os_str(), "--model".as_ref(), model.as_os_str()];
    let checked = cruisefit(&words).expect(0);
    assert!(checked.stdout.contains("no-model-of-its-own"), "{}", checked.stdout);
    assert!(
        checked.stdout.contains("2 flights compared with no model: found aircraft type \"A320\""),
        "{}",
        checked.stdout
    );
}

#[test]
fn half_life_is_set_and_searched() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let aged = scratch.path().join("AGED.ron");
    let reports = fixture("reports");
    let tune = |half_life: &str| {
        let arguments = ["tune", reports.to_str().unwrap(), "--model", model.to_str().unwrap()];
        let option = format!("--half-life={half_life}");
        cruisefit(&[&arguments[..], &["-o", aged.to_str().unwrap(), &option]].concat())
    };
    let ran = tune("365").expect(0);
    assert!(ran.stdout.contains("Noise stays as it is"), "{}", ran.stdout);
    assert!(std::fs::read_to_string(&aged).unwrap().contains("half_life_days: Some(365.0)"));
    adapt(&aged, &scratch.path().join("out"), std::slice::from_ref(&reports), &[]).expect(0);
    // Twelve flights of an aircraft that does not age: none is found, and noise is searched.
    let ran = tune("search").expect(0);
    assert!(ran.stdout.contains("half-life none") && ran.stdout.contains("ln evidence"));
    assert!(std::fs::read_to_string(&aged).unwrap().contains("half_life_days: None"));
    for wrong in ["-3", "soon"] {
        tune(wrong).expect(2).says("half-life");
    }
}

#[test]
fn polynomial_with_covariance() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    adapt(&model, &output, &[fixture("reports")], &[]).expect(0);
    let csv = scratch.path().join("polynomial.csv");
    cruisefit(&[
        "export".as_ref(),
        output.join("models/SIM-01.ron").as_os_str(),
        "--polynomial".as_ref(),
        "-o".as_ref(),
        csv.as_os_str(),
    ])
    .expect(0);
    let columns = csv_columns(&csv);
    assert_eq!(numbers(&columns, "value").len(), 6);
    for coefficient in 0..6 {
        assert!(numbers(&columns, &format!("covariance_{coefficient}"))[coefficient] > 0.0);
    }
}
