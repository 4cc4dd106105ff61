//! Results of commands against the same computed here from what goes into them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use pipeline::model_file::ModelFile;

use crate::support::{
    adapt, cruisefit, csv_columns, diagnosis_document, fixture, initial_model, numbers,
};

const WING_AREA_M2: f64 = 94.94690688;
const STANDARD_GRAVITY_M_S2: f64 = 9.80665;

/// Pressure in Pa in the standard atmosphere's lower stratosphere, ICAO Doc 7488.
fn pressure_pa(pressure_altitude_m: f64) -> f64 {
    22_632.06
        * (-STANDARD_GRAVITY_M_S2 * (pressure_altitude_m - 11_000.0) / (287.05287 * 216.65)).exp()
}

/// S·q, q = γ/2·p·M².
fn surface_force_n(pressure_altitude_m: f64, mach: f64) -> f64 {
    0.7 * pressure_pa(pressure_altitude_m) * mach.powi(2) * WING_AREA_M2
}

/// 0.657 lb/(lbf h) at 15 °C; the aircraft's law has no Mach number.
fn tsfc_kg_n_s(static_air_temperature_k: f64) -> f64 {
    0.657 * 0.45359237 / (4.4482216152605 * 3600.0) * (static_air_temperature_k / 288.15).sqrt()
}

/// Bilinear value of the fixture's table: lift coefficient from 0.10, Mach number from 0.50, both by 0.05, ten Mach numbers.
fn drag_coefficient(table: &[f64], lift: f64, mach: f64) -> f64 {
    let (x, y) = ((lift - 0.10) / 0.05, (mach - 0.50) / 0.05);
    let (i, j) = (x.floor(), y.floor());
    let (u, v) = (x - i, y - j);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside the table")]
    let at = |i: f64, j: f64| table[(i * 10.0 + j) as usize];
    (1.0 - u) * ((1.0 - v) * at(i, j) + v * at(i, j + 1.0))
        + u * ((1.0 - v) * at(i + 1.0, j) + v * at(i + 1.0, j + 1.0))
}

/// `evaluate --table-only` predicts by the *learnt* table, not by the initial one.
#[test]
fn evaluate_by_a_learnt_table() {
    for law in ["bayes", "paper"] {
        let scratch = tempfile::tempdir().unwrap();
        let model = initial_model(scratch.path());
        let reports: Vec<PathBuf> =
            (1..=9).map(|flight| fixture(&format!("reports/{flight:04}.txt"))).collect();
        let output = scratch.path().join("out");
        adapt(&model, &output, &reports, &["--law", law]).expect(0);
        let (segments, residuals) = (scratch.path().join("s.csv"), scratch.path().join("r.csv"));
        let judged = fixture("reports/0012.txt");
        let segment = ["segment".as_ref(), judged.as_os_str(), "-o".as_ref(), segments.as_os_str()];
        cruisefit(&segment).expect(0);
        cruisefit(&[
            "evaluate".as_ref(),
            judged.as_os_str(),
            "--model".as_ref(),
            output.as_os_str(),
            "--table-only".as_ref(),
            "-o".as_ref(),
            residuals.as_os_str(),
        ])
        .expect(0);
        let text = std::fs::read_to_string(output.join("models/SIM-01.ron")).unwrap();
        let model = ModelFile::from_text(&text).unwrap();
        let (learnt, initial) =
            (model.drag_coefficient().values(), model.initial.drag_table().values());
        let (segments, residuals) = (csv_columns(&segments), csv_columns(&residuals));
        let of = |name: &str| numbers(&segments, name);
        let predicted = numbers(&residuals, "predicted_fuel_flow_kg_s");
        let (altitude, sat_k, mach) =
            (of("pressure_altitude_m"), of("static_air_temperature_k"), of("mach"));
        let (mass, acceleration, recorded) =
            (of("mass_kg"), of("acceleration_m_s2"), of("fuel_flow_kg_s"));
        assert!(predicted.len() >= 3, "{}", predicted.len());
        let mut moved = 0.0_f64;
        for k in 0..predicted.len() {
            let force_n = surface_force_n(altitude[k], mach[k]);
            let lift = mass[k] * STANDARD_GRAVITY_M_S2 / force_n;
            let tsfc = tsfc_kg_n_s(sat_k[k]);
            let by = |table: &[f64]| {
                let drag_n = force_n * drag_coefficient(table, lift, mach[k]);
                (drag_n + mass[k] * acceleration[k]) * tsfc
            };
            // What is left out here, the load factor of a small bank angle, makes up to 1e-4.
            let (found, expected) = (predicted[k], by(learnt));
            assert!((found / expected - 1.0).abs() < 2e-4, "law {law}: {found} {expected}");
            moved = moved.max((by(initial) / expected - 1.0).abs());
            let error = numbers(&residuals, "error_percent")[k];
            assert!((error - 100.0 * (recorded[k] - found) / recorded[k]).abs() < 1e-9);
        }
        // Law paper leaves nodes alone that no segment touched; somewhere both have learnt.
        assert!(moved > 5e-3, "law {law} has learnt little here: {moved}");
    }
}

/// Fuel flow of both engines, kg/s, level and without acceleration in the lower stratosphere: drag with a rise that no polynomial of
/// six coefficients holds (Lock's fourth power), the fixture's law of TSFC.
fn fuel_flow_kg_s(mass_kg: f64, pressure_altitude_m: f64, mach: f64) -> f64 {
    let force_n = surface_force_n(pressure_altitude_m, mach);
    let lift = mass_kg * STANDARD_GRAVITY_M_S2 / force_n;
    let drag = 0.018 + 0.05 * lift.powi(2) + 30.0 * (mach - 0.76).max(0.0).powi(4);
    force_n * drag * tsfc_kg_n_s(216.65)
}

/// TAS in kt at 216.65 K, where sound goes 295.07 m/s.
fn true_airspeed_kt(mach: f64) -> f64 {
    mach * 295.069_5 / 0.514_444_4
}

const FOOT_M: f64 = 0.3048;

/// Rows of fuel flow as a planner has them.
fn guide_by_hand() -> String {
    let mut rows = String::from("mass_kg,pressure_altitude_ft,true_airspeed_kt,fuel_flow_lb_h\n");
    for level_ft in [37_000.0, 39_000.0, 41_000.0] {
        for heavier in 0..6 {
            for hundredths in (70..=86).step_by(2) {
                let (mass, mach) =
                    (24_000.0 + 3_200.0 * f64::from(heavier), f64::from(hundredths) / 100.0);
                let flow = fuel_flow_kg_s(mass, level_ft * FOOT_M, mach) * 3600.0 / 0.45359237;
                let speed = true_airspeed_kt(mach);
                writeln!(rows, "{mass},{level_ft},{speed:.3},{flow:.2}").unwrap();
            }
        }
    }
    rows
}

/// The model that `init` makes of it, with cells in which the rise is nearly straight.
fn initial_model_by_hand(folder: &Path) -> String {
    let text = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (aircraft, guide, model) = (text("AIRCRAFT.ron"), text("guide.csv"), text("MODEL.ron"));
    let of_fixture = std::fs::read_to_string(fixture("AIRCRAFT.ron")).unwrap();
    let (coarse, fine) = ("mach: (0.50, 0.95, 0.05)", "mach: (0.68, 0.88, 0.02)");
    assert!(of_fixture.contains(coarse));
    std::fs::write(&aircraft, of_fixture.replace(coarse, fine)).unwrap();
    std::fs::write(&guide, guide_by_hand()).unwrap();
    cruisefit(&["init", "--aircraft", &aircraft, "--guide", &guide, "-o", &model]).expect(0);
    model
}

/// A flight that burns what the guide says.
fn report_by_hand(number: u32) -> String {
    let level_ft = 37_000.0 + 2_000.0 * f64::from(number % 3);
    let mach = 0.77 + 0.01 * f64::from(number * 5 % 8);
    let (zero_fuel_kg, mut fuel_kg) = (22_000.0 + 900.0 * f64::from(number * 3 % 7), 9_000.0);
    let mut text = format!(
        "CRUISE-REPORT 1\nAIRCRAFT global5000\nTAIL BOOK\nFLIGHT {number:04}\nSTART 2024-02-{:02}T06:00:00Z\nZFW {zero_fuel_kg} kg\n\
         FOB {fuel_kg} kg\nMISSING N2 ROLL DRIFT\nTIME ALT SAT MACH VTAS GSPD WF(1) WF(2) FU\ns ft degC - kt kt kg/h kg/h kg\n",
        1 + number
    );
    for minute in 0..120 {
        let flow = fuel_flow_kg_s(zero_fuel_kg + fuel_kg, level_ft * FOOT_M, mach);
        let (speed, each) = (true_airspeed_kt(mach), 1800.0 * flow);
        writeln!(
            text,
            "{} {level_ft} -56.50 {mach:.4} {speed:.2} {speed:.2} {each:.2} {each:.2} {:.2}",
            60 * minute,
            9_000.0 - fuel_kg
        )
        .unwrap();
        fuel_kg -= 60.0 * flow;
    }
    text
}

/// An aircraft that burns what its guide says has no gap, whatever the polynomial through the guide's rows loses of a drag rise; the
/// polynomial itself has one.
#[test]
fn who_burns_the_guide_has_no_gap() {
    let scratch = tempfile::tempdir().unwrap();
    let at = |name: &str| scratch.path().join(name);
    std::fs::create_dir(at("reports")).unwrap();
    for number in 1..=12 {
        std::fs::write(at(&format!("reports/{number:04}.txt")), report_by_hand(number)).unwrap();
    }
    let text = |name: &str| at(name).to_str().unwrap().to_owned();
    let model = initial_model_by_hand(scratch.path());
    let diagnosed = |more: &[&str]| {
        let (reports, output) = (text("reports"), text("found"));
        let words = ["diagnose", &reports, "--model", &model, "-o", &output];
        cruisefit(&[&words, more].concat()).expect(0);
        diagnosis_document(&at("found"))["diagnoses"][0].clone()
    };
    let by_rows = diagnosed(&[]);
    let rms = |found: &serde_json::Value| found["gap"]["rms_percent"].as_f64().unwrap();
    assert_eq!(by_rows["verdict"]["kind"], "no_gap", "{by_rows}");
    let by_polynomial = diagnosed(&["--table-only"]);
    assert_eq!(by_polynomial["verdict"]["effects"][0], "drag_table", "{by_polynomial}");
    assert!(
        rms(&by_rows) < 0.3 && rms(&by_polynomial) > 1.0,
        "{} {}",
        rms(&by_rows),
        rms(&by_polynomial)
    );
}

/// Before any flight the guide's own optimum is advised: the Mach number with the greatest V/Wf, found by trying every thousandth.
#[test]
fn an_untaught_optimum_is_that_of_the_guide() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model_by_hand(scratch.path());
    let output = scratch.path().join("optimum.csv");
    let masses = "28000,31000,34000";
    let asked = ["--levels", "37000,39000,41000", "--mass-kg", masses, "-o"];
    let words = [&["optimum", "--model", &model], &asked[..], &[output.to_str().unwrap()]];
    cruisefit(&words.concat()).expect(0);
    let found = csv_columns(&output);
    let of = |name: &str| numbers(&found, name);
    let (mass, level_ft, mach) = (of("mass_kg"), of("pressure_altitude_ft"), of("mach"));
    let mut judged = 0;
    for k in (0..mach.len()).filter(|&k| found["kind"][k] == "maximum_range") {
        let range = |thousandths: u32| {
            let mach = f64::from(thousandths) / 1000.0;
            mach / fuel_flow_kg_s(mass[k], level_ft[k] * FOOT_M, mach)
        };
        let best = (700..=860).max_by(|&a, &b| range(a).total_cmp(&range(b))).unwrap();
        let off = mach[k] - f64::from(best) / 1000.0;
        assert!(off.abs() <= 0.005, "{} kg at {} ft: {off} off {best}", mass[k], level_ft[k]);
        judged += 1;
    }
    assert_eq!(judged, 9);
}
