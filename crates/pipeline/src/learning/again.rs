//! A model's flights, learnt again one by one: what it knew before each of them.

use std::borrow::Cow;

use adapt::bayes::DragTables;
use effects::ExtendedModel;
use flight::{Observation, Segment};
use lut::Table;

use super::{LawChoice, LearningError, begin, learn_observations, observed};
use crate::model_file::{LawState, Learnt, ModelFile};

/// A model's tail as it was before it learnt anything, by the same law and settings; `None` for an initial model.
///
/// # Errors
/// As for [`begin`].
pub fn begin_again(model: &ModelFile) -> Result<Option<Learnt>, LearningError> {
    let Some(learnt) = &model.learnt else { return Ok(None) };
    let law = match &learnt.law {
        LawState::Paper { settings, .. } => LawChoice::Paper(*settings),
        LawState::Bayes { .. } => LawChoice::Bayes(model.settings.bayes),
    };
    begin(&model.initial, &learnt.tail, &learnt.criteria, law).map(Some)
}

/// A tail on the way to what its model has learnt. Exact where it learns the same flights in the same order.
pub(crate) struct LearningAgain<'m> {
    initial: &'m ExtendedModel,
    law: LawState,
    /// The tables that law `bayes` goes through.
    tables: Option<DragTables>,
}

impl<'m> LearningAgain<'m> {
    /// Before the first flight; `None` for an initial model.
    ///
    /// # Errors
    /// As for [`begin_again`] and [`DragTables::new`].
    pub(crate) fn new(model: &'m ModelFile) -> Result<Option<Self>, LearningError> {
        let (Some(begun), Some(learnt)) = (begin_again(model)?, &model.learnt) else {
            return Ok(None);
        };
        Self::from(&model.initial, begun.law, &learnt.law).map(Some)
    }

    /// Goes on from what a tail had learnt to what it has learnt now.
    ///
    /// # Errors
    /// As for [`DragTables::new`].
    pub(crate) fn from(
        initial: &'m ExtendedModel,
        begun: LawState,
        now: &LawState,
    ) -> Result<Self, LearningError> {
        let tables = match now {
            LawState::Paper { .. } => None,
            LawState::Bayes { state, .. } => Some(DragTables::new(state)?),
        };
        Ok(Self { initial, law: begun, tables })
    }

    /// The model that the tail began with.
    pub(crate) const fn initial(&self) -> &'m ExtendedModel {
        self.initial
    }

    /// The drag table now.
    ///
    /// # Errors
    /// As for [`DragTables::drag`].
    pub(crate) fn table(&self) -> Result<Cow<'_, Table>, LearningError> {
        Ok(match (&self.tables, &self.law) {
            (Some(tables), LawState::Bayes { state, .. }) => Cow::Owned(tables.drag(state)?),
            (_, law) => Cow::Borrowed(law.drag_coefficient()),
        })
    }

    /// Learns the next flight.
    ///
    /// # Errors
    /// As for [`learn_flight`](super::learn_flight), which do not happen on flights that were learnt before.
    pub(crate) fn learn(&mut self, segments: &[Segment]) -> Result<(), LearningError> {
        self.learn_observed(&self.observe(segments))
    }

    /// What segments say of drag; `None` of those that say nothing.
    pub(super) fn observe(&self, segments: &[Segment]) -> Vec<Option<Observation>> {
        segments.iter().map(|segment| Some(observed(self.initial, segment)?.0)).collect()
    }

    /// Learns the next flight, whose segments say this.
    ///
    /// # Errors
    /// As for [`learn`](Self::learn).
    pub(super) fn learn_observed(
        &mut self,
        observations: &[Option<Observation>],
    ) -> Result<(), LearningError> {
        let observations: Vec<Observation> = observations.iter().flatten().copied().collect();
        learn_observations(self.initial, &mut self.law, &observations)?;
        Ok(())
    }
}
