//! Likely causes of an alert: what the newest `diagnosis.json` names, where a cause stands out there.

use std::path::Path;

use flight::effect::EffectId;
use monitor::AlertRule;
use pipeline::diagnosis_document::VerdictKind;
use pipeline::diagnosis_words::{NO_CAUSE_STANDS_OUT, stands_out};
use pipeline::monitoring::AlertDocument;
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
    #[serde(default)]
    causes: Vec<Cause>,
    compared: Compared,
}

/// An effect of the library, and the size that it has by itself.
#[derive(Debug, Deserialize)]
struct Cause {
    effect: String,
    magnitude: Magnitude,
}

#[derive(Debug, Deserialize)]
struct Magnitude {
    value: f64,
}

#[derive(Debug, Deserialize)]
struct Compared {
    #[serde(default)]
    flights_learnt: usize,
    /// The tail that they were of, where it is another.
    #[serde(default)]
    learnt_tail: Option<String>,
}

impl Compared {
    /// Whether the model had learnt the tail itself: it does not see what it learnt, and so not what the tail burns beyond its book.
    const fn is_own(&self) -> bool {
        self.flights_learnt > 0 && self.learnt_tail.is_none()
    }
}

#[derive(Debug, Deserialize)]
struct Verdict {
    kind: VerdictKind,
    #[serde(default)]
    effects: Vec<String>,
    #[serde(default)]
    class: Vec<String>,
    #[serde(default)]
    probability: f64,
}

/// Why a diagnosis against what a tail has learnt says nothing of what it burns beyond its book.
const OF_OWN_MODEL: &str = "the newest diagnosis is against the tail's own model, which has learnt what it burns beyond its book";

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

    /// Puts the likely causes of its tail into an alert: the class of effects that the diagnosis names, the named ones first,
    /// where it advises to act on one; else why it names none.
    pub(crate) fn explain(&self, alert: &mut AlertDocument) {
        let Some(found) = self.0.iter().find(|diagnosis| diagnosis.tail == alert.tail) else {
            alert.no_likely_cause = Some("this tail was not diagnosed".to_owned());
            return;
        };
        match found.of_alert(alert) {
            Ok(causes) => {
                alert.likely_causes_in_words =
                    causes.iter().map(|name| found.in_words(name)).collect();
                alert.likely_causes = causes;
            }
            Err(reason) => alert.no_likely_cause = Some(reason),
        }
    }
}

impl TailDiagnosis {
    /// An effect in words at the sign that was found, and its name.
    fn in_words(&self, name: &str) -> String {
        let cause = self.causes.iter().find(|one| one.effect == name);
        match (EffectId::from_name(name), cause) {
            (Some(effect), Some(cause)) => {
                format!("{} ({name})", effect.phrase(cause.magnitude.value))
            }
            _ => name.to_owned(),
        }
    }

    fn of_alert(&self, alert: &AlertDocument) -> Result<Vec<String>, String> {
        if is_of_deviation(alert) && self.compared.is_own() {
            return Err(OF_OWN_MODEL.to_owned());
        }
        let verdict = &self.verdict;
        match verdict.kind {
            VerdictKind::Effects if stands_out(verdict.probability) => {
                let mut named = verdict.effects.clone();
                for effect in &verdict.class {
                    if !named.contains(effect) {
                        named.push(effect.clone());
                    }
                }
                Ok(named)
            }
            VerdictKind::Effects => Err(format!(
                "{NO_CAUSE_STANDS_OUT}, the most probable has {:.2}",
                verdict.probability
            )),
            VerdictKind::NoGap => Err("no gap is seen by the model that was diagnosed".to_owned()),
            VerdictKind::OutsideLibrary => {
                Err("no effect of the library explains the gap".to_owned())
            }
            VerdictKind::InsufficientData => Err("too little data for a diagnosis".to_owned()),
        }
    }
}

/// Whether the alert's rule looks at what a tail burns beyond its book.
fn is_of_deviation(alert: &AlertDocument) -> bool {
    matches!(alert.rule.parse(), Ok(AlertRule::Deviation { .. }))
}
