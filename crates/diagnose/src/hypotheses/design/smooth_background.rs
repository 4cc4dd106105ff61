//! The smooth background: what of a gap depends smoothly on conditions and belongs to no effect.

use effects::{EffectReferences, Variable};

use crate::priors::{PRODUCT_SCALE, SMOOTH_QUANTILES};
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::signals::variables::{Hats, Scaled};

/// Variables of the smooth background. Our choice: what effects of the library depend on.
const SMOOTH_VARIABLES: [Variable; 15] = [
    Variable::Mach,
    Variable::LiftCoefficient,
    Variable::PressureAltitude,
    Variable::CorrectedThrust,
    Variable::IsaDeviation,
    Variable::StaticAirTemperature,
    Variable::Date,
    Variable::FuelUsed,
    Variable::Roll,
    Variable::Acceleration,
    Variable::CrossWind,
    Variable::Latitude,
    Variable::EastwardSpeed,
    Variable::CenterOfGravity,
    Variable::Mass,
];

/// Products in the smooth background. Our choice: pairs that physics multiplies.
const SMOOTH_PRODUCTS: [(Variable, Variable); 10] = [
    (Variable::Mach, Variable::LiftCoefficient),
    (Variable::Mach, Variable::PressureAltitude),
    (Variable::LiftCoefficient, Variable::PressureAltitude),
    (Variable::Mach, Variable::IsaDeviation),
    (Variable::PressureAltitude, Variable::IsaDeviation),
    (Variable::CorrectedThrust, Variable::Mach),
    (Variable::CrossWind, Variable::Latitude),
    (Variable::EastwardSpeed, Variable::Latitude),
    (Variable::CenterOfGravity, Variable::LiftCoefficient),
    (Variable::Mach, Variable::Date),
];

/// A level, functions of single variables, products of two.
#[derive(Clone, Debug)]
pub(super) struct SmoothBackground {
    hats: Vec<(Variable, Hats)>,
    products: Vec<(Variable, Scaled, Variable, Scaled)>,
    /// Root mean square of all terms together, so that an amplitude is that of their sum.
    rms: f64,
}

impl SmoothBackground {
    /// Over the values that were flown. So many kinds of it act: on fuel flow, and on thrust where N2 is recorded.
    pub(super) fn new(
        data: &PreparedFlights<'_>,
        references: &EffectReferences,
        values: impl Fn(Variable) -> Option<Vec<f64>>,
        kinds: usize,
    ) -> Self {
        let hats = SMOOTH_VARIABLES
            .into_iter()
            .filter_map(|v| Some((v, Hats::at_quantiles(&values(v)?, &SMOOTH_QUANTILES)?)))
            .collect();
        let products = SMOOTH_PRODUCTS
            .into_iter()
            .filter_map(|(a, b)| {
                Some((a, Scaled::from_values(&values(a)?), b, Scaled::from_values(&values(b)?)))
            })
            .collect();
        let mut background = Self { hats, products, rms: 1.0 };
        background.rms = background.rms_over(data, references, kinds);
        background
    }

    /// Without any function: its level alone.
    pub(super) const fn without_functions(&self) -> Self {
        Self { hats: Vec::new(), products: Vec::new(), rms: self.rms }
    }

    /// Terms of one kind.
    pub(super) fn terms(&self) -> usize {
        1 + self.hats.iter().map(|(_, hats)| hats.len()).sum::<usize>() + self.products.len()
    }

    /// Prior standard deviation of each term that makes their sum this large, root mean square over the segments.
    pub(super) fn deviation(&self, amplitude: f64) -> f64 {
        amplitude / self.rms
    }

    /// Writes the terms at a segment.
    pub(super) fn write(&self, row: &SegmentRow, references: &EffectReferences, into: &mut [f64]) {
        let value = |variable: Variable| {
            variable.value(&row.point, &row.response, references).unwrap_or(0.0)
        };
        into[0] = 1.0;
        let mut at = 1;
        for (variable, hats) in &self.hats {
            hats.write(value(*variable), &mut into[at..at + hats.len()]);
            at += hats.len();
        }
        for (a, scaled_a, b, scaled_b) in &self.products {
            into[at] = PRODUCT_SCALE * scaled_a.at(value(*a)) * scaled_b.at(value(*b));
            at += 1;
        }
    }

    /// Root mean square over the segments of the sum of all terms of unit amplitude, all kinds of them together.
    fn rms_over(
        &self,
        data: &PreparedFlights<'_>,
        references: &EffectReferences,
        kinds: usize,
    ) -> f64 {
        let mut terms = vec![0.0; self.terms()];
        let mut square = 0.0;
        for row in &data.segments {
            self.write(row, references, &mut terms);
            square += terms.iter().map(|term| term * term).sum::<f64>();
        }
        (kinds as f64 * square / data.segments.len().max(1) as f64).sqrt()
    }
}
