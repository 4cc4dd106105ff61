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
/// ISO 2533:1975, clause 2, with its main constants.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_viscosities() {
        // ICAO Doc 7488/3, table C (sea level) and table 5 (16 000 and 20 000 ft), five digits.
        for (sat_k, published_pa_s) in
            [(288.15, 1.7894e-5), (256.451, 1.6322e-5), (248.526, 1.5915e-5)]
        {
            let viscosity_pa_s = dynamic_viscosity(Temperature::kelvin(sat_k)).to_pascal_seconds();
            assert!((viscosity_pa_s - published_pa_s).abs() < 0.5e-9, "{viscosity_pa_s:e}");
        }
    }

    #[test]
    fn reynolds_number_by_hand() {
        // 0.4 kg/m³ · 240 m/s · 3 m / 1.44e-5 Pa s = 2.0e7.
        let reynolds_number = reynolds_number(
            Density::kilograms_per_cubic_meter(0.4),
            TrueAirspeed::meters_per_second(240.0),
            3.0,
            DynamicViscosity::pascal_seconds(1.44e-5),
        );
        assert!((reynolds_number - 2.0e7).abs() < 1e-6);
    }
}
