//! The states of a block of points, as the remainder's variables have them.

use atmos::constants::SEA_LEVEL_PRESSURE_PA;
use perf_model::LevelBlock;

use crate::math::lanes::{LANES, Lanes, each};
use crate::math::vector_ln_exp::ln;

/// What the remainder depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct States {
    pub(super) mach: Lanes,
    pub(super) lift_coefficient: Lanes,
    pub(super) pressure_altitude_m: Lanes,
    pub(super) corrected_thrust_n: Lanes,
    pub(super) isa_deviation_k: Lanes,
    pub(super) mass_kg: Lanes,
}

impl States {
    /// Of the points at a drag coefficient.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    pub(super) fn of(block: &LevelBlock, drag_coefficient: &Lanes) -> Self {
        let mut corrected_thrust_n = block.dynamic_force_n;
        for place in 0..LANES {
            corrected_thrust_n[place] *= drag_coefficient[place] / pressure_ratio(block, place);
        }
        Self {
            mach: block.mach,
            lift_coefficient: block.lift_coefficient,
            pressure_altitude_m: block.pressure_altitude_m,
            corrected_thrust_n,
            isa_deviation_k: block.isa_deviation_k,
            mass_kg: block.mass_kg,
        }
    }
}

/// The states on one side of an error of their Mach numbers: what of them is another.
#[derive(Clone, Debug)]
pub(super) struct MachSide {
    pub(super) mach: Lanes,
    pub(super) lift_coefficient: Lanes,
    pub(super) corrected_thrust_n: Lanes,
    pub(super) thrust_n: Lanes,
    /// What was learnt of ln drag.
    pub(super) learnt: Lanes,
}

/// δ of a point.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
pub(super) fn pressure_ratio(block: &LevelBlock, place: usize) -> f64 {
    block.pressure_pa[place] * (1.0 / SEA_LEVEL_PRESSURE_PA)
}

/// ln of a ratio of positive numbers.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
pub(super) fn ln_ratio(a: &Lanes, b: &Lanes) -> Lanes {
    each(a, b, |a, b| ln(a / b))
}
