//! Static and total air temperature.

use units::{Mach, Temperature};

use crate::constants::RATIO_OF_SPECIFIC_HEATS;

/// Temperature that a probe measures in air of a SAT: the total air temperature when the recovery factor is 1.
///
/// ```text
/// TAT = SAT·(1 + r·(γ−1)/2·M²)                                      [atmosphere.13]
/// ```
///
/// `recovery_factor` r is the share of the adiabatic heating that the probe sees: a property of the probe, 1 for an
/// ideal one and for the TAT that an air data computer sends. It is not checked.
///
/// # Source
/// Adiabatic flow; Anderson, *Modern Compressible Flow*, equation (3.28).
#[inline]
#[must_use]
pub fn static_to_total(sat: Temperature, mach: Mach, recovery_factor: f64) -> Temperature {
    Temperature::kelvin(sat.to_kelvin() * heating_ratio(mach, recovery_factor))
}

/// SAT behind a measured total temperature: the inverse of [`static_to_total`]. `[atmosphere.13]`
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
