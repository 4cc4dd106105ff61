//! `cruisefit evaluate`: the fuel-flow error of a model over reports; nothing is adapted.

use std::collections::BTreeMap;

use crate::args::EvaluateArgs;
use crate::commands::{Outcome, check_refused, predicts, prepare};
use crate::failure::{Failure, RefusedReport};
use crate::files::write_atomically;
use crate::models::Models;
use crate::progress::Progress;
use crate::reading::FlightRead;
use pipeline::evaluation::{TailCounts, TailData, TailResult};
use pipeline::model_file::ModelFile;
use pipeline::summary::{RefusedSummary, ReportsSummary, SCHEMA, Summary};
use pipeline::whole_model::Predicts;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &EvaluateArgs, progress: Progress) -> Result<Outcome, Failure> {
    let (summary, refused) = evaluate(arguments, progress)?;
    if let Some(path) = &arguments.json {
        write_atomically(path, &summary.to_json())?;
    }
    Ok(Outcome { text: summary.to_text(), refused })
}

/// The error of the models over the reports, and what was refused.
///
/// # Errors
/// A reason for which there is nothing to evaluate.
pub(crate) fn evaluate(
    arguments: &EvaluateArgs,
    progress: Progress,
) -> Result<(Summary, Vec<RefusedReport>), Failure> {
    let models = Models::read(&arguments.models.models)?;
    let reading = prepare(&arguments.reports, progress)?;
    let files = reading.files();
    let mut refused = reading.refused;
    let mut by_tail: BTreeMap<String, (ModelFile, Vec<FlightRead>)> = BTreeMap::new();
    for flight in reading.flights {
        match models.for_flight(&flight) {
            Ok(model) => by_tail
                .entry(flight.reduced.identity.tail.clone())
                .or_insert_with(|| (model.clone(), Vec::new()))
                .1
                .push(flight),
            Err(reason) => refused.push(RefusedReport::whole(flight.path, reason)),
        }
    }
    refused.sort_by(|one, other| one.path.cmp(&other.path));
    check_refused(&refused, files, arguments.reports.strict, by_tail.is_empty())?;
    let predicts = predicts(arguments.table_only);
    let read = by_tail.values().map(|(_, flights)| flights.len()).sum();
    let tails = by_tail
        .into_iter()
        .map(|(tail, (model, flights))| evaluate_tail(tail, model, flights, predicts).summary)
        .collect();
    let summary = Summary {
        schema: SCHEMA,
        reports: ReportsSummary {
            read,
            already_known: 0,
            refused: refused.iter().map(RefusedSummary::from).collect(),
        },
        tails,
    };
    Ok((summary, refused))
}

fn evaluate_tail(
    tail: String,
    model: ModelFile,
    mut flights: Vec<FlightRead>,
    predicts: Predicts,
) -> TailResult {
    flights.sort_by(FlightRead::order);
    let counts = TailCounts {
        flights: flights.len(),
        flights_new: flights.len(),
        samples: flights.iter().map(|flight| flight.reduced.samples as u64).sum(),
    };
    let mut notes: Vec<String> = model.note_of_effects().into_iter().collect();
    for flight in &flights {
        flight.add_notes(&mut notes);
    }
    let segments = flights.into_iter().flat_map(|flight| flight.reduced.segments).collect();
    TailResult::as_given(TailData { tail, model, segments, counts, notes }, predicts)
}
