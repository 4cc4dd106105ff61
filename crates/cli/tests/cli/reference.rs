//! The whole chain against the results of an independent implementation of the method.
//!
//! Oracle: reference results for three fleets of forty flights flown in JSBSim, two grids, two thresholds, which are
//! not part of a clone. Tolerances are those of the comparison's own page: segments 1e-9 relative (absolute floor
//! 1e-12), tables 1e-8, summary 1e-6.

use std::path::{Path, PathBuf};

use test_support::outside_data;

use crate::support::{adapt, cruisefit, csv_columns, fixture, numbers};

const FLEETS: [&str; 3] = ["SIM-01", "SIM-02", "SIM-05"];
const GRIDS: [(&str, &str); 2] = [
    ("wide", "lift_coefficient: (0.10, 0.80, 0.05), mach: (0.50, 0.95, 0.05)"),
    ("compact", "lift_coefficient: (0.30, 0.60, 0.05), mach: (0.76, 0.88, 0.02)"),
];
const THRESHOLDS: [&str; 2] = ["5", "1"];

/// Columns of the reference's segments, and of ours.
const SEGMENT_COLUMNS: [(&str, &str); 14] = [
    ("time_s", "time_s"),
    ("pressure_altitude_m", "pressure_altitude_m"),
    ("static_air_temperature_k", "static_air_temperature_k"),
    ("mach", "mach"),
    ("true_airspeed_m_s", "true_airspeed_m_s"),
    ("ground_speed_m_s", "ground_speed_m_s"),
    ("acceleration_m_s2", "acceleration_m_s2"),
    ("mass_kg", "mass_kg"),
    ("fuel_flow_kg_s", "fuel_flow_kg_s"),
    ("lift_coefficient", "lift_coefficient"),
    ("drag_coefficient", "drag_coefficient"),
    ("predicted_fuel_flow_kg_s", "predicted_fuel_flow_kg_s"),
    ("error_percent", "error_percent"),
    ("samples", "samples"),
];

#[test]
fn three_fleets_two_grids_two_thresholds() {
    let (Some(golden), Some(data)) =
        (outside_data("golden"), outside_data("data/jsbsim-global5000"))
    else {
        return;
    };
    let scratch = tempfile::tempdir().unwrap();
    for (grid, table) in GRIDS {
        let model = initial_model_on(scratch.path(), grid, table, &data);
        let initial = scratch.path().join(format!("{grid}.csv"));
        cruisefit(&["export".as_ref(), model.as_os_str(), "-o".as_ref(), initial.as_os_str()])
            .expect(0);
        compare_tables(&golden.join(format!("initial_{grid}_table.csv")), &initial);
        for fleet in FLEETS {
            for threshold in THRESHOLDS {
                let output = scratch.path().join(format!("{fleet}-{grid}-{threshold}"));
                adapt(
                    &model,
                    &output,
                    &[data.join(fleet)],
                    &["--law", "paper", "--threshold", threshold],
                )
                .expect(0);
                let adapted = output.join(format!("models/{fleet}.ron"));
                let exported = output.join("table.csv");
                cruisefit(&[
                    "export".as_ref(),
                    adapted.as_os_str(),
                    "-o".as_ref(),
                    exported.as_os_str(),
                ])
                .expect(0);
                let name = format!("{fleet}_{grid}_paper_{threshold}_table.csv");
                compare_tables(&golden.join(name), &exported);
                if grid == "wide" {
                    compare_segments(
                        &golden.join(format!("{fleet}_segments.csv")),
                        &output.join(format!("segments/{fleet}.csv")),
                    );
                }
                compare_summary(&golden.join("summary.csv"), &output, fleet, grid, threshold);
            }
        }
    }
}

#[test]
fn the_initial_polynomial() {
    let Some(golden) = outside_data("golden") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let model = crate::support::initial_model(scratch.path());
    let text = std::fs::read_to_string(model).unwrap();
    let (_, after) = text.split_once("coefficients: (").unwrap();
    let found: Vec<f64> =
        after.split(')').next().unwrap().split(',').map(|n| n.trim().parse().unwrap()).collect();
    let expected = numbers(&csv_columns(&golden.join("initial_polynomial.csv")), "value");
    assert_eq!(found.len(), 6);
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() <= 1e-8 * expected.abs(), "{found} {expected}");
    }
}

fn initial_model_on(scratch: &Path, grid: &str, table: &str, data: &Path) -> PathBuf {
    let text = std::fs::read_to_string(fixture("AIRCRAFT.ron")).unwrap();
    let (before, _) = text.split_once("    table:").unwrap();
    let aircraft = scratch.join(format!("{grid}-AIRCRAFT.ron"));
    std::fs::write(&aircraft, format!("{before}    table: ({table}),\n)\n")).unwrap();
    let model = scratch.join(format!("{grid}.ron"));
    cruisefit(&[
        "init".as_ref(),
        "--aircraft".as_ref(),
        aircraft.as_os_str(),
        "--guide".as_ref(),
        data.join("guide.csv").as_os_str(),
        "-o".as_ref(),
        model.as_os_str(),
    ])
    .expect(0);
    model
}

fn compare_tables(expected: &Path, found: &Path) {
    let (expected_columns, found_columns) = (csv_columns(expected), csv_columns(found));
    for name in ["lift_coefficient", "mach", "drag_coefficient", "confidence"] {
        let (e, f) = (numbers(&expected_columns, name), numbers(&found_columns, name));
        assert_eq!(e.len(), f.len(), "{}", expected.display());
        for (node, (e, f)) in e.iter().zip(&f).enumerate() {
            assert!(
                (e - f).abs() <= 1e-8 * e.abs(),
                "{} node {node} {name}: expected {e}, found {f}",
                expected.display()
            );
        }
    }
}

fn compare_segments(expected: &Path, found: &Path) {
    let (expected_columns, found_columns) = (csv_columns(expected), csv_columns(found));
    assert_eq!(expected_columns["rows"], found_columns["rows"], "kept rows");
    assert_eq!(expected_columns["flight"], found_columns["flight"]);
    for (theirs, ours) in SEGMENT_COLUMNS {
        let (e, f) = (numbers(&expected_columns, theirs), numbers(&found_columns, ours));
        for (row, (e, f)) in e.iter().zip(&f).enumerate() {
            assert!(
                (e - f).abs() <= 1e-12 + 1e-9 * e.abs(),
                "{} row {row} {theirs}: expected {e}, found {f}",
                expected.display()
            );
        }
    }
}

fn compare_summary(golden: &Path, output: &Path, fleet: &str, grid: &str, threshold: &str) {
    let rows = csv_columns(golden);
    let row = (0..rows["fleet"].len())
        .find(|&row| {
            rows["fleet"][row] == fleet
                && rows["grid"][row] == grid
                && rows["threshold_percent"][row] == format!("{threshold}.0")
        })
        .unwrap();
    let expected = |name: &str| rows[name][row].parse::<f64>().unwrap();
    let text = std::fs::read_to_string(output.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    let tail = &summary["tails"][0];
    let errors = &tail["fuel_flow_error_percent"];
    for (name, found) in [
        ("flights", &tail["flights"]),
        ("segments", &tail["segments"]),
        ("outside_table", &tail["outside_table"]),
        ("refits", &tail["refits"]),
        ("mean_before", &errors["before"]["mean"]),
        ("std_before", &errors["before"]["std"]),
        ("max_before", &errors["before"]["max_abs"]),
        ("mean_after", &errors["after"]["mean"]),
        ("std_after", &errors["after"]["std"]),
        ("max_after", &errors["after"]["max_abs"]),
    ] {
        let (expected, found) = (expected(name), found.as_f64().unwrap());
        // The reference prints nine decimals.
        assert!(
            (expected - found).abs() <= 1e-9 + 1e-6 * expected.abs(),
            "{fleet} {grid} {threshold} {name}: expected {expected}, found {found}"
        );
    }
}
