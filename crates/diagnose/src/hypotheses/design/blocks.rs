//! Smooth functions of single variables, which stand for what is outside the library.

use core::ops::Range;

use effects::{EffectReferences, Variable};

use crate::hypotheses::design::rows_of_segment::RowsOfSegment;
use crate::priors::{AGNOSTIC_QUANTILES, SPLIT_SCALE};
use crate::residuals::segments::PreparedFlights;
use crate::signals::channels::MAXIMUM_CHANNELS;
use crate::signals::variables::Hats;

/// Without acceleration: its own error is in the residual, which depends on it in every recording.
pub(crate) const AGNOSTIC_VARIABLES: [Variable; 19] = [
    Variable::Mach,
    Variable::LiftCoefficient,
    Variable::PressureAltitude,
    Variable::CorrectedThrust,
    Variable::IsaDeviation,
    Variable::StaticAirTemperature,
    Variable::FuelUsed,
    Variable::Mass,
    Variable::Date,
    Variable::Roll,
    Variable::CrossWind,
    Variable::Latitude,
    Variable::EastwardSpeed,
    Variable::CenterOfGravity,
    Variable::LatitudeCrossWind,
    Variable::CenterOfGravityLift,
    Variable::MachLift,
    Variable::MachExcess,
    Variable::AntiIce,
];

/// How a smooth function acts: on fuel flow alone, or on thrust, so that N2 sees it too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Acts {
    FuelFlow,
    Thrust,
    Split,
}

/// A smooth term of one variable.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(crate) variable: Variable,
    pub(crate) acts: Acts,
    pub(crate) columns: Range<usize>,
    hats: Option<Hats>,
}

impl Block {
    /// Writes its columns of a segment.
    pub(super) fn write(
        &self,
        rows: &mut RowsOfSegment<'_>,
        references: &EffectReferences,
        scratch: &mut [f64],
    ) {
        let row = rows.row;
        let Some(hats) = &self.hats else {
            for (k, column) in self.columns.clone().enumerate() {
                let mut values = [0.0; MAXIMUM_CHANNELS];
                if row.is_recorded[1 + k] {
                    values[1 + k] = SPLIT_SCALE;
                }
                rows.put(column, &values);
            }
            return;
        };
        let value = self.variable.value(&row.point, &row.response, references).unwrap_or(0.0);
        hats.write(value, &mut scratch[..hats.len()]);
        for (k, value) in scratch[..hats.len()].iter().enumerate() {
            if self.acts == Acts::Thrust {
                rows.put_thrust(self.columns.start + k, *value);
            } else {
                rows.put_fuel_flow(self.columns.start + k, *value);
            }
        }
    }
}

/// Functions of single variables outside the library, and the contrasts of the engines: their columns from `first` on, and the
/// first column after them.
pub(super) fn agnostic_blocks(
    data: &PreparedFlights<'_>,
    values: impl Fn(Variable) -> Option<Vec<f64>>,
    first: usize,
) -> (Vec<Block>, usize) {
    let mut blocks = Vec::new();
    let mut at = first;
    for variable in AGNOSTIC_VARIABLES {
        let hats = values(variable).and_then(|values| match variable {
            // A switch has no values between off and on that a bend could be at.
            Variable::AntiIce => Hats::at_quantiles(&values, &[0.0, 1.0]),
            // What changes with time has not yet changed at the date of the model.
            Variable::Date => {
                Hats::at_quantiles(&values, &AGNOSTIC_QUANTILES).map(|hats| hats.zero_at(0.0))
            }
            _ => Hats::at_quantiles(&values, &AGNOSTIC_QUANTILES),
        });
        let Some(hats) = hats else { continue };
        for acts in [Acts::FuelFlow, Acts::Thrust] {
            if acts == Acts::Thrust && !data.channels.n2 {
                continue;
            }
            let columns = at..at + hats.len();
            at = columns.end;
            blocks.push(Block { variable, acts, columns, hats: Some(hats.clone()) });
        }
    }
    if data.channels.contrasts > 0 {
        let columns = at..at + data.channels.contrasts;
        at = columns.end;
        blocks.push(Block { variable: Variable::Engine, acts: Acts::Split, columns, hats: None });
    }
    (blocks, at)
}
