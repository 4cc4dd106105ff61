//! Noise of a segment at points of level flight: slopes of ln fuel flow along what sensors measure, by the steps by which single
//! predictions take them.

use effects::Variable;
use perf_model::aircraft::SensorDeviations;
use units::{Mass, PressureAltitude};

use crate::math::lanes::{LANES, Lanes, each, map};
use crate::math::vector_ln_exp::ln;
use crate::residuals::level::block::{Block, ln_ratio};
use crate::residuals::level::drag::{Drag, Found};
use crate::residuals::level::functions::{self, Functions, States, Values};
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
#[derive(Clone, Debug)]
pub(super) struct At<'b> {
    pub(super) block: &'b Block,
    pub(super) states: States,
    pub(super) drag: Found,
    pub(super) values: Values,
}

/// Both sides of the points for each sensor whose error changes drag.
#[derive(Clone, Debug)]
pub(super) struct Sides {
    mach: [Side; 2],
    altitude: [Side; 2],
    mass: [Side; 2],
}

/// Points moved to one side by one sensor's error, and drag there.
#[derive(Clone, Debug)]
struct Side {
    states: States,
    drag: Found,
    thrust_n: Lanes,
}

/// Points that are moved, but for their thrust; dynamic and static pressure over those of the points.
struct Moved {
    states: States,
    dynamic_pressure: Lanes,
    static_pressure: Lanes,
}

impl Noise {
    /// Of Mach number, SAT (K) and pressure altitude (m).
    fn steps(&self) -> (f64, f64, f64) {
        let sensors = &self.sensors;
        let temperature_k = sensors.static_air_temperature_k.max(1e-3);
        (sensors.mach.max(1e-6), temperature_k, sensors.pressure_altitude_m.max(0.1))
    }

    /// The points moved, and drag there; false in `is_known` where there is none.
    pub(super) fn sides(
        &self,
        drag: &Drag,
        block: &Block,
        states: &States,
        is_known: &mut [bool; LANES],
    ) -> Sides {
        let (mach_step, temperature_step_k, altitude_step_m) = self.steps();
        for (is_known, temperature_k) in is_known.iter_mut().zip(&block.temperature_k) {
            *is_known &= *temperature_k > temperature_step_k;
        }
        let mut find = |moved: &Moved| moved.find(drag, block, is_known);
        let along_mach = |by: f64| Moved::along_mach(states, by);
        let along_altitude = |by_m: f64| Moved::along_altitude(block, states, by_m);
        let along_mass = |by: f64| Moved::along_mass(states, by);
        Sides {
            mach: [find(&along_mach(mach_step)), find(&along_mach(-mach_step))],
            altitude: [
                find(&along_altitude(altitude_step_m)),
                find(&along_altitude(-altitude_step_m)),
            ],
            mass: [find(&along_mass(MASS_STEP)), find(&along_mass(-MASS_STEP))],
        }
    }

    /// Variance of what a segment has of its own and of what a flight has in common, less the standing effects'.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    pub(super) fn variance(&self, functions: &Functions, at: &At<'_>, sides: &Sides) -> Lanes {
        let Self { sensors, statistics: Statistics { factors, flight_bias, .. }, .. } = self;
        let (mach_step, temperature_step_k, altitude_step_m) = self.steps();
        let mut of_mach = difference(functions, at, &sides.mach, &functions::MACH);
        for (slope, mach) in of_mach.iter_mut().zip(&at.states.mach) {
            let ratio = (1.0 + mach + mach_step) / (1.0 + mach - mach_step);
            *slope += self.mach_exponent * ln(ratio);
        }
        let of_temperature = along_temperature(functions, at, temperature_step_k);
        let of_altitude = difference(functions, at, &sides.altitude, &functions::ALTITUDE);
        let of_mass = difference(functions, at, &sides.mass, &functions::MASS);
        let of_acceleration = along_acceleration(functions, at);
        let squared = |difference: f64, step: f64, deviation: f64| {
            let slope = difference / (2.0 * step);
            slope * slope * deviation * deviation
        };
        let (within, between) = (factors.within[0].powi(2), factors.between[0].powi(2));
        let mut variance = [0.0; LANES];
        for (place, variance) in variance.iter_mut().enumerate() {
            let temperature_k = sensors.static_air_temperature_k;
            let own = self.fuel_flow_variance
                + squared(of_mach[place], mach_step, sensors.mach)
                + squared(of_temperature[place], temperature_step_k, temperature_k)
                + squared(of_altitude[place], altitude_step_m, sensors.pressure_altitude_m)
                + squared(of_acceleration[place], ACCELERATION_STEP_M_S2, self.acceleration_m_s2);
            let mass = sensors.mass.relative_to(Mass::kilograms(at.states.mass_kg[place]));
            let common = self.level_variance
                + squared(of_mass[place], MASS_STEP, mass)
                + squared(of_mach[place], mach_step, flight_bias.mach)
                + squared(
                    of_temperature[place],
                    temperature_step_k,
                    flight_bias.static_air_temperature_k,
                )
                + squared(of_altitude[place], altitude_step_m, flight_bias.pressure_altitude_m);
            *variance = own * within + common * between;
        }
        variance
    }
}

impl Moved {
    fn along_mach(states: &States, by: f64) -> Self {
        let mach = map(&states.mach, |mach| mach + by);
        let pressure = each(&mach, &states.mach, |moved, mach| (moved / mach) * (moved / mach));
        let lift_coefficient = each(&states.lift_coefficient, &pressure, |lift, p| lift / p);
        Self {
            states: States { mach, lift_coefficient, ..*states },
            dynamic_pressure: pressure,
            static_pressure: [1.0; LANES],
        }
    }

    /// Outside the atmosphere's domain no number.
    fn along_altitude(block: &Block, states: &States, by_m: f64) -> Self {
        let altitude_m = map(&states.pressure_altitude_m, |altitude_m| altitude_m + by_m);
        let pressure = each(&altitude_m, &block.pressure_pa, |altitude_m, before_pa| {
            let pressure = atmos::isa::pressure(PressureAltitude::meters(altitude_m));
            pressure.map_or(f64::NAN, |pressure| pressure.to_pascals() / before_pa)
        });
        let isa_deviation_k = each(&altitude_m, &block.temperature_k, |altitude_m, sat_k| {
            let standard = atmos::isa::temperature(PressureAltitude::meters(altitude_m));
            standard.map_or(f64::NAN, |standard| sat_k - standard.to_kelvin())
        });
        let lift_coefficient = each(&states.lift_coefficient, &pressure, |lift, p| lift / p);
        Self {
            states: States {
                lift_coefficient,
                pressure_altitude_m: altitude_m,
                isa_deviation_k,
                ..*states
            },
            dynamic_pressure: pressure,
            static_pressure: pressure,
        }
    }

    fn along_mass(states: &States, by: f64) -> Self {
        Self {
            states: States {
                lift_coefficient: map(&states.lift_coefficient, |lift| lift * (1.0 + by)),
                mass_kg: map(&states.mass_kg, |mass_kg| mass_kg * (1.0 + by)),
                ..*states
            },
            dynamic_pressure: [1.0; LANES],
            static_pressure: [1.0; LANES],
        }
    }

    /// With drag, and with the thrust that it asks for.
    fn find(&self, drag: &Drag, block: &Block, is_known: &mut [bool; LANES]) -> Side {
        let mut states = self.states;
        let found = drag.at(&states.lift_coefficient, &states.mach, is_known);
        let mut thrust_n = found.coefficient;
        for (place, thrust_n) in thrust_n.iter_mut().enumerate() {
            *thrust_n *= block.dynamic_force_n[place] * self.dynamic_pressure[place];
            states.corrected_thrust_n[place] =
                *thrust_n / (block.pressure_ratio(place) * self.static_pressure[place]);
        }
        Side { states, drag: found, thrust_n }
    }
}

/// ln fuel flow on one side less that on the other, but for the TSFC law.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn difference(
    functions: &Functions,
    at: &At<'_>,
    [up, down]: &[Side; 2],
    moved: &[Variable],
) -> Lanes {
    let mut found = ln_ratio(&up.thrust_n, &down.thrust_n);
    let above = functions.change(&at.values, &up.states, moved);
    let below = functions.change(&at.values, &down.states, moved);
    for (place, found) in found.iter_mut().enumerate() {
        let learnt = up.drag.learnt[place] - down.drag.learnt[place];
        *found += above[place] - below[place] + learnt;
    }
    found
}

/// Density falls and airspeed rises with temperature so that lift and drag stay.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn along_temperature(functions: &Functions, at: &At<'_>, step_k: f64) -> Lanes {
    let mut states = at.states;
    states.isa_deviation_k = map(&at.states.isa_deviation_k, |deviation_k| deviation_k + step_k);
    let above = functions.change(&at.values, &states, &functions::TEMPERATURE);
    states.isa_deviation_k = map(&at.states.isa_deviation_k, |deviation_k| deviation_k - step_k);
    let below = functions.change(&at.values, &states, &functions::TEMPERATURE);
    let mut found = at.block.temperature_k;
    for (place, found) in found.iter_mut().enumerate() {
        let tsfc = 0.5 * ln((*found + step_k) / (*found - step_k));
        *found = tsfc + above[place] - below[place];
    }
    found
}

/// Drag stays; thrust carries the inertia too, and what is learnt of drag counts by its share of thrust.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn along_acceleration(functions: &Functions, at: &At<'_>) -> Lanes {
    let (up_n, up) = accelerated(functions, at, ACCELERATION_STEP_M_S2);
    let (down_n, down) = accelerated(functions, at, -ACCELERATION_STEP_M_S2);
    let mut found = ln_ratio(&up_n, &down_n);
    for (place, found) in found.iter_mut().enumerate() {
        *found += up[place] - down[place];
    }
    found
}

/// Thrust, and what was learnt, at an acceleration.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn accelerated(functions: &Functions, at: &At<'_>, acceleration_m_s2: f64) -> (Lanes, Lanes) {
    let drag_n = each(&at.block.dynamic_force_n, &at.drag.coefficient, |force, drag| force * drag);
    let thrust_n = each(&drag_n, &at.states.mass_kg, |drag, mass| drag + mass * acceleration_m_s2);
    let mut states = at.states;
    for (place, corrected_n) in states.corrected_thrust_n.iter_mut().enumerate() {
        *corrected_n = thrust_n[place] / at.block.pressure_ratio(place);
    }
    let mut learnt = functions.change(&at.values, &states, &functions::ACCELERATION);
    for (place, learnt) in learnt.iter_mut().enumerate() {
        *learnt += drag_n[place] / thrust_n[place] * at.drag.learnt[place];
    }
    (thrust_n, learnt)
}
