//! The first pass over reports: who flew and when, from the beginning of each file. What is kept is small, so that a
//! million files fit into little memory; the second pass reads each file where its turn comes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use flight::Timestamp;
use rayon::prelude::*;

use super::{Buffers, FlightRead, Source, bytes};
use crate::failure::RefusedReport;
use crate::progress::Bar;

/// A report's header fits into this many bytes nearly always; otherwise the whole report is read.
pub(super) const BEGINNING_BYTES: u64 = 4096;

/// A flight to read.
#[derive(Clone, Debug)]
pub(crate) struct Head {
    /// START.
    pub(crate) start: Timestamp,
    /// Its name.
    pub(crate) flight: Box<str>,
    /// Its file.
    pub(crate) path: Box<Path>,
    /// Type of the aircraft.
    pub(crate) aircraft_type: Arc<str>,
    /// A recording of another layout holds flights that only reading it finds: they are kept as read.
    pub(crate) read: Option<Box<FlightRead>>,
}

/// The flights of a batch by tail, each tail's in the order of flying, and what was refused.
#[derive(Debug, Default)]
pub(crate) struct Heads {
    /// Flights.
    pub(crate) tails: BTreeMap<String, Vec<Head>>,
    /// Files that are no reports.
    pub(crate) refused: Vec<RefusedReport>,
}

impl Source {
    /// The flights in files.
    pub(crate) fn heads(&self, mut files: Vec<PathBuf>, progress: &Bar) -> Heads {
        /// So many files at a time: what is known of them is small, but the list of it should not double it.
        const FILES_AT_A_TIME: usize = 4096;
        let mut heads = Heads::default();
        let mut types: BTreeMap<String, Arc<str>> = BTreeMap::new();
        // Taken from the end, so that the list gives back its memory while what is known of its files grows.
        files.reverse();
        while !files.is_empty() {
            let mut some = files.split_off(files.len().saturating_sub(FILES_AT_A_TIME));
            files.shrink_to_fit();
            some.reverse();
            let read: Vec<(Vec<Found>, Vec<RefusedReport>)> = some
                .into_par_iter()
                .map_init(Buffers::default, |buffers, path| {
                    let found = self.head_of(path, buffers);
                    progress.step();
                    found
                })
                .collect();
            for (found, refused) in read {
                heads.refused.extend(refused);
                for Found { head, path, read } in found {
                    let aircraft_type = if let Some(known) = types.get(&head.aircraft_type) {
                        Arc::clone(known)
                    } else {
                        let new: Arc<str> = Arc::from(head.aircraft_type.as_str());
                        types.insert(head.aircraft_type, Arc::clone(&new));
                        new
                    };
                    heads.tails.entry(head.identity.tail).or_default().push(Head {
                        start: head.identity.start,
                        flight: head.identity.flight.into_boxed_str(),
                        path: path.into_boxed_path(),
                        aircraft_type,
                        read,
                    });
                }
            }
        }
        for flights in heads.tails.values_mut() {
            flights.sort_by(|one, other| {
                (one.start, &one.flight, &one.path).cmp(&(other.start, &other.flight, &other.path))
            });
            flights.shrink_to_fit();
        }
        heads
    }

    fn head_of(&self, path: PathBuf, buffers: &mut Buffers) -> (Vec<Found>, Vec<RefusedReport>) {
        if self.mapping.is_none()
            && bytes::read_beginning(&path, BEGINNING_BYTES, &mut buffers.raw).is_ok()
            && let Some(head) = report::head(&buffers.raw)
        {
            return (vec![Found { head, path, read: None }], Vec::new());
        }
        let (flights, refused) = self.read_file(&path, buffers);
        // A table of segments holds many flights too.
        let keep = self.mapping.is_some() || flights.len() > 1;
        let found = flights.into_iter().map(|flight| {
            let identity = (*flight.reduced.identity).clone();
            let aircraft_type = flight.reduced.aircraft_type.clone();
            Found {
                head: report::Head { aircraft_type, identity },
                path: path.clone(),
                read: keep.then(|| Box::new(flight)),
            }
        });
        (found.collect(), refused)
    }
}

struct Found {
    head: report::Head,
    path: PathBuf,
    read: Option<Box<FlightRead>>,
}
