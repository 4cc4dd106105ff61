//! The whole model at flight points of which mass, level, Mach number and temperature are known and nothing else: many of them.
//!
//! A difficult file. It finds what [`WholeModel::of_point`](super::whole::WholeModel::of_point) finds, which asks the model some
//! twenty times at each point: for slopes along everything that sensors measure, and for the effects that a fleet always shows.
//! At such points most of that is known beforehand. An effect whose input is missing is what it was on average. A sensor's error
//! moves few of the remainder's variables, so that only their functions are asked again. Functions of one variable are tabulated
//! once for a model, their means as [curves](crate::math::curve), what is uncertain of them as [`directions`]; what is learnt of
//! the drag table is a table itself. Points are computed a block at a time, several in one instruction; only tables are asked
//! point by point.

#![expect(clippy::needless_range_loop, reason = "loops count, as those over lanes")]

mod block;
mod directions;
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
use crate::math::lanes::{LANES, Lanes, add, map};
use crate::math::vector_ln_exp::{exp, ln};
use crate::residuals::level::block::Block;
use crate::residuals::level::directions::{Directions, MOST_RISES};
use crate::residuals::level::drag::Drag;
use crate::residuals::level::functions::Functions;
use crate::residuals::level::noise::{At, Noise};
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
    directions: Directions,
    noise: Noise,
    /// Factor on standard deviations.
    stated: f64,
}

/// What is asked of the whole model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LevelQuestion {
    /// Predictions alone. Where a variance would have to be asked of a single prediction, at an end of the atmosphere or of the
    /// table, the mean comes from here: the same within 1e-9.
    Means,
    /// Variances too, which take most of the time.
    MeansAndVariances,
}

/// What the whole model makes of a prediction by its initial table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelCorrection {
    /// To be added to ln fuel flow.
    pub ln_correction: f64,
    /// e to the power of it, by which fuel flow is to be multiplied.
    pub ratio: f64,
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
    pub const TOGETHER: usize = LANES;

    /// `None` for a model with applied effects, or with a standing effect that no column of conditions leaves out.
    pub(crate) fn new(
        model: &EffectModel<'_>,
        baseline: &Baseline,
        samples: usize,
    ) -> Option<Self> {
        if model.applied().is_some() {
            return None;
        }
        let (rises, places, without_input) = standing_effects(model, baseline)?;
        let parts = &baseline.parts;
        let functions = Functions::new(baseline)?;
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
            directions: Directions::new(baseline, &functions, &places)?,
            functions,
            rises,
            standing_mean: of(&parts.standing_means),
            standing_variance: of(&parts.standing_variances),
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
    /// corrections are those of single predictions within 1e-9, the standard deviations within 1e-5 of themselves, and the same
    /// bits whichever points are asked together.
    #[must_use]
    pub fn corrections(
        &self,
        points: &[LevelPrediction],
        question: LevelQuestion,
    ) -> LevelCorrections {
        let vectors = pulp::Arch::new();
        let mut answers = [None; Self::TOGETHER];
        let of_variances = question == LevelQuestion::MeansAndVariances;
        let points = &points[..points.len().min(Self::TOGETHER)];
        for (at, points) in points.chunks(LANES).enumerate() {
            let Some(block) = Block::new(points) else { continue };
            let answers = &mut answers[at * LANES..];
            let found =
                vectors.dispatch(Compute { model: self, block: &block, points, of_variances });
            for (place, answer) in answers.iter_mut().enumerate().take(points.len()) {
                *answer = Self::answer(&found, place);
            }
        }
        if of_variances {
            // Where there is none a single prediction says why.
            for answer in &mut answers {
                *answer = answer.filter(|found| found.variance.is_finite());
            }
        }
        answers
    }

    fn answer(found: &Computed, place: usize) -> Option<LevelCorrection> {
        let ln_correction = found.correction[place];
        let is_whole = found.is_known[place] && ln_correction.is_finite();
        is_whole.then(|| LevelCorrection {
            ln_correction,
            ratio: found.ratio[place],
            variance: found.variance[place],
            beyond_flights: found.is_beyond_flights[place],
        })
    }
}

/// All that is computed of the points of a block. Compiled for the widest vectors that a
/// processor may have, which are chosen when it runs.
struct Compute<'a> {
    model: &'a WholeModelOfLevels,
    block: &'a Block,
    points: &'a [LevelPrediction],
    of_variances: bool,
}

/// What is computed.
struct Computed {
    is_known: [bool; LANES],
    is_beyond_flights: [bool; LANES],
    /// To be added to ln fuel flow, and e to the power of it.
    correction: Lanes,
    ratio: Lanes,
    /// NaN where it is not asked for.
    variance: Lanes,
}

impl pulp::WithSimd for Compute<'_> {
    type Output = Computed;

    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Computed {
        let Self { model, block, .. } = self;
        let mut is_known = [true; LANES];
        let drag = model.drag.at_points(self.points, &mut is_known);
        let states = block.states(&drag.coefficient);
        let values = model.functions.values(&states);
        let mut correction = values.sum;
        for place in 0..LANES {
            let over_bilinear = drag.coefficient[place] / block.bilinear_drag_coefficient[place];
            correction[place] += ln(over_bilinear) + drag.learnt[place] + model.standing_mean;
        }
        let mut slopes = [[0.0; LANES]; MOST_RISES];
        for k in 0..model.rises.len().min(MOST_RISES) {
            let rise = model.rises[k];
            for place in 0..LANES {
                let state = (states.mach[place], states.lift_coefficient[place]);
                slopes[k][place] = rise.slope(state, drag.coefficient[place]);
            }
            add(&mut correction, rise.size, &slopes[k]);
        }
        let at = At {
            functions: &model.functions,
            table: &model.drag,
            block,
            states: &states,
            drag: &drag,
            values: &values,
        };
        let variance = if self.of_variances {
            self.variance(simd, &at, &slopes, &mut is_known)
        } else {
            [f64::NAN; LANES]
        };
        let ratio = map(&correction, exp);
        let is_beyond_flights = values.is_beyond_flights;
        Computed { is_known, is_beyond_flights, correction, ratio, variance }
    }
}

impl Compute<'_> {
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn variance<S: pulp::Simd>(
        &self,
        simd: S,
        at: &At<'_>,
        rises: &[Lanes; MOST_RISES],
        is_known: &mut [bool; LANES],
    ) -> Lanes {
        let Self { model, points, .. } = *self;
        let mut variance = model.noise.variance(at, is_known);
        add(&mut variance, 1.0, &model.functions.left(at.values));
        let rises = &rises[..model.rises.len()];
        model.directions.add_variances(simd, (at.values, rises), points, &mut variance);
        for place in 0..points.len().min(LANES) {
            variance[place] += model.drag.left_out(&points[place].cell);
        }
        let stated = model.stated * model.stated;
        map(&variance, |variance| stated * variance + model.standing_variance)
    }
}

impl Rise {
    /// Slope of ln fuel flow along the size, by the difference by which it was learnt.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn slope(&self, (mach, lift): (f64, f64), drag: f64) -> f64 {
        let by = |moved: f64| drag_rise(mach, lift, self.divergence_mach - moved);
        let as_is = by(0.0);
        let up = drag + (by(self.step_mach) - as_is);
        let down = drag + (by(-self.step_mach) - as_is);
        ln(up / down) / (2.0 * self.step)
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
    (rises.len() <= MOST_RISES).then_some((rises, places, without_input))
}
