//! The search over no effect and single effects, with pairs behind them.

use crate::hypotheses::backgrounds::{Background, Diagonal};
use crate::hypotheses::evidence::{Hypothesis, ScoredHypothesis, Scorer, Single};
use crate::math::mixture::{Evidence, Mixture, ln_sum};

/// All models with their scores.
#[derive(Clone, Debug)]
pub(crate) struct Search {
    pub(crate) models: Vec<ScoredHypothesis>,
    /// ln weight of no effect, summed over the backgrounds that do not count as a finding.
    pub(crate) ln_clean: f64,
}

/// Every model of at most `largest` effects. `is_nothing` is true for backgrounds that do not count as a finding.
pub(crate) fn search_all(
    scorer: &Scorer,
    backgrounds: &[Background],
    largest: usize,
    is_nothing: impl Fn(&Background) -> bool,
) -> Search {
    let ln_background = -(backgrounds.len() as f64).ln();
    let columns = scorer.priors.len();
    let mut models = Vec::new();
    let mut ln_clean = f64::NEG_INFINITY;

    let none = Hypothesis { columns: vec![], flight_scatter_percent: None };
    let prior = scorer.ln_prior(&none) + ln_background;
    let mut sum = Mixture::<0>::new();
    let mut best = (f64::NEG_INFINITY, 0);
    for (k, at) in backgrounds.iter().enumerate() {
        let ln = scorer.none(at) + prior;
        if is_nothing(at) {
            ln_clean = ln_sum([ln_clean, ln]);
        }
        best = if ln > best.0 { (ln, k) } else { best };
        sum.add(ln, [], []);
    }
    models.push(scored(none, &sum, best.1));

    for column in 0..columns {
        let model = Hypothesis { columns: vec![column], flight_scatter_percent: None };
        let prior = scorer.ln_prior(&model) + ln_background;
        models.push(over(backgrounds, model, |at| {
            let mut evidence = scorer.one(at, column, 0.0);
            evidence.ln += prior;
            evidence
        }));
    }
    if largest >= 2 {
        let best = models.iter().map(|m| m.ln_weight).fold(f64::NEG_INFINITY, f64::max);
        models.extend(crate::search::pairs::search(scorer, backgrounds, best));
    }
    Search { models, ln_clean }
}

/// Models with flight-to-flight scatter: alone and with one effect.
pub(crate) fn search_flight_scatter(
    scorer: &Scorer,
    backgrounds: &[Diagonal],
    percent: f64,
) -> Vec<ScoredHypothesis> {
    let ln_background = -(backgrounds.len() as f64).ln();
    let mut models = Vec::new();
    let alone = Hypothesis { columns: vec![], flight_scatter_percent: Some(percent) };
    let prior = scorer.ln_prior(&alone) + ln_background;
    models.push(over(backgrounds, alone, |at| Evidence {
        ln: scorer.nothing(at.square, at.ln_determinant) + prior,
        sizes: [],
        deviations: [],
    }));
    for column in 0..scorer.priors.len() {
        let model = Hypothesis { columns: vec![column], flight_scatter_percent: Some(percent) };
        let prior = scorer.ln_prior(&model) + ln_background;
        models.push(over(backgrounds, model, |at| {
            let mut evidence = scorer.single(
                Single {
                    gram: at.gram[column],
                    product: at.product[column],
                    square: at.square,
                    ln_determinant: at.ln_determinant,
                },
                column,
                0.0,
            );
            evidence.ln += prior;
            evidence
        }));
    }
    models
}

fn over<B, const K: usize>(
    backgrounds: &[B],
    model: Hypothesis,
    evidence: impl Fn(&B) -> Evidence<K>,
) -> ScoredHypothesis {
    let mut sum = Mixture::<K>::new();
    let mut best = (f64::NEG_INFINITY, 0);
    for (k, at) in backgrounds.iter().enumerate() {
        let one = evidence(at);
        if one.ln > best.0 {
            best = (one.ln, k);
        }
        sum.add(one.ln, one.sizes, one.deviations);
    }
    scored(model, &sum, best.1)
}

fn scored<const K: usize>(
    model: Hypothesis,
    sum: &Mixture<K>,
    background: usize,
) -> ScoredHypothesis {
    let mean = sum.mean();
    ScoredHypothesis {
        model,
        ln_weight: mean.ln,
        sizes: mean.sizes.to_vec(),
        deviations: mean.deviations.to_vec(),
        background,
    }
}
