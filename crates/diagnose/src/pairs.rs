//! The search over pairs: the same evidence as [`Scorer::two`], for every pair at every background at once.
//!
//! Difficult, because it is where the time goes: two thousand pairs, sixteen backgrounds or more, four combinations of prior
//! scales. Backgrounds are the innermost, contiguous index; a pair whose evidence is below what any posterior could show is
//! dropped before its first logarithm; each that is left costs one logarithm and one exponential.

use crate::backgrounds::Background;
use crate::evidence::{Model, NOISE_FREEDOM, Scored, Scorer, sign_factor};

/// A model this much less probable than the best one, in ln, is left out: all together they hold less than 1e-13.
const NEGLIGIBLE: f64 = 40.0;
/// Largest gain of two signs, ln 2 each.
const SIGNS: f64 = 2.0 * core::f64::consts::LN_2;

/// A column with one of its prior scales, under every background.
struct Column {
    /// G + λ.
    posterior: Vec<f64>,
    /// b + λμ.
    right: Vec<f64>,
    /// λ and λμ².
    precision: f64,
    square: f64,
    ln_share: f64,
}

/// What one pair comes to under one background and one choice of scales.
#[derive(Clone, Copy)]
struct Term {
    /// The weight is factor·exp(ln): determinant and signs are factors, so that they cost no logarithm.
    ln: f64,
    factor: f64,
    background: usize,
    sizes: [f64; 2],
    deviations: [f64; 2],
}

/// Every pair of columns of different effects that is not negligible beside `best`, the ln weight of the best smaller model.
pub(crate) fn search(scorer: &Scorer, backgrounds: &[Background], best: f64) -> Vec<Scored> {
    let columns: Vec<Vec<Column>> =
        (0..scorer.columns()).map(|column| lanes(scorer, backgrounds, column)).collect();
    let squares: Vec<f64> = backgrounds.iter().map(|at| NOISE_FREEDOM + at.square).collect();
    let mut best = best;
    let mut models = Vec::new();
    let mut scratch = Scratch::new(backgrounds.len());
    scratch.limit(scorer, backgrounds, best - NEGLIGIBLE);
    for a in 0..columns.len() {
        for b in a + 1..columns.len() {
            if scorer.effect_of[a] == scorer.effect_of[b] {
                continue;
            }
            let model = Model { columns: vec![a, b], heating_percent: None };
            let prior = scorer.ln_prior(&model) - (backgrounds.len() as f64).ln();
            scratch.by_prior = (prior / scorer.power()).exp();
            for (place, at) in backgrounds.iter().enumerate() {
                scratch.cross[place] = at.gram(a, b);
            }
            scratch.terms.clear();
            let positive = [scorer.priors[a].positive, scorer.priors[b].positive];
            for of_a in &columns[a] {
                for of_b in &columns[b] {
                    scratch.square(of_a, of_b, &squares);
                    scratch.collect(scorer, backgrounds, of_a, of_b, positive, prior);
                }
            }
            if let Some(scored) = scratch.scored(model) {
                if scored.ln_weight > best {
                    best = scored.ln_weight;
                    scratch.limit(scorer, backgrounds, best - NEGLIGIBLE);
                }
                models.push(scored);
            }
        }
    }
    models
}

fn lanes(scorer: &Scorer, backgrounds: &[Background], column: usize) -> Vec<Column> {
    let prior = &scorer.priors[column];
    prior.scales[..prior.count]
        .iter()
        .map(|&(deviation, ln_share)| {
            let precision = 1.0 / (deviation * deviation);
            Column {
                posterior: backgrounds
                    .iter()
                    .map(|at| at.gram(column, column) + precision)
                    .collect(),
                right: backgrounds
                    .iter()
                    .map(|at| at.product(column) + precision * prior.mean)
                    .collect(),
                precision,
                square: precision * prior.mean * prior.mean,
                ln_share,
            }
        })
        .collect()
}

/// Memory of one pair, and of the limit that all are held against.
struct Scratch {
    cross: Vec<f64>,
    /// ν0 + q of the pair; infinite where the pair is degenerate.
    squares: Vec<f64>,
    /// The same beyond which a term with prior 1 is negligible.
    limits: Vec<f64>,
    /// What the pair's prior makes of the limits.
    by_prior: f64,
    terms: Vec<Term>,
    /// Weights by background.
    totals: Vec<f64>,
}

impl Scratch {
    fn new(backgrounds: usize) -> Self {
        Self {
            cross: vec![0.0; backgrounds],
            squares: vec![0.0; backgrounds],
            limits: vec![f64::INFINITY; backgrounds],
            by_prior: 1.0,
            terms: Vec::with_capacity(4 * backgrounds),
            totals: vec![0.0; backgrounds],
        }
    }

    /// The residual square beyond which a term without prior is below `least`: determinants only make it smaller, signs at
    /// most double it.
    fn limit(&mut self, scorer: &Scorer, backgrounds: &[Background], least: f64) {
        for (limit, at) in self.limits.iter_mut().zip(backgrounds) {
            *limit = ((SIGNS - 0.5 * at.ln_determinant - least) / scorer.power()).exp();
        }
    }

    /// ν0 + q + Σλμ² − r'M⁻¹r under every background.
    fn square(&mut self, a: &Column, b: &Column, squares: &[f64]) {
        let count = self.squares.len();
        let (posterior_a, posterior_b) = (&a.posterior[..count], &b.posterior[..count]);
        let (right_a, right_b) = (&a.right[..count], &b.right[..count]);
        let (cross, squares) = (&self.cross[..count], &squares[..count]);
        let own = a.square + b.square;
        for k in 0..count {
            let determinant = posterior_a[k] * posterior_b[k] - cross[k] * cross[k];
            let explained = (posterior_b[k] * right_a[k] * right_a[k]
                + posterior_a[k] * right_b[k] * right_b[k]
                - 2.0 * cross[k] * right_a[k] * right_b[k])
                / determinant;
            self.squares[k] = squares[k] + own - explained;
        }
    }

    /// Keeps the terms that are not negligible.
    fn collect(
        &mut self,
        scorer: &Scorer,
        backgrounds: &[Background],
        a: &Column,
        b: &Column,
        positive: [bool; 2],
        prior: f64,
    ) {
        for (k, at) in backgrounds.iter().enumerate() {
            let square = self.squares[k];
            if square.is_nan() || square > self.limits[k] * self.by_prior {
                continue;
            }
            let cross = self.cross[k];
            let posterior = [a.posterior[k], b.posterior[k]];
            let determinant = posterior[0] * posterior[1] - cross * cross;
            if determinant <= 0.0 {
                continue; // rounding: exactly confounded and hardly any prior
            }
            let sizes = [
                (posterior[1] * a.right[k] - cross * b.right[k]) / determinant,
                (posterior[0] * b.right[k] - cross * a.right[k]) / determinant,
            ];
            let scale = square / (NOISE_FREEDOM + scorer.rows);
            let deviations = [
                (scale * posterior[1] / determinant).sqrt(),
                (scale * posterior[0] / determinant).sqrt(),
            ];
            let ln = prior - 0.5 * at.ln_determinant - scorer.power() * square.ln()
                + a.ln_share
                + b.ln_share;
            let factor = (a.precision * b.precision / determinant).sqrt()
                * sign_factor(positive[0], sizes[0] / deviations[0])
                * sign_factor(positive[1], sizes[1] / deviations[1]);
            self.terms.push(Term { ln, factor, background: k, sizes, deviations });
        }
    }

    /// The mixture of all terms; `None` where none was kept.
    fn scored(&mut self, model: Model) -> Option<Scored> {
        let largest = self.terms.iter().map(|term| term.ln).fold(f64::NEG_INFINITY, f64::max);
        if largest == f64::NEG_INFINITY {
            return None;
        }
        self.totals.fill(0.0);
        let (mut total, mut first, mut second) = (0.0, [0.0; 2], [0.0; 2]);
        for term in &self.terms {
            let below = term.ln - largest;
            if below < -NEGLIGIBLE {
                continue;
            }
            let weight = term.factor * below.exp();
            self.totals[term.background] += weight;
            total += weight;
            for k in 0..2 {
                let (size, deviation) = (term.sizes[k], term.deviations[k]);
                first[k] += weight * size;
                second[k] += weight * (size * size + deviation * deviation);
            }
        }
        let sizes = first.map(|sum| sum / total);
        let deviations = core::array::from_fn::<f64, 2, _>(|k| {
            (second[k] / total - sizes[k] * sizes[k]).max(0.0).sqrt()
        });
        let background = (0..self.totals.len())
            .reduce(|best, k| if self.totals[k] > self.totals[best] { k } else { best })
            .unwrap_or(0);
        Some(Scored {
            model,
            ln_weight: largest + total.ln(),
            sizes: sizes.to_vec(),
            deviations: deviations.to_vec(),
            background,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::{Mixture, Prior};

    /// Against the evidence of one pair at a time, which has its own test against numerical integration.
    #[test]
    fn same_as_one_pair_at_a_time() {
        let columns = 4;
        let prior = |mean: f64, deviation: f64, positive: bool| Prior {
            mean,
            scales: [(deviation, 0.5_f64.ln()), (3.0 * deviation, 0.5_f64.ln())],
            count: 2,
            positive,
        };
        let scorer = Scorer {
            priors: vec![
                prior(0.0, 1.0, true),
                prior(1.0, 0.15, false),
                prior(0.0, 2.0, true),
                prior(0.0, 0.5, false),
            ],
            effect_of: vec![0, 1, 2, 2],
            ln_columns: vec![0.0, 0.0, 2.0_f64.ln()],
            effects: 3,
            rows: 60.0,
        };
        let background = |spike: f64| {
            let shrink = 1.0 / (1.0 + spike);
            // A Gram and a product of whole numbers, positive definite by its diagonal.
            let gram = [
                [40.0, 10.0, -5.0, 3.0],
                [10.0, 30.0, 8.0, -6.0],
                [-5.0, 8.0, 25.0, 20.0],
                [3.0, -6.0, 20.0, 35.0],
            ];
            let product = [21.0, 17.0, -9.0, 4.0];
            let mut matrix = faer::Mat::<f64>::zeros(columns + 1, columns + 1);
            for i in 0..columns {
                for j in 0..columns {
                    matrix[(i, j)] = shrink * gram[i][j];
                }
                matrix[(i, columns)] = shrink * product[i];
            }
            matrix[(columns, columns)] = 75.0;
            let mut at = Background::small(&matrix, &[0, 1, 2, 3], columns, 3.0 * spike);
            at.spike = spike;
            at
        };
        let backgrounds = [background(0.0), background(0.3)];
        let found = search(&scorer, &backgrounds, f64::NEG_INFINITY);
        assert_eq!(found.len(), 5, "the two columns of one effect make no pair");
        for scored in &found {
            let (a, b) = (scored.model.columns[0], scored.model.columns[1]);
            let prior = scorer.ln_prior(&scored.model) - 2.0_f64.ln();
            let mut sum = Mixture::<2>::new();
            for at in &backgrounds {
                let one = scorer.two(at, [a, b], [0.0; 2]);
                sum.add(one.ln + prior, one.sizes, one.deviations);
            }
            let mean = sum.mean();
            assert!((scored.ln_weight - mean.ln).abs() < 1e-10, "{a} {b}");
            for k in 0..2 {
                assert!((scored.sizes[k] - mean.sizes[k]).abs() < 1e-12, "{a} {b}");
                assert!((scored.deviations[k] - mean.deviations[k]).abs() < 1e-12, "{a} {b}");
            }
        }
        // What is negligible beside a better model is left out, and nothing else is.
        let best = found.iter().map(|m| m.ln_weight).fold(f64::NEG_INFINITY, f64::max);
        assert!(search(&scorer, &backgrounds, best + 2.0 * NEGLIGIBLE).is_empty());
        assert_eq!(search(&scorer, &backgrounds, best).len(), found.len());
    }
}
