//! Likely causes of an alert: what the newest `diagnosis.json` names.

use std::path::Path;

use serde::Deserialize;

use crate::failure::Failure;
use crate::files::read_text;

/// What is read of `diagnosis.json`.
#[derive(Debug, Deserialize)]
struct DiagnosisFile {
    diagnoses: Vec<TailDiagnosis>,
}

#[derive(Debug, Deserialize)]
struct TailDiagnosis {
    tail: String,
    verdict: Verdict,
}

#[derive(Debug, Deserialize)]
struct Verdict {
    kind: String,
    #[serde(default)]
    effects: Vec<String>,
    #[serde(default)]
    class: Vec<String>,
}

/// The diagnoses of a file.
#[derive(Debug)]
pub(crate) struct Causes(Vec<TailDiagnosis>);

impl Causes {
    /// Reads `diagnosis.json`, or the one in a folder.
    ///
    /// # Errors
    /// A file that cannot be read or is not a diagnosis.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let path = if path.is_dir() { path.join("diagnosis.json") } else { path.to_owned() };
        let file: DiagnosisFile = serde_json::from_str(&read_text(&path)?)
            .map_err(|error| Failure::bad_file(&path, error))?;
        Ok(Self(file.diagnoses))
    }

    /// The class of effects that the diagnosis of a tail names, the named ones first; its kind of verdict where it names
    /// none; nothing where the tail was not diagnosed.
    pub(crate) fn of_tail(&self, tail: &str) -> Vec<String> {
        let Some(found) = self.0.iter().find(|diagnosis| diagnosis.tail == tail) else {
            return Vec::new();
        };
        let mut named = found.verdict.effects.clone();
        for effect in &found.verdict.class {
            if !named.contains(effect) {
                named.push(effect.clone());
            }
        }
        if named.is_empty() {
            named.push(found.verdict.kind.clone());
        }
        named
    }
}
