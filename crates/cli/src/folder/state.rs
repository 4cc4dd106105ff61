//! `STATE.ron`: which files are the state of a folder, by their SHA-256.
//!
//! BE ADVISED: a folder is used for years, by older and newer programs. `format` counts up when the meaning of a field
//! changes; a field may be added with a default. The last field is a checksum of all bytes before it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use pipeline::checksum::sha256;
use pipeline::summary::TailSummary;
use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};

use crate::failure::Failure;
use crate::files::{TEMPORARY, read_text};

/// Name of the file.
pub(crate) const NAME: &str = "STATE.ron";

/// The format that this program writes.
const FORMAT: u32 = 1;

/// Begins the last field.
const CHECKSUM: &str = "\n    checksum: \"";

/// The state of a folder.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct State {
    /// Counts up with every change; 0 where nothing was stored yet.
    pub(crate) generation: u64,
    /// The files of each tail.
    pub(crate) tails: BTreeMap<String, TailState>,
}

/// The files of a tail, and what a run needs to know of a tail to which it adds nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TailState {
    /// SHA-256 of what the tail was begun with: initial model, law, settings, trim criteria.
    pub(crate) begun: String,
    /// Its model.
    pub(crate) model: FileState,
    /// Every segment that it has learnt.
    pub(crate) segments: FileState,
    /// Every flight that it has learnt.
    pub(crate) flights: FileState,
    /// Its figures.
    pub(crate) summary: TailSummary,
}

/// A file of the state.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FileState {
    /// Path below the folder.
    pub(crate) file: String,
    /// SHA-256 of its bytes.
    pub(crate) sha256: String,
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

impl State {
    /// The state of a folder; `None` where the folder has no `STATE.ron`.
    ///
    /// # Errors
    /// A file that cannot be read, is damaged, or is of a newer format.
    pub(crate) fn read(folder: &Path) -> Result<Option<Self>, Failure> {
        let path = folder.join(NAME);
        if !path.exists() {
            return Ok(None);
        }
        let text = read_text(&path)?;
        Self::parse(&text).map(Some).map_err(|reason| Failure::BadFile {
            path: crate::failure::show(&path),
            reason,
            help: Some(
                "take the file from a backup of the folder; without STATE.ron the folder is read as one of an older \
                 program, from models/ and segments/"
                    .to_owned(),
            ),
        })
    }

    fn parse(text: &str) -> Result<Self, String> {
        let end = text.rfind(CHECKSUM).ok_or("it has no checksum: it is cut off")?;
        let found = text[end + CHECKSUM.len()..].split('"').next().unwrap_or_default();
        let computed = checksum(&text[..end]);
        if found != computed {
            return Err(format!(
                "checksum {found} does not match the content ({computed}): the file was changed or damaged"
            ));
        }
        let document: Document = ron::from_str(text).map_err(|error| error.to_string())?;
        if document.format > FORMAT {
            return Err(format!("format {}, this program reads up to {FORMAT}", document.format));
        }
        Ok(Self { generation: document.generation, tails: document.tails })
    }

    /// The text of the file.
    ///
    /// # Errors
    /// None that is known: what RON refuses to write.
    pub(crate) fn to_text(&self) -> Result<String, ron::Error> {
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

    /// The folder in which files of this generation wait until each has its place.
    pub(crate) fn waiting(&self, folder: &Path) -> PathBuf {
        waiting_of(folder, self.generation)
    }

    /// The bytes of a file of the state.
    ///
    /// # Errors
    /// A file that cannot be read, or whose SHA-256 is not that of the state.
    pub(crate) fn bytes_of(&self, folder: &Path, file: &FileState) -> Result<Vec<u8>, Failure> {
        let path = folder.join(&file.file);
        // In this order: a file moves from the waiting folder to its place.
        let bytes = std::fs::read(self.waiting(folder).join(&file.file))
            .or_else(|_| std::fs::read(&path))
            .map_err(|error| Failure::unreadable(&path, error))?;
        if sha256(&bytes) == file.sha256 {
            return Ok(bytes);
        }
        Err(Failure::BadFile {
            path: crate::failure::show(&path),
            reason: "its SHA-256 is not that of STATE.ron: it was changed or damaged".to_owned(),
            help: Some(
                "take it from a backup, or adapt again from the reports into another folder"
                    .to_owned(),
            ),
        })
    }
}

/// The folder in which files of a generation wait.
pub(crate) fn waiting_of(folder: &Path, generation: u64) -> PathBuf {
    folder.join(format!("{TEMPORARY}next-{generation}"))
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
        let file =
            |file: &str| FileState { file: file.to_owned(), sha256: sha256(file.as_bytes()) };
        let json = r#"{"tail": "T, \"1\"", "flights": 3, "flights_new": 0, "samples": 9, "segments": 2, "outside_table": 0,
            "informed_nodes": 0.1, "refits": 1, "fuel_flow_error_percent": {"before": {"mean": 0.25, "std": null,
            "max_abs": 1.5, "n": 2}}}"#;
        let tail = TailState {
            begun: sha256(b"begun"),
            model: file("models/T.ron"),
            segments: file("segments/T.csv"),
            flights: file("flights/T.csv"),
            summary: serde_json::from_str(json).unwrap(),
        };
        state.tails.insert("T, \"1\"".to_owned(), tail);
        let text = state.to_text().unwrap();
        assert_eq!(State::parse(&text).unwrap(), state);
        let changed = text.replacen("generation: 7", "generation: 8", 1);
        assert!(State::parse(&changed).unwrap_err().contains("changed or damaged"));
        assert!(State::parse(&text[..text.len() / 2]).is_err());
    }
}
