//! What reaches a terminal: width, escapes, formulas, help, errors.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::support::{Ran, adapt, bytes_below, cruisefit, fixture, init, initial_model, root};

/// A tail that a spreadsheet takes for a formula, a terminal for two escapes, a reader for the other direction of writing and a
/// browser for markup.
const HOSTILE: &str = "=1+2\u{1b}[31m\u{9b}5m\u{202e}<b>";

fn hostile_report(folder: &Path) -> PathBuf {
    let text = std::fs::read_to_string(fixture("reports/0001.txt")).unwrap();
    let text: String = text
        .lines()
        .map(|line| {
            if line.starts_with("TAIL") { format!("TAIL {HOSTILE}\n") } else { format!("{line}\n") }
        })
        .collect();
    let path = folder.join("a\u{1b}[31m.txt");
    std::fs::write(&path, text).unwrap();
    path
}

fn is_harmless(what: &str, text: &str) {
    for letter in text.chars() {
        let obeyed = letter.is_control() && !matches!(letter, '\n' | '\t' | '\r');
        assert!(!obeyed && letter != '\u{202e}', "{what} holds {letter:?}");
    }
}

#[test]
fn a_hostile_tail_does_nothing_anywhere() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let report = hostile_report(scratch.path());
    let output = scratch.path().join("out");
    let first = adapt(&model, &output, std::slice::from_ref(&report), &[]).expect(0);
    // Known again from what was written: escapes in files read back.
    let again = adapt(&model, &output, std::slice::from_ref(&report), &[]).expect(0);
    assert!(
        again.stdout.contains("0 read, 1 already known")
            || again.stdout.contains("0 reports read, 1 already known"),
        "{}",
        again.stdout
    );
    let shown = cruisefit(&[
        "evaluate".as_ref(),
        report.as_os_str(),
        "--model".as_ref(),
        output.as_os_str(),
        "--json".as_ref(),
        "-".as_ref(),
    ])
    .expect(0);
    let document: serde_json::Value = serde_json::from_str(&shown.stdout).unwrap();
    assert_eq!(document["tails"][0]["tail"], HOSTILE);
    for (what, text) in [
        ("stdout", &first.stdout),
        ("stderr", &first.stderr),
        ("again", &again.stdout),
        ("json", &shown.stdout),
    ] {
        is_harmless(what, text);
    }
    let mut tables = 0;
    for (name, bytes) in bytes_below(&output) {
        let text = String::from_utf8(bytes).unwrap();
        let ending = Path::new(&name).extension().unwrap_or_default();
        if ending == "csv" {
            is_harmless(&name, &text);
            for cell in csv::ReaderBuilder::new()
                .from_reader(text.as_bytes())
                .records()
                .flat_map(|row| row.unwrap().iter().map(str::to_owned).collect::<Vec<_>>())
            {
                let formula =
                    cell.starts_with(['=', '+', '-', '@']) && cell.parse::<f64>().is_err();
                assert!(!formula, "{name}: {cell}");
            }
            tables += 1;
        }
        if ending == "html" {
            is_harmless(&name, &text);
            assert!(!text.contains("}<b>"), "{name}: markup of a name is text");
        }
    }
    assert_eq!(tables, 3, "segments, flights, deviations");
    // What a planner's own column holds comes through `predict`.
    let points = scratch.path().join("points.csv");
    std::fs::write(
        &points,
        "mass_kg,pressure_altitude_ft,mach,X-route\n30000,41000,0.8,\"=HYPERLINK(\"\"x\"\")\u{1b}[2J\"\n",
    )
    .unwrap();
    let predict = ["predict".as_ref(), "--model".as_ref(), model.as_os_str(), points.as_os_str()];
    let predicted = cruisefit(&predict).expect(0).stdout;
    is_harmless("predict", &predicted);
    assert!(predicted.contains("\"'=HYPERLINK(\"\"x\"\")\\u{1b}[2J\""), "{predicted}");
    let missing = cruisefit(&["show", "no\u{1b}[2Jfile"]).expect(2);
    is_harmless("an error", &missing.stderr);
}

/// Every error that a slip provokes, each without a trace of how the program stores things.
#[test]
fn errors_are_sentences() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (reports, aircraft, guide) =
        (fixture("reports"), fixture("AIRCRAFT.ron"), fixture("guide.csv"));
    let bad = scratch.path().join("bad.ron");
    std::fs::write(&bad, "(\n    name: \"x\",\n    wing_area: 3,\n)\n").unwrap();
    let bad_guide = scratch.path().join("bad.csv");
    std::fs::write(&bad_guide, "weight_lb,pressure_altitude_ft,mahc,fuel_flow_lb_h\n1,2,3,4\n")
        .unwrap();
    let wrong_effect = scratch.path().join("plan.ron");
    let plan = include_str!("../../../simulate/examples/plan.ron");
    std::fs::write(&wrong_effect, plan.replacen("wave_drag", "wave_drga", 1)).unwrap();
    let out = scratch.path().join("out");
    let plain = |path: &Path| path.to_str().unwrap().to_owned();
    let (model, reports, aircraft, guide) =
        (plain(&model), plain(&reports), plain(&aircraft), plain(&guide));
    let (bad, bad_guide, out, folder, wrong_effect) =
        (plain(&bad), plain(&bad_guide), plain(&out), plain(scratch.path()), plain(&wrong_effect));
    adapt(Path::new(&model), Path::new(&out), &[fixture("reports")], &[]).expect(0);
    let learnt = format!("{out}/models/SIM-01.ron");
    let cases: Vec<(Vec<&str>, &str)> = vec![
        (vec!["adpt"], "'adapt'"),
        (
            vec!["init", "--aircraft", &bad, "--guide", &guide, "-o", "-"],
            "did you mean wing_area_m2?",
        ),
        (
            vec!["init", "--aircraft", &aircraft, "--guide", &bad_guide, "-o", "-"],
            "did you mean mach?",
        ),
        (vec!["init", "--aircraft", &guide, "--guide", &guide, "-o", "-"], "not an aircraft file"),
        (vec!["show", &bad], "not a model file"),
        (vec!["show", &folder], "a folder without"),
        (vec!["evaluate", &reports, "--model", &bad], "not a model file"),
        (vec!["evaluate", &reports, "--model", "MODL.ron"], "No such file"),
        (
            vec!["diagnose", &reports, "--model", &learnt, "-o", "x", "--effects", "tsfc_engine2"],
            "did you mean tsfc_engine_2?",
        ),
        (
            vec!["segment", &reports, "--criteria", "airbus-report-2"],
            "did you mean airbus-report-02?",
        ),
        (vec!["segment", &reports, "--mapping", "traffic-a32"], "did you mean traffic-a320?"),
        (vec!["segment", &reports, "--mapping", "acropol"], "did you mean acropole-a320?"),
        (vec!["segment", &reports, "--mapping", &bad], "bad.ron"),
        (vec!["explain", "tsfc_engine2"], "did you mean tsfc_engine_2?"),
        (vec!["guide", "--type", "ZZZZ", "-o", "x"], "no public model of ZZZZ"),
        (vec!["predict", "--model", &model, &guide], "unknown column"),
        (vec!["tune", &reports, "--model", &learnt, "-o", "-"], "has learnt already"),
        (vec!["merge", &model, &learnt, "-o", "-"], "has learnt nothing"),
        (vec!["monitor", &folder], "found no model in models/"),
        (vec!["monitor", "no-such-folder"], "No such file"),
        (vec!["show", &guide], "this is a table (CSV)"),
        (vec!["plot", &out, "--tail", "SIM-11", "-o", "x.svg"], "did you mean"),
        (vec!["simulate", &bad, "-o", "x"], "bad.ron"),
        (vec!["simulate", &wrong_effect, "-o", "x"], "did you mean wave_drag?"),
        (vec!["plot", &model, "-o", "-", "--json"], "standard output has room"),
        (
            vec!["plot", &model, "-o", "x.svg", "--format", "jpeg"],
            "[possible values: svg, png, pdf]",
        ),
        (vec!["trial", &bad, "-o", "x"], "bad.ron"),
        (vec!["golden", "check", &folder], "golden.ron"),
        (
            vec!["adapt", &reports, "--model", &model, "-o", &out, "--law", "paper"],
            "was started with another law",
        ),
        (vec!["forget", &out, "--tail", "SIM-1", "--flight", "1"], "did you mean SIM-01?"),
        (vec!["export", &model, "-o", "x.foo"], "x.foo"),
        (vec!["plot", &model, "-o", "x.foo"], "x.foo"),
        (vec!["optimum", "--model", &model, "--levels", "abc"], "abc"),
        (
            vec!["evaluate", &reports, "--model", &model, "--json", &guide],
            "was not made by this command",
        ),
        (vec!["mapping", "no-such-recording.csv"], "No such file"),
    ];
    for (arguments, words) in cases {
        let ran = cruisefit(&arguments).expect(2);
        ran.says(words);
        is_no_debug_print(&arguments, &ran);
    }
}

/// `Name { field: value }`, `Some(3)`, `Err("x")`: how Rust prints what it stores.
fn is_no_debug_print(arguments: &[&str], ran: &Ran) {
    // The line of the user's file that is shown under a message is the user's.
    let own = |line: &&str| !line.contains(" │ ") && !line.contains(" | ");
    for line in ran.stderr.lines().filter(own) {
        for shape in [" { ", "Some(", "None", "Ok(", "Err(", "::", "os error", "\\\""] {
            assert!(!line.contains(shape), "{arguments:?}: {shape} in {line}");
        }
    }
}

#[test]
fn the_offending_line_is_shown() {
    let scratch = tempfile::tempdir().unwrap();
    let bad = scratch.path().join("bad.ron");
    std::fs::write(&bad, "(\n    name: \"x\",\n    wing_area: 3,\n)\n").unwrap();
    let guide = fixture("guide.csv");
    let ran = cruisefit(&[
        "init".as_ref(),
        "--aircraft".as_ref(),
        bad.as_os_str(),
        "--guide".as_ref(),
        guide.as_os_str(),
        "-o".as_ref(),
        "-".as_ref(),
    ])
    .expect(2);
    assert!(ran.stderr.contains("  3 │     wing_area: 3,"), "{}", ran.stderr);
    let text = std::fs::read_to_string(fixture("reports/0001.txt")).unwrap();
    let report = scratch.path().join("0001.txt");
    std::fs::write(&report, text.replacen("0.7665", "NaN", 1)).unwrap();
    let ran = cruisefit(&["segment".as_ref(), report.as_os_str()]).expect(2);
    let underlined = ran.stderr.lines().find(|line| line.contains("^^^")).unwrap_or_default();
    let above =
        ran.stderr.lines().find(|line| line.contains(" │ ") && line.contains("NaN")).unwrap();
    assert_eq!(above.find("NaN"), underlined.find("^^^"), "{}", ran.stderr);
}

#[test]
fn tables_fit_80_columns() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let output = scratch.path().join("out");
    let adapted = adapt(&model, &output, &[fixture("reports")], &[]).expect(0);
    let learnt = output.join("models/SIM-01.ron");
    let learnt = learnt.to_str().unwrap();
    let (output, reports) = (output.to_str().unwrap(), fixture("reports"));
    let reports = reports.to_str().unwrap();
    let report = fixture("reports/0001.txt");
    let shown = [
        adapted,
        cruisefit(&["show", learnt]),
        cruisefit(&["show", report.to_str().unwrap()]),
        cruisefit(&["show", output]),
        cruisefit(&["evaluate", reports, "--model", learnt]),
        cruisefit(&["optimum", "--model", learnt]),
        cruisefit(&["monitor", output]),
        cruisefit(&["monitor", output, "--month"]),
        cruisefit(&["effects"]),
        cruisefit(&["explain"]),
    ];
    for ran in shown {
        let ran = ran.expect(0);
        // Sentences are wrapped by the terminal's width; rows of tables have two blanks between columns.
        for line in ran.stdout.lines().filter(|line| line.trim().matches("  ").count() >= 2) {
            assert!(line.chars().count() <= 80, "{line}");
        }
    }
}

#[test]
fn quiet_leaves_results() {
    let scratch = tempfile::tempdir().unwrap();
    let model = scratch.path().join("MODEL.ron");
    let quiet = init(&model, &["--quiet".as_ref()]).expect(0);
    assert_eq!((quiet.stdout.as_str(), quiet.stderr.as_str()), ("", ""));
    let shown = cruisefit(&["show".as_ref(), model.as_os_str(), "-q".as_ref()]).expect(0);
    assert!(shown.stdout.contains("Global 5000"), "{}", shown.stdout);
    let coloured = cruisefit(&["effects", "--color", "always"]).expect(0);
    assert!(coloured.stdout.contains("\u{1b}[1m"), "{}", coloured.stdout);
    assert!(!cruisefit(&["effects"]).expect(0).stdout.contains('\u{1b}'));
}

#[test]
fn every_command_prints_a_document() {
    let scratch = tempfile::tempdir().unwrap();
    let path = |name: &str| scratch.path().join(name).to_str().unwrap().to_owned();
    let (model, out, later) = (path("MODEL.ron"), path("out"), path("diagnosis"));
    let plain = |path: PathBuf| path.to_str().unwrap().to_owned();
    let (aircraft, guide, reports) =
        (plain(fixture("AIRCRAFT.ron")), plain(fixture("guide.csv")), plain(fixture("reports")));
    let (learnt, points) = (format!("{out}/models/SIM-01.ron"), path("points.csv"));
    std::fs::write(
        &points,
        "mass_kg,pressure_altitude_ft,mach,isa_deviation_c\n30000,41000,0.8,0\n",
    )
    .unwrap();
    let runs: Vec<Vec<&str>> = vec![
        vec!["init", "--aircraft", &aircraft, "--guide", &guide, "-o", &model],
        vec!["adapt", &reports, "--model", &model, "-o", &out],
        vec!["evaluate", &reports, "--model", &learnt],
        vec!["check", &reports],
        vec!["segment", &reports],
        vec!["predict", "--model", &model, &points],
        vec!["diagnose", &reports, "--model", &learnt, "-o", &later, "--allow-learnt"],
        vec!["monitor", &out],
        vec!["optimum", "--model", &learnt],
        vec!["show", &learnt],
        vec!["show", &later],
        vec!["show", &out],
        vec!["effects"],
        vec!["explain", "wave_drag"],
        vec!["guide", "--list"],
        vec!["mapping", "--presets"],
        vec!["forget", &out, "--tail", "SIM-01", "--flight", "0001"],
    ];
    for mut run in runs {
        run.push("--json");
        let ran = cruisefit(&run).expect(0);
        let parsed: Result<serde_json::Value, _> = serde_json::from_str(&ran.stdout);
        assert!(parsed.is_ok(), "{run:?}: {}", ran.stdout);
    }
}

#[test]
fn standard_input_is_a_file() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let piped = |arguments: &[&str], input: &[u8]| {
        let mut child = Command::new(env!("CARGO_BIN_EXE_cruisefit"))
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::io::Write::write_all(&mut child.stdin.take().unwrap(), input).unwrap();
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    let report = fixture("reports/0001.txt");
    let by_name = cruisefit(&["segment".as_ref(), report.as_os_str()]).expect(0);
    let by_pipe = piped(&["segment", "-"], &std::fs::read(&report).unwrap());
    assert_eq!(String::from_utf8(by_pipe).unwrap(), by_name.stdout);
    let points = b"mass_kg,pressure_altitude_ft,mach,isa_deviation_c\n30000,41000,0.8,0\n";
    let predicted = piped(&["predict", "--model", model.to_str().unwrap(), "-"], points);
    assert_eq!(String::from_utf8(predicted).unwrap().lines().count(), 2);
    let shown = piped(&["show", "-"], &std::fs::read(&model).unwrap());
    assert!(String::from_utf8(shown).unwrap().contains("It has learnt nothing yet."));
}

#[test]
fn the_book_holds_what_explain_prints() {
    let page = std::fs::read_to_string(root().join("docs/src/guides/topics.md")).unwrap();
    let printed = cruisefit(&["explain", "--book"]).expect(0).stdout;
    assert!(page == printed, "docs/topics.sh writes docs/src/guides/topics.md anew");
}
