//! The pages and figures that runs write, and the topics that are explained.

use std::fs;
use std::path::Path;

use crate::support::{adapt, cruisefit, csv_columns, fixture, initial_model};

#[test]
fn numbers_of_the_verdict() {
    let scratch = tempfile::tempdir().unwrap();
    cruisefit(&["demo".as_ref(), "-o".as_ref(), scratch.path().as_os_str()]).expect(0);
    check_numbers(scratch.path());
    check_plots(scratch.path());
}

/// What is forwarded is one file, of up to two hundred tails; of more, each tail has its own.
#[test]
fn a_fleet_is_one_page_up_to_two_hundred_tails() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let report = fs::read_to_string(fixture("reports/0001.txt")).unwrap();
    assert!(report.contains("SIM-01"));
    let reports = scratch.path().join("reports");
    fs::create_dir(&reports).unwrap();
    let (mut tails, output) = (0, scratch.path().join("out"));
    for (until, pages) in [(31, 0), (200, 0), (201, 201)] {
        for tail in tails..until {
            let text = report.replace("SIM-01", &format!("T-{tail}"));
            fs::write(reports.join(format!("{tail}.txt")), text).unwrap();
        }
        tails = until;
        let law = ["--law", "paper"];
        adapt(&model, &output, std::slice::from_ref(&reports), &law).expect(0);
        let page = fs::read_to_string(output.join("report.html")).unwrap();
        let sections = page.matches("<details class=\"tail\"").count();
        assert_eq!(sections, if pages == 0 { until } else { 0 }, "{until} tails");
        let own = fs::read_dir(output.join("pages")).map_or(0, Iterator::count);
        assert_eq!(own, pages, "{until} tails");
    }
}

/// The charts of documents: of a diagnosis, of months, of blind trials.
fn check_plots(demo: &Path) {
    let (adapted, months) = (demo.join("adapted-bayes"), demo.join("monitor"));
    cruisefit(&["monitor".as_ref(), adapted.as_os_str(), "-o".as_ref(), months.as_os_str()])
        .expect(0);
    let trials = demo.join("trials.json");
    let group = r#"{"denied": "exact", "background": "clean", "times": 1.0,
        "scores": {"confusion": {"tsfc_level": {"tsfc_level": 3, "no_gap": 1}}}}"#;
    fs::write(&trials, format!(r#"{{"schema": "cruisefit.trials/1", "groups": [{group}]}}"#))
        .unwrap();
    let figure = demo.join("figure.svg");
    for (source, words) in [
        (demo.join("diagnosis/diagnosis.json"), "N750CF: from the gap to the noise"),
        (demo.join("diagnosis"), "N750CF: gap over Mach number and lift coefficient"),
        (months.join("monitor.json"), "N750CF: deviation of fuel flow over time"),
        (months.clone(), "N750CF: deviation of fuel flow over time"),
        (trials.clone(), ">tsfc_level</text>"),
    ] {
        let arguments = ["plot".as_ref(), source.as_os_str(), "-o".as_ref(), figure.as_os_str()];
        cruisefit(&arguments).expect(0);
        let svg = fs::read_to_string(&figure).unwrap();
        assert!(svg.contains(words) && !svg.contains("NaN"), "{}", source.display());
    }
    let maps = demo.join("diagnosis");
    let chosen: [&std::ffi::OsStr; 6] = [
        "plot".as_ref(),
        maps.as_os_str(),
        "--chart".as_ref(),
        "gap-map".as_ref(),
        "-o".as_ref(),
        figure.as_os_str(),
    ];
    cruisefit(&chosen).expect(0);
    let svg = fs::read_to_string(&figure).unwrap();
    assert!(svg.contains("gap over Mach number") && !svg.contains("from the gap to the noise"));
    let polar = chosen.map(|one| if one == "gap-map" { "polar".as_ref() } else { one });
    cruisefit(&polar).expect(2).says("holds no polar of any tail");
    check_gaps(&maps);
    fs::write(&trials, r#"{"schema": "cruisefit.other/1"}"#).unwrap();
    let ran = cruisefit(&["plot".as_ref(), trials.as_os_str(), "-o".as_ref(), figure.as_os_str()]);
    ran.expect(2).says("unknown variant `cruisefit.other/1`");
}

/// The table of gaps has the segments, the mean and the root mean square of the document.
fn check_gaps(diagnosis: &Path) {
    let columns = csv_columns(&diagnosis.join("gaps.csv"));
    let gaps: Vec<f64> =
        columns["gap_before_percent"].iter().map(|cell| cell.parse().unwrap()).collect();
    let json = fs::read_to_string(diagnosis.join("diagnosis.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    crate::json_schema::assert_held("diagnosis-1.json", &json);
    let one = &json["diagnoses"][0];
    assert_eq!(Some(gaps.len() as u64), one["segments"].as_u64());
    let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
    let rms = (gaps.iter().map(|gap| gap * gap).sum::<f64>() / gaps.len() as f64).sqrt();
    for (found, name) in [(mean, "mean_percent"), (rms, "rms_percent")] {
        let expected = one["gap"][name].as_f64().unwrap();
        assert!((found - expected).abs() < 1e-9, "{name}: {found}, document {expected}");
    }
}

/// Every figure of the verdict stands on the page as in the document, and errors before and after as in the summary.
pub(crate) fn check_numbers(folder: &Path) {
    for adapted in ["adapted-bayes", "adapted-paper"] {
        let json = fs::read_to_string(folder.join(adapted).join("summary.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let html = fs::read_to_string(folder.join(adapted).join("report.html")).unwrap();
        for tail in json["tails"].as_array().unwrap() {
            let of = |when: &str| {
                let errors = &tail["fuel_flow_error_percent"][when];
                let number = |name: &str| errors[name].as_f64().unwrap();
                format!(
                    "mean {:+.2} %, std {:.2} %, n {}",
                    number("mean"),
                    number("std"),
                    errors["n"]
                )
            };
            let words = format!("before: {}. after: {}.", of("before"), of("after"));
            assert!(html.contains(&words), "{adapted}: {words}");
        }
    }
    let json = fs::read_to_string(folder.join("diagnosis/diagnosis.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let html = fs::read_to_string(folder.join("diagnosis/diagnosis.html")).unwrap();
    for diagnosis in json["diagnoses"].as_array().unwrap() {
        let gap = |name: &str| diagnosis["gap"][name].as_f64().unwrap();
        for figure in [
            format!("{:+.2} % in the mean", gap("mean_percent")),
            format!("{:.2} % rms", gap("rms_percent")),
            format!("noise alone makes {:.2} %", gap("noise_floor_rms_percent")),
            format!("{} flights with {} segments", diagnosis["flights"], diagnosis["segments"]),
        ] {
            assert!(html.contains(&figure), "{figure}");
        }
        for cause in diagnosis["causes"].as_array().unwrap() {
            let probability = format!("<td>{:.3}</td>", cause["probability"].as_f64().unwrap());
            assert!(html.contains(&probability), "{probability}");
        }
    }
}

#[test]
fn a_plot_is_what_the_ending_of_its_name_says() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let plot = |source: &Path, name: &str| {
        let output = scratch.path().join(name);
        let arguments = ["plot".as_ref(), source.as_os_str(), "-o".as_ref(), output.as_os_str()];
        (cruisefit(&arguments), output)
    };
    let (ran, figure) = plot(&model, "model.svg");
    ran.expect(0);
    assert!(fs::read_to_string(figure).unwrap().starts_with("<svg xmlns="));
    for (name, begins) in [("model.png", "\u{fffd}PNG"), ("model.pdf", "%PDF-")] {
        let (ran, figure) = plot(&model, name);
        ran.expect(0);
        let first = fs::read(&figure).unwrap();
        assert!(String::from_utf8_lossy(&first[..8]).starts_with(begins), "{name}");
        plot(&model, name).0.expect(0);
        assert_eq!(fs::read(&figure).unwrap(), first, "{name}: same model, same bytes");
    }
    // To standard output the picture alone, as SVG or as asked for.
    let model_path = model.to_str().unwrap();
    let printed = cruisefit(&["plot", model_path, "-o", "-"]).expect(0).stdout;
    assert_eq!(printed.into_bytes(), fs::read(scratch.path().join("model.svg")).unwrap());
    let asked = std::process::Command::new(env!("CARGO_BIN_EXE_cruisefit"))
        .args(["plot", model_path, "-o", "-", "--format", "pdf"])
        .output()
        .unwrap();
    assert_eq!(asked.stdout, fs::read(scratch.path().join("model.pdf")).unwrap());
    let (ran, figure) = plot(&model, "model.jpeg");
    ran.expect(2).says("found \"jpeg\", expected a name that ends in .svg, .png or .pdf");
    assert!(!figure.exists());
    let folder = scratch.path().join("adapted");
    adapt(&model, &folder, &[fixture("reports")], &[]).expect(0);
    let (ran, figure) = plot(&folder, "tail.svg");
    ran.expect(0);
    let svg = fs::read_to_string(figure).unwrap();
    assert!(svg.contains("error over time") && svg.contains("drag polar at Mach"));
}

#[test]
fn a_topic_that_is_nearly_right_is_named() {
    let ran = cruisefit(&["explain", "tsfc_engine2"]).expect(2);
    ran.says("did you mean tsfc_engine_2");
    assert!(cruisefit(&["explain", "wave_drag"]).expect(0).stdout.contains("Mdd"));
    let effects = cruisefit(&["effects"]).expect(0).stdout;
    assert!(effects.lines().all(|line| line.chars().count() <= 80), "{effects}");
    let listed = cruisefit(&["effects", "--json"]).expect(0).stdout;
    let listed: serde_json::Value = serde_json::from_str(&listed).unwrap();
    assert_eq!(listed.as_array().unwrap().len(), flight::effect::EffectId::ALL.len());
}
