//! One tail's flights learnt, on top of what the tail has learnt already: which of its reports are new ([`Sorting`]), what
//! it begins with ([`Start`]), and its model after them ([`learn`]).

mod begun;
mod dates;
mod new_flights;
mod sorting;

use std::borrow::Cow;
use std::cmp::Ordering;

use effects::ExtendedModel;
use flight::Segment;

use crate::evaluation::{TailCounts, TailData, TailResult};
use crate::known_flights::entry_of;
use crate::learning::{self, FlightToLearn, LawChoice, LearningCurve, LearningError, LnFuelFlows};
use crate::learnt_flights::KnownFlight;
use crate::model_file::{Learnt, LedgerEntry, ModelFile};
use crate::reading::{FlightRead, RefusedReport};

pub use begun::{LawAsked, Start, Starts, choice_of};
pub use dates::{Dates, refuse_impossible};
use new_flights::NewFlights;
pub use sorting::{Contradictions, OlderFlights, Sorting};

/// A tail that has learnt flights.
#[derive(Clone, Debug)]
pub struct StoredTail {
    /// Its model.
    pub model: ModelFile,
    /// Segments of the flights in its ledger, in the order in which they were learnt.
    pub segments: Vec<Segment>,
    /// The flights in its ledger.
    pub flights: Vec<KnownFlight>,
    /// How far off it was on each of them before it learnt it; `None` where a program stored the tail that did not keep this.
    pub curve: Option<LearningCurve>,
    /// What its model predicts for each segment, where that was computed when it was learnt.
    pub predicted: Option<LnFuelFlows>,
}

impl StoredTail {
    /// Whether the segments of every flight are at hand.
    fn has_all_segments(&self) -> bool {
        let learnt: u64 = self.flights.iter().map(|known| known.entry.segments).sum();
        learnt == self.segments.len() as u64
    }
}

/// A flight with its segments: what a model is rebuilt from.
#[derive(Clone, Debug)]
pub struct Material {
    /// The flight.
    pub known: KnownFlight,
    /// Its segments.
    pub segments: Vec<Segment>,
}

impl Material {
    /// Whether all segments that the flight had when it was learnt are at hand.
    pub(crate) fn is_whole(&self) -> bool {
        self.segments.len() as u64 == self.known.entry.segments
    }

    /// The order of flying.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        let entries = (&self.known.entry, &other.known.entry);
        let tails = entries.0.tail.cmp(&entries.1.tail);
        self.known
            .start
            .cmp(&other.known.start)
            .then(tails)
            .then(entries.0.flight.cmp(&entries.1.flight))
    }
}

/// Whether a model learns what no table can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RemainderChoice {
    /// Smooth remainder, N2 deck and noise levels are learnt from all segments (law `bayes`).
    Learn,
    /// The table alone is learnt.
    Leave,
}

/// What a tail's new flights came to.
#[derive(Debug)]
pub struct Learning {
    /// The tail with them; `None` where none was learnt.
    pub learnt: Option<StoredTail>,
    /// How many were learnt.
    pub flights_new: usize,
    /// What is worth knowing about them, each once.
    pub notes: Vec<String>,
    /// What could not be learnt.
    pub refused: Vec<RefusedReport>,
}

/// Learns the new flights of a tail, on top of what is stored of it.
///
/// # Errors
/// An initial table that the law cannot correct.
pub fn learn(
    start: &Start<'_>,
    tail: &str,
    sorting: Sorting,
    stored: Option<StoredTail>,
    remainder: RemainderChoice,
) -> Result<Learning, LearningError> {
    let learns_again = |stored: &StoredTail| {
        let new = sorting.new.iter().map(|(flight, _)| flight);
        (sorting.late || dates::change_with(&stored.model, new)) && stored.has_all_segments()
    };
    let late = learns_in_any_order(start) && stored.as_ref().is_some_and(learns_again);
    let mut work = Work { notes: sorting.warnings, refused: sorting.refused, flights_new: 0 };
    let learnt = if sorting.new.is_empty() {
        None
    } else if sorting.replaced.is_empty() && !late {
        let new = sorting.new.into_iter().map(|(flight, _)| flight).collect();
        work.continued(start, tail, stored, new)?
    } else {
        work.relearnt(start, tail, stored, sorting.new, &sorting.replaced)?
    };
    let Work { mut notes, refused, flights_new } = work;
    let learnt =
        learnt.filter(|_| flights_new > 0).map(|learnt| settled(learnt, remainder, &mut notes));
    Ok(Learning { learnt, flights_new, notes, refused })
}

/// Whether what a tail learns does not depend on when its flights arrive: then those that arrive late are learnt in their place.
const fn learns_in_any_order(start: &Start<'_>) -> bool {
    matches!(start.law(), LawChoice::Bayes(_))
}

/// The figures of a tail.
pub fn result_of(stored: StoredTail, flights_new: usize, notes: Vec<String>) -> TailResult {
    let StoredTail { model, segments, flights, curve, predicted } = stored;
    // Not the tail whose diagnosis was applied: what a tail has learnt is its own.
    let tail = model.learnt.as_ref().map(|learnt| learnt.tail.clone()).unwrap_or_default();
    let counts = TailCounts {
        flights: flights.len(),
        flights_new,
        samples: flights.iter().map(|flight| flight.entry.samples).sum(),
    };
    let data = TailData { tail, model, segments, counts, notes, curve };
    TailResult::adapted_as_predicted(data, predicted.as_deref())
}

/// Brings the model up to date with what it has learnt.
pub fn settled(
    mut stored: StoredTail,
    remainder: RemainderChoice,
    notes: &mut Vec<String>,
) -> StoredTail {
    let model = &mut stored.model;
    let Some(learnt) = &mut model.learnt else { return stored };
    if let Err(error) = learning::settle(learnt) {
        // Cannot happen to a state that was read whole.
        tracing::error!(tail = learnt.tail, "{error}");
    }
    if remainder == RemainderChoice::Learn {
        // `ModelFile::reference`, of which a part is borrowed already.
        let reference = model.by_guide.as_deref().unwrap_or(&model.initial);
        stored.predicted =
            learning::remember_remainder((reference, Some(&model.guide)), learnt, &stored.segments);
    } else if learnt.baseline.take().is_some() {
        notes.push(
            "the remainder of an earlier run is dropped: it belonged to the table before these flights"
                .to_owned(),
        );
    }
    stored
}

/// Learns flights anew, one after the other, into a model that has learnt nothing.
///
/// # Errors
/// A flight that cannot be learnt.
pub fn rebuild(mut model: ModelFile, flights: Vec<Material>) -> Result<StoredTail, LearningError> {
    let mut segments = Vec::new();
    let mut known = Vec::new();
    let starts = flights.iter().map(|flight| flight.known.start).collect();
    let dated = Dates::of_starts(&model, starts);
    let mut new = NewFlights::after(&model);
    for flight in flights {
        let Some(learnt) = &mut model.learnt else { break };
        let as_dated = match flight.segments.first() {
            Some(first) => dated.segments_as_dated(&first.identity, &flight.segments),
            None => Cow::Borrowed(&flight.segments[..]),
        };
        known.push(learn_one(&model.initial, learnt, flight.known, &as_dated)?);
        new.learnt(as_dated, &flight.segments);
        segments.extend(flight.segments);
    }
    let curve = new.curve(&model, LearningCurve::new(), &segments);
    Ok(StoredTail { model, segments, flights: known, curve, predicted: None })
}

/// A tail's learning in this run.
#[derive(Debug)]
struct Work {
    notes: Vec<String>,
    refused: Vec<RefusedReport>,
    flights_new: usize,
}

impl Work {
    /// New flights after those that the tail has learnt.
    fn continued(
        &mut self,
        start: &Start<'_>,
        tail: &str,
        stored: Option<StoredTail>,
        new: Vec<FlightRead>,
    ) -> Result<Option<StoredTail>, LearningError> {
        let mut stored = if let Some(stored) = stored {
            stored
        } else {
            let model = start.fresh(tail)?;
            let curve = Some(LearningCurve::new());
            let (segments, flights) = (Vec::new(), Vec::new());
            StoredTail { model, segments, flights, curve, predicted: None }
        };
        stored.predicted = None;
        let mut learning = NewFlights::after(&stored.model);
        self.notes.extend(stored.model.note_of_effects());
        let dated = Dates::of_learnt_and_new(&stored.model, &new);
        for flight in new {
            let Some(learnt) = &mut stored.model.learnt else { break };
            let known = known_of(&flight);
            let as_dated = dated.as_dated(&flight);
            match learn_one(&stored.model.initial, learnt, known, &as_dated) {
                Ok(known) => {
                    self.flights_new += 1;
                    flight.add_notes(&mut self.notes);
                    stored.flights.push(known);
                    learning.learnt(as_dated, &flight.reduced.segments);
                    stored.segments.extend(flight.reduced.segments);
                }
                Err(error) => self.refused.push(RefusedReport::whole(flight.path, error)),
            }
        }
        // Where nothing was kept of earlier flights, the whole curve is made again when it is asked for.
        if let Some(before) = stored.curve.take() {
            stored.curve = learning.curve(&stored.model, before, &stored.segments);
        }
        Ok(Some(stored))
    }

    /// The tail from its first flight on, with other versions of some, or with flights that arrive late.
    fn relearnt(
        &mut self,
        start: &Start<'_>,
        tail: &str,
        stored: Option<StoredTail>,
        new: Vec<(FlightRead, Option<usize>)>,
        replaced: &[usize],
    ) -> Result<Option<StoredTail>, LearningError> {
        let Some(stored) = stored else { return Ok(None) };
        // In the place of each flight, or of those that replace it.
        let mut slots: Vec<Vec<Material>> =
            materials(stored.flights, stored.segments).into_iter().map(|one| vec![one]).collect();
        for index in replaced {
            slots[*index].clear();
        }
        let mut paths = Vec::new();
        let mut last = Vec::new();
        for (flight, replaces) in new {
            flight.add_notes(&mut self.notes);
            let material = Material { known: known_of(&flight), segments: flight.reduced.segments };
            paths.push(flight.path);
            match replaces {
                Some(index) => slots[index].push(material),
                None => last.push(material),
            }
        }
        let mut flights: Vec<Material> = slots.into_iter().flatten().chain(last).collect();
        if learns_in_any_order(start) {
            flights.sort_by(Material::order);
        }
        match rebuild(start.fresh(tail)?, flights) {
            Ok(rebuilt) => {
                self.notes.extend(rebuilt.model.note_of_effects());
                self.flights_new = paths.len();
                Ok(Some(rebuilt))
            }
            Err(error) => {
                let refuse = |path| {
                    RefusedReport::whole(path, format!("the tail cannot be learnt anew: {error}"))
                };
                self.refused.extend(paths.into_iter().map(refuse));
                Ok(None)
            }
        }
    }
}

/// Flights with their segments, in the order in which they were learnt.
pub fn materials(flights: Vec<KnownFlight>, segments: Vec<Segment>) -> Vec<Material> {
    let mut segments = segments.into_iter().peekable();
    flights
        .into_iter()
        .map(|known| {
            let mut own = Vec::new();
            while let Some(segment) = segments.next_if(|segment| {
                segment.identity.start == known.start
                    && segment.identity.flight == known.entry.flight
            }) {
                own.push(segment);
            }
            Material { known, segments: own }
        })
        .collect()
}

fn known_of(flight: &FlightRead) -> KnownFlight {
    KnownFlight { entry: entry_of(flight), start: flight.reduced.identity.start, end: flight.end }
}

/// Learns one flight; returns it with what learning counted.
fn learn_one(
    initial: &ExtendedModel,
    learnt: &mut Learnt,
    known: KnownFlight,
    segments: &[Segment],
) -> Result<KnownFlight, LearningError> {
    let entry = LedgerEntry { segments: 0, outside_table: 0, ..known.entry.clone() };
    let result = learning::learn_flight(initial, learnt, &FlightToLearn { entry, segments })?;
    let entry = learnt.ledger.last().cloned().unwrap_or(known.entry);
    tracing::debug!(
        tail = entry.tail,
        flight = entry.flight,
        segments = segments.len(),
        adapted = result.adapted,
        outside = result.outside_table,
        refitted = result.refitted,
        "learnt"
    );
    Ok(KnownFlight { entry, ..known })
}
