//! `monitor`: from a folder of `adapt` to tables, JSON, text, alerts.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::json_schema::violations;
use crate::support::{
    Ran, adapt, bytes_below, cruisefit, csv_columns, fixture, initial_model, root,
};

/// The fixture's twelve flights, adapted.
fn adapted(folder: &Path) -> PathBuf {
    let model = initial_model(folder);
    let output = folder.join("adapted");
    adapt(&model, &output, &[fixture("reports")], &[]).expect(0);
    output
}

fn reports() -> Vec<PathBuf> {
    (1..=12).map(|flight| fixture(&format!("reports/{flight:04}.txt"))).collect()
}

fn monitor(folder: &Path, more: &[&str]) -> Ran {
    let mut arguments: Vec<std::ffi::OsString> = vec!["monitor".into(), folder.into()];
    arguments.extend(more.iter().map(Into::into));
    cruisefit(&arguments)
}

fn numbers(column: &[String]) -> Vec<f64> {
    column.iter().map(|field| field.parse().unwrap()).collect()
}

#[test]
fn tables_json_and_text_agree_and_hold_their_schema() {
    let folder = tempfile::tempdir().unwrap();
    let adapted = adapted(folder.path());
    let before = bytes_below(&adapted);
    let output = folder.path().join("out");
    let printed = monitor(&adapted, &["-o", output.to_str().unwrap()]).expect(0).stdout;
    assert_eq!(bytes_below(&adapted), before, "monitor only reads");
    for line in printed.lines().filter(|line| !line.starts_with("Written to")) {
        assert!(line.chars().count() <= 80, "{line}");
    }
    let json = monitor(&adapted, &["--json"]).expect(0).stdout;
    assert_eq!(json.as_bytes(), std::fs::read(output.join("monitor.json")).unwrap());
    let document: Value = serde_json::from_str(&json).unwrap();
    let schema = std::fs::read(root().join("docs/schemas/monitor-1.json")).unwrap();
    let found = violations(&serde_json::from_slice(&schema).unwrap(), &document);
    assert!(found.is_empty(), "{found:#?}");
    let tail = &document["tails"][0];
    let flights = csv_columns(&output.join("flights.csv"));
    assert_eq!(flights["flight"].len(), tail["flights"].as_array().unwrap().len());
    let deviation = tail["flights"][0]["deviation_percent"]["value"].as_f64().unwrap();
    assert_eq!(numbers(&flights["deviation_percent"])[0].to_bits(), deviation.to_bits());
}

/// By hand: a flight that gives no segment was flown all the same, so that the rate of flights is that of twelve.
#[test]
fn flights_without_a_segment_count_in_the_rate_of_flights() {
    let folder = tempfile::tempdir().unwrap();
    let rate_of = |folder: &Path| {
        let text = monitor(folder, &["--json"]).expect(0).stdout;
        let tail = serde_json::from_str::<Value>(&text).unwrap()["tails"][0].take();
        let rate = tail["cost"]["flights_per_year"].as_f64().unwrap();
        (rate, tail["flights_without_segments"].clone())
    };
    let mut cut = reports();
    // Over less than a month there is no rate.
    let last = std::fs::read_to_string(&cut[11]).unwrap();
    cut[11] = folder.path().join("last.txt");
    std::fs::write(&cut[11], last.replace("2019-04-08", "2019-06-08")).unwrap();
    let (model, whole) = (initial_model(folder.path()), folder.path().join("whole"));
    adapt(&model, &whole, &cut, &[]).expect(0);
    for place in [4, 7] {
        // Three rows, in which it rolls.
        let text = std::fs::read_to_string(&cut[place]).unwrap();
        let head = text.lines().position(|line| line.starts_with("TIME")).unwrap();
        let few: String = text.lines().take(head + 5).flat_map(|line| [line, "\n"]).collect();
        let few = few.replace("  -0.1  ", "  20.1  ").replace("  -0.2  ", "  20.2  ");
        cut[place] = folder.path().join(format!("cut-{place}.txt"));
        std::fs::write(&cut[place], few).unwrap();
    }
    let output = folder.path().join("cut");
    adapt(&model, &output, &cut, &[]).expect(0);
    assert_eq!(rate_of(&whole).1, Value::from(0));
    assert_eq!(rate_of(&output), (rate_of(&whole).0, Value::from(2)));
    let stored = monitor(&output, &[]).expect(0).stdout;
    assert!(stored.contains("2 learnt flights beside these, no segment inside the table"));
    // The same from model and segments, where the table of flights is missing.
    std::fs::remove_file(output.join("deviations/SIM-01.csv")).unwrap();
    let anew = monitor(&output, &[]).expect(0).stdout;
    assert_eq!(anew, stored);
}

/// Against the fuel factor of `evaluate`, which is the mean over flights of the same deviation from the book, and against the error that
/// `adapt` wrote: 100 ln(recorded/predicted) of the initial model before the first flight, because nothing had been learnt then.
#[test]
fn deviations_are_those_of_the_segments() {
    let folder = tempfile::tempdir().unwrap();
    let adapted = adapted(folder.path());
    let output = folder.path().join("out");
    monitor(&adapted, &["-o", output.to_str().unwrap()]).expect(0);
    let flights = csv_columns(&output.join("flights.csv"));
    let segments_file = std::fs::read_dir(adapted.join("segments")).unwrap().next().unwrap();
    let segments = csv_columns(&segments_file.unwrap().path());
    let shown = numbers(&flights["initial_deviation_percent"]);
    let factors = folder.path().join("factors.csv");
    let mut words: Vec<std::ffi::OsString> = vec!["evaluate".into(), fixture("reports").into()];
    words.extend(["--model".into(), initial_model(folder.path()).into()]);
    words.extend(["--fuel-factors".into(), factors.clone().into()]);
    cruisefit(&words).expect(0);
    let factor = numbers(&csv_columns(&factors)["fuel_factor_percent_of_predicted"])[0];
    let mean = shown.iter().sum::<f64>() / shown.len() as f64;
    assert!((100.0 * (factor / 100.0).ln_1p() - mean).abs() < 1e-9, "{factor} against {mean}");
    let of_initial = |flight: &str| {
        let rows = segments["flight"].iter().enumerate().filter(|(_, name)| *name == flight);
        let errors: Vec<f64> = rows
            .filter(|(row, _)| !segments["error_percent"][*row].is_empty())
            .map(|(row, _)| segments["error_percent"][row].parse().unwrap())
            .collect();
        // error = 100 (recorded − predicted)/recorded, so that predicted/recorded = 1 − error/100.
        let deviations = errors.iter().map(|error| -100.0 * (1.0 - error / 100.0).ln());
        deviations.sum::<f64>() / errors.len() as f64
    };
    let first: f64 = flights["before_learning_percent"][0].parse().unwrap();
    let expected = of_initial(&flights["flight"][0]);
    assert!((first - expected).abs() < 1e-9, "{first} against {expected}");
    // The book is some per cent too optimistic, at each level alike; what the model knew after the first flights is not.
    let last: f64 = flights["before_learning_percent"].last().unwrap().parse().unwrap();
    assert!(mean > 1.5 && last.abs() < 0.5 * mean, "{shown:?} {last}");
}

#[test]
fn alerts_set_the_exit_status_and_name_likely_causes() {
    let folder = tempfile::tempdir().unwrap();
    let adapted = adapted(folder.path());
    let diagnosis = folder.path().join("diagnosis.json");
    let text = r#"{"diagnoses": [{"tail": "SIM-01", "compared": {"flights_learnt": 0},
        "verdict": {"kind": "effects", "effects": ["drag_factor"], "class": ["drag_factor", "tsfc_factor"],
        "probability": 0.83, "closure": 0.9},
        "causes": [{"effect": "drag_factor", "magnitude": {"value": -2.1}}]}]}"#;
    std::fs::write(&diagnosis, text).unwrap();
    let more = ["--alert", "deviation=1", "--diagnosis", diagnosis.to_str().unwrap()];
    let pages = folder.path().join("pages");
    let with_page = [&more[..], &["-o", pages.to_str().unwrap()]].concat();
    let printed = monitor(&adapted, &with_page).expect(3).stdout;
    // A person reads words, at the sign that was found, where the diagnosis has one.
    let page = std::fs::read_to_string(pages.join("monitor.html")).unwrap();
    let words = flight::effect::EffectId::DragFactor.phrase(-1.0);
    assert!(page.contains(&format!("likely {words} (drag_factor), or tsfc_factor")), "{words}");
    assert!(printed.contains("ALERT SIM-01"), "{printed}");
    assert!(printed.contains("likely: drag_factor, tsfc_factor"), "{printed}");
    // The tail's own model has learnt what it burns beyond its book; another tail's has not.
    let against =
        |learnt: &str| std::fs::write(&diagnosis, text.replace(r#""flights_learnt": 0"#, learnt));
    against(r#""flights_learnt": 40"#).unwrap();
    let printed = monitor(&adapted, &more).expect(3).stdout;
    assert!(
        printed.contains("no likely cause: the newest diagnosis is against the tail's own model"),
        "{printed}"
    );
    against(r#""flights_learnt": 40, "learnt_tail": "SIM-02""#).unwrap();
    let printed = monitor(&adapted, &more).expect(3).stdout;
    assert!(printed.contains("likely: drag_factor, tsfc_factor"), "{printed}");
    monitor(&adapted, &["--alert", "deviation=50"]).expect(0);
    monitor(&adapted, &["--alert", "speed=1"]).expect(2).says("expected deviation=PCT");
    monitor(&adapted, &["--since", "27/03/2019"]).expect(2).says("expected a date like 2026-03-02");
    let output = folder.path().join("none");
    let none = monitor(&adapted, &["--since", "2029-01-01", "-o", output.to_str().unwrap()]);
    none.expect(0).says("no segment is inside the table since 2029-01-01T00:00:00Z");
    let header = std::fs::read_to_string(output.join("flights.csv")).unwrap();
    assert!(header.starts_with("tail,flight,start,") && header.lines().count() == 1, "{header}");
}

/// A verdict that advises not to act names nothing, and one that names no effect is no cause.
#[test]
fn what_does_not_stand_out_is_no_likely_cause() {
    let folder = tempfile::tempdir().unwrap();
    let adapted = adapted(folder.path());
    let (diagnosis, output) = (folder.path().join("diagnosis.json"), folder.path().join("out"));
    let open = r#""effects", "effects": ["drag_factor"], "class": ["drag_factor", "isobaric_slope"], "probability": 0.17"#;
    for (verdict, reason) in [
        (open, "no cause stands out, the most probable has 0.17"),
        (r#""no_gap", "effects": [], "class": [], "probability": 0.0"#, "no gap is seen"),
        (r#""outside_library", "effects": [], "class": [], "probability": 0.0"#, "no effect of"),
    ] {
        let text = format!(
            r#"{{"diagnoses": [{{"tail": "SIM-01", "compared": {{}}, "verdict": {{"kind": {verdict}}}}}]}}"#
        );
        std::fs::write(&diagnosis, text).unwrap();
        let more = ["--alert", "deviation=1", "--diagnosis", diagnosis.to_str().unwrap()];
        let printed = monitor(&adapted, &[&more[..], &["-o", output.to_str().unwrap()]].concat());
        let printed = printed.expect(3).stdout;
        assert!(printed.contains(&format!("no likely cause: {reason}")), "{printed}");
        assert!(!printed.contains("  likely: "), "{printed}");
        assert_eq!(csv_columns(&output.join("alerts.csv"))["likely_causes"], [""]);
        let page = std::fs::read_to_string(output.join("monitor.html")).unwrap();
        assert!(page.contains(reason) && !page.contains("isobaric_slope"), "{verdict}");
    }
}

/// All that is said of what to plan with is one factor, that of the level.
#[test]
fn terminal_page_and_tables_have_one_factor() {
    let folder = tempfile::tempdir().unwrap();
    let adapted = adapted(folder.path());
    let output = folder.path().join("out");
    let more = ["--basic-perf-factor", "1.5", "-o", output.to_str().unwrap()];
    let printed = monitor(&adapted, &more).expect(0).stdout;
    let tails = csv_columns(&output.join("tails.csv"));
    let number = |name: &str| numbers(&tails[name])[0];
    let level = number("deviation_percent");
    let factor = number("fuel_factor_percent");
    assert!((factor - 100.0 * ((level / 100.0).exp() - 1.0)).abs() < 1e-9, "{factor} {level}");
    let entered = (10.0 * factor).ceil() / 10.0;
    let told = format!("PERF FACTOR {:+.1} %, basic +1.5 and factor {entered:+.1}", entered + 1.5);
    assert!(printed.contains(&told), "{printed}");
    assert!((number("performance_factor_percent") - entered - 1.5).abs() < 1e-9);
    let page = std::fs::read_to_string(output.join("monitor.html")).unwrap();
    assert!(page.contains(&format!("a fuel factor of {entered:+.1} %")), "{told}");
    // What a flight and a year cost is of the level too: 100·excess/burnt = 100·(1 − e^(−d/100)).
    let per_flight = number("excess_fuel_kg_per_flight");
    let burnt = per_flight / (1.0 - (-level / 100.0).exp());
    let document: Value =
        serde_json::from_slice(&std::fs::read(output.join("monitor.json")).unwrap()).unwrap();
    let flights = document["tails"][0]["flights"].as_array().unwrap();
    let mean = flights.iter().map(|flight| {
        let percent = flight["deviation_percent"]["value"].as_f64().unwrap();
        flight["excess_fuel_kg"].as_f64().unwrap() / (1.0 - (-percent / 100.0).exp())
    });
    assert!((burnt - mean.sum::<f64>() / flights.len() as f64).abs() < 1e-6, "{burnt}");
    // And what is shown of such a folder is what was printed.
    let shown = cruisefit(&["show".as_ref(), output.as_os_str()]).expect(0).stdout;
    assert!(printed.starts_with(&shown), "{shown}");
}

#[test]
fn events_are_measured_or_refused_with_their_position() {
    let folder = tempfile::tempdir().unwrap();
    let adapted = adapted(folder.path());
    let events = folder.path().join("EVENTS.csv");
    let flights = {
        let output = folder.path().join("out");
        monitor(&adapted, &["-o", output.to_str().unwrap(), "--quick"]).expect(0);
        csv_columns(&output.join("flights.csv"))
    };
    assert!(flights["before_learning_percent"].iter().all(String::is_empty));
    let middle = &flights["start"][6];
    std::fs::write(&events, format!("date,tail,kind,note\n{middle},SIM-01,wash,\n")).unwrap();
    let arguments = ["--events", events.to_str().unwrap(), "--json"];
    let json = monitor(&adapted, &arguments).expect(0).stdout;
    let document: Value = serde_json::from_str(&json).unwrap();
    let event = &document["tails"][0]["events"][0];
    assert_eq!(event["kind"], "wash");
    assert!(event["effect_percent"]["value"].is_number(), "{event}");
    std::fs::write(&events, "date,tail,kind,note\n2026-13-01,SIM-01,wash,\n").unwrap();
    monitor(&adapted, &arguments).expect(2).says("line 2, column date: found \"2026-13-01\"");
    monitor(folder.path(), &[]).expect(2).says("models");
}

#[test]
fn months_and_costs_are_printed_as_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let adapted = adapted(folder.path());
    let printed = monitor(&adapted, &["--month", "--quick"]).expect(0).stdout;
    assert!(printed.contains("before learning"), "{printed}");
    let plain = monitor(&adapted, &["--quick"]).expect(0).stdout;
    assert!(!plain.contains("CO₂"), "{plain}");
    let more = ["--quick", "--co2-factor", "3.16", "--flights-per-year", "100", "--json"];
    let document: Value = serde_json::from_str(&monitor(&adapted, &more).expect(0).stdout).unwrap();
    let cost = &document["tails"][0]["cost"];
    let number = |name: &str| cost[name].as_f64().unwrap();
    assert!((number("fuel_kg_per_year") - 100.0 * number("fuel_kg_per_flight")).abs() < 1e-6);
    assert!((number("co2_kg_per_year") - 3.16 * number("fuel_kg_per_year")).abs() < 1e-6);
    assert!(cost["price_per_year"].is_null());
    let priced =
        monitor(&adapted, &["--quick", "--fuel-price", "0.9", "--flights-per-year", "100"]);
    let printed = priced.expect(0).stdout;
    assert!(printed.contains(" kg fuel a year at a cost of "), "{printed}");
}

#[test]
fn factors_that_are_no_factors_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let adapted = adapted(folder.path());
    for (option, quantity) in [
        ("--co2-factor", "kg of CO₂ from a kg of fuel"),
        ("--fuel-price", "price of a kg of fuel"),
        ("--flights-per-year", "flights a year"),
    ] {
        for value in ["-5", "0", "NaN", "inf"] {
            let refused = monitor(&adapted, &[option, value]).expect(2).stderr;
            let said = format!("{quantity}: found {value}, expected a finite number above 0");
            assert!(refused.contains(&said), "{refused}");
        }
    }
    for value in ["NaN", "-inf"] {
        let option = format!("--basic-perf-factor={value}");
        let refused = monitor(&adapted, &[&option]).expect(2).stderr;
        assert!(refused.contains(&format!("found {value}, expected a finite number")), "{refused}");
    }
}

/// What `adapt` kept of each flight says what its segments say: a folder of a program that kept nothing gives the same documents.
#[test]
fn what_is_kept_of_flights_says_what_their_segments_say() {
    for law in ["bayes", "paper"] {
        let folder = tempfile::tempdir().unwrap();
        let model = initial_model(folder.path());
        let adapted = folder.path().join("adapted");
        adapt(&model, &adapted, &[fixture("reports")], &["--law", law]).expect(0);
        let all = |name: &str| {
            let outputs = ["whole", "quick", "since"].map(|how| folder.path().join(name).join(how));
            let more: [&[&str]; 3] = [&[], &["--quick"], &["--since", "2019-03-27"]];
            for (output, more) in outputs.iter().zip(more) {
                let arguments = [&["-o", output.to_str().unwrap()], more].concat();
                monitor(&adapted, &arguments).expect(0);
            }
            assert_eq!(csv_columns(&outputs[2].join("flights.csv"))["flight"].len(), 6);
            outputs.map(|output| bytes_below(&output))
        };
        let kept = all("kept");
        std::fs::remove_file(adapted.join("STATE.ron")).unwrap();
        std::fs::remove_dir_all(adapted.join("deviations")).unwrap();
        assert!(all("segments") == kept, "law {law}");
    }
}

/// A folder of a program that kept nothing is gone on with, and from then on has what its first flights show too.
#[test]
fn an_older_folder_learns_what_its_flights_showed() {
    let folder = tempfile::tempdir().unwrap();
    let model = initial_model(folder.path());
    let (whole, older) = (folder.path().join("whole"), folder.path().join("older"));
    let reports = reports();
    adapt(&model, &whole, &reports, &[]).expect(0);
    adapt(&model, &older, &reports[..7], &[]).expect(0);
    std::fs::remove_file(older.join("STATE.ron")).unwrap();
    std::fs::remove_dir_all(older.join("deviations")).unwrap();
    adapt(&model, &older, &reports[7..], &[]).expect(0);
    let name = "deviations/SIM-01.csv";
    assert!(bytes_below(&older)[name] == bytes_below(&whole)[name]);
    assert_eq!(csv_columns(&whole.join(name))["flight"].len(), 12);
}

/// A flight that is forgotten is gone from what was kept, and what came after it is learnt without it.
#[test]
fn what_is_forgotten_shows_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let model = initial_model(folder.path());
    let (all, without) = (folder.path().join("all"), folder.path().join("without"));
    let mut reports = reports();
    adapt(&model, &all, &reports, &[]).expect(0);
    let name = "deviations/SIM-01.csv";
    let flight = csv_columns(&all.join(name))["flight"][4].clone();
    let (tail, flight) = (["--tail", "SIM-01"], ["--flight", flight.as_str()]);
    let mut arguments: Vec<std::ffi::OsString> = vec!["forget".into(), all.clone().into()];
    arguments.extend(tail.iter().chain(&flight).map(Into::into));
    cruisefit(&arguments).expect(0);
    reports.remove(4);
    adapt(&model, &without, &reports, &[]).expect(0);
    assert!(bytes_below(&all)[name] == bytes_below(&without)[name]);
}

/// Nothing is lost with the table of what flights show: it is told that it is damaged, what it held follows from model and
/// segments, and the next flight that is learnt puts it right.
#[test]
fn a_damaged_table_of_flights_is_told_and_made_anew() {
    let folder = tempfile::tempdir().unwrap();
    let model = initial_model(folder.path());
    let (sound, damaged) = (folder.path().join("sound"), folder.path().join("damaged"));
    let name = "deviations/SIM-01.csv";
    for output in [&sound, &damaged] {
        adapt(&model, output, &reports()[..9], &[]).expect(0);
    }
    let changed = std::fs::read_to_string(damaged.join(name)).unwrap().replacen(",1", ",2", 1);
    std::fs::write(damaged.join(name), changed).unwrap();
    let told = monitor(&damaged, &["--json"]).expect(0);
    told.says(name).says("SHA-256").says("segments are read instead");
    assert_eq!(told.stdout, monitor(&sound, &["--json"]).expect(0).stdout);
    // Also where the tail learns nothing that night.
    for seen in [9, 12] {
        for output in [&sound, &damaged] {
            let ran = adapt(&model, output, &reports()[..seen], &[]).expect(0);
            let is_told = seen == 9 && output == &damaged;
            assert_eq!(ran.stderr.contains("it is made anew"), is_told, "{}", ran.stderr);
        }
        assert!(bytes_below(&sound)[name] == bytes_below(&damaged)[name], "{seen}");
    }
}
