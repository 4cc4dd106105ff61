//! `STATE.ron`: which files are the state of a folder, by their SHA-256.
//!
//! BE ADVISED: a folder is used for years, by older and newer programs. `format` counts up when the meaning of a field
//! changes; a field may be added with a default. The last field is a checksum of all bytes before it.

use std::collections::BTreeMap;

use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};

use crate::checksum::sha256;
use crate::evaluation::TailResult;
use crate::summary::TailSummary;

/// Name of the file.
pub const NAME: &str = "STATE.ron";

/// Folders of the files of tails that a state names, and of the pages of tails, beside the state.
pub const FOLDERS: [&str; 5] = ["models", "segments", "flights", "deviations", "pages"];

/// The format that this program writes.
const FORMAT: u32 = 1;

/// Begins the last field.
const CHECKSUM: &str = "\n    checksum: \"";

/// The state of a folder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Counts up with every change; 0 where nothing was stored yet.
    pub generation: u64,
    /// The files of each tail.
    pub tails: BTreeMap<String, TailState>,
}

/// The files of a tail, and what a run needs to know of a tail to which it adds nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TailState {
    /// SHA-256 of what the tail was begun with: initial model, law, settings, trim criteria.
    pub begun: String,
    /// Its model.
    pub model: FileState,
    /// Every segment that it has learnt.
    pub segments: FileState,
    /// Every flight that it has learnt.
    pub flights: FileState,
    /// What each flight shows, for `monitor`; `None` of a tail that an older program stored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviations: Option<DeviationsState>,
    /// Its figures.
    pub summary: TailSummary,
}

/// What each flight of a tail shows, and what has to be known of the tail beside it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviationsState {
    /// The table of flights.
    pub file: FileState,
    /// Type code of the aircraft.
    pub aircraft_type: String,
    /// What the model has learnt, in words.
    pub model: String,
}

/// A file of the state.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileState {
    /// Path below the folder.
    pub file: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
}

impl DeviationsState {
    /// Of a tail at the end of a run, whose table of flights is in this file.
    pub fn of(file: FileState, result: &TailResult) -> Self {
        let aircraft_type = result.model.initial.aircraft().type_code().to_owned();
        Self { file, aircraft_type, model: result.model.told() }
    }
}

impl FileState {
    /// A file with these bytes.
    pub fn of(file: &str, bytes: &[u8]) -> Self {
        Self { file: file.to_owned(), sha256: sha256(bytes) }
    }

    /// Whether these are the bytes that the state names.
    pub fn names(&self, bytes: &[u8]) -> bool {
        sha256(bytes) == self.sha256
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: u32,
    generation: u64,
    tails: BTreeMap<String, TailState>,
    #[serde(default)]
    checksum: String,
}

/// Why a text is not the state of a folder.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderStateError {
    /// No checksum at the end.
    #[error("it has no checksum: it is cut off")]
    CutOff,
    /// The bytes are not those that were written.
    #[error(
        "checksum {found} does not match the content ({computed}): the file was changed or damaged"
    )]
    Damaged {
        /// As written in the file.
        found: String,
        /// Of the bytes before it.
        computed: String,
    },
    /// Not what the file holds.
    #[error(transparent)]
    Syntax(#[from] ron::error::SpannedError),
    /// Written by a newer program.
    #[error("format {found}, this program reads up to {FORMAT}")]
    Newer {
        /// Its format.
        found: u32,
    },
}

impl State {
    /// The state that a text holds.
    ///
    /// # Errors
    /// A text that was cut off or changed, or is of a newer format.
    pub fn from_text(text: &str) -> Result<Self, FolderStateError> {
        let end = text.rfind(CHECKSUM).ok_or(FolderStateError::CutOff)?;
        let found = text[end + CHECKSUM.len()..].split('"').next().unwrap_or_default();
        let computed = checksum(&text[..end]);
        if found != computed {
            return Err(FolderStateError::Damaged { found: found.to_owned(), computed });
        }
        let document: Document = ron::from_str(text)?;
        if document.format > FORMAT {
            return Err(FolderStateError::Newer { found: document.format });
        }
        Ok(Self { generation: document.generation, tails: document.tails })
    }

    /// The text of the file.
    ///
    /// # Errors
    /// None that is known: what RON refuses to write.
    pub fn to_text(&self) -> Result<String, ron::Error> {
        let document = Document {
            format: FORMAT,
            generation: self.generation,
            tails: self.tails.clone(),
            checksum: String::new(),
        };
        let config = PrettyConfig::new().compact_structs(false).new_line("\n");
        let text = ron::ser::to_string_pretty(&document, config)?;
        let Some(end) = text.rfind(CHECKSUM) else { return Ok(text) };
        let body = &text[..end];
        Ok(format!("{body}{CHECKSUM}{}\",\n)\n", checksum(body)))
    }
}

fn checksum(body: &str) -> String {
    format!("sha256:{}", sha256(body.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_reads_back_and_a_changed_digit_is_noticed() {
        let mut state = State { generation: 7, tails: BTreeMap::new() };
        let file = |file: &str| FileState::of(file, file.as_bytes());
        let json = r#"{"tail": "T, \"1\"", "flights": 3, "flights_new": 0, "samples": 9, "segments": 2, "outside_table": 0,
            "informed_nodes": 0.1, "refits": 1, "fuel_flow_error_percent": {"before": {"mean": 0.25, "std": null,
            "max_abs": 1.5, "n": 2}}}"#;
        let tail = TailState {
            begun: sha256(b"begun"),
            model: file("models/T.ron"),
            segments: file("segments/T.csv"),
            flights: file("flights/T.csv"),
            deviations: Some(DeviationsState {
                file: file("deviations/T.csv"),
                aircraft_type: "SIM".to_owned(),
                model: "3 flights".to_owned(),
            }),
            summary: serde_json::from_str(json).unwrap(),
        };
        state.tails.insert("T, \"1\"".to_owned(), tail);
        let text = state.to_text().unwrap();
        assert_eq!(State::from_text(&text).unwrap(), state);
        let changed = text.replacen("generation: 7", "generation: 8", 1);
        assert!(State::from_text(&changed).unwrap_err().to_string().contains("changed or damaged"));
        assert!(State::from_text(&text[..text.len() / 2]).is_err());
        // As older programs wrote it.
        state.tails.values_mut().for_each(|tail| tail.deviations = None);
        let text = state.to_text().unwrap();
        assert!(!text.contains("deviations"));
        assert_eq!(State::from_text(&text).unwrap(), state);
    }
}
