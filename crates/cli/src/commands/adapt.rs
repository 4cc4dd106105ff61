//! `cruisefit adapt`: one adapted model per tail, continuing from what the folder holds.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::args::{AdaptArgs, LawName};
use crate::commands::{Outcome, check_refused, prepare};
use crate::failure::{Failure, RefusedReport, show};
use crate::folder::{Folder, StoredTail};
use crate::models::Models;
use crate::plausibility;
use crate::progress::Progress;
use crate::reading::{FlightRead, Reading};
use pipeline::evaluation::{TailCounts, TailData, TailResult};
use pipeline::learning::{self, FlightToLearn, LawChoice};
use pipeline::model_file::{Learnt, LedgerEntry, ModelFile, PaperSettings};
use pipeline::summary::{RefusedSummary, ReportsSummary, SCHEMA, Summary};

pub(super) mod dates;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &AdaptArgs, progress: Progress) -> Result<Outcome, Failure> {
    let models = Models::read(&arguments.models.models)?;
    check_threshold(arguments)?;
    let mut reading = prepare(&arguments.reports, progress)?;
    let files = reading.files();
    dates::refuse_impossible(&mut reading, flight::Timestamp::now());
    let chosen = choose_models(&models, &mut reading, arguments)?;
    let book_of = |flight: &FlightRead| {
        let model = models.for_flight(flight).ok()?;
        Some((&model.initial, model.initial.drag_table()))
    };
    plausibility::set_aside_absurd(&mut reading, book_of, arguments.accept);
    let nothing_left = reading.flights.is_empty();
    check_refused(&reading.refused, files, arguments.reports.strict, nothing_left)?;
    let folder = Folder::open(&arguments.output, arguments.restart)?;
    let mut stored = folder.load()?;
    for (tail, start) in &chosen {
        if let Some(known) = stored.get(tail) {
            check_begun_alike(&arguments.output, known, start)?;
        }
    }
    let mut by_tail: BTreeMap<String, Vec<FlightRead>> = BTreeMap::new();
    for flight in reading.flights {
        by_tail.entry(flight.reduced.identity.tail.clone()).or_default().push(flight);
    }
    let mut refused = reading.refused;
    let mut already_known = 0;
    let mut jobs = Vec::new();
    for (tail, flights) in by_tail {
        let Some(start) = chosen.get(&tail) else { continue };
        let begun = stored.remove(&tail);
        let sorted = sort_out(&tail, flights, begun.as_ref(), arguments.reports.strict);
        refused.extend(sorted.refused);
        already_known += sorted.already_known;
        jobs.push(Job {
            tail,
            begun,
            start: start.clone(),
            flights: sorted.new,
            warnings: sorted.warnings,
        });
    }
    check_refused(&refused, files, arguments.reports.strict, false)?;
    // A tail's flights are learnt in order; tails are independent of each other.
    let learnt: Vec<(TailResult, Vec<RefusedReport>)> =
        jobs.into_par_iter().map(|job| job.learn(!arguments.no_remainder)).collect();
    let mut read = 0;
    let mut results = Vec::new();
    for (result, not_learnt) in learnt {
        read += result.summary.flights_new;
        refused.extend(not_learnt);
        if result.summary.flights_new > 0 || result.summary.flights > 0 {
            results.push(result);
        }
    }
    for result in &results {
        if result.summary.flights_new > 0 || !folder.model_path(&result.tail).exists() {
            folder.store(&result.tail, &result.model, &result.rows)?;
        }
    }
    // The summary covers every tail that the folder holds, also those without a report in this run.
    for (tail, StoredTail { model, segments }) in stored {
        results.push(at_rest(tail, model, segments));
    }
    results.sort_by(|one, other| one.tail.cmp(&other.tail));
    refused.sort_by(|one, other| one.path.cmp(&other.path));
    let reports = ReportsSummary {
        read,
        already_known,
        refused: refused.iter().map(RefusedSummary::from).collect(),
    };
    let summary = write_results(&folder, reports, &results)?;
    let text = format!(
        "{}Written to {}: models/, segments/, summary.json, report.html\n",
        summary.to_text(),
        show(&arguments.output)
    );
    Ok(Outcome { text, refused })
}

/// Writes `summary.json` and `report.html`.
fn write_results(
    folder: &Folder,
    reports: ReportsSummary,
    results: &[TailResult],
) -> Result<Summary, Failure> {
    let summary = Summary {
        schema: SCHEMA,
        reports,
        tails: results.iter().map(|result| result.summary.clone()).collect(),
    };
    folder.write("summary.json", &summary.to_json())?;
    let title = "Adaptation of performance models to cruise reports";
    folder.write("report.html", page::report(&summary, results, title).as_bytes())?;
    Ok(summary)
}

fn check_threshold(arguments: &AdaptArgs) -> Result<(), Failure> {
    let wrong = |reason: String| Failure::BadArgument { argument: "--threshold", reason };
    match (arguments.threshold, arguments.law) {
        (Some(_), LawName::Bayes) => {
            Err(wrong("law bayes has no threshold; --law paper has".to_owned()))
        }
        (Some(threshold), LawName::Paper) => adapt::paper::PaperLaw::new(threshold)
            .map(|_| ())
            .map_err(|error| wrong(error.to_string())),
        (None, _) => Ok(()),
    }
}

/// The state that each tail starts from; a report without a model moves to the refused ones.
fn choose_models(
    models: &Models,
    reading: &mut Reading,
    arguments: &AdaptArgs,
) -> Result<BTreeMap<String, ModelFile>, Failure> {
    let mut chosen = BTreeMap::new();
    let flights = std::mem::take(&mut reading.flights);
    for flight in flights {
        match models.for_flight(&flight) {
            Ok(model) => {
                let tail = &flight.reduced.identity.tail;
                if !chosen.contains_key(tail) {
                    chosen.insert(tail.clone(), beginning(model, tail, arguments)?);
                }
                reading.flights.push(flight);
            }
            Err(reason) => reading.refused.push(RefusedReport::whole(flight.path, reason)),
        }
    }
    Ok(chosen)
}

/// A model's initial part, before anything is learnt.
fn beginning(model: &ModelFile, tail: &str, arguments: &AdaptArgs) -> Result<ModelFile, Failure> {
    if let Some(learnt) = &model.learnt {
        tracing::warn!(
            tail,
            "the model given has learnt {} flights of tail {}; adaptation starts from its initial part{}",
            learnt.ledger.len(),
            learnt.tail,
            if model.applied.is_empty() { "" } else { " and the effects applied to it" }
        );
    }
    let law = match arguments.law {
        LawName::Bayes => LawChoice::Bayes(model.settings.bayes),
        LawName::Paper => LawChoice::Paper(PaperSettings {
            threshold_percent: arguments
                .threshold
                .unwrap_or(model.settings.paper.threshold_percent),
        }),
    };
    let learnt = learning::begin(&model.initial, tail, &arguments.reports.criteria, law)
        .map_err(|error| Failure::BadArgument { argument: "--model", reason: error.to_string() })?;
    Ok(ModelFile { learnt: Some(learnt), ..model.clone() })
}

fn check_begun_alike(
    folder: &std::path::Path,
    known: &StoredTail,
    start: &ModelFile,
) -> Result<(), Failure> {
    let otherwise =
        |what, difference| Failure::BegunOtherwise { folder: show(folder), what, difference };
    if let Some((what, difference)) = start.difference_of_initial(&known.model) {
        return Err(otherwise(what, difference));
    }
    if let Some(difference) = start.difference_of_law(&known.model) {
        return Err(otherwise("law or setting", difference));
    }
    Ok(())
}

/// A tail for which this run has nothing new.
fn at_rest(tail: String, model: ModelFile, segments: Vec<flight::Segment>) -> TailResult {
    let counts = counts_of(&model, 0);
    TailResult::adapted(TailData { tail, model, segments, counts, notes: Vec::new() })
}

fn counts_of(model: &ModelFile, flights_new: usize) -> TailCounts {
    let ledger = model.learnt.as_ref().map_or(&[][..], |learnt| &learnt.ledger);
    TailCounts {
        flights: ledger.len(),
        flights_new,
        samples: ledger.iter().map(|entry| entry.samples).sum(),
    }
}

struct Sorted {
    new: Vec<FlightRead>,
    refused: Vec<RefusedReport>,
    already_known: usize,
    warnings: Vec<String>,
}

/// Puts a tail's flights in the order of flying and sets aside those already in the ledger, or given twice.
fn sort_out(
    tail: &str,
    mut flights: Vec<FlightRead>,
    begun: Option<&StoredTail>,
    strict: bool,
) -> Sorted {
    flights.sort_by(FlightRead::order);
    let ledger = begun
        .and_then(|begun| begun.model.learnt.as_ref())
        .map_or(&[][..], |learnt| learnt.ledger.as_slice());
    let mut known: BTreeMap<(String, String), String> = ledger
        .iter()
        .map(|entry| ((entry.start.clone(), entry.flight.clone()), entry.content.clone()))
        .collect();
    let newest =
        ledger.iter().filter_map(|entry| entry.start.parse::<flight::Timestamp>().ok()).max();
    let mut sorted =
        Sorted { new: Vec::new(), refused: Vec::new(), already_known: 0, warnings: Vec::new() };
    for flight in flights {
        let key =
            (flight.reduced.identity.start.to_string(), flight.reduced.identity.flight.clone());
        let refuse = |reason: String| RefusedReport::whole(flight.path.clone(), reason);
        match known.get(&key) {
            Some(content) if *content == flight.content => {
                sorted.already_known += 1;
                continue;
            }
            Some(_) => {
                sorted.refused.push(refuse(format!(
                    "tail {tail} flight {} of {} is already known with different content",
                    key.1, key.0
                )));
                continue;
            }
            None => {}
        }
        if newest.is_some_and(|newest| flight.reduced.identity.start < newest) {
            let finding = format!(
                "flight {} of {} is older than the newest one that tail {tail} has learnt",
                key.1, key.0
            );
            if strict {
                sorted.refused.push(refuse(finding));
                continue;
            }
            tracing::warn!("{finding}; it is learnt now, after newer ones");
            sorted.warnings.push(format!("{finding}; it was learnt after newer ones"));
        }
        known.insert(key, flight.content.clone());
        sorted.new.push(flight);
    }
    sorted
}

struct Job {
    tail: String,
    begun: Option<StoredTail>,
    start: ModelFile,
    flights: Vec<FlightRead>,
    warnings: Vec<String>,
}

impl Job {
    fn learn(self, remember_remainder: bool) -> (TailResult, Vec<RefusedReport>) {
        let (mut model, mut segments) = match self.begun {
            Some(StoredTail { model, segments }) => (model, segments),
            None => (self.start, Vec::new()),
        };
        let mut refused = Vec::new();
        let mut notes = self.warnings;
        notes.extend(model.note_of_effects());
        let dated = dates::Dates::of(&model, &self.flights);
        let mut flights_new = 0;
        for flight in self.flights {
            let Some(learnt) = &mut model.learnt else { break };
            let segments_as_dated = dated.as_dated(&flight);
            match learn_one(&model.initial, learnt, &flight, &segments_as_dated) {
                Ok(()) => {
                    flights_new += 1;
                    flight.add_notes(&mut notes);
                    segments.extend(flight.reduced.segments);
                }
                Err(error) => refused.push(RefusedReport::whole(flight.path, error)),
            }
        }
        if let Some(learnt) = &mut model.learnt
            && flights_new > 0
            && let Err(error) = learning::settle(learnt)
        {
            // Cannot happen to a state that was read whole: if it did, what was learnt would not be written.
            tracing::error!(tail = self.tail, "{error}");
            flights_new = 0;
        }
        if let Some(learnt) = &mut model.learnt
            && flights_new > 0
            && remember_remainder
        {
            learning::remember_remainder(&model.initial, learnt, &segments);
        }
        let counts = counts_of(&model, flights_new);
        let data = TailData { tail: self.tail, model, segments, counts, notes };
        (TailResult::adapted(data), refused)
    }
}

fn learn_one(
    initial: &effects::ExtendedModel,
    learnt: &mut Learnt,
    flight: &FlightRead,
    segments: &[flight::Segment],
) -> Result<(), learning::LearningError> {
    let entry = LedgerEntry {
        tail: flight.reduced.identity.tail.clone(),
        flight: flight.reduced.identity.flight.clone(),
        start: flight.reduced.identity.start.to_string(),
        content: flight.content.clone(),
        samples: flight.reduced.samples as u64,
        segments: 0,
        outside_table: 0,
    };
    let result = learning::learn_flight(initial, learnt, &FlightToLearn { entry, segments })?;
    tracing::debug!(
        tail = flight.reduced.identity.tail,
        flight = flight.reduced.identity.flight,
        segments = flight.reduced.segments.len(),
        adapted = result.adapted,
        outside = result.outside_table,
        refitted = result.refitted,
        "learnt"
    );
    Ok(())
}
