//! The factor on the drag of the table by level, at the points of a block. Little of what a block costs: compiled once, and not for
//! every width of vectors.

#![expect(clippy::needless_range_loop, reason = "loops count, as those over lanes")]

use perf_model::{GuideLevels, LevelBlock};
use units::PressureAltitude;

use crate::math::lanes::{LANES, Lanes};

/// Planes over lift coefficient and Mach number at the levels of points.
#[derive(Clone, Debug)]
pub(super) struct Planes {
    shares: [Lanes; 3],
    /// For each of lift coefficient and Mach number what is multiplied with it and then added, so that it is from -1 to 1.
    scales: [(f64, f64); 2],
}

/// What a factor is at points, and how ln of it changes there along ln lift coefficient.
pub(super) struct FactorAlongLift {
    pub(super) factor: Lanes,
    pub(super) ln_factor: Lanes,
}

impl Planes {
    /// Those at the levels of a block's points, moved by so much.
    pub(super) fn at(levels: &GuideLevels, block: &LevelBlock, by_m: f64) -> Self {
        let mut shares = [[0.0; LANES]; 3];
        for place in 0..LANES {
            let level = PressureAltitude::meters(block.pressure_altitude_m[place] + by_m);
            let plane = levels.shares(level);
            for term in 0..3 {
                shares[term][place] = plane[term];
            }
        }
        let scales = levels.ranges().map(|(low, high)| {
            let scale = 2.0 / (high - low);
            (scale, -scale * low - 1.0)
        });
        Self { shares, scales }
    }

    /// The factor at lift coefficients and Mach numbers.
    #[inline(never)]
    pub(super) fn factor(&self, (lift_coefficient, mach): (&Lanes, &Lanes)) -> Lanes {
        let [middle, by_lift, by_mach] = &self.shares;
        let mut factor = [0.0; LANES];
        for place in 0..LANES {
            let lift = self.term(0, lift_coefficient[place]);
            let mach = self.term(1, mach[place]);
            factor[place] = 1.0 + middle[place] + by_lift[place] * lift + by_mach[place] * mach;
        }
        factor
    }

    /// The factor, and the slope of ln of it.
    #[inline(never)]
    pub(super) fn along_lift(&self, lift_and_mach: (&Lanes, &Lanes)) -> FactorAlongLift {
        let factor = self.factor(lift_and_mach);
        let (scale, offset) = self.scales[0];
        let mut ln_factor = [0.0; LANES];
        for place in 0..LANES {
            let lift = lift_and_mach.0[place];
            let is_held = (scale * lift + offset).abs() >= 1.0;
            let slope = self.shares[1][place] * scale * lift / factor[place];
            ln_factor[place] = if is_held { 0.0 } else { slope };
        }
        FactorAlongLift { factor, ln_factor }
    }

    fn term(&self, axis: usize, value: f64) -> f64 {
        let (scale, offset) = self.scales[axis];
        (scale * value + offset).clamp(-1.0, 1.0)
    }
}
