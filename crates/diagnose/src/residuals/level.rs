//! The whole model at flight points of which mass, level, Mach number and temperature are known and nothing else: many of them.
//!
//! A difficult file. It finds what [`WholeModel::of_point`](super::whole::WholeModel::of_point) finds, which asks the model some
//! twenty times at each point: for slopes along everything that sensors measure, and for the effects that a fleet always shows.
//! At such points most of that is known beforehand. An effect whose input is missing is what it was on average. Slopes along what
//! sensors measure are derivatives of what was asked for the prediction, but for the Mach number's, within whose error drag may rise.
//! Functions of one variable are tabulated once for a model, their means as [curves](crate::math::curve), what is uncertain of them as
//! [`directions`]; what is learnt of the drag table is a table itself. Points are computed a block at a time, several in one
//! instruction; only tables are asked point by point.

#![expect(clippy::needless_range_loop, reason = "loops count, as those over lanes")]

mod by_level;
mod directions;
mod drag;
mod functions;
mod noise;
mod states;

use effects::{EffectModel, EffectPoint, drag_rise};
use flight::effect::{DragRise, DragRiseLaw, EffectId, HiddenParameter};
use perf_model::variance::{mean_acceleration_deviation_m_s2, total_fuel_flow_relative_variance};
use perf_model::{FlightPoint, LevelBlock};
use units::{Mach, Mass, PressureAltitude};

use crate::baseline::Baseline;
use crate::baseline::smooth::BEYOND_BY_ROUNDING;
use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::math::lanes::{LANES, Lanes, add, each, map};
use crate::math::vector_ln_exp::{NEAR, exp, ln, ln_of_near};
use crate::residuals::level::directions::{Directions, MOST_RISES};
use crate::residuals::level::drag::Drag;
use crate::residuals::level::functions::{Functions, Values};
use crate::residuals::level::noise::{At, Noise};
use crate::residuals::level::states::States;
use crate::signals::noise::{ALTITUDE_STEP_M, Statistics};

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

/// What the whole model predicts at the points of a block.
#[derive(Clone, Debug)]
pub struct LevelAnswers {
    /// False where single predictions have to be asked.
    pub is_known: [bool; LANES],
    /// Fuel flow of all engines.
    pub fuel_flow_total_kg_s: Lanes,
    /// Variance of ln fuel flow that a new segment of a new flight would show; NaN where it was not asked for.
    pub variance: Lanes,
    /// As of [`WholePrediction`](super::whole::WholePrediction).
    pub beyond_flights: [bool; LANES],
}

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
            drag: Drag::new(
                (model.drag_table(), model.levels()),
                baseline.between_nodes(),
                learnt,
            )?,
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
                path_force: baseline.path_force(),
            },
            stated: baseline.interval_factor(),
        })
    }

    /// Predictions at the points of a block of the initial model: ln fuel flow as single predictions have it within 1e-9, standard
    /// deviations within 1e-5 of themselves, and the same bits whichever points are asked together.
    #[must_use]
    pub fn answers(&self, block: &LevelBlock, question: LevelQuestion) -> LevelAnswers {
        let of_variances = question == LevelQuestion::MeansAndVariances;
        let compute = Compute { model: self, block, of_variances };
        let mut answers = pulp::Arch::new().dispatch(compute);
        if of_variances {
            // Where there is none a single prediction says why.
            for place in 0..LANES {
                answers.is_known[place] &= answers.variance[place].is_finite();
            }
        }
        answers
    }
}

/// All that is computed of the points of a block. Compiled for the widest vectors that a
/// processor may have, which are chosen when it runs.
struct Compute<'a> {
    model: &'a WholeModelOfLevels,
    block: &'a LevelBlock,
    of_variances: bool,
}

impl pulp::NullaryFnOnce for Compute<'_> {
    type Output = LevelAnswers;

    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn call(self) -> LevelAnswers {
        let Self { model, block, .. } = self;
        let mut is_known = block.is_known;
        let planes = model.drag.planes(block, 0.0);
        let planes = planes.as_ref();
        let (drag, along_lift) = if self.of_variances {
            let (drag, along_lift) = model.drag.of_block_along_lift(block, planes, &mut is_known);
            (drag, Some(along_lift))
        } else {
            (model.drag.of_block(block, planes, &mut is_known), None)
        };
        let states = States::of(block, &drag.coefficient);
        let slopes = model.slopes_of_rises(&states, &drag.coefficient);
        let (remainder, beyond, variance) = if let Some(along_lift) = &along_lift {
            let table = (&model.drag, planes);
            let sides = model.noise.mach_sides(table, (block, &states), &mut is_known);
            let values = model.functions.values(&states, &sides);
            let at = At {
                block,
                states: &states,
                drag: &drag,
                along_lift,
                factor_along_altitude: &model.factor_along_altitude(block),
                slopes: &model.functions.slopes(&values, &states),
                sides: &sides,
                rise_by_mach: &values.rise_by_mach,
            };
            let variance = self.variance(&at, &values, &slopes);
            (values.sum, values.beyond, variance)
        } else {
            let (remainder, beyond) = model.functions.sum(&states);
            (remainder, beyond, [f64::NAN; LANES])
        };
        let mut correction = [0.0; LANES];
        for place in 0..LANES {
            correction[place] = remainder[place] + drag.learnt[place] + model.standing_mean;
        }
        for k in 0..model.rises.len().min(MOST_RISES) {
            add(&mut correction, model.rises[k].size, &slopes[k]);
        }
        let mut fuel_flow_total_kg_s = [0.0; LANES];
        let mut beyond_flights = [false; LANES];
        for place in 0..LANES {
            let by_drag_kg_s =
                drag.coefficient[place] * block.fuel_flow_per_drag_coefficient_kg_s[place];
            fuel_flow_total_kg_s[place] = by_drag_kg_s * exp(correction[place]);
        }
        for place in 0..LANES {
            is_known[place] &= correction[place].abs() <= f64::MAX;
            beyond_flights[place] = beyond[place] > BEYOND_BY_ROUNDING;
        }
        LevelAnswers { is_known, fuel_flow_total_kg_s, variance, beyond_flights }
    }
}

impl Compute<'_> {
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn variance(&self, at: &At<'_>, values: &Values, rises: &[Lanes; MOST_RISES]) -> Lanes {
        let Self { model, block, .. } = *self;
        let mut variance = model.noise.variance(at);
        add(&mut variance, 1.0, &model.functions.left(values));
        let rises = &rises[..model.rises.len()];
        model.directions.add_variances((values, rises), block, &mut variance);
        let left_out = model.drag.left_out(&block.cells);
        add(&mut variance, 1.0, &left_out);
        let stated = model.stated * model.stated;
        map(&variance, |variance| stated * variance + model.standing_variance)
    }
}

impl WholeModelOfLevels {
    /// Slopes of ln of the factor by level along the pressure altitude, by the step by which single predictions take them: levels
    /// are where it bends.
    fn factor_along_altitude(&self, block: &LevelBlock) -> Lanes {
        let at = (&block.lift_coefficient, &block.mach);
        let side = |by_m| self.drag.planes(block, by_m).map(|planes| planes.factor(at));
        let (Some(above), Some(below)) = (side(ALTITUDE_STEP_M), side(-ALTITUDE_STEP_M)) else {
            return [0.0; LANES];
        };
        each(&above, &below, |above, below| ln(above / below) / (2.0 * ALTITUDE_STEP_M))
    }

    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn slopes_of_rises(&self, states: &States, drag: &Lanes) -> [Lanes; MOST_RISES] {
        let mut slopes = [[0.0; LANES]; MOST_RISES];
        for k in 0..self.rises.len().min(MOST_RISES) {
            slopes[k] = self.rises[k].slopes(states, drag);
        }
        slopes
    }
}

impl Rise {
    /// Slopes of ln fuel flow along the size, by the difference by which it was learnt.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn slopes(&self, states: &States, drag: &Lanes) -> Lanes {
        let per_step = 1.0 / (2.0 * self.step);
        let (mut slopes, mut sides) = ([0.0; LANES], [0.0; LANES]);
        let mut are_far = 0;
        for place in 0..LANES {
            let (up, down) = self.drag_on_both_sides(states, drag, place);
            sides[place] = (up - down) / (up + down);
        }
        for place in 0..LANES {
            slopes[place] = ln_of_near(sides[place]) * per_step;
            are_far |= u64::from(sides[place].abs() > NEAR);
        }
        if are_far != 0 {
            // Far beyond where drag rises: each such place by the logarithm.
            for place in 0..LANES {
                let (up, down) = self.drag_on_both_sides(states, drag, place);
                let by_logarithm = ln(up / down) * per_step;
                let is_far = sides[place].abs() > NEAR;
                slopes[place] = if is_far { by_logarithm } else { slopes[place] };
            }
        }
        slopes
    }

    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn drag_on_both_sides(&self, states: &States, drag: &Lanes, place: usize) -> (f64, f64) {
        let (mach, lift) = (states.mach[place], states.lift_coefficient[place]);
        let by = |moved: f64| drag_rise(mach, lift, self.divergence_mach - moved);
        let as_is = by(0.0);
        let drag = drag[place];
        (drag + (by(self.step_mach) - as_is), drag + (by(-self.step_mach) - as_is))
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
            (
                EffectId::WaveDrag,
                HiddenParameter::DragRise(DragRise { divergence_mach, law: DragRiseLaw::Lock }),
            ) => {
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

#[cfg(test)]
mod tests;
