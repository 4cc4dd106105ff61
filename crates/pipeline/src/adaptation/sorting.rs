//! Which of a tail's reports are learnt: those that are neither known nor contradict what is known.

use std::collections::BTreeSet;

use flight::Timestamp;

use crate::known_flights::{KnownFlights, Relation};
use crate::learnt_flights::KnownFlight;
use crate::reading::{FlightRead, RefusedReport};

/// What may be done with a report that contradicts a known flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contradictions {
    /// Refuse it.
    Refuse,
    /// Learn it in place of the known one.
    Relearn,
}

/// What happens to a flight older than the newest one learnt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OlderFlights {
    /// It is learnt, with a warning: by law `bayes` in its place, all flights again; by law `paper` after newer ones.
    Learn,
    /// It is refused.
    Refuse,
}

/// A tail's reports, one after the other.
#[derive(Debug)]
pub struct Sorting {
    tail: String,
    known: KnownFlights,
    /// How many of the known flights are stored.
    stored: usize,
    newest: Option<Timestamp>,
    /// What happens to a report that contradicts a stored flight.
    pub contradictions: Contradictions,
    /// What happens to a flight older than the newest stored one.
    pub older: OlderFlights,
    /// Flights to learn; with the number of the stored flight that each replaces, of several the first.
    pub new: Vec<(FlightRead, Option<usize>)>,
    /// Numbers of stored flights that are replaced.
    pub replaced: Vec<usize>,
    /// START and name of stored flights whose reports are at hand as they were learnt.
    at_hand: BTreeSet<(Timestamp, String)>,
    /// What is not learnt.
    pub refused: Vec<RefusedReport>,
    /// Flights that were known before.
    pub already_known: usize,
    /// Copies among the reports themselves.
    pub copies: usize,
    /// The first copy, and what it is a copy of.
    pub first_copy: Option<(String, String)>,
    /// What is worth knowing about the order of flights.
    pub warnings: Vec<String>,
    /// Whether a flight to learn is older than the newest stored one.
    pub(super) late: bool,
}

impl Sorting {
    /// Nothing but what is stored is known.
    pub fn new(tail: &str, known: KnownFlights) -> Self {
        Self {
            tail: tail.to_owned(),
            stored: known.flights().len(),
            newest: known.flights().iter().map(|flight| flight.start).max(),
            known,
            contradictions: Contradictions::Refuse,
            older: OlderFlights::Learn,
            new: Vec::new(),
            replaced: Vec::new(),
            at_hand: BTreeSet::new(),
            refused: Vec::new(),
            already_known: 0,
            copies: 0,
            first_copy: None,
            warnings: Vec::new(),
            late: false,
        }
    }

    /// Says of a stored flight that its report is at hand as it was learnt: no other version of it is right as well.
    pub fn is_at_hand(&mut self, start: Timestamp, flight: &str) {
        self.at_hand.insert((start, flight.to_owned()));
    }

    /// Sorts the next report, in the order of flying.
    pub fn sort(&mut self, flight: FlightRead) {
        let relations = self.known.relations(&flight);
        match relations[..] {
            [] => match self.in_hours_of_replaced(&flight) {
                Some(index) => self.accept(flight, Some(index)),
                None if self.is_accepted_by_age(&flight) => self.accept(flight, None),
                None => {}
            },
            [Relation::Same(index), ..] if index < self.stored => self.already_known += 1,
            [Relation::Same(index), ..] => self.copy(&flight, index),
            _ => match self.objection(&relations, &flight) {
                Some(reason) => self.refused.push(RefusedReport::whole(flight.path, reason)),
                None => self.accept_in_place_of(flight, &relations),
            },
        }
    }

    /// The replaced flight in whose hours another one lies, which takes its place as well.
    fn in_hours_of_replaced(&self, flight: &FlightRead) -> Option<usize> {
        let start = flight.reduced.identity.start;
        let known = self.known.flights();
        self.replaced.iter().copied().find(|index| known[*index].overlaps(start, flight.end))
    }

    /// Why a flight that contradicts known ones does not take their place; `None` where it does.
    fn objection(&self, relations: &[Relation], flight: &FlightRead) -> Option<String> {
        let known = self.known.flights();
        let of = |relation: &Relation| relation.known().map(|index| &known[index]);
        let told = |relation: Relation| self.known.objection(relation, flight).unwrap_or_default();
        let is_stored =
            |relation: &&Relation| relation.known().is_some_and(|index| index < self.stored);
        if let Some(relation) = relations.iter().find(|relation| !is_stored(relation)) {
            let other = of(relation).and_then(|known| self.path_of(known));
            return Some(match other {
                Some(other) => format!("{} (the other report is {other})", told(*relation)),
                None => told(*relation),
            });
        }
        let is_at_hand = |relation: &&Relation| {
            of(relation)
                .is_some_and(|one| self.at_hand.contains(&(one.start, one.entry.flight.clone())))
        };
        if let Some(at_hand) = relations.iter().find(is_at_hand) {
            return Some(
                told(*at_hand)
                    + ", whose report is among these as it was learnt: leave one of the two out",
            );
        }
        let first = *relations.first()?;
        if let (Relation::OtherContent(_), Some(known)) = (first, of(&first)) {
            let samples = flight.reduced.samples as u64;
            if samples < known.entry.samples && flight.end < known.end {
                return Some(format!(
                    "{}, of which it is a shorter version: {samples} samples where {} were learnt (`cruisefit forget` makes room for it)",
                    told(first),
                    known.entry.samples
                ));
            }
        }
        (self.contradictions == Contradictions::Refuse)
            .then(|| told(first) + " (--relearn learns this one in its place)")
    }

    /// The report of a flight that this run has read.
    fn path_of(&self, known: &KnownFlight) -> Option<String> {
        let is_it = |one: &FlightRead| {
            one.reduced.identity.start == known.start
                && one.reduced.identity.flight == known.entry.flight
        };
        let found = self.new.iter().find(|(one, _)| is_it(one));
        found.map(|(one, _)| one.path.display().to_string())
    }

    fn accept_in_place_of(&mut self, flight: FlightRead, relations: &[Relation]) {
        let replaced: Vec<usize> = relations.iter().filter_map(|one| one.known()).collect();
        for index in &replaced {
            self.known.replace(*index);
        }
        self.replaced.extend(&replaced);
        self.accept(flight, replaced.first().copied());
    }

    fn accept(&mut self, flight: FlightRead, replaces: Option<usize>) {
        self.known.add(&flight);
        self.new.push((flight, replaces));
    }

    fn copy(&mut self, flight: &FlightRead, index: usize) {
        self.copies += 1;
        if self.first_copy.is_none()
            && let Some(original) = self.path_of(&self.known.flights()[index])
        {
            self.first_copy = Some((flight.path.display().to_string(), original));
        }
    }

    /// Whether a flight older than the newest stored one is learnt: with a warning, or not at all.
    fn is_accepted_by_age(&mut self, flight: &FlightRead) -> bool {
        let identity = &flight.reduced.identity;
        if self.newest.is_none_or(|newest| identity.start >= newest) {
            return true;
        }
        let finding = format!(
            "flight {} of {} is older than the newest one that tail {} has learnt",
            identity.flight, identity.start, self.tail
        );
        if self.older == OlderFlights::Refuse {
            self.refused.push(RefusedReport::whole(flight.path.clone(), finding));
            return false;
        }
        tracing::warn!("{finding}");
        self.warnings.push(finding);
        self.late = true;
        true
    }
}
