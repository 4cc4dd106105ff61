//! From the few columns in which a channel is learnt to all of its coefficients, averaged over the sizes of noise and
//! remainder.

use faer::Mat;

use crate::learning::dials::{Dials, MOST_DIALS, SCALES};
use crate::learning::evidence::{Evidence, Weighted};
use crate::math::cholesky::Cholesky;
use crate::math::linear::{add_gram, subtract_gram, symmetrize};
use crate::math::pivoted::Pivoted;

/// Mean and covariance of the coefficients of a channel, in their prior standard deviations.
pub(super) struct ChannelPosterior {
    pub(super) mean: Vec<f64>,
    pub(super) covariance: Mat<f64>,
    /// Root mean squares of the factors that were averaged over.
    pub(super) dials: Dials,
}

impl ChannelPosterior {
    /// Averages over the points.
    ///
    /// ```text
    /// mean α = Σ p α_i,   V = Σ p (V_i + (α_i − α)(α_i − α)ᵀ),   K = RRᵀ and Λ of the mean squares of the scales
    /// β = ΛTᵀK⁻¹α,   cov β = Λ − YYᵀ + (YR⁻¹)V(YR⁻¹)ᵀ,   Y = ΛTᵀR⁻ᵀ
    /// ```
    ///
    /// α are the columns that were learnt, T every column in terms of them, Λ the prior variances of all; `None` where
    /// a matrix is not positive definite.
    pub(super) fn averaged(
        evidence: &mut Evidence<'_>,
        points: &[Weighted],
        reduction: &Pivoted,
        groups: &[usize],
    ) -> Option<Self> {
        let (width, rank) = (groups.len(), reduction.pivots.len());
        let mut spread = Mat::<f64>::zeros(rank, rank);
        let mut mean = Mat::<f64>::zeros(rank, 1);
        let mut means = Vec::with_capacity(points.len());
        let mut squares = [0.0; MOST_DIALS];
        for Weighted { dials, weight } in points {
            let (found, covariance) = evidence.mean_and_covariance(dials)?;
            covariance.add_to(*weight, &mut spread);
            mean += faer::Scale(*weight) * &found;
            means.push(found);
            let [smooth, products, straight] = dials.scales;
            let all = [dials.within, dials.between, smooth, products, straight];
            for (sum, value) in squares.iter_mut().zip(all) {
                *sum += weight * value * value;
            }
        }
        let apart = Mat::from_fn(points.len(), rank, |at, k| {
            points[at].weight.sqrt() * (means[at][(k, 0)] - mean[(k, 0)])
        });
        add_gram(&mut spread, apart.as_ref());
        let [within, between, smooth, products, straight] = squares.map(f64::sqrt);
        let dials = Dials { within, between, scales: [smooth, products, straight] };
        let variance = prior_variances(groups, dials.scales);
        let root = Cholesky::in_place(evidence.prior().covariance(dials.scales).to_mat())?;
        // Yᵀ = R⁻¹TΛ, and K⁻¹TΛ.
        let mut turned = Mat::from_fn(rank, width, |k, column| {
            reduction.transfer[(k, column)] * variance[column]
        });
        root.solve_lower(&mut turned);
        let mut covariance = Mat::<f64>::zeros(width, width);
        subtract_gram(&mut covariance, &turned.transpose().to_owned());
        root.solve_upper(&mut turned);
        let known = Cholesky::new(&spread)?;
        let part = known.lower().transpose() * &turned;
        add_gram(&mut covariance, part.as_ref());
        for (k, variance) in variance.iter().enumerate() {
            covariance[(k, k)] += variance;
        }
        symmetrize(&mut covariance);
        let mean = (turned.transpose() * &mean).col_as_slice(0).to_vec();
        Some(Self { mean, covariance, dials })
    }
}

/// Prior variances of columns: 1, or the square of the scale of their group.
pub(super) fn prior_variances(groups: &[usize], scales: [f64; SCALES]) -> Vec<f64> {
    let of = |group: &usize| group.checked_sub(1).map_or(1.0, |at| scales[at] * scales[at]);
    groups.iter().map(of).collect()
}
