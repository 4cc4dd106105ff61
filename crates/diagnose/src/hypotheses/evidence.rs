//! The search: every single effect and every pair, scored by closed-form Gaussian evidence over backgrounds.
//!
//! Difficult: everything happens on small matrices from which all that no hypothesis names (nuisance, smooth discrepancy,
//! small amounts of every other effect) was integrated out before. A hypothesis is a choice of columns; an effect with a hidden
//! parameter has several columns that share its prior mass.

use flight::effect::{EffectGroup, EffectId, EffectSign};
use statrs::function::erf::erfc;

use crate::hypotheses::backgrounds::Background;
use crate::library::{Library, Testable};
use crate::math::mixture::{Evidence, Factored, Mixture};
use crate::math::vector_ln_exp::{exp, ln};
use crate::priors::{
    EXPECTED_SIGN, FLIGHT_SCATTER_SIZES_PERCENT, NOISE_FREEDOM, PRIOR_BY_SIZE, PRIOR_SCALES,
};

/// What a hypothesis is made of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Hypothesis {
    /// Columns, at most two.
    pub(crate) columns: Vec<usize>,
    /// Flight-to-flight scatter, per cent.
    pub(crate) flight_scatter_percent: Option<f64>,
}

/// A hypothesis with its score.
#[derive(Clone, Debug)]
pub(crate) struct ScoredHypothesis {
    pub(crate) hypothesis: Hypothesis,
    /// ln of evidence times prior, summed over backgrounds.
    pub(crate) ln_weight: f64,
    /// Posterior means and standard deviations of the sizes.
    pub(crate) sizes: Vec<f64>,
    pub(crate) deviations: Vec<f64>,
    /// The background under which the hypothesis is most probable.
    pub(crate) background: usize,
    /// Share of its weight in backgrounds in which the drag table is uncertain.
    pub(crate) table_share: f64,
}

/// Prior of a column.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prior {
    pub(crate) mean: f64,
    /// Standard deviations and ln probabilities.
    pub(crate) scales: [(f64, f64); PRIOR_SCALES.len()],
    pub(crate) count: usize,
    pub(crate) sign: EffectSign,
}

/// What one column comes to in one background.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Single {
    pub(crate) gram: f64,
    pub(crate) product: f64,
    pub(crate) square: f64,
    pub(crate) ln_determinant: f64,
}

/// Everything the scoring of models needs.
#[derive(Clone, Debug)]
pub(crate) struct Scorer {
    pub(crate) priors: Vec<Prior>,
    /// Effect of each column.
    pub(crate) effect_of: Vec<usize>,
    /// ln of the number of hidden parameters that each column is one of.
    pub(crate) ln_choices: Vec<f64>,
    pub(crate) effects: usize,
    /// Of every effect, which part gets worse with age by it.
    pub(crate) age_of: Vec<Option<EffectGroup>>,
    /// Effects that no hypothesis names, because the uncertain table holds them.
    pub(crate) held: Vec<bool>,
    pub(crate) rows: f64,
}

impl Prior {
    /// That of the size of an effect: a known one, or as large as such effects usually are.
    pub(crate) fn of(effect: &Testable) -> Self {
        let deviation = effect.prior_deviation;
        let (scales, count) = if effect.has_known_size {
            ([(deviation, 0.0); PRIOR_SCALES.len()], 1)
        } else {
            let free = PRIOR_SCALES.map(|(scale, share)| (scale * deviation, share.ln()));
            (free, PRIOR_SCALES.len())
        };
        Self { mean: effect.prior_mean, scales, count, sign: effect.sign }
    }

    /// ln of its density at a size, sign included.
    pub(crate) fn ln_density(&self, size: f64) -> f64 {
        let root = (2.0 * core::f64::consts::PI).sqrt();
        let mut own = [f64::NEG_INFINITY; PRIOR_SCALES.len()];
        for (own, &(deviation, ln_share)) in own.iter_mut().zip(&self.scales[..self.count]) {
            let z = (size - self.mean) / deviation;
            *own = ln_share - 0.5 * z * z - ln(deviation * root);
        }
        let largest = own.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = own.into_iter().map(|own| exp(own - largest)).sum();
        let sign = match self.sign {
            EffectSign::Positive if size > 0.0 => 2.0 * EXPECTED_SIGN,
            EffectSign::Positive => 2.0 * (1.0 - EXPECTED_SIGN),
            _ => 1.0,
        };
        largest + ln(sum * sign)
    }
}

/// The part that gets worse with age by an effect; `None` for any other effect.
const fn part_that_ages(id: EffectId) -> Option<EffectGroup> {
    match id {
        EffectId::EngineAgeing
        | EffectId::EngineHistory
        | EffectId::AirframeAgeing
        | EffectId::AirframeHistory => Some(id.entry().group),
        _ => None,
    }
}

impl Scorer {
    pub(crate) fn new(library: &Library, rows: f64, held: Vec<bool>) -> Self {
        let priors = library
            .columns
            .iter()
            .map(|column| Prior::of(&library.effects[column.effect]))
            .collect();
        Self {
            priors,
            effect_of: library.columns.iter().map(|column| column.effect).collect(),
            ln_choices: library.columns.iter().map(|column| column.ln_choices).collect(),
            age_of: library.effects.iter().map(|effect| part_that_ages(effect.id)).collect(),
            effects: library.effects.len() + usize::from(library.heating_value)
                - held.iter().filter(|held| **held).count(),
            held,
            rows,
        }
    }

    pub(crate) fn columns(&self) -> usize {
        self.priors.len()
    }

    /// Whether two columns are ageing and history of one part: a history whose falls take nothing back is ageing, and both
    /// together, one against the other, are a step.
    pub(crate) fn is_one_history(&self, one: usize, other: usize) -> bool {
        let part = self.part_that_ages(one);
        part.is_some() && part == self.part_that_ages(other)
    }

    /// The part that gets worse with age by the effect of a column.
    pub(crate) fn part_that_ages(&self, column: usize) -> Option<EffectGroup> {
        self.age_of[self.effect_of[column]]
    }

    pub(crate) fn power(&self) -> f64 {
        0.5 * (NOISE_FREEDOM + self.rows)
    }

    /// ln prior of a hypothesis: of its number of effects, of which ones, of their hidden parameters. Over all models the priors
    /// sum to one.
    pub(crate) fn ln_prior(&self, hypothesis: &Hypothesis) -> f64 {
        if hypothesis.columns.iter().any(|&column| self.held[self.effect_of[column]]) {
            return f64::NEG_INFINITY;
        }
        let size =
            hypothesis.columns.len() + usize::from(hypothesis.flight_scatter_percent.is_some());
        let count = self.effects as f64;
        let choices = match size {
            0 => 1.0,
            1 => count,
            _ => 0.5 * count * (count - 1.0),
        };
        let hidden: f64 = hypothesis.columns.iter().map(|&column| self.ln_choices[column]).sum();
        let heating = if hypothesis.flight_scatter_percent.is_some() {
            (FLIGHT_SCATTER_SIZES_PERCENT.len() as f64).ln()
        } else {
            0.0
        };
        let share = PRIOR_BY_SIZE[size.min(2)] / PRIOR_BY_SIZE.iter().sum::<f64>();
        share.ln() - f64::ln(choices) - hidden - heating
    }

    pub(crate) fn none(&self, at: &Background) -> f64 {
        self.nothing(at.square, at.ln_determinant)
    }

    /// As [`none`](Self::none).
    pub(crate) fn nothing(&self, square: f64, ln_determinant: f64) -> f64 {
        ln_evidence_of_left(self.rows, square, ln_determinant)
    }

    /// One effect; `shift` is the size at which the model was linearised.
    ///
    /// ```text
    /// ln p = −½ ln|1 + Z'Z| − ½ ln(M/λ) − ½(ν0 + n) ln(ν0 + q + λμ² − r²/M) + ln 2P(sign)     [diagnosis.19]
    /// M = G + λ,  r = b + λμ,  λ = 1/s²
    /// ```
    pub(crate) fn one(&self, at: &Background, column: usize, shift: f64) -> Evidence<1> {
        let single = Single {
            gram: at.gram(column, column),
            product: at.product(column),
            square: at.square,
            ln_determinant: at.ln_determinant,
        };
        self.single(single, column, shift)
    }

    /// As [`one`](Self::one).
    pub(crate) fn single(&self, at: Single, column: usize, shift: f64) -> Evidence<1> {
        let prior = self.priors[column];
        let Single { gram, product, .. } = at;
        let mut sum = Factored::new();
        for &(deviation, ln_share) in &prior.scales[..prior.count] {
            let precision = 1.0 / (deviation * deviation);
            let mean = prior.mean - shift;
            let posterior = gram + precision;
            let right = product + precision * mean;
            let size = right / posterior;
            let square = at.square + precision * mean * mean - right * size;
            let scale = (NOISE_FREEDOM + square) / (NOISE_FREEDOM + self.rows);
            let variance = scale / posterior;
            let size = size + shift;
            let factor =
                (precision / posterior).sqrt() * sign_factor(prior.sign, size / variance.sqrt());
            let ln = ln_share - self.power() * (NOISE_FREEDOM + square).ln();
            sum.add(ln, factor, size, variance);
        }
        let mut evidence = sum.mean();
        evidence.ln -= 0.5 * at.ln_determinant;
        evidence
    }

    /// Two effects, `shifts` as above.
    pub(crate) fn two(
        &self,
        at: &Background,
        columns: [usize; 2],
        shifts: [f64; 2],
    ) -> Evidence<2> {
        let [a, b] = columns;
        let (prior_a, prior_b) = (self.priors[a], self.priors[b]);
        let cross = at.gram(a, b);
        let mut sum = Mixture::<2>::new();
        for &(deviation_a, ln_a) in &prior_a.scales[..prior_a.count] {
            for &(deviation_b, ln_b) in &prior_b.scales[..prior_b.count] {
                let precision =
                    [1.0 / (deviation_a * deviation_a), 1.0 / (deviation_b * deviation_b)];
                let mean = [prior_a.mean - shifts[0], prior_b.mean - shifts[1]];
                let posterior = [at.gram(a, a) + precision[0], at.gram(b, b) + precision[1]];
                let right = [
                    at.product(a) + precision[0] * mean[0],
                    at.product(b) + precision[1] * mean[1],
                ];
                let determinant = posterior[0] * posterior[1] - cross * cross;
                if determinant <= 0.0 {
                    continue; // rounding: exactly confounded and hardly any prior
                }
                let size_a = (posterior[1] * right[0] - cross * right[1]) / determinant;
                let size_b = (posterior[0] * right[1] - cross * right[0]) / determinant;
                let square =
                    at.square + precision[0] * mean[0] * mean[0] + precision[1] * mean[1] * mean[1]
                        - right[0] * size_a
                        - right[1] * size_b;
                let scale = (NOISE_FREEDOM + square) / (NOISE_FREEDOM + self.rows);
                let spread_a = (scale * posterior[1] / determinant).sqrt();
                let spread_b = (scale * posterior[0] / determinant).sqrt();
                let ln = -0.5 * at.ln_determinant
                    - 0.5 * (determinant / (precision[0] * precision[1])).ln()
                    - self.power() * (NOISE_FREEDOM + square).ln()
                    + ln_a
                    + ln_b
                    + ln_sign(prior_a.sign, (size_a + shifts[0]) / spread_a)
                    + ln_sign(prior_b.sign, (size_b + shifts[1]) / spread_b);
                sum.add(ln, [size_a + shifts[0], size_b + shifts[1]], [spread_a, spread_b]);
            }
        }
        sum.mean()
    }
}

/// ln of the evidence of what is left, over noise of an unknown variance v whose prior is scaled inverse χ² about 1; up to a
/// constant that depends on `rows` alone.
///
/// ```text
/// ∫ |vC|^(−1/2) exp(−q/2v) v^(−ν0/2 − 1) exp(−ν0/2v) dv ∝ |C|^(−1/2) (ν0 + q)^(−(ν0 + n)/2)
/// ```
///
/// with n `rows`, q = yᵀC⁻¹y and ν0 [`NOISE_FREEDOM`].
///
/// # Source
/// Gelman et al. 2013, Bayesian Data Analysis, 3rd edition, section 2.6 (normal distribution with known mean but unknown variance).
pub(crate) fn ln_evidence_of_left(rows: f64, square: f64, ln_determinant: f64) -> f64 {
    -0.5 * ln_determinant - 0.5 * (NOISE_FREEDOM + rows) * (NOISE_FREEDOM + square).ln()
}

/// ln of [`sign_factor`].
fn ln_sign(sign: EffectSign, t: f64) -> f64 {
    if sign == EffectSign::Positive { sign_factor(sign, t).ln() } else { 0.0 }
}

/// How much more probable the data are when the sign is the expected one: 2·(p Φ(t) + (1 − p) Φ(−t)).
pub(crate) fn sign_factor(sign: EffectSign, t: f64) -> f64 {
    if sign != EffectSign::Positive {
        return 1.0;
    }
    if t > 8.0 {
        return 2.0 * EXPECTED_SIGN;
    }
    if t < -8.0 {
        return 2.0 * (1.0 - EXPECTED_SIGN);
    }
    let above = 0.5 * erfc(-t / core::f64::consts::SQRT_2);
    2.0 * (EXPECTED_SIGN * above + (1.0 - EXPECTED_SIGN) * (1.0 - above))
}

#[cfg(test)]
mod tests;
