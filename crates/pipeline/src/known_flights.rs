//! What a flight is to flights that are known: new, the same, another version of one, or the same hours again.

use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hasher};
use std::time::Duration;

use crate::model_file::LedgerEntry;
use flight::{Segment, Timestamp};

use crate::learnt_flights::KnownFlight;
use crate::reading::FlightRead;

/// The flights of one tail, in the order in which they became known.
#[derive(Clone, Debug, Default)]
pub struct KnownFlights {
    flights: Vec<KnownFlight>,
    /// Which of them are known no more: another version has taken their place.
    replaced: BTreeSet<usize>,
    by_identity: BTreeMap<(Timestamp, String), usize>,
    by_segments: BTreeMap<u64, usize>,
    longest: Duration,
}

/// What a flight is to those that are known. The number is that of the known flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// None of them.
    New,
    /// The same flight with the same content.
    Same(usize),
    /// The same flight with other content.
    OtherContent(usize),
    /// Another flight in the same hours.
    SameHours(usize),
    /// The same samples at another time.
    SameSamples(usize),
}

impl Relation {
    /// The number of the known flight.
    pub const fn known(self) -> Option<usize> {
        match self {
            Self::New => None,
            Self::Same(index)
            | Self::OtherContent(index)
            | Self::SameHours(index)
            | Self::SameSamples(index) => Some(index),
        }
    }
}

impl KnownFlights {
    /// Known are these flights.
    pub fn new(flights: Vec<KnownFlight>) -> Self {
        let mut known = Self::default();
        for flight in flights {
            known.push(flight);
        }
        known
    }

    /// The segments of the known flights, by which the same samples are found at another time.
    pub fn add_segments(&mut self, segments: &[Segment]) {
        for of_flight in segments.chunk_by(|one, other| one.identity == other.identity) {
            let identity = &of_flight[0].identity;
            let key = (identity.start, identity.flight.clone());
            if let (Some(index), Some(mark)) = (self.by_identity.get(&key), samples_mark(of_flight))
            {
                self.by_segments.insert(mark, *index);
            }
        }
    }

    /// One more.
    pub fn add(&mut self, flight: &FlightRead) {
        let index = self.flights.len();
        if let Some(mark) = samples_mark(&flight.reduced.segments) {
            let first = self.by_segments.entry(mark).or_insert(index);
            if self.replaced.contains(first) {
                *first = index;
            }
        }
        self.push(KnownFlight {
            entry: entry_of(flight),
            start: flight.reduced.identity.start,
            end: flight.end,
        });
    }

    fn push(&mut self, flight: KnownFlight) {
        self.longest = self.longest.max(length(flight.start, flight.end));
        self.by_identity.insert((flight.start, flight.entry.flight.clone()), self.flights.len());
        self.flights.push(flight);
    }

    /// From now on a flight is known no more: another version takes its place. Its number stays.
    pub fn replace(&mut self, index: usize) {
        self.replaced.insert(index);
    }

    /// The flights, those that were replaced among them.
    pub fn flights(&self) -> &[KnownFlight] {
        &self.flights
    }

    /// The flight of this name and START.
    pub fn find(&self, start: Timestamp, flight: &str) -> Option<&KnownFlight> {
        self.by_identity.get(&(start, flight.to_owned())).map(|index| &self.flights[*index])
    }

    /// What a flight is to them: of several the first of this order.
    pub fn relation(&self, flight: &FlightRead) -> Relation {
        self.relations(flight).into_iter().next().unwrap_or(Relation::New)
    }

    /// What a flight is to all of them to which it is something: one that is known has no further ones.
    pub fn relations(&self, flight: &FlightRead) -> Vec<Relation> {
        let identity = &flight.reduced.identity;
        let start = identity.start;
        let known = |index: &&usize| !self.replaced.contains(index);
        let mut found = Vec::new();
        let own = self.by_identity.get(&(start, identity.flight.clone())).filter(known);
        if let Some(&index) = own {
            if flight.has_content(&self.flights[index].entry.content) {
                return vec![Relation::Same(index)];
            }
            found.push(Relation::OtherContent(index));
        }
        // Whoever overlaps it began before its end, and not longer before it than the longest flight lasts.
        let earliest = start.checked_sub(self.longest).unwrap_or(Timestamp::MIN);
        let from = (earliest, String::new());
        let begun_before_its_end = self
            .by_identity
            .range(from..)
            .take_while(|((begun, _), _)| *begun < flight.end)
            .map(|(_, index)| index);
        found.extend(
            begun_before_its_end
                .filter(known)
                .filter(|index| {
                    own != Some(index) && self.flights[**index].overlaps(start, flight.end)
                })
                .map(|&index| Relation::SameHours(index)),
        );
        let same_samples = samples_mark(&flight.reduced.segments)
            .and_then(|mark| self.by_segments.get(&mark))
            .filter(known)
            .filter(|index| found.iter().all(|relation| relation.known() != Some(**index)));
        found.extend(same_samples.map(|&index| Relation::SameSamples(index)));
        found
    }

    /// Why a flight of this relation is not used; `None` where it is new, or a copy that nobody needs to hear of.
    pub fn objection(&self, relation: Relation, flight: &FlightRead) -> Option<String> {
        let identity = &flight.reduced.identity;
        let told = |index: usize| {
            let known = &self.flights[index];
            format!("flight {} of {}", known.entry.flight, known.entry.start)
        };
        let this =
            format!("tail {} flight {} of {}", identity.tail, identity.flight, identity.start);
        match relation {
            Relation::New | Relation::Same(_) => None,
            Relation::OtherContent(_) => {
                Some(format!("{this} is already known with different content"))
            }
            Relation::SameHours(index) => Some(format!(
                "{this} overlaps {}, which lasts until {}: one aircraft does not fly twice at a time",
                told(index),
                self.flights[index].end
            )),
            Relation::SameSamples(index) => {
                Some(format!("{this} has the same samples as {}", told(index)))
            }
        }
    }
}

/// A flight's entry in a ledger, but for what learning counts.
pub fn entry_of(flight: &FlightRead) -> LedgerEntry {
    LedgerEntry {
        tail: flight.reduced.identity.tail.clone(),
        flight: flight.reduced.identity.flight.clone(),
        start: flight.reduced.identity.start.to_string(),
        content: flight.content.clone(),
        samples: flight.reduced.samples as u64,
        segments: 0,
        outside_table: 0,
        gauges: flight.reduced.gauges,
    }
}

fn length(start: Timestamp, end: Timestamp) -> Duration {
    end.duration_since(start).try_into().unwrap_or(Duration::ZERO)
}

/// What the same samples have in common whatever tail, name and START they are given: a hash of the bits of the segments'
/// means. Of this program's run only: it is not kept. `None` without a segment.
pub fn samples_mark(segments: &[Segment]) -> Option<u64> {
    if segments.is_empty() {
        return None;
    }
    let mut hasher = DefaultHasher::new();
    for segment in segments {
        let means = &segment.means;
        for value in [
            means.pressure_altitude_m,
            means.static_air_temperature_k,
            means.mach,
            means.mass_kg,
            means.fuel_flow_total_kg_s,
        ] {
            hasher.write_u64(value.to_bits());
        }
    }
    Some(hasher.finish())
}
