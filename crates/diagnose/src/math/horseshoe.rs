//! All columns of a Gram at once under a prior that shrinks what is small and leaves what is large: the horseshoe.
//!
//! ```text
//! β_j ~ N(0, τ² λ_j²)·N(0, c²),  λ_j ~ C⁺(0, 1),  τ ~ C⁺(0, τ₀)                                   [diagnosis.55]
//! ```
//!
//! # Source
//! Carvalho, C. M., Polson, N. G., and Scott, J. G.: The horseshoe estimator for sparse signals. Biometrika 97 (2010), 465–480.
//! The slab c: Piironen, J., and Vehtari, A.: Sparsity information and regularization in the horseshoe and other shrinkage
//! priors. Electronic Journal of Statistics 11 (2017), 5018–5051. The steps of the sampler: Makalic, E., and Schmidt, D. F.: A
//! simple sampler for the horseshoe estimator. IEEE Signal Processing Letters 23 (2016), 179–182.
//!
//! Difficult: of two columns that are alike either may be the large one, and no step that moves one of them at a time gets from
//! the one answer to the other. So the largest scale changes places with another, by the ratio of evidences (Metropolis).

use faer::Mat;

use crate::math::lower::{Lower, dot};
use crate::math::random::RandomStream;

/// Largest precision of a column's prior: a millionth of its unit is nothing, and matrices stay finite.
const LARGEST_PRECISION: f64 = 1e12;
/// Sweeps between two choices of the background, each of which factors every one of them.
const SWEEPS_TO_A_BACKGROUND: usize = 10;

/// A linear system from which all but its columns was integrated out, residuals of unit variance.
pub(crate) struct Candidate {
    /// Products of the columns with each other.
    pub(crate) gram: Lower,
    /// Products of the columns with the residuals.
    pub(crate) product: Vec<f64>,
    /// ln of its prior probability and of its evidence without any column.
    pub(crate) ln_weight: f64,
}

/// What the prior believes and how long is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Horseshoe {
    /// Scale τ₀ of the size that is common to all columns.
    pub(crate) common_scale: f64,
    /// Standard deviation c of the slab.
    pub(crate) slab: f64,
    /// Sweeps that are thrown away, and draws that are kept.
    pub(crate) sweeps: (usize, usize),
    pub(crate) seed: u64,
}

/// Draws of all coefficients, one column a draw; `None` where a matrix is not positive definite.
pub(crate) fn draw(candidates: &[Candidate], prior: Horseshoe) -> Option<Mat<f64>> {
    let size = candidates.first()?.product.len();
    let mut chain = Chain::new(size, prior);
    let (discarded, kept) = prior.sweeps;
    let mut draws = Mat::zeros(size, kept);
    for sweep in 0..discarded + kept {
        if candidates.len() > 1 && sweep % SWEEPS_TO_A_BACKGROUND == 0 {
            chain.choose(candidates)?;
        }
        let factor = chain.exchange(&candidates[chain.candidate])?;
        chain.draw_coefficients(&factor);
        chain.draw_scales();
        if let Some(place) = sweep.checked_sub(discarded) {
            draws.col_as_slice_mut(place).copy_from_slice(&chain.coefficients);
        }
    }
    Some(draws)
}

/// Where a sampler is.
struct Chain {
    prior: Horseshoe,
    random: RandomStream,
    candidate: usize,
    coefficients: Vec<f64>,
    /// λ², and the auxiliary variables of λ.
    own: Vec<f64>,
    own_auxiliary: Vec<f64>,
    /// τ², and its auxiliary variable.
    common: f64,
    common_auxiliary: f64,
}

impl Chain {
    fn new(size: usize, prior: Horseshoe) -> Self {
        /// Stream of these draws among those of a seed.
        const STREAM: u64 = 0x5A0E;
        let common = prior.common_scale * prior.common_scale;
        Self {
            prior,
            random: RandomStream::new(prior.seed, STREAM),
            candidate: 0,
            coefficients: vec![0.0; size],
            own: vec![1.0; size],
            own_auxiliary: vec![1.0; size],
            common,
            common_auxiliary: common,
        }
    }

    /// Factor of a candidate's precision under the present scales.
    fn factored(&self, candidate: &Candidate) -> Option<Factor> {
        let precisions: Vec<f64> = self.own.iter().map(|&own| self.precision(own)).collect();
        Factor::new(candidate, &precisions)
    }

    /// Precision of the prior of a column of this λ².
    fn precision(&self, own: f64) -> f64 {
        (1.0 / (own * self.common) + self.prior.slab.powi(-2)).min(LARGEST_PRECISION)
    }

    /// Lets the largest of the columns' own scales change places with one of the others, if that is no worse, or by chance; gives
    /// the factor under the scales that it leaves.
    ///
    /// The scale that is largest afterwards is the same, so that the way back is as probable; the prior is the same for all
    /// columns, and what the evidence leaves out is a product over all of them.
    fn exchange(&mut self, candidate: &Candidate) -> Option<Factor> {
        let size = self.own.len();
        let largest = (0..size).max_by(|a, b| self.own[*a].total_cmp(&self.own[*b]))?;
        let factor = self.factored(candidate)?;
        if size < 2 {
            return Some(factor);
        }
        let other = (largest + 1 + self.random.below(size - 1)) % size;
        let [fewer, more] = [largest, other].map(|place| self.precision(self.own[place]));
        let gain = factor.gain_of_exchange(largest, other, more - fewer);
        if self.random.uniform().ln() > gain {
            return Some(factor);
        }
        self.swap(largest, other);
        self.factored(candidate)
    }

    fn swap(&mut self, one: usize, other: usize) {
        self.own.swap(one, other);
        self.own_auxiliary.swap(one, other);
    }

    /// Draws which candidate holds, coefficients integrated out; what depends on the scales alone is common to all.
    fn choose(&mut self, candidates: &[Candidate]) -> Option<()> {
        let mut lns = Vec::with_capacity(candidates.len());
        for candidate in candidates {
            lns.push(candidate.ln_weight + self.factored(candidate)?.ln_evidence());
        }
        let largest = lns.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights = lns.iter().map(|ln| (ln - largest).exp());
        let mut left = self.random.uniform() * weights.clone().sum::<f64>();
        self.candidate = lns.len() - 1;
        for (place, weight) in weights.enumerate() {
            left -= weight;
            if left <= 0.0 {
                self.candidate = place;
                break;
            }
        }
        Some(())
    }

    fn draw_coefficients(&mut self, factor: &Factor) {
        self.random.fill(&mut self.coefficients);
        for (normal, half) in self.coefficients.iter_mut().zip(&factor.half) {
            *normal += half;
        }
        factor.lower.solve_upper(&mut self.coefficients);
    }

    fn draw_scales(&mut self) {
        let (random, common) = (&mut self.random, self.common);
        let mut sum = 0.0;
        for ((own, auxiliary), value) in
            self.own.iter_mut().zip(&mut self.own_auxiliary).zip(&self.coefficients)
        {
            let square = value * value;
            *own = (1.0 / *auxiliary + square / (2.0 * common)) / random.exponential();
            *auxiliary = (1.0 + 1.0 / *own) / random.exponential();
            sum += square / *own;
        }
        let gamma = half_gamma(random, self.coefficients.len() + 1);
        self.common = (1.0 / self.common_auxiliary + 0.5 * sum) / gamma;
        let scale = self.prior.common_scale.powi(-2);
        self.common_auxiliary = (scale + 1.0 / self.common) / random.exponential();
    }
}

/// Cholesky factor of a gram with precisions added to its diagonal, and `L⁻¹` of the product.
struct Factor {
    lower: Lower,
    half: Vec<f64>,
}

impl Factor {
    /// `None` where the matrix is not positive definite.
    fn new(candidate: &Candidate, precisions: &[f64]) -> Option<Self> {
        let mut lower = candidate.gram.clone();
        for (k, precision) in precisions.iter().enumerate() {
            *lower.at_mut(k, k) += precision;
        }
        if !lower.factor() {
            return None;
        }
        let mut half = candidate.product.clone();
        lower.solve_lower(&mut half);
        Some(Self { lower, half })
    }

    /// ln of the evidence, coefficients integrated out, but for what the precisions have in common.
    fn ln_evidence(&self) -> f64 {
        0.5 * (dot(&self.half, &self.half) - self.lower.ln_determinant())
    }

    /// What that grows by if the precision of one column is so much more, and that of another so much less.
    ///
    /// ```text
    /// |A + E D Eᵀ| = |A|·|1 + D C|,  bᵀ(A + E D Eᵀ)⁻¹b = bᵀA⁻¹b − vᵀ(1 + D C)⁻¹D v,  C = EᵀA⁻¹E,  v = EᵀA⁻¹b
    /// ```
    ///
    /// The determinant is a difference of ones where a large precision goes, and right to 1e-16 of that precision: far more than
    /// a choice by chance needs. −∞ where rounding leaves nothing.
    fn gain_of_exchange(&self, more: usize, less: usize, change: f64) -> f64 {
        let [a, b] = [more, less].map(|place| {
            let mut column = vec![0.0; self.half.len()];
            column[place] = 1.0;
            self.lower.solve_lower(&mut column);
            column
        });
        let [of_a, of_b] = [&a, &b].map(|column| dot(column, &self.half));
        let (own_a, own_b, cross) =
            (1.0 + change * dot(&a, &a), 1.0 - change * dot(&b, &b), change * dot(&a, &b));
        let determinant = own_a * own_b + cross * cross;
        if determinant.is_nan() || determinant <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let explained = own_b * of_a * of_a + 2.0 * cross * of_a * of_b - own_a * of_b * of_b;
        -0.5 * (change * explained / determinant + determinant.ln())
    }
}

/// A gamma number of shape `halves`/2 and unit rate: exponentials, and half the square of a normal number.
fn half_gamma(random: &mut RandomStream, halves: usize) -> f64 {
    let whole: f64 = (0..halves / 2).map(|_| random.exponential()).sum();
    let mut normal = [0.0];
    if halves % 2 == 1 {
        random.fill(&mut normal);
    }
    whole + 0.5 * normal[0] * normal[0]
}

#[cfg(test)]
mod tests;
