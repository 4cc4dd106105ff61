//! Gauss–Newton: the leading models re-simulated at their own estimate, re-linearised, re-scored. Noise stays.

use faer::Mat;
use perf_model::effects::{EffectModel, Effects, HiddenParameters};

use crate::analysis::{Replaced, Stacked};
use crate::data::Difference;
use crate::design::{half_whitened, whiten_flight};
use crate::evidence::{Background, Mixture, Scored, Scorer, backgrounds_at_levels};
use crate::gram::{Gram, Reduced, fold_of};
use crate::library::Library;
use crate::noise::MAXIMUM_CHANNELS;

/// Largest number of re-linearisations of a model.
const STEPS: usize = 3;
/// A step shorter than this share of the typical size ends the iteration.
const CONVERGED: f64 = 0.02;

/// A model linearised at its own estimate.
#[derive(Clone, Debug)]
pub(crate) struct Relinearised {
    pub(crate) scored: Scored,
    /// Gram without nuisance, agnostic functions included, with the model's own columns and residual.
    pub(crate) reduced: Vec<Reduced>,
    /// Where it was linearised.
    pub(crate) shifts: Vec<f64>,
}

/// Effects of a model at these sizes.
pub(crate) fn effects_of(library: &Library, columns: &[usize], sizes: &[f64]) -> Effects {
    let mut effects = Effects::none();
    let mut hidden = HiddenParameters::default();
    for (&column, &size) in columns.iter().zip(sizes) {
        let at = &library.columns[column];
        effects = effects.with(library.effects[at.effect].id, size);
        hidden = merged(hidden, at.hidden);
    }
    effects.with_hidden(hidden)
}

/// Hidden parameters of two columns together: each sets its own and leaves the others at their defaults.
fn merged(a: HiddenParameters, b: HiddenParameters) -> HiddenParameters {
    let default = HiddenParameters::default();
    let number = |a: f64, b: f64, default: f64| {
        if b.total_cmp(&default).is_eq() { a } else { b }
    };
    HiddenParameters {
        throttle_pivot: number(a.throttle_pivot, b.throttle_pivot, default.throttle_pivot),
        drag_divergence_mach: number(
            a.drag_divergence_mach,
            b.drag_divergence_mach,
            default.drag_divergence_mach,
        ),
        step_from_s: number(a.step_from_s, b.step_from_s, default.step_from_s),
        step_target: if b.step_target == default.step_target {
            a.step_target
        } else {
            b.step_target
        },
    }
}

/// Refines one model; `None` where a step leaves the domain of the physics. `without` leaves a fold of flights out.
pub(crate) fn refine(
    stacked: &Stacked<'_>,
    model: &EffectModel<'_>,
    library: &Library,
    scorer: &Scorer,
    start: &Scored,
    at: &Background,
    without: Option<usize>,
) -> Option<Relinearised> {
    let columns = &start.model.columns;
    let mut sizes = start.sizes.clone();
    // Agnostic functions compete once, at the end, and never on folds.
    let agnostic = without.is_none();
    for _ in 0..STEPS {
        let (gram, replaced) = relinearise(stacked, model, library, columns, &sizes, without);
        let reduced = stacked.reduced_at_levels(&gram, without, &replaced, false)?;
        let chosen = |spike: f64, tau: f64, scatter: usize| {
            spike.total_cmp(&at.spike).is_eq()
                && tau.total_cmp(&at.tau).is_eq()
                && scatter == at.scatter
        };
        let smooth = stacked.design.smooth.len();
        let one = backgrounds_at_levels(&reduced, library.columns.len(), smooth, library, chosen);
        let found = estimate(scorer, one.first()?, columns, &sizes);
        let converged =
            columns.iter().zip(found.iter().zip(&sizes)).all(|(&column, (new, old))| {
                let typical = library.effects[library.columns[column].effect].typical;
                (new - old).abs() <= CONVERGED * typical
            });
        if !found.iter().all(|size| size.is_finite()) {
            return None;
        }
        if converged {
            let reduced = if agnostic {
                stacked.reduced_at_levels(&gram, without, &replaced, agnostic)?
            } else {
                reduced
            };
            return Some(score_everywhere(stacked, library, scorer, start, reduced, sizes));
        }
        sizes = found;
    }
    let (gram, replaced) = relinearise(stacked, model, library, columns, &sizes, without);
    let reduced = stacked.reduced_at_levels(&gram, without, &replaced, agnostic)?;
    Some(score_everywhere(stacked, library, scorer, start, reduced, sizes))
}

fn score_everywhere(
    stacked: &Stacked<'_>,
    library: &Library,
    scorer: &Scorer,
    start: &Scored,
    reduced: Vec<Reduced>,
    shifts: Vec<f64>,
) -> Relinearised {
    let all = backgrounds_at_levels(
        &reduced,
        library.columns.len(),
        stacked.design.smooth.len(),
        library,
        |_, tau, _| stacked.admits(tau),
    );
    let prior = scorer.ln_prior(&start.model) - (all.len() as f64).ln();
    let columns = &start.model.columns;
    let mut best = (f64::NEG_INFINITY, 0);
    let mut note = |k: usize, ln: f64| {
        if ln > best.0 {
            best = (ln, k);
        }
    };
    let (ln_weight, sizes, deviations) = if let [a, b] = columns[..] {
        let mut sum = Mixture::<2>::new();
        for (k, at) in all.iter().enumerate() {
            let one = scorer.two(at, [a, b], [shifts[0], shifts[1]]);
            note(k, one.ln);
            sum.add(one.ln + prior, one.sizes, one.deviations);
        }
        let mean = sum.mean();
        (mean.ln, mean.sizes.to_vec(), mean.deviations.to_vec())
    } else {
        let mut sum = Mixture::<1>::new();
        for (k, at) in all.iter().enumerate() {
            let one = scorer.one(at, columns[0], shifts[0]);
            note(k, one.ln);
            sum.add(one.ln + prior, one.sizes, one.deviations);
        }
        let mean = sum.mean();
        (mean.ln, mean.sizes.to_vec(), mean.deviations.to_vec())
    };
    let scored =
        Scored { model: start.model.clone(), ln_weight, sizes, deviations, background: best.1 };
    Relinearised { scored, reduced, shifts }
}

fn estimate(scorer: &Scorer, at: &Background, columns: &[usize], shifts: &[f64]) -> Vec<f64> {
    match columns[..] {
        [a, b] => scorer.two(at, [a, b], [shifts[0], shifts[1]]).sizes.to_vec(),
        [a] => scorer.one(at, a, shifts[0]).sizes.to_vec(),
        _ => vec![],
    }
}

/// The Gram in which the model's columns and the residual are those at `sizes`, and what that replaced.
fn relinearise(
    stacked: &Stacked<'_>,
    model: &EffectModel<'_>,
    library: &Library,
    columns: &[usize],
    sizes: &[f64],
    without: Option<usize>,
) -> (Gram, Replaced) {
    let data = stacked.data;
    let design = stacked.design;
    let effects = effects_of(library, columns, sizes);
    let trial = model.trial(&effects);
    let differences: Vec<Difference> = columns
        .iter()
        .map(|&column| {
            let effect = &library.effects[library.columns[column].effect];
            Difference::of(model, &effects, effect.id, *effects.hidden(), 0.5 * effect.typical)
        })
        .collect();
    let channels = data.channels.count();
    let count = columns.len() + 1;
    let mut gram: Gram = stacked.folds.without(without).clone();
    let mut cross = Mat::<f64>::zeros(design.columns, count);
    let mut own = Mat::<f64>::zeros(count, count);
    let places: Vec<usize> = columns.iter().copied().chain([design.residual()]).collect();
    let mut replaced = Replaced { columns: places.clone(), levels: Vec::new() };
    for (index, flight) in data.flights.iter().enumerate() {
        if Some(fold_of(index)) == without {
            replaced.levels.push(vec![]);
            continue;
        }
        let segments = &data.segments[flight.segments.clone()];
        let whitened = stacked.whitened(index);
        let mut fresh = Mat::<f64>::zeros(whitened.nrows(), count);
        for (place, row) in segments.iter().enumerate() {
            let put = |fresh: &mut Mat<f64>, column: usize, values: &[f64; MAXIMUM_CHANNELS]| {
                let white = half_whitened(row, values, channels);
                for channel in 0..channels {
                    fresh[(place * channels + channel, column)] = white[channel];
                }
            };
            for (k, difference) in differences.iter().enumerate() {
                // A segment that cannot be flown with the effects says nothing about this one.
                let slope = difference
                    .signature(model, &row.known, row.is_recorded, &data.predictor)
                    .unwrap_or([0.0; MAXIMUM_CHANNELS]);
                put(&mut fresh, k, &slope);
            }
            let with = model.response_at(&row.known, &trial).unwrap_or(row.response);
            let with = data.predictor.predict(&with);
            let plain = data.predictor.predict(&row.response);
            let mut change = [0.0; MAXIMUM_CHANNELS];
            for channel in 0..channels {
                if row.is_recorded[channel] {
                    change[channel] = plain[channel] - with[channel];
                }
            }
            put(&mut fresh, count - 1, &change);
        }
        if let Some(gauge) = &flight.gauge {
            // Gauge signatures are linear in the size: slope as before, residual less what the sizes explain.
            let last = whitened.nrows() - 1;
            for (k, &column) in columns.iter().enumerate() {
                fresh[(last, k)] = gauge.signatures[column] / gauge.deviation;
                fresh[(last, count - 1)] -= gauge.signatures[column] * sizes[k] / gauge.deviation;
            }
        }
        whiten_flight(data, segments, &mut fresh);
        stacked.weigh(index, &mut fresh);
        for row in 0..fresh.nrows() {
            fresh[(row, count - 1)] += whitened[(row, design.residual())];
        }
        let level = whitened.col(design.smooth.start).to_owned();
        replaced.levels.push((fresh.transpose() * &level).iter().copied().collect());
        cross += whitened.transpose() * &fresh;
        own += fresh.transpose() * &fresh;
    }
    for (k, &place) in places.iter().enumerate() {
        for column in 0..design.columns {
            gram.matrix[(column, place)] = cross[(column, k)];
            gram.matrix[(place, column)] = cross[(column, k)];
        }
    }
    for (k, &a) in places.iter().enumerate() {
        for (l, &b) in places.iter().enumerate() {
            gram.matrix[(a, b)] = own[(k, l)];
        }
    }
    (gram, replaced)
}
