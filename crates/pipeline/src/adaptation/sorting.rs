//! Which of a tail's reports are learnt: those that are neither known nor contradict what is known.

use flight::Timestamp;

use crate::known_flights::{KnownFlights, Relation};
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
    /// Flights to learn; with the number of the stored flight that each replaces first.
    pub new: Vec<(FlightRead, Option<usize>)>,
    /// Numbers of stored flights that are replaced.
    pub replaced: Vec<usize>,
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
            refused: Vec::new(),
            already_known: 0,
            copies: 0,
            first_copy: None,
            warnings: Vec::new(),
            late: false,
        }
    }

    /// Sorts the next report, in the order of flying.
    pub fn sort(&mut self, flight: FlightRead) {
        match self.known.relation(&flight) {
            Relation::New => {
                if self.is_accepted_by_age(&flight) {
                    self.accept(flight, None);
                }
            }
            Relation::Same(index) if index < self.stored && !self.replaced.contains(&index) => {
                self.already_known += 1;
            }
            Relation::Same(index) => self.copy(&flight, index),
            relation @ (Relation::OtherContent(index)
            | Relation::SameHours(index)
            | Relation::SameSamples(index)) => {
                if self.contradictions == Contradictions::Relearn
                    && index < self.stored
                    && !self.replaced.contains(&index)
                {
                    self.replaced.push(index);
                    self.accept(flight, Some(index));
                } else {
                    let mut reason = self.known.objection(relation, &flight).unwrap_or_default();
                    if index < self.stored {
                        reason.push_str(" (--relearn learns this one in its place)");
                    }
                    self.refused.push(RefusedReport::whole(flight.path, reason));
                }
            }
        }
    }

    fn accept(&mut self, flight: FlightRead, replaces: Option<usize>) {
        self.known.add(&flight);
        self.new.push((flight, replaces));
    }

    fn copy(&mut self, flight: &FlightRead, index: usize) {
        self.already_known += 1;
        self.copies += 1;
        let identity = &self.known.flights()[index];
        let original = self.new.iter().find(|(one, _)| {
            one.reduced.identity.start == identity.start
                && one.reduced.identity.flight == identity.entry.flight
        });
        if self.first_copy.is_none()
            && let Some((original, _)) = original
        {
            self.first_copy =
                Some((flight.path.display().to_string(), original.path.display().to_string()));
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
