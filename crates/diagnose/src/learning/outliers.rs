//! Outlier weights of the values and flights that a baseline learns from: one absurd recording must not move it.
//!
//! Weights divide variances. They begin at the distance from the median of all residuals, over the median distance, and are
//! then taken against the fit, until they stay. A value or flight within the usual distance has a weight of exactly 1, so that
//! clean flights are learnt as if nothing were weighed.

use crate::learning::dials::Dials;
use crate::learning::rows::ChannelRows;
use crate::math::quantile::{MEDIAN_TO_DEVIATION, median};
use crate::thresholds::{FARTHEST_FROM_MEDIAN, LEAST_MEDIAN_DISTANCE, USUAL_DISTANCE};

/// Largest change of a weight at which they count as settled. Our choice: 0.8 instead of 0.75 changes nothing.
const SETTLED: f64 = 0.05;

/// Weights of every value, and of what the values of each flight have in common.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Weights {
    pub(super) rows: Vec<f64>,
    pub(super) groups: Vec<f64>,
}

impl Weights {
    /// All of them 1.
    pub(super) fn of_one(rows: &ChannelRows) -> Self {
        Self { rows: vec![1.0; rows.variance.len()], groups: vec![1.0; rows.groups.len()] }
    }

    /// Before anything is fitted: how far a value lies from the median.
    pub(super) fn before(rows: &ChannelRows) -> Self {
        let residuals = rows.residual();
        let middle = median(residuals.to_vec());
        let distance = median(residuals.iter().map(|value| (value - middle).abs()).collect());
        let scale = (MEDIAN_TO_DEVIATION * distance).max(LEAST_MEDIAN_DISTANCE);
        let of_rows = residuals
            .iter()
            .map(|value| weight((value - middle) / scale, FARTHEST_FROM_MEDIAN))
            .collect();
        Self { rows: of_rows, ..Self::of_one(rows) }
    }

    /// Against what is left of the values after a fit with the weights so far.
    pub(super) fn after(&self, rows: &ChannelRows, left: &[f64], dials: &Dials) -> Self {
        let mut next = self.clone();
        for (group, range) in rows.groups.iter().enumerate() {
            let own: Vec<f64> =
                range.clone().map(|row| rows.variance[row] * dials.within.powi(2)).collect();
            let common = range.clone().map(|row| rows.common_variance(row)).sum::<f64>()
                / range.len() as f64
                * dials.between.powi(2);
            let left = &left[range.clone()];
            let precisions = own.iter().zip(&self.rows[range.clone()]).map(|(v, w)| w / v);
            let sum: f64 = precisions.clone().sum();
            let mean = precisions.zip(left).map(|(p, left)| p * left).sum::<f64>()
                / (sum + self.groups[group] / common.max(f64::MIN_POSITIVE));
            next.groups[group] = weight(mean / common.sqrt(), USUAL_DISTANCE);
            for (k, row) in range.clone().enumerate() {
                next.rows[row] = weight((left[k] - mean) / own[k].sqrt(), USUAL_DISTANCE);
            }
        }
        next
    }

    /// Whether none of them moved.
    pub(super) fn settled(&self, before: &Self) -> bool {
        let pairs = self.rows.iter().zip(&before.rows);
        pairs.chain(self.groups.iter().zip(&before.groups)).all(|(a, b)| (a - b).abs() <= SETTLED)
    }

    /// Values that count less than half.
    pub(super) fn outliers(&self) -> usize {
        self.rows.iter().filter(|weight| **weight < 0.5).count()
    }
}

/// 1 up to a usual distance, then falling with its square.
fn weight(distance: f64, usual: f64) -> f64 {
    let share = usual / distance.abs();
    if share >= 1.0 || share.is_nan() { 1.0 } else { share * share }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_usual_counts_whole_and_what_is_absurd_hardly() {
        assert_eq!([0.0, -2.4, 2.5].map(|z| weight(z, 2.5).to_bits()), [1.0_f64.to_bits(); 3]);
        assert!((weight(5.0, 2.5) - 0.25).abs() < 1e-15);
        // What a value pulls with falls as its distance grows.
        assert!(100.0 * weight(100.0, 2.5) < 10.0 * weight(10.0, 2.5));
        assert!((median(vec![3.0, 1.0, 2.0, 10.0]) - 2.5).abs() < 1e-15);
    }

    #[test]
    fn weights_are_settled_where_none_of_them_moved_by_much() {
        let of = |row: f64, group: f64| Weights { rows: vec![1.0, row], groups: vec![group] };
        assert!(of(0.5, 0.7).settled(&of(0.5, 0.7)) && of(0.5, 0.7).settled(&of(0.46, 0.74)));
        assert!(!of(0.5, 0.7).settled(&of(0.44, 0.7)) && !of(0.5, 0.7).settled(&of(0.5, 0.76)));
    }
}
