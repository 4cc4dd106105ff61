//! Noise of a segment at points of level flight: slopes of ln fuel flow along what sensors measure, by the steps by which single
//! predictions take them.

#![expect(clippy::needless_range_loop, reason = "loops count, as those over lanes")]

use atmos::constants::{
    HIGHEST_PRESSURE_ALTITUDE_M, ISOTHERMAL_SCALE_HEIGHT_M, LAPSE_RATE_K_M,
    LOWEST_PRESSURE_ALTITUDE_M, SEA_LEVEL_PRESSURE_PA, SEA_LEVEL_TEMPERATURE_K,
    TROPOPAUSE_PRESSURE_ALTITUDE_M, TROPOSPHERE_PRESSURE_EXPONENT,
};
use effects::Variable;
use perf_model::LevelBlock;
use perf_model::aircraft::SensorDeviations;
use units::Mass;

use crate::math::lanes::{LANES, Lanes, each, map};
use crate::math::vector_ln_exp::{exp, ln};
use crate::residuals::level::drag::{Drag, Found};
use crate::residuals::level::functions::{self, Functions, Values};
use crate::residuals::level::states::{States, ln_ratio, pressure_ratio};
use crate::signals::noise::Statistics;

/// Relative step of the mass, and step of the acceleration (m/s²), of the slopes of the noise.
const MASS_STEP: f64 = 1e-3;
const ACCELERATION_STEP_M_S2: f64 = 1e-4;

/// Constants of the noise of a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    pub(super) sensors: SensorDeviations,
    pub(super) statistics: Statistics,
    pub(super) acceleration_m_s2: f64,
    pub(super) fuel_flow_variance: f64,
    /// Of drift, heating value: what a flight has in common whatever it flies.
    pub(super) level_variance: f64,
    /// Exponent of 1 + M in the TSFC law.
    pub(super) mach_exponent: f64,
}

/// The points, and what the model makes of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct At<'b> {
    pub(super) functions: &'b Functions,
    pub(super) table: &'b Drag,
    pub(super) block: &'b LevelBlock,
    pub(super) states: &'b States,
    pub(super) drag: &'b Found,
    pub(super) values: &'b Values,
}

/// Points moved to one side by one sensor's error, and drag there.
#[derive(Clone, Debug)]
struct Side {
    states: States,
    /// Dynamic and static pressure over those of the points.
    dynamic_pressure: Lanes,
    static_pressure: Lanes,
    drag: Found,
    thrust_n: Lanes,
}

impl Noise {
    /// Of Mach number, SAT (K) and pressure altitude (m).
    fn steps(&self) -> (f64, f64, f64) {
        let sensors = &self.sensors;
        let temperature_k = sensors.static_air_temperature_k.max(1e-3);
        (sensors.mach.max(1e-6), temperature_k, sensors.pressure_altitude_m.max(0.1))
    }

    /// Variance of what a segment has of its own and of what a flight has in common, less the standing effects'; false in
    /// `is_known` where a sensor's error leads to where there is no drag.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    pub(super) fn variance(&self, at: &At<'_>, is_known: &mut [bool; LANES]) -> Lanes {
        let Self {
            sensors,
            statistics: Statistics { factors, flight_bias, air_data_drift, .. },
            ..
        } = self;
        // What drifts of air data counts as what a flight has in common.
        let (fresh, drifting) = (1.0 - air_data_drift.share, air_data_drift.share);
        let (mach_step, temperature_step_k, altitude_step_m) = self.steps();
        let mut sides = [Side::new(at), Side::new(at)];
        let [up, down] = &mut sides;
        up.along_mach(at, mach_step);
        down.along_mach(at, -mach_step);
        let mut of_mach = difference(at, [up, down], &functions::MACH, is_known);
        up.along_altitude(at, altitude_step_m);
        down.along_altitude(at, -altitude_step_m);
        let of_altitude = difference(at, [up, down], &functions::ALTITUDE, is_known);
        up.along_mass(at, MASS_STEP);
        down.along_mass(at, -MASS_STEP);
        let of_mass = difference(at, [up, down], &functions::MASS, is_known);
        for place in 0..LANES {
            is_known[place] &= at.block.static_air_temperature_k[place] > temperature_step_k;
            let above = 1.0 + at.states.mach[place];
            of_mach[place] += self.mach_exponent * ln((above + mach_step) / (above - mach_step));
        }
        let of_temperature = along_temperature(at, temperature_step_k);
        let of_acceleration = along_acceleration(at);
        let squared = |difference: f64, step: f64, deviation: f64| {
            let slope = difference / (2.0 * step);
            slope * slope * deviation * deviation
        };
        let (within, between) = (factors.within[0].powi(2), factors.between[0].powi(2));
        let mut variance = [0.0; LANES];
        for place in 0..LANES {
            let temperature_k = sensors.static_air_temperature_k;
            let of_air_data = squared(of_mach[place], mach_step, sensors.mach)
                + squared(of_temperature[place], temperature_step_k, temperature_k)
                + squared(of_altitude[place], altitude_step_m, sensors.pressure_altitude_m);
            let own = self.fuel_flow_variance
                + fresh * of_air_data
                + squared(of_acceleration[place], ACCELERATION_STEP_M_S2, self.acceleration_m_s2);
            let mass = sensors.mass.relative_to(Mass::kilograms(at.states.mass_kg[place]));
            let common = self.level_variance
                + drifting * of_air_data
                + squared(of_mass[place], MASS_STEP, mass)
                + squared(of_mach[place], mach_step, flight_bias.mach)
                + squared(
                    of_temperature[place],
                    temperature_step_k,
                    flight_bias.static_air_temperature_k,
                )
                + squared(of_altitude[place], altitude_step_m, flight_bias.pressure_altitude_m);
            variance[place] = own * within + common * between;
        }
        variance
    }
}

impl Side {
    fn new(at: &At<'_>) -> Self {
        Self {
            states: *at.states,
            dynamic_pressure: [1.0; LANES],
            static_pressure: [1.0; LANES],
            drag: at.drag.clone(),
            thrust_n: [0.0; LANES],
        }
    }

    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn along_mach(&mut self, at: &At<'_>, by: f64) {
        self.states = *at.states;
        for place in 0..LANES {
            let mach = at.states.mach[place];
            let ratio = (mach + by) / mach;
            self.states.mach[place] = mach + by;
            self.states.lift_coefficient[place] /= ratio * ratio;
            self.dynamic_pressure[place] = ratio * ratio;
            self.static_pressure[place] = 1.0;
        }
    }

    /// Outside the atmosphere's domain no number.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn along_altitude(&mut self, at: &At<'_>, by_m: f64) {
        self.states = *at.states;
        for place in 0..LANES {
            let altitude_m = at.states.pressure_altitude_m[place] + by_m;
            let standard_k = standard_temperature_k(altitude_m);
            let ratio = pressure_pa(altitude_m, standard_k) / at.block.pressure_pa[place];
            self.states.pressure_altitude_m[place] = altitude_m;
            self.states.isa_deviation_k[place] =
                at.block.static_air_temperature_k[place] - standard_k;
            self.states.lift_coefficient[place] /= ratio;
            self.dynamic_pressure[place] = ratio;
            self.static_pressure[place] = ratio;
        }
    }

    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn along_mass(&mut self, at: &At<'_>, by: f64) {
        self.states = *at.states;
        for place in 0..LANES {
            self.states.lift_coefficient[place] *= 1.0 + by;
            self.states.mass_kg[place] *= 1.0 + by;
            self.dynamic_pressure[place] = 1.0;
            self.static_pressure[place] = 1.0;
        }
    }

    /// Drag there, and the thrust that it asks for. Compiled once: it is asked six times.
    fn find(&mut self, at: &At<'_>, is_known: &mut [bool; LANES]) {
        pulp::Arch::new().dispatch(Find { side: self, at, is_known });
    }
}

struct Find<'a> {
    side: &'a mut Side,
    at: &'a At<'a>,
    is_known: &'a mut [bool; LANES],
}

impl pulp::NullaryFnOnce for Find<'_> {
    type Output = ();

    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn call(self) {
        let Self { side, at, is_known } = self;
        let (states, block) = (&mut side.states, at.block);
        at.table.at((&states.lift_coefficient, &states.mach), is_known, &mut side.drag);
        for place in 0..LANES {
            let force_n = block.dynamic_force_n[place] * side.dynamic_pressure[place];
            let thrust_n = side.drag.coefficient[place] * force_n;
            side.thrust_n[place] = thrust_n;
            states.corrected_thrust_n[place] =
                thrust_n / (pressure_ratio(block, place) * side.static_pressure[place]);
        }
    }
}

/// Pressure of the standard atmosphere, on both sides of the tropopause without a branch; no number outside its domain.
///
/// ```text
/// p = p0·(T/T0)^n·exp(−(hp − 11 000 m)/H above it)
/// ```
///
/// # Source
/// Book `[atmosphere.2]`.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn pressure_pa(altitude_m: f64, standard_temperature_k: f64) -> f64 {
    let above_m = altitude_m - TROPOPAUSE_PRESSURE_ALTITUDE_M;
    let above_m = if above_m > 0.0 { above_m } else { 0.0 };
    let of_temperature = ln(standard_temperature_k / SEA_LEVEL_TEMPERATURE_K);
    let ln_ratio =
        TROPOSPHERE_PRESSURE_EXPONENT * of_temperature - above_m / ISOTHERMAL_SCALE_HEIGHT_M;
    let inside = LOWEST_PRESSURE_ALTITUDE_M..=HIGHEST_PRESSURE_ALTITUDE_M;
    if inside.contains(&altitude_m) { SEA_LEVEL_PRESSURE_PA * exp(ln_ratio) } else { f64::NAN }
}

/// Temperature of the standard atmosphere.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn standard_temperature_k(altitude_m: f64) -> f64 {
    let is_high = altitude_m > TROPOPAUSE_PRESSURE_ALTITUDE_M;
    let low_m = if is_high { TROPOPAUSE_PRESSURE_ALTITUDE_M } else { altitude_m };
    SEA_LEVEL_TEMPERATURE_K - LAPSE_RATE_K_M * low_m
}

/// ln fuel flow on one side less that on the other, but for the TSFC law.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn difference(
    at: &At<'_>,
    [up, down]: [&mut Side; 2],
    moved: &[Variable],
    is_known: &mut [bool; LANES],
) -> Lanes {
    up.find(at, is_known);
    down.find(at, is_known);
    let mut found = ln_ratio(&up.thrust_n, &down.thrust_n);
    let above = at.functions.change(at.values, &up.states, moved);
    let below = at.functions.change(at.values, &down.states, moved);
    for place in 0..LANES {
        let learnt = up.drag.learnt[place] - down.drag.learnt[place];
        found[place] += above[place] - below[place] + learnt;
    }
    found
}

/// Density falls and airspeed rises with temperature so that lift and drag stay.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn along_temperature(at: &At<'_>, step_k: f64) -> Lanes {
    let mut states = *at.states;
    states.isa_deviation_k = map(&at.states.isa_deviation_k, |deviation_k| deviation_k + step_k);
    let above = at.functions.change(at.values, &states, &functions::TEMPERATURE);
    states.isa_deviation_k = map(&at.states.isa_deviation_k, |deviation_k| deviation_k - step_k);
    let below = at.functions.change(at.values, &states, &functions::TEMPERATURE);
    let mut found = at.block.static_air_temperature_k;
    for place in 0..LANES {
        let tsfc = 0.5 * ln((found[place] + step_k) / (found[place] - step_k));
        found[place] = tsfc + above[place] - below[place];
    }
    found
}

/// Drag stays; thrust carries the inertia too, and what is learnt of drag counts by its share of thrust.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn along_acceleration(at: &At<'_>) -> Lanes {
    let (up_n, up) = accelerated(at, ACCELERATION_STEP_M_S2);
    let (down_n, down) = accelerated(at, -ACCELERATION_STEP_M_S2);
    let mut found = ln_ratio(&up_n, &down_n);
    for place in 0..LANES {
        found[place] += up[place] - down[place];
    }
    found
}

/// Thrust, and what was learnt, at an acceleration.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn accelerated(at: &At<'_>, acceleration_m_s2: f64) -> (Lanes, Lanes) {
    let drag_n = each(&at.block.dynamic_force_n, &at.drag.coefficient, |force, drag| force * drag);
    let thrust_n = each(&drag_n, &at.states.mass_kg, |drag, mass| drag + mass * acceleration_m_s2);
    let mut states = *at.states;
    for place in 0..LANES {
        states.corrected_thrust_n[place] = thrust_n[place] / pressure_ratio(at.block, place);
    }
    let mut learnt = at.functions.change(at.values, &states, &functions::ACCELERATION);
    for place in 0..LANES {
        learnt[place] += drag_n[place] / thrust_n[place] * at.drag.learnt[place];
    }
    (thrust_n, learnt)
}
