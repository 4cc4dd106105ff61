//! What a channel's predictions do on flights that did not teach them: the empirical null of scatter and of intervals.
//!
//! Every flight is predicted from all others, in closed form, and judged by its mean (how much flights differ) and value by
//! value (how far stated intervals reach).

use faer::{Mat, MatRef};

use crate::learning::dials::Dials;
use crate::learning::evidence::Solved;
use crate::learning::outliers::Weights;
use crate::learning::rows::ChannelRows;
use crate::math::cholesky::Cholesky;
use crate::math::quantile::{QuantileType, quantile};
use crate::priors::NOISE_LIMITS;
use crate::thresholds::{FACTOR_LIMITS, ORDINARY_SEGMENTS};

/// The 97.5 % quantile of the normal distribution.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// A flight predicted from all others.
pub(super) struct Unseen {
    /// Mean error, and the model's part and the segments' part of its variance.
    mean: f64,
    of_model: f64,
    within: f64,
    /// The same of what a flight has in common, at a factor of 1.
    between: f64,
    /// Share of the flight that counts.
    share: f64,
    /// Errors of its values, each with the model's variance and the row that it is of.
    values: Vec<(f64, f64, usize)>,
}

/// Flights predicted from all others at given noise.
///
/// ```text
/// e = C Q⁻¹(y − Zα),   cov e = C Q⁻¹ C,   Q = C − Z V Zᵀ                                        [baseline.2]
/// ```
///
/// α and V are the posterior from all flights, C the noise of the flight, over the share of it that counts, Z its rows.
///
/// # Source
/// Sundararajan and Keerthi 2001, doi 10.1162/08997660151134343, here of whole flights.
pub(super) fn unseen(
    rows: &ChannelRows,
    weights: &Weights,
    solved: &Solved,
    dials: &Dials,
) -> Vec<Unseen> {
    let errors = rows.left(&solved.mean);
    let left = Mat::from_fn(errors.len(), 1, |row, _| errors[row]);
    let spread = rows.learnt_columns() * &solved.root;
    let (within, between) = (dials.within.powi(2), dials.between.powi(2));
    let groups = rows.groups.iter().enumerate();
    groups
        .filter_map(|(group, range)| {
            let count = range.len();
            let spread: MatRef<'_, f64> = spread.subrows(range.start, count);
            let known = spread * spread.transpose();
            let share = rows.shares[group];
            let noise = Mat::from_fn(count, count, |i, j| {
                let (a, b) = (range.start + i, range.start + j);
                let own = if i == j { rows.variance[a] / weights.rows[a] } else { 0.0 };
                let common: f64 = rows.loadings.iter().map(|u| u[a] * u[b]).sum();
                (within * own + between * common / weights.groups[group]) / share
            });
            let factor = Cholesky::new(&(&noise - known))?;
            let mut solved = left.subrows(range.start, count).to_owned();
            factor.solve(&mut solved);
            let errors = &noise * &solved;
            let mut turned = noise.clone();
            factor.solve_lower(&mut turned);
            let of_model = turned.transpose() * &turned - &noise;
            let total = |matrix: &Mat<f64>| -> f64 {
                (0..count).flat_map(|i| (0..count).map(move |j| (i, j))).map(|at| matrix[at]).sum()
            };
            let square = (count * count) as f64;
            let own: f64 = range.clone().map(|row| rows.variance[row]).sum();
            let common: f64 = rows
                .loadings
                .iter()
                .map(|u| (u[range.clone()].iter().sum::<f64>() / count as f64).powi(2))
                .sum();
            Some(Unseen {
                mean: (0..count).map(|k| errors[(k, 0)]).sum::<f64>() / count as f64,
                of_model: total(&of_model).max(0.0) / square,
                within: within * own / square,
                between: common,
                share,
                values: (0..count)
                    .map(|k| (errors[(k, 0)], of_model[(k, k)].max(0.0), range.start + k))
                    .collect(),
            })
        })
        .collect()
}

/// The factor between flights at which the mean errors of unseen flights are as large as announced, if that is more.
///
/// ```text
/// Σ_f s_f·e_f²/(v_model + v_within + b² v_between) = Σ_f s_f,   s the share of a flight that counts
/// ```
pub(super) fn scatter_by_unseen(unseen: &[Unseen], now: f64) -> f64 {
    let excess = |factor: f64| {
        let of = |flight: &Unseen| {
            let announced = flight.of_model + flight.within + factor * factor * flight.between;
            // An absurd flight counts as a distant one.
            flight.share * (flight.mean * flight.mean / announced).min(9.0)
        };
        unseen.iter().map(of).sum::<f64>() - unseen.iter().map(|flight| flight.share).sum::<f64>()
    };
    if unseen.is_empty() || excess(now) <= 0.0 {
        return now;
    }
    let (mut below, mut above) = (now, NOISE_LIMITS.1);
    for _ in 0..60 {
        let middle = f64::midpoint(below, above);
        if excess(middle) > 0.0 { below = middle } else { above = middle }
    }
    above
}

/// The factor on stated standard deviations by unseen values; 1 where there are none. `left_out` is the variance of the model
/// at a row that no column holds.
///
/// ```text
/// factor = q/1.96,  q the 95 % quantile of |error|/announced over unseen values
/// ```
///
/// A flight of which less than half counts is too old to say what comes. With few values a quantile is hardly known; it is drawn towards 1.96 as if so many ordinary ones had been seen in addition.
pub(super) fn factor_by_unseen(
    rows: &ChannelRows,
    unseen: &[Unseen],
    dials: &Dials,
    left_out: impl Fn(usize) -> f64,
) -> f64 {
    let (within, between) = (dials.within.powi(2), dials.between.powi(2));
    let recent = unseen.iter().filter(|flight| flight.share >= 0.5);
    let values = recent.flat_map(|flight| &flight.values);
    let distances = values
        .map(|&(error, of_model, row)| {
            let noise = within * rows.variance[row] + between * rows.common_variance(row);
            error.abs() / (of_model + noise + left_out(row)).sqrt()
        })
        .collect();
    factor_of(distances)
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
