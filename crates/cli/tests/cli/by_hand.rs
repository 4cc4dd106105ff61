//! Results of commands against the same computed here from what goes into them.

use std::path::PathBuf;

use pipeline::model_file::ModelFile;

use crate::support::{adapt, cruisefit, csv_columns, fixture, initial_model, numbers};

const WING_AREA_M2: f64 = 94.94690688;
const STANDARD_GRAVITY_M_S2: f64 = 9.80665;

/// Pressure in Pa in the standard atmosphere's lower stratosphere, ICAO Doc 7488.
fn pressure_pa(pressure_altitude_m: f64) -> f64 {
    22_632.06
        * (-STANDARD_GRAVITY_M_S2 * (pressure_altitude_m - 11_000.0) / (287.05287 * 216.65)).exp()
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
            // S·q, q = γ/2·p·M².
            let force_n = 0.7 * pressure_pa(altitude[k]) * mach[k].powi(2) * WING_AREA_M2;
            let lift = mass[k] * STANDARD_GRAVITY_M_S2 / force_n;
            // 0.657 lb/(lbf h) at 15 °C; the aircraft's law has no Mach number.
            let tsfc = 0.657 * 0.45359237 / (4.4482216152605 * 3600.0) * (sat_k[k] / 288.15).sqrt();
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
