//! What models of one initial model have learnt, added up.

use std::collections::BTreeSet;

use adapt::bayes::MergeError as StateMergeError;

use crate::model_file::{LawState, Learnt, LedgerEntry, ModelFile};

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
}

/// Adds what another model has learnt. The remainder is left out: it is learnt from segments, which a model does not keep.
/// [`crate::learning::settle`] brings the table up to date.
///
/// # Errors
/// [`MergeError`]; the model then is as it was.
pub fn add(merged: &mut ModelFile, other: &ModelFile) -> Result<(), MergeError> {
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
    if learnt.tail != more.tail {
        learnt.tail = format!("{}+{}", learnt.tail, more.tail);
    }
    learnt.references.merge(&more.references);
    learnt.baseline = None;
    learnt.ledger.extend(more.ledger.iter().cloned());
    Ok(())
}
