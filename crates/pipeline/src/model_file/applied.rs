//! Effects of diagnoses that a model file contains, and from where.

use std::fmt::Write;

use diagnose::{AddedEffect, Addition};
use effects::{AppliedEffects, EffectModelError};
use flight::effect::{EffectId, HiddenParameter};
use serde::{Deserialize, Serialize};

use super::ModelFile;
use crate::addition_record::{AdditionRecord, UnknownEffect, effect_of};
use crate::diagnosed_tail::POOL;
use crate::diagnosis_words::applied_form_words;
use crate::summary::counted;

/// What one diagnosis added to the model.
#[derive(Clone, Debug, PartialEq)]
pub struct AppliedRecord {
    /// Effects with sizes and hidden parameters, and what they are zero at.
    pub addition: Addition,
    /// Where they come from.
    pub diagnosis: DiagnosisRecord,
}

/// [`AppliedRecord`] as a model file has it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "AppliedRecord")]
pub(super) struct AppliedText {
    addition: AdditionRecord,
    diagnosis: DiagnosisRecord,
}

/// A diagnosis that was applied.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiagnosisRecord {
    /// Whose; `*` for a pool.
    pub tail: String,
    /// Flights that were diagnosed.
    pub flights: u64,
    /// Their segments.
    pub segments: u64,
    /// START of the first of them.
    pub first: String,
    /// START of the last of them.
    pub last: String,
    /// Probability of the first effect, or of a cause outside the library.
    pub probability: f64,
    /// Effects that the flights could not distinguish from it.
    #[serde(with = "effect_names")]
    pub class: Vec<EffectId>,
}

/// Effects by their names.
mod effect_names {
    use flight::effect::EffectId;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(class: &[EffectId], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(class.iter().map(ToString::to_string))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<Vec<EffectId>, D::Error> {
        let names = Vec::<String>::deserialize(from)?;
        names.iter().map(|name| super::effect_of(name).map_err(serde::de::Error::custom)).collect()
    }
}

impl From<&AppliedRecord> for AppliedText {
    fn from(record: &AppliedRecord) -> Self {
        Self {
            addition: AdditionRecord::from(&record.addition),
            diagnosis: record.diagnosis.clone(),
        }
    }
}

impl TryFrom<AppliedText> for AppliedRecord {
    type Error = UnknownEffect;

    fn try_from(text: AppliedText) -> Result<Self, UnknownEffect> {
        Ok(Self { addition: Addition::try_from(text.addition)?, diagnosis: text.diagnosis })
    }
}

impl AppliedRecord {
    /// The effects with sizes and units, in words.
    pub fn told(&self) -> String {
        let effects = self.addition.effects.iter().map(told);
        let form = self.addition.form.iter().map(applied_form_words);
        effects.chain(form).collect::<Vec<_>>().join(" and ")
    }
}

/// One effect with size and unit, in words.
fn told(added: &AddedEffect) -> String {
    let unit = added.effect.entry().unit;
    let mut words =
        format!("{} {:+.4} ± {:.4} {unit}", added.effect, added.size, added.standard_deviation);
    // Writing to a string cannot fail.
    let _ = match added.hidden {
        HiddenParameter::None => Ok(()),
        HiddenParameter::Step { from_s, target } => {
            #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
            let from = flight::Timestamp::from_second(from_s as i64)
                .map_or_else(|_| from_s.to_string(), |instant| instant.to_string());
            write!(words, ", from {from} on, of {}", target.words())
        }
        hidden => write!(words, ", {hidden}"),
    };
    words
}

/// Applied effects as the performance model takes them.
pub(super) fn layers_of(applied: &[AppliedRecord]) -> AppliedEffects {
    AppliedEffects::new(applied.iter().map(|record| record.addition.layer()).collect())
}

impl ModelFile {
    /// The model with the effects of one more diagnosis.
    ///
    /// # Errors
    /// An effect that the model cannot take.
    pub fn extended(&self, record: AppliedRecord) -> Result<Self, EffectModelError> {
        let mut applied = self.applied.clone();
        applied.push(record);
        let initial = self.initial.with_effects(layers_of(&applied))?;
        let by_guide = self
            .by_guide
            .as_deref()
            .map(|model| model.with_effects(layers_of(&applied)).map(Box::new))
            .transpose()?;
        Ok(Self { initial, applied, by_guide, ..self.clone() })
    }

    /// The tail that the model is of: whose diagnosis was applied to it, else whose flights it has learnt.
    pub fn tail(&self) -> Option<&str> {
        let learnt = self.learnt.as_ref().map(|learnt| learnt.tail.as_str());
        self.tail_of_effects().or(learnt)
    }

    /// The tail whose diagnosis was applied to it last; `None` without one, or where that was of a pool of tails.
    pub fn tail_of_effects(&self) -> Option<&str> {
        let applied = self.applied.last().map(|record| record.diagnosis.tail.as_str());
        applied.filter(|tail| *tail != POOL)
    }

    /// What it has learnt, and the effects that it contains: "law bayes, 30 flights of N750CF learnt".
    pub fn told(&self) -> String {
        let learnt = match &self.learnt {
            Some(learnt) => format!(
                "{}, {} of {} learnt",
                learnt.law.told(),
                counted(learnt.ledger.len(), "flight"),
                learnt.tail
            ),
            None => "initial model, which has learnt no flight".to_owned(),
        };
        if self.applied.is_empty() {
            return learnt;
        }
        format!("{learnt}; contains {}", self.told_effects())
    }

    /// The effects that the model contains in words; "none" for none.
    pub fn told_effects(&self) -> String {
        if self.applied.is_empty() {
            return "none".to_owned();
        }
        self.applied.iter().map(AppliedRecord::told).collect::<Vec<_>>().join("; ")
    }

    /// What to print about the effects where recordings are compared with the model; `None` without any.
    pub fn note_of_effects(&self) -> Option<String> {
        (!self.applied.is_empty())
            .then(|| format!("the model contains applied effects: {}", self.told_effects()))
    }
}
