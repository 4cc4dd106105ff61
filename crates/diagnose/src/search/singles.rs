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

/// Every model of at most `largest` effects.
pub(crate) fn search_all(
    scorer: &Scorer,
    backgrounds: &[Background],
    largest: usize,
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
    if largest >= 2 {
        let best = models.iter().map(|m| m.ln_weight).fold(f64::NEG_INFINITY, f64::max);
        let large: Vec<bool> = models[1..=columns]
            .iter()
            .zip(&scorer.priors)
            .map(|(single, prior)| (single.sizes[0] - prior.mean).abs() > LARGE * prior.scales[0].0)
            .collect();
        let context = Context { uncertain_table: &kinds.uncertain_table, large: &large, best };
        models.extend(pairs::search(scorer, backgrounds, context));
    }
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
