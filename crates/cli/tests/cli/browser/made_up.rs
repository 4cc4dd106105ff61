//! Documents made up for pages that no quick run would fill.

use std::fs;
use std::path::Path;

use page::{FleetRun, fleet_diagnosis};
use pipeline::fleet_diagnosis::FleetRecord;
use pipeline::summary::ReportsSummary;
use serde_json::{Value, json};

/// Writes the page of 200 tails, of which every fifth has a finding of its own, and returns its document.
pub(super) fn fleet(page: &Path) -> Value {
    let size = |value: f64, unit: &str| json!({ "value": value, "unit": unit, "ci95": [value - 0.6, value + 0.6] });
    let effect = |name: &str, value: f64, unit: &str| json!({ "effect": name, "magnitude": size(value, unit) });
    let finding = |tail: Option<String>, levels: &[&str], name: &str, value: f64, unit: &str| {
        json!({
            "level": levels[0], "levels": levels, "tail": tail, "effect": name,
            "class": if levels.len() > 1 { vec![name, "mach_bias"] } else { vec![name] },
            "probability": 0.99, "effect_probability": 0.9, "magnitude": size(value, unit),
        })
    };
    let mut findings = vec![finding(None, &["type"], "zero_lift_drag", 8.0, "counts")];
    let tails: Vec<Value> = (0..200_usize)
        .map(|k| {
            let wave = (0.7 * k as f64).sin();
            let (mut drag, mut temperature, mut flow) = (8.0 + wave, 0.2 * wave, 0.1 * wave);
            let name = || Some(format!("T-{k:03}"));
            match k % 15 {
                0 => {
                    drag += 6.0;
                    findings.push(finding(name(), &["tail"], "zero_lift_drag", drag - 8.0, "counts"));
                }
                5 => {
                    temperature += 3.0;
                    findings.push(finding(name(), &["sensor"], "temperature_bias", temperature, "K"));
                }
                10 => {
                    flow -= 1.5;
                    findings.push(finding(name(), &["sensor", "tail"], "fuel_flow_gain", flow, "%"));
                }
                _ => {}
            }
            json!({
                "tail": format!("T-{k:03}"), "flights": 5 + k % 9, "segments": 40 + k, "noise": 1.0 + 0.1 * wave,
                "effects": [effect("zero_lift_drag", drag, "counts"), effect("temperature_bias", temperature, "K"),
                            effect("fuel_flow_gain", flow, "%")],
            })
        })
        .collect();
    let document = json!({
        "aircraft_type": "GLEX", "model_of": "type", "findings": findings, "false_share": 0.012,
        "spread_of_typical": 0.2, "smooth_discrepancy_percent": 0.3,
        "effects": [effect("zero_lift_drag", 8.0, "counts"), effect("temperature_bias", 0.0, "K"),
                    effect("fuel_flow_gain", 0.0, "%")],
        "tails": tails, "left_out": [],
    });
    let record: FleetRecord = serde_json::from_value(document.clone()).unwrap();
    let reports = ReportsSummary { read: 1800, already_known: 0, refused: Vec::new() };
    let run = FleetRun {
        reports: &reports,
        fleets: std::slice::from_ref(&record),
        diagnoses: &[],
        figures: &[],
        options: &["trim criteria steady".to_owned()],
    };
    fs::write(page, fleet_diagnosis(&run)).unwrap();
    document
}
