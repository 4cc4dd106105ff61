//! Outlier weights of the values and flights that a baseline learns from: one absurd recording must not move it.
//!
//! Weights divide variances. They begin at the distance from the median of all residuals, over the median distance, and are
//! then taken against the fit, until they stay. A value or flight within the usual distance has a weight of exactly 1, so that
//! clean flights are learnt as if nothing were weighed.

use crate::learning::dials::Dials;
use crate::learning::rows::ChannelRows;
use crate::math::quantile::{MEDIAN_TO_DEVIATION, median};
use crate::thresholds::{ABSURD, FARTHEST_FROM_MEDIAN, LEAST_MEDIAN_DISTANCE, USUAL_DISTANCE};

/// Largest change of a weight, as a share of it, at which they count as settled: that of an absurd flight is small, and the scatter
/// between flights that it makes goes with its share. Our choice: 0.8 instead of 0.76 changes nothing.
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

    /// Before anything is fitted: how far a value lies from the median, or from that of its flight where the flight as a whole lies
    /// far from all. Scatter between flights that is sought with one such flight among them holds it, and then it is not far.
    pub(super) fn before(rows: &ChannelRows) -> Self {
        let residuals = rows.residual();
        let middle = median(residuals.to_vec());
        let scale = scale_about(middle, residuals);
        let medians: Vec<f64> =
            rows.groups.iter().map(|range| median(residuals[range.clone()].to_vec())).collect();
        let scale_of_flights = scale_about(middle, &medians);
        let mut weights = Self::of_one(rows);
        for (group, range) in rows.groups.iter().enumerate() {
            let of_flight =
                weight((medians[group] - middle) / scale_of_flights, FARTHEST_FROM_MEDIAN);
            weights.groups[group] = of_flight;
            let about = if of_flight < 1.0 { medians[group] } else { middle };
            for row in range.clone() {
                weights.rows[row] = weight((residuals[row] - about) / scale, FARTHEST_FROM_MEDIAN);
            }
        }
        weights
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
        let mut pairs = pairs.chain(self.groups.iter().zip(&before.groups));
        pairs.all(|(a, b)| (a - b).abs() <= SETTLED * a.max(*b))
    }

    /// Values that count less than half.
    pub(super) fn outliers(&self) -> usize {
        self.rows.iter().filter(|weight| **weight < 0.5).count()
    }
}

/// Standard deviation of ordinary values about their middle, by the median distance.
fn scale_about(middle: f64, values: &[f64]) -> f64 {
    let distance = median(values.iter().map(|value| (value - middle).abs()).collect());
    (MEDIAN_TO_DEVIATION * distance).max(LEAST_MEDIAN_DISTANCE)
}

/// 1 up to a usual distance, then falling with its square, and with its fourth power from where it is absurd ([`ABSURD`]), twice
/// the usual distance, on.
///
/// A value that counts by the square of its distance adds 2.5² = 6.25 to the sum that noise is found from, however far it lies:
/// as much as all of ten flights, of which a dozen columns take up most. An absurd one must add nothing.
fn weight(distance: f64, usual: f64) -> f64 {
    let square = (usual / distance).powi(2);
    if square >= 1.0 || square.is_nan() { 1.0 } else { square * (square / ABSURD).min(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_usual_counts_whole_and_what_is_absurd_hardly() {
        assert_eq!([0.0, -2.4, 2.5].map(|z| weight(z, 2.5).to_bits()), [1.0_f64.to_bits(); 3]);
        assert!((weight(5.0, 2.5) - 0.25).abs() < 1e-15);
        assert!((weight(10.0, 2.5) - 4.0 * 0.25_f64.powi(4)).abs() < 1e-15);
        // What a value pulls with falls as its distance grows.
        assert!(100.0 * weight(100.0, 2.5) < 10.0 * weight(10.0, 2.5));
        assert!((median(vec![3.0, 1.0, 2.0, 10.0]) - 2.5).abs() < 1e-15);
    }

    /// One flight of ten burns half more: it counts little as a whole, and its segments agree with each other.
    #[test]
    fn an_absurd_flight_is_one_before_anything_is_learnt() {
        let (flights, each) = (10, 4);
        let value = |flight: usize, k: usize| {
            let absurd = if flight == 3 { 0.4 } else { 0.0 };
            absurd + 0.002 * (flight as f64 - 4.5) + 0.001 * k as f64
        };
        let rows = ChannelRows {
            columns: faer::Mat::from_fn(flights * each, 1, |row, _| value(row / each, row % each)),
            variance: vec![1e-6; flights * each],
            loadings: vec![vec![0.003; flights * each]],
            groups: (0..flights).map(|flight| flight * each..(flight + 1) * each).collect(),
            shares: vec![1.0; flights],
        };
        let weights = Weights::before(&rows);
        assert!(weights.rows.iter().all(|weight| weight.to_bits() == 1.0_f64.to_bits()));
        for (flight, weight) in weights.groups.iter().enumerate() {
            // 5 of 40 % over the scale, which is the least of 1 %: an eighth.
            let expected = if flight == 3 { 4.0 * (0.05_f64 / 0.4).powi(4) } else { 1.0 };
            assert!((weight - expected).abs() < 0.1 * expected, "{flight}: {weight}");
        }
    }

    #[test]
    fn weights_are_settled_where_none_of_them_moved_by_much() {
        let of = |row: f64, group: f64| Weights { rows: vec![1.0, row], groups: vec![group] };
        assert!(of(0.5, 0.7).settled(&of(0.5, 0.7)) && of(0.5, 0.7).settled(&of(0.48, 0.73)));
        assert!(!of(0.5, 0.7).settled(&of(0.44, 0.7)) && !of(0.5, 0.7).settled(&of(0.5, 0.76)));
        // An absurd flight whose weight has halved had made the scatter √2 too large.
        assert!(!of(0.5, 0.001).settled(&of(0.5, 0.002)));
    }
}
