//! Files that a new generation no longer names: its waiting folder lists them, so that whoever completes the generation removes
//! them too.

use std::collections::BTreeSet;
use std::path::Path;

use super::FOLDERS;
use super::state::{State, TailState};
use crate::files::steps;

/// Name of the list in the waiting folder.
pub(super) const LIST: &str = "REMOVED";

/// The list of the files that one generation names and the next does not, a line each; empty where there are none.
pub(super) fn no_longer_named(old: &State, new: &State) -> String {
    let (old, new) = (files(old), files(new));
    old.difference(&new).flat_map(|file| [*file, "\n"]).collect()
}

/// Removes the files of a waiting folder's list, and then the list. Files that have gone already are no error.
pub(super) fn complete(waiting: &Path, folder: &Path) -> std::io::Result<()> {
    let list = waiting.join(LIST);
    let text = match std::fs::read_to_string(&list) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(error),
    };
    let mut below = BTreeSet::new();
    for line in text.lines() {
        // Nothing outside the folders of tails' files, whatever somebody wrote there.
        let Some((name, file)) = line.split_once('/') else { continue };
        let path = folder.join(name).join(file);
        if FOLDERS.contains(&name) && !file.contains('/') && path.is_file() {
            steps::remove_file(&path)?;
            below.insert(name);
        }
    }
    for name in below {
        steps::sync_folder(&folder.join(name))?;
    }
    steps::remove_file(&list)
}

fn files(state: &State) -> BTreeSet<&str> {
    state.tails.values().flat_map(files_of).collect()
}

fn files_of(tail: &TailState) -> impl Iterator<Item = &str> {
    let deviations = tail.deviations.as_ref().map(|of| &of.file);
    let all = [&tail.model, &tail.segments, &tail.flights].into_iter().chain(deviations);
    all.map(|file| file.file.as_str())
}
