//! One channel learnt: outlier weights, sizes of noise and remainder, posterior.

use faer::Mat;

use crate::learning::dials::Dials;
use crate::learning::evidence::{Evidence, Weighted};
use crate::learning::outliers::Weights;
use crate::learning::posterior::{ChannelPosterior, prior_variances};
use crate::learning::prior::Prior;
use crate::learning::rows::ChannelRows;
use crate::learning::sums::ChannelSums;
use crate::learning::turned::TurnedFlights;
use crate::learning::unseen::{Unseen, scatter_by_unseen, unseen};
use crate::math::lower::dot;
use crate::math::pivoted::{Pivoted, pivoted};
use crate::thresholds::FEWEST_FLIGHTS_OF_SCATTER;

/// How often the scatter between flights is raised. Our choice: raising it changes the fit that it is judged by, so that once is
/// not enough.
const INFLATIONS: usize = 3;
/// How often outliers are weighed. Our choice: a bound on time; clean flights need one.
const MOST_WEIGHINGS: usize = 5;
/// How often by noise alone before scales are sought. Our choice: absurd values are down after two.
const MOST_WEIGHINGS_BY_NOISE: usize = 2;
/// Growth of the scatter below which it is not raised again. Our choice: noise need not be known better.
const SETTLED_SCATTER: f64 = 1.02;
/// Steps of the search in ln of a factor, before outliers are weighed and after. Our choice: a factor of two, down to a fifth;
/// a parabola through three values finds what lies between them, and flights leave some tens of per cent open.
const FIRST_STEPS: [f64; 2] = [0.6, 0.2];
const STEPS: [f64; 1] = [0.12];
/// The same from what was likeliest of rows that are nearly the same.
const NEARBY_STEPS: [f64; 2] = [0.2, 0.12];
/// Noise within flights at which columns are chosen, over that of the aircraft file. Our choice: about the least that is ever
/// found, where the most columns can be told apart.
const QUIET: f64 = 0.2;
/// Information that may be left out of a column there, in prior standard deviations squared: 2 % of the posterior's.
const NEGLIGIBLE: f64 = 0.02;

/// What a channel's rows came to.
pub(super) struct LearntChannel {
    pub(super) posterior: ChannelPosterior,
    pub(super) weights: Weights,
    /// Every flight predicted from all others.
    pub(super) unseen: Vec<Unseen>,
    /// What is left of every value.
    pub(super) left: Vec<f64>,
}

/// Learns a channel. `groups` are the scales of its columns: 0 none, 1 and on those of [`Dials::scales`]. `None` where matrices
/// are not positive definite.
pub(super) fn learn_channel(
    rows: &ChannelRows,
    groups: &[usize],
    turned: &mut TurnedFlights,
) -> Option<LearntChannel> {
    let few = FewColumns::of(rows, groups);
    let Weighed { weights, sums, dials: before, left, .. } = few.weigh(turned)?;
    let mut evidence = Evidence::new(&sums, &few.prior);
    let mut dials = before;
    let unseen = raise_scatter(&few.rows, &weights, &mut evidence, &mut dials)?;
    let points = points_raised(&mut evidence, &before, &dials);
    let posterior = ChannelPosterior::averaged(&mut evidence, &points, &few.reduction, groups)?;
    Some(LearntChannel { posterior, weights, unseen, left })
}

/// Few columns of a channel that hold all others, whatever the weights.
pub(super) struct FewColumns {
    reduction: Pivoted,
    prior: Prior,
    rows: ChannelRows,
}

/// A fit with outliers weighed: at the likeliest noise, with nothing raised and nothing averaged.
pub(super) struct Weighed {
    pub(super) weights: Weights,
    sums: ChannelSums,
    pub(super) dials: Dials,
    left: Vec<f64>,
    mean: Mat<f64>,
}

impl FewColumns {
    pub(super) fn of(rows: &ChannelRows, groups: &[usize]) -> Self {
        let width = groups.len();
        let own = ChannelSums::own(rows, &Weights::of_one(rows));
        let quiet = Mat::from_fn(width, width, |i, j| own[(i, j)] / (QUIET * QUIET));
        let reduction = pivoted(&quiet, width, NEGLIGIBLE);
        let prior = Prior::of(&reduction, groups);
        let rows = rows.only(&reduction.pivots);
        Self { reduction, prior, rows }
    }

    /// Fits, and weighs what lies far from the fit, until weights stay. The first times only noise is sought: scales that are sought
    /// among outliers are large enough to follow them, and then nothing lies far.
    pub(super) fn weigh(&self, turned: &mut TurnedFlights) -> Option<Weighed> {
        let mut weights = Weights::before(&self.rows);
        let mut dials = Dials::usual();
        // Weighings by noise alone.
        let mut before = if self.prior.has_scales() { 0 } else { MOST_WEIGHINGS_BY_NOISE };
        let mut steps: &[f64] = &FIRST_STEPS;
        for weighing in 1.. {
            let sums = ChannelSums::new(&self.rows, &weights, turned);
            let mut evidence = Evidence::new(&sums, &self.prior);
            let by_noise = before < MOST_WEIGHINGS_BY_NOISE;
            dials = if by_noise {
                evidence.likeliest_noise(dials, steps)
            } else {
                evidence.likeliest(dials, steps)
            };
            let mean = evidence.mean(&dials)?;
            let left = self.rows.left(&mean);
            let next = weights.after(&self.rows, &left, &dials);
            let is_settled = next.settled(&weights);
            steps = &STEPS;
            if by_noise {
                before = if is_settled { MOST_WEIGHINGS_BY_NOISE } else { before + 1 };
                if before == MOST_WEIGHINGS_BY_NOISE {
                    steps = &FIRST_STEPS;
                }
            } else if is_settled || weighing >= MOST_WEIGHINGS {
                return Some(Weighed { weights, sums, dials, left, mean });
            }
            weights = next;
        }
        None
    }

    /// Coefficients of all columns at a fit, in their prior standard deviations.
    ///
    /// ```text
    /// β = ΛTᵀK⁻¹α,   α the few columns' coefficients, T all columns in terms of them, K = TΛTᵀ
    /// ```
    pub(super) fn coefficients(&self, fit: &Weighed, groups: &[usize]) -> Option<Vec<f64>> {
        let mut covariance = self.prior.covariance(fit.dials.scales);
        let mut solved = fit.mean.col_as_slice(0).to_vec();
        if !covariance.factor() {
            return None;
        }
        covariance.solve_lower(&mut solved);
        covariance.solve_upper(&mut solved);
        let variances = prior_variances(groups, fit.dials.scales);
        let of = |(column, variance): (usize, f64)| {
            variance * dot(self.reduction.transfer.col_as_slice(column), &solved)
        };
        Some(variances.into_iter().enumerate().map(of).collect())
    }

    /// ln of the marginal likelihood of what was recorded, with these weights, at the likeliest noise from a start, and that noise; of
    /// no use where matrices are not positive definite.
    pub(super) fn ln_evidence(
        &self,
        weights: &Weights,
        start: Dials,
        turned: &mut TurnedFlights,
    ) -> (f64, Dials) {
        let sums = ChannelSums::new(&self.rows, weights, turned);
        let mut evidence = Evidence::new(&sums, &self.prior);
        let likeliest = evidence.likeliest(start, &NEARBY_STEPS);
        (evidence.ln_evidence(&likeliest), likeliest)
    }
}

/// The points that the posterior is averaged over. What flights leave open is about the likeliest scatter; what unseen flights add
/// to it they add to every point. About the raised scatter the likelihood falls, and averaging would take back half of it.
fn points_raised(evidence: &mut Evidence<'_>, likeliest: &Dials, raised: &Dials) -> Vec<Weighted> {
    let mut points = evidence.points(*likeliest);
    let raise = raised.between / likeliest.between;
    for point in &mut points {
        point.dials.between *= raise;
    }
    points
}

/// Raises the scatter between flights to what unseen flights show, where there are enough to know, and returns those.
fn raise_scatter(
    rows: &ChannelRows,
    weights: &Weights,
    evidence: &mut Evidence<'_>,
    dials: &mut Dials,
) -> Option<Vec<Unseen>> {
    let mut others = Vec::new();
    for _ in 0..INFLATIONS {
        others = unseen(rows, weights, &evidence.solved(dials)?, dials);
        if others.len() < FEWEST_FLIGHTS_OF_SCATTER {
            break;
        }
        let between = scatter_by_unseen(&others, dials.between);
        let settled = between < SETTLED_SCATTER * dials.between;
        dials.between = between;
        if settled {
            break;
        }
    }
    Some(others)
}

#[cfg(test)]
mod tests {
    use faer::Side;
    use faer::linalg::solvers::Solve;

    use super::*;

    /// Eight flights that differ four times as much as stated. What is believed of scatter draws the likeliest towards the
    /// statement; unseen flights raise it, and averaging leaves it raised: they err no more than announced.
    #[test]
    fn averaging_keeps_the_scatter_that_unseen_flights_showed() {
        let (flights, each) = (8, 3);
        let count = flights * each;
        let number = |k: usize| (k as f64 * 0.618_033_988_749_895).fract() - 0.5;
        let rows = ChannelRows {
            columns: Mat::from_fn(count, 2, |row, column| {
                if column == 0 { 1.0 } else { 0.1 * number(row) + 14.0 * number(row / each + 40) }
            }),
            variance: vec![0.01; count],
            loadings: vec![vec![1.0; count]],
            groups: (0..flights).map(|flight| flight * each..(flight + 1) * each).collect(),
            shares: vec![1.0; flights],
        };
        let found = learn_channel(&rows, &[0], &mut TurnedFlights::default()).unwrap();
        let between = found.posterior.dials.between;
        assert!(between > 2.0, "{between}");
        let needed = scatter_by_unseen(&found.unseen, between);
        assert!(needed <= between, "{between}, and {needed} needed");
    }

    /// Ridge regression with the covariance of each flight written out (faer's Cholesky solver), at the noise that was found.
    #[test]
    fn coefficients_are_those_of_a_dense_regression() {
        let (flights, each, width) = (6, 4, 3);
        let count = flights * each;
        let number = |k: usize| (k as f64 * 0.618_033_988_749_895).fract() - 0.5;
        let rows = ChannelRows {
            columns: Mat::from_fn(count, width + 1, |i, j| number(7 * i + 11 * j + 2)),
            variance: (0..count).map(|i| 0.1 + 0.1 * (number(i) + 0.5)).collect(),
            loadings: vec![(0..count).map(|i| 0.2 + number(i + 9)).collect()],
            groups: (0..flights).map(|flight| flight * each..(flight + 1) * each).collect(),
            shares: vec![1.0; flights],
        };
        let groups = [0; 3];
        let few = FewColumns::of(&rows, &groups);
        let fit = few.weigh(&mut TurnedFlights::default()).unwrap();
        assert!(fit.weights.rows.iter().chain(&fit.weights.groups).all(|weight| *weight > 0.99));
        let covariance = Mat::from_fn(count, count, |i, j| {
            let own = if i == j { rows.variance[i] } else { 0.0 };
            let is_common = i / each == j / each;
            let common = if is_common { rows.loadings[0][i] * rows.loadings[0][j] } else { 0.0 };
            fit.dials.within.powi(2) * own + fit.dials.between.powi(2) * common
        });
        let columns = rows.columns.subcols(0, width);
        let solved = covariance.llt(Side::Lower).unwrap().solve(&rows.columns);
        let products = columns.transpose() * solved;
        let precision =
            Mat::from_fn(width, width, |i, j| products[(i, j)] + if i == j { 1.0 } else { 0.0 });
        let right = Mat::from_fn(width, 1, |i, _| products[(i, width)]);
        let expected = precision.llt(Side::Lower).unwrap().solve(&right);
        for (k, found) in few.coefficients(&fit, &groups).unwrap().into_iter().enumerate() {
            let known: f64 = expected[(k, 0)];
            assert!((found - known).abs() < 1e-9 * (1.0 + known.abs()), "{k}: {found} {known}");
        }
    }
}
