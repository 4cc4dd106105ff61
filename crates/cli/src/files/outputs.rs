//! Files that a command may replace, and those that it leaves alone unless it is told to.

use std::path::Path;

use crate::failure::{Failure, show};
use crate::files::write_atomically;
use crate::folder::is_of_a_state;

/// Refuses to replace a file that holds something else than what the command makes.
///
/// `own` decides, from the file's text, whether the command may replace it; a file with the very bytes that would be
/// written may always be replaced. Devices and pipes hold nothing.
///
/// # Errors
/// A file that would be lost.
pub(crate) fn check_replaceable(
    path: &Path,
    force: bool,
    written: &[u8],
    own: impl FnOnce(&str) -> bool,
) -> Result<(), Failure> {
    let is_file = path.metadata().is_ok_and(|known| known.is_file());
    if force || !is_file || path.as_os_str() == "-" {
        return Ok(());
    }
    let known = std::fs::read(path).map_err(|error| Failure::unreadable(path, error))?;
    if known == written || std::str::from_utf8(&known).is_ok_and(own) {
        return Ok(());
    }
    Err(Failure::WouldReplace { path: crate::failure::show(path) })
}

/// Writes what a command was asked for, in place of nothing or of an older result of the same kind: never of a file that a
/// folder's state names, nor of one that holds something else (a model under the name of a picture).
///
/// # Errors
/// A file that would be lost, or that cannot be written.
pub(crate) fn write_result(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    check_result(path, bytes)?;
    write_atomically(path, bytes)
}

/// Refuses to write over what a command reads.
///
/// # Errors
/// An output that is one of the inputs.
pub(crate) fn check_not_read(output: Option<&Path>, input: &Path) -> Result<(), Failure> {
    let Some(path) = output.filter(|path| path.is_file()) else { return Ok(()) };
    match (path.canonicalize(), input.canonicalize()) {
        (Ok(one), Ok(other)) if one == other => would_lose(path, "what this command reads"),
        _ => Ok(()),
    }
}

/// The refusal to replace a file.
///
/// # Errors
/// Always.
pub(crate) fn would_lose(path: &Path, what: impl Into<String>) -> Result<(), Failure> {
    Err(Failure::WouldLose { path: show(path), what: what.into() })
}

fn check_result(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if path.as_os_str() == "-" || !path.metadata().is_ok_and(|known| known.is_file()) {
        return Ok(());
    }
    if is_of_a_state(path) {
        return would_lose(path, "part of what a folder has learnt");
    }
    let known = beginning(path).map_err(|error| Failure::unreadable(path, error))?;
    let (old, new) = (Kind::of(&known), Kind::of(&bytes[..bytes.len().min(BEGINNING)]));
    if known.is_empty() || old == new {
        return Ok(());
    }
    would_lose(path, old.told())
}

/// Bytes by which a file is known for what it holds.
const BEGINNING: usize = 4096;

fn beginning(path: &Path) -> std::io::Result<Vec<u8>> {
    use std::io::Read;
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(BEGINNING as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// What a file holds, as its first bytes tell.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Kind {
    Picture,
    Parquet,
    Document,
    /// Its first word: "CRUISE-REPORT", "aircraft:".
    Text(String),
    /// The first column's name: tables that begin with another one are another table.
    Table(String),
}

impl Kind {
    fn of(bytes: &[u8]) -> Self {
        let starts = |with: &[&[u8]]| with.iter().any(|one| bytes.starts_with(one));
        if starts(&[b"PAR1"]) {
            return Self::Parquet;
        }
        if starts(&[b"\x89PNG", b"%PDF", b"<svg"]) {
            return Self::Picture;
        }
        let text = String::from_utf8_lossy(bytes);
        if text.trim_start().starts_with(['{', '[']) {
            return Self::Document;
        }
        let header = text.lines().next().unwrap_or_default();
        match header.trim_start_matches('\u{feff}').split_once(',') {
            Some((first, _)) if !first.contains(['(', ' ']) => Self::Table(first.to_owned()),
            _ => Self::Text(header.split_whitespace().next().unwrap_or_default().to_owned()),
        }
    }

    fn told(&self) -> String {
        match self {
            Self::Picture => "a picture".to_owned(),
            Self::Parquet => "a Parquet file".to_owned(),
            Self::Document => "a JSON document".to_owned(),
            Self::Text(first) => format!("another text, which begins with {first}"),
            Self::Table(first) => format!("another table, which begins with {first}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_made_by_the_command_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("M.ron");
        check_replaceable(&path, false, b"new", |_| false).unwrap();
        std::fs::write(&path, "old").unwrap();
        check_replaceable(&path, false, b"new", |_| false).unwrap_err();
        check_replaceable(&path, false, b"old", |_| false).unwrap();
        check_replaceable(&path, false, b"new", |text| text == "old").unwrap();
        check_replaceable(&path, true, b"new", |_| false).unwrap();
    }

    /// Each of these was replaced without a word once.
    #[test]
    fn a_result_replaces_results_of_its_kind_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("OUT.csv");
        let write = |bytes: &[u8]| write_result(&path, bytes);
        let table = b"mass_kg,mach\n1,0.8\n";
        write(table).unwrap();
        write(b"mass_kg,mach,fuel_flow_kg_h\n").unwrap();
        for other in ["tail,start\n", "<svg/>", "(format: 1,\n)", "{}"] {
            assert!(write(other.as_bytes()).is_err(), "{other}");
        }
        assert!(check_not_read(Some(&path), &path).is_err());
        let state = folder.path().join("STATE.ron");
        std::fs::write(&state, "").unwrap();
        assert!(write_result(&state, table).is_err());
        std::fs::create_dir(folder.path().join("segments")).unwrap();
        let segments = folder.path().join("segments/T.csv");
        std::fs::write(&segments, table).unwrap();
        assert!(write_result(&segments, table).is_err());
        std::fs::remove_file(&state).unwrap();
        write_result(&segments, table).unwrap();
    }
}
