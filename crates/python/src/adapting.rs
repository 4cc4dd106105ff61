//! The calls that make an [`Adapted`]: adapt, evaluate; and merge.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

use flight::Timestamp;
use pipeline::adaptation::{
    self, Contradictions, LawAsked, OlderFlights, RemainderChoice, Sorting, Start, Starts,
    StoredTail, refuse_impossible,
};
use pipeline::criteria_costs::CriteriaCosts;
use pipeline::evaluation::TailResult;
use pipeline::known_flights::KnownFlights;
use pipeline::merging::{self, Part};
use pipeline::models::{Models, ReportsByModel, check_engines};
use pipeline::plausibility::{self, Absurd, Book};
use pipeline::reading::{FlightRead, Reading, RefusedReport};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::adapted::{Adapted, Reports, Tail};
use crate::failure::Failure;
use crate::flights::Flights;
use crate::model::{Model, models_of, predicts_of};
use crate::work::{Caller, run, threads_in, threads_of};

/// How tails learn, in the words of the Python files.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Options {
    law: String,
    threshold_percent: Option<f64>,
    remainder: String,
    older: String,
    contradictions: String,
    absurd: String,
    threads: Option<i128>,
}

/// Every tail's flights learnt, from the initial part of its model or from what `begun` has learnt.
#[pyfunction]
pub(crate) fn adapt(
    py: Python<'_>,
    models: Vec<Py<Model>>,
    flights: &Flights,
    options: Options,
    begun: Option<&Adapted>,
) -> PyResult<Adapted> {
    let how = How::new(&options)?;
    let models = models_of(&models)?;
    let flights = flights.clone();
    let begun = begun.map(|begun| Arc::clone(&begun.tails));
    run(py, threads_in(options.threads)?, move |caller| {
        adapt_all(&models, &flights, &how, begun, caller)
    })
}

/// The errors of models over flights; nothing is adapted. `predicts`: `whole` or `table`.
#[pyfunction]
pub(crate) fn evaluate(
    py: Python<'_>,
    models: Vec<Py<Model>>,
    flights: &Flights,
    predicts: &str,
    #[pyo3(from_py_with = threads_of)] threads: Option<NonZeroUsize>,
) -> PyResult<Adapted> {
    let predicts = predicts_of(predicts)?;
    let models = models_of(&models)?;
    let flights = flights.clone();
    run(py, threads, move |caller| {
        let mut reading = flights.distinct().clone();
        let by_tail = models.with_flights(&mut reading);
        let refused = reading.refused;
        let read = by_tail.values().map(|(_, flights)| flights.len()).sum();
        let tails = by_tail
            .into_par_iter()
            .map(|(tail, (model, flights))| {
                caller.still_waits()?;
                let result = TailResult::of_flights(tail, model.clone(), flights, predicts);
                Ok(Tail { result, flights: Vec::new(), begun: String::new(), costs: None })
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        let Reading { copies, other_files, .. } = reading;
        let reports = Reports { read, copies, other_files, refused, ..Reports::default() };
        Ok(Adapted::new(tails, reports))
    })
}

/// The sum of what models of one initial model have learnt.
#[pyfunction]
pub(crate) fn merge(py: Python<'_>, models: Vec<Py<Model>>) -> PyResult<Model> {
    let models: Vec<Model> = models.iter().map(|model| model.get().clone()).collect();
    let file = run(py, NonZeroUsize::new(1), move |_| {
        if models.is_empty() {
            return Err(Failure::input("models: none given, expected two or more"));
        }
        let part = |model: &Model| Part { model: model.file.as_ref().clone(), flights: None };
        let merged = merging::merge(models.iter().map(part).collect());
        let (merged, _) = merged.map_err(|(place, error)| {
            Failure::input(&error).in_file(models[place].name.display().to_string())
        })?;
        Ok(merged)
    })?;
    let name = PathBuf::from(file.tail().unwrap_or_default());
    Ok(Model { file: Arc::new(file), name })
}

/// How tails learn.
#[derive(Debug)]
struct How {
    law: LawAsked,
    remainder: RemainderChoice,
    older: OlderFlights,
    contradictions: Contradictions,
    absurd: Absurd,
}

impl How {
    fn new(options: &Options) -> Result<Self, Failure> {
        Ok(Self {
            law: match (options.law.as_str(), options.threshold_percent) {
                ("bayes", None) => LawAsked::Bayes,
                ("bayes", Some(_)) => {
                    return Err(Failure::input("threshold: law bayes has none; law paper has"));
                }
                ("paper", threshold_percent) => LawAsked::Paper { threshold_percent },
                (other, _) => {
                    return Err(Failure::input(format!(
                        "law: found {other:?}, expected \"bayes\" or \"paper\""
                    )));
                }
            },
            remainder: choice(
                &options.remainder,
                [("learn", RemainderChoice::Learn), ("leave", RemainderChoice::Leave)],
            )?,
            older: choice(
                &options.older,
                [("learn", OlderFlights::Learn), ("refuse", OlderFlights::Refuse)],
            )?,
            contradictions: choice(
                &options.contradictions,
                [("refuse", Contradictions::Refuse), ("relearn", Contradictions::Relearn)],
            )?,
            absurd: absurd_of(&options.absurd)?,
        })
    }
}

/// `refuse` or `accept`.
///
/// # Errors
/// Another word.
pub(crate) fn absurd_of(word: &str) -> Result<Absurd, Failure> {
    choice(word, [("refuse", Absurd::Refuse), ("accept", Absurd::Accept)])
}

/// What a word of the Python files stands for.
fn choice<T: Copy>(word: &str, words: [(&str, T); 2]) -> Result<T, Failure> {
    words.iter().find(|(known, _)| *known == word).map(|(_, meant)| *meant).ok_or_else(|| {
        Failure::input(format!("found {word:?}, expected {:?} or {:?}", words[0].0, words[1].0))
    })
}

/// A tail to be learnt.
struct Job<'a> {
    tail: String,
    start: Start<'a>,
    flights: Vec<FlightRead>,
    stored: Option<(StoredTail, String)>,
}

/// What a tail came to.
struct Outcome {
    tail: Option<Tail>,
    reports: Reports,
}

fn adapt_all(
    models: &Models,
    flights: &Flights,
    how: &How,
    begun: Option<Arc<Vec<Tail>>>,
    caller: &Caller,
) -> Result<Adapted, Failure> {
    let mut reports = Reports {
        other_files: flights.reading.other_files,
        refused: flights.reading.refused.clone(),
        ..Reports::default()
    };
    let mut starts = Starts::new(how.law, &flights.criteria, how.remainder);
    let mut by_tail: BTreeMap<String, ReportsByModel<'_, FlightRead>> = BTreeMap::new();
    for flight in &flights.reading.flights {
        let tail = &flight.reduced.identity.tail;
        match models.to_begin_with(tail, &flight.reduced.aircraft_type) {
            Ok(model) => by_tail.entry(tail.clone()).or_default().add(model, flight.clone()),
            Err(reason) => reports.refused.push(RefusedReport::whole(flight.path.clone(), reason)),
        }
    }
    let begun = begun.map_or_else(Vec::new, Arc::unwrap_or_clone);
    let mut stored: BTreeMap<String, Tail> =
        begun.into_iter().map(|tail| (tail.result.tail.clone(), tail)).collect();
    let mut jobs = Vec::new();
    for (tail, by_model) in by_tail {
        let known = stored.remove(&tail);
        let begun = known.as_ref().map(|known| known.begun.as_str());
        let is_known = |model| begun == Some(starts.of_model(model).begun.as_str());
        let Some(one) = by_model.of_one(&tail, is_known) else { continue };
        let (start, flights) = (starts.of_model(one.model), one.reports);
        reports.refused.extend(
            one.strays.into_iter().map(|(flight, why)| RefusedReport::whole(flight.path, why)),
        );
        let stored = match known {
            None => None,
            Some(known) => {
                check_begun_alike(&tail, &known, &start)?;
                let begun = known.begun.clone();
                Some((known.stored(), begun))
            }
        };
        jobs.push(Job { tail, start, flights, stored });
    }
    let outcomes = jobs
        .into_par_iter()
        .map(|job| {
            caller.still_waits()?;
            learn(job, how)
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let mut tails = Vec::new();
    for Outcome { tail, reports: of_tail } in outcomes {
        tails.extend(tail);
        reports.read += of_tail.read;
        reports.already_known += of_tail.already_known;
        reports.copies += of_tail.copies;
        reports.refused.extend(of_tail.refused);
        reports.findings.push_str(&of_tail.findings);
    }
    tails.extend(stored.into_values().map(|tail| {
        let begun = tail.begun.clone();
        Tail::learnt(tail.stored(), begun, 0, Vec::new())
    }));
    Ok(Adapted::new(tails, reports))
}

fn check_begun_alike(tail: &str, known: &Tail, start: &Start<'_>) -> Result<(), Failure> {
    if known.begun == start.begun {
        return Ok(());
    }
    if start.learns_more_than(&known.begun) {
        return Err(Failure::input(format!(
            "tail {tail} was started with another setting: the table alone was learnt, and more would be now; pass remainder=False"
        )));
    }
    match start.difference(tail, &known.result.model).map_err(Failure::input)? {
        None => Ok(()),
        Some((what, difference)) => Err(Failure::input(format!(
            "tail {tail} was started with another {what}: {difference}"
        ))),
    }
}

fn learn(job: Job<'_>, how: &How) -> Result<Outcome, Failure> {
    let Job { tail, start, mut flights, stored } = job;
    flights.sort_by(FlightRead::order);
    let mut known = KnownFlights::new(
        stored.as_ref().map_or_else(Vec::new, |(stored, _)| stored.flights.clone()),
    );
    // A flight that is known changes nothing, whatever is wrong with it.
    let (known_already, flights): (Vec<_>, Vec<_>) = flights.into_iter().partition(|flight| {
        let identity = &flight.reduced.identity;
        known
            .find(identity.start, &identity.flight)
            .is_some_and(|known| flight.has_content(&known.entry.content))
    });
    if let Some((stored, _)) = &stored {
        known.add_segments(&stored.segments);
    }
    let mut reading = Reading::default();
    for flight in flights {
        match check_engines(start.model, &flight) {
            Ok(()) => reading.flights.push(flight),
            Err(reason) => reading.refused.push(RefusedReport::whole(flight.path, reason)),
        }
    }
    refuse_impossible(&mut reading, Timestamp::now());
    let model = &start.model.initial;
    let learnt = stored.as_ref().map_or(&[][..], |(stored, _)| &stored.segments);
    let book = Book { model, table: model.drag_table(), learnt: Some(learnt) };
    let findings = plausibility::set_aside_absurd(&mut reading, |_| Some(book), how.absurd);
    let mut sorting = Sorting::new(&tail, known);
    sorting.contradictions = how.contradictions;
    sorting.older = how.older;
    sorting.already_known = known_already.len();
    for flight in &known_already {
        sorting.is_at_hand(flight.reduced.identity.start, &flight.reduced.identity.flight);
    }
    sorting.refused = reading.refused;
    let costs = CriteriaCosts::of_flights(&reading.flights);
    for flight in reading.flights {
        sorting.sort(flight);
    }
    let (already_known, copies) = (sorting.already_known, sorting.copies);
    let (stored, begun) = match stored {
        Some((stored, begun)) => (Some(stored), begun),
        None => (None, start.begun.clone()),
    };
    let before = stored.clone();
    let found =
        adaptation::learn(&start, &tail, sorting, stored, how.remainder).map_err(Failure::input)?;
    let tail = match found.learnt {
        Some(learnt) => {
            let tail = Tail::learnt(learnt, start.begun.clone(), found.flights_new, found.notes);
            Some(Tail { costs, ..tail })
        }
        None => before.map(|stored| Tail::learnt(stored, begun, 0, Vec::new())),
    };
    let read = tail.as_ref().map_or(0, |tail| tail.result.summary.flights_new);
    let reports = Reports {
        read,
        already_known,
        copies,
        refused: found.refused,
        findings,
        ..Reports::default()
    };
    Ok(Outcome { tail, reports })
}
