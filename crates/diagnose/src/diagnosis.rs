//! From flights to a verdict.

use effects::ExtendedModel;
use effects::{EffectModel, EffectModelError, EffectPoint, EffectReferences, Effects};
use flight::effect::EffectId;

use crate::TableUncertainty;
use crate::addition::Addition;
use crate::analysis::{Analysis, Stacked, analyse};
use crate::baseline::Baseline;
use crate::classes::{Distances, leading_columns};
use crate::closure::{Shrinkage, held_out_floor, in_sample, nested, replicate_floor};
use crate::data::{Against, Data};
use crate::design::{Acts, Design};
use crate::library::Library;
use crate::output::{
    Detectable, Diagnosis, Gap, NotTestable, OutsideLibrary, Verdict, VerdictKind,
};
use crate::outside::compete;
use crate::record::FlightRecord;
use crate::slices;

mod gap;
mod posterior;
mod verdict;

use gap::{exceeds_uncertainty, gap_of, is_real, is_vague, noise_scale, unknown_square};
use posterior::{causes, dominant};
use verdict::{advisor, beside, closed, credit, verdict};

/// Fewest flights and segments that a name is given on.
const FEWEST_FLIGHTS: usize = 6;
const FEWEST_SEGMENTS: usize = 30;
/// A gap counts as real when nothing at all is less probable than this.
pub(crate) const CLEAN_PROBABILITY: f64 = 0.05;
/// Probability of a cause outside the library above which it is said.
const OUTSIDE_PROBABILITY: f64 = 0.5;
/// Half width of a 95 % interval in standard deviations.
const NORMAL_95: f64 = 1.96;

/// What is diagnosed, and against what.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// The performance model.
    pub model: &'a ExtendedModel,
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
    pub const fn against(model: &'a ExtendedModel, flights: &'a [FlightRecord<'a>]) -> Self {
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
    model: &ExtendedModel,
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
            let start_s = segment.identity.start_s();
            Some(EffectPoint::from_means(&means, start_s, engines))
        })
        .collect();
    Ok(effects::mean_references(model.aircraft(), drag_table, &points)?)
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
    let against = Against::taught_or_table(input.baseline);
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

const fn acts_words(acts: Acts) -> &'static str {
    match acts {
        Acts::FuelFlow => "fuel flow",
        Acts::Thrust => "thrust",
        Acts::Split => "one engine",
    }
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
