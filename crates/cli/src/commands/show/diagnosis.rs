//! What a `diagnosis.json` holds, tail by tail: the figures that decide, from the document alone.

use std::fmt::Write;

use pipeline::diagnosis_words::{NO_CAUSE_STANDS_OUT, stands_out};
use pipeline::fleet_diagnosis::{FleetRecord, of_tail_words};
use pipeline::summary::{aligned, counted};
use serde_json::Value;

/// A guide that is off is named otherwise: the table is learnt first, whatever its probability.
const DRAG_TABLE: &str = "drag_table";
/// Causes that are listed; the others are in the document.
const CAUSES: usize = 6;
/// Regions that are listed.
const REGIONS: usize = 3;

/// The text of every diagnosis of a document.
pub(super) fn text(document: &Value) -> String {
    let mut text = String::new();
    let diagnoses = document["diagnoses"].as_array().map_or(&[][..], Vec::as_slice);
    // Documents of another program may have others; what cannot be read is not told.
    let fleets: Vec<FleetRecord> =
        serde_json::from_value(document["fleets"].clone()).unwrap_or_default();
    for diagnosis in diagnoses {
        append(diagnosis, &fleets, &mut text);
        text.push('\n');
    }
    let _ = writeln!(
        text,
        "{} by {}",
        if diagnoses.len() == 1 {
            "1 diagnosis".to_owned()
        } else {
            format!("{} diagnoses", diagnoses.len())
        },
        document["program"].as_str().unwrap_or("an unknown program")
    );
    text
}

fn append(diagnosis: &Value, fleets: &[FleetRecord], text: &mut String) {
    let compared = &diagnosis["compared"];
    let count =
        |value: &Value| value.as_u64().and_then(|count| usize::try_from(count).ok()).unwrap_or(0);
    let _ = writeln!(
        text,
        "{}: {} from {} to {}, {}; model {}, {}, {} learnt",
        words(&diagnosis["tail"]),
        counted(count(&diagnosis["flights"]), "flight"),
        date(&compared["first_flight"]),
        date(&compared["last_flight"]),
        counted(count(&diagnosis["segments"]), "segment"),
        words(&compared["aircraft"]),
        words(&compared["law"]),
        counted(count(&compared["flights_learnt"]), "flight"),
    );
    let gap = &diagnosis["gap"];
    if gap["rms_percent"].is_null() {
        text.push_str("  Too little data: no gap was computed\n");
    } else {
        let _ = writeln!(
            text,
            "  Gap {} % in the mean, {} % rms{}; noise alone makes {} %",
            signed(&gap["mean_percent"], 2),
            plain(&gap["rms_percent"], 2),
            interval(&gap["rms_ci95"], 2),
            plain(&gap["noise_floor_rms_percent"], 2)
        );
    }
    let regions = diagnosis["where"].as_array().map_or(&[][..], Vec::as_slice);
    for region in regions.iter().take(REGIONS) {
        let _ = writeln!(
            text,
            "  Region: {}, {} %{}, p {}",
            words(&region["slice"]),
            signed(&region["mean_gap_percent"], 2),
            interval(&region["ci95"], 2),
            plain(&region["p_value"], 3)
        );
    }
    let verdict = &diagnosis["verdict"];
    let _ = writeln!(text, "  Verdict: {}", verdict_words(verdict));
    if let Some(told) = of_tail_words(fleets, &words(&diagnosis["tail"])) {
        let _ = writeln!(text, "  In its fleet: {told}");
    }
    if let Some(advice) = verdict["advice"].as_str().filter(|advice| !advice.is_empty()) {
        let _ = writeln!(text, "  To do: {advice}");
    }
    append_causes(diagnosis, text);
}

/// The kind with the effects named; where none of them stands out, that first.
fn verdict_words(verdict: &Value) -> String {
    let effects = listed(&verdict["effects"]);
    let probability = verdict["probability"].as_f64().filter(|_| !effects.is_empty());
    match probability {
        Some(probability) if !stands_out(probability) && effects != DRAG_TABLE => format!(
            "{NO_CAUSE_STANDS_OUT}; the most probable, not to be acted on: {effects}, probability {probability:.2}"
        ),
        Some(probability) => {
            format!("{}, {effects}, probability {probability:.2}", words(&verdict["kind"]))
        }
        None if effects.is_empty() => words(&verdict["kind"]),
        None => format!("{}, {effects}", words(&verdict["kind"])),
    }
}

fn append_causes(diagnosis: &Value, text: &mut String) {
    let causes = diagnosis["causes"].as_array().map_or(&[][..], Vec::as_slice);
    if causes.is_empty() {
        return;
    }
    let head = ["  cause", "probability", "size", "unit", "left, % rms"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for cause in causes.iter().take(CAUSES) {
        let size = &cause["magnitude"];
        rows.push(vec![
            format!("  {}", words(&cause["effect"])),
            plain(&cause["probability"], 2),
            format!("{}{}", signed(&size["value"], 2), interval(&size["ci95"], 2)),
            words(&size["unit"]),
            plain(&cause["rms_after_percent"], 2),
        ]);
    }
    text.push_str(&aligned(&rows));
    if causes.len() > CAUSES {
        let _ = writeln!(text, "  and {} less probable", causes.len() - CAUSES);
    }
}

fn words(value: &Value) -> String {
    value.as_str().unwrap_or("–").to_owned()
}

fn date(value: &Value) -> String {
    words(value).split('T').next().unwrap_or_default().to_owned()
}

fn plain(value: &Value, decimals: usize) -> String {
    value.as_f64().map_or_else(|| "–".to_owned(), |number| format!("{number:.decimals$}"))
}

fn signed(value: &Value, decimals: usize) -> String {
    value.as_f64().map_or_else(|| "–".to_owned(), |number| format!("{number:+.decimals$}"))
}

fn interval(value: &Value, decimals: usize) -> String {
    match (value[0].as_f64(), value[1].as_f64()) {
        (Some(low), Some(high)) => format!(" ({low:.decimals$} to {high:.decimals$})"),
        _ => String::new(),
    }
}

fn listed(value: &Value) -> String {
    let names = value.as_array().map_or(&[][..], Vec::as_slice);
    names.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_document_lacks_is_a_dash() {
        let shown = text(&serde_json::json!({ "diagnoses": [{ "tail": "T-1", "flights": 1 }] }));
        assert!(shown.starts_with("T-1: 1 flight from – to –, 0 segments"), "{shown}");
        assert!(shown.contains("Verdict: –"), "{shown}");
        assert!(text(&serde_json::json!({})).starts_with("0 diagnoses"));
    }
    /// The same words as on the terminal of diagnose; what the comparison with its type found of a tail is said with it.
    #[test]
    fn an_open_verdict_and_what_a_fleet_says_are_told() {
        let verdict = |probability: f64, effects: &[&str]| serde_json::json!({ "kind": "effects", "effects": effects, "probability": probability });
        let told = verdict_words(&verdict(0.17, &["tsfc_engine_2"]));
        assert!(told.starts_with("no cause stands out; the most probable, not to be"), "{told}");
        assert_eq!(
            verdict_words(&verdict(0.83, &["drag_factor"])),
            "effects, drag_factor, probability 0.83"
        );
        let magnitude = serde_json::json!({ "value": -1.63, "unit": "%", "ci95": [-2.28, -0.98] });
        let found = serde_json::json!({ "level": "tail", "levels": ["tail", "sensor"], "tail": "T-1",
            "effect": "tsfc_engine_2", "class": ["tsfc_engine_2"], "probability": 0.997, "effect_probability": 0.5,
            "magnitude": magnitude });
        let fleet = serde_json::json!({ "aircraft_type": "C750", "model_of": "tail", "findings": [found],
            "false_share": 0.0, "spread_of_typical": 0.1, "smooth_discrepancy_percent": 0.2, "effects": [],
            "tails": [], "left_out": [] });
        let silent = serde_json::json!({ "kind": "no_gap", "effects": [], "probability": 0.0 });
        let shown = text(&serde_json::json!({ "fleets": [fleet], "diagnoses": [
            { "tail": "T-1", "verdict": silent }, { "tail": "T-2", "verdict": silent }
        ] }));
        let told = "In its fleet: It differs from its type by: engine 2 burns less, tsfc_engine_2 -1.63 ± 0.65 % \
                    (probability 1.00, the aircraft or a sensor).";
        assert_eq!(shown.matches("In its fleet").count(), 1, "{shown}");
        assert!(shown.contains(told), "{shown}");
    }
}
