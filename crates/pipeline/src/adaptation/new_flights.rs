//! The flights that a run adds to a tail's learning curve.

use std::borrow::Cow;
use std::collections::BTreeMap;

use flight::Segment;

use crate::learning::{LearningAgain, LearningCurve, LearningError, continue_curve};
use crate::model_file::{LawState, ModelFile};

/// The flights that a tail learns in this run, for its learning curve.
pub(super) struct NewFlights {
    /// What had been learnt before.
    begun: Option<LawState>,
    /// Segments of each flight.
    counts: Vec<usize>,
    /// Segments of flights whose date was taken for an error, by the place of the flight.
    moved: BTreeMap<usize, Vec<Segment>>,
}

impl NewFlights {
    pub(super) fn after(model: &ModelFile) -> Self {
        let begun = model.learnt.as_ref().map(|learnt| learnt.law.clone());
        Self { begun, counts: Vec::new(), moved: BTreeMap::new() }
    }

    /// A flight was learnt: as what, and as it was recorded.
    pub(super) fn learnt(&mut self, as_dated: Cow<'_, [Segment]>, recorded: &[Segment]) {
        if let Cow::Owned(moved) = as_dated {
            self.moved.insert(self.counts.len(), moved);
        }
        self.counts.push(recorded.len());
    }

    /// The curve with these flights, whose segments are the last of these; `None` where what was learnt cannot be learnt again.
    /// The model does not need it.
    pub(super) fn curve(
        self,
        model: &ModelFile,
        curve: LearningCurve,
        segments: &[Segment],
    ) -> Option<LearningCurve> {
        self.continued(model, curve, segments)
            .inspect_err(|error| tracing::warn!("what was learnt cannot be learnt again: {error}"))
            .ok()
    }

    fn continued(
        self,
        model: &ModelFile,
        mut curve: LearningCurve,
        segments: &[Segment],
    ) -> Result<LearningCurve, LearningError> {
        let (Some(begun), Some(now)) = (self.begun, &model.learnt) else { return Ok(curve) };
        let mut rest = &segments[segments.len() - self.counts.iter().sum::<usize>()..];
        let flights = self.counts.iter().enumerate().map(|(place, count)| {
            let (recorded, others) = rest.split_at(*count);
            rest = others;
            (recorded, self.moved.get(&place).map_or(recorded, Vec::as_slice))
        });
        let again = LearningAgain::from(&model.initial, begun, &now.law)?;
        continue_curve(&mut curve, again, flights)?;
        Ok(curve)
    }
}
