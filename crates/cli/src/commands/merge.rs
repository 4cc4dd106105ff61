//! `cruisefit merge`: what models of one initial model have learnt, added up.

use std::collections::BTreeSet;

use crate::args::MergeArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::models::{read_model, write_model};
use pipeline::learning;
use pipeline::model_file::{LawState, Learnt, LedgerEntry, ModelFile};

/// Runs the command.
///
/// # Errors
/// Models that do not add up: another initial model, law, setting, trim criterion, or a flight that two have learnt.
pub(crate) fn run(arguments: &MergeArgs) -> Result<Outcome, Failure> {
    let mut models = Vec::with_capacity(arguments.models.len());
    for path in &arguments.models {
        models.push((path, read_model(path)?));
    }
    let Some(((_, first), others)) = models.split_first() else {
        return Err(Failure::BadArgument {
            argument: "MODEL.ron",
            reason: "none given".to_owned(),
        });
    };
    let mut merged = first.clone();
    for (path, other) in others {
        add(&mut merged, other).map_err(|reason| Failure::bad_file(path, reason))?;
    }
    let Some(learnt) = &mut merged.learnt else {
        return Err(Failure::bad_file(&arguments.models[0], "has learnt nothing"));
    };
    learnt
        .ledger
        .sort_by(|one, other| (&one.start, &one.flight).cmp(&(&other.start, &other.flight)));
    learning::settle(learnt).map_err(|error| Failure::bad_file(&arguments.models[0], error))?;
    let flights = learnt.ledger.len();
    write_model(&merged, &arguments.output)?;
    Ok(Outcome::text(format!(
        "{flights} flights of {} models merged, written to {}\n",
        arguments.models.len(),
        show(&arguments.output)
    )))
}

fn add(merged: &mut ModelFile, other: &ModelFile) -> Result<(), String> {
    if let Some((what, difference)) = merged.difference_of_initial(other) {
        return Err(format!("another {what} than the first model: {difference}"));
    }
    if let Some(difference) = merged.difference_of_law(other) {
        return Err(format!("another law or setting than the first model: {difference}"));
    }
    let (Some(learnt), Some(more)) = (&mut merged.learnt, &other.learnt) else {
        return Err("a model that has learnt nothing".to_owned());
    };
    let key = |entry: &LedgerEntry| (entry.tail.clone(), entry.start.clone(), entry.flight.clone());
    let known: BTreeSet<_> = learnt.ledger.iter().map(key).collect();
    if let Some(twice) = more.ledger.iter().find(|entry| known.contains(&key(entry))) {
        return Err(format!(
            "tail {} flight {} of {} is in the ledger of an earlier model too: it would count twice",
            twice.tail, twice.flight, twice.start
        ));
    }
    add_learnt(learnt, more)
}

fn add_learnt(learnt: &mut Learnt, more: &Learnt) -> Result<(), String> {
    let (LawState::Bayes { state, .. }, LawState::Bayes { state: other, .. }) =
        (&mut learnt.law, &more.law)
    else {
        return Err("law paper cannot be merged: what it learns depends on the order".to_owned());
    };
    state.merge(other).map_err(|error| error.to_string())?;
    if learnt.tail != more.tail {
        learnt.tail = format!("{}+{}", learnt.tail, more.tail);
    }
    learnt.references.merge(&more.references);
    // It is learnt from segments, which a model does not keep.
    learnt.baseline = None;
    learnt.ledger.extend(more.ledger.iter().cloned());
    Ok(())
}
