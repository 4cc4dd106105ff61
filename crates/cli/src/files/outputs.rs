//! Files that a command may replace, and those that it leaves alone unless it is told to.

use std::path::Path;

use crate::failure::{Failure, show};
use crate::files::write_atomically;
use crate::folder::is_of_a_state;
use crate::parquet_batches::names_of_file;

/// Refuses to replace a file that holds something else than what the command makes.
///
/// `own` decides, from the file's text, whether the command may replace it; a file with the very bytes that would be
/// written may always be replaced, what a folder has learnt never. Devices and pipes hold nothing.
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
    check_no_state(path)?;
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
    check_result(path, bytes, &[])?;
    write_atomically(path, bytes)
}

/// The same of a Parquet file with columns of these names.
///
/// # Errors
/// As those of [`write_result`].
pub(crate) fn write_parquet(path: &Path, bytes: &[u8], names: &[&str]) -> Result<(), Failure> {
    check_result(path, bytes, names)?;
    write_atomically(path, bytes)
}

/// Refuses to write over what a folder has learnt, whatever is said.
///
/// # Errors
/// A file that would be lost.
pub(crate) fn check_no_state(path: &Path) -> Result<(), Failure> {
    if path.is_file() && is_of_a_state(path) {
        return would_lose(path, "part of what a folder has learnt");
    }
    Ok(())
}

/// Refuses to put a table with columns of these names, CSV or Parquet, in the place of something else.
///
/// # Errors
/// A file that would be lost.
pub(crate) fn check_table(path: &Path, names: &[&str]) -> Result<(), Failure> {
    check_result(path, names.join(",").as_bytes(), names)
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

fn check_result(path: &Path, bytes: &[u8], names: &[&str]) -> Result<(), Failure> {
    if path.as_os_str() == "-" || !path.metadata().is_ok_and(|known| known.is_file()) {
        return Ok(());
    }
    check_no_state(path)?;
    let known = beginning(path).map_err(|error| Failure::unreadable(path, error))?;
    let old = Kind::of(&known);
    let is_alike = match &old {
        // One whose columns cannot be read is nobody's result.
        Kind::Parquet => names_of_file(path).is_ok_and(|known| {
            begin_alike(known.iter().map(String::as_str), names.iter().copied())
        }),
        _ => old.is_like(&Kind::of(&bytes[..bytes.len().min(BEGINNING)])),
    };
    if known.is_empty() || is_alike {
        return Ok(());
    }
    would_lose(path, old.told())
}

/// Whether two tables begin with the same columns, as far as both have them.
fn begin_alike<'a>(
    one: impl IntoIterator<Item = &'a str>,
    other: impl IntoIterator<Item = &'a str>,
) -> bool {
    one.into_iter().zip(other).take(COLUMNS_ALIKE).all(|(one, other)| one == other)
}

/// Columns by which a table is known: those of one command may have more or fewer behind them, by its options.
const COLUMNS_ALIKE: usize = 3;

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
    /// Its schema without the version; its first field where it names none.
    Document(String),
    /// Its first word: "CRUISE-REPORT", "aircraft:".
    Text(String),
    /// Its columns' names: tables that begin with others are other tables.
    Table(Vec<String>),
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
            return Self::Document(schema_of(&text).to_owned());
        }
        let header = text.lines().next().unwrap_or_default();
        let names: Vec<&str> = header.trim_start_matches('\u{feff}').split(',').collect();
        if names.len() > 1 && !names[0].contains(['(', ' ']) {
            return Self::Table(names.into_iter().map(str::to_owned).collect());
        }
        Self::Text(header.split_whitespace().next().unwrap_or_default().to_owned())
    }

    fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Table(one), Self::Table(other)) => {
                begin_alike(one.iter().map(String::as_str), other.iter().map(String::as_str))
            }
            _ => self == other,
        }
    }

    fn told(&self) -> String {
        match self {
            Self::Picture => "a picture".to_owned(),
            Self::Parquet => "a Parquet file of other columns".to_owned(),
            Self::Document(what) => format!("another JSON document, of {what}"),
            Self::Text(first) => format!("another text, which begins with {first}"),
            Self::Table(names) => {
                let first = &names[..names.len().min(COLUMNS_ALIKE)];
                format!("another table, which begins with {}", first.join(","))
            }
        }
    }
}

/// What a JSON document says that it is: `cruisefit.optimum` of `"schema": "cruisefit.optimum/1"`, else its first field.
pub(crate) fn schema_of(text: &str) -> &str {
    let schema = text.split_once("\"schema\"").and_then(|(_, rest)| first_quoted(rest));
    match schema {
        Some(named) => named.split('/').next().unwrap_or(named),
        None => first_quoted(text).unwrap_or("no field"),
    }
}

fn first_quoted(text: &str) -> Option<&str> {
    text.split('"').nth(1)
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
        // What a folder has learnt stays, whatever is said.
        std::fs::create_dir(folder.path().join("models")).unwrap();
        std::fs::write(folder.path().join("STATE.ron"), "").unwrap();
        let learnt = folder.path().join("models/T.ron");
        std::fs::write(&learnt, "old").unwrap();
        check_replaceable(&learnt, true, b"new", |_| true).unwrap_err();
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
        for other in ["tail,start\n", "mass_kg,owner\n", "<svg/>", "(format: 1,\n)", "{}"] {
            assert!(write(other.as_bytes()).is_err(), "{other}");
        }
        let json = folder.path().join("OUT.json");
        std::fs::write(&json, r#"{"schema": "cruisefit.summary/3"}"#).unwrap();
        write_result(&json, br#"{"schema": "cruisefit.summary/4"}"#).unwrap();
        for other in [r#"{"schema": "cruisefit.optimum/1"}"#, r#"{"type": "x"}"#, "[]"] {
            assert!(write_result(&json, other.as_bytes()).is_err(), "{other}");
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
