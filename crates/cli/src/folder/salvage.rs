//! What is still known of a tail whose files are damaged, so that it can be learnt anew without losing a flight.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use flight::Segment;
use pipeline::learning::FlightKey;
use pipeline::learnt_flights;
use pipeline::model_file::ModelFile;
use pipeline::reading::FlightRead;
use pipeline::segments_table;
use pipeline::summary::counted;

use super::state::{self, FileState, State, TailState};
use crate::failure::Failure;

/// What the sound files of a damaged tail tell.
#[derive(Debug)]
pub(crate) struct Salvage {
    /// Its model, where that is sound.
    pub(crate) model: Option<ModelFile>,
    /// Its segments; empty where they are damaged.
    pub(crate) segments: Vec<Segment>,
    learnt: Learnt,
}

/// The flights that a tail has learnt.
#[derive(Debug)]
enum Learnt {
    /// These, each with its content where that is known.
    Flights(BTreeMap<FlightKey, Option<String>>),
    /// So many: no file that names them is sound.
    Number(usize),
}

impl Salvage {
    /// What is still known of a tail; `None` where all of its files are sound.
    ///
    /// # Errors
    /// A file that cannot be read at all: nothing is known to be damaged then.
    pub(super) fn of(
        folder: &Path,
        state: &State,
        tail: &str,
        entry: &TailState,
    ) -> Result<Option<Self>, Failure> {
        let sound = |file: &FileState| {
            state::sound_bytes(state, folder, file)
                .map_err(|error| Failure::unreadable(&folder.join(&file.file), error))
        };
        let (model, segments, flights) =
            (sound(&entry.model)?, sound(&entry.segments)?, sound(&entry.flights)?);
        if model.is_some() && segments.is_some() && flights.is_some() {
            return Ok(None);
        }
        let path = folder.join(&entry.model.file);
        let model = model.and_then(|bytes| crate::models::model_of_bytes(&path, &bytes).ok());
        let flights = flights.and_then(|bytes| learnt_flights::read(tail, &bytes).ok());
        let flights = flights.map(|flights| {
            let keys = flights.into_iter();
            keys.map(|known| ((known.start, known.entry.flight), Some(known.entry.content)))
                .collect()
        });
        let segments = segments.and_then(|bytes| segments_table::read(&bytes).ok());
        let segments = segments.unwrap_or_default();
        let learnt = flights
            .or_else(|| model.as_ref().and_then(of_ledger))
            .or_else(|| of_segments(&segments, entry.summary.flights))
            .map_or(Learnt::Number(entry.summary.flights), Learnt::Flights);
        Ok(Some(Self { model, segments, learnt }))
    }

    /// Whether this content of a flight is known to be another than was learnt.
    pub(crate) fn is_other_version(&self, flight: &FlightKey, content: &str) -> bool {
        match &self.learnt {
            Learnt::Flights(learnt) => {
                let known = learnt.get(flight).and_then(Option::as_ref);
                known.is_some_and(|known| known != content)
            }
            Learnt::Number(_) => false,
        }
    }

    /// What would be lost if the tail were learnt from these flights alone.
    pub(crate) fn lost(&self, flights: &[FlightRead]) -> Option<String> {
        let identities = flights.iter().map(|flight| &flight.reduced.identity);
        let at_hand: BTreeSet<FlightKey> =
            identities.map(|identity| (identity.start, identity.flight.clone())).collect();
        match &self.learnt {
            Learnt::Flights(learnt) => {
                let mut lost = learnt.keys().filter(|flight| !at_hand.contains(*flight));
                let (start, flight) = lost.next()?;
                let more = match lost.count() {
                    0 => String::new(),
                    more => format!(" and {more} more"),
                };
                Some(format!(
                    "flight {flight} of {start}{more}, which it has learnt, would be lost: no usable report is of it"
                ))
            }
            Learnt::Number(learnt) if at_hand.len() < *learnt => Some(format!(
                "it has learnt {}, the usable reports are of {}",
                counted(*learnt, "flight"),
                at_hand.len()
            )),
            Learnt::Number(_) => None,
        }
    }
}

/// The flights of a model's ledger.
fn of_ledger(model: &ModelFile) -> Option<BTreeMap<FlightKey, Option<String>>> {
    let ledger = model.learnt.as_ref()?.ledger.iter();
    ledger
        .map(|entry| {
            let flight = (entry.start.parse().ok()?, entry.flight.clone());
            Some((flight, Some(entry.content.clone())))
        })
        .collect()
}

/// The flights of segments, where all that were learnt have one.
fn of_segments(segments: &[Segment], learnt: usize) -> Option<BTreeMap<FlightKey, Option<String>>> {
    let identities = segments.iter().map(|segment| &segment.identity);
    let flights: BTreeMap<FlightKey, Option<String>> =
        identities.map(|identity| ((identity.start, identity.flight.clone()), None)).collect();
    (flights.len() == learnt).then_some(flights)
}
