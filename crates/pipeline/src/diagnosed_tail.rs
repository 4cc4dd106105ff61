//! A diagnosis with the tail that it is of: what the page, the terminal and `diagnosis.json` are made from.

use diagnose::Diagnosis;
use serde::{Deserialize, Serialize};

use crate::diagnosis_months::MonthGap;
use crate::diagnosis_words::note_words;
use crate::monitoring::Event;
use crate::summary::counted;

/// Name of a pool of all tails.
pub const POOL: &str = "*";

/// One tail's diagnosis.
#[derive(Clone, Debug, PartialEq)]
pub struct DiagnosedTail {
    /// Whose; [`POOL`] for a pool.
    pub tail: String,
    /// What was found.
    pub diagnosis: Diagnosis,
    /// The flights and the model.
    pub compared: Compared,
    /// The gap month by month.
    pub months: Vec<MonthGap>,
    /// What the run adds to the diagnosis' own notes: of the model, then of the reports.
    pub run_notes: Vec<String>,
}

/// Which flights were held against which model.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Compared {
    /// The aircraft of the model, as its file names it.
    pub aircraft: String,
    /// The law by which it learnt; `null` where it learnt nothing.
    pub law: Option<String>,
    /// Flights that it learnt.
    pub flights_learnt: usize,
    /// Of which tail they were, where it is another than the one that was diagnosed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub learnt_tail: Option<String>,
    /// START of the first flight that was diagnosed.
    pub first_flight: Option<String>,
    /// START of the last one.
    pub last_flight: Option<String>,
}

/// What a run was asked for, beside reports and models.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is an option of the command line and a key of diagnosis.json"
)]
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunOptions {
    /// Only these effects were looked for; empty for all.
    pub effects: Vec<String>,
    /// These were not.
    pub without: Vec<String>,
    /// All tails of a type together.
    pub pool: bool,
    /// All tails of a type compared with each other.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub fleet: bool,
    /// Against the table alone, whatever else the model has learnt.
    pub table_only: bool,
    /// Flights that the model has learnt were diagnosed too.
    pub allow_learnt: bool,
    /// What was done to the aircraft, and when: dates that are tried first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<Event>,
}

impl RunOptions {
    /// What an answer depends on, in words; empty where everything was looked for.
    pub fn restrictions(&self) -> Vec<String> {
        let mut told = Vec::new();
        if !self.effects.is_empty() {
            told.push(format!(
                "as asked, only these effects were looked for: {}; a probability is that among them",
                self.effects.join(", ")
            ));
        }
        if !self.without.is_empty() {
            told.push(format!(
                "as asked, these effects were left out: {}",
                self.without.join(", ")
            ));
        }
        told
    }

    /// What was asked for in words, with the trim criteria, for the page.
    pub fn in_words(&self, criteria: &str) -> Vec<String> {
        let mut words = vec![format!("trim criteria {criteria}")];
        if !self.effects.is_empty() {
            words.push(format!("only these effects looked for: {}", self.effects.join(", ")));
        }
        if !self.without.is_empty() {
            words.push(format!("not looked for: {}", self.without.join(", ")));
        }
        if !self.events.is_empty() {
            words.push(format!("{} given", counted(self.events.len(), "event")));
        }
        let modes = [
            (self.pool, "all tails of a type together (--pool)"),
            (self.fleet, "tails of a type compared with each other (--fleet)"),
            (self.table_only, "against the table alone (--table-only)"),
            (self.allow_learnt, "flights that the model has learnt included (--allow-learnt)"),
        ];
        words.extend(modes.iter().filter(|(is, _)| *is).map(|(_, words)| (*words).to_owned()));
        words
    }
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
