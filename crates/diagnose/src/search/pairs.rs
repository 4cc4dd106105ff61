//! The search over pairs: the same evidence as [`Scorer::two`], for every pair at every background at once.
//!
//! Difficult, because it is where the time goes: two thousand pairs, sixteen backgrounds or more, four combinations of prior
//! scales. Backgrounds lie side by side, eight to a step, and each step is written so that compilers make vectors of it. A pair
//! whose evidence is below what any posterior could show is dropped before its first logarithm.

use flight::effect::EffectSign;

use crate::hypotheses::backgrounds::Background;
use crate::hypotheses::evidence::{Hypothesis, ScoredHypothesis, Scorer, sign_factor};
use crate::math::vector_ln_exp::{exp, ln};
use crate::priors::{LARGEST_OF_TWO, NOISE_FREEDOM};

/// A model this much less probable than the best one, in ln, is left out: all together they hold less than 1e-13.
pub(crate) const NEGLIGIBLE: f64 = 40.0;
/// The same where only the best model is asked for, and whether nothing at all is probable: all together less than 1e-4.
pub(crate) const NEGLIGIBLE_BESIDE_THE_BEST: f64 = 20.0;
/// Largest gain of two signs, ln 2 each.
const SIGNS: f64 = 2.0 * core::f64::consts::LN_2;
/// Prior scales that count for every column of a pair: all but the thin tail.
const USUAL_SCALES: usize = 2;
/// Backgrounds to a step.
const WIDTH: usize = 8;

/// A number under each of so many backgrounds.
type Lanes = [f64; WIDTH];

/// A column with one of its prior scales, under every background.
struct Column {
    /// G + λ.
    posterior: Vec<Lanes>,
    /// b + λμ.
    right: Vec<Lanes>,
    /// λ and λμ².
    precision: f64,
    square: f64,
    ln_share: f64,
}

/// What a pair comes to under some backgrounds and one choice of scales.
#[derive(Clone, Copy)]
struct Terms {
    /// The weight is factor·exp(ln): determinant and signs are factors, so that they cost no logarithm. −∞ where negligible.
    ln: Lanes,
    factor: Lanes,
    sizes: [Lanes; 2],
    variances: [Lanes; 2],
    /// First background over [`WIDTH`].
    step: usize,
}

/// What the search over smaller models leaves to that over pairs.
#[derive(Clone, Copy)]
pub(crate) struct Context<'a> {
    /// Backgrounds in which the drag table is uncertain.
    pub(crate) uncertain_table: &'a [bool],
    /// Columns whose size is far beyond the usual: of these alone the thin tail of the prior counts in a pair.
    pub(crate) large: &'a [bool],
    /// The ln weight of the best smaller model.
    pub(crate) best: f64,
    /// A pair this much less probable than the best model, in ln, is left out.
    pub(crate) negligible: f64,
}

/// Every pair of columns of different effects that is not negligible against the best smaller model.
pub(crate) fn search(
    scorer: &Scorer,
    backgrounds: &[Background],
    Context { uncertain_table, large, best, negligible }: Context<'_>,
) -> Vec<ScoredHypothesis> {
    let columns: Vec<Vec<Column>> = (0..scorer.columns())
        .map(|column| scales(scorer, backgrounds, column, large[column]))
        .collect();
    let mut best = best;
    let mut models = Vec::new();
    let mut scratch = Scratch::new(scorer, backgrounds);
    scratch.limit(best - negligible);
    for a in 0..columns.len() {
        for b in a + 1..columns.len() {
            if scorer.effect_of[a] == scorer.effect_of[b] || scorer.is_one_history(a, b) {
                continue;
            }
            let model = Hypothesis { columns: vec![a, b], flight_scatter_percent: None };
            let prior = scorer.ln_prior(&model);
            let by_prior = (prior / scorer.power()).exp();
            for (place, at) in backgrounds.iter().enumerate() {
                scratch.cross[place / WIDTH][place % WIDTH] = at.gram(a, b);
            }
            scratch.terms.clear();
            for of_a in &columns[a] {
                for of_b in &columns[b] {
                    for step in 0..scratch.cross.len() {
                        scratch.collect(of_a, of_b, step, prior, by_prior);
                    }
                }
            }
            let signs = [scorer.priors[a].sign, scorer.priors[b].sign];
            let scored = scratch.scored(model, signs, uncertain_table);
            if let Some(scored) = scored.filter(|scored| is_possible(scorer, scored)) {
                if scored.ln_weight > best {
                    best = scored.ln_weight;
                    scratch.limit(best - negligible);
                }
                models.push(scored);
            }
        }
    }
    models
}

/// Whether neither of two effects is larger than any such effect is, and not one part gets better with age while the other gets
/// worse: two slopes of different dates, one against the other, are a step, which is an effect of its own.
fn is_possible(scorer: &Scorer, scored: &ScoredHypothesis) -> bool {
    let columns = &scored.hypothesis.columns;
    let is_of_age = columns.iter().all(|&column| scorer.part_that_ages(column).is_some());
    if is_of_age && scored.sizes.iter().product::<f64>() < 0.0 {
        return false;
    }
    let is_usual = |(&column, size): (&usize, &f64)| {
        let prior = &scorer.priors[column];
        (size - prior.mean).abs() <= LARGEST_OF_TWO * prior.scales[0].0
    };
    scored.hypothesis.columns.iter().zip(&scored.sizes).all(is_usual)
}

/// One number per background, `rest` where there is none.
fn lanes(backgrounds: &[Background], rest: f64, of: impl Fn(&Background) -> f64) -> Vec<Lanes> {
    let mut all = vec![[rest; WIDTH]; backgrounds.len().div_ceil(WIDTH)];
    for (place, at) in backgrounds.iter().enumerate() {
        all[place / WIDTH][place % WIDTH] = of(at);
    }
    all
}

fn scales(
    scorer: &Scorer,
    backgrounds: &[Background],
    column: usize,
    is_large: bool,
) -> Vec<Column> {
    let prior = &scorer.priors[column];
    let count = if is_large { prior.count } else { prior.count.min(USUAL_SCALES) };
    prior.scales[..count]
        .iter()
        .map(|&(deviation, ln_share)| {
            let precision = 1.0 / (deviation * deviation);
            Column {
                posterior: lanes(backgrounds, 1.0, |at| at.gram(column, column) + precision),
                right: lanes(backgrounds, 0.0, |at| at.product(column) + precision * prior.mean),
                precision,
                square: precision * prior.mean * prior.mean,
                ln_share,
            }
        })
        .collect()
}

/// Memory of one pair, and of the limit that all are held against.
struct Scratch {
    power: f64,
    /// ν0 + n.
    freedom: f64,
    cross: Vec<Lanes>,
    /// ν0 + q without any effect; infinite where there is no background.
    squares: Vec<Lanes>,
    /// −½ ln of each background's determinant, and ln of its prior.
    ln_determinants: Vec<Lanes>,
    /// ν0 + q beyond which a term with prior 1 is negligible.
    limits: Vec<Lanes>,
    terms: Vec<Terms>,
}

impl Scratch {
    fn new(scorer: &Scorer, backgrounds: &[Background]) -> Self {
        let squares = lanes(backgrounds, f64::INFINITY, |at| NOISE_FREEDOM + at.square);
        Self {
            power: scorer.power(),
            freedom: NOISE_FREEDOM + scorer.rows,
            cross: vec![[0.0; WIDTH]; squares.len()],
            ln_determinants: lanes(backgrounds, 0.0, |at| at.ln_prior - 0.5 * at.ln_determinant),
            limits: vec![[0.0; WIDTH]; squares.len()],
            terms: Vec::with_capacity(4 * squares.len()),
            squares,
        }
    }

    /// The residual square beyond which a term without prior is below `least`: determinants only make it smaller, signs at
    /// most double it.
    fn limit(&mut self, least: f64) {
        for (limits, lns) in self.limits.iter_mut().zip(&self.ln_determinants) {
            for (limit, ln_determinant) in limits.iter_mut().zip(lns) {
                *limit = ((SIGNS + ln_determinant - least) / self.power).exp();
            }
        }
    }

    /// Keeps the terms of one step where one of them is not negligible. ν0 + q + Σλμ² − r'M⁻¹r says so.
    fn collect(&mut self, a: &Column, b: &Column, step: usize, prior: f64, by_prior: f64) {
        let (posterior_a, posterior_b) = (&a.posterior[step], &b.posterior[step]);
        let (right_a, right_b) = (&a.right[step], &b.right[step]);
        let (cross, limits) = (&self.cross[step], &self.limits[step]);
        let own = a.square + b.square;
        let (mut determinants, mut squares) = ([0.0; WIDTH], self.squares[step]);
        let mut kept = 0;
        for k in 0..WIDTH {
            determinants[k] = posterior_a[k] * posterior_b[k] - cross[k] * cross[k];
            let explained = (posterior_b[k] * right_a[k] * right_a[k]
                + posterior_a[k] * right_b[k] * right_b[k]
                - 2.0 * cross[k] * right_a[k] * right_b[k])
                / determinants[k];
            squares[k] = squares[k] + own - explained;
            kept += u32::from(squares[k] <= limits[k] * by_prior);
        }
        if kept == 0 {
            return;
        }
        let mut terms = Terms {
            ln: [0.0; WIDTH],
            factor: [0.0; WIDTH],
            sizes: [[0.0; WIDTH]; 2],
            variances: [[0.0; WIDTH]; 2],
            step,
        };
        let constant = prior + a.ln_share + b.ln_share;
        let precisions = a.precision * b.precision;
        let ln_determinants = &self.ln_determinants[step];
        for k in 0..WIDTH {
            let inverse = 1.0 / determinants[k];
            terms.sizes[0][k] = (posterior_b[k] * right_a[k] - cross[k] * right_b[k]) * inverse;
            terms.sizes[1][k] = (posterior_a[k] * right_b[k] - cross[k] * right_a[k]) * inverse;
            let scale = squares[k] / self.freedom * inverse;
            terms.variances[0][k] = scale * posterior_b[k];
            terms.variances[1][k] = scale * posterior_a[k];
            terms.factor[k] = (precisions * inverse).sqrt();
            let ln = constant + ln_determinants[k] - self.power * ln(squares[k]);
            // A determinant of 0 or less is rounding: exactly confounded and hardly any prior.
            let ln = if determinants[k] > 0.0 { ln } else { f64::NEG_INFINITY };
            terms.ln[k] = if squares[k] <= limits[k] * by_prior { ln } else { f64::NEG_INFINITY };
        }
        self.terms.push(terms);
    }

    /// The mixture of all terms; `None` where none was kept.
    fn scored(
        &mut self,
        hypothesis: Hypothesis,
        signs: [EffectSign; 2],
        uncertain_table: &[bool],
    ) -> Option<ScoredHypothesis> {
        let largest =
            self.terms.iter().flat_map(|terms| terms.ln).fold(f64::NEG_INFINITY, f64::max);
        if largest == f64::NEG_INFINITY {
            return None;
        }
        let mut totals = vec![[0.0; WIDTH]; self.cross.len()];
        let (mut firsts, mut seconds) = ([[0.0; WIDTH]; 2], [[0.0; WIDTH]; 2]);
        for terms in &self.terms {
            let mut weights = [0.0; WIDTH];
            for (k, kept) in weights.iter_mut().enumerate() {
                let below = terms.ln[k] - largest;
                let weight = terms.factor[k] * exp(below);
                *kept = if below >= -NEGLIGIBLE { weight } else { 0.0 };
            }
            for (which, _) in
                signs.iter().enumerate().filter(|(_, sign)| **sign == EffectSign::Positive)
            {
                for (k, weight) in weights.iter_mut().enumerate() {
                    if *weight > 0.0 {
                        let t = terms.sizes[which][k] / terms.variances[which][k].sqrt();
                        *weight *= sign_factor(EffectSign::Positive, t);
                    }
                }
            }
            let total = &mut totals[terms.step];
            for k in 0..WIDTH {
                total[k] += weights[k];
            }
            for which in 0..2 {
                let (sizes, variances) = (&terms.sizes[which], &terms.variances[which]);
                let (first, second) = (&mut firsts[which], &mut seconds[which]);
                for k in 0..WIDTH {
                    let weighs = weights[k] > 0.0;
                    let (size, variance) = (sizes[k], variances[k]);
                    let one = weights[k] * size;
                    let two = weights[k] * (size * size + variance);
                    first[k] += if weighs { one } else { 0.0 };
                    second[k] += if weighs { two } else { 0.0 };
                }
            }
        }
        let flat = totals.as_flattened();
        let total: f64 = flat.iter().sum();
        let sizes = firsts.map(|first| first.iter().sum::<f64>() / total);
        let deviations = core::array::from_fn::<f64, 2, _>(|k| {
            (seconds[k].iter().sum::<f64>() / total - sizes[k] * sizes[k]).max(0.0).sqrt()
        });
        let background =
            (0..flat.len()).reduce(|best, k| if flat[k] > flat[best] { k } else { best });
        let with_table: f64 =
            flat.iter().zip(uncertain_table).filter(|(_, is)| **is).map(|(weight, _)| weight).sum();
        Some(ScoredHypothesis {
            table_share: with_table / total,
            hypothesis,
            ln_weight: largest + total.ln(),
            sizes: sizes.to_vec(),
            deviations: deviations.to_vec(),
            background: background.unwrap_or(0),
        })
    }
}

#[cfg(test)]
mod tests;
