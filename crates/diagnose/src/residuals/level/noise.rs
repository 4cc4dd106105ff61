//! Noise of a segment at points of level flight: slopes of ln fuel flow along what sensors measure, by the steps by which single
//! predictions take them where these are as large as a sensor's error, by derivatives where they are small.

#![expect(clippy::needless_range_loop, reason = "loops count, as those over lanes")]

use atmos::constants::{
    ISOTHERMAL_SCALE_HEIGHT_M, LAPSE_RATE_K_M, SEA_LEVEL_TEMPERATURE_K,
    TROPOPAUSE_PRESSURE_ALTITUDE_M, TROPOSPHERE_PRESSURE_EXPONENT,
};
use perf_model::LevelBlock;
use perf_model::aircraft::SensorDeviations;
use units::Mass;

use crate::math::lanes::{LANES, Lanes, each, map};
use crate::math::vector_ln_exp::ln;
use crate::residuals::level::by_level::Planes;
use crate::residuals::level::drag::{AlongLift, Drag, Found};
use crate::residuals::level::functions::Slopes;
use crate::residuals::level::states::{MachSide, States, ln_ratio, pressure_ratio};
use crate::signals::noise::{Statistics, mach_step};

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
    /// What of the force along the path shows beyond all of it.
    pub(super) path_force: f64,
}

/// The points, and what the model makes of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct At<'b> {
    pub(super) block: &'b LevelBlock,
    pub(super) states: &'b States,
    pub(super) drag: &'b Found,
    pub(super) along_lift: &'b AlongLift,
    /// Slopes of ln of the factor by level along the pressure altitude, per m.
    pub(super) factor_along_altitude: &'b Lanes,
    /// Of the remainder.
    pub(super) slopes: &'b Slopes,
    pub(super) sides: &'b [MachSide; 2],
    /// Of the remainder, from one side to the other.
    pub(super) rise_by_mach: &'b Lanes,
}

/// Slopes of ln fuel flow along what sensors measure.
struct Along {
    mach: Lanes,
    temperature_k: Lanes,
    altitude_m: Lanes,
    ln_mass: Lanes,
    acceleration_m_s2: Lanes,
}

impl Noise {
    /// The states at Mach numbers that are off by the sensor's error, above and below; false in `is_known` where there is no drag.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    pub(super) fn mach_sides(
        &self,
        table: (&Drag, Option<&Planes>),
        (block, states): (&LevelBlock, &States),
        is_known: &mut [bool; LANES],
    ) -> [MachSide; 2] {
        let step = mach_step(&self.sensors);
        let above = mach_side(step, table, (block, states), is_known);
        [above, mach_side(-step, table, (block, states), is_known)]
    }

    /// Variance of what a segment has of its own and of what a flight has in common, less the standing effects'.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    pub(super) fn variance(&self, at: &At<'_>) -> Lanes {
        let Self {
            sensors,
            statistics: Statistics { factors, flight_bias, air_data_drift, .. },
            ..
        } = self;
        // What drifts of air data counts as what a flight has in common.
        let (fresh, drifting) = (1.0 - air_data_drift.share, air_data_drift.share);
        let along = self.along(at);
        let squared = |slope: f64, deviation: f64| slope * slope * deviation * deviation;
        let (within, between) = (factors.within[0].powi(2), factors.between[0].powi(2));
        let mut variance = [0.0; LANES];
        for place in 0..LANES {
            let (of_mach, of_temperature, of_altitude) =
                (along.mach[place], along.temperature_k[place], along.altitude_m[place]);
            let of_air_data = squared(of_mach, sensors.mach)
                + squared(of_temperature, sensors.static_air_temperature_k)
                + squared(of_altitude, sensors.pressure_altitude_m);
            let own = self.fuel_flow_variance
                + fresh * of_air_data
                + squared(along.acceleration_m_s2[place], self.acceleration_m_s2);
            let mass = sensors.mass.relative_to(Mass::kilograms(at.states.mass_kg[place]));
            let common = self.level_variance
                + drifting * of_air_data
                + squared(along.ln_mass[place], mass)
                + squared(of_mach, flight_bias.mach)
                + squared(of_temperature, flight_bias.static_air_temperature_k)
                + squared(of_altitude, flight_bias.pressure_altitude_m);
            variance[place] = own * within + common * between;
        }
        variance
    }

    /// With e and l the slopes of ln drag and of what was learnt of it along ln lift, r those of the remainder, g its mean for the
    /// force along the path, p the slope of ln pressure along the altitude, f that of the factor by level, lift and dynamic
    /// pressure being inversely proportional:
    ///
    /// ```text
    /// ln mass       e + l + r_lift + r_thrust·e + r_mass
    /// altitude      p·(1 − e − l − r_lift − r_thrust·e) + f·(1 + r_thrust) + r_altitude − r_isa·dT/dh
    /// SAT           ½/T + r_isa           density falls and airspeed rises so that lift and drag stay
    /// acceleration  m/D·(1 + r_thrust − learnt + g)  drag stays; what is learnt of it counts by its share of thrust
    /// ```
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn along(&self, at: &At<'_>) -> Along {
        let At { block, states, drag, along_lift, slopes, .. } = *at;
        let none = [0.0; LANES];
        let mut along = Along {
            mach: self.along_mach(at),
            temperature_k: none,
            altitude_m: none,
            ln_mass: none,
            acceleration_m_s2: none,
        };
        let shown = 1.0 + self.path_force;
        for place in 0..LANES {
            let (e, thrust) = (along_lift.ln_drag[place], slopes.ln_thrust[place]);
            let of_lift = e + along_lift.learnt[place] + slopes.ln_lift[place] + thrust * e;
            along.ln_mass[place] = of_lift + slopes.ln_mass[place];
            let isa = slopes.isa_deviation_k[place];
            along.temperature_k[place] = 0.5 / block.static_air_temperature_k[place] + isa;
            let (pressure, standard_k_m) = along_altitude(states.pressure_altitude_m[place]);
            let by_level = at.factor_along_altitude[place] * (1.0 + thrust);
            along.altitude_m[place] =
                pressure * (1.0 - of_lift) + by_level + slopes.pressure_altitude_m[place]
                    - isa * standard_k_m;
            let drag_n = block.dynamic_force_n[place] * drag.coefficient[place];
            along.acceleration_m_s2[place] =
                states.mass_kg[place] / drag_n * (shown + thrust - drag.learnt[place]);
        }
        along
    }

    /// By the difference over the sensor's error, within which drag may rise.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn along_mach(&self, at: &At<'_>) -> Lanes {
        let [above, below] = at.sides;
        let step = mach_step(&self.sensors);
        let mut found = ln_ratio(&above.thrust_n, &below.thrust_n);
        for place in 0..LANES {
            let one_more = 1.0 + at.states.mach[place];
            let by_law = self.mach_exponent * ln((one_more + step) / (one_more - step));
            let learnt = above.learnt[place] - below.learnt[place] + at.rise_by_mach[place];
            found[place] = (found[place] + learnt + by_law) / (2.0 * step);
        }
        found
    }
}

/// The states at Mach numbers that are off by so much.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn mach_side(
    by: f64,
    (table, planes): (&Drag, Option<&Planes>),
    (block, states): (&LevelBlock, &States),
    is_known: &mut [bool; LANES],
) -> MachSide {
    let mach = map(&states.mach, |mach| mach + by);
    let square = each(&mach, &states.mach, |there, here| (there / here) * (there / here));
    let lift_coefficient = each(&states.lift_coefficient, &square, |lift, square| lift / square);
    let found = table.at((&lift_coefficient, &mach), planes, is_known);
    let thrust_n = each(&found.coefficient, &block.dynamic_force_n, |drag, force_n| drag * force_n);
    let thrust_n = each(&thrust_n, &square, |thrust_n, square| thrust_n * square);
    let mut corrected_thrust_n = thrust_n;
    for place in 0..LANES {
        corrected_thrust_n[place] /= pressure_ratio(block, place);
    }
    MachSide { mach, lift_coefficient, corrected_thrust_n, thrust_n, learnt: found.learnt }
}

/// Slopes of ln pressure and of the standard temperature (K) along the pressure altitude, on both sides of the tropopause without a
/// branch.
///
/// ```text
/// d ln p/dh = −n·L/T below it, −1/H above it;  dT/dh = −L below it, 0 above it
/// ```
///
/// # Source
/// Book `[atmosphere.2]`.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn along_altitude(altitude_m: f64) -> (f64, f64) {
    let is_high = altitude_m > TROPOPAUSE_PRESSURE_ALTITUDE_M;
    let standard_k = SEA_LEVEL_TEMPERATURE_K - LAPSE_RATE_K_M * altitude_m;
    let low = -TROPOSPHERE_PRESSURE_EXPONENT * LAPSE_RATE_K_M / standard_k;
    if is_high { (-1.0 / ISOTHERMAL_SCALE_HEIGHT_M, 0.0) } else { (low, -LAPSE_RATE_K_M) }
}
