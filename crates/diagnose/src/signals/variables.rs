//! The physical variables that a gap may hang on as they were flown, and hat functions over them.

use effects::{EffectReferences, Response, Variable};
use serde::{Deserialize, Serialize};

use crate::math::quantile::{QuantileType, quantile};

/// The value of a variable as it was flown, effects of sensors and mass undone; only for variables of state.
pub(crate) fn flown(variable: Variable, response: &Response, references: &EffectReferences) -> f64 {
    let altitude = || {
        let pressure = units::Pressure::pascals(
            response.ln_pressure_ratio.exp() * atmos::constants::SEA_LEVEL_PRESSURE_PA,
        );
        // A response exists only inside the atmosphere's domain.
        atmos::isa::pressure_altitude(pressure).map_or(0.0, units::PressureAltitude::to_meters)
    };
    match variable {
        Variable::Mach => response.mach,
        Variable::LiftCoefficient => response.lift_coefficient,
        Variable::PressureAltitude => altitude(),
        Variable::CorrectedThrust => {
            response.ln_corrected_thrust.exp() / references.corrected_thrust_n
        }
        Variable::IsaDeviation => {
            let isa_k = atmos::isa::temperature(units::PressureAltitude::meters(altitude()))
                .map_or(0.0, units::Temperature::to_kelvin);
            response.ln_temperature_ratio.exp() * atmos::constants::SEA_LEVEL_TEMPERATURE_K - isa_k
        }
        Variable::Mass => response.mass_kg,
        _ => 0.0,
    }
}

/// Hat functions over one variable: piecewise linear, 1 at one knot and 0 at the others, held beyond the ends; each less
/// its mean over the data it was made from, so that a sum of them is no level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Hats {
    pub(crate) knots: Vec<f64>,
    /// What is subtracted from each hat: its mean over the values, or its value where a sum is to be zero.
    pub(crate) means: Vec<f64>,
}

impl Hats {
    /// Knots at quantiles of the values; `None` where they do not spread over at least three knots, or two if no more are asked
    /// for.
    pub(crate) fn at_quantiles(values: &[f64], quantiles: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (first, last) = (*sorted.first()?, *sorted.last()?);
        let span = last - first;
        if !span.is_finite() || span <= 1e-9 * first.abs().max(last.abs()) {
            return None;
        }
        let mut knots: Vec<f64> = Vec::new();
        for &share in quantiles {
            let knot = quantile(&sorted, share, QuantileType::Type7);
            if knots.last().is_none_or(|&before| knot > before + 1e-3 * span) {
                knots.push(knot);
            }
        }
        if knots.len() < quantiles.len().min(3) {
            return None;
        }
        let mut hats = Self { means: vec![0.0; knots.len()], knots };
        let mut means = vec![0.0; hats.knots.len()];
        for &value in values {
            let (index, upper) = hats.place(value);
            means[index] += 1.0 - upper;
            means[index + 1] += upper;
        }
        for mean in &mut means {
            *mean /= values.len() as f64;
        }
        hats.means = means;
        Some(hats)
    }

    /// The same hats, of which any sum is zero at a value in place of on average; at the nearest end where it lies outside.
    pub(crate) fn zero_at(mut self, value: f64) -> Self {
        let (index, upper) = self.place(value);
        self.means.fill(0.0);
        self.means[index] = 1.0 - upper;
        self.means[index + 1] = upper;
        self
    }

    pub(crate) fn len(&self) -> usize {
        self.knots.len()
    }

    /// Writes every hat's value.
    pub(crate) fn write(&self, value: f64, into: &mut [f64]) {
        let (index, upper) = self.place(value);
        for (slot, mean) in into.iter_mut().zip(&self.means) {
            *slot = -mean;
        }
        into[index] += 1.0 - upper;
        into[index + 1] += upper;
    }

    /// Interval that holds a value, and how far up in it the value lies; held at the ends.
    fn place(&self, value: f64) -> (usize, f64) {
        let last = self.knots.len() - 1;
        let index = self.knots[1..last].partition_point(|&knot| knot <= value);
        let (low, high) = (self.knots[index], self.knots[index + 1]);
        (index, ((value - low) / (high - low)).clamp(0.0, 1.0))
    }
}

/// A variable made dimensionless: (v − mean)/standard deviation, held within ±2.5.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Scaled {
    mean: f64,
    deviation: f64,
}

impl Scaled {
    pub(crate) fn from_values(values: &[f64]) -> Self {
        let count = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / count;
        let deviation = variance.sqrt();
        let spread = deviation > 1e-9 * mean.abs().max(1e-9);
        Self { mean, deviation: if spread { deviation } else { f64::INFINITY } }
    }

    pub(crate) fn at(self, value: f64) -> f64 {
        ((value - self.mean) / self.deviation).clamp(-2.5, 2.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hats_are_zero_where_they_are_asked_to_be() {
        let values: Vec<f64> = (0..=10).map(f64::from).collect();
        let hats = Hats::at_quantiles(&values, &[0.0, 0.5, 1.0]).unwrap();
        let mut row = [0.0; 3];
        for (zero, held) in [(4.0, 4.0), (-7.0, 0.0), (12.0, 10.0)] {
            let hats = hats.clone().zero_at(zero);
            hats.write(held, &mut row);
            assert!(row.iter().all(|value| value.abs() < 1e-15), "{zero}");
            hats.write(2.5, &mut row);
            // A constant is one of their sums still, less what it is at that value.
            assert!(row.iter().sum::<f64>().abs() < 1e-15);
            assert!((5.0 * row[1] + 10.0 * row[2] - (2.5 - held)).abs() < 1e-12, "{row:?}");
        }
    }

    #[test]
    fn hats_sum_to_zero_and_interpolate() {
        let values: Vec<f64> = (0..=10).map(f64::from).collect();
        let hats = Hats::at_quantiles(&values, &[0.0, 0.5, 1.0]).unwrap();
        assert_eq!(hats.knots, [0.0, 5.0, 10.0]);
        let mut row = [0.0; 3];
        let mut sums = [0.0; 3];
        for &value in &values {
            hats.write(value, &mut row);
            // A partition of unity less its means, which sum to one.
            assert!(row.iter().sum::<f64>().abs() < 1e-15);
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += value;
            }
        }
        assert!(sums.iter().all(|sum| sum.abs() < 1e-14));
        hats.write(6.0, &mut row);
        assert!((row[1] + hats.means[1] - 0.8).abs() < 1e-15);
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "a value over infinity is exactly zero")]
    fn what_does_not_spread_has_no_hats() {
        assert!(Hats::at_quantiles(&[3.0; 20], &[0.0, 0.5, 1.0]).is_none());
        assert!(Hats::at_quantiles(&[], &[0.0, 0.5, 1.0]).is_none());
        assert_eq!(Scaled::from_values(&[2.0; 5]).at(7.0), 0.0);
    }
}
