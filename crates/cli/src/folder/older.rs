//! Folders of programs before `STATE.ron`: every model in `models/` counts, and segments without a flight in the
//! model's ledger are left over from a run that was interrupted.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use flight::Segment;
use pipeline::adaptation::StoredTail;
use pipeline::learnt_flights;
use pipeline::model_file::ModelFile;
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
        let segments = segments_of(folder, &tail, &model)?;
        let flights = learnt_flights::of_ledger(&learnt.ledger, &segments)
            .map_err(|reason| Failure::bad_file(&path, reason))?;
        tails.insert(tail, StoredTail { model, segments, flights, curve: None });
    }
    Ok(tails)
}

fn segments_of(folder: &Path, tail: &str, model: &ModelFile) -> Result<Vec<Segment>, Failure> {
    let path = folder.join("segments").join(format!("{}.csv", file_stem_of_tail(tail)));
    let bytes = std::fs::read(&path).map_err(|error| Failure::unreadable(&path, error))?;
    let all = segments_table::read(&bytes).map_err(|error| Failure::bad_file(&path, error))?;
    let ledger = model.learnt.as_ref().map_or(&[][..], |learnt| &learnt.ledger);
    let known: BTreeSet<(&str, &str)> =
        ledger.iter().map(|entry| (entry.flight.as_str(), entry.start.as_str())).collect();
    let mut segments = Vec::with_capacity(all.len());
    for segment in all {
        let start = segment.identity.start.to_string();
        if known.contains(&(segment.identity.flight.as_str(), start.as_str())) {
            segments.push(segment);
        }
    }
    let expected: u64 = ledger.iter().map(|entry| entry.segments).sum();
    if segments.len() as u64 != expected {
        return Err(Failure::bad_file(
            &path,
            format!("{} segments, the model's ledger has {expected}", segments.len()),
        ));
    }
    Ok(segments)
}
