//! What flights are compared with.

use effects::{EffectModel, EffectReferences};

use crate::baseline::Baseline;
use crate::input::Input;
use crate::signals::noise::{NoiseFactors, Statistics};
use crate::signals::references::DiagnoseError;

/// What flights are compared with, which also decides where their noise is known from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Reference<'a> {
    /// A table alone: the aircraft file states the noise.
    Table,
    /// A table whose remainder and noise are about to be learnt.
    Untaught,
    /// A table and what was learnt from clean flights, noise included.
    Baseline(&'a Baseline),
}

impl<'a> Reference<'a> {
    /// The baseline where there is one, else the table alone.
    pub(crate) fn from_baseline(baseline: Option<&'a Baseline>) -> Self {
        baseline.map_or(Self::Table, Self::Baseline)
    }

    pub(crate) fn baseline(self) -> Option<&'a Baseline> {
        match self {
            Self::Table | Self::Untaught => None,
            Self::Baseline(baseline) => Some(baseline),
        }
    }

    pub(crate) fn statistics(self, model: &EffectModel<'_>) -> Statistics {
        let factors = self.baseline().map_or_else(NoiseFactors::default, |b| *b.noise());
        Statistics::of(&factors, model.aircraft().sensors())
    }
}

impl<'a> Input<'a> {
    /// What flights are compared with.
    pub(crate) fn reference(&self) -> Reference<'a> {
        Reference::from_baseline(self.baseline)
    }

    /// The model with effects, its table between the nodes what it is said to be, or was when the baseline was learnt.
    pub(crate) fn effect_model(
        &self,
        references: EffectReferences,
    ) -> Result<EffectModel<'a>, DiagnoseError> {
        let model = EffectModel::new(self.model, self.drag_table, references)?;
        let between_nodes = self.baseline.map_or(self.between_nodes, Baseline::between_nodes);
        Ok(model.between_nodes(between_nodes))
    }
}
