//! Outside the library: which function of which variable, how large, and how much of the gap it closes on unseen flights.

use effects::{DRAG_COEFFICIENT_PER_COUNT, PERCENT, Variable};
use faer::Mat;
use units::convert::STANDARD_GRAVITY_M_S2;

use crate::hypotheses::design::Acts;
use crate::hypotheses::evidence::Scorer;
use crate::judge::closure::Shrinkage;
use crate::judge::forms::dictionary::{Candidate, Values, candidates, finer, finest};
use crate::math::eliminate::Changed;
use crate::math::mixture::ln_sum;
use crate::output::form::{ActsOn, FoundForm};
use crate::output::verdict::Closure;
use crate::priors::{FORM_AMPLITUDES, NOISE_FREEDOM};
use crate::residuals::rows::SegmentRow;
use crate::residuals::whiten::whiten_within_segment;
use crate::search::analyse::Analysis;
use crate::search::folds::fold_of;
use crate::search::outside::Outside;
use crate::search::system::{Problem, SmoothTerms, WhitenedSystem};
use crate::signals::channels::MAXIMUM_CHANNELS;
use crate::thresholds::{CLOSURE_FOLDS, FORM_VARIABLES, FORMS_TOLD, NORMAL_95};

pub(crate) mod dictionary;

/// The forms that the leading variables of a cause outside the library may have, best first.
pub(crate) fn leading_forms(
    problem: Problem<'_>,
    analysis: &Analysis,
    outside: &Outside,
    (noise_scale, seed): (f64, u64),
) -> Vec<FoundForm> {
    let variables = &outside.leading[..outside.leading.len().min(FORM_VARIABLES)];
    forms(problem.system, &analysis.scorer, variables, noise_scale, seed)
}

/// The most probable forms of different kinds, best first, where a function of one of these variables is needed.
fn forms(
    system: &WhitenedSystem<'_>,
    scorer: &Scorer,
    leading: &[Variable],
    noise_scale: f64,
    seed: u64,
) -> Vec<FoundForm> {
    let values = values_of(system, leading);
    let coarse = candidates(&values);
    if coarse.is_empty() {
        return vec![];
    }
    let Some(first) = Fits::new(system, scorer, &values, coarse, None) else { return vec![] };
    // A second, closer grid about the best of every kind.
    let close: Vec<Candidate> = first
        .kinds()
        .into_iter()
        .flat_map(|kind| finer(&values, &first.candidates[kind.best]))
        .collect();
    let Some(fits) = Fits::new(system, scorer, &values, close, None) else { return vec![] };
    let mut kinds = fits.kinds();
    kinds.truncate(FORMS_TOLD);
    let whole = ln_sum(fits.ln.iter().copied());
    kinds
        .iter()
        .map(|kind| {
            let one = &fits.candidates[kind.best];
            let of = &values[one.variable];
            let unseen = unseen(system, scorer, (&values, one), noise_scale, seed);
            // What is told is the best of a third grid: an addition that is applied is to leave nothing by its own steps.
            let told = Fits::new(system, scorer, &values, finest(&values, one), None);
            let told = told.as_ref().and_then(|told| Some((told.kinds().first()?.best, told)));
            let (best, told) = told.unwrap_or((kind.best, &fits));
            let (size, deviation) = told.size(best);
            FoundForm {
                form: told.candidates[best].form,
                variable: of.variable,
                acts_on: if of.acts == Acts::Thrust { ActsOn::Thrust } else { ActsOn::FuelFlow },
                size,
                rms_percent: told.rms_percent(best),
                size_ci95: [size - NORMAL_95 * deviation, size + NORMAL_95 * deviation],
                place_ci95: fits.places(kind),
                scale: [of.mean, of.deviation],
                probability: (kind.ln - whole).exp(),
                closure: unseen.closure().map(|(share, ci95)| Closure { share, ci95 }),
            }
        })
        .collect()
}

/// The values of each variable, acting on fuel flow and on drag.
fn values_of(system: &WhitenedSystem<'_>, variables: &[Variable]) -> Vec<Values> {
    let mut all: Vec<Values> = Vec::new();
    for &variable in variables {
        let references = system.design.references();
        let of = |row: &SegmentRow| variable.value_of_form(&row.point, &row.response, references);
        let values: Option<Vec<f64>> = system.data.segments.iter().map(of).collect();
        let Some(values) = values else { continue };
        for acts in [Acts::FuelFlow, Acts::Thrust] {
            all.extend(Values::new(variable, acts, values.clone()));
        }
    }
    all
}

/// All candidates fitted beside what is uncertain about the model.
struct Fits {
    candidates: Vec<Candidate>,
    /// ln evidence, prior of the candidate included.
    ln: Vec<f64>,
    /// Mean and standard deviation of each size, for a function of 1 % root mean square, and that function's size in the form's own unit.
    sizes: Vec<(f64, f64)>,
    units: Vec<f64>,
}

/// Candidates of one kind: one form of one variable, its parameters left open.
struct FormKind {
    members: Vec<usize>,
    best: usize,
    ln: f64,
}

impl Fits {
    fn new(
        system: &WhitenedSystem<'_>,
        scorer: &Scorer,
        values: &[Values],
        candidates: Vec<Candidate>,
        without: Option<usize>,
    ) -> Option<Self> {
        let units: Vec<f64> = candidates.iter().map(|one| unit_of(system, values, one)).collect();
        let columns = Columns { system, values, candidates: &candidates, units: &units };
        let (changed, levels) = columns.products(without);
        let gram = system.gram(without);
        let count = candidates.len();
        let mut ln = vec![f64::NEG_INFINITY; count];
        let mut sizes = vec![(0.0, 0.0); count];
        let mut best = vec![f64::NEG_INFINITY; count];
        for &level in &system.levels {
            let (elimination, reduced) =
                system.level(gram, level, without, SmoothTerms::LeftOut)?;
            let own = elimination.follow(changed.clone(), &levels).own;
            let square = own[(count, count)];
            for k in 0..count {
                for amplitude in FORM_AMPLITUDES {
                    let precision = (PERCENT / amplitude).powi(2);
                    let total = own[(k, k)] + precision;
                    let left = square - own[(k, count)].powi(2) / total;
                    let determinant = reduced.ln_determinant + (total / precision).ln();
                    let one = scorer.nothing(left, determinant) + level.ln_prior
                        - (FORM_AMPLITUDES.len() as f64).ln()
                        + candidates[k].ln_prior;
                    if !one.is_finite() {
                        continue;
                    }
                    ln[k] = ln_sum([ln[k], one]);
                    if one > best[k] {
                        best[k] = one;
                        let variance = (NOISE_FREEDOM + left) / (NOISE_FREEDOM + gram.rows) / total;
                        sizes[k] = (own[(k, count)] / total, variance.max(0.0).sqrt());
                    }
                }
            }
        }
        Some(Self { candidates, ln, sizes, units })
    }

    /// Kinds, the most probable first.
    fn kinds(&self) -> Vec<FormKind> {
        let mut kinds: Vec<FormKind> = Vec::new();
        for (index, one) in self.candidates.iter().enumerate() {
            let like = |kind: &&mut FormKind| self.candidates[kind.best].is_like(one);
            if let Some(kind) = kinds.iter_mut().find(like) {
                kind.members.push(index);
                if self.ln[index] > self.ln[kind.best] {
                    kind.best = index;
                }
            } else {
                kinds.push(FormKind { members: vec![index], best: index, ln: 0.0 });
            }
        }
        for kind in &mut kinds {
            kind.ln = ln_sum(kind.members.iter().map(|&member| self.ln[member]));
        }
        kinds.sort_by(|a, b| b.ln.total_cmp(&a.ln));
        kinds
    }

    /// Size of a candidate in its own unit, with its standard deviation.
    fn size(&self, index: usize) -> (f64, f64) {
        let (size, deviation) = self.sizes[index];
        (size * self.units[index], deviation * self.units[index])
    }

    /// Root mean square of what a candidate changes fuel flow by, %: sizes are those of functions of 1 %.
    fn rms_percent(&self, index: usize) -> f64 {
        self.sizes[index].0.abs()
    }

    /// Between which places of a kind 95 % of its probability lie.
    fn places(&self, kind: &FormKind) -> Option<[f64; 2]> {
        let mut places: Vec<(f64, f64)> = kind
            .members
            .iter()
            .filter_map(|&member| {
                let weight = (self.ln[member] - kind.ln).exp();
                Some((self.candidates[member].place()?, weight))
            })
            .collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        let end = |share: f64| {
            let mut sum = 0.0;
            places.iter().find_map(|(place, weight)| {
                sum += weight;
                (sum >= share).then_some(*place)
            })
        };
        let last = places.last().map(|last| last.0);
        end(0.025).map(|low| [low, end(0.975).or(last).unwrap_or(low)])
    }
}

/// What a candidate changes ln fuel flow by at a segment, where its size is 1 in its unit: 1 % of fuel flow, a drag count.
pub(crate) fn change(values: &[Values], one: &Candidate, segment: usize, row: &SegmentRow) -> f64 {
    let shape = one.value(values, segment);
    match values[one.variable].acts {
        Acts::Thrust => {
            let weight_n = row.response.mass_kg * STANDARD_GRAVITY_M_S2;
            let drag_n = row.drag_over_thrust * row.response.net_thrust_n;
            let drag_coefficient = row.response.lift_coefficient * drag_n / weight_n;
            shape * DRAG_COEFFICIENT_PER_COUNT / drag_coefficient * row.drag_over_thrust
        }
        _ => shape * PERCENT,
    }
}

/// The size at which a candidate changes ln fuel flow by 1 %, root mean square.
fn unit_of(system: &WhitenedSystem<'_>, values: &[Values], one: &Candidate) -> f64 {
    let segments = &system.data.segments;
    let square: f64 = segments
        .iter()
        .enumerate()
        .map(|(index, row)| change(values, one, index, row).powi(2))
        .sum();
    let rms = (square / segments.len().max(1) as f64).sqrt();
    if rms > 0.0 { PERCENT / rms } else { 0.0 }
}

/// Columns of candidates, and the residual behind them.
pub(crate) struct Columns<'a> {
    pub(crate) system: &'a WhitenedSystem<'a>,
    pub(crate) values: &'a [Values],
    pub(crate) candidates: &'a [Candidate],
    pub(crate) units: &'a [f64],
}

impl Columns<'_> {
    /// Products with all columns that are uncertain about the model, with each other, and with each flight's level.
    pub(crate) fn products(&self, without: Option<usize>) -> (Changed, Mat<f64>) {
        let Self { system, candidates, .. } = *self;
        let design = system.design;
        let (end, width) = (design.smooth.end, candidates.len() + 1);
        let flights = &system.data.flights;
        let mut changed =
            Changed { cross: Mat::zeros(end + 1, width), own: Mat::zeros(width, width) };
        let mut levels = Mat::<f64>::zeros(flights.len(), width);
        for index in 0..flights.len() {
            if Some(fold_of(index)) == without {
                continue;
            }
            let whitened = system.whitened(index);
            let mut rows = self.rows(index);
            for (row, value) in whitened.col(design.residual()).iter().enumerate() {
                rows[(row, width - 1)] = *value;
            }
            let cross = whitened.subcols(0, end).transpose() * &rows;
            for column in 0..width {
                for row in 0..end {
                    changed.cross[(row, column)] += cross[(row, column)];
                }
            }
            let own = rows.transpose() * &rows;
            let level = whitened.subcols(design.smooth.start, 1).transpose() * &rows;
            for column in 0..width {
                changed.cross[(end, column)] += own[(width - 1, column)];
                levels[(index, column)] = level[(0, column)];
            }
            changed.own += own;
        }
        (changed, levels)
    }

    /// Whitened rows of a flight, the residual's column left open.
    fn rows(&self, index: usize) -> Mat<f64> {
        let Self { system, values, candidates, units } = *self;
        let data = system.data;
        let flight = &data.flights[index];
        let channels = data.channels;
        let segments = &data.segments[flight.segments.clone()];
        let count = segments.len() * channels.count() + usize::from(flight.gauge.is_some());
        let mut rows = Mat::<f64>::zeros(count, candidates.len() + 1);
        for (place, row) in segments.iter().enumerate() {
            let mut on_fuel = [0.0; MAXIMUM_CHANNELS];
            on_fuel[0] = 1.0;
            let mut on_thrust = on_fuel;
            if channels.n2 && row.is_recorded[channels.n2_row()] {
                on_thrust[channels.n2_row()] = row.n2_slope;
            }
            let fuel = whiten_within_segment(row, &on_fuel, channels.count());
            let thrust = whiten_within_segment(row, &on_thrust, channels.count());
            for (column, one) in candidates.iter().enumerate() {
                let by = change(values, one, flight.segments.start + place, row) * units[column];
                let white = if values[one.variable].acts == Acts::Thrust { thrust } else { fuel };
                for (channel, value) in white.iter().enumerate().take(channels.count()) {
                    rows[(place * channels.count() + channel, column)] = value * by;
                }
            }
        }
        system.whiten(index, &mut rows);
        rows
    }
}

/// Before and after a form whose parameters and size are those of the other flights, fold by fold.
fn unseen(
    system: &WhitenedSystem<'_>,
    scorer: &Scorer,
    (values, one): (&[Values], &Candidate),
    noise_scale: f64,
    seed: u64,
) -> Shrinkage {
    let of_kind: Vec<Candidate> =
        candidates(values).into_iter().filter(|other| other.is_like(one)).collect();
    let best = |tried: Vec<Candidate>, fold: usize| {
        let fits = Fits::new(system, scorer, values, tried, Some(fold))?;
        let kinds = fits.kinds();
        let index = kinds.first()?.best;
        Some((fits.candidates[index], fits.size(index).0))
    };
    let fitted: Vec<Option<(Candidate, f64)>> = (0..CLOSURE_FOLDS)
        .map(|fold| {
            let (coarse, _) = best(of_kind.clone(), fold)?;
            best(finer(values, &coarse), fold)
        })
        .collect();
    let closed = |flight: usize, segment: usize| {
        fitted[fold_of(flight)].as_ref().map_or(0.0, |(one, size)| {
            size * change(values, one, segment, &system.data.segments[segment])
        })
    };
    Shrinkage::of_changes(system, noise_scale, seed, closed)
}
