//! What flights are held against.

use effects::EffectModel;
use perf_model::aircraft::{FlightBias, FuelFlowDrift};

use crate::baseline::Baseline;
use crate::signals::noise::{NoiseFactors, Statistics};

/// What flights are held against, and with it where their noise is known from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Against<'a> {
    /// A table alone: the aircraft file states the noise.
    Table,
    /// A table whose remainder and noise are about to be learnt.
    NothingYet,
    /// A table and what it was taught of clean flights, noise included.
    Baseline(&'a Baseline),
}

impl<'a> Against<'a> {
    /// What was taught, where there is something; else the table.
    pub(crate) fn taught_or_table(baseline: Option<&'a Baseline>) -> Self {
        baseline.map_or(Self::Table, Self::Baseline)
    }

    pub(crate) fn baseline(self) -> Option<&'a Baseline> {
        match self {
            Self::Table | Self::NothingYet => None,
            Self::Baseline(baseline) => Some(baseline),
        }
    }

    pub(crate) fn statistics(self, model: &EffectModel<'_>) -> Statistics {
        let sensors = model.aircraft().sensors();
        let stated = matches!(self, Self::Table);
        Statistics {
            factors: self.baseline().map_or_else(NoiseFactors::default, |b| *b.noise()),
            // What a flight keeps is learnt as a factor on mass, heating value and split, what wanders as one on the rest.
            flight_bias: if stated { sensors.flight_bias } else { FlightBias::none() },
            fuel_flow_drift: if stated {
                sensors.fuel_flow_drift
            } else {
                FuelFlowDrift::default()
            },
        }
    }
}
