//! Documents made up for pages that no quick run would fill.

use std::fs;
use std::path::Path;

use flight::effect::EffectId;
use page::{
    FleetRun, TrialCalibration, TrialGoal, TrialGroup, TrialScore, TrialsPage, fleet_diagnosis,
};
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
    let reports = ReportsSummary { read: 1800, ..ReportsSummary::default() };
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

/// Writes the page of trials in which every effect of two engines was planted eight times and found six times.
pub(super) fn trials(page: &Path) {
    let names: Vec<String> = EffectId::library(2).iter().map(ToString::to_string).collect();
    let confusion = names.iter().enumerate().map(|(k, name)| {
        let other = names[(k + 3) % names.len()].clone();
        (name.clone(), [(name.clone(), 6), (other, 1), ("no_gap".to_owned(), 1)].into())
    });
    let score = |words: &str, value| TrialScore {
        words: words.to_owned(),
        value: Some(value),
        ci95: Some([value - 0.05, value + 0.02]),
        of: Some(240),
    };
    let bin = |tenth: u32| {
        let stated = 0.1 * f64::from(tenth) + 0.05;
        let range = [stated - 0.05, stated + 0.05];
        let right = stated - 0.04;
        TrialCalibration { range, stated, right, ci95: [right - 0.04, right + 0.04], of: 24 }
    };
    let group = TrialGroup {
        name: "exact model, clean, 1 × typical".to_owned(),
        cases: "240 single effects".to_owned(),
        scores: vec![score("The planted effect is on top", 0.75), score("Silent", 0.98)],
        confusion: confusion.collect(),
        calibration: (1..10).map(bin).collect(),
        size_tenths: [24, 17, 14, 19, 16, 20, 15, 18, 17, 22],
    };
    let other =
        TrialGroup { name: "adapted model, clean, 1 × typical".to_owned(), ..group.clone() };
    let document = TrialsPage {
        plan: vec!["seed 17".to_owned(), "60 flights of 2 h diagnosed".to_owned()],
        seal_sha256: "6f1ed002ab5595859014ebf0951522d9".to_owned(),
        cases: 240,
        failed: Vec::new(),
        goals: vec![TrialGoal {
            group: group.name.clone(),
            goal: "≥ 0.97".to_owned(),
            reached: score("The planted effect is on top", 0.75),
            met: Some(false),
        }],
        groups: vec![group, other],
    };
    fs::write(page, page::trials(&document)).unwrap();
}
