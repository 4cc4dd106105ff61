//! Static and total air temperature.

use units::{Mach, Temperature};

use crate::constants::RATIO_OF_SPECIFIC_HEATS;

/// Temperature that a probe measures in air of a given SAT: the total air temperature when the recovery factor is 1.
///
/// ```text
/// TAT = SAT·(1 + r·(γ−1)/2·M²)                                      [atmosphere.13]
/// ```
///
/// `recovery_factor` r is the share of the adiabatic heating that the probe measures: a property of the probe, 1 for an
/// ideal one and for the TAT that an air data computer sends. It is not checked.
///
/// # Source
/// Adiabatic flow: NACA Report 1135 (1953); Anderson, *Modern Compressible Flow*, equation (3.28).
#[inline]
#[must_use]
pub fn static_to_total(sat: Temperature, mach: Mach, recovery_factor: f64) -> Temperature {
    Temperature::kelvin(sat.to_kelvin() * heating_ratio(mach, recovery_factor))
}

/// SAT from a measured total temperature: the inverse of [`static_to_total`]. `[atmosphere.13]`
#[inline]
#[must_use]
pub fn total_to_static(
    total_temperature: Temperature,
    mach: Mach,
    recovery_factor: f64,
) -> Temperature {
    Temperature::kelvin(total_temperature.to_kelvin() / heating_ratio(mach, recovery_factor))
}

fn heating_ratio(mach: Mach, recovery_factor: f64) -> f64 {
    1.0 + recovery_factor * (RATIO_OF_SPECIFIC_HEATS - 1.0) / 2.0 * mach.value() * mach.value()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ram_rise_by_hand() {
        // Mach 0.80 at −56.5 °C: 216.65·0.2·0.64 = 27.7312 K; a probe of r = 0.95 measures 26.34464 K of it.
        let sat = Temperature::celsius(-56.5);
        let rise_k = |recovery_factor: f64| {
            (static_to_total(sat, Mach::new(0.80), recovery_factor) - sat).to_kelvin()
        };
        assert!((rise_k(1.0) - 27.7312).abs() < 1e-10);
        assert!((rise_k(0.95) - 26.34464).abs() < 1e-10);
        assert!(rise_k(0.0).abs() < 1e-12);
    }

    #[test]
    fn published_ratio_at_mach_one() {
        // NACA Report 1135, table I: T/Tt = 0.8333 at Mach 1.
        let static_temperature = total_to_static(Temperature::kelvin(1.0), Mach::new(1.0), 1.0);
        assert!((static_temperature.to_kelvin() - 0.8333).abs() < 5e-5);
    }
}
