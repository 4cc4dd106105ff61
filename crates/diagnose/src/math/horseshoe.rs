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
mod tests {
    use core::f64::consts::FRAC_2_PI;

    use super::*;
    use crate::math::cholesky::Cholesky;

    /// Oracle: faer's factor.
    #[test]
    fn the_factor_is_that_of_dense_algebra() {
        let gram = Mat::from_fn(5, 5, |i, j| {
            let near = ((i + 2 * j) % 5 + (j + 2 * i) % 5) as f64;
            if i == j { 40.0 } else { near }
        });
        let product: Vec<f64> = (0..5).map(|i| f64::from(i) - 1.5).collect();
        let precisions = [0.5, 1.0, 2.0, 0.0, 3.0];
        let mut whole = gram.clone();
        (0..5).for_each(|k| whole[(k, k)] += precisions[k]);
        let expected = Cholesky::new(&whole).unwrap();
        let mut solved = Mat::from_fn(5, 1, |i, _| product[i]);
        let right = solved.clone();
        expected.solve(&mut solved);
        let candidate = Candidate { gram: Lower::of(&gram), product, ln_weight: 0.0 };
        let factor = Factor::new(&candidate, &precisions).unwrap();
        let explained: f64 = (0..5).map(|k| right[(k, 0)] * solved[(k, 0)]).sum();
        let ln_evidence = 0.5 * (explained - expected.ln_determinant());
        assert!((factor.ln_evidence() - ln_evidence).abs() < 1e-12);
        let mut found = factor.half.clone();
        factor.lower.solve_upper(&mut found);
        for (found, expected) in found.iter().zip(solved.col_as_slice(0)) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }

    /// Oracle: both factors. Precisions as far apart as they can be, and nearly alike; columns that are all but the same.
    #[test]
    fn the_gain_of_an_exchange_is_that_of_two_factors() {
        let gram = Mat::from_fn(20, 20, |i, j| match (i, j) {
            (i, j) if i == j => 400.0 + i as f64,
            (0, 1) | (1, 0) => 399.5,
            _ => ((i * j) % 7) as f64,
        });
        let product = (0..20).map(|i| 30.0 * f64::from(i) - 200.0).collect();
        let candidate = Candidate { gram: Lower::of(&gram), product, ln_weight: 0.0 };
        let mut precisions: Vec<f64> = (0..20).map(|k| 0.5 + 3.0 * f64::from(k)).collect();
        (precisions[3], precisions[7], precisions[8]) = (1e12, 1e4, 0.5001);
        for (more, less) in [(0, 1), (1, 0), (0, 3), (5, 7), (0, 8), (12, 19)] {
            let mut after = precisions.clone();
            after.swap(more, less);
            let change = precisions[less] - precisions[more];
            let before = Factor::new(&candidate, &precisions).unwrap();
            let expected = Factor::new(&candidate, &after).unwrap().ln_evidence();
            let expected = expected - before.ln_evidence();
            let found = before.gain_of_exchange(more, less, change);
            let tolerance = 1e-9 + 1e-15 * change.abs();
            assert!((found - expected).abs() < tolerance, "{more} {less}: {found} {expected}");
        }
    }

    fn candidate(gram: f64, product: f64, ln_weight: f64) -> Candidate {
        let gram = Lower::of(&Mat::from_fn(1, 1, |_, _| gram));
        Candidate { gram, product: vec![product], ln_weight }
    }

    fn prior(kept: usize) -> Horseshoe {
        Horseshoe { common_scale: 0.5, slab: 4.0, sweeps: (500, kept), seed: 20 }
    }

    /// Evidence, mean and mean square of one coefficient by the trapezium rule over ln λ and ln τ; given both, all is normal.
    fn integrated(gram: f64, product: f64) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for i in -300..=300 {
            for j in -300..=300 {
                let (own, common) = ((0.05 * f64::from(i)).exp(), (0.05 * f64::from(j)).exp());
                // Densities of half-Cauchy numbers, in their logarithms.
                let density = FRAC_2_PI * own / (1.0 + own * own) * FRAC_2_PI * common
                    / 0.5
                    / (1.0 + (common / 0.5).powi(2));
                let spread = (own * common).powi(-2);
                let precision = gram + spread + 1.0 / 16.0;
                let mean = product / precision;
                // ∫ N(β; 0, 1/spread)·N(β; 0, 16)·exp(product·β − ½ gram·β²) dβ but for constants.
                let weight = density * (spread / precision).sqrt() * (0.5 * product * mean).exp();
                sums[0] += weight;
                sums[1] += weight * mean;
                sums[2] += weight * (mean * mean + 1.0 / precision);
            }
        }
        [sums[0], sums[1] / sums[0], sums[2] / sums[0]]
    }

    /// One coefficient, of about one and of about four standard deviations. Oracle: numerical integration.
    #[test]
    fn one_coefficient_by_integration() {
        for (gram, product) in [(4.0, 2.0), (4.0, 9.0)] {
            let draws = draw(&[candidate(gram, product, 0.0)], prior(60_000)).unwrap();
            let values: Vec<f64> = (0..draws.ncols()).map(|k| draws[(0, k)]).collect();
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let square = values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
            let [_, expected, expected_square] = integrated(gram, product);
            // Four standard errors of some 6 000 independent draws.
            let tolerance = 4.0 * (expected_square - expected * expected).sqrt() / 6_000_f64.sqrt();
            assert!((mean - expected).abs() < tolerance, "{mean} {expected} {tolerance}");
            assert!(
                (square - expected_square).abs() < 4.0 * tolerance,
                "{square} {expected_square}"
            );
            // A shrunk mean: neither nothing nor least squares.
            assert!(expected > 0.05 && expected < product / gram, "{expected}");
        }
    }

    /// Two backgrounds, one of which explains what the coefficient would: the share of draws in each is that of its evidence.
    #[test]
    fn backgrounds_are_chosen_by_evidence() {
        let (gram, products) = (4.0, [6.0, 1.0]);
        let [first, second] = products.map(|product| integrated(gram, product)[0]);
        // Weights that make the two about as probable.
        let lns = [0.0, (first / second).ln() - 0.4];
        let candidates = [candidate(gram, 6.0, lns[0]), candidate(gram, 1.0, lns[1])];
        let mut chain = Chain::new(1, prior(0));
        let mut chosen = 0_u32;
        for sweep in 0..120_000 {
            if sweep % SWEEPS_TO_A_BACKGROUND == 0 {
                chain.choose(&candidates).unwrap();
                chosen += u32::try_from(chain.candidate).unwrap();
            }
            let factor = chain.exchange(&candidates[chain.candidate]).unwrap();
            chain.draw_coefficients(&factor);
            chain.draw_scales();
        }
        let share = f64::from(chosen) / 12_000.0;
        let expected = 1.0 / (1.0 + 0.4_f64.exp());
        assert!((share - expected).abs() < 0.03, "{share} {expected}");
    }

    /// Two columns that are all but one and the same: each is the larger one in half of the draws. Oracle: symmetry. One chain
    /// that moved one column at a time would stay with the first that it met.
    #[test]
    fn of_two_like_columns_each_leads_half_of_the_time() {
        let gram = Mat::from_fn(6, 6, |i, j| match (i, j) {
            (i, j) if i == j => 400.0,
            (0, 1) | (1, 0) => 399.9,
            _ => 0.0,
        });
        let product = (0..6).map(|i| if i < 2 { 400.0 } else { 0.0 }).collect();
        let draws = draw(
            &[Candidate { gram: Lower::of(&gram), product, ln_weight: 0.0 }],
            Horseshoe { common_scale: 0.05, ..prior(4_000) },
        );
        let draws = draws.unwrap();
        let first = (0..4_000).filter(|k| draws[(0, *k)].abs() > draws[(1, *k)].abs()).count();
        assert!((1_400..2_600).contains(&first), "{first}");
        // Mostly one of them makes all of it, and seldom both a half.
        let one = (0..4_000).filter(|k| {
            let share = draws[(0, *k)] / (draws[(0, *k)] + draws[(1, *k)]);
            !(0.2..0.8).contains(&share)
        });
        assert!(one.count() > 2_000);
    }

    /// Shapes of whole and of half numbers: mean and variance are the shape.
    #[test]
    fn gamma_numbers_have_their_moments() {
        let mut random = RandomStream::new(3, 0);
        for halves in [3, 8] {
            let numbers: Vec<f64> = (0..40_000).map(|_| half_gamma(&mut random, halves)).collect();
            let shape = halves as f64 / 2.0;
            let mean = numbers.iter().sum::<f64>() / 40_000.0;
            let variance = numbers.iter().map(|n| (n - mean).powi(2)).sum::<f64>() / 40_000.0;
            assert!((mean - shape).abs() < 5.0 * (shape / 40_000.0).sqrt(), "{mean} {shape}");
            assert!((variance / shape - 1.0).abs() < 0.1, "{variance} {shape}");
        }
    }
}
