//! The whole model at flight points of which mass, level, Mach number and temperature are known and nothing else: many of them.
//!
//! A difficult file. It finds what [`WholeModel::of_point`](super::whole::WholeModel::of_point) finds, which asks the model some
//! twenty times at each point: for slopes along everything that sensors measure, and for the effects that a fleet always shows.
//! At such points most of that is known beforehand. An effect whose input is missing is what it was on average. A sensor's error
//! moves few of the remainder's variables, so that only their functions are asked again. What is learnt of the drag table is a
//! table itself; and the variance is one quadratic form in what is left. Points are computed a block at a time, several in one
//! instruction; only tables are asked point by point.

mod block;
mod covariance;
mod drag;
mod functions;
mod noise;

use effects::{EffectModel, EffectPoint, drag_rise};
use flight::effect::{EffectId, HiddenParameter};
use perf_model::variance::{mean_acceleration_deviation_m_s2, total_fuel_flow_relative_variance};
use perf_model::{FlightPoint, LevelPrediction};
use units::{Mach, Mass, PressureAltitude};

use crate::baseline::Baseline;
use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::math::lanes::{LANES, Lanes};
use crate::math::vector_ln_exp::ln;
use crate::residuals::level::block::Block;
use crate::residuals::level::covariance::{Covariance, TOGETHER};
use crate::residuals::level::drag::Drag;
use crate::residuals::level::functions::Functions;
use crate::residuals::level::noise::{At, Noise, Sides};
use crate::signals::noise::Statistics;

/// A whole model, prepared for many such points.
#[derive(Clone, Debug)]
pub struct WholeModelOfLevels {
    drag: Drag,
    functions: Functions,
    rises: Vec<Rise>,
    /// What effects without input were worth on average, and how different that was.
    standing_mean: f64,
    standing_variance: f64,
    covariance: Covariance,
    noise: Noise,
    /// Factor on standard deviations.
    stated: f64,
}

/// What is asked of the whole model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LevelQuestion {
    /// Predictions alone. Where a variance would have to be asked of a single prediction, at an end of the atmosphere or of the
    /// table, the mean comes from here: the same within 1e-12.
    Means,
    /// Variances too, which take most of the time.
    MeansAndVariances,
}

/// What the whole model makes of a prediction by its initial table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelCorrection {
    /// To be added to ln fuel flow.
    pub ln_correction: f64,
    /// Variance of ln fuel flow that a new segment of a new flight would show; NaN where it was not asked for.
    pub variance: f64,
    /// As of [`WholePrediction`](super::whole::WholePrediction).
    pub beyond_flights: bool,
}

/// Answers for up to [`WholeModelOfLevels::TOGETHER`] points; `None` where single predictions have to be asked.
pub type LevelCorrections = [Option<LevelCorrection>; WholeModelOfLevels::TOGETHER];

/// A drag rise that the fleet shows at all times.
#[derive(Clone, Copy, Debug)]
struct Rise {
    divergence_mach: f64,
    /// In the effect's unit, and in that of the equation.
    step: f64,
    step_mach: f64,
    size: f64,
}

impl WholeModelOfLevels {
    /// Points that are computed together.
    pub const TOGETHER: usize = TOGETHER;

    /// `None` for a model with applied effects, or with a standing effect that no column of conditions leaves out.
    pub(crate) fn new(
        model: &EffectModel<'_>,
        baseline: &Baseline,
        samples: usize,
    ) -> Option<Self> {
        if model.applied().is_some() || !Functions::hold(baseline) {
            return None;
        }
        let (rises, places, without_input) = standing_effects(model, baseline)?;
        let parts = &baseline.parts;
        let learnt = baseline.table.as_ref().map(|table| (table, parts.drag.as_slice()));
        let aircraft = model.aircraft();
        let sensors = *aircraft.sensors();
        let meter = sensors.fuel_flow_percent / 100.0;
        let heating_value = sensors.lower_heating_value_percent / 100.0;
        let statistics = Statistics::of(baseline.noise(), &sensors);
        let drift = statistics.fuel_flow_drift.percent / 100.0;
        let of = |values: &[f64]| -> f64 {
            without_input.iter().filter_map(|place| values.get(*place)).sum()
        };
        Some(Self {
            drag: Drag::new(model.drag_table(), baseline.between_nodes(), learnt)?,
            functions: Functions::new(baseline),
            rises,
            standing_mean: of(&parts.standing_means),
            standing_variance: of(&parts.standing_variances),
            covariance: Covariance::new(baseline, &places)?,
            noise: Noise {
                sensors,
                statistics,
                acceleration_m_s2: mean_acceleration_deviation_m_s2(
                    sensors.acceleration_m_s2,
                    samples,
                ),
                fuel_flow_variance: total_fuel_flow_relative_variance(
                    meter,
                    &[],
                    aircraft.engines(),
                ),
                level_variance: heating_value * heating_value
                    + drift * drift / aircraft.engines().max(1) as f64,
                mach_exponent: aircraft.tsfc_law().mach_exponent,
            },
            stated: baseline.interval_factor(),
        })
    }

    /// What the whole model makes of points, up to [`TOGETHER`](Self::TOGETHER) of them, predicted by its initial table. The
    /// corrections are those of single predictions within 1e-12, the variances within 1e-8 of themselves, whichever points are
    /// asked together.
    #[must_use]
    pub fn corrections(
        &self,
        points: &[LevelPrediction],
        question: LevelQuestion,
    ) -> LevelCorrections {
        let vectors = pulp::Arch::new();
        let mut answers = [None; TOGETHER];
        let of_variances = question == LevelQuestion::MeansAndVariances;
        let mut loadings =
            vec![0.0; if of_variances { TOGETHER * self.covariance.width() } else { 0 }];
        let points = &points[..points.len().min(TOGETHER)];
        for (at, points) in points.chunks(LANES).enumerate() {
            let Some(block) = Block::new(points) else { continue };
            let answers = &mut answers[at * LANES..];
            let found = vectors.dispatch(Compute {
                model: self,
                block: &block,
                points,
                first: at * LANES,
                loadings: &mut loadings,
            });
            for (place, answer) in answers.iter_mut().enumerate().take(points.len()) {
                *answer = self.answer(&found, place);
            }
        }
        if of_variances {
            self.add_variance_of_model(&loadings, &mut answers);
        }
        answers
    }

    fn answer(&self, found: &Computed, place: usize) -> Option<LevelCorrection> {
        let ln_correction = found.correction[place];
        let is_whole = found.is_known[place]
            && self.functions.reach(&found.values, place)
            && ln_correction.is_finite();
        is_whole.then(|| LevelCorrection {
            ln_correction,
            variance: found.variance[place],
            beyond_flights: self.functions.is_beyond_flights(&found.values, place),
        })
    }

    /// Adds the variance of what was learnt to that of the noise.
    fn add_variance_of_model(&self, loadings: &[f64], answers: &mut LevelCorrections) {
        for (answer, of_model) in answers.iter_mut().zip(self.covariance.variances(loadings)) {
            if let Some(found) = answer {
                found.variance += self.stated * self.stated * of_model;
            }
            // A single prediction says why there is none.
            *answer = answer.filter(|found| found.variance.is_finite());
        }
    }
}

/// All that is computed of the points of a block, but for the variance of what was learnt. Compiled for the widest vectors that a
/// processor may have, which are chosen when it runs.
struct Compute<'a> {
    model: &'a WholeModelOfLevels,
    block: &'a Block,
    points: &'a [LevelPrediction],
    /// Place of the block's first point among those that are asked together.
    first: usize,
    /// Empty where no variances are asked for; column after column.
    loadings: &'a mut [f64],
}

/// What is computed.
struct Computed {
    is_known: [bool; LANES],
    values: functions::Values,
    /// To be added to ln fuel flow.
    correction: Lanes,
    /// Of noise and of what the loadings leave out; NaN where it is not asked for.
    variance: Lanes,
}

impl pulp::NullaryFnOnce for Compute<'_> {
    type Output = Computed;

    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn call(mut self) -> Computed {
        let Self { model, block, .. } = self;
        let mut is_known = [true; LANES];
        let drag = model.drag.at(&block.lift_coefficient, &block.mach, &mut is_known);
        let states = block.states(&drag.coefficient);
        let values = model.functions.values(&states);
        let mut correction = values.sum;
        for (place, correction) in correction.iter_mut().enumerate() {
            let over_bilinear = drag.coefficient[place] / block.bilinear_drag_coefficient[place];
            *correction += ln(over_bilinear) + drag.learnt[place] + model.standing_mean;
        }
        for (k, rise) in model.rises.iter().enumerate() {
            let mut slopes = [0.0; LANES];
            for (place, slope) in slopes.iter_mut().enumerate() {
                let state = (states.mach[place], states.lift_coefficient[place]);
                *slope = rise.slope(state, drag.coefficient[place]);
                correction[place] += *slope * rise.size;
            }
            self.write(model.functions.terms() + k, &slopes);
        }
        let at = At { block, states, drag, values };
        let variance = if self.loadings.is_empty() {
            [f64::NAN; LANES]
        } else {
            let sides = model.noise.sides(&model.drag, block, &at.states, &mut is_known);
            self.variance(&at, &sides)
        };
        Computed { is_known, values: at.values, correction, variance }
    }
}

impl Compute<'_> {
    /// The variance but for that of what was learnt, whose loadings are written.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn variance(&mut self, at: &At<'_>, sides: &Sides) -> Lanes {
        let Self { model, points, first, .. } = *self;
        let mut terms = [[0.0; LANES]; functions::MOST_TERMS];
        let terms = &mut terms[..model.functions.terms()];
        let left = model.functions.write(&at.values, terms);
        for (column, of_term) in terms.iter().enumerate() {
            self.write(column, of_term);
        }
        let drag = (terms.len() + model.rises.len()) * TOGETHER;
        let mut variance = model.noise.variance(&model.functions, at, sides);
        let stated = model.stated * model.stated;
        for (place, variance) in variance.iter_mut().enumerate() {
            let unflown = points.get(place).map_or(0.0, |point| {
                model.drag.write(&point.cell, first + place, &mut self.loadings[drag..])
            });
            *variance = stated * (*variance + left[place] + unflown) + model.standing_variance;
        }
        variance
    }

    /// Writes a column of the loadings, where they are asked for.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn write(&mut self, column: usize, values: &Lanes) {
        let start = column * TOGETHER + self.first;
        if let Some(into) = self.loadings.get_mut(start..start + LANES) {
            into.copy_from_slice(values);
        }
    }
}

impl Rise {
    /// Slope of ln fuel flow along the size, by the difference by which it was learnt.
    fn slope(&self, (mach, lift): (f64, f64), drag: f64) -> f64 {
        let by = |moved: f64| drag_rise(mach, lift, self.divergence_mach - moved);
        let as_is = by(0.0);
        let up = drag + (by(self.step_mach) - as_is);
        let down = drag + (by(-self.step_mach) - as_is);
        (up / down).ln() / (2.0 * self.step)
    }
}

/// The drag rises among the standing effects, their places, and the places of those without input; `None` where another one
/// acts at a point of conditions alone.
type Standing = (Vec<Rise>, Vec<usize>, Vec<usize>);

fn standing_effects(model: &EffectModel<'_>, baseline: &Baseline) -> Option<Standing> {
    let plain = FlightPoint::new(
        Mass::kilograms(baseline.references().mass_kg),
        PressureAltitude::meters(10_000.0),
        Mach::new(0.5),
    );
    let plain = EffectPoint::from_flight_point(&plain, model.aircraft().engines()).ok()?;
    let (mut rises, mut places, mut without_input) = (Vec::new(), Vec::new(), Vec::new());
    for (place, effect) in STANDING_EFFECTS.iter().enumerate() {
        if effect.lacks_input(&plain) {
            without_input.push(place);
            continue;
        }
        match (effect.id, effect.hidden) {
            // Off, as is stated for such points: it changes nothing.
            (EffectId::AntiIceBleed, _) if plain.anti_ice == Some(0.0) => {}
            (EffectId::WaveDrag, HiddenParameter::DragDivergenceMach(divergence_mach)) => {
                let step = 0.5 * baseline.references().typical_size(effect.id);
                rises.push(Rise {
                    divergence_mach,
                    step,
                    step_mach: step * effect.id.entry().unit_factor(),
                    size: baseline.standing_effects()[place],
                });
                places.push(place);
            }
            _ => return None,
        }
    }
    Some((rises, places, without_input))
}
