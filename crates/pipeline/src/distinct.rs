//! Each flight once, whatever the names of its files.

use std::collections::BTreeMap;

use crate::known_flights::{KnownFlights, Relation};
use crate::reading::{FlightRead, Reading, RefusedReport};

/// Keeps one report of every flight: copies are left out with one warning for all of them, a report that contradicts
/// another one (other content, the same hours under another name) is refused.
pub fn distinct(reading: Reading) -> Reading {
    let Reading { flights, mut refused, mut copies, other_files } = reading;
    let mut order: Vec<usize> = (0..flights.len()).collect();
    order.sort_by(|one, other| flights[*one].order(&flights[*other]));
    let mut tails: BTreeMap<&str, KnownFlights> = BTreeMap::new();
    let mut first_paths: BTreeMap<(&str, usize), &FlightRead> = BTreeMap::new();
    let mut kept = vec![false; flights.len()];
    let mut first_copy = None;
    for index in order {
        let flight = &flights[index];
        let tail = flight.reduced.identity.tail.as_str();
        let known = tails.entry(tail).or_default();
        let relation = known.relation(flight);
        match relation {
            Relation::New => {
                first_paths.insert((tail, known.flights().len()), flight);
                known.add(flight);
                kept[index] = true;
            }
            Relation::Same(of) => {
                copies += 1;
                first_copy = first_copy.or_else(|| {
                    let original = first_paths.get(&(tail, of))?;
                    Some((flight.path.display(), original.path.display()))
                });
            }
            _ => {
                let reason = known.objection(relation, flight).unwrap_or_default();
                refused.push(RefusedReport::whole(flight.path.clone(), reason));
            }
        }
    }
    warn_of_copies(copies, first_copy);
    let mut kept = kept.into_iter();
    let mut flights = flights;
    flights.retain(|_| kept.next().unwrap_or(false));
    refused.sort_by(|one, other| one.path.cmp(&other.path));
    Reading { flights, refused, copies, other_files }
}

/// One warning for all copies of a batch: how many, and the first with what it is a copy of.
pub fn warn_of_copies<P: std::fmt::Display>(copies: usize, first: Option<(P, P)>) {
    let Some((copy, original)) = first else { return };
    let (are, count) = match copies {
        1 => ("is a copy", "1 report".to_owned()),
        n => ("are copies", format!("{n} reports")),
    };
    tracing::warn!("{count} {are} of others and used once; the first: {copy}, of {original}");
}
