//! What the `STATE.ron` of a folder names.

use std::path::Path;

use pipeline::folder_state::{State, TailState};
use pipeline::summary::{Summary, TailSummary, aligned, counted};

use crate::commands::Outcome;
use crate::failure::Failure;
use crate::folder::state::NAME;

/// In which tails of its folder a summary is not what they have learnt by now: `forget` leaves it as the last run of `adapt` made it.
/// Nothing where it lies in no folder that `adapt` keeps.
pub(super) fn since(summary_path: &Path, summary: &Summary) -> String {
    let path = summary_path.with_file_name(NAME);
    let text = std::fs::read_to_string(path).ok();
    let Some(state) = text.and_then(|text| State::from_text(&text).ok()) else {
        return String::new();
    };
    let words = |tail: &TailSummary| {
        let now = state.tails.get(&tail.tail).map_or(0, |now| now.summary.flights);
        (now != tail.flights).then(|| {
            let tail = &tail.tail;
            format!("Since that run of adapt flights were forgotten: tail {tail} has learnt {now} now.\n")
        })
    };
    summary.tails.iter().filter_map(words).collect()
}

/// The tails of a state, each with its flights and its model.
///
/// # Errors
/// A state that is damaged, or of a newer format.
pub(super) fn outcome(path: &Path, text: &str) -> Result<Outcome, Failure> {
    let state = State::from_text(text).map_err(|error| Failure::bad_file(path, error))?;
    let tails: Vec<(&String, &TailState)> = state.tails.iter().collect();
    let flights: usize = tails.iter().map(|(_, of)| of.summary.flights).sum();
    let mut words = format!(
        "State of a folder that adapt keeps: generation {}, {}, {}. The folder itself shows more.\n",
        state.generation,
        counted(tails.len(), "tail"),
        counted(flights, "flight")
    );
    let mut rows = vec![["tail", "flights", "segments", "model"].map(str::to_owned).to_vec()];
    rows.extend(tails.iter().map(|(tail, of)| {
        let summary = &of.summary;
        let counts = [summary.flights, summary.segments].map(|count| count.to_string());
        let [flights, segments] = counts;
        vec![(*tail).clone(), flights, segments, of.model.file.clone()]
    }));
    words.push_str(&aligned(&rows));
    let document = serde_json::json!({
        "schema": "cruisefit.state-summary/1",
        "generation": state.generation,
        "tails": tails.iter().map(|(tail, of)| serde_json::json!({
            "tail": tail,
            "flights": of.summary.flights,
            "segments": of.summary.segments,
            "model": of.model.file,
        })).collect::<Vec<_>>(),
    });
    Ok(Outcome::with_json(words, format!("{document:#}\n")))
}
