//! Outlier weights of the segments and flights that a baseline learns from: one absurd recording must not move it.
//!
//! Weights divide variances. They begin at the distance from the median of all residuals, over the median distance, and are
//! then taken against the fit, until they stay. A segment or flight within the usual distance has a weight of exactly 1, so that
//! clean flights are learnt as if nothing were weighed.

use crate::baseline::Baseline;
use crate::math::quantile::{QuantileType, quantile};
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::thresholds::{FARTHEST_FROM_MEDIAN, LEAST_MEDIAN_DISTANCE, USUAL_DISTANCE};

/// Standard deviation over median distance from the median, of a normal distribution: 1/Φ⁻¹(¾).
const DEVIATION_OVER_MEDIAN_DISTANCE: f64 = 1.482_602_218_505_602;
/// Largest change of a weight at which they count as settled. Our choice: 0.8 instead of 0.75 changes nothing.
const SETTLED: f64 = 0.05;

/// Weights of every segment, and of what the segments of each flight have in common.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Weights {
    pub(super) segments: Vec<f64>,
    pub(super) flights: Vec<f64>,
}

impl Weights {
    /// Before anything is fitted: how far a segment lies from the median.
    pub(super) fn before(data: &PreparedFlights<'_>) -> Self {
        let residuals: Vec<f64> = data.segments.iter().map(|row| row.residual[0]).collect();
        let middle = median(residuals.clone());
        let distance = median(residuals.iter().map(|value| (value - middle).abs()).collect());
        let scale = (DEVIATION_OVER_MEDIAN_DISTANCE * distance).max(LEAST_MEDIAN_DISTANCE);
        let segments = residuals
            .iter()
            .map(|value| weight((value - middle) / scale, FARTHEST_FROM_MEDIAN))
            .collect();
        Self { segments, flights: vec![1.0; data.flights.len()] }
    }

    /// Against what was fitted with the weights so far.
    pub(super) fn after(&self, data: &PreparedFlights<'_>, fitted: &Baseline) -> Self {
        let (within, between) = (fitted.noise().within, fitted.noise().between);
        let n2 = data.channels.n2.then(|| data.channels.n2_row());
        let mut next = self.clone();
        for (flight, rows) in data.flights.iter().enumerate() {
            let range = rows.segments.clone();
            let rows = &data.segments[range.clone()];
            let left: Vec<f64> = rows.iter().map(|row| fitted.left_of_fuel_flow(row)).collect();
            let own: Vec<f64> =
                rows.iter().map(|row| own_variance(row, 0) * within[0].powi(2)).collect();
            let of_flight = rows
                .iter()
                .map(|row| row.noise.common.iter().map(|u| u[0] * u[0]).sum::<f64>())
                .sum::<f64>()
                / rows.len() as f64
                * between[0].powi(2);
            let precisions = own.iter().zip(&self.segments[range.clone()]).map(|(v, w)| w / v);
            let sum: f64 = precisions.clone().sum();
            let mean = precisions.zip(&left).map(|(p, left)| p * left).sum::<f64>()
                / (sum + self.flights[flight] / of_flight.max(f64::MIN_POSITIVE));
            next.flights[flight] = weight(mean / of_flight.sqrt(), USUAL_DISTANCE);
            for (k, row) in rows.iter().enumerate() {
                let mut distance = ((left[k] - mean) / own[k].sqrt()).abs();
                if let Some(channel) = n2.filter(|&channel| row.is_recorded[channel]) {
                    let deviation = (own_variance(row, channel) * within[2].powi(2)
                        + row.noise.common.iter().map(|u| u[channel].powi(2)).sum::<f64>()
                            * between[2].powi(2))
                    .sqrt();
                    distance =
                        distance.max((fitted.left_of_n2(row, data, channel) / deviation).abs());
                }
                next.segments[range.start + k] = weight(distance, USUAL_DISTANCE);
            }
        }
        next
    }

    /// Whether none of them moved.
    pub(super) fn settled(&self, before: &Self) -> bool {
        let pairs = self.segments.iter().zip(&before.segments);
        pairs.chain(self.flights.iter().zip(&before.flights)).all(|(a, b)| (a - b).abs() <= SETTLED)
    }

    /// Segments that count less than half.
    pub(super) fn outliers(&self) -> usize {
        self.segments.iter().filter(|weight| **weight < 0.5).count()
    }
}

impl Baseline {
    /// ln fuel flow of a segment that was learnt from, less everything that was learnt.
    pub(super) fn left_of_fuel_flow(&self, row: &SegmentRow) -> f64 {
        let carried = row.standing_effects.iter().zip(&self.parts.standing_effects);
        let carried: f64 = carried.map(|(slope, size)| slope[0] * size).sum();
        row.residual[0] - self.mean_at(&row.response) - self.drag_at(&row.response) - carried
    }

    /// The same of ln N2.
    fn left_of_n2(&self, row: &SegmentRow, data: &PreparedFlights<'_>, channel: usize) -> f64 {
        let deck = self.parts.deck_coefficients.iter().zip(&data.predictor.deck.coefficients);
        let deck: f64 = deck.zip(row.deck).map(|((new, old), term)| (new - old) * term).sum();
        let carried = row.standing_effects.iter().zip(&self.parts.standing_effects);
        let carried: f64 = carried.map(|(slope, size)| slope[channel] * size).sum();
        row.residual[channel] - deck - row.n2_slope * self.drag_at(&row.response) - carried
    }
}

/// Variance of a channel's own noise, at noise factors of 1.
fn own_variance(row: &SegmentRow, channel: usize) -> f64 {
    row.noise.factor[channel][..=channel].iter().map(|l| l * l).sum()
}

/// 1 up to a usual distance, then falling with its square.
fn weight(distance: f64, usual: f64) -> f64 {
    let share = usual / distance.abs();
    if share >= 1.0 || share.is_nan() { 1.0 } else { share * share }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    if values.is_empty() { 0.0 } else { quantile(&values, 0.5, QuantileType::Type7) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_usual_counts_whole_and_what_is_absurd_hardly() {
        assert_eq!([0.0, -2.4, 2.5].map(|z| weight(z, 2.5).to_bits()), [1.0_f64.to_bits(); 3]);
        assert!((weight(5.0, 2.5) - 0.25).abs() < 1e-15);
        // What a segment pulls with falls as its distance grows.
        assert!(100.0 * weight(100.0, 2.5) < 10.0 * weight(10.0, 2.5));
        assert!((median(vec![3.0, 1.0, 2.0, 10.0]) - 2.5).abs() < 1e-15);
    }
}
