//! Flights that a second tail has learnt: a registration that was corrected leaves its flight on the old tail.
//!
//! Every night all flights of the folder are passed: they are looked for by START and end, in the small tables of flights, without
//! their SHA-256. Only where both are those of a flight that is new tonight the segments of the other tail are read and compared.

use std::collections::BTreeMap;
use std::path::Path;

use flight::Timestamp;
use pipeline::known_flights::samples_mark;
use pipeline::learnt_flights::KnownFlight;
use pipeline::reading::FlightRead;
use rayon::prelude::*;

use super::tail::TailOutcome;
use crate::failure::show;
use crate::folder::Folder;

/// A flight that a tail learns in this run.
#[derive(Clone, Debug)]
pub(super) struct NewFlight {
    flight: String,
    start: Timestamp,
    end: Timestamp,
    /// What its samples have in common with those of the same flight of another tail.
    samples: u64,
}

impl NewFlight {
    /// `None` for a flight without segments, from which nothing is learnt.
    pub(super) fn of(flight: &FlightRead) -> Option<Self> {
        let identity = &flight.reduced.identity;
        Some(Self {
            flight: identity.flight.clone(),
            start: identity.start,
            end: flight.end,
            samples: samples_mark(&flight.reduced.segments)?,
        })
    }
}

/// The new flights of all tails, by START as tables have it.
type ByStart<'a> = BTreeMap<String, Vec<(&'a str, &'a NewFlight)>>;

/// Warns of new flights that another tail has learnt too, in this run or before.
pub(super) fn warn_of_twins(output: &Path, folder: &Folder, outcomes: &[TailOutcome]) {
    let mut new = ByStart::new();
    for outcome in outcomes {
        for flight in &outcome.new_flights {
            new.entry(flight.start.to_string()).or_default().push((&outcome.tail, flight));
        }
    }
    if new.is_empty() {
        return;
    }
    for (tail, flight, (other, known)) in among_new(&new) {
        tell(output, (tail, flight), other, &known.flight);
    }
    let tails: Vec<String> = folder.tails().into_iter().collect();
    let found: Vec<_> = tails.par_iter().map(|tail| stored_twins(folder, tail, &new)).collect();
    for (stored, twins) in tails.iter().zip(found) {
        for (tail, flight, known) in twins {
            tell(output, (tail, flight), stored, &known);
        }
    }
}

fn tell(output: &Path, (tail, new): (&str, &NewFlight), other: &str, known: &str) {
    let folder = show(output);
    tracing::warn!(
        "flight {known} of tail {other} and flight {} of tail {tail}, both of {}, are the same samples, learnt twice: \
         `cruisefit forget {folder} --tail {other} --flight {known}` takes it from the former",
        new.flight,
        new.start,
    );
}

/// Tail and flight, and those of another tail that learns the same in this run.
fn among_new<'a>(new: &ByStart<'a>) -> Vec<(&'a str, &'a NewFlight, (&'a str, &'a NewFlight))> {
    let mut found = Vec::new();
    for at_once in new.values() {
        for (place, (tail, flight)) in at_once.iter().enumerate() {
            let twin = at_once[..place].iter().find(|(other, one)| {
                other != tail && one.end == flight.end && one.samples == flight.samples
            });
            found.extend(twin.map(|other| (*tail, *flight, *other)));
        }
    }
    found
}

/// The new flights of other tails that a tail has learnt before, with the name that they have there.
fn stored_twins<'a>(
    folder: &Folder,
    tail: &str,
    new: &ByStart<'a>,
) -> Vec<(&'a str, &'a NewFlight, String)> {
    // What is damaged is told where it is needed.
    let flights = folder.flights_begun(tail, |start| new.contains_key(start)).unwrap_or_default();
    let twins_in_time = |known: &KnownFlight| {
        let at_once = new.get(&known.entry.start).map_or(&[][..], Vec::as_slice);
        at_once
            .iter()
            .filter(|(other, one)| *other != tail && one.end == known.end)
            .map(|(other, one)| (*other, *one, known.entry.flight.clone()))
            .collect::<Vec<_>>()
    };
    let mut twins: Vec<_> = flights.iter().flat_map(twins_in_time).collect();
    if twins.is_empty() {
        return twins;
    }
    let segments = folder.load(tail).map(|stored| stored.segments).unwrap_or_default();
    twins.retain(|(_, flight, known)| {
        let of_flight = segments.iter().filter(|segment| {
            segment.identity.start == flight.start && segment.identity.flight == *known
        });
        samples_mark(&of_flight.cloned().collect::<Vec<_>>()) == Some(flight.samples)
    });
    twins
}
