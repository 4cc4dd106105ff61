//! The state of an output folder: what it holds, and how that changes.
//!
//! What a reader sees is one generation. A run puts all its files into a waiting folder inside the output folder, makes
//! them durable, and then replaces `STATE.ron`, which names every file with its SHA-256, in one rename: before it the
//! old generation holds, after it the new one. Only then does each file move to its place. A run that is interrupted
//! while files move has committed: readers look for a file in the waiting folder first, and the next run completes the
//! moves. A waiting folder of another generation was never committed and is removed.

mod contents;
pub(crate) mod lock;
pub(crate) mod names;
pub(crate) mod older;
mod removal;
mod restart;
mod salvage;
pub(crate) mod state;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use pipeline::adaptation::StoredTail;
use pipeline::folder_state::{self, FOLDERS};
use pipeline::learnt_flights::{self, KnownFlight};

use crate::failure::{Failure, show};
use crate::files::{TEMPORARY, steps};
use contents::flights_of;
pub(crate) use contents::{
    ModelsFound, deviations_of, is_superseded, models_of, stored_of, waiting_model,
    warn_of_strangers,
};
use lock::{Busy, Lock};
pub(crate) use restart::keep_aside;
pub(crate) use salvage::Salvage;
use state::{FileState, State, TailState};

/// Whether a folder that exists is continued.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Beginning {
    /// Continue what it holds.
    Continue,
    /// Start over, and keep the old folder aside.
    Restart,
}

/// An output folder of `adapt`, open for writing: locked against other processes. Dropped without
/// [`commit`](Self::commit), it is as it was.
#[derive(Debug)]
pub(crate) struct Folder {
    /// Where files are written; the folder itself, or its replacement when it is started over.
    path: PathBuf,
    /// The folder that `path` takes the place of in the end.
    replaces: Option<PathBuf>,
    /// Whether this run made the folder.
    made: bool,
    lock: Option<Lock>,
    state: State,
    /// Tails of a folder without `STATE.ron`.
    older: BTreeMap<String, StoredTail>,
    /// Files that what is staged makes out of date: gone when it is in its place.
    out_of_date: Vec<String>,
}

/// Whether a path is that of a folder's state, or of a file of the kinds that a state names.
pub(crate) fn is_of_a_state(path: &Path) -> bool {
    let Ok(path) = path.canonicalize() else { return false };
    path.file_name().is_some_and(|own| own == folder_state::NAME)
        || path.parent().is_some_and(is_kept_by_a_state)
}

/// Whether a folder is one of those in which a folder of `adapt` keeps what it has learnt.
pub(crate) fn is_kept_by_a_state(folder: &Path) -> bool {
    folder.file_name().is_some_and(|name| FOLDERS.iter().any(|folder| name == *folder))
        && folder.parent().is_some_and(|above| above.join(folder_state::NAME).is_file())
}

impl Folder {
    /// Opens the folder at a path, created if it does not exist.
    ///
    /// # Errors
    /// A folder that cannot be written, that another process is writing, or whose state is damaged.
    pub(crate) fn open(path: &Path, beginning: Beginning, busy: Busy) -> Result<Self, Failure> {
        let mut path = restart::tidy(path)?;
        // Behind a link the target is replaced: whoever reads it elsewhere sees the new folder.
        if path.is_symlink() {
            path = path.canonicalize().map_err(|error| Failure::unwritable(&path, error))?;
        }
        let failed = |error: std::io::Error| Failure::unwritable(&path, error);
        let made = !path.exists();
        if !made && !path.is_dir() {
            return Err(Failure::unwritable(&path, "it is a file, where a folder was expected"));
        }
        std::fs::create_dir_all(&path).map_err(failed)?;
        let mut folder = Self {
            lock: Some(Lock::take(&path, busy)?),
            path: path.clone(),
            replaces: None,
            made,
            state: State::default(),
            older: BTreeMap::new(),
            out_of_date: Vec::new(),
        };
        // An existing folder may still not be writable: better reported now than after an hour of work.
        tempfile::tempfile_in(&path).map_err(failed)?;
        if beginning == Beginning::Restart && !made && restart::holds_anything(&path)? {
            folder.path = restart::replacement(&path).map_err(failed)?;
            folder.replaces = Some(path);
            return Ok(folder);
        }
        match state::read(&path)? {
            Some(state) => folder.state = state,
            None => folder.older = older::read(&path)?,
        }
        folder.clear_up().map_err(failed)?;
        if folder.state.generation > 0 {
            warn_of_strangers(&folder.path, &folder.state);
        }
        Ok(folder)
    }

    /// Whether the folder holds this tail.
    pub(crate) fn holds(&self, tail: &str) -> bool {
        self.state.tails.contains_key(tail) || self.older.contains_key(tail)
    }

    /// Tails that the folder holds.
    pub(crate) fn tails(&self) -> BTreeSet<String> {
        self.state.tails.keys().chain(self.older.keys()).cloned().collect()
    }

    /// Tails that are not in `STATE.ron` yet, because the folder was begun by a program before it.
    pub(crate) fn is_older(&self, tail: &str) -> bool {
        self.older.contains_key(tail)
    }

    /// What `STATE.ron` has of a tail.
    pub(crate) fn state_of(&self, tail: &str) -> Option<&TailState> {
        self.state.tails.get(tail)
    }

    /// The flights that a tail has learnt.
    ///
    /// # Errors
    /// A file that is damaged.
    pub(crate) fn flights(&self, tail: &str) -> Result<Vec<KnownFlight>, Failure> {
        if let Some(stored) = self.older.get(tail) {
            return Ok(stored.flights.clone());
        }
        match self.state.tails.get(tail) {
            Some(entry) => flights_of(&self.path, &self.state, tail, entry),
            None => Ok(Vec::new()),
        }
    }

    /// Those of them whose START is wanted, as the file has them, whatever its SHA-256: for a look at every tail.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(crate) fn flights_begun(
        &self,
        tail: &str,
        is_wanted: impl Fn(&str) -> bool,
    ) -> Result<Vec<KnownFlight>, Failure> {
        let Some(entry) = self.state.tails.get(tail) else { return self.flights(tail) };
        let path = self.path.join(&entry.flights.file);
        let bytes = std::fs::read(&path).map_err(|error| Failure::unreadable(&path, error))?;
        learnt_flights::begun(tail, &bytes, is_wanted)
            .map_err(|reason| Failure::bad_file(&path, reason))
    }

    /// Where the folder is written.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// A tail's model, segments and flights.
    ///
    /// # Errors
    /// A file that is damaged.
    pub(crate) fn load(&self, tail: &str) -> Result<StoredTail, Failure> {
        if let Some(stored) = self.older.get(tail) {
            return Ok(stored.clone());
        }
        let Some(entry) = self.state.tails.get(tail) else {
            return Err(Failure::bad_file(&self.path, format!("holds no tail {tail:?}")));
        };
        contents::stored_tail(&self.path, &self.state, tail, entry)
    }

    /// What is still known of a tail whose files are damaged; `None` where they are sound.
    ///
    /// # Errors
    /// A file that cannot be read at all.
    pub(crate) fn salvage(&self, tail: &str) -> Result<Option<Salvage>, Failure> {
        let entry = self.state.tails.get(tail);
        entry.map_or(Ok(None), |entry| Salvage::of(&self.path, &self.state, tail, entry))
    }

    /// Whether the folder has a file at this path now.
    pub(crate) fn has(&self, file: &str) -> bool {
        self.path.join(file).exists()
    }

    /// Puts a file of the next generation into the waiting folder, for the state to name.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(crate) fn stage(&self, file: &str, bytes: &[u8]) -> Result<FileState, Failure> {
        self.stage_unnamed(file, bytes)?;
        Ok(FileState::of(file, bytes))
    }

    /// The same of a file that is no part of the state, a page for instance.
    ///
    /// # Errors
    /// As for [`stage`](Self::stage).
    pub(crate) fn stage_unnamed(&self, file: &str, bytes: &[u8]) -> Result<(), Failure> {
        let path = self.waiting().join(file);
        let attempt = || {
            steps::make_folder(&self.waiting())?;
            if let Some(folder) = path.parent() {
                steps::make_folder(folder)?;
            }
            steps::write(&path, bytes)
        };
        attempt().map_err(|error| Failure::unwritable(&self.path, error))
    }

    /// These files, where there are any, are out of date with what is staged, and go when it is in its place. None of them may
    /// be of the state.
    pub(crate) fn removes(&mut self, files: impl IntoIterator<Item = String>) {
        self.out_of_date.extend(files);
    }

    /// Makes these tails, with the files that were staged, the state of the folder.
    ///
    /// # Errors
    /// A file that cannot be written; the folder then is as it was.
    pub(crate) fn commit(mut self, tails: BTreeMap<String, TailState>) -> Result<(), Failure> {
        if tails == self.state.tails && self.older.is_empty() && self.replaces.is_none() {
            // Only files that are no state (summary, page) are new, or of the state ones that were damaged.
            let waiting = self.waiting();
            let publish = || -> std::io::Result<()> {
                let [of_state @ .., _pages] = FOLDERS;
                if of_state.iter().any(|name| waiting.join(name).is_dir()) {
                    steps::sync_below(&self.path)?;
                }
                self.move_files(&waiting)
            };
            return publish().map_err(|error| Failure::unwritable(&self.path, error));
        }
        let state = State { generation: self.state.generation + 1, tails };
        let text =
            state.to_text().map_err(|error| Failure::unwritable(&self.path, error))?.into_bytes();
        self.stage_unnamed(state::NAME, &text)?;
        let gone = removal::no_longer_named(&self.state, &state);
        if !gone.is_empty() {
            self.stage_unnamed(removal::LIST, gone.as_bytes())?;
        }
        let waiting = self.waiting();
        let publish = || -> std::io::Result<()> {
            steps::sync_below(&self.path)?;
            steps::rename(&waiting.join(state::NAME), &self.path.join(state::NAME))
        };
        publish().map_err(|error| Failure::unwritable(&self.path, error))?;
        // From here on the new generation holds, whatever happens.
        self.state = state;
        self.older.clear();
        if let Err(error) = self.settle() {
            tracing::warn!(
                "{}: {error}; the run is stored, and the next one completes the moves of its files",
                show(&self.path)
            );
        }
        match self.replaces.take() {
            Some(old) => self.take_the_place_of(&old),
            None => Ok(()),
        }
    }

    /// Moves the files of a committed generation to their places and removes what it no longer names.
    fn settle(&self) -> std::io::Result<()> {
        steps::sync_folder(&self.path)?;
        self.move_files(&state::waiting(&self.state, &self.path))
    }

    /// Moves everything in a waiting folder to its place, makes that durable, and removes the folder.
    fn move_files(&self, waiting: &Path) -> std::io::Result<()> {
        if !waiting.is_dir() {
            return Ok(());
        }
        for name in FOLDERS {
            let from = waiting.join(name);
            if from.is_dir() {
                let to = self.path.join(name);
                steps::make_folder(&to)?;
                move_all(&from, &to)?;
            }
        }
        removal::complete(waiting, &self.path)?;
        move_all(waiting, &self.path)?;
        for file in self.out_of_date.iter().map(|file| self.path.join(file)) {
            if file.is_file() {
                steps::remove_file(&file)?;
            }
        }
        steps::sync_folder(&self.path)?;
        steps::remove_folder(waiting)
    }

    /// Completes or removes what an interrupted run left.
    fn clear_up(&self) -> std::io::Result<()> {
        let waiting = state::waiting(&self.state, &self.path);
        if self.state.generation > 0 && waiting.is_dir() {
            tracing::info!("{}: completing a run that was interrupted", show(&self.path));
            self.move_files(&waiting)?;
        }
        let folders = FOLDERS.map(|name| self.path.join(name));
        for folder in std::iter::once(&self.path).chain(&folders) {
            let Ok(entries) = std::fs::read_dir(folder) else { continue };
            for path in entries.flatten().map(|entry| entry.path()) {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                if path == lock::lock_file(&self.path) || !name.starts_with(TEMPORARY) {
                    continue;
                }
                if path.is_dir() && name.starts_with(&format!("{TEMPORARY}next-")) {
                    steps::remove_folder(&path)?;
                } else if name.ends_with(".tmp") {
                    steps::remove_file(&path)?;
                }
            }
        }
        Ok(())
    }

    fn waiting(&self) -> PathBuf {
        state::waiting_of(&self.path, self.state.generation + 1)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let waiting = self.waiting();
        if waiting.is_dir() {
            // If it cannot be removed, the next run removes it.
            let _ = steps::remove_folder(&waiting);
        }
        if self.replaces.is_some() {
            let _ = steps::remove_folder(&self.path);
        }
        self.lock = None;
        if self.made && self.replaces.is_none() {
            // Succeeds only where nothing was stored.
            let _ = std::fs::remove_dir(&self.path);
        }
    }
}

/// Moves the files of one folder into another, and makes that durable.
fn move_all(from: &Path, to: &Path) -> std::io::Result<()> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        if entry.file_type()?.is_file() {
            names.push(entry.file_name());
        }
    }
    names.sort();
    for name in &names {
        steps::rename(&from.join(name), &to.join(name))?;
    }
    if names.is_empty() { Ok(()) } else { steps::sync_folder(to) }
}
