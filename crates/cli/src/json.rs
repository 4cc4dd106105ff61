//! The document of a run, where one is asked for.

use pipeline::summary::RefusedSummary;

use crate::args::JsonWanted;
use crate::commands::Outcome;
use crate::failure::Failure;
use crate::files::outputs::{check_replaceable, schema_of, would_lose};
use crate::files::write_atomically;
use crate::terminal;

/// Schema of the document of a command that has no other.
const SCHEMA: &str = "cruisefit.done/1";

/// Refuses to put a document in the place of another file, before anything is done: `--json` may swallow the name of a report.
///
/// # Errors
/// A file that would be lost.
pub(crate) fn check(wanted: JsonWanted<'_>) -> Result<(), Failure> {
    let JsonWanted::File(path) = wanted else { return Ok(()) };
    if path.is_dir() {
        return Err(Failure::unwritable(path, "it is a folder; --json takes the name of a file"));
    }
    let is_own = |text: &str| {
        let is_document = text.trim_start().starts_with(['{', '[']);
        text.is_empty() || (is_document && schema_of(text).starts_with("cruisefit."))
    };
    match check_replaceable(path, false, &[], is_own) {
        // There is no --force to advise.
        Err(Failure::WouldReplace { .. }) => {
            would_lose(path, "a file that was not made by this command")
        }
        checked => checked,
    }
}

/// Prints or writes the document of a run, and whether it got there: what the command wrote stays where standard output is full.
///
/// # Errors
/// A file that cannot be written.
pub(crate) fn deliver(wanted: JsonWanted<'_>, outcome: &Outcome) -> Result<bool, Failure> {
    if wanted == JsonWanted::No {
        return Ok(true);
    }
    let document = harmless(&outcome.json.clone().unwrap_or_else(|| of_text(outcome)));
    match wanted {
        JsonWanted::File(path) => write_atomically(path, &document).map(|()| true),
        _ => Ok(terminal::print_document(&document)),
    }
}

/// What a command without a document of its own did: its lines, its figures, and what was refused.
fn of_text(outcome: &Outcome) -> Vec<u8> {
    let refused: Vec<RefusedSummary> = outcome.refused.iter().map(RefusedSummary::from).collect();
    let lines: Vec<&str> = outcome.text.lines().collect();
    let mut document = serde_json::json!({ "schema": SCHEMA, "text": lines, "refused": refused });
    if !outcome.figures.is_null() {
        document["figures"] = outcome.figures.clone();
    }
    let mut bytes = serde_json::to_vec_pretty(&document).unwrap_or_default();
    bytes.push(b'\n');
    bytes
}

/// Characters that a terminal obeys as escapes of JSON: the reader gets them back, the terminal does not.
fn harmless(document: &[u8]) -> Vec<u8> {
    let Ok(text) = std::str::from_utf8(document) else { return document.to_vec() };
    let escaped = pipeline::csv_cell::without_controls_as(
        text,
        |letter| letter == '\n',
        |code| format!("\\u{code:04x}"),
    );
    escaped.into_owned().into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_reads_back_and_has_nothing_that_a_terminal_obeys() {
        let tail = "T\u{1b}[2J\u{9b}1m\u{202e}\u{7f}é";
        let document = serde_json::json!({ "tail": tail });
        let bytes = harmless(&serde_json::to_vec(&document).unwrap());
        let text = std::str::from_utf8(&bytes).unwrap();
        assert_eq!(terminal::neutral(text), text);
        assert_eq!(serde_json::from_str::<serde_json::Value>(text).unwrap()["tail"], tail);
    }

    #[test]
    fn a_report_is_not_replaced_by_a_document() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("0001.txt");
        write_atomically(&path, b"CRUISE-REPORT 1\n").unwrap();
        assert!(check(JsonWanted::File(&path)).is_err());
        assert!(check(JsonWanted::File(folder.path())).is_err());
        write_atomically(&path, b"{\"type\": \"FeatureCollection\"}\n").unwrap();
        assert!(check(JsonWanted::File(&path)).is_err());
        write_atomically(&path, b"{\"schema\": \"cruisefit.done/1\"}\n").unwrap();
        check(JsonWanted::File(&path)).unwrap();
    }
}
