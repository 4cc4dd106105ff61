//! Dates that cannot be right: refused, or learnt without ageing what is known.

use std::borrow::Cow;
use std::sync::Arc;

use crate::dates;
use crate::model_file::{LawState, ModelFile};
use flight::{FlightIdentity, Segment, Timestamp};

use crate::reading::{FlightRead, Reading, RefusedReport};

/// Moves flights that cannot have been flown when they say to the refused ones.
pub fn refuse_impossible(reading: &mut Reading, now: Timestamp) {
    // Fractions of a second are nothing to print.
    let now = Timestamp::from_second(now.as_second()).unwrap_or(now);
    for flight in std::mem::take(&mut reading.flights) {
        let (identity, segments) = (&flight.reduced.identity, &flight.reduced.segments);
        match dates::possible(identity, segments, flight.end, now) {
            Ok(()) => reading.flights.push(flight),
            Err(reason) => reading.refused.push(RefusedReport::whole(flight.path, reason)),
        }
    }
}

/// The dates of a tail's flights, where dates matter: in a model whose knowledge ages.
#[derive(Clone, Debug)]
pub struct Dates {
    /// Starts of the flights that were learnt and of those to be learnt; empty where knowledge does not age.
    starts: Vec<Timestamp>,
}

impl Dates {
    /// The dates of the flights that a model has learnt, and of new ones.
    pub fn of_learnt_and_new(model: &ModelFile, new: &[FlightRead]) -> Self {
        let Some(learnt) = model.learnt.as_ref().filter(|_| ages(model)) else {
            return Self { starts: Vec::new() };
        };
        let known = learnt.ledger.iter().filter_map(|entry| entry.start.parse().ok());
        let starts = known.chain(new.iter().map(|flight| flight.reduced.identity.start)).collect();
        Self { starts }
    }

    /// The dates of flights that a model is to learn anew.
    pub fn of_starts(model: &ModelFile, starts: Vec<Timestamp>) -> Self {
        Self { starts: if ages(model) { starts } else { Vec::new() } }
    }

    /// A flight's segments, on the date that the flight is taken to have been flown on.
    pub fn as_dated<'f>(&self, flight: &'f FlightRead) -> Cow<'f, [Segment]> {
        self.segments_as_dated(&flight.reduced.identity, &flight.reduced.segments)
    }

    /// The same of the segments of a flight.
    pub fn segments_as_dated<'f>(
        &self,
        identity: &FlightIdentity,
        segments: &'f [Segment],
    ) -> Cow<'f, [Segment]> {
        let FlightIdentity { tail, start, flight: name } = identity;
        let mut others = self.starts.clone();
        if let Some(own) = others.iter().position(|date| date == start) {
            others.swap_remove(own);
        }
        let Some(instead) = dates::instead_of(*start, &others) else {
            return Cow::Borrowed(segments);
        };
        tracing::warn!(
            "flight {name} of {start}: no other flight of tail {tail} within {} days; its date is taken for an error, and it is learnt as if flown on {instead}, without ageing what is known",
            dates::DAYS_THAT_CONFIRM
        );
        let identity = Arc::new(FlightIdentity { start: instead, ..identity.clone() });
        let moved =
            |segment: &Segment| Segment { identity: Arc::clone(&identity), ..segment.clone() };
        Cow::Owned(segments.iter().map(moved).collect())
    }
}

/// Whether new flights change what a model takes the dates of those that it has learnt for: they confirm one that stood alone, or
/// leave one alone.
pub(super) fn change_with<'f>(
    model: &ModelFile,
    new: impl Iterator<Item = &'f FlightRead>,
) -> bool {
    let Some(learnt) = model.learnt.as_ref().filter(|_| ages(model)) else { return false };
    let known: Vec<Timestamp> =
        learnt.ledger.iter().filter_map(|entry| entry.start.parse().ok()).collect();
    let new: Vec<Timestamp> = new.map(|flight| flight.reduced.identity.start).collect();
    known.iter().enumerate().any(|(own, start)| {
        let before = [&known[..own], &known[own + 1..]].concat();
        let after = [&before[..], &new[..]].concat();
        dates::instead_of(*start, &before) != dates::instead_of(*start, &after)
    })
}

/// Whether what a model knows ages.
fn ages(model: &ModelFile) -> bool {
    let by_bayes = model.learnt.as_ref().is_some_and(|l| matches!(l.law, LawState::Bayes { .. }));
    by_bayes && model.settings.bayes.values().half_life_days.is_some()
}
