//! What a channel's predictions do on flights that did not teach them: the empirical null of scatter and of intervals.
//!
//! Every flight is predicted from all others, in closed form, and judged by its mean (how much flights differ) and value by
//! value (how far stated intervals reach).

use crate::learning::dials::Dials;
use crate::learning::evidence::Solved;
use crate::learning::outliers::Weights;
use crate::learning::rows::ChannelRows;
use crate::math::lower::{Lower, dot};
use crate::math::quantile::{QuantileType, quantile};
use crate::priors::NOISE_LIMITS;
use crate::thresholds::{ABSURD, FACTOR_LIMITS, ORDINARY_SEGMENTS};

/// The 97.5 % quantile of the normal distribution.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// A flight predicted from all others.
pub(super) struct Unseen {
    /// Mean error, and the model's part and the segments' part of its variance, outliers weighed down: they do not make every
    /// flight doubtful.
    mean: f64,
    of_model: f64,
    within: f64,
    /// The same of what a flight has in common, at a factor of 1.
    between: f64,
    /// Share of the flight that counts, and its weight.
    share: f64,
    weight: f64,
    /// Errors of its values, each with the model's variance and the row that it is of.
    values: Vec<(f64, f64, usize)>,
}

impl Unseen {
    /// How much it says of ordinary flights.
    const fn counts(&self) -> f64 {
        self.share * self.weight
    }
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
    // One column per row: what a row spreads over the posterior's root.
    let spread = solved.root.transpose() * rows.learnt_columns().transpose();
    let (within, between) = (dials.within.powi(2), dials.between.powi(2));
    let groups = rows.groups.iter().enumerate();
    groups
        .filter_map(|(group, range)| {
            let count = range.len();
            let share = rows.shares[group];
            let mut noise = Lower::zeros(count);
            for j in 0..count {
                for i in j..count {
                    let (a, b) = (range.start + i, range.start + j);
                    let own = if i == j { rows.variance[a] / weights.rows[a] } else { 0.0 };
                    let common: f64 = rows.loadings.iter().map(|u| u[a] * u[b]).sum();
                    *noise.at_mut(i, j) =
                        (within * own + between * common / weights.groups[group]) / share;
                }
            }
            let mut factor = noise.clone();
            factor.subtract_products(&spread, range.start);
            if !factor.factor() {
                return None;
            }
            // With Q = LLᵀ and T = L⁻¹C: e = Tᵀ·L⁻¹(y − Zα), cov e − C = TᵀT − C.
            let full = |i: usize, j: usize| noise.at(i.max(j), i.min(j));
            let mut left = errors[range.clone()].to_vec();
            factor.solve_lower(&mut left);
            let mut sums = vec![0.0; count];
            let values: Vec<(f64, f64, usize)> = (0..count)
                .map(|k| {
                    let mut turned: Vec<f64> = (0..count).map(|i| full(i, k)).collect();
                    factor.solve_lower(&mut turned);
                    for (sum, value) in sums.iter_mut().zip(&turned) {
                        *sum += value;
                    }
                    let of_model = dot(&turned, &turned) - full(k, k);
                    (dot(&turned, &left), of_model.max(0.0), range.start + k)
                })
                .collect();
            let of_noise: f64 = (0..count)
                .flat_map(|i| (0..count).map(move |k| (i, k)))
                .map(|(i, k)| full(i, k))
                .sum();
            let of_total = dot(&sums, &sums) - of_noise;
            let square = (count * count) as f64;
            let own: f64 = range.clone().map(|row| rows.variance[row] / weights.rows[row]).sum();
            let common: f64 = rows
                .loadings
                .iter()
                .map(|u| (u[range.clone()].iter().sum::<f64>() / count as f64).powi(2))
                .sum::<f64>()
                / weights.groups[group];
            Some(Unseen {
                mean: values.iter().map(|(error, ..)| error).sum::<f64>() / count as f64,
                of_model: of_total.max(0.0) / square,
                within: within * own / square,
                between: common,
                share,
                weight: weights.groups[group],
                values,
            })
        })
        .collect()
}

/// The factor between flights at which the mean errors of unseen flights are as large as announced, if that is more.
///
/// ```text
/// Σ_f s_f·e_f²/(v_model + v_within + b² v_between) = Σ_f s_f,   s the share of a flight that counts, times its weight
/// ```
pub(super) fn scatter_by_unseen(unseen: &[Unseen], now: f64) -> f64 {
    let excess = |factor: f64| {
        let of = |flight: &Unseen| {
            let announced = flight.of_model + flight.within + factor * factor * flight.between;
            // An absurd flight counts as a distant one, as far as it counts.
            flight.counts() * (flight.mean * flight.mean / announced).min(9.0)
        };
        unseen.iter().map(of).sum::<f64>() - unseen.iter().map(Unseen::counts).sum::<f64>()
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
/// What is announced of an outlier is what it was learnt with: its noise divided by its weight; an absurd one says nothing. One
/// such flight of ten would be the quantile otherwise, and make every interval as wide as itself. A flight of which less than
/// half counts is too old to say what comes. With few values a quantile is hardly known; it is drawn towards 1.96 as if so many ordinary ones had been seen in
/// addition.
pub(super) fn factor_by_unseen(
    rows: &ChannelRows,
    unseen: &[Unseen],
    (dials, weights): (&Dials, &Weights),
    left_out: impl Fn(usize) -> f64,
) -> f64 {
    let (within, between) = (dials.within.powi(2), dials.between.powi(2));
    let recent = unseen.iter().filter(|flight| flight.share >= 0.5);
    let distances = recent
        .flat_map(|flight| flight.values.iter().map(move |value| (flight.weight, value)))
        .filter(|(weight, (.., row))| weight.min(weights.rows[*row]) > ABSURD)
        .map(|(weight, &(error, of_model, row))| {
            let own = within * rows.variance[row] / weights.rows[row];
            let noise = own + between * rows.common_variance(row) / weight;
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
    use faer::linalg::solvers::{DenseSolveCore, Solve};
    use faer::{Mat, Side};
    use statrs::distribution::ContinuousCDF;

    use super::*;
    use crate::math::cholesky::Cholesky;

    /// Numbers without order, from −½ to ½: the golden ratio's multiples.
    fn number(k: usize) -> f64 {
        (k as f64 * 0.618_033_988_749_895).fract() - 0.5
    }

    /// Learning from the other flights alone, with faer's inverses: priors of 1, covariances written out.
    #[test]
    fn unseen_flights_are_as_predicted_by_the_others() {
        let (count, width) = (11, 3);
        let rows = ChannelRows {
            columns: Mat::from_fn(count, width + 1, |i, j| number(5 * i + 17 * j + 1)),
            variance: (0..count).map(|i| 0.4 + 0.5 * number(i)).collect(),
            loadings: (0..2).map(|r| (0..count).map(|i| number(3 * i + r)).collect()).collect(),
            groups: vec![0..4, 4..5, 5..11],
            shares: vec![0.5, 1.0, 0.8],
        };
        let weights = Weights {
            rows: (0..count).map(|i| 0.7 + 0.3 * number(i + 4)).collect(),
            groups: vec![1.0, 0.3, 0.8],
        };
        let dials = Dials { within: 0.7, between: 1.3, ..Dials::usual() };
        let of = |group: usize| {
            let range = rows.groups[group].clone();
            let noise = Mat::from_fn(range.len(), range.len(), |i, j| {
                let (i, j) = (range.start + i, range.start + j);
                let own = if i == j { rows.variance[i] / weights.rows[i] } else { 0.0 };
                let common: f64 = rows.loadings.iter().map(|u| u[i] * u[j]).sum();
                (0.49 * own + 1.69 * common / weights.groups[group]) / rows.shares[group]
            });
            let part = rows.columns.subrows(range.start, range.len());
            (part.subcols(0, width).to_owned(), part.col(width).to_owned(), noise)
        };
        let learnt = |left_out: Option<usize>| {
            let (mut precision, mut right) =
                (Mat::<f64>::identity(width, width), faer::Col::zeros(width));
            for group in (0..3).filter(|group| Some(*group) != left_out) {
                let (columns, values, noise) = of(group);
                let solver = noise.llt(Side::Lower).unwrap();
                precision += columns.transpose() * solver.solve(&columns);
                right += columns.transpose() * solver.solve(&values);
            }
            let covariance = precision.llt(Side::Lower).unwrap().inverse();
            (&covariance * right, covariance)
        };
        let (mean, covariance) = learnt(None);
        let solved = Solved {
            mean: Mat::from_fn(width, 1, |k, _| mean[k]),
            root: Cholesky::new(&covariance).unwrap().lower().clone(),
        };
        let found = unseen(&rows, &weights, &solved, &dials);
        assert_eq!(found.len(), 3);
        for (group, found) in found.iter().enumerate() {
            let (columns, values, _) = of(group);
            let (mean, covariance) = learnt(Some(group));
            let errors = values - &columns * mean;
            let of_model = &columns * covariance * columns.transpose();
            let size = errors.nrows();
            let same = |one: f64, other: f64| assert!((one - other).abs() < 1e-10, "{one} {other}");
            same(found.mean, errors.sum() / size as f64);
            same(found.of_model, of_model.sum() / (size * size) as f64);
            for (k, (error, variance, row)) in found.values.iter().enumerate() {
                same(*error, errors[k]);
                same(*variance, of_model[(k, k)]);
                assert_eq!(*row, rows.groups[group].start + k);
            }
        }
    }

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
