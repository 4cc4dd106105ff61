//! The whole model at flight points of which mass, level, Mach number and temperature are known and nothing else: many of them.
//!
//! A difficult file. It finds what [`WholeModel::of_point`](super::whole::WholeModel::of_point) finds, which asks the model some
//! twenty times at each point: for slopes along everything that sensors measure, and for the effects that a fleet always shows.
//! At such points most of that is known beforehand. An effect whose input is missing is what it was on average. A sensor's error
//! moves few of the remainder's variables, so that only their functions are asked again. What is learnt of the drag table is a
//! table itself; and the variance is one quadratic form in what is left.

mod covariance;
mod functions;

use atmos::constants::SEA_LEVEL_PRESSURE_PA;
use effects::{BetweenNodes, EffectModel, EffectPoint, Variable, drag_rise, value_continued};
use flight::effect::{EffectId, HiddenParameter};
use lut::{Cell, Outside, Table};
use perf_model::aircraft::SensorDeviations;
use perf_model::variance::{mean_acceleration_deviation_m_s2, total_fuel_flow_relative_variance};
use perf_model::{FlightPoint, LevelPrediction};
use units::{Mach, Mass, PressureAltitude};

use crate::baseline::Baseline;
use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::residuals::level::covariance::Covariance;
use crate::residuals::level::functions::{Functions, State};
use crate::signals::noise::NoiseFactors;
use crate::signals::table_uncertainty::TableUncertainty;

/// Relative step of the mass, and step of the acceleration (m/s²), of the slopes of the noise.
const MASS_STEP: f64 = 1e-3;
const ACCELERATION_STEP_M_S2: f64 = 1e-4;

/// A whole model, prepared for many such points.
#[derive(Clone, Debug)]
pub struct WholeModelOfLevels {
    drag_table: Table,
    between_nodes: BetweenNodes,
    mach_exponent: f64,
    functions: Functions,
    learnt_drag: Option<LearntDrag>,
    rises: Vec<Rise>,
    /// What effects without input were worth on average, and how different that was.
    standing_mean: f64,
    standing_variance: f64,
    covariance: Covariance,
    noise: Noise,
    /// Factor on standard deviations.
    stated: f64,
}

/// What the whole model makes of a prediction by its initial table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelCorrection {
    /// To be added to ln fuel flow.
    pub ln_correction: f64,
    /// Variance of ln fuel flow that a new segment of a new flight would show.
    pub variance: f64,
    /// As of [`WholePrediction`](super::whole::WholePrediction).
    pub beyond_flights: bool,
}

/// What was learnt of the drag table: its mean at the nodes, and what the loadings leave out.
#[derive(Clone, Debug)]
struct LearntDrag {
    uncertainty: TableUncertainty,
    mean: Table,
    left_deviation: Option<Table>,
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

/// Constants of the noise of a segment.
#[derive(Clone, Copy, Debug)]
struct Noise {
    sensors: SensorDeviations,
    factors: NoiseFactors,
    acceleration_m_s2: f64,
    fuel_flow_variance: f64,
}

/// A point as the initial model sees it.
#[derive(Clone, Copy)]
struct At<'p> {
    predicted: &'p LevelPrediction,
    /// As the model was learnt with it, and over that of the bilinear table.
    drag_coefficient: f64,
    over_bilinear: f64,
    /// Drag of a drag coefficient of 1, N.
    dynamic_force_n: f64,
    pressure_pa: f64,
    pressure_ratio: f64,
    state: State,
    values: functions::Values,
}

impl WholeModelOfLevels {
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
        let learnt_drag = match &baseline.table {
            Some(table) => Some(LearntDrag::new(table, &parts.drag)?),
            None => None,
        };
        let aircraft = model.aircraft();
        let sensors = *aircraft.sensors();
        let meter = sensors.fuel_flow_percent / 100.0;
        let of = |values: &[f64]| -> f64 {
            without_input.iter().filter_map(|place| values.get(*place)).sum()
        };
        Some(Self {
            drag_table: model.drag_table().clone(),
            between_nodes: baseline.between_nodes(),
            mach_exponent: aircraft.tsfc_law().mach_exponent,
            functions: Functions::new(baseline),
            learnt_drag,
            rises,
            standing_mean: of(&parts.standing_means),
            standing_variance: of(&parts.standing_variances),
            covariance: Covariance::new(baseline, &places),
            noise: Noise {
                sensors,
                factors: *baseline.noise(),
                acceleration_m_s2: mean_acceleration_deviation_m_s2(
                    sensors.acceleration_m_s2,
                    samples,
                ),
                fuel_flow_variance: total_fuel_flow_relative_variance(
                    meter,
                    &[],
                    aircraft.engines(),
                ),
            },
            stated: baseline.interval_factor(),
        })
    }

    /// What the whole model makes of a point; `None` where single predictions have to be asked. `predicted` is by the initial
    /// table. The correction is that of single predictions within 1e-12, the variance within 1e-8 of itself.
    #[must_use]
    pub fn correction(
        &self,
        predicted: &LevelPrediction,
        pressure_altitude_m: f64,
        scratch: &mut Vec<f64>,
    ) -> Option<LevelCorrection> {
        let at = self.at(predicted, pressure_altitude_m)?;
        let width = self.covariance.width();
        scratch.clear();
        scratch.resize(width, 0.0);
        let terms = self.functions.terms();
        let (remainder, rest) = scratch.split_at_mut(terms);
        let mut unflown = self.functions.write(&at.state, remainder);
        let (rises, drag) = rest.split_at_mut(self.rises.len());
        let mut standing = self.standing_mean;
        for (rise, slope) in self.rises.iter().zip(rises) {
            *slope = rise.slope(&at.state, at.drag_coefficient);
            standing += *slope * rise.size;
        }
        let mut learnt = 0.0;
        if let Some(table) = &self.learnt_drag {
            let cell = table.cell(predicted.lift_coefficient, predicted.mach.value())?;
            learnt = table.mean.interpolate(&cell);
            table.uncertainty.write_at(&cell, drag);
            unflown += table.left_deviation.as_ref().map_or(0.0, |left| {
                let deviation = left.interpolate(&cell);
                deviation * deviation
            });
        }
        let noise = self.noise_of(&at)?;
        let stated = self.stated * self.stated;
        let correction = LevelCorrection {
            ln_correction: at.over_bilinear.ln() + learnt + at.values.sum + standing,
            variance: stated * (unflown + self.covariance.variance(scratch) + noise)
                + self.standing_variance,
            beyond_flights: self.functions.is_beyond_flights(&at.state),
        };
        correction.variance.is_finite().then_some(correction)
    }

    fn at<'p>(&self, predicted: &'p LevelPrediction, pressure_altitude_m: f64) -> Option<At<'p>> {
        let dynamic_force_n = predicted.net_thrust.to_newtons() / predicted.drag_coefficient;
        let drag_coefficient = self.drag(predicted.lift_coefficient, predicted.mach.value())?;
        let thrust_n = dynamic_force_n * drag_coefficient;
        let pressure_pa = pressure_pa(pressure_altitude_m)?;
        let pressure_ratio = pressure_pa / SEA_LEVEL_PRESSURE_PA;
        let temperature_k = predicted.static_air_temperature.to_kelvin();
        let state = State {
            mach: predicted.mach.value(),
            lift_coefficient: predicted.lift_coefficient,
            pressure_altitude_m,
            corrected_thrust_n: thrust_n / pressure_ratio,
            isa_deviation_k: temperature_k - predicted.standard_temperature.to_kelvin(),
            mass_kg: predicted.mass.to_kilograms(),
        };
        let values = self.functions.values(&state);
        let over_bilinear = drag_coefficient / predicted.drag_coefficient;
        Some(At {
            predicted,
            drag_coefficient,
            over_bilinear,
            dynamic_force_n,
            pressure_pa,
            pressure_ratio,
            state,
            values,
        })
    }

    /// The initial table's drag coefficient as the model was learnt with it.
    fn drag(&self, lift_coefficient: f64, mach: f64) -> Option<f64> {
        value_continued((&self.drag_table, self.between_nodes), lift_coefficient, mach)
    }

    /// Variance of what a segment has of its own and of what a flight has in common, less the standing effects'.
    fn noise_of(&self, at: &At<'_>) -> Option<f64> {
        let Noise { sensors, factors, acceleration_m_s2, fuel_flow_variance } = &self.noise;
        let mach = self.slope_of_mach(at, sensors.mach.max(1e-6))?;
        let temperature = self.slope_of_temperature(at, sensors.static_air_temperature_k.max(1e-3));
        let altitude = self.slope_of_altitude(at, sensors.pressure_altitude_m.max(0.1))?;
        let acceleration = self.slope_of_acceleration(at)?;
        let mass = self.slope_of_mass(at)?;
        let squared = |slope: f64, deviation: f64| slope * slope * deviation * deviation;
        let own = fuel_flow_variance
            + squared(mach, sensors.mach)
            + squared(temperature, sensors.static_air_temperature_k)
            + squared(altitude, sensors.pressure_altitude_m)
            + squared(acceleration, *acceleration_m_s2);
        let heating_value = sensors.lower_heating_value_percent / 100.0;
        let common = squared(mass, sensors.mass.relative_to(at.predicted.mass))
            + heating_value * heating_value;
        Some(
            own * factors.within[0] * factors.within[0]
                + common * factors.between[0] * factors.between[0],
        )
    }

    fn slope_of_mach(&self, at: &At<'_>, step: f64) -> Option<f64> {
        let State { mach, lift_coefficient, .. } = at.state;
        let side = |moved: f64| {
            let pressure = (moved / mach) * (moved / mach);
            let lift = lift_coefficient / pressure;
            let drag = self.drag(lift, moved)?;
            let thrust_n = at.dynamic_force_n * pressure * drag;
            let state = State {
                mach: moved,
                lift_coefficient: lift,
                corrected_thrust_n: thrust_n / at.pressure_ratio,
                ..at.state
            };
            Some((thrust_n, self.learnt(&at.values, &state, &functions::MACH)?))
        };
        let (up, down) = (side(mach + step)?, side(mach - step)?);
        let tsfc = self.mach_exponent * ((1.0 + mach + step) / (1.0 + mach - step)).ln();
        Some(((up.0 / down.0).ln() + tsfc + up.1 - down.1) / (2.0 * step))
    }

    /// Density falls and airspeed rises with temperature so that lift and drag stay.
    fn slope_of_temperature(&self, at: &At<'_>, step: f64) -> f64 {
        let temperature_k = at.predicted.static_air_temperature.to_kelvin();
        let side = |moved: f64| {
            let isa_deviation_k = at.state.isa_deviation_k + moved;
            let state = State { isa_deviation_k, ..at.state };
            self.functions.change(&at.values, &state, &functions::TEMPERATURE)
        };
        let tsfc = 0.5 * ((temperature_k + step) / (temperature_k - step)).ln();
        (tsfc + side(step) - side(-step)) / (2.0 * step)
    }

    fn slope_of_altitude(&self, at: &At<'_>, step: f64) -> Option<f64> {
        let temperature_k = at.predicted.static_air_temperature.to_kelvin();
        let side = |pressure_altitude_m: f64| {
            let altitude = PressureAltitude::meters(pressure_altitude_m);
            let standard_k = atmos::isa::temperature(altitude).ok()?.to_kelvin();
            let pressure = pressure_pa(pressure_altitude_m)? / at.pressure_pa;
            let lift = at.state.lift_coefficient / pressure;
            let drag = self.drag(lift, at.state.mach)?;
            let thrust_n = at.dynamic_force_n * pressure * drag;
            let state = State {
                lift_coefficient: lift,
                pressure_altitude_m,
                corrected_thrust_n: thrust_n / (at.pressure_ratio * pressure),
                isa_deviation_k: temperature_k - standard_k,
                ..at.state
            };
            Some((thrust_n, self.learnt(&at.values, &state, &functions::ALTITUDE)?))
        };
        let altitude_m = at.state.pressure_altitude_m;
        let (up, down) = (side(altitude_m + step)?, side(altitude_m - step)?);
        Some(((up.0 / down.0).ln() + up.1 - down.1) / (2.0 * step))
    }

    fn slope_of_mass(&self, at: &At<'_>) -> Option<f64> {
        let side = |factor: f64| {
            let lift = at.state.lift_coefficient * factor;
            let drag = self.drag(lift, at.state.mach)?;
            let thrust_n = at.dynamic_force_n * drag;
            let state = State {
                lift_coefficient: lift,
                corrected_thrust_n: thrust_n / at.pressure_ratio,
                mass_kg: at.state.mass_kg * factor,
                ..at.state
            };
            Some((thrust_n, self.learnt(&at.values, &state, &functions::MASS)?))
        };
        let (up, down) = (side(1.0 + MASS_STEP)?, side(1.0 - MASS_STEP)?);
        Some(((up.0 / down.0).ln() + up.1 - down.1) / (2.0 * MASS_STEP))
    }

    /// Drag stays; thrust carries the inertia too, and what is learnt of drag counts by its share of thrust.
    fn slope_of_acceleration(&self, at: &At<'_>) -> Option<f64> {
        let State { mach, lift_coefficient, mass_kg, .. } = at.state;
        let drag_n = at.dynamic_force_n * at.drag_coefficient;
        let of_drag = self.learnt_drag_at(lift_coefficient, mach)?;
        let side = |acceleration_m_s2: f64| {
            let thrust_n = drag_n + mass_kg * acceleration_m_s2;
            let corrected_thrust_n = thrust_n / at.pressure_ratio;
            let state = State { corrected_thrust_n, ..at.state };
            let change = self.functions.change(&at.values, &state, &functions::ACCELERATION);
            (thrust_n, change + drag_n / thrust_n * of_drag)
        };
        let (up, down) = (side(ACCELERATION_STEP_M_S2), side(-ACCELERATION_STEP_M_S2));
        Some(((up.0 / down.0).ln() + up.1 - down.1) / (2.0 * ACCELERATION_STEP_M_S2))
    }

    /// The remainder's change, and what is learnt of drag, at a moved state of level flight.
    fn learnt(&self, values: &functions::Values, moved: &State, by: &[Variable]) -> Option<f64> {
        let drag = self.learnt_drag_at(moved.lift_coefficient, moved.mach)?;
        Some(self.functions.change(values, moved, by) + drag)
    }

    fn learnt_drag_at(&self, lift_coefficient: f64, mach: f64) -> Option<f64> {
        let Some(table) = &self.learnt_drag else { return Some(0.0) };
        Some(table.mean.interpolate(&table.cell(lift_coefficient, mach)?))
    }
}

impl LearntDrag {
    fn new(uncertainty: &TableUncertainty, means: &[f64]) -> Option<Self> {
        let grid = uncertainty.grid();
        let mean = (0..grid.nodes())
            .map(|node| uncertainty.row(node).iter().zip(means).map(|(l, mean)| l * mean).sum());
        let mean = Table::new(grid.clone(), mean.collect()).ok()?;
        let left = uncertainty.left_deviations();
        let left_deviation =
            if left.is_empty() { None } else { Some(Table::new(grid.clone(), left).ok()?) };
        Some(Self { uncertainty: uncertainty.clone(), mean, left_deviation })
    }

    fn cell(&self, lift_coefficient: f64, mach: f64) -> Option<Cell> {
        self.mean.grid().locate(lift_coefficient, mach, Outside::Hold).ok()
    }
}

impl Rise {
    /// Slope of ln fuel flow along the size, by the difference by which it was learnt.
    fn slope(&self, state: &State, drag: f64) -> f64 {
        let (mach, lift) = (state.mach, state.lift_coefficient);
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

fn pressure_pa(pressure_altitude_m: f64) -> Option<f64> {
    let altitude = PressureAltitude::meters(pressure_altitude_m);
    Some(atmos::isa::pressure(altitude).ok()?.to_pascals())
}
