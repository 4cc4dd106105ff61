//! Thrust-specific fuel consumption.

use units::{Mach, Tsfc};

/// The constants of the TSFC law, the same for all engines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TsfcLaw {
    /// At rest, at sea level of the standard day.
    pub static_tsfc: Tsfc,
    /// Exponent of 1 + M.
    pub mach_exponent: f64,
}

/// TSFC at a temperature ratio and Mach number.
///
/// ```text
/// TSFC = TSFC0·√θ·(1 + M)^n                                          [forces.5]
/// ```
///
/// with θ = SAT/T0 of the static air temperature. The law has no throttle: it is for cruise thrust. NaN for θ < 0.
///
/// # Source
/// Ghazi et al. 2020, equation (5). The radical, θ, M and n are legible; their arrangement is constrained by
/// equations (22) and (23).
#[must_use]
pub fn tsfc(law: TsfcLaw, temperature_ratio: f64, mach: Mach) -> Tsfc {
    Tsfc::kilograms_per_newton_second(
        law.static_tsfc.to_kilograms_per_newton_second()
            * temperature_ratio.sqrt()
            * (1.0 + mach.value()).powf(law.mach_exponent),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cruise_tsfc_of_an_ae3007_for_five_exponents() {
        // Worked values for TSFC0 = 1.0242e-5 kg/(N s), M 0.80, θ 0.7519, printed to three digits in lb/(lbf h)
        // together with the ICAO emissions data bank entry 6AL024 (static TSFC 0.362 lb/(lbf h)).
        for (mach_exponent, printed) in
            [(0.8, 0.502), (1.0, 0.564), (1.1, 0.598), (1.2, 0.635), (1.25, 0.654), (1.3, 0.673)]
        {
            let law = TsfcLaw {
                static_tsfc: Tsfc::kilograms_per_newton_second(1.0242e-5),
                mach_exponent,
            };
            let cruise = tsfc(law, 0.7519, Mach::new(0.80)).to_pounds_per_pound_force_hour();
            assert!((cruise - printed).abs() < 0.001, "{mach_exponent}: {cruise}");
        }
    }

    #[test]
    fn exponent_by_hand() {
        // θ = 0.81, M = 0.44, n = 1.5: 1e-5 · 0.9 · 1.44^1.5 = 1e-5 · 0.9 · 1.728 = 1.5552e-5.
        let law =
            TsfcLaw { static_tsfc: Tsfc::kilograms_per_newton_second(1e-5), mach_exponent: 1.5 };
        let value = tsfc(law, 0.81, Mach::new(0.44)).to_kilograms_per_newton_second();
        assert!((value - 1.5552e-5).abs() < 1e-19, "{value}");
    }

    #[test]
    fn exponent_zero_leaves_temperature_alone() {
        let law =
            TsfcLaw { static_tsfc: Tsfc::kilograms_per_newton_second(1e-5), mach_exponent: 0.0 };
        let value = tsfc(law, 1.0, Mach::new(0.9)).to_kilograms_per_newton_second();
        assert!((value - 1e-5).abs() < 1e-20);
    }
}
