//! The search over no effect and single effects, with pairs behind them.

use crate::hypotheses::backgrounds::{Background, Diagonal};
use crate::hypotheses::evidence::{Hypothesis, ScoredHypothesis, Scorer, Single};
use crate::math::mixture::{Evidence, Mixture, ln_sum};
use crate::priors::PRIOR_NO_GAP;
use crate::search::pairs::{self, Context};

/// Size over the least prior scale beyond which the thin tail of the prior counts in pairs: there it holds a tenth of the density.
const LARGE: f64 = 4.0;

/// All models with their scores.
#[derive(Clone, Debug)]
pub(crate) struct Search {
    pub(crate) models: Vec<ScoredHypothesis>,
    /// ln weight of no effect, summed over the backgrounds that do not count as a finding.
    pub(crate) ln_clean: f64,
}

/// Backgrounds that do not count as a finding, and those in which the drag table is uncertain.
pub(crate) struct Kinds {
    pub(crate) nothing: Vec<bool>,
    pub(crate) uncertain_table: Vec<bool>,
}

/// Every model of at most two effects; pairs this much less probable than the best model, in ln, are left out.
pub(crate) fn search_all(
    scorer: &Scorer,
    backgrounds: &[Background],
    negligible: f64,
    kinds: &Kinds,
) -> Search {
    let columns = scorer.priors.len();
    let mut models = Vec::new();
    let mut ln_clean = f64::NEG_INFINITY;

    let none = Hypothesis { columns: vec![], flight_scatter_percent: None };
    let prior = scorer.ln_prior(&none);
    let beliefs = no_effect_beliefs(backgrounds, kinds);
    let mut sum = Sum::<0>::new();
    for (k, at) in backgrounds.iter().enumerate() {
        let ln = scorer.none(at) + prior + beliefs[k];
        if kinds.nothing[k] {
            ln_clean = ln_sum([ln_clean, ln]);
        }
        sum.add(k, Evidence { ln, sizes: [], deviations: [] }, kinds.uncertain_table[k]);
    }
    models.push(sum.scored(none));

    for column in 0..columns {
        let model = Hypothesis { columns: vec![column], flight_scatter_percent: None };
        let prior = scorer.ln_prior(&model);
        let mut sum = Sum::<1>::new();
        for (k, at) in backgrounds.iter().enumerate() {
            let mut evidence = scorer.one(at, column, 0.0);
            evidence.ln += prior + at.ln_prior;
            sum.add(k, evidence, kinds.uncertain_table[k]);
        }
        models.push(sum.scored(model));
    }
    let best = models.iter().map(|m| m.ln_weight).fold(f64::NEG_INFINITY, f64::max);
    let large: Vec<bool> = models[1..=columns]
        .iter()
        .zip(&scorer.priors)
        .map(|(single, prior)| (single.sizes[0] - prior.mean).abs() > LARGE * prior.scales[0].0)
        .collect();
    let context =
        Context { uncertain_table: &kinds.uncertain_table, large: &large, best, negligible };
    models.extend(pairs::search(scorer, backgrounds, context));
    Search { models, ln_clean }
}

/// ln prior of every background for no effect: that there is no gap is a belief of its own, and shares nothing with the
/// backgrounds in which small faults act.
fn no_effect_beliefs(backgrounds: &[Background], kinds: &Kinds) -> Vec<f64> {
    let total = |nothing: bool| {
        let own = backgrounds.iter().zip(&kinds.nothing).filter(|(_, is)| **is == nothing);
        ln_sum(own.map(|(at, _)| at.ln_prior))
    };
    let (of_nothing, of_rest) = (total(true), total(false));
    if of_nothing == f64::NEG_INFINITY || of_rest == f64::NEG_INFINITY {
        return backgrounds.iter().map(|at| at.ln_prior).collect();
    }
    let nothing = PRIOR_NO_GAP.ln() - of_nothing;
    let rest = (1.0 - PRIOR_NO_GAP).ln() - of_rest;
    let all = backgrounds.iter().zip(&kinds.nothing);
    all.map(|(at, is)| at.ln_prior + if *is { nothing } else { rest }).collect()
}

/// Models with flight-to-flight scatter: alone and with one effect.
pub(crate) fn search_flight_scatter(
    scorer: &Scorer,
    backgrounds: &[Diagonal],
    percent: f64,
) -> Vec<ScoredHypothesis> {
    let mut models = Vec::new();
    let alone = Hypothesis { columns: vec![], flight_scatter_percent: Some(percent) };
    let prior = scorer.ln_prior(&alone);
    let mut sum = Sum::<0>::new();
    for (k, at) in backgrounds.iter().enumerate() {
        let ln = scorer.nothing(at.square, at.ln_determinant) + prior + at.ln_prior;
        sum.add(k, Evidence { ln, sizes: [], deviations: [] }, true);
    }
    models.push(sum.scored(alone));
    for column in 0..scorer.priors.len() {
        let model = Hypothesis { columns: vec![column], flight_scatter_percent: Some(percent) };
        let prior = scorer.ln_prior(&model);
        let mut sum = Sum::<1>::new();
        for (k, at) in backgrounds.iter().enumerate() {
            let single = Single {
                gram: at.gram[column],
                product: at.product[column],
                square: at.square,
                ln_determinant: at.ln_determinant,
            };
            let mut evidence = scorer.single(single, column, 0.0);
            evidence.ln += prior + at.ln_prior;
            sum.add(k, evidence, true);
        }
        models.push(sum.scored(model));
    }
    models
}

/// One model over all backgrounds.
pub(crate) struct Sum<const K: usize> {
    mixture: Mixture<K>,
    best: (f64, usize),
    ln_uncertain_table: f64,
}

impl<const K: usize> Sum<K> {
    pub(crate) const fn new() -> Self {
        let nothing = f64::NEG_INFINITY;
        Self { mixture: Mixture::new(), best: (nothing, 0), ln_uncertain_table: nothing }
    }

    /// Adds the evidence in a background, prior included.
    pub(crate) fn add(&mut self, background: usize, one: Evidence<K>, uncertain_table: bool) {
        if one.ln > self.best.0 {
            self.best = (one.ln, background);
        }
        if uncertain_table {
            self.ln_uncertain_table = ln_sum([self.ln_uncertain_table, one.ln]);
        }
        self.mixture.add(one.ln, one.sizes, one.deviations);
    }

    pub(crate) fn scored(&self, hypothesis: Hypothesis) -> ScoredHypothesis {
        let mean = self.mixture.mean();
        ScoredHypothesis {
            hypothesis,
            ln_weight: mean.ln,
            sizes: mean.sizes.to_vec(),
            deviations: mean.deviations.to_vec(),
            background: self.best.1,
            table_share: if mean.ln > f64::NEG_INFINITY {
                (self.ln_uncertain_table - mean.ln).exp().min(1.0)
            } else {
                0.0
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use faer::Mat;
    use flight::effect::EffectSign;

    use super::*;
    use crate::hypotheses::evidence::{Prior, ln_evidence_of_left};
    use crate::math::eliminate::integrate_out;

    const ROWS: f64 = 60.0;
    /// Standard deviations and shares of the prior of every effect: the last is the thin tail.
    const SCALES: [(f64, f64); 3] = [(1.0, 0.45), (3.0, 0.45), (10.0, 0.1)];

    fn scorer_of_three() -> Scorer {
        let scales = SCALES.map(|(deviation, share)| (deviation, share.ln()));
        let prior = Prior { mean: 0.0, scales, count: 3, sign: EffectSign::Either };
        Scorer {
            priors: vec![prior; 3],
            effect_of: vec![0, 1, 2],
            ln_choices: vec![0.0; 3],
            effects: 3,
            age_of: vec![None; 3],
            held: vec![false; 3],
            rows: ROWS,
        }
    }

    /// ln of the evidence of two columns, each with so many of its scales: columns of known prior are integrated out for every
    /// choice of scales, and the noise after them, both of which have oracles of their own.
    fn ln_evidence_of_pair(matrix: &Mat<f64>, columns: [usize; 2], counts: [usize; 2]) -> f64 {
        let [of_first, of_second] = counts.map(|count| &SCALES[..count]);
        let choices = of_first.iter().flat_map(|a| of_second.iter().map(move |b| (a, b)));
        ln_sum(choices.map(|((first, share_a), (second, share_b))| {
            let left = integrate_out(matrix, &[3], &columns, &[*first, *second]).unwrap();
            let ln = ln_evidence_of_left(ROWS, left.matrix[(0, 0)], left.ln_determinant);
            ln + (share_a * share_b).ln()
        }))
    }

    /// Effects of about 9, −7 and 2 least scales: the thin tail counts in a pair for the first two, and not for the third.
    #[test]
    fn the_thin_tail_counts_in_pairs_for_large_effects_alone() {
        let sizes = [9.0, -7.0, 2.0];
        // So little information that no pair is negligible against the best.
        let gram = [[1.0, 0.1, 0.05], [0.1, 1.2, -0.1], [0.05, -0.1, 0.8]];
        // The three sizes explain the data, but for noise of about unit variance.
        let product = gram.map(|row| row.iter().zip(sizes).map(|(g, size)| g * size).sum::<f64>());
        let explained: f64 = product.iter().zip(sizes).map(|(b, size)| b * size).sum();
        let matrix = Mat::from_fn(4, 4, |i, j| match (i, j) {
            (3, 3) => explained + ROWS,
            (3, k) | (k, 3) => product[k],
            _ => gram[i][j],
        });
        let scorer = scorer_of_three();
        let backgrounds = [Background::small(&matrix, &[0, 1, 2], 3, 0.0)];
        let kinds = Kinds { nothing: vec![true], uncertain_table: vec![false] };
        let found = search_all(&scorer, &backgrounds, pairs::NEGLIGIBLE, &kinds);
        let pairs: Vec<&ScoredHypothesis> =
            found.models.iter().filter(|model| model.hypothesis.columns.len() == 2).collect();
        assert_eq!(pairs.len(), 3);
        for (pair, (columns, counts)) in
            pairs.iter().zip([([0, 1], [3, 3]), ([0, 2], [3, 2]), ([1, 2], [3, 2])])
        {
            assert_eq!(pair.hypothesis.columns, columns);
            let prior = scorer.ln_prior(&pair.hypothesis);
            let expected = ln_evidence_of_pair(&matrix, columns, counts) + prior;
            assert!((pair.ln_weight - expected).abs() < 1e-10, "{columns:?}");
            // With the tail for none of them, or for both, it would be another number.
            for other in [[2, 2], [3, 3]].into_iter().filter(|other| *other != counts) {
                let other = ln_evidence_of_pair(&matrix, columns, other) + prior;
                assert!((other - expected).abs() > 0.01, "{columns:?}: {other} {expected}");
            }
        }
    }
}
