//! Gauss–Newton: the leading models re-simulated at their own estimate, re-linearised, re-scored. Noise stays.
//!
//! Difficult: one step changes a model's own columns and the residual, and nothing else. All models step together, so that the
//! rows are gone through once a step; what was integrated out before stays factored, and the changed columns follow.

use effects::{EffectModel, Effects, Trial};
use faer::{Mat, MatMut, MatRef};

use crate::hypotheses::backgrounds::{Background, TableBelief};
use crate::hypotheses::evidence::{ScoredHypothesis, Scorer};
use crate::library::Library;
use crate::math::eliminate::Changed;
use crate::priors::LARGEST_OF_TWO;
use crate::residuals::signatures::Difference;
use crate::residuals::whiten::whiten_within_segment;
use crate::search::folds::fold_of;
use crate::search::singles::Sum;
use crate::search::system::{EliminatedGrams, Problem, SmoothTerms, WhitenedSystem};
use crate::signals::channels::MAXIMUM_CHANNELS;

/// Largest number of re-linearisations of a model.
const STEPS: usize = 6;
/// A model is linearised no farther out than this times the typical size: a law that is nearly flat where it begins, as that of a drag
/// rise, throws its first estimate far beyond, from where each step takes back a little.
const FARTHEST: f64 = LARGEST_OF_TWO;
/// A step shorter than this share of the typical size ends the iteration.
const CONVERGED: f64 = 0.02;

/// A model linearised at its own estimate.
#[derive(Clone, Debug)]
pub(crate) struct Relinearised {
    pub(crate) scored: ScoredHypothesis,
    /// Its own columns and the residual, in the Gram without nuisance at every level of scatter between flights.
    pub(crate) changed: Vec<Changed>,
    /// Where it was linearised.
    pub(crate) shifts: Vec<f64>,
}

/// Effects of a model at these sizes.
pub(crate) fn effects_of(library: &Library, columns: &[usize], sizes: &[f64]) -> Effects {
    let mut effects = Effects::none();
    for (&column, &size) in columns.iter().zip(sizes) {
        let at = &library.columns[column];
        let id = library.effects[at.effect].id;
        effects = effects.with(id, size).with_hidden(id, at.hidden);
    }
    effects
}

/// One model on its way.
struct Relinearisation<'a> {
    start: &'a ScoredHypothesis,
    at: &'a Background,
    sizes: Vec<f64>,
}

/// Refines models, each with the background it was found in; `None` where a step leaves the domain of the physics.
/// `without` leaves a fold of flights out.
pub(crate) fn refine(
    problem: Problem<'_>,
    scorer: &Scorer,
    space: &EliminatedGrams,
    starts: &[(&ScoredHypothesis, &Background)],
    without: Option<usize>,
) -> Vec<Option<Relinearised>> {
    let Problem { system, model, library } = problem;
    // Smooth terms compete once, at the end, and never on folds.
    let smooth_terms = if without.is_none() { SmoothTerms::Kept } else { SmoothTerms::LeftOut };
    let mut runs: Vec<Option<Relinearisation<'_>>> = starts
        .iter()
        .map(|&(start, at)| {
            let sizes = within_reach(library, &start.hypothesis.columns, &start.sizes);
            Some(Relinearisation { start, at, sizes })
        })
        .collect();
    let mut refined: Vec<Option<Relinearised>> = starts.iter().map(|_| None).collect();
    let rescoring = Rescoring { library, scorer, space };
    for step in 0..=STEPS {
        let running: Vec<usize> = (0..runs.len()).filter(|&k| runs[k].is_some()).collect();
        if running.is_empty() {
            break;
        }
        let linear: Vec<Linear> = running
            .iter()
            .filter_map(|&k| runs[k].as_ref())
            .map(|run| Linear::new(model, library, &run.start.hypothesis.columns, &run.sizes))
            .collect();
        let mut fresh = RelinearisedRows::new(system, model, &linear, without);
        let mut products = fresh.products(system, smooth_terms);
        let mut finished = Vec::new();
        for (place, &k) in running.iter().enumerate() {
            let Some(run) = &mut runs[k] else { continue };
            if step == STEPS {
                finished.push(place);
                continue;
            }
            let columns = &run.start.hypothesis.columns;
            let changed = products.changed(&fresh, place);
            let found = estimate(rescoring, run, &changed, &fresh.levels_of(place))
                .filter(|found| found.iter().all(|size| size.is_finite()));
            let Some(found) = found else {
                runs[k] = None;
                continue;
            };
            let converged =
                columns.iter().zip(found.iter().zip(&run.sizes)).all(|(&column, (new, old))| {
                    let typical = library.effects[library.columns[column].effect].typical;
                    (new - old).abs() <= CONVERGED * typical
                });
            if converged {
                finished.push(place);
            } else {
                run.sizes = within_reach(library, columns, &found);
            }
        }
        if smooth_terms == SmoothTerms::Kept && !finished.is_empty() {
            products.add_smooth_terms(system, &fresh);
        }
        for place in finished {
            let k = running[place];
            let Some(run) = runs[k].take() else { continue };
            let changed = products.changed(&fresh, place);
            let levels = fresh.levels_of(place);
            refined[k] = Some(score_everywhere(rescoring, run, &changed, &levels));
        }
    }
    refined
}

/// Sizes at which a model may be linearised.
fn within_reach(library: &Library, columns: &[usize], sizes: &[f64]) -> Vec<f64> {
    let farthest =
        |column: usize| FARTHEST * library.effects[library.columns[column].effect].typical;
    let sizes = columns.iter().zip(sizes);
    sizes.map(|(&column, size)| size.clamp(-farthest(column), farthest(column))).collect()
}

/// What a relinearised hypothesis is scored with.
#[derive(Clone, Copy)]
struct Rescoring<'a> {
    library: &'a Library,
    scorer: &'a Scorer,
    space: &'a EliminatedGrams,
}

/// The hypothesis in every background.
fn score_everywhere(
    rescoring: Rescoring<'_>,
    run: Relinearisation<'_>,
    changed: &Changed,
    levels: &Mat<f64>,
) -> Relinearised {
    let Rescoring { library, scorer, space } = rescoring;
    let Relinearisation { start, sizes: shifts, .. } = run;
    let columns = &start.hypothesis.columns;
    let followed: Vec<Changed> =
        space.levels.iter().map(|level| level.follow(changed.clone(), levels)).collect();
    let all: Vec<Background> = space
        .smoothed
        .iter()
        .flat_map(|under| under.changed(library, columns, &followed[under.level()], |_| true))
        .collect();
    let prior = scorer.ln_prior(&start.hypothesis);
    let uncertain = |at: &Background| space.beliefs[at.level] == TableBelief::Uncertain;
    let scored = if let [a, b] = columns[..] {
        let mut sum = Sum::<2>::new();
        for (k, at) in all.iter().enumerate() {
            let mut one = scorer.two(at, [a, b], [shifts[0], shifts[1]]);
            one.ln += prior + at.ln_prior;
            sum.add(k, one, uncertain(at));
        }
        sum.scored(start.hypothesis.clone())
    } else {
        let mut sum = Sum::<1>::new();
        for (k, at) in all.iter().enumerate() {
            let mut one = scorer.one(at, columns[0], shifts[0]);
            one.ln += prior + at.ln_prior;
            sum.add(k, one, uncertain(at));
        }
        sum.scored(start.hypothesis.clone())
    };
    Relinearised { scored, changed: followed, shifts }
}

/// Sizes in the background that the model was found in; `None` where that cannot be made.
fn estimate(
    rescoring: Rescoring<'_>,
    run: &Relinearisation<'_>,
    changed: &Changed,
    levels: &Mat<f64>,
) -> Option<Vec<f64>> {
    let Rescoring { library, scorer, space } = rescoring;
    let under = space.smoothed.iter().find(|under| under.is_of(run.at))?;
    let followed = space.levels[under.level()].follow(changed.clone(), levels);
    let columns = &run.start.hypothesis.columns;
    let small_effects_scale = |small_effects_scale: f64| {
        small_effects_scale.total_cmp(&run.at.small_effects_scale).is_eq()
    };
    let one = under.changed(library, columns, &followed, small_effects_scale);
    let at = one.first()?;
    Some(match columns[..] {
        [a, b] => scorer.two(at, [a, b], [run.sizes[0], run.sizes[1]]).sizes.to_vec(),
        [a] => scorer.one(at, a, run.sizes[0]).sizes.to_vec(),
        _ => vec![],
    })
}

/// A model ready to be linearised at its sizes.
struct Linear {
    columns: Vec<usize>,
    sizes: Vec<f64>,
    trial: Trial,
    differences: Vec<Difference>,
}

impl Linear {
    fn new(model: &EffectModel<'_>, library: &Library, columns: &[usize], sizes: &[f64]) -> Self {
        let effects = effects_of(library, columns, sizes);
        let difference = |&column: &usize| {
            let effect = &library.effects[library.columns[column].effect];
            Difference::new(
                model,
                &effects,
                effect.id,
                effects.hidden(effect.id),
                0.5 * effect.typical,
            )
        };
        Self {
            columns: columns.to_vec(),
            sizes: sizes.to_vec(),
            trial: model.trial(&effects),
            differences: columns.iter().map(difference).collect(),
        }
    }

    /// Own columns and the residual.
    fn width(&self) -> usize {
        self.columns.len() + 1
    }
}

/// The rows of all models' own columns and residuals, model after model.
struct RelinearisedRows {
    /// Of each flight; none of a fold that is left out.
    flights: Vec<Option<Mat<f64>>>,
    /// Products with each flight's fuel-flow level.
    levels: Mat<f64>,
    /// First column of each model, and the end.
    starts: Vec<usize>,
}

impl RelinearisedRows {
    fn new(
        system: &WhitenedSystem<'_>,
        model: &EffectModel<'_>,
        linear: &[Linear],
        without: Option<usize>,
    ) -> Self {
        let mut starts = vec![0];
        for one in linear {
            starts.push(starts[starts.len() - 1] + one.width());
        }
        let width = starts[linear.len()];
        let flights = &system.data.flights;
        let mut fresh = Self {
            flights: Vec::with_capacity(flights.len()),
            levels: Mat::zeros(flights.len(), width),
            starts,
        };
        for index in 0..flights.len() {
            let kept =
                (Some(fold_of(index)) != without).then(|| fresh.rows(system, model, linear, index));
            fresh.flights.push(kept);
        }
        fresh
    }

    /// Whitened rows of a flight. Residuals are less what the sizes explain, but not yet the residual itself.
    fn rows(
        &self,
        system: &WhitenedSystem<'_>,
        model: &EffectModel<'_>,
        linear: &[Linear],
        index: usize,
    ) -> Mat<f64> {
        let data = system.data;
        let flight = &data.flights[index];
        let channels = data.channels.count();
        let segments = &data.segments[flight.segments.clone()];
        let rows = segments.len() * channels + usize::from(flight.gauge.is_some());
        let mut fresh = Mat::<f64>::zeros(rows, self.starts[linear.len()]);
        for (place, row) in segments.iter().enumerate() {
            let put = |fresh: &mut Mat<f64>, column: usize, values: &[f64; MAXIMUM_CHANNELS]| {
                let white = whiten_within_segment(row, values, channels);
                for channel in 0..channels {
                    fresh[(place * channels + channel, column)] = white[channel];
                }
            };
            let plain = data.predictor.predict(&row.response);
            for (one, &first) in linear.iter().zip(&self.starts) {
                for (k, difference) in one.differences.iter().enumerate() {
                    // A segment that cannot be flown with the effects says nothing about this one.
                    let slope = difference
                        .signature(model, &row.known, row.is_recorded, &data.predictor)
                        .unwrap_or([0.0; MAXIMUM_CHANNELS]);
                    put(&mut fresh, first + k, &slope);
                }
                let with = model.response_at(&row.known, &one.trial).unwrap_or(row.response);
                let with = data.predictor.predict(&with);
                let mut change = [0.0; MAXIMUM_CHANNELS];
                for channel in 0..channels {
                    if row.is_recorded[channel] {
                        change[channel] = plain[channel] - with[channel];
                    }
                }
                put(&mut fresh, first + one.columns.len(), &change);
            }
        }
        if let Some(gauge) = &flight.gauge {
            // Gauge signatures are linear in the size: slope as before, residual less what the sizes explain.
            for (one, &first) in linear.iter().zip(&self.starts) {
                let residual = first + one.columns.len();
                for (k, &column) in one.columns.iter().enumerate() {
                    let signature = gauge.signatures[column] / gauge.deviation;
                    fresh[(rows - 1, first + k)] = signature;
                    fresh[(rows - 1, residual)] -= signature * one.sizes[k];
                }
            }
        }
        system.whiten(index, &mut fresh);
        fresh
    }

    /// Completes the residuals, and multiplies with all but the columns of smooth terms.
    fn products(&mut self, system: &WhitenedSystem<'_>, smooth_terms: SmoothTerms) -> OwnProducts {
        let design = system.design;
        let width = self.levels.ncols();
        let end = design.smooth.end;
        let last = match smooth_terms {
            SmoothTerms::Kept => design.residual(),
            SmoothTerms::LeftOut => end,
        };
        let mut products =
            OwnProducts { cross: Mat::zeros(last + 1, width), own: Mat::zeros(width, width) };
        for (index, rows) in self.flights.iter_mut().enumerate() {
            let Some(rows) = rows else { continue };
            let whitened = system.whitened(index);
            let residual = whitened.subcols(design.residual(), 1);
            for place in &self.starts[1..] {
                for (value, of) in
                    rows.col_as_slice_mut(place - 1).iter_mut().zip(residual.col(0).iter())
                {
                    *value += of;
                }
            }
            let level = whitened.subcols(design.smooth.start, 1);
            add_product(self.levels.subrows_mut(index, 1), level, rows);
            add_product(products.cross.subrows_mut(0, end), whitened.subcols(0, end), rows);
            add_product(products.cross.subrows_mut(last, 1), residual, rows);
            add_product(products.own.as_mut(), rows.as_ref(), rows);
        }
        products
    }

    fn levels_of(&self, place: usize) -> Mat<f64> {
        let range = self.starts[place]..self.starts[place + 1];
        self.levels.subcols(range.start, range.len()).to_owned()
    }
}

/// Products of all models' own columns and residuals with a design's columns, residual last, and with each other.
struct OwnProducts {
    cross: Mat<f64>,
    own: Mat<f64>,
}

impl OwnProducts {
    fn changed(&self, fresh: &RelinearisedRows, place: usize) -> Changed {
        let (start, end) = (fresh.starts[place], fresh.starts[place + 1]);
        let width = end - start;
        Changed {
            cross: self.cross.subcols(start, width).to_owned(),
            own: self.own.submatrix(start, start, width, width).to_owned(),
        }
    }

    /// Products with columns of smooth terms, which were left open.
    fn add_smooth_terms(&mut self, system: &WhitenedSystem<'_>, fresh: &RelinearisedRows) {
        let design = system.design;
        let (start, end) = (design.smooth.end, design.residual());
        for (index, rows) in fresh.flights.iter().enumerate() {
            let Some(rows) = rows else { continue };
            let whitened = system.whitened(index);
            add_product(
                self.cross.subrows_mut(start, end - start),
                whitened.subcols(start, end - start),
                rows,
            );
        }
    }
}

/// `C += AᵀB`, in place.
fn add_product(into: MatMut<'_, f64>, a: MatRef<'_, f64>, b: &Mat<f64>) {
    let add = faer::Accum::Add;
    faer::linalg::matmul::matmul(into, add, a.transpose(), b.as_ref(), 1.0, faer::Par::Seq);
}
