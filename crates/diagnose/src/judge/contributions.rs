//! What each effect makes of the gap where many act: all of the library at once, shrunk.
//!
//! The search names one effect or two and leaves the rest to backgrounds. Where no two carry the gap, this says how it is made
//! up, each effect with an interval that holds what these flights cannot tell it from.

use faer::Mat;

use crate::judge::posterior::mean_square;
use crate::library::Testable;
use crate::math::horseshoe::{Candidate, Horseshoe, draw};
use crate::math::lower::Lower;
use crate::math::quantile::central_95;
use crate::output::{Contribution, Magnitude};
use crate::priors::{CONTRIBUTING, PRIOR_SCALES};
use crate::search::analyse::Analysis;
use crate::search::system::Problem;
use crate::thresholds::CONTRIBUTION_SWEEPS;

/// Contributions to a gap that was detected, the likeliest largest first; empty where none was, or nothing can be drawn.
pub(crate) fn contributions(
    Problem { system, library, .. }: Problem<'_>,
    analysis: &Analysis,
    is_detected: bool,
    (noise_scale, seed): (f64, u64),
) -> Vec<Contribution> {
    if !is_detected {
        return vec![];
    }
    let columns: Vec<usize> =
        library.effects.iter().map(|effect| likeliest_column(effect, analysis)).collect();
    let typical: Vec<f64> = library.effects.iter().map(|effect| effect.typical).collect();
    let candidates: Vec<Candidate> = analysis
        .space
        .smoothed
        .iter()
        .map(|smoothed| {
            let gram = smoothed.gram();
            let residual = gram.ncols() - 1;
            let (size, scaled) = (columns.len(), |j: usize| typical[j] / noise_scale);
            Candidate {
                gram: Lower::of(&Mat::from_fn(size, size, |i, j| {
                    typical[i] * scaled(j) * gram[(columns[i], columns[j])]
                })),
                product: (0..size).map(|j| scaled(j) * gram[(columns[j], residual)]).collect(),
                ln_weight: smoothed.ln_weight(noise_scale),
            }
        })
        .collect();
    let others = columns.len() as f64 - CONTRIBUTING;
    let slab = PRIOR_SCALES.iter().map(|(scale, _)| *scale).fold(0.0, f64::max);
    let prior = Horseshoe {
        common_scale: CONTRIBUTING / others.max(1.0),
        slab,
        sweeps: CONTRIBUTION_SWEEPS,
        seed,
    };
    let Some(draws) = draw(&candidates, prior) else { return vec![] };
    let rms_percent: Vec<f64> = columns
        .iter()
        .zip(&typical)
        .map(|(&column, typical)| 100.0 * typical * mean_square(system, column).sqrt())
        .collect();
    let leads = shares_of_leading(&draws, &rms_percent);
    let mut found: Vec<Contribution> = library
        .effects
        .iter()
        .enumerate()
        .map(|(place, effect)| {
            let of = |unit: f64, value: fn(f64) -> f64| {
                let values = (0..draws.ncols()).map(|k| value(unit * draws[(place, k)]));
                summary(values.collect())
            };
            let (value, ci95) = of(effect.typical, |size| size);
            let (rms, rms_ci95) = of(rms_percent[place], f64::abs);
            Contribution {
                effect: effect.id,
                magnitude: Magnitude { value, ci95 },
                rms_percent: rms,
                rms_ci95,
                leads: leads[place],
            }
        })
        .collect();
    found.sort_by(|a, b| b.leads.total_cmp(&a.leads).then(b.rms_percent.total_cmp(&a.rms_percent)));
    found
}

/// The column of an effect in the most probable model that has one, else the one that stands for it.
fn likeliest_column(effect: &Testable, analysis: &Analysis) -> usize {
    let columns = analysis.models.iter().flat_map(|(scored, _)| &scored.hypothesis.columns);
    let own = effect.all_columns();
    columns.copied().find(|column| own.contains(column)).unwrap_or(effect.representative)
}

/// Of every effect the share of draws in which it makes the largest change.
fn shares_of_leading(draws: &Mat<f64>, rms_percent: &[f64]) -> Vec<f64> {
    let mut shares = vec![0.0; rms_percent.len()];
    for draw in 0..draws.ncols() {
        let sizes = draws.col_as_slice(draw).iter().zip(rms_percent);
        let changes = sizes.map(|(size, unit)| (size * unit).abs()).enumerate();
        if let Some((largest, _)) = changes.max_by(|a, b| a.1.total_cmp(&b.1)) {
            shares[largest] += 1.0 / draws.ncols() as f64;
        }
    }
    shares
}

/// Mean and 95 % interval.
fn summary(mut values: Vec<f64>) -> (f64, [f64; 2]) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (mean, central_95(&mut values))
}
