//! `STATE.ron` of a folder, and the files that it names.

use std::path::{Path, PathBuf};

pub(crate) use pipeline::folder_state::{DeviationsState, FileState, NAME, State, TailState};

use crate::failure::Failure;
use crate::files::{TEMPORARY, read_text};

/// The state of a folder; `None` where the folder has no `STATE.ron`.
///
/// # Errors
/// A file that cannot be read, is damaged, or is of a newer format.
pub(crate) fn read(folder: &Path) -> Result<Option<State>, Failure> {
    let path = folder.join(NAME);
    if !path.exists() {
        return Ok(None);
    }
    let text = read_text(&path)?;
    State::from_text(&text).map(Some).map_err(|error| Failure::BadFile {
        path: crate::failure::show(&path),
        reason: error.to_string(),
        help: Some(
            "take the file from a backup of the folder; without STATE.ron the folder is read as one of an older \
             program, from models/ and segments/"
                .to_owned(),
        ),
    })
}

/// The folder in which files of this generation wait until each has its place.
pub(crate) fn waiting(state: &State, folder: &Path) -> PathBuf {
    waiting_of(folder, state.generation)
}

/// The bytes of a file of the state.
///
/// # Errors
/// A file that cannot be read, or whose SHA-256 is not that of the state.
pub(crate) fn bytes_of(state: &State, folder: &Path, file: &FileState) -> Result<Vec<u8>, Failure> {
    let path = folder.join(&file.file);
    let bytes =
        found_bytes(state, folder, file).map_err(|error| Failure::unreadable(&path, error))?;
    if file.names(&bytes) {
        return Ok(bytes);
    }
    Err(Failure::BadFile {
        path: crate::failure::show(&path),
        reason: "its SHA-256 is not that of STATE.ron: it was changed or damaged".to_owned(),
        help: Some(
            "take it from a backup, or adapt with --relearn and all reports of the tail: it is then learnt anew"
                .to_owned(),
        ),
    })
}

/// The bytes of a file of the state where it is as the state names it; `None` where it is damaged or gone.
///
/// # Errors
/// A file that cannot be read, which need not be damaged.
pub(crate) fn sound_bytes(
    state: &State,
    folder: &Path,
    file: &FileState,
) -> std::io::Result<Option<Vec<u8>>> {
    match found_bytes(state, folder, file) {
        Ok(bytes) => Ok(Some(bytes).filter(|bytes| file.names(bytes))),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

fn found_bytes(state: &State, folder: &Path, file: &FileState) -> std::io::Result<Vec<u8>> {
    // In this order: a file moves from the waiting folder to its place.
    std::fs::read(waiting(state, folder).join(&file.file))
        .or_else(|_| std::fs::read(folder.join(&file.file)))
}

/// The folder in which files of a generation wait.
pub(crate) fn waiting_of(folder: &Path, generation: u64) -> PathBuf {
    folder.join(format!("{TEMPORARY}next-{generation}"))
}
