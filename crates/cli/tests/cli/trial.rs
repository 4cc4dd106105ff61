//! Blind trials, small.

use crate::json_schema::assert_held;
use crate::support::{bytes_below, cruisefit};

/// Three cases of eight short flights.
const PLAN: &str = r#"(
    seed: 3, flights: 8, clean_flights: 6, duration_h: 1.0, effects: ["drag_factor"],
    parts: [
        (denied: exact, background: clutter, kind: single, repeats: 1, times: 2.0),
        (denied: exact, background: clean, kind: struck, repeats: 1),
        (denied: adapted, background: clean, kind: null, repeats: 1),
    ],
    floors: [(denied: exact, background: clean, score: reported, least: 0.5)],
)"#;

#[test]
fn a_trial_is_sealed_scored_and_gone_on_from() {
    let scratch = tempfile::tempdir().unwrap();
    let plan = scratch.path().join("plan.ron");
    std::fs::write(&plan, PLAN).unwrap();
    let output = scratch.path().join("out");
    let run = |threads: &str, more: &[&str]| {
        let mut arguments = vec![
            "trial",
            plan.to_str().unwrap(),
            "-o",
            output.to_str().unwrap(),
            "--threads",
            threads,
        ];
        arguments.extend(more);
        cruisefit(&arguments)
    };
    let ran = run("2", &[]).expect(0);
    assert!(ran.stdout.contains("exact model, clutter, 2 x typical: 1 single"), "{}", ran.stdout);
    let expected = bytes_below(&output);
    let trials: serde_json::Value = serde_json::from_slice(&expected["trials.json"]).unwrap();
    assert_held("trials-1.json", &trials);
    // The hash that was printed at the start is the one in the results.
    ran.says(trials["seal_sha256"].as_str().unwrap());
    assert_eq!(trials["cases"].as_array().unwrap().len(), 3);
    check_page(std::str::from_utf8(&expected["trials.html"]).unwrap(), &trials);
    let truth: serde_json::Value = serde_json::from_slice(&expected["truth/00001.json"]).unwrap();
    assert_eq!(truth["effects"][0]["id"], "drag_factor");
    // Twice the typical 2 %, of either sign; every other effect is there too, but for those that are known.
    let size = truth["effects"][0]["size"].as_f64().unwrap();
    assert!((size.abs() - 4.0).abs() < 1e-12, "{size}");
    assert_eq!(truth["clutter"].as_array().unwrap().len(), 29);

    // An interrupted run continues: the remaining cases give the same result, to the last byte, on one thread as on
    // two.
    std::fs::remove_file(output.join("cases/00002.json")).unwrap();
    std::fs::remove_file(output.join("trials.json")).unwrap();
    run("1", &[]).expect(0);
    assert_eq!(bytes_below(&output), expected);

    // A floor without a case behind it is missed.
    run("2", &["--check"]).expect(2).says("1 scores below their floor, 0 cases failed");
    // Another plan in the same folder is refused, unless started over.
    run("2", &["--seed", "4"]).expect(2).says("was started with another plan");
    // A truth that was changed is noticed.
    let path = output.join("truth/00001.json");
    std::fs::write(&path, std::fs::read_to_string(&path).unwrap().replace("4.0", "5.0")).unwrap();
    run("2", &[]).expect(2).says("was started with another truth");
}

/// Every score, calibration and count of confusions of the document is on the page.
fn check_page(page: &str, trials: &serde_json::Value) {
    let shown: Vec<f64> = page
        .split("data-v=\"")
        .skip(1)
        .filter_map(|rest| rest.split('"').next()?.parse().ok())
        .collect();
    let has = |value: &serde_json::Value| {
        let number = value.as_f64().unwrap();
        // A number read from JSON may differ in its last bit.
        assert!(shown.iter().any(|one| (one - number).abs() <= 1e-12 * number.abs()), "{number}");
    };
    assert!(page.contains(trials["seal_sha256"].as_str().unwrap()) && page.contains("seed 3"));
    for group in trials["groups"].as_array().unwrap() {
        for name in ["reported", "top_one", "silent", "intervals"] {
            let score = &group["scores"][name];
            if score["of"].as_u64() > Some(0) {
                for part in ["share", "of"] {
                    has(&score[part]);
                }
                score["ci95"].as_array().unwrap().iter().for_each(has);
            }
        }
        for bin in group["scores"]["calibration"].as_array().unwrap() {
            has(&bin["stated"]);
            has(&bin["right"]["share"]);
        }
        let confusion = group["scores"]["confusion"].as_object().unwrap();
        confusion.values().flat_map(|row| row.as_object().unwrap().values()).for_each(has);
    }
}

#[test]
fn fleets_are_sealed_scored_and_gone_on_from() {
    let scratch = tempfile::tempdir().unwrap();
    let plan = scratch.path().join("plan.ron");
    // An effect of the type of three times its typical size, one tail of its own, one step.
    let text = "(seed: 3, clean_flights: 6, duration_h: 1.0,
        fleets: [(tails: 4, flights: 5, repeats: 2, step_share: 0.25, times: 3.0)])";
    std::fs::write(&plan, text).unwrap();
    let output = scratch.path().join("out");
    let run = |threads: &str| {
        let paths = (plan.to_str().unwrap(), output.to_str().unwrap());
        cruisefit(&["trial", paths.0, "-o", paths.1, "--threads", threads])
    };
    let ran = run("2").expect(0);
    assert!(
        ran.stdout.contains("fleets of 4 tails, 5 flights each, 3 x typical"),
        "{}",
        ran.stdout
    );
    let expected = bytes_below(&output);
    let trials: serde_json::Value = serde_json::from_slice(&expected["trials.json"]).unwrap();
    ran.says(trials["seal_sha256"].as_str().unwrap());
    assert_held("trials-1.json", &trials);
    assert_eq!(trials["fleets"].as_array().unwrap().len(), 2);
    for fleet in trials["fleets"].as_array().unwrap() {
        assert_eq!(fleet["planted"].as_array().unwrap().len(), 2);
        assert_eq!(fleet["steps"].as_array().unwrap().len(), 1);
    }
    let truth: serde_json::Value =
        serde_json::from_slice(&expected["truth/fleet-00001.json"]).unwrap();
    assert_eq!(truth["planted"][0]["level"], "type");
    // The page and the table show the scores that the document holds.
    let scores = trials["fleet_groups"][0]["scores"].as_array().unwrap();
    let html = std::str::from_utf8(&expected["trials.html"]).unwrap();
    let markdown = std::str::from_utf8(&expected["trials.md"]).unwrap();
    for score in scores.iter().filter(|score| score["reached"]["of"] != 0) {
        let words = score["words"].as_str().unwrap();
        assert!(html.contains(words) && markdown.contains(words), "{words}");
    }

    std::fs::remove_file(output.join("cases/fleet-00002.json")).unwrap();
    run("1").expect(0);
    assert_eq!(bytes_below(&output), expected);

    // A truth that was changed is not scored.
    let sealed = output.join("truth/fleet-00001.json");
    std::fs::write(&sealed, b"{}").unwrap();
    run("1").expect(2).says("fleet 1");
}
