//! How far the whole model expects to err on average over many segments.

use std::collections::BTreeMap;

use crate::residuals::whole::{WholeModel, WholePrediction};

impl WholeModel<'_> {
    /// Variance of the mean error over these segments of one new flight.
    #[must_use]
    pub fn variance_of_flight(&self, segments: &[&WholePrediction]) -> f64 {
        self.variance_of_mean(segments) + WholePrediction::own_variance_of_flight(segments)
    }

    /// Variance of the model's mean error over these segments, however many flights there are: that of a fleet's mean.
    ///
    /// ```text
    /// |mean of loadings|² + q²·((mean of deviations where nothing was flown)² + σ²·Σ_functions var(mean) + v)
    /// ```
    ///
    /// var(mean) and v are `[baseline.9]` of the functions and of the drag table, q is the factor on what is stated. Where
    /// nothing was flown a model errs alike everywhere; where something was, what its terms leave is another from place to place.
    #[must_use]
    pub fn variance_of_mean(&self, segments: &[&WholePrediction]) -> f64 {
        let share = 1.0 / segments.len().max(1) as f64;
        let mut sums = vec![0.0; self.directions()];
        let mut along = vec![Vec::with_capacity(segments.len()); self.baseline.smooth_functions()];
        let mut nodes: BTreeMap<usize, f64> = BTreeMap::new();
        let mut unflown = 0.0;
        for one in segments {
            for (sum, loading) in sums.iter_mut().zip(&one.loadings) {
                *sum += share * loading;
            }
            unflown += share * one.places.unflown.sqrt();
            for (along, place) in along.iter_mut().zip(&one.places.smooth) {
                along.push(*place);
            }
            for (node, weight) in &one.places.nodes {
                *nodes.entry(*node).or_default() += share * weight;
            }
        }
        let of_nodes = self.baseline.table.as_ref().map_or(0.0, |t| t.left_out_visited(&nodes));
        let left = unflown * unflown + self.baseline.left_of_mean(&along) + of_nodes;
        let stated = self.baseline.interval_factor();
        stated * stated * left + sums.iter().map(|sum| sum * sum).sum::<f64>()
    }
}

impl WholePrediction {
    /// Variance of the mean error over these segments of one new flight that is the flight's own, not the model's.
    #[must_use]
    pub fn own_variance_of_flight(segments: &[&Self]) -> f64 {
        let count = segments.len().max(1) as f64;
        let mean = |of: fn(&Self) -> f64| segments.iter().map(|one| of(one)).sum::<f64>() / count;
        mean(|one| one.of_flight) + mean(|one| one.of_segment) / count
    }
}
