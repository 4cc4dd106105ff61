//! What a baseline's predictions do on flights that did not teach them: the empirical null of its intervals.
//!
//! The flights are learnt again without each fold in turn, and the fold's segments are predicted. How far they lie off, over how
//! far they were announced to lie off, is kept as one factor on every standard deviation that the model states:
//!
//! ```text
//! factor = q/1.96,  q the 95 % quantile of |error|/announced over unseen segments              [baseline.2]
//! ```
//!
//! With few segments a quantile is hardly known; it is drawn towards 1.96 as if so many ordinary segments had been seen in
//! addition.

use faer::Mat;

use crate::baseline::Baseline;
use crate::learning::moments::{GramSums, LeftOutSegment};
use crate::math::quantile::{QuantileType, quantile};
use crate::thresholds::{FACTOR_LIMITS, LEARNING_FOLDS, ORDINARY_SEGMENTS};

/// The 97.5 % quantile of the normal distribution.
const NORMAL_95: f64 = 1.959_963_984_540_054;

impl Baseline {
    /// The factor on stated standard deviations by flights left out; 1 where there are none.
    pub(super) fn factor_by_unseen(&self, moments: &GramSums) -> f64 {
        let mut distances = Vec::new();
        let all = moments.gram(&self.parts.noise, None);
        for fold in 0..LEARNING_FOLDS {
            let judged: Vec<&LeftOutSegment> =
                moments.segments.iter().filter(|segment| segment.fold == fold).collect();
            if judged.is_empty() {
                continue;
            }
            let others = &all - moments.gram(&self.parts.noise, Some(fold));
            let Some((solution, factor)) = self.posterior(&others) else { return 1.0 };
            let width = self.factor.nrows();
            let mut loadings = Mat::from_fn(width, judged.len(), |k, at| judged[at].loading[k]);
            let expected = loadings.transpose() * &solution;
            factor.solve_lower(&mut loadings);
            let (within, between) = (self.parts.noise.within[0], self.parts.noise.between[0]);
            for (k, segment) in judged.into_iter().enumerate() {
                let of_model: f64 = loadings.col_as_slice(k).iter().map(|l| l * l).sum();
                let announced = of_model
                    + self.unflown(segment)
                    + within * within * segment.within
                    + between * between * segment.between;
                distances.push((segment.residual - expected[(k, 0)]).abs() / announced.sqrt());
            }
        }
        factor_of(distances)
    }

    fn unflown(&self, segment: &LeftOutSegment) -> f64 {
        let drag = segment.drag_over_thrust * segment.drag_over_thrust;
        segment.unflown_share * self.smooth_variance() + drag * segment.drag_left_out
    }
}

fn factor_of(mut distances: Vec<f64>) -> f64 {
    if distances.is_empty() {
        return 1.0;
    }
    distances.sort_by(f64::total_cmp);
    let found = quantile(&distances, 0.95, QuantileType::Type7) / NORMAL_95;
    let count = distances.len() as f64;
    let factor = ((count * found * found + ORDINARY_SEGMENTS) / (count + ORDINARY_SEGMENTS)).sqrt();
    factor.clamp(FACTOR_LIMITS.0, FACTOR_LIMITS.1)
}

#[cfg(test)]
mod tests {
    use statrs::distribution::ContinuousCDF;

    use super::*;

    /// Quantiles of the half-normal distribution: `scipy.stats.halfnorm.ppf`, spaced evenly.
    #[test]
    fn errors_as_announced_keep_the_intervals() {
        let normal = statrs::distribution::Normal::standard();
        let distances = |scale: f64| -> Vec<f64> {
            (0..400)
                .map(|k| scale * normal.inverse_cdf(0.5 + 0.5 * (f64::from(k) + 0.5) / 400.0))
                .collect()
        };
        assert!((factor_of(distances(1.0)) - 1.0).abs() < 0.01);
        assert!((factor_of(distances(2.0)) - 1.93).abs() < 0.03);
        assert!((factor_of(distances(0.1)) - FACTOR_LIMITS.0).abs() < 1e-12);
        assert_eq!(factor_of(vec![]).to_bits(), 1.0_f64.to_bits());
    }
}
