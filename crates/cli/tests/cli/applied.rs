//! `diagnose --apply`, and how the commands treat a model that contains effects.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use simulate::{AircraftTruth, Preset, TruthPhysics};
use units::Mach;

use crate::support::{
    adapt, bytes_below, cruisefit, csv_columns, diagnosis_document, fixture, initial_model, numbers,
};

/// Two tails of one virtual aircraft whose physics is the model's: `NEW`, and `WORN` with TSFC of engine 2 up 3 %.
/// `FEW` is as worn. Sensors only round; no scatter between flights. Between an engine and its meter then only the recorded
/// mass decides, which the meter makes: twenty flights say which of the two it is, eight leave both possible.
const PLAN: &str = r#"(
    seed: 6,
    physics: (reynolds_number: Off, trim_drag: Off, asymmetry: Off, part_load: Off, temperature_exponent: Off, offtake: Off),
    earth: (load_factor: Off, local_gravity: Off, rotating_earth: Off, isobaric_slope: Off, coriolis_along_path: Off),
    sensors: Rounded,
    scatter: (heating_value_percent: 0, zero_fuel_mass_percent: 0, throttle_split_percent: 0),
    tails: [
        (tail: "NEW", flights: Designed((
            flights: 40, anti_ice_share: 0, high_mach: Some((0.68, 0.80)), low_mach: Some((0.60, 0.68)),
        ))),
        (tail: "WORN", effects: [(id: "tsfc_engine_2", size: Some(3))], flights: Designed((
            flights: 20, anti_ice_share: 0, high_mach: Some((0.68, 0.80)), low_mach: Some((0.60, 0.68)),
        ))),
        (tail: "FEW", effects: [(id: "tsfc_engine_2", size: Some(3))], flights: Designed((
            flights: 8, anti_ice_share: 0, high_mach: Some((0.68, 0.80)), low_mach: Some((0.60, 0.68)),
        ))),
    ],
)"#;

/// Runs the binary with words and paths.
fn run(words: &[&dyn AsRef<std::ffi::OsStr>]) -> crate::support::Ran {
    let arguments: Vec<&std::ffi::OsStr> = words.iter().map(AsRef::as_ref).collect();
    cruisefit(&arguments)
}

/// Deviation of the adapted table from the truth at the lift coefficients and Mach numbers that were flown, per cent: mean,
/// root mean square, and the share of segments within 0.5 %.
fn against_truth(folder: &Path) -> [f64; 3] {
    let table = folder.join("table.csv");
    run(&[&"export", &folder.join("models/WORN.ron"), &"-o", &table]).expect(0);
    let columns = csv_columns(&table);
    let [lift, mach, drag] =
        ["lift_coefficient", "mach", "drag_coefficient"].map(|name| numbers(&columns, name));
    let axis = |values: &[f64]| {
        let mut values = values.to_vec();
        values.sort_by(f64::total_cmp);
        values.dedup();
        lut::Axis::new(values).unwrap()
    };
    let grid = lut::Grid::new(axis(&lift), axis(&mach));
    let table = lut::Table::new(std::sync::Arc::new(grid), drag).unwrap();
    let truth = AircraftTruth::preset(Preset::CitationX).unwrap();
    let flown = csv_columns(&folder.join("segments/WORN.csv"));
    let (lift, mach) = (numbers(&flown, "lift_coefficient"), numbers(&flown, "mach"));
    let deviations: Vec<f64> = lift
        .iter()
        .zip(&mach)
        .map(|(&lift, &mach)| {
            let cell = table.grid().locate(lift, mach, lut::Outside::Error).unwrap();
            let at = truth.reference_conditions();
            let true_drag =
                truth.drag_coefficient(lift, Mach::new(mach), &at, TruthPhysics::plain());
            100.0 * (table.interpolate(&cell) / true_drag - 1.0)
        })
        .collect();
    assert!(deviations.len() > 150, "{}", deviations.len());
    let count = deviations.len() as f64;
    let within = deviations.iter().filter(|d| d.abs() <= 0.5).count() as f64;
    [
        deviations.iter().sum::<f64>() / count,
        (deviations.iter().map(|d| d * d).sum::<f64>() / count).sqrt(),
        within / count,
    ]
}

/// What a folder's document says of its one tail.
fn diagnosis(folder: &Path) -> serde_json::Value {
    diagnosis_document(folder)["diagnoses"][0].clone()
}

fn verdict(folder: &Path) -> serde_json::Value {
    diagnosis(folder)["verdict"].clone()
}

/// Flies PLAN.ron in a folder, and teaches the study's model with the flights of NEW; returns the initial model.
fn taught(folder: &Path) -> PathBuf {
    let at = |name: &str| folder.join(name);
    run(&[&"simulate", &at("PLAN.ron"), &"-o", &at("flown")]).expect(0);
    run(&[&"simulate", &"ghazi-2020", &"-o", &at("study")]).expect(0);
    let initial = at("MODEL.ron");
    // Finer than the study's table, so that no chord of the drag rise is taken for an effect.
    let text = std::fs::read_to_string(at("study/AIRCRAFT.ron")).unwrap();
    let finer = text.replace("mach: (0.50, 0.90, 0.05)", "mach: (0.50, 0.92, 0.02)");
    assert_ne!(finer, text);
    std::fs::write(at("study/AIRCRAFT.ron"), finer).unwrap();
    let (aircraft, guide) = (at("study/AIRCRAFT.ron"), at("study/guide.csv"));
    run(&[&"init", &"--aircraft", &aircraft, &"--guide", &guide, &"-o", &initial]).expect(0);
    adapt(&initial, &at("new"), &[at("flown/NEW")], &[]).expect(0);
    initial
}

#[test]
fn an_engine_effect_is_applied_and_adapt_leaves_drag_alone() {
    let scratch = tempfile::tempdir().unwrap();
    let at = |name: &str| scratch.path().join(name);
    std::fs::write(at("PLAN.ron"), PLAN).unwrap();
    let initial = taught(scratch.path());
    let (learnt, worn) = (at("new/models/NEW.ron"), at("flown/WORN"));
    let (found, applied) = (at("found"), at("applied"));

    // A meter of engine 2 that reads high looks nearly the same: the user has to state which of the two it is.
    let few = at("flown/FEW");
    let refused =
        run(&[&"diagnose", &few, &"--model", &learnt, &"-o", &found, &"--apply", &applied])
            .expect(1);
    refused.says("these flights cannot distinguish").says("tsfc_engine_2").says("fuel_flow_gain_2");
    assert!(bytes_below(&applied).is_empty());
    let named = [&"--effects" as &dyn AsRef<std::ffi::OsStr>, &"tsfc_engine_2"];
    let mut words: Vec<&dyn AsRef<std::ffi::OsStr>> =
        vec![&"diagnose", &few, &"--model", &learnt, &"-o", &found, &"--apply", &applied];
    words.extend(named);
    let ran = run(&words).expect(0);
    assert!(ran.stdout.contains("FEW: applied tsfc_engine_2 +"), "{}", ran.stdout);

    // Twenty flights say it.
    let ran = run(&[&"diagnose", &worn, &"--model", &learnt, &"-o", &found, &"--apply", &applied])
        .expect(0);
    assert!(ran.stdout.contains("WORN: applied tsfc_engine_2 +"), "{}", ran.stdout);
    let extended = applied.join("WORN.ron");

    // The same flights against the extended model: nothing is left.
    let again = at("again");
    run(&[&"diagnose", &worn, &"--model", &extended, &"-o", &again, &"--apply", &at("twice")])
        .expect(0);
    assert_eq!(verdict(&again)["kind"], "no_gap");
    assert!(bytes_below(&at("twice")).is_empty());

    // Another tail of the type has no share in it.
    adapt(&extended, &at("not_its_own"), &[at("flown/NEW")], &[])
        .expect(2)
        .says("effects of tail WORN applied to it, which are not tail NEW's");

    // Adapted without the effect, the engine's wear is charged to drag; with it, drag is left alone.
    adapt(&initial, &at("charged"), std::slice::from_ref(&worn), &[]).expect(0);
    adapt(&extended, &at("alone"), std::slice::from_ref(&worn), &[])
        .expect(0)
        .says("adaptation starts from its initial part and the effects applied to it");
    let (charged, alone) = (against_truth(&at("charged")), against_truth(&at("alone")));
    eprintln!(
        "mean, rms, share within 0.5 %: {charged:.3?} without the effect, {alone:.3?} with it"
    );
    assert!((charged[0] - 1.5).abs() < 0.2 && charged[2] < 0.1, "{charged:?}");
    assert!(alone[0].abs() < 0.15 && alone[1] < 0.5 && alone[2] > 0.9, "{alone:?}");

    // The table of segments keeps what was recorded, errors are those of the extended model.
    let [charged, alone] =
        ["charged", "alone"].map(|folder| csv_columns(&at(&format!("{folder}/segments/WORN.csv"))));
    for column in ["fuel_flow_kg_s", "fuel_flow_2_kg_s", "mach", "mass_kg"] {
        assert_eq!(charged[column], alone[column], "{column}");
    }
    let predicted = |of: &std::collections::BTreeMap<String, Vec<String>>| {
        numbers(of, "predicted_fuel_flow_kg_s").iter().sum::<f64>()
    };
    // Half of 3 %, as far as the diagnosis found it.
    let more = predicted(&alone) / predicted(&charged) - 1.0;
    assert!((100.0 * more - 1.5).abs() < 0.15, "{more}");

    // Another set of effects is another initial state.
    adapt(&initial, &at("alone"), std::slice::from_ref(&worn), &[])
        .expect(2)
        .says("was started with another set of applied effects: tsfc_engine_2 +")
        .says("against none");
    run(&[
        &"merge",
        &at("alone/models/WORN.ron"),
        &at("new/models/NEW.ron"),
        &"-o",
        &at("merged.ron"),
    ])
    .expect(2)
    .says("another set of applied effects than the first model");
    let shown = run(&[&"show", &extended]).expect(0);
    assert!(shown.stdout.contains("Applied: tsfc_engine_2 +"), "{}", shown.stdout);
    assert!(shown.stdout.contains("Predictions have tsfc_engine_2\n"), "{}", shown.stdout);
    run(&[&"export", &extended, &"-o", &at("table.csv")])
        .expect(0)
        .says("effects that the model contains are not in it: tsfc_engine_2");
}

/// A bump of drag that no effect of the library is: it is applied where a person asks for it, and then nothing is left.
#[test]
fn a_form_outside_the_library_is_applied_by_its_name() {
    let scratch = tempfile::tempdir().unwrap();
    let at = |name: &str| scratch.path().join(name);
    let bump = r#"effects: [(id: "outside_mach_bump", size: Some(15), at: Some(0.74))], flights: Designed(("#;
    let plan = PLAN
        .replace(r#"effects: [(id: "tsfc_engine_2", size: Some(3))], flights: Designed(("#, bump);
    let plan = plan.replace("flights: 20", "flights: 40");
    std::fs::write(at("PLAN.ron"), plan).unwrap();
    taught(scratch.path());
    let (learnt, bumped) = (at("new/models/NEW.ron"), at("flown/WORN"));
    let (found, applied) = (at("found"), at("applied"));
    let ran =
        run(&[&"diagnose", &bumped, &"--model", &learnt, &"-o", &found, &"--apply", &applied])
            .expect(0);
    assert!(
        ran.stdout.contains("--effects outside applies the form that describes it, drag +"),
        "{}",
        ran.stdout
    );
    assert!(bytes_below(&applied).is_empty());
    let ran = run(&[
        &"diagnose",
        &bumped,
        &"--model",
        &learnt,
        &"-o",
        &found,
        &"--effects",
        &"outside",
        &"--apply",
        &applied,
    ])
    .expect(0);
    assert!(ran.stdout.contains("WORN: applied outside: drag +"), "{}", ran.stdout);
    assert!(!ran.stdout.contains("only these effects"), "{}", ran.stdout);
    let extended = applied.join("WORN.ron");
    let shown = run(&[&"show", &extended]).expect(0);
    assert!(shown.stdout.contains("Predictions have outside\n"), "{}", shown.stdout);
    let again = at("again");
    run(&[&"diagnose", &bumped, &"--model", &extended, &"-o", &again]).expect(0);
    let rms_percent = |folder: &Path| diagnosis(folder)["gap"]["rms_percent"].as_f64().unwrap();
    let (before, after) = (rms_percent(&found), rms_percent(&again));
    assert!(before > 1.0 && after < 0.2 * before, "{before} {after}");
    assert_eq!(verdict(&again)["kind"], "no_gap");
    // At the bump the planner gets the drag that was planted there, elsewhere nothing.
    let points = at("points.csv");
    std::fs::write(
        &points,
        "mass_kg,pressure_altitude_ft,mach\n14000,41000,0.74\n14000,41000,0.64\n",
    )
    .unwrap();
    let drag = |model: &Path| {
        let out = at("predicted.csv");
        run(&[&"predict", &"--model", &model, &points, &"-o", &out, &"--table-only"]).expect(0);
        numbers(&csv_columns(&out), "drag_coefficient")
    };
    let (with, without) = (drag(&extended), drag(&learnt));
    let counts: Vec<f64> = with.iter().zip(&without).map(|(a, b)| 1e4 * (a - b)).collect();
    assert!((counts[0] - 15.0).abs() < 3.0 && counts[1].abs() < 2.0, "{counts:?}");
    let mut words: Vec<&dyn AsRef<std::ffi::OsStr>> =
        vec![&"diagnose", &bumped, &"--model", &learnt, &"-o", &found, &"--effects", &"outside"];
    run(&words).expect(2).says("give --apply DIR too");
    words.extend([&"--fleet" as &dyn AsRef<std::ffi::OsStr>, &"--apply", &applied]);
    run(&words).expect(2).says("`outside` is the form of one tail's gap");
}

/// A model of the fixture's aircraft that contains effects, written by hand as a program of today writes it.
fn extended_by_hand(model: &Path, effects: &str) -> PathBuf {
    let text = std::fs::read_to_string(model).unwrap();
    let end = text.rfind("\n    checksum: \"").unwrap();
    let mut body = text[..end].to_owned();
    let _ = write!(
        body,
        r#"
    effects: [
        (
            addition: (
                effects: [{effects}],
                references: (
                    date_s: 1550000000, mach: 0.82, unit_reynolds_number_per_m: 6e6, temperature_ratio: 0.76,
                    corrected_thrust_n: 150000, fuel_flow_total_kg_s: 0.5, mass_kg: 32000,
                    center_of_gravity_percent_mac: Some(25),
                ),
            ),
            diagnosis: (
                tail: "SIM-01", flights: 20, segments: 200, first: "2019-01-01T00:00:00Z",
                last: "2019-06-01T00:00:00Z", probability: 0.97, class: ["drag_factor"],
            ),
        ),
    ],"#
    );
    let mut hash = <sha2::Sha256 as sha2::Digest>::new();
    for line in body.lines() {
        sha2::Digest::update(&mut hash, line.as_bytes());
        sha2::Digest::update(&mut hash, b"\n");
    }
    let sum = sha2::Digest::finalize(hash)
        .iter()
        .fold(String::new(), |text, byte| format!("{text}{byte:02x}"));
    let path = model.with_file_name("EXTENDED.ron");
    std::fs::write(&path, format!("{body}\n    checksum: \"sha256:{sum}\",\n)\n")).unwrap();
    path
}

fn one(effect: &str, size: f64) -> String {
    format!(r#"(effect: "{effect}", size: {size}, standard_deviation: 0.1)"#)
}

fn predicted(model: &Path, points: &Path) -> (String, String) {
    let ran = run(&[&"predict", &"--model", &model, &points]);
    assert!(ran.status < 2, "{}", ran.stderr);
    (ran.stdout, ran.stderr)
}

#[test]
fn effects_of_recordings_never_change_what_a_planner_gets() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let points = fixture("static.csv");
    let (plain, _) = predicted(&model, &points);
    let reports = [fixture("reports/0001.txt")];
    adapt(&model, &scratch.path().join("plain"), &reports, &[]).expect(0);
    let segments =
        |folder: &str| csv_columns(&scratch.path().join(folder).join("segments/SIM-01.csv"));
    let errors = numbers(&segments("plain"), "error_percent");
    for (effect, size) in [
        ("zero_fuel_mass_bias", 400.0),
        ("fuel_quantity_gain", 3.0),
        ("mach_bias", 0.004),
        ("static_pressure_bias", 0.3),
        ("temperature_bias", 2.0),
        ("fuel_flow_gain", 2.0),
        ("fuel_flow_gain_1", 3.0),
        ("fuel_flow_gain_2", 3.0),
    ] {
        let extended = extended_by_hand(&model, &one(effect, size));
        assert_eq!(predicted(&extended, &points).0, plain, "{effect}");
        // But it corrects what is recorded.
        let folder = scratch.path().join(effect);
        adapt(&extended, &folder, &reports, &[]).expect(0);
        let corrected = numbers(&segments(effect), "error_percent");
        let moved = (0..errors.len()).map(|k| (corrected[k] - errors[k]).abs()).sum::<f64>();
        assert!(moved / errors.len() as f64 > 0.01, "{effect}: {moved}");
    }
    // By hand: a meter 2 % high, 1 − Ŵf/(Wf/1.02); mass changes by 2 % of the fuel used, up to 0.3 % of it.
    let corrected = numbers(&segments("fuel_flow_gain"), "error_percent");
    for (corrected, error) in corrected.iter().zip(&errors) {
        let by_hand = 100.0 * (1.0 - 1.02 * (1.0 - error / 100.0));
        assert!((corrected - by_hand).abs() < 0.35, "{corrected} {by_hand}");
    }
}

#[test]
fn physical_effects_change_what_a_planner_gets_and_missing_inputs_are_said() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let points = scratch.path().join("points.csv");
    std::fs::write(
        &points,
        "mass_kg,pressure_altitude_ft,mach,isa_deviation_c,date,cg_percent_mac\n\
         32000,41000,0.82,0,2020-02-12,20\n\
         32000,41000,0.82,0,,\n",
    )
    .unwrap();
    let flows = |model: &Path| {
        let (out, err) = predicted(model, &points);
        let path = scratch.path().join("out.csv");
        std::fs::write(&path, out).unwrap();
        let columns = csv_columns(&path);
        (numbers(&columns, "fuel_flow_kg_s"), numbers(&columns, "drag_coefficient"), err)
    };
    let (plain, drag, _) = flows(&model);
    // A year after the reference of 2019-02-12T19:33:20Z, less a day's part: 0.9978 years of 1 % each.
    let aged = extended_by_hand(&model, &one("engine_ageing", 1.0));
    let (found, _, stderr) = flows(&aged);
    assert!((found[0] / plain[0] - 1.009_978).abs() < 1e-4, "{found:?}");
    assert!((found[1] / plain[1] - 1.0).abs() < 1e-12, "{found:?}");
    assert_eq!(stderr.matches("points without date: engine_ageing is at its reference").count(), 1);
    // 5 %MAC forward: 3 counts·0.5·CL/0.4.
    let trimmed = extended_by_hand(&model, &one("trim_drag_cg", 3.0));
    let (_, trimmed_drag, stderr) = flows(&trimmed);
    assert!(trimmed_drag[0] > drag[0] + 1.0e-4 && trimmed_drag[0] < drag[0] + 2.2e-4);
    assert!((trimmed_drag[1] / drag[1] - 1.0).abs() < 1e-12);
    assert_eq!(stderr.matches("points without cg_percent_mac").count(), 1);
    // A step from 2020 on is there on the first point's date, and not on the reference's.
    let stepped = extended_by_hand(
        &model,
        r#"(effect: "step_change", size: 1.5, standard_deviation: 0.1, step_from_s: Some(1577836800), step_target: Some(fuel_flow))"#,
    );
    let (found, _, stderr) = flows(&stepped);
    assert!((found[0] / plain[0] - 1.015).abs() < 1e-9, "{found:?}");
    assert!((found[1] / plain[1] - 1.0).abs() < 1e-12, "{found:?}");
    assert!(stderr.contains("points without date: step_change is at its reference"), "{stderr}");
}

#[test]
fn files_with_effects_read_back_to_the_same_bytes_and_wrong_ones_are_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let extended = extended_by_hand(&model, &one("drag_factor", 2.0));
    // `tune` and `adapt` keep the effects in what they write.
    let out = scratch.path().join("out");
    adapt(&extended, &out, &[fixture("reports/0001.txt")], &[]).expect(0);
    let written = std::fs::read_to_string(out.join("models/SIM-01.ron")).unwrap();
    assert!(written.contains("effect: \"drag_factor\""), "{written}");
    adapt(&extended, &out, &[fixture("reports/0001.txt")], &[]).expect(0);
    assert_eq!(std::fs::read_to_string(out.join("models/SIM-01.ron")).unwrap(), written);
    let wrong = extended_by_hand(&model, &one("drag_faktor", 2.0));
    run(&[&"show", &wrong]).expect(2).says("effects: no effect is called \"drag_faktor\"");
    // A digit that was changed is noticed.
    let text = written.replacen("size: 2", "size: 3", 1);
    assert_ne!(text, written);
    std::fs::write(&wrong, text).unwrap();
    run(&[&"show", &wrong]).expect(2).says("does not match the content");
}

#[test]
fn what_is_no_effect_is_not_applied() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (found, applied) = (scratch.path().join("found"), scratch.path().join("applied"));
    let reports: Vec<PathBuf> = vec![fixture("reports/0001.txt"), fixture("reports/0002.txt")];
    let ran = run(&[
        &"diagnose",
        &reports[0],
        &reports[1],
        &"--model",
        &model,
        &"-o",
        &found,
        &"--apply",
        &applied,
    ])
    .expect(0);
    assert!(ran.stdout.contains("SIM-01: nothing applied: insufficient data"), "{}", ran.stdout);
    assert!(bytes_below(&applied).is_empty());
}
