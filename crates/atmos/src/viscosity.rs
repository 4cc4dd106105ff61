//! Viscosity of air and the Reynolds number.

use units::{Density, DynamicViscosity, Temperature, TrueAirspeed};

use crate::constants::{SUTHERLAND_COEFFICIENT, SUTHERLAND_TEMPERATURE_K};

/// Dynamic viscosity of air by Sutherland's law.
///
/// ```text
/// μ = βS·SAT^(3/2)/(SAT + S)                                        [atmosphere.14]
/// ```
///
/// ISO 2533 uses it over its whole range of altitude; NaN for a negative temperature.
///
/// # Source
/// ISO 2533:1975, equation (22).
#[inline]
#[must_use]
pub fn dynamic_viscosity(sat: Temperature) -> DynamicViscosity {
    let sat_k = sat.to_kelvin();
    DynamicViscosity::pascal_seconds(
        SUTHERLAND_COEFFICIENT * sat_k * sat_k.sqrt() / (sat_k + SUTHERLAND_TEMPERATURE_K),
    )
}

/// Reynolds number over a length, for example the mean aerodynamic chord; over 1 m, the unit Reynolds number.
///
/// ```text
/// Re = ρ·V·ℓ/μ                                                      [atmosphere.15]
/// ```
#[inline]
#[must_use]
pub fn reynolds_number(
    density: Density,
    true_airspeed: TrueAirspeed,
    length_m: f64,
    dynamic_viscosity: DynamicViscosity,
) -> f64 {
    density.to_kilograms_per_cubic_meter() * true_airspeed.to_meters_per_second() * length_m
        / dynamic_viscosity.to_pascal_seconds()
}
