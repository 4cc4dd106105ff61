//! Folders of programs before `STATE.ron`: every model in `models/` counts, and segments without a flight in the
//! model's ledger are left over from a run that was interrupted.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use flight::Segment;
use pipeline::adaptation::StoredTail;
use pipeline::learnt_flights;
use pipeline::model_file::Learnt;
use pipeline::segments_table;

use crate::failure::Failure;
use crate::files::file_stem_of_tail;
use crate::models::read_model;

/// Every tail of an older folder; nothing where there is no model.
///
/// # Errors
/// A model or segment file that cannot be read or was damaged.
pub(super) fn read(folder: &Path) -> Result<BTreeMap<String, StoredTail>, Failure> {
    let mut tails = BTreeMap::new();
    let models = folder.join("models");
    let Ok(entries) = std::fs::read_dir(&models) else { return Ok(tails) };
    let mut paths = Vec::new();
    for entry in entries {
        paths.push(entry.map_err(|error| Failure::unreadable(&models, error))?.path());
    }
    paths.sort();
    for path in paths {
        if path.extension().is_none_or(|ending| ending != "ron") {
            continue;
        }
        let model = read_model(&path)?;
        let Some(learnt) = &model.learnt else {
            return Err(Failure::bad_file(&path, "a model that has learnt nothing"));
        };
        let tail = learnt.tail.clone();
        if path.file_stem().is_none_or(|stem| *stem != *file_stem_of_tail(&tail)) {
            tracing::warn!(
                "{} is ignored: the model of tail {tail} is {}.ron",
                path.display(),
                file_stem_of_tail(&tail)
            );
            continue;
        }
        let segments = segments_of(folder, learnt)?;
        let flights = learnt_flights::of_ledger(&learnt.ledger, &segments)
            .map_err(|reason| Failure::bad_file(&path, reason))?;
        tails.insert(tail, StoredTail { model, segments, flights, curve: None, predicted: None });
    }
    Ok(tails)
}

/// The segments of all flights of a tail's ledger.
fn segments_of(folder: &Path, learnt: &Learnt) -> Result<Vec<Segment>, Failure> {
    let segments = known_segments(folder, learnt)?;
    let expected: u64 = learnt.ledger.iter().map(|entry| entry.segments).sum();
    if segments.len() as u64 != expected {
        return Err(Failure::bad_file(
            &segments_file(folder, &learnt.tail),
            format!("{} segments, the model's ledger has {expected}", segments.len()),
        ));
    }
    Ok(segments)
}

fn segments_file(folder: &Path, tail: &str) -> PathBuf {
    folder.join("segments").join(format!("{}.csv", file_stem_of_tail(tail)))
}

/// Segments of flights in a tail's ledger, in the order in which they were learnt. A run that was interrupted may have left
/// some of other flights.
///
/// # Errors
/// A file that cannot be read or was damaged.
pub(crate) fn known_segments(folder: &Path, learnt: &Learnt) -> Result<Vec<Segment>, Failure> {
    let path = segments_file(folder, &learnt.tail);
    let bytes = std::fs::read(&path).map_err(|error| Failure::unreadable(&path, error))?;
    let all = segments_table::read(&bytes).map_err(|error| Failure::bad_file(&path, error))?;
    let known: BTreeSet<(&str, &str)> =
        learnt.ledger.iter().map(|entry| (entry.flight.as_str(), entry.start.as_str())).collect();
    let is_known = |segment: &Segment| {
        known.contains(&(segment.identity.flight.as_str(), &segment.identity.start.to_string()))
    };
    Ok(all.into_iter().filter(is_known).collect())
}
