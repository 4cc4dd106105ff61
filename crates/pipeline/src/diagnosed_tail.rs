//! A diagnosis with the tail that it is of: what the page, the terminal and `diagnosis.json` are made from.

use diagnose::Diagnosis;

use crate::diagnosis_words::note_words;

/// Name of a pool of all tails.
pub const POOL: &str = "*";

/// One tail's diagnosis.
#[derive(Clone, Debug, PartialEq)]
pub struct DiagnosedTail {
    /// Whose; [`POOL`] for a pool.
    pub tail: String,
    /// What was found.
    pub diagnosis: Diagnosis,
    /// What the run adds to the diagnosis' own notes: of the model, then of the reports.
    pub run_notes: Vec<String>,
}

impl DiagnosedTail {
    /// The tail's name; "All tails" for a pool.
    pub fn name(&self) -> &str {
        if self.tail == POOL { "All tails" } else { &self.tail }
    }

    /// Every note in words: those of the diagnosis, then those of the run.
    pub fn notes(&self) -> Vec<String> {
        let own = self.diagnosis.notes.iter().map(note_words);
        own.chain(self.run_notes.iter().cloned()).collect()
    }
}
