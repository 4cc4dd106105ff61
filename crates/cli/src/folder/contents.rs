//! What a folder's state names, read: for the folder itself, and for commands that only read it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use pipeline::adaptation::StoredTail;
use pipeline::learnt_flights::{self, KnownFlight};
use pipeline::model_file::ModelFile;
use pipeline::monitoring::{MonitoredFlight, curve_of_flights, read_flights};
use pipeline::segments_table;

use super::state::{self, DeviationsState, State, TailState};
use crate::failure::Failure;
use crate::files::TEMPORARY;

/// Models of a folder, and the tails of which they are damaged, with the reason of each.
#[derive(Debug, Default)]
pub(crate) struct ModelsFound {
    pub(crate) models: Vec<(PathBuf, ModelFile)>,
    pub(crate) damaged: Vec<(String, Failure)>,
}

/// Models of a folder that has a state, in the order of tails, for commands that only read.
///
/// # Errors
/// A state that is damaged.
pub(crate) fn models_of(folder: &Path) -> Result<Option<ModelsFound>, Failure> {
    loop {
        let Some(state) = state::read(folder)? else { return Ok(None) };
        warn_of_strangers(folder, &state);
        let mut found = ModelsFound::default();
        for (tail, entry) in &state.tails {
            let path = folder.join(&entry.model.file);
            let model = state::bytes_of(&state, folder, &entry.model)
                .and_then(|bytes| crate::models::model_of_bytes(&path, &bytes));
            match model {
                Ok(model) => found.models.push((path, model)),
                Err(failure) => found.damaged.push((tail.clone(), failure)),
            }
        }
        // Otherwise another process may have stored a newer generation in the meantime.
        if found.damaged.is_empty() || !is_superseded(folder, &state) {
            return Ok(Some(found));
        }
    }
}

/// Whether a folder has another state by now: files that this one names may have gone while they were read.
pub(crate) fn is_superseded(folder: &Path, state: &State) -> bool {
    state::read(folder).is_ok_and(|now| now.is_some_and(|now| now != *state))
}

/// What each flight of a tail shows.
///
/// # Errors
/// A file that is damaged.
pub(crate) fn deviations_of(
    state: &State,
    folder: &Path,
    of: &DeviationsState,
) -> Result<Vec<MonitoredFlight>, Failure> {
    let bytes = state::bytes_of(state, folder, &of.file)?;
    read_flights(&bytes).map_err(|reason| Failure::bad_file(&folder.join(&of.file.file), reason))
}

/// A tail's model, segments and flights.
///
/// # Errors
/// A file that is damaged.
pub(super) fn stored_tail(
    folder: &Path,
    state: &State,
    tail: &str,
    entry: &TailState,
) -> Result<StoredTail, Failure> {
    let path = folder.join(&entry.model.file);
    let bytes = state::bytes_of(state, folder, &entry.model)?;
    let model = crate::models::model_of_bytes(&path, &bytes)?;
    let path = folder.join(&entry.segments.file);
    let bytes = state::bytes_of(state, folder, &entry.segments)?;
    let segments = segments_table::read(&bytes).map_err(|error| Failure::bad_file(&path, error))?;
    let flights = flights_of(folder, state, tail, entry)?;
    let curve = match &entry.deviations {
        Some(of) => match deviations_of(state, folder, of) {
            Ok(flights) => Some(curve_of_flights(&flights)),
            // Nothing is lost with it: all that it holds follows from model and segments.
            Err(failure) => {
                tracing::warn!("{failure}; it is made anew");
                None
            }
        },
        None => None,
    };
    Ok(StoredTail { model, segments, flights, curve, predicted: None })
}

/// A model file of a folder that has a state, with the segments and flights that it learnt; `None` of any other file.
///
/// # Errors
/// A file that is damaged.
pub(crate) fn stored_of(model: &Path) -> Result<Option<StoredTail>, Failure> {
    let Some((folder, file)) = place_of(model) else { return Ok(None) };
    loop {
        let Some(state) = state::read(folder)? else { return Ok(None) };
        let Some((tail, entry)) = state.tails.iter().find(|(_, entry)| entry.model.file == file)
        else {
            return Ok(None);
        };
        match stored_tail(folder, &state, tail, entry) {
            Ok(stored) => return Ok(Some(stored)),
            // Another process may have stored a newer generation in the meantime.
            Err(_) if is_superseded(folder, &state) => {}
            Err(failure) => return Err(failure),
        }
    }
}

/// The bytes of a model file that still waits for its place, as a run leaves it that was killed after its state was stored: what lies
/// there is of the generation before. `None` of every other file.
///
/// # Errors
/// A state or file that is damaged.
pub(crate) fn waiting_model(model: &Path) -> Result<Option<Vec<u8>>, Failure> {
    let Some((folder, file)) = place_of(model) else { return Ok(None) };
    let Some(state) = state::read(folder)? else { return Ok(None) };
    if !state::waiting(&state, folder).is_dir() {
        return Ok(None);
    }
    let entry = state.tails.values().find(|entry| entry.model.file == file);
    entry.map(|entry| state::bytes_of(&state, folder, &entry.model)).transpose()
}

/// The folder of `adapt` of which a file may be a model, and the name under which its state has it.
fn place_of(model: &Path) -> Option<(&Path, String)> {
    let models = model.parent()?;
    if models.file_name()? != "models" {
        return None;
    }
    let above = models.parent()?;
    let folder = if above.as_os_str().is_empty() { Path::new(".") } else { above };
    Some((folder, format!("models/{}", model.file_name()?.to_string_lossy())))
}

/// The flights that a tail has learnt.
///
/// # Errors
/// A file that is damaged.
pub(super) fn flights_of(
    folder: &Path,
    state: &State,
    tail: &str,
    entry: &TailState,
) -> Result<Vec<KnownFlight>, Failure> {
    let bytes = state::bytes_of(state, folder, &entry.flights)?;
    learnt_flights::read(tail, &bytes)
        .map_err(|reason| Failure::bad_file(&folder.join(&entry.flights.file), reason))
}

/// Names files that look like state and are none.
pub(crate) fn warn_of_strangers(folder: &Path, state: &State) {
    for stranger in strangers(folder, state) {
        tracing::warn!("{} is ignored: STATE.ron does not name it", stranger.display());
    }
}

/// Files in `models/`, `segments/` and `deviations/` that the state does not name.
fn strangers(folder: &Path, state: &State) -> Vec<PathBuf> {
    let named: BTreeSet<PathBuf> = state
        .tails
        .values()
        .flat_map(|tail| {
            let deviations = tail.deviations.as_ref().map(|of| &of.file);
            [&tail.model, &tail.segments].into_iter().chain(deviations)
        })
        .map(|file| folder.join(&file.file))
        .collect();
    let mut strangers = Vec::new();
    for name in ["models", "segments", "deviations"] {
        let Ok(entries) = std::fs::read_dir(folder.join(name)) else { continue };
        for path in entries.flatten().map(|entry| entry.path()) {
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            if !named.contains(&path) && !file.starts_with(TEMPORARY) {
                strangers.push(path);
            }
        }
    }
    strangers.sort();
    strangers
}
