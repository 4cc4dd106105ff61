//! From flights to a verdict.

use core::fmt::Write as _;

use flight::effect::EffectId;
use perf_model::PerformanceModel;
use perf_model::effects::{
    EffectModel, EffectModelError, EffectPoint, EffectReferences, Effects, StepTarget,
};
use statrs::function::erf::erfc;

use crate::TableUncertainty;
use crate::addition::Addition;
use crate::advice::{Advisor, best_first};
use crate::analysis::{Analysis, Stacked, analyse};
use crate::baseline::Baseline;
use crate::classes::{Distances, leading_columns};
use crate::closure::{SMALLEST_GAP, Shrinkage, held_out_floor, in_sample, nested, replicate_floor};
use crate::data::{Against, Data};
use crate::design::{Acts, Design};
use crate::evidence::{NOISE_FREEDOM, Scored};
use crate::library::Library;
use crate::output::{
    Cause, Detectable, Diagnosis, Gap, Magnitude, NotTestable, OutsideLibrary, Separation, Verdict,
    VerdictKind,
};
use crate::outside::{Companion, Outside, compete};
use crate::record::FlightRecord;
use crate::slices;

/// Fewest flights and segments that a name is given on.
const FEWEST_FLIGHTS: usize = 6;
const FEWEST_SEGMENTS: usize = 30;
/// A gap counts as real when nothing at all is less probable than this.
pub(crate) const CLEAN_PROBABILITY: f64 = 0.05;
/// Probability of a cause outside the library above which it is said.
const OUTSIDE_PROBABILITY: f64 = 0.5;
/// Shares of the explainable gap between which a named set that an agnostic function improves upon passes from "something
/// else" to "this effect in another form". Their middle, nine tenths, is where the verdict turns.
const OTHER_FORM: [f64; 2] = [0.8, 1.0];
/// Probability that the credible set of effects holds.
const CREDIBLE: f64 = 0.95;
/// Half width of a 95 % interval in standard deviations.
const NORMAL_95: f64 = 1.96;

/// What is diagnosed, and against what.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// The performance model.
    pub model: &'a PerformanceModel,
    /// Its drag table: its own, or the adapted one.
    pub drag_table: &'a lut::Table,
    /// Flights in order of flying, none of which the table has learnt.
    pub flights: &'a [FlightRecord<'a>],
    /// What the model remembers of clean flights; `None` against a table alone.
    pub baseline: Option<&'a Baseline>,
    /// What the table does not know; `None` where every node counts as known.
    pub table: Option<&'a TableUncertainty>,
    /// Conditions that effects are zero at; else the baseline's, else the means of the data at hand.
    pub references: Option<EffectReferences>,
}

impl<'a> Input<'a> {
    /// Flights against a model's own table, nothing taught and every node taken as known.
    #[must_use]
    pub const fn against(model: &'a PerformanceModel, flights: &'a [FlightRecord<'a>]) -> Self {
        Self {
            model,
            drag_table: model.drag_table(),
            flights,
            baseline: None,
            table: None,
            references: None,
        }
    }
}

/// What to look for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Only these effects; empty for all.
    pub effects: Vec<EffectId>,
    /// Not these.
    pub without: Vec<EffectId>,
    /// Leave closure out: choice and fit on folds cost as much again as the search.
    pub skip_closure: bool,
    /// Leave out where the gap lies.
    pub skip_where: bool,
    /// Seed of the draws of noise and the resamples of flights behind intervals and `where`.
    pub seed: u64,
}

/// Why there is no diagnosis.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnoseError {
    /// The model takes no effects.
    #[error(transparent)]
    Model(#[from] EffectModelError),
    /// Too few flights to learn a baseline from.
    #[error("{found} flights inside the drag table, at least {needed} are needed")]
    TooFewFlights {
        /// Flights found.
        found: usize,
        /// Flights needed.
        needed: usize,
    },
    /// A matrix that is not positive definite: columns beyond what doubles hold.
    #[error("the linear model is degenerate")]
    Degenerate,
}

/// References of the data at hand.
///
/// # Errors
/// [`DiagnoseError::Model`] where nothing is inside the drag table.
pub fn references_of(
    model: &PerformanceModel,
    drag_table: &lut::Table,
    flights: &[FlightRecord<'_>],
) -> Result<EffectReferences, DiagnoseError> {
    let engines = model.aircraft().engines();
    #[expect(clippy::cast_precision_loss, reason = "seconds since 1970 are below 2^53")]
    let points: Vec<EffectPoint> = flights
        .iter()
        .flat_map(|flight| flight.segments)
        .filter_map(|segment| {
            // What cannot be corrected is left out of the diagnosis too, with its reason.
            let means = model.corrected_means(&segment.means).ok()?;
            let start_s = segment.identity.start.as_second() as f64;
            Some(EffectPoint::of_means(&means, start_s, engines))
        })
        .collect();
    Ok(EffectReferences::mean_of(model.aircraft(), drag_table, &points)?)
}

/// Diagnoses one set of flights.
///
/// # Errors
/// [`DiagnoseError`] where the model takes no effects or the numbers are degenerate. Too little data is a verdict, not
/// an error.
pub fn diagnose(input: &Input<'_>, options: &Options) -> Result<Diagnosis, DiagnoseError> {
    let references = match (input.references, input.baseline) {
        (Some(given), _) => given,
        (None, Some(baseline)) => *baseline.references(),
        (None, None) => match references_of(input.model, input.drag_table, input.flights) {
            Ok(found) => found,
            Err(DiagnoseError::Model(EffectModelError::NothingInside { segments })) => {
                return Ok(insufficient(
                    0,
                    0,
                    &format!("none of {segments} segments is inside the drag table"),
                ));
            }
            Err(error) => return Err(error),
        },
    };
    let model = EffectModel::new(input.model, input.drag_table, references)?;
    let chosen = |id: EffectId| {
        (options.effects.is_empty() || options.effects.contains(&id))
            && !options.without.contains(&id)
    };
    let against = input.baseline.map_or(Against::Table, Against::Baseline);
    let (data, library) =
        Data::prepare(&model, input.flights, against, |points, engines, starts| {
            Library::of(&model, points, engines, starts, chosen)
        });
    let not_testable = library
        .not_testable
        .iter()
        .map(|(id, needs)| NotTestable {
            effect: id.to_string(),
            needs: needs.iter().map(|&name| name.to_owned()).collect(),
        })
        .collect();
    if let Some(reason) = too_little(&data, &library) {
        let mut found = insufficient(data.flights.len(), data.segments.len(), &reason);
        found.not_testable = not_testable;
        found.left_out = data.left_out;
        return Ok(found);
    }
    let design = Design::of(&data, &references, input.baseline, input.table);
    let stacked = Stacked::of(&data, &design, None);
    let mut notes = Vec::new();
    notes.extend(data.thrust_by_n2_note(&library));
    if input.references.is_none() && input.baseline.is_none() {
        notes.push("references of effects are the means of these flights".to_owned());
    }
    let mut result = conclude(&stacked, &model, &library, options, &mut notes)?;
    // Heavy tails show only beside the best model; then everything is done again with weights.
    if let Some(weights) = crate::robust::weights(&stacked, &result.1, &library) {
        notes.push("whitened residuals have heavy tails: segments are weighed".to_owned());
        drop(result);
        let stacked = Stacked::of(&data, &design, Some(weights));
        result = conclude(&stacked, &model, &library, options, &mut notes)?;
    }
    let mut diagnosis = result.0;
    diagnosis.not_testable = not_testable;
    diagnosis.left_out.clone_from(&data.left_out);
    diagnosis.notes = notes;
    Ok(diagnosis)
}

/// Why the data is too little for any name.
fn too_little(data: &Data<'_>, library: &Library) -> Option<String> {
    let (flights, segments) = (data.flights.len(), data.segments.len());
    if flights < FEWEST_FLIGHTS {
        return Some(format!("{flights} flights, at least {FEWEST_FLIGHTS} are needed"));
    }
    if segments < FEWEST_SEGMENTS {
        return Some(format!("{segments} segments, at least {FEWEST_SEGMENTS} are needed"));
    }
    if library.effects.is_empty() {
        return Some("no effect of the library can be tested".to_owned());
    }
    let spread = |of: &dyn Fn(&EffectPoint) -> f64| {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for row in &data.segments {
            low = low.min(of(&row.point));
            high = high.max(of(&row.point));
        }
        high - low
    };
    let conditions = [
        spread(&|p| p.mach) > 1e-3,
        spread(&|p| p.pressure_altitude_m) > 30.0,
        spread(&|p| p.mass_kg / p.mass_kg.max(1.0)) > 0.0 || spread(&|p| p.mass_kg) > 1.0,
        spread(&|p| p.static_air_temperature_k) > 0.1,
    ];
    if conditions.iter().filter(|varied| **varied).count() < 2 {
        return Some("all segments were flown at the same conditions".to_owned());
    }
    let first = data.segments[0].residual[0];
    if data.segments.iter().all(|row| (row.residual[0] - first).abs() < 1e-12) {
        return Some(
            "the residuals of all segments are equal: fuel flow was computed, not measured"
                .to_owned(),
        );
    }
    None
}

fn insufficient(flights: usize, segments: usize, reason: &str) -> Diagnosis {
    Diagnosis {
        tail: String::new(),
        flights,
        segments,
        gap: Gap {
            mean_percent: 0.0,
            rms_percent: 0.0,
            rms_ci95: [0.0; 2],
            noise_floor_rms_percent: 0.0,
            floor_by_replicates_rms_percent: None,
            floor_by_held_out_fit_rms_percent: None,
            detected: false,
            p_value: 1.0,
        },
        r#where: vec![],
        causes: vec![],
        not_testable: vec![],
        verdict: Verdict {
            kind: VerdictKind::InsufficientData,
            effects: vec![],
            class: vec![],
            probability: 0.0,
            closure: None,
            closure_ci95: None,
            advice: format!("Too little data: {reason}."),
            separations: vec![],
        },
        addition: None,
        detectable: vec![],
        outside: OutsideLibrary { probability: 0.0, variable: None, acts_on: None },
        left_out: std::collections::BTreeMap::new(),
        notes: vec![],
    }
}

/// An effect with its posterior.
#[derive(Clone, Debug)]
struct Posterior {
    /// Index in the library; `None` for flight-to-flight scatter.
    effect: Option<usize>,
    probability: f64,
    /// The most probable model in which it is the larger effect.
    model: Scored,
    /// Its place in that model.
    place: usize,
}

fn conclude(
    stacked: &Stacked<'_>,
    model: &EffectModel<'_>,
    library: &Library,
    options: &Options,
    notes: &mut Vec<String>,
) -> Result<(Diagnosis, Analysis), DiagnoseError> {
    let analysis = analyse(stacked, model, library, None, true).ok_or(DiagnoseError::Degenerate)?;
    let mut outside = compete(stacked, &analysis, library);
    let gram = stacked.gram(None);
    let leading = leading_columns(library, &analysis.models);
    let distances =
        Distances::of(gram, stacked.design, leading).ok_or(DiagnoseError::Degenerate)?;
    let best = &analysis.models[0].0;
    let scale = noise_scale(&analysis, best, gram.rows);
    let posteriors = dominant(stacked, &analysis, library);
    let own =
        in_sample(stacked, model, library, &best.model.columns, &best.sizes, scale, options.seed);
    let mut gap = gap_of(stacked, &analysis, &own, scale);
    let real = is_real(&analysis, &outside) || exceeds_uncertainty(&gap, unknown_square(stacked));
    let unseen = (!options.skip_closure && real)
        .then(|| nested(stacked, model, library, scale, options.seed));
    // What a taught remainder leaves need not be noise; but a name that makes other flights worse is none.
    let makes_worse = stacked.data.predictor.baseline.is_some()
        && unseen.as_ref().and_then(Shrinkage::closure).is_some_and(|(closure, _)| closure < 0.0);
    gap.detected = real && !is_vague(&gap, &outside, posteriors.first(), makes_worse);
    let unseen = unseen.filter(|_| gap.detected);
    if unseen.is_some() {
        let percent = |square: f64| 100.0 * square.sqrt();
        gap.floor_by_replicates_rms_percent = replicate_floor(stacked, &own, scale).map(percent);
        gap.floor_by_held_out_fit_rms_percent = held_out_floor(stacked, library).map(percent);
    }
    let places = if options.skip_where {
        vec![]
    } else {
        slices::find(stacked, &analysis, scale, gap.detected, options.seed)
    };
    let found_outside = outside.probability;
    let top = posteriors.first();
    outside.probability *= 1.0
        - credit(
            beside(&outside, &distances, library, top),
            top.is_some_and(|top| top.effect.is_none()),
            closed(unseen.as_ref(), &own),
        );
    let classes = distances.classes(library);
    let advisor = advisor(stacked, model, library, &distances, &classes, &posteriors, gap.detected);
    let verdict = verdict(
        &analysis,
        &outside,
        found_outside,
        &distances,
        &advisor,
        library,
        &posteriors,
        &own,
        unseen.as_ref(),
        gap.detected,
        notes,
    );
    let causes = causes(&analysis, &outside, &distances, library, &posteriors, unseen.as_ref());
    let name = |effect: usize| library.effects[effect].id.to_string();
    let detectable = (0..library.effects.len())
        .map(|effect| {
            let smallest = distances.smallest_detectable(effect);
            let class = classes.iter().find(|class| class.contains(&effect));
            Detectable {
                effect: name(effect),
                smallest: smallest.is_finite().then_some(smallest),
                unit: library.effects[effect].id.entry().unit.to_owned(),
                class: class
                    .map_or_else(Vec::new, |class| class.iter().map(|&e| name(e)).collect()),
                nearest_other: distances.nearest_other(library, effect),
                nearest_pair: distances.nearest_pair(library, effect),
                separations: class.map_or_else(Vec::new, |class| advisor.beforehand(effect, class)),
            }
        })
        .collect();
    let diagnosis = Diagnosis {
        tail: String::new(),
        flights: stacked.data.flights.len(),
        segments: stacked.data.segments.len(),
        gap,
        r#where: places,
        causes,
        not_testable: vec![],
        addition: Addition::of(&analysis, library, &verdict.effects, *model.references())
            .filter(|_| !verdict.effects.is_empty()),
        verdict,
        detectable,
        outside: OutsideLibrary {
            probability: outside.probability,
            variable: outside.variable.map(|(variable, _)| variable.words().to_owned()),
            acts_on: outside.variable.map(|(_, acts)| acts_words(acts).to_owned()),
        },
        left_out: std::collections::BTreeMap::new(),
        notes: vec![],
    };
    Ok((diagnosis, analysis))
}

/// Whether there is more than noise: either nothing at all is improbable beside the library, or nothing outside it is.
fn is_real(analysis: &Analysis, outside: &Outside) -> bool {
    analysis.clean <= CLEAN_PROBABILITY || 1.0 - outside.probability <= CLEAN_PROBABILITY
}

/// Whether the gap is larger than noise and what the model does not know together by what closure needs, at 97.5 %: then it
/// is real, however many small effects could make it up together. `unknown` is a mean square of ln fuel flow.
fn exceeds_uncertainty(gap: &Gap, unknown: f64) -> bool {
    let expected = gap.noise_floor_rms_percent.powi(2) + 1e4 * unknown;
    gap.rms_ci95[0].powi(2) > (1.0 + SMALLEST_GAP) * expected
}

/// Mean square of ln fuel flow that the table, the chords of its cells and a taught remainder leave open.
fn unknown_square(stacked: &Stacked<'_>) -> f64 {
    let (data, design) = (stacked.data, stacked.design);
    let sum: f64 = data
        .flights
        .iter()
        .map(|flight| {
            let rows = design.fuel_flow(data, flight);
            (0..rows.nrows())
                .flat_map(|row| design.nuisance.clone().map(move |column| (row, column)))
                .map(|at| rows[at] * rows[at])
                .sum::<f64>()
        })
        .sum();
    sum / data.segments.len().max(1) as f64
}

/// Whether the evidence points at nothing: nothing is more probable than not, and the size of the gap is within its noise or
/// the leading set widens it on flights that it was not fitted to. A remainder is never exact, and what is left over
/// is spread over many small hypotheses.
fn is_vague(gap: &Gap, outside: &Outside, top: Option<&Posterior>, makes_worse: bool) -> bool {
    outside.probability <= OUTSIDE_PROBABILITY
        && top.is_none_or(|top| top.probability * (1.0 - outside.probability) < 0.5)
        && (gap.rms_ci95[0] <= gap.noise_floor_rms_percent || makes_worse)
}

/// Share of the explainable gap that the leading set closes, with its interval: on unseen flights; on the same ones where the
/// gap is too small for that; `None` where it is too small for either.
fn closed(unseen: Option<&Shrinkage>, own: &Shrinkage) -> Option<(f64, [f64; 2])> {
    unseen.and_then(Shrinkage::closure).or_else(|| own.closure())
}

/// How much of the evidence for an agnostic function goes to the leading effect `[diagnosis.41]`: the larger of
///
/// - what says that the function is the effect in another form. Truth never has the library's form exactly, and with enough
///   flights an agnostic function sees it. Effects of the library in other forms closed 0.94 to 0.98 of the gap on two
///   other simulators, effects that the library lacks 0.25 at most;
/// - what says that the effect acts *beside* the function: the probability of it or of a member of its class in the models
///   that hold a function, as long as the effect surely makes unseen flights better, where that can be measured. Real
///   gaps have many causes, and the largest has a name though the rest has none.
///
/// Scatter between flights closes nothing: only the second counts for it.
fn credit(beside: f64, is_scatter: bool, closed: Option<(f64, [f64; 2])>) -> f64 {
    let Some((share, [least, _])) = closed.filter(|_| !is_scatter) else { return beside };
    let [none, all] = OTHER_FORM;
    let form = ((share - none) / (all - none)).clamp(0.0, 1.0);
    if least > 0.0 { form.max(beside) } else { form }
}

/// If an agnostic function is needed, the probability that the leading effect, or one that these flights cannot tell from it,
/// acts beside it.
fn beside(
    outside: &Outside,
    distances: &Distances,
    library: &Library,
    top: Option<&Posterior>,
) -> f64 {
    let Some(top) = top else { return 0.0 };
    if top.effect.is_none() {
        return outside.beside(&Companion::Scatter).min(1.0);
    }
    let column = top.model.model.columns[top.place];
    let size = top.model.sizes[top.place];
    let class = distances.confused_with(library, column, size);
    class.into_iter().map(|effect| outside.beside(&Companion::Effect(effect))).sum::<f64>().min(1.0)
}

const fn acts_words(acts: Acts) -> &'static str {
    match acts {
        Acts::FuelFlow => "fuel flow",
        Acts::Thrust => "thrust",
        Acts::Split => "one engine",
    }
}

/// Noise variance over what the sensors announce, of the best model.
fn noise_scale(analysis: &Analysis, best: &Scored, rows: usize) -> f64 {
    let at = &analysis.backgrounds[best.background.min(analysis.backgrounds.len() - 1)];
    let explained: f64 = best
        .model
        .columns
        .iter()
        .zip(&best.sizes)
        .map(|(&column, size)| at.product(column) * size)
        .sum();
    let square = (at.square - explained).max(0.0);
    (NOISE_FREEDOM + square) / (NOISE_FREEDOM + rows as f64)
}

/// Probability of each effect to be the larger one of what acts, over models.
fn dominant(stacked: &Stacked<'_>, analysis: &Analysis, library: &Library) -> Vec<Posterior> {
    let count = stacked.data.segments.len() as f64;
    let mean_squares: Vec<f64> = (0..library.columns.len())
        .map(|column| {
            stacked.data.segments.iter().map(|row| row.signatures[column][0].powi(2)).sum::<f64>()
                / count
        })
        .collect();
    // One entry an effect, flight-to-flight scatter last.
    let mut found: Vec<Option<Posterior>> = vec![None; library.effects.len() + 1];
    for (scored, probability) in &analysis.models {
        let mut shares: Vec<(f64, Option<usize>, usize)> = scored
            .model
            .columns
            .iter()
            .zip(&scored.sizes)
            .enumerate()
            .map(|(place, (&column, size))| {
                (size * size * mean_squares[column], Some(library.columns[column].effect), place)
            })
            .collect();
        if let Some(percent) = scored.model.heating_percent {
            shares.push(((percent / 100.0).powi(2), None, 0));
        }
        let Some(&(_, effect, place)) = shares.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else {
            continue;
        };
        let slot = &mut found[effect.unwrap_or(library.effects.len())];
        match slot {
            Some(posterior) => posterior.probability += probability,
            None => {
                *slot = Some(Posterior {
                    effect,
                    probability: *probability,
                    model: scored.clone(),
                    place,
                });
            }
        }
    }
    let mut all: Vec<Posterior> = found.into_iter().flatten().collect();
    all.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    all
}

fn gap_of(stacked: &Stacked<'_>, analysis: &Analysis, own: &Shrinkage, scale: f64) -> Gap {
    let count = stacked.data.segments.len() as f64;
    let mean = stacked.data.segments.iter().map(|row| row.residual[0]).sum::<f64>() / count;
    let square = own.before();
    // Interval of the mean square by flight, then its root.
    let flights = own.before.len() as f64;
    let spread: f64 = own
        .before
        .iter()
        .zip(&own.segments)
        .map(|(sum, n)| (sum - square * n).powi(2))
        .sum::<f64>()
        * flights
        / (flights - 1.0).max(1.0);
    let half = NORMAL_95 * spread.sqrt() / count;
    // The largest deviation any effect makes of noise alone, with as many looks as columns (Bonferroni).
    let plain = analysis.backgrounds.iter().find(|b| b.spike == 0.0 && b.tau == 0.0);
    let p_value = plain.map_or(1.0, |at| {
        let columns = analysis.scorer.columns();
        let largest = (0..columns)
            .filter(|&column| at.gram(column, column) > 0.0)
            .map(|column| at.product(column).powi(2) / at.gram(column, column))
            .fold(0.0, f64::max);
        (columns as f64 * erfc((largest / scale / 2.0).sqrt())).min(1.0)
    });
    Gap {
        mean_percent: 100.0 * mean,
        rms_percent: 100.0 * square.sqrt(),
        rms_ci95: [100.0 * (square - half).max(0.0).sqrt(), 100.0 * (square + half).sqrt()],
        noise_floor_rms_percent: 100.0 * own.floor().sqrt(),
        floor_by_replicates_rms_percent: None,
        floor_by_held_out_fit_rms_percent: None,
        detected: false,
        p_value,
    }
}

fn causes(
    analysis: &Analysis,
    outside: &Outside,
    distances: &Distances,
    library: &Library,
    posteriors: &[Posterior],
    unseen: Option<&Shrinkage>,
) -> Vec<Cause> {
    let inside = 1.0 - outside.probability;
    let named: f64 = posteriors.iter().map(|p| p.probability).sum();
    let best = &analysis.models[0].0;
    let mut sum = 0.0;
    let mut causes = Vec::new();
    for posterior in posteriors {
        if causes.len() >= 3 && (sum > 0.995 * named || posterior.probability < 1e-3) {
            break;
        }
        sum += posterior.probability;
        let is_best = posterior.model.model == best.model;
        let closure = unseen.filter(|_| is_best).and_then(Shrinkage::closure);
        causes.push(Cause {
            effect: name_of(library, posterior.effect),
            probability: posterior.probability * inside,
            class: class_of(distances, library, posterior),
            magnitude: magnitude(library, posterior),
            rms_after_percent: unseen.filter(|_| is_best).map(|s| 100.0 * s.after().sqrt()),
            closure: closure.map(|c| c.0),
            closure_ci95: closure.map(|c| c.1),
            hidden: hidden_words(library, posterior),
        });
    }
    causes
}

fn name_of(library: &Library, effect: Option<usize>) -> String {
    effect.map_or(EffectId::FuelHeatingValue, |e| library.effects[e].id).to_string()
}

fn magnitude(library: &Library, posterior: &Posterior) -> Magnitude {
    let Some(effect) = posterior.effect else {
        let percent = posterior.model.model.heating_percent.unwrap_or(0.0);
        return Magnitude {
            value: percent,
            unit: EffectId::FuelHeatingValue.entry().unit.to_owned(),
            ci95: [0.5 * percent, 2.0 * percent],
        };
    };
    let value = posterior.model.sizes[posterior.place];
    let half = NORMAL_95 * posterior.model.deviations[posterior.place];
    Magnitude {
        value,
        unit: library.effects[effect].id.entry().unit.to_owned(),
        ci95: [value - half, value + half],
    }
}

fn class_of(distances: &Distances, library: &Library, posterior: &Posterior) -> Vec<String> {
    let Some(_) = posterior.effect else {
        return vec![EffectId::FuelHeatingValue.to_string()];
    };
    let column = posterior.model.model.columns[posterior.place];
    let size = posterior.model.sizes[posterior.place];
    distances
        .confused_with(library, column, size)
        .into_iter()
        .map(|effect| library.effects[effect].id.to_string())
        .collect()
}

fn hidden_words(library: &Library, posterior: &Posterior) -> String {
    let Some(effect) = posterior.effect else { return String::new() };
    let column = &library.columns[posterior.model.model.columns[posterior.place]];
    match library.effects[effect].id {
        EffectId::StepChange => {
            let target = match column.hidden.step_target {
                StepTarget::FuelFlow => "fuel flow",
                StepTarget::Drag => "drag",
            };
            #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
            let from = flight::Timestamp::from_second(column.hidden.step_from_s as i64)
                .map_or_else(|_| String::new(), |instant| instant.to_string());
            format!("{target} from {from}")
        }
        EffectId::TsfcThrottle => format!(
            "over {}, pivot {:.1}",
            column.hidden.throttle_argument.words(),
            column.hidden.throttle_pivot
        ),
        EffectId::WaveDrag => format!("Mdd {}", column.hidden.drag_divergence_mach),
        _ => String::new(),
    }
}

#[expect(clippy::too_many_arguments, reason = "the verdict reads all that was found")]
fn verdict(
    analysis: &Analysis,
    outside: &Outside,
    agnostic: f64,
    distances: &Distances,
    advisor: &Advisor<'_>,
    library: &Library,
    posteriors: &[Posterior],
    own: &Shrinkage,
    unseen: Option<&Shrinkage>,
    detected: bool,
    notes: &mut Vec<String>,
) -> Verdict {
    let closure = unseen.and_then(Shrinkage::closure);
    let mut verdict = Verdict {
        kind: VerdictKind::NoGap,
        effects: vec![],
        class: vec![],
        probability: 0.0,
        closure: closure.map(|c| c.0),
        closure_ci95: closure.map(|c| c.1),
        advice: String::new(),
        separations: vec![],
    };
    let Some(top) = posteriors.first().filter(|_| detected) else {
        verdict.closure = None;
        verdict.closure_ci95 = None;
        "Nothing beyond the noise. `detectable` says how large each effect would have to be."
            .clone_into(&mut verdict.advice);
        return verdict;
    };
    let named: f64 = posteriors.iter().map(|p| p.probability).sum();
    let variable = outside.variable.map_or("no variable", |(variable, _)| variable.words());
    let closed = closed(unseen, own);
    if outside.probability > OUTSIDE_PROBABILITY || (agnostic > OUTSIDE_PROBABILITY && named < 0.5)
    {
        verdict.kind = VerdictKind::OutsideLibrary;
        verdict.probability = outside.probability.max(1.0 - named);
        verdict.advice =
            format!("A gap that no effect of the library explains; it hangs on {variable}.");
        if let Some((closed, _)) = closed {
            let _ = write!(
                verdict.advice,
                " The nearest, {}, closes {:.0} % of it.",
                name_of(library, top.effect),
                100.0 * closed.clamp(0.0, 1.0)
            );
        }
        return verdict;
    }
    verdict.kind = VerdictKind::Effects;
    verdict.probability = top.probability * (1.0 - outside.probability);
    verdict.effects = set_of(analysis, library, top);
    verdict.class = class_of(distances, library, top);
    // What the evidence leaves open belongs to the class too, however far apart sizes typical of it would be.
    for posterior in credible(posteriors) {
        let name = name_of(library, posterior.effect);
        if !verdict.class.contains(&name) {
            verdict.class.push(name);
        }
    }
    verdict.separations = separations(advisor, library, top, &verdict.class);
    let rest = (agnostic > OUTSIDE_PROBABILITY).then(|| Rest {
        variable,
        is_form: closed
            .is_none_or(|(share, _)| share >= f64::midpoint(OTHER_FORM[0], OTHER_FORM[1])),
    });
    if let Some(rest) = &rest {
        notes.push(rest.words());
    }
    verdict.advice = advice(&verdict, rest.as_ref());
    verdict
}

/// What an agnostic function sees beside a named effect.
struct Rest {
    variable: &'static str,
    /// The effect itself in another form; else something else.
    is_form: bool,
}

impl Rest {
    fn words(&self) -> String {
        if self.is_form {
            format!("the form of the effect differs in {}", self.variable)
        } else {
            format!("something else acts beside the effect; it hangs on {}", self.variable)
        }
    }
}

/// The most probable causes that hold 95 % of the probability together.
fn credible(posteriors: &[Posterior]) -> impl Iterator<Item = &Posterior> {
    let named: f64 = posteriors.iter().map(|p| p.probability).sum();
    let mut sum = 0.0;
    posteriors.iter().take_while(move |posterior| {
        let before = sum;
        sum += posterior.probability;
        before < CREDIBLE * named
    })
}

/// The effects that act together, where a pair is more probable than not; else the top effect.
fn set_of(analysis: &Analysis, library: &Library, top: &Posterior) -> Vec<String> {
    let (best, probability) = &analysis.models[0];
    let mut names = vec![name_of(library, top.effect)];
    if *probability > 0.5 {
        let members = best.model.columns.iter().map(|&c| Some(library.columns[c].effect));
        let scatter = best.model.heating_percent.map(|_| None);
        for member in members.chain(scatter) {
            let name = name_of(library, member);
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names
}

/// Who is asked for advice: about the leading effect of every probable cause, and what could be taken for it.
fn advisor<'a>(
    stacked: &Stacked<'_>,
    model: &EffectModel<'_>,
    library: &'a Library,
    distances: &'a Distances,
    classes: &[Vec<usize>],
    posteriors: &[Posterior],
    detected: bool,
) -> Advisor<'a> {
    let top = posteriors.first().filter(|top| detected && top.effect.is_some());
    let found = top.map(|top| top.model.model.columns[top.place]);
    let mut likely: Vec<usize> = Vec::new();
    if let (Some(top), Some(column)) = (top, found) {
        likely.extend(credible(posteriors).filter_map(|posterior| posterior.effect));
        likely.extend(distances.confused_with(library, column, top.model.sizes[top.place]));
    }
    let found: Vec<usize> = found.into_iter().collect();
    Advisor::of(stacked, model, library, distances, classes, &found, &likely)
}

fn separations(
    advisor: &Advisor<'_>,
    library: &Library,
    top: &Posterior,
    class: &[String],
) -> Vec<Separation> {
    if top.effect.is_none() {
        return vec![];
    }
    let column = top.model.model.columns[top.place];
    let size = top.model.sizes[top.place];
    let mut all = Vec::new();
    for (index, effect) in library.effects.iter().enumerate() {
        if Some(index) != top.effect && class.contains(&effect.id.to_string()) {
            all.extend(advisor.between(column, size, index));
        }
    }
    best_first(&mut all);
    all
}

fn advice(verdict: &Verdict, rest: Option<&Rest>) -> String {
    let mut words = if verdict.class.len() > 1 {
        format!("One of {}: these flights cannot tell them apart.", verdict.class.join(", "))
    } else {
        format!("{}.", verdict.effects.join(" and "))
    };
    match rest {
        Some(Rest { variable, is_form: true }) => {
            let _ = write!(words, " Its form differs from the library's in {variable}.");
        }
        Some(Rest { variable, is_form: false }) => {
            let _ = write!(words, " Something else acts beside it, which hangs on {variable}.");
        }
        None => {}
    }
    if let Some(best) = verdict.separations.first() {
        let _ = write!(words, " To be sure: {} ({}).", best.measurement, best.distances_told());
    }
    words
}

impl Diagnosis {
    /// The verdict's effects as they are switched on in a model, hidden parameters included; empty where the verdict names
    /// none.
    #[must_use]
    pub fn effects(&self) -> Effects {
        self.addition
            .as_ref()
            .and_then(|addition| addition.layer().ok())
            .map_or_else(Effects::none, |layer| layer.effects)
    }
}
