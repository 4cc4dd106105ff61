//! Points side by side: what is known of a block of them, one array for each quantity.

use atmos::constants::SEA_LEVEL_PRESSURE_PA;
use perf_model::LevelPrediction;

use crate::math::lanes::{LANES, Lanes, each};
use crate::math::vector_ln_exp::ln;
use crate::residuals::level::functions::States;

/// Points as the initial model sees them. Places beyond the last point repeat the first one.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) mach: Lanes,
    pub(super) lift_coefficient: Lanes,
    pub(super) pressure_altitude_m: Lanes,
    pub(super) pressure_pa: Lanes,
    pub(super) temperature_k: Lanes,
    pub(super) isa_deviation_k: Lanes,
    pub(super) mass_kg: Lanes,
    /// Drag of a drag coefficient of 1, N.
    pub(super) dynamic_force_n: Lanes,
    /// Of the bilinear table.
    pub(super) bilinear_drag_coefficient: Lanes,
}

impl Block {
    /// Of one point or more; those beyond [`LANES`] are left out.
    pub(super) fn new(points: &[LevelPrediction]) -> Option<Self> {
        let first = points.first()?;
        let of = |of: fn(&LevelPrediction) -> f64| {
            let mut lanes: Lanes = [of(first); LANES];
            for (lane, point) in lanes.iter_mut().zip(points) {
                *lane = of(point);
            }
            lanes
        };
        Some(Self {
            mach: of(|point| point.mach.value()),
            lift_coefficient: of(|point| point.lift_coefficient),
            pressure_altitude_m: of(|point| point.pressure_altitude.to_meters()),
            pressure_pa: of(|point| point.pressure.to_pascals()),
            temperature_k: of(|point| point.static_air_temperature.to_kelvin()),
            isa_deviation_k: of(|point| {
                point.static_air_temperature.to_kelvin() - point.standard_temperature.to_kelvin()
            }),
            mass_kg: of(|point| point.mass.to_kilograms()),
            dynamic_force_n: of(|point| point.net_thrust.to_newtons() / point.drag_coefficient),
            bilinear_drag_coefficient: of(|point| point.drag_coefficient),
        })
    }

    /// The points' states at a drag coefficient.
    pub(super) fn states(&self, drag_coefficient: &Lanes) -> States {
        let mut corrected_thrust_n = self.dynamic_force_n;
        for (place, thrust_n) in corrected_thrust_n.iter_mut().enumerate() {
            *thrust_n *= drag_coefficient[place] / self.pressure_ratio(place);
        }
        States {
            mach: self.mach,
            lift_coefficient: self.lift_coefficient,
            pressure_altitude_m: self.pressure_altitude_m,
            corrected_thrust_n,
            isa_deviation_k: self.isa_deviation_k,
            mass_kg: self.mass_kg,
        }
    }

    /// δ of a point.
    #[inline]
    pub(super) fn pressure_ratio(&self, place: usize) -> f64 {
        self.pressure_pa[place] / SEA_LEVEL_PRESSURE_PA
    }
}

/// ln of a ratio of positive numbers.
#[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
#[inline(always)]
pub(super) fn ln_ratio(a: &Lanes, b: &Lanes) -> Lanes {
    each(a, b, |a, b| ln(a / b))
}
