//! The functions of one variable that predictions of many points need, as polynomials.

use atmos::constants::{
    HIGHEST_PRESSURE_ALTITUDE_M, LOWEST_PRESSURE_ALTITUDE_M, TROPOPAUSE_PRESSURE_ALTITUDE_M,
};
use atmos::isa;
use units::{Mach, Pressure, PressureAltitude, Temperature};

use super::super::PerformanceModel;
use super::{Lanes, LevelBlock};
use crate::tsfc::tsfc;

/// The functions of one variable that a prediction needs, as polynomials.
pub(super) struct Functions {
    low_pressure_pa: Polynomial<16>,
    high_pressure_pa: Polynomial<16>,
    pub(super) low_temperature_k: Polynomial<2>,
    /// TSFC of the static temperature of the standard day at sea level over Mach number, kg/(N·s).
    pub(super) tsfc_at_sea_level: Polynomial<16>,
}

impl Functions {
    pub(super) fn of(model: &PerformanceModel) -> Self {
        let (lowest, highest) = (LOWEST_PRESSURE_ALTITUDE_M, HIGHEST_PRESSURE_ALTITUDE_M);
        let tropopause = TROPOPAUSE_PRESSURE_ALTITUDE_M;
        let pressure = |altitude_m: f64| {
            isa::pressure(PressureAltitude::meters(altitude_m))
                .map_or(f64::NAN, Pressure::to_pascals)
        };
        let temperature = |altitude_m: f64| {
            isa::temperature(PressureAltitude::meters(altitude_m))
                .map_or(f64::NAN, Temperature::to_kelvin)
        };
        let machs = model.aircraft().grid().y();
        let law = model.aircraft().tsfc_law();
        Self {
            low_pressure_pa: Polynomial::of((lowest, tropopause), pressure),
            high_pressure_pa: Polynomial::of((tropopause, highest), pressure),
            low_temperature_k: Polynomial::of((lowest, tropopause), temperature),
            tsfc_at_sea_level: Polynomial::of((machs.first(), machs.last()), |mach| {
                tsfc(law, 1.0, Mach::new(mach)).to_kilograms_per_newton_second()
            }),
        }
    }

    /// Pressures at altitudes. Most blocks are on one side of the tropopause: the other side is not computed for them.
    #[expect(clippy::inline_always, reason = "as its caller")]
    #[inline(always)]
    pub(super) fn write_pressures_pa(&self, altitudes_m: &Lanes, pressures_pa: &mut Lanes) {
        let is_low = |altitude_m: f64| altitude_m <= TROPOPAUSE_PRESSURE_ALTITUDE_M;
        let (low, high) = (&self.low_pressure_pa, &self.high_pressure_pa);
        let mut count = 0;
        for altitude_m in altitudes_m {
            count += usize::from(is_low(*altitude_m));
        }
        for place in 0..LevelBlock::POINTS {
            if count < LevelBlock::POINTS {
                pressures_pa[place] = high.at(altitudes_m[place]);
            }
        }
        for place in 0..LevelBlock::POINTS {
            if count > 0 && is_low(altitudes_m[place]) {
                pressures_pa[place] = low.at(altitudes_m[place]);
            }
        }
    }
}

/// A smooth function between two ends as the polynomial that meets it at Chebyshev's points.
///
/// # Source
/// Press et al., *Numerical Recipes*, third edition, sections 5.8 (coefficients) and 5.10 (as powers).
pub(super) struct Polynomial<const N: usize> {
    middle: f64,
    per_half_width: f64,
    /// Of the powers of the variable scaled to −1 to 1, from the lowest.
    coefficients: [f64; N],
}

impl<const N: usize> Polynomial<N> {
    pub(super) fn of((first, last): (f64, f64), function: impl Fn(f64) -> f64) -> Self {
        let (middle, half_width) = (f64::midpoint(first, last), 0.5 * (last - first));
        let angle = |k: usize| core::f64::consts::PI * (k as f64 + 0.5) / N as f64;
        let values: [f64; N] =
            core::array::from_fn(|k| function(middle + half_width * angle(k).cos()));
        // Chebyshev's polynomials as powers, one after the other: T(j+1) = 2 x T(j) − T(j−1).
        let (mut before, mut current) = ([0.0; N], [0.0; N]);
        current[0] = 1.0;
        let mut coefficients = [0.0; N];
        for j in 0..N {
            let sum: f64 = values
                .iter()
                .enumerate()
                .map(|(k, value)| value * (j as f64 * angle(k)).cos())
                .sum();
            let weight = sum * if j == 0 { 1.0 } else { 2.0 } / N as f64;
            for (coefficient, power) in coefficients.iter_mut().zip(&current) {
                *coefficient += weight * power;
            }
            let double = if j == 0 { 1.0 } else { 2.0 };
            let next: [f64; N] = core::array::from_fn(|power| {
                let raised = if power == 0 { 0.0 } else { double * current[power - 1] };
                raised - before[power]
            });
            before = current;
            current = next;
        }
        Self { middle, per_half_width: 1.0 / half_width, coefficients }
    }

    #[inline]
    pub(super) fn at(&self, x: f64) -> f64 {
        let scaled = (x - self.middle) * self.per_half_width;
        self.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * scaled + coefficient)
    }
}
