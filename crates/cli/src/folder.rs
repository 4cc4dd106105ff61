//! The state of an output folder: what it holds, and whether a run may continue it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use flight::Segment;

use crate::failure::Failure;
use crate::files::{file_stem_of_tail, make_folder, write_atomically};
use crate::models::{read_model, write_model};
use pipeline::model_file::ModelFile;
use pipeline::segments_table::{self, SegmentRow};

/// A tail in the folder.
#[derive(Clone, Debug)]
pub(crate) struct StoredTail {
    /// Its model.
    pub(crate) model: ModelFile,
    /// Segments of the flights in its ledger, in the order in which they were learnt.
    pub(crate) segments: Vec<Segment>,
}

/// An output folder of `adapt`.
#[derive(Clone, Debug)]
pub(crate) struct Folder {
    path: PathBuf,
}

impl Folder {
    /// The folder at a path, created if it does not exist; with `restart`, an existing one is renamed first.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub(crate) fn open(path: &Path, restart: bool) -> Result<Self, Failure> {
        if restart {
            keep_aside(path)?;
        }
        for folder in [path.to_owned(), path.join("models"), path.join("segments")] {
            make_folder(&folder)?;
            // An existing folder may still not be writable: better reported now than after an hour of work.
            tempfile::tempfile_in(&folder).map_err(|error| Failure::unwritable(&folder, error))?;
        }
        Ok(Self { path: path.to_owned() })
    }

    /// Every tail that the folder holds.
    ///
    /// # Errors
    /// A model or segment file that cannot be read or was damaged.
    pub(crate) fn load(&self) -> Result<BTreeMap<String, StoredTail>, Failure> {
        let folder = self.path.join("models");
        let entries =
            std::fs::read_dir(&folder).map_err(|error| Failure::unreadable(&folder, error))?;
        let mut tails = BTreeMap::new();
        for entry in entries {
            let path = entry.map_err(|error| Failure::unreadable(&folder, error))?.path();
            if path.extension().is_none_or(|ending| ending != "ron") {
                continue;
            }
            let model = read_model(&path)?;
            let Some(learnt) = &model.learnt else {
                return Err(Failure::bad_file(&path, "a model that has learnt nothing"));
            };
            let tail = learnt.tail.clone();
            let segments = self.load_segments(&tail, &model)?;
            tails.insert(tail, StoredTail { model, segments });
        }
        Ok(tails)
    }

    fn load_segments(&self, tail: &str, model: &ModelFile) -> Result<Vec<Segment>, Failure> {
        let path = self.segments_path(tail);
        let bytes = std::fs::read(&path).map_err(|error| Failure::unreadable(&path, error))?;
        let all = segments_table::read(&bytes).map_err(|error| Failure::bad_file(&path, error))?;
        let ledger = model.learnt.as_ref().map_or(&[][..], |learnt| &learnt.ledger);
        // Segments are written before the model. A run that was interrupted in between leaves segments of flights that
        // the ledger does not list: they count as not learnt, and are learnt when their report is given again.
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

    /// Writes a tail: its segments, then its model, each whole or not at all.
    ///
    /// # Errors
    /// A file or folder that cannot be written.
    pub(crate) fn store(
        &self,
        tail: &str,
        model: &ModelFile,
        rows: &[SegmentRow],
    ) -> Result<(), Failure> {
        let engines = model.initial.aircraft().engines();
        let table = segments_table::table(rows, engines);
        write_atomically(&self.segments_path(tail), &table.to_csv())?;
        write_model(model, &self.model_path(tail))
    }

    /// Writes a file of the folder's top level.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(crate) fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        write_atomically(&self.path.join(name), bytes)
    }

    /// Path of a tail's model.
    pub(crate) fn model_path(&self, tail: &str) -> PathBuf {
        self.path.join("models").join(format!("{}.ron", file_stem_of_tail(tail)))
    }

    /// Path of a tail's segments.
    pub(crate) fn segments_path(&self, tail: &str) -> PathBuf {
        self.path.join("segments").join(format!("{}.csv", file_stem_of_tail(tail)))
    }
}

/// Renames a folder, if it exists, so that another can take its place.
///
/// # Errors
/// A folder that cannot be renamed.
pub(crate) fn keep_aside(path: &Path) -> Result<(), Failure> {
    if path.exists() {
        let aside = free_name(path);
        std::fs::rename(path, &aside).map_err(|error| Failure::unwritable(path, error))?;
        tracing::info!(from = %path.display(), to = %aside.display(), "kept aside");
    }
    Ok(())
}

/// `DIR.1`, or the first number that is free.
fn free_name(path: &Path) -> PathBuf {
    let mut number = 1_u32;
    loop {
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".{number}"));
        let aside = PathBuf::from(name);
        if !aside.exists() {
            return aside;
        }
        number += 1;
    }
}
