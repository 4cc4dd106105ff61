//! What `monitor` needs of an output folder of `adapt`: it reads, and writes nothing there.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use flight::Segment;

use crate::failure::Failure;
use crate::files::file_stem_of_tail;
use crate::models::read_model;
use pipeline::model_file::ModelFile;
use pipeline::segments_table;

/// A tail of the folder.
#[derive(Debug)]
pub(crate) struct StoredTail {
    pub(crate) tail: String,
    pub(crate) model: ModelFile,
    /// Segments of the flights in its ledger, in the order in which they were learnt.
    pub(crate) segments: Vec<Segment>,
}

/// The model files of a folder, in order.
///
/// # Errors
/// A folder that cannot be read or holds no tail.
pub(crate) fn tails(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let models = folder.join("models");
    let mut paths = Vec::new();
    // A folder without `models/` is one that another command wrote.
    if models.is_dir() || !folder.is_dir() {
        let entries =
            std::fs::read_dir(&models).map_err(|error| Failure::unreadable(&models, error))?;
        for entry in entries {
            let path = entry.map_err(|error| Failure::unreadable(&models, error))?.path();
            if path.extension().is_some_and(|ending| ending == "ron") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    if paths.is_empty() {
        return Err(Failure::bad_file(
            folder,
            "found no model in models/, expected a folder that `cruisefit adapt` wrote",
        ));
    }
    Ok(paths)
}

/// Reads one tail.
///
/// # Errors
/// A model or segment file that cannot be read or was damaged.
pub(crate) fn read(folder: &Path, path: &Path) -> Result<StoredTail, Failure> {
    let model = read_model(path)?;
    let Some(learnt) = &model.learnt else {
        return Err(Failure::bad_file(path, "a model that has learnt nothing"));
    };
    let tail = learnt.tail.clone();
    let path = folder.join("segments").join(format!("{}.csv", file_stem_of_tail(&tail)));
    let bytes = std::fs::read(&path).map_err(|error| Failure::unreadable(&path, error))?;
    let all = segments_table::read(&bytes).map_err(|error| Failure::bad_file(&path, error))?;
    // A run that was interrupted may have left segments of flights that the ledger does not list.
    let known: BTreeSet<(&str, &str)> =
        learnt.ledger.iter().map(|entry| (entry.flight.as_str(), entry.start.as_str())).collect();
    let is_known = |segment: &Segment| {
        known.contains(&(segment.identity.flight.as_str(), &segment.identity.start.to_string()))
    };
    let segments = all.into_iter().filter(is_known).collect();
    Ok(StoredTail { tail, model, segments })
}
