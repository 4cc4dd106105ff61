//! What a tail begins with: an initial model, a law with its settings, trim criteria.

use std::collections::BTreeMap;

use super::RemainderChoice;
use crate::checksum::sha256;
use crate::learning::{self, LawChoice, LearningError};
use crate::model_file::{ModelFile, PaperSettings};
use crate::summary::counted;

/// The law that tails are to learn by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LawAsked {
    /// Law `bayes`, with the settings of each model.
    Bayes,
    /// Law `paper`.
    Paper {
        /// Per cent; `None` for that of each model.
        threshold_percent: Option<f64>,
    },
}

/// What a tail begins with.
#[derive(Clone, Debug)]
pub struct Start<'a> {
    /// The model as given, with what it may have learnt.
    pub model: &'a ModelFile,
    law: LawChoice,
    criteria: &'a str,
    /// SHA-256 of all of it, by which a tail is known to have been begun alike.
    pub begun: String,
    remainder: RemainderChoice,
    /// The same of a tail for which the other choice was made; none by law `paper`, which has no remainder.
    with_other_choice: Option<String>,
}

impl Start<'_> {
    /// The law by which tails learn.
    pub(crate) const fn law(&self) -> &LawChoice {
        &self.law
    }

    /// Whether a tail that was begun with this (its SHA-256) was to learn its table alone, and would now learn more: what every
    /// prediction of it means would change.
    #[must_use]
    pub fn learns_more_than(&self, begun: &str) -> bool {
        self.remainder == RemainderChoice::Learn && self.is_other_choice(begun)
    }

    /// Whether a tail that was begun with this was to learn more than the table alone, which is what it would learn now.
    #[must_use]
    pub fn learns_less_than(&self, begun: &str) -> bool {
        self.remainder == RemainderChoice::Leave && self.is_other_choice(begun)
    }

    fn is_other_choice(&self, begun: &str) -> bool {
        self.with_other_choice.as_deref() == Some(begun)
    }

    /// A model of a tail that has learnt nothing.
    ///
    /// # Errors
    /// An initial table that the law cannot correct.
    pub fn fresh(&self, tail: &str) -> Result<ModelFile, LearningError> {
        if let Some(learnt) = &self.model.learnt {
            tracing::warn!(
                tail,
                "the model given has learnt {} of tail {}; adaptation starts from its initial part{}",
                counted(learnt.ledger.len(), "flight"),
                learnt.tail,
                if self.model.applied.is_empty() { "" } else { " and the effects applied to it" }
            );
        }
        let learnt = learning::begin(&self.model.initial, tail, self.criteria, self.law)?;
        Ok(ModelFile { learnt: Some(learnt), ..self.model.clone() })
    }

    /// What another tail of the same folder was begun with otherwise, that all tails of a folder have in common: law and trim criteria.
    pub fn difference_of_folder(&self, stored: &ModelFile) -> Option<(&'static str, String)> {
        let law = match self.law {
            LawChoice::Bayes(_) => "bayes",
            LawChoice::Paper(_) => "paper",
        };
        let (known_law, known_criteria) = stored.learns_by()?;
        if known_law != law {
            return Some(("law", format!("{known_law} against {law}")));
        }
        let differs = known_criteria != self.criteria;
        differs.then(|| {
            ("set of trim criteria", format!("{known_criteria} against {}", self.criteria))
        })
    }

    /// What a stored model of the tail was begun with otherwise, and both values; `None` where it was begun alike.
    ///
    /// # Errors
    /// As for [`Self::fresh`].
    pub fn difference(
        &self,
        tail: &str,
        stored: &ModelFile,
    ) -> Result<Option<(&'static str, String)>, LearningError> {
        let fresh = self.fresh(tail)?;
        Ok(fresh.difference_of_initial(stored).or_else(|| {
            fresh.difference_of_law(stored).map(|difference| ("law or setting", difference))
        }))
    }
}

/// What the tails of a run begin with.
#[derive(Debug)]
pub struct Starts<'a> {
    law: LawAsked,
    criteria: &'a str,
    remainder: RemainderChoice,
    /// What the tails of a model begin with, by the model's place in memory.
    begun: BTreeMap<*const ModelFile, Begun>,
}

/// SHA-256 of what a tail begins with.
#[derive(Clone, Debug)]
struct Begun {
    asked: String,
    /// Of one for which the other choice of a remainder was made.
    with_other_choice: Option<String>,
}

impl<'a> Starts<'a> {
    /// By this law and these trim criteria (the name of a preset).
    pub const fn new(law: LawAsked, criteria: &'a str, remainder: RemainderChoice) -> Self {
        Self { law, criteria, remainder, begun: BTreeMap::new() }
    }

    /// What the reports of a model begin with.
    pub fn of_model(&mut self, model: &'a ModelFile) -> Start<'a> {
        let law = match self.law {
            LawAsked::Bayes => LawChoice::Bayes(model.settings.bayes),
            LawAsked::Paper { threshold_percent } => LawChoice::Paper(PaperSettings {
                threshold_percent: threshold_percent
                    .unwrap_or(model.settings.paper.threshold_percent),
            }),
        };
        let (criteria, remainder) = (self.criteria, self.remainder);
        let Begun { asked, with_other_choice } = self
            .begun
            .entry(std::ptr::from_ref(model))
            .or_insert_with(|| Begun::of(model, &law, criteria, remainder))
            .clone();
        Start { model, law, criteria, begun: asked, remainder, with_other_choice }
    }
}

impl Begun {
    fn of(model: &ModelFile, law: &LawChoice, criteria: &str, remainder: RemainderChoice) -> Self {
        let initial = ModelFile { learnt: None, ..model.clone() };
        // Where the text cannot be made the model cannot be stored either, which is reported there.
        let initial = initial.to_text().unwrap_or_default();
        let sum = |law: &str| sha256(format!("{initial}\n{law}\n{criteria}\n").as_bytes());
        match (law, remainder) {
            // It has no remainder.
            (LawChoice::Paper(settings), _) => Self {
                asked: sum(&format!("paper {}", settings.threshold_percent)),
                with_other_choice: None,
            },
            (LawChoice::Bayes(_), RemainderChoice::Learn) => {
                Self { asked: sum("bayes"), with_other_choice: Some(sum(TABLE_ALONE)) }
            }
            (LawChoice::Bayes(_), RemainderChoice::Leave) => {
                Self { asked: sum(TABLE_ALONE), with_other_choice: Some(sum("bayes")) }
            }
        }
    }
}

/// What was chosen for a tail that is stored when it was begun with this (its SHA-256).
///
/// A model without a remainder does not tell: its flights may all lie outside the table, or, of programs that learnt a table from fewer
/// than three, be few.
#[must_use]
pub fn choice_of(stored: &ModelFile, begun: &str) -> RemainderChoice {
    let Some(learnt) = &stored.learnt else { return RemainderChoice::Learn };
    if learnt.baseline.is_some() {
        return RemainderChoice::Learn;
    }
    let law = LawChoice::Bayes(stored.settings.bayes);
    let all = Begun::of(stored, &law, &learnt.criteria, RemainderChoice::Learn);
    if all.asked == begun { RemainderChoice::Learn } else { RemainderChoice::Leave }
}

/// Law `bayes` that learns the table alone, in what a tail was begun with.
const TABLE_ALONE: &str = "bayes, the table alone";
