//! What a tail begins with: an initial model, a law with its settings, trim criteria.

use std::collections::BTreeMap;

use pipeline::checksum::sha256;
use pipeline::learning::{self, LawChoice};
use pipeline::model_file::{ModelFile, PaperSettings};

use crate::args::{AdaptArgs, LawName};
use crate::failure::{Failure, show};
use crate::folder::Folder;
use crate::models::{Models, NoModel};

/// What a tail begins with.
#[derive(Clone, Debug)]
pub(super) struct Start<'a> {
    /// The model as given, with what it may have learnt.
    pub(super) model: &'a ModelFile,
    law: LawChoice,
    criteria: &'a str,
    /// SHA-256 of all of it, by which a tail is known to have been begun alike.
    pub(super) begun: String,
}

impl Start<'_> {
    /// A model of a tail that has learnt nothing.
    ///
    /// # Errors
    /// An initial table that the law cannot correct.
    pub(super) fn fresh(&self, tail: &str) -> Result<ModelFile, Failure> {
        if let Some(learnt) = &self.model.learnt {
            tracing::warn!(
                tail,
                "the model given has learnt {} flights of tail {}; adaptation starts from its initial part{}",
                learnt.ledger.len(),
                learnt.tail,
                if self.model.applied.is_empty() { "" } else { " and the effects applied to it" }
            );
        }
        let learnt = learning::begin(&self.model.initial, tail, self.criteria, self.law).map_err(
            |error| Failure::BadArgument { argument: "--model", reason: error.to_string() },
        )?;
        Ok(ModelFile { learnt: Some(learnt), ..self.model.clone() })
    }
}

/// What the tails of a run begin with.
#[derive(Debug)]
pub(super) struct Starts<'a> {
    models: &'a Models,
    arguments: &'a AdaptArgs,
    /// SHA-256 of what the tails of a model begin with, by the model's place in memory.
    begun: BTreeMap<*const ModelFile, String>,
}

impl<'a> Starts<'a> {
    pub(super) const fn new(models: &'a Models, arguments: &'a AdaptArgs) -> Self {
        Self { models, arguments, begun: BTreeMap::new() }
    }

    /// What a report of this tail and type begins with.
    ///
    /// # Errors
    /// Why there is no model.
    pub(super) fn start(&mut self, tail: &str, aircraft_type: &str) -> Result<Start<'a>, NoModel> {
        let model = self.models.for_report(tail, aircraft_type)?;
        let law = match self.arguments.law {
            LawName::Bayes => LawChoice::Bayes(model.settings.bayes),
            LawName::Paper => LawChoice::Paper(PaperSettings {
                threshold_percent: self
                    .arguments
                    .threshold
                    .unwrap_or(model.settings.paper.threshold_percent),
            }),
        };
        let criteria = self.arguments.reports.criteria.as_str();
        let begun = self
            .begun
            .entry(std::ptr::from_ref(model))
            .or_insert_with(|| begun_of(model, &law, criteria))
            .clone();
        Ok(Start { model, law, criteria, begun })
    }

    /// A tail that the folder holds must have been begun with the same.
    ///
    /// # Errors
    /// What differs.
    pub(super) fn check_begun_alike(
        &self,
        folder: &Folder,
        tail: &str,
        start: &Start<'_>,
    ) -> Result<(), Failure> {
        if !folder.holds(tail) || folder.state_of(tail).is_some_and(|s| s.begun == start.begun) {
            return Ok(());
        }
        // A damaged tail is refused when its flights are.
        let Ok(stored) = folder.load(tail) else { return Ok(()) };
        let otherwise = |what, difference| Failure::BegunOtherwise {
            folder: show(&self.arguments.output),
            what,
            difference,
        };
        let fresh = start.fresh(tail)?;
        if let Some((what, difference)) = fresh.difference_of_initial(&stored.model) {
            return Err(otherwise(what, difference));
        }
        match fresh.difference_of_law(&stored.model) {
            Some(difference) => Err(otherwise("law or setting", difference)),
            None => Ok(()),
        }
    }
}

fn begun_of(model: &ModelFile, law: &LawChoice, criteria: &str) -> String {
    let initial = ModelFile { learnt: None, ..model.clone() };
    // Where the text cannot be made the model cannot be stored either, which is reported there.
    let initial = initial.to_text().unwrap_or_default();
    let law = match law {
        LawChoice::Paper(settings) => format!("paper {}", settings.threshold_percent),
        LawChoice::Bayes(_) => "bayes".to_owned(),
    };
    sha256(format!("{initial}\n{law}\n{criteria}\n").as_bytes())
}
