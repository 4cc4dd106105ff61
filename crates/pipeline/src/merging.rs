//! What models of one initial model have learnt, put together.
//!
//! Where the segments of all of them are at hand, all flights are learnt again in the order of flying: what comes out is what
//! learning all of them at once gives, to the bit. Without segments the sums of law `bayes` are added: nearly the same table,
//! because each flight keeps the outlier weight that it got among the flights of its own model, and nothing more.

use std::collections::BTreeSet;

use adapt::bayes::MergeError as StateMergeError;

use crate::adaptation::{Material, RemainderChoice, materials, rebuild, settled};
use crate::learning::{self, LearningError};
use crate::learnt_flights::KnownFlight;
use crate::model_file::{LawState, Learnt, LedgerEntry, ModelFile};
use crate::prediction::Predictor;
use crate::whole_model::Predicts;
use flight::{Segment, Timestamp};
use perf_model::FlightPoint;

/// A model to merge.
#[derive(Clone, Debug)]
pub struct Part {
    /// The model.
    pub model: ModelFile,
    /// The flights that it has learnt with their segments, where they are at hand.
    pub flights: Option<(Vec<KnownFlight>, Vec<Segment>)>,
}

/// How models were put together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Merging {
    /// All flights were learnt again, as if they had been learnt at once.
    LearntAgain,
    /// Sums were added: the table alone, with the outlier weights that each flight got among the flights of its own model.
    Added,
}

/// By how much tails that were merged differ from each other: standard deviation of the fuel flow that their models predict at the mean
/// state of each, %. `None` of one tail, and where a state cannot be predicted.
///
/// A merged model states how well it knows the mean of its tails, as of one aircraft.
#[must_use]
pub fn spread_of_tails_percent(parts: &[Part]) -> Option<f64> {
    let learnt: Vec<&Learnt> =
        parts.iter().map(|part| part.model.learnt.as_ref()).collect::<Option<_>>()?;
    let tails: BTreeSet<&str> = learnt.iter().map(|one| one.tail.as_str()).collect();
    if tails.len() < 2 {
        return None;
    }
    let states: Vec<FlightPoint> =
        learnt.iter().map(|one| one.references.mean_state()).collect::<Option<_>>()?;
    let mut levels = Vec::with_capacity(parts.len());
    for part in parts {
        let predictor =
            Predictor::new(&part.model, Predicts::WholeModel).ok()?.without_deviations();
        let mut sum = 0.0;
        for state in &states {
            let found = predictor.at(state).ok()?;
            sum += 100.0 * found.prediction.fuel_flow_total.to_kilograms_per_second().ln();
        }
        levels.push(sum / states.len() as f64);
    }
    let mean = levels.iter().sum::<f64>() / levels.len() as f64;
    let squares: f64 = levels.iter().map(|level| (level - mean).powi(2)).sum();
    Some((squares / (levels.len() as f64 - 1.0)).sqrt())
}

/// Why two models do not add up.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MergeError {
    /// Another initial model, aircraft, effect or setting.
    #[error("another {what} than the first model: {difference}")]
    Initial {
        /// Which part of the initial model.
        what: &'static str,
        /// Both values.
        difference: String,
    },
    /// Another law, or other trim criteria.
    #[error("another law or setting than the first model: {difference}")]
    Law {
        /// Both values.
        difference: String,
    },
    /// There is only an initial model.
    #[error("a model that has learnt nothing")]
    NothingLearnt,
    /// A flight that both have learnt.
    #[error(
        "tail {tail} flight {flight} of {start} is in the ledger of an earlier model too: it would count twice"
    )]
    FlightTwice {
        /// Tail.
        tail: String,
        /// Flight.
        flight: String,
        /// START.
        start: String,
    },
    /// Law `paper`.
    #[error("law paper cannot be merged: what it learns depends on the order")]
    LawPaper,
    /// States of law `bayes` that do not add up.
    #[error(transparent)]
    State(#[from] StateMergeError),
    /// What was learnt cannot be learnt again, or solved.
    #[error(transparent)]
    Learning(#[from] LearningError),
}

/// Puts together what models have learnt: by learning all flights again where all of their segments are at hand, otherwise by
/// adding sums. The order of the models does not matter.
///
/// # Errors
/// [`MergeError`], with the place of the model that it is about.
pub fn merge(parts: Vec<Part>) -> Result<(ModelFile, Merging), (usize, MergeError)> {
    // What is wrong is told in the order given; sums are rounded in that of flying.
    let mut order: Vec<&Part> = parts.iter().collect();
    sum(&order)?;
    order.sort_by_cached_key(|part| first_flight(&part.model));
    let merged = sum(&order)?;
    let remainder = remainder_of(&parts);
    let finish = match flights_of(parts) {
        Some(flights) => {
            learn_again(merged, flights, remainder).map(|model| (model, Merging::LearntAgain))
        }
        None => settle(merged).map(|model| (model, Merging::Added)),
    };
    finish.map_err(|error| (0, error))
}

/// Models with what they have learnt added up, one after the other.
fn sum(parts: &[&Part]) -> Result<ModelFile, (usize, MergeError)> {
    let Some((first, others)) = parts.split_first() else {
        return Err((0, MergeError::NothingLearnt));
    };
    if first.model.learnt.is_none() {
        return Err((0, MergeError::NothingLearnt));
    }
    let mut merged = first.model.clone();
    for (place, other) in others.iter().enumerate() {
        add(&mut merged, &other.model).map_err(|error| (place + 1, error))?;
    }
    Ok(merged)
}

/// START, tail and number of the first flight in a model's ledger.
fn first_flight(model: &ModelFile) -> Option<(Option<Timestamp>, String, String)> {
    let entries = model.learnt.iter().flat_map(|learnt| &learnt.ledger);
    let key = |entry: &LedgerEntry| {
        (entry.start.parse::<Timestamp>().ok(), entry.tail.clone(), entry.flight.clone())
    };
    entries.map(key).min()
}

/// All flights with their segments; `None` where those of one are not at hand, or not all of them.
fn flights_of(parts: Vec<Part>) -> Option<Vec<Material>> {
    let mut all = Vec::new();
    for part in parts {
        let (flights, segments) = part.flights?;
        all.extend(materials(flights, segments));
    }
    all.iter().all(Material::is_whole).then_some(all)
}

/// A sum brought up to date, its flights in the order of flying.
fn settle(mut merged: ModelFile) -> Result<ModelFile, MergeError> {
    if let Some(learnt) = &mut merged.learnt {
        // As text an instant with parts of a second is before the one without them.
        learnt.ledger.sort_by_cached_key(|entry| {
            (entry.start.parse::<Timestamp>().ok(), entry.start.clone(), entry.flight.clone())
        });
        learning::settle(learnt)?;
    }
    Ok(merged)
}

/// Flights within the table from which on a table alone is a table on purpose: fewer taught a table alone until the whole model was
/// learnt from the first flight on.
const ON_PURPOSE: usize = 3;

/// Whether more than the table is learnt: not where a part with flights enough knows its table alone, on purpose.
fn remainder_of(parts: &[Part]) -> RemainderChoice {
    let is_table_alone = |part: &Part| {
        part.model.learnt.as_ref().is_some_and(|learnt| {
            let within = learnt.ledger.iter().filter(|entry| entry.segments > entry.outside_table);
            learnt.baseline.is_none() && within.count() >= ON_PURPOSE
        })
    };
    let alone = parts.iter().any(is_table_alone);
    if alone { RemainderChoice::Leave } else { RemainderChoice::Learn }
}

/// Flights learnt in the order of flying by a model that has learnt nothing.
fn learn_again(
    merged: ModelFile,
    mut flights: Vec<Material>,
    remainder: RemainderChoice,
) -> Result<ModelFile, MergeError> {
    flights.sort_by(Material::order);
    let learnt = learning::begin_again(&merged)?;
    let rebuilt = rebuild(ModelFile { learnt, ..merged }, flights)?;
    Ok(settled(rebuilt, remainder, &mut Vec::new()).model)
}

/// Adds what another model has learnt. The remainder is left out: it is learnt from segments, which a model does not keep.
/// [`crate::learning::settle`] brings the table up to date.
///
/// # Errors
/// [`MergeError`]; the model then is as it was.
fn add(merged: &mut ModelFile, other: &ModelFile) -> Result<(), MergeError> {
    if let Some((what, difference)) = merged.difference_of_initial(other) {
        return Err(MergeError::Initial { what, difference });
    }
    if let Some(difference) = merged.difference_of_law(other) {
        return Err(MergeError::Law { difference });
    }
    let (Some(learnt), Some(more)) = (&mut merged.learnt, &other.learnt) else {
        return Err(MergeError::NothingLearnt);
    };
    let key = |entry: &LedgerEntry| (entry.tail.clone(), entry.start.clone(), entry.flight.clone());
    let known: BTreeSet<_> = learnt.ledger.iter().map(key).collect();
    if let Some(twice) = more.ledger.iter().find(|entry| known.contains(&key(entry))) {
        return Err(MergeError::FlightTwice {
            tail: twice.tail.clone(),
            flight: twice.flight.clone(),
            start: twice.start.clone(),
        });
    }
    add_learnt(learnt, more)
}

fn add_learnt(learnt: &mut Learnt, more: &Learnt) -> Result<(), MergeError> {
    let (LawState::Bayes { state, .. }, LawState::Bayes { state: other, .. }) =
        (&mut learnt.law, &more.law)
    else {
        return Err(MergeError::LawPaper);
    };
    state.merge(other)?;
    let tails: BTreeSet<&str> = learnt.tail.split('+').chain(more.tail.split('+')).collect();
    if learnt.tail != more.tail {
        learnt.tail = tails.into_iter().collect::<Vec<_>>().join("+");
    }
    learnt.references.merge(&more.references);
    learnt.baseline = None;
    learnt.ledger.extend(more.ledger.iter().cloned());
    Ok(())
}
