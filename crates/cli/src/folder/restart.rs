//! Starting a folder over: the new folder is made beside the old one and the two exchange their names.

use std::path::{Component, Path, PathBuf};

use super::Folder;
use crate::failure::{Failure, show};
use crate::files::TEMPORARY;

impl Folder {
    /// Gives this folder the name of another, which is kept under this one's.
    pub(super) fn take_the_place_of(&mut self, old: &Path) -> Result<(), Failure> {
        let new = self.path.clone();
        let failed = |error: std::io::Error| Failure::unwritable(old, error);
        exchange(&new, old).map_err(failed)?;
        if let Some(lock) = &mut self.lock {
            lock.moved_to(&new);
        }
        old.clone_into(&mut self.path);
        tracing::warn!("the folder as it was is kept as {}", show(&new));
        Ok(())
    }
}

/// Renames a folder, if it exists, so that another can take its place.
///
/// # Errors
/// A folder that cannot be renamed.
pub(crate) fn keep_aside(path: &Path) -> Result<(), Failure> {
    if path.exists() {
        let path = tidy(path)?;
        let aside = free_name(&path);
        std::fs::rename(&path, &aside).map_err(|error| Failure::unwritable(&path, error))?;
        tracing::warn!("the folder as it was is kept as {}", show(&aside));
    }
    Ok(())
}

/// A path whose last part is a name: without a slash at its end, and neither `.` nor `..`.
///
/// # Errors
/// A folder that cannot be found.
pub(super) fn tidy(path: &Path) -> Result<PathBuf, Failure> {
    let tidy: PathBuf = path.components().collect();
    match tidy.components().next_back() {
        Some(Component::Normal(_)) => Ok(tidy),
        _ => path.canonicalize().map_err(|error| Failure::unwritable(path, error)),
    }
}

/// Whether there is anything in a folder but the program's own temporary files.
pub(super) fn holds_anything(path: &Path) -> Result<bool, Failure> {
    let entries = std::fs::read_dir(path).map_err(|error| Failure::unreadable(path, error))?;
    Ok(entries.flatten().any(|entry| !entry.file_name().to_string_lossy().starts_with(TEMPORARY)))
}

/// Makes the folder that is to replace another, under the name that the other will have. `path` is locked: what a run that was
/// killed left of its own is removed.
pub(super) fn replacement(path: &Path) -> std::io::Result<PathBuf> {
    for name in names_aside(path).take_while(|name| name.exists()) {
        // An empty folder may be somebody's.
        let is_left = std::fs::read_dir(&name).is_ok_and(|mut entries| entries.next().is_some());
        if is_left && holds_anything(&name).is_ok_and(|holds| !holds) {
            std::fs::remove_dir_all(&name)?;
        }
    }
    let replacement = free_name(path);
    std::fs::create_dir(&replacement)?;
    Ok(replacement)
}

/// The first of the names for old folders that is free.
fn free_name(path: &Path) -> PathBuf {
    names_aside(path).find(|name| !name.exists()).unwrap_or_else(|| path.with_extension("old"))
}

/// `DIR.1`, `DIR.2`, …
fn names_aside(path: &Path) -> impl Iterator<Item = PathBuf> {
    (1_u32..).map(|number| {
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".{number}"));
        PathBuf::from(name)
    })
}

/// Exchanges the names of two folders: in one step where the system can.
fn exchange(one: &Path, other: &Path) -> std::io::Result<()> {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{CWD, RenameFlags, renameat_with};
        if renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE).is_ok() {
            return Ok(());
        }
    }
    let mut between = other.as_os_str().to_owned();
    between.push(".exchanged");
    let between = PathBuf::from(between);
    std::fs::rename(other, &between)?;
    std::fs::rename(one, other)?;
    std::fs::rename(&between, one)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_end_in_a_name() {
        assert_eq!(tidy(Path::new("a/b/")).unwrap(), Path::new("a/b"));
        assert!(tidy(Path::new(".")).unwrap().is_absolute());
    }
}
