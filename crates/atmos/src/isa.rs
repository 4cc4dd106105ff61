//! The international standard atmosphere over pressure altitude, −2 to 20 km.

use units::{
    Density, OutOfDomain, Pressure, PressureAltitude, SpeedOfSound, Temperature,
    TemperatureDifference, check_within,
};

use crate::constants::{
    HIGHEST_PRESSURE_ALTITUDE_M, ISOTHERMAL_SCALE_HEIGHT_M, LAPSE_RATE_K_M,
    LOWEST_PRESSURE_ALTITUDE_M, RATIO_OF_SPECIFIC_HEATS, SEA_LEVEL_DENSITY_KG_M3,
    SEA_LEVEL_PRESSURE_PA, SEA_LEVEL_TEMPERATURE_K, SPECIFIC_GAS_CONSTANT_J_KG_K,
    TROPOPAUSE_PRESSURE_ALTITUDE_M, TROPOPAUSE_TEMPERATURE_K, TROPOSPHERE_PRESSURE_EXPONENT,
};

/// Temperature of the standard day at a pressure altitude.
///
/// ```text
/// T = T0 − L·hp      hp ≤ 11 000 m
/// T = 216.65 K       above                                          [atmosphere.1]
/// ```
///
/// # Errors
/// [`OutOfDomain`] outside −2000 to 20 000 m, and for NaN.
///
/// # Source
/// ISO 2533:1975, clause 2 and its table of temperature gradients; EUROCONTROL BADA 3.12, section 3.1.
#[inline]
pub fn temperature(pressure_altitude: PressureAltitude) -> Result<Temperature, OutOfDomain> {
    let pressure_altitude_m = check_pressure_altitude_m(pressure_altitude)?;
    Ok(Temperature::kelvin(temperature_k(pressure_altitude_m)))
}

/// Static pressure at a pressure altitude. This is the definition of pressure altitude: it holds on every day.
///
/// ```text
/// p = p0·(T/T0)^(g0/(R L))                       hp ≤ 11 000 m
/// p = p11·exp(−(hp − 11 000 m)·g0/(R T11))       above              [atmosphere.2]
/// ```
///
/// # Errors
/// [`OutOfDomain`] outside −2000 to 20 000 m, and for NaN.
///
/// # Source
/// ISO 2533:1975, clause 2; EUROCONTROL BADA 3.12, equations 3.1-18 and 3.1-20.
#[inline]
pub fn pressure(pressure_altitude: PressureAltitude) -> Result<Pressure, OutOfDomain> {
    let pressure_altitude_m = check_pressure_altitude_m(pressure_altitude)?;
    Ok(Pressure::pascals(pressure_pa(pressure_altitude_m)))
}

/// Pressure altitude at which the static pressure occurs: the inverse of [`pressure`].
///
/// ```text
/// hp = (T0/L)·(1 − (p/p0)^(R L/g0))              p ≥ p11
/// hp = 11 000 m − (R T11/g0)·ln(p/p11)           below              [atmosphere.3]
/// ```
///
/// At the two ends of the domain the result is held to the end, in case the last bit is rounded outward.
///
/// # Errors
/// [`OutOfDomain`] for a static pressure outside that of 20 000 m to that of −2000 m, and for NaN.
///
/// # Source
/// `[atmosphere.2]` solved for the altitude.
#[inline]
pub fn pressure_altitude(static_pressure: Pressure) -> Result<PressureAltitude, OutOfDomain> {
    let static_pressure_pa = check_within(
        "static pressure",
        "Pa",
        static_pressure.to_pascals(),
        pressure_pa(HIGHEST_PRESSURE_ALTITUDE_M),
        pressure_pa(LOWEST_PRESSURE_ALTITUDE_M),
    )?;
    let pressure_altitude_m = pressure_altitude_m(static_pressure_pa)
        .clamp(LOWEST_PRESSURE_ALTITUDE_M, HIGHEST_PRESSURE_ALTITUDE_M);
    Ok(PressureAltitude::meters(pressure_altitude_m))
}

/// Density of air of a static pressure and the *measured* SAT.
///
/// ```text
/// ρ = p/(R·SAT)                                                     [atmosphere.4]
/// ```
///
/// Dry air. Not positive, or NaN, arguments give what the division gives.
///
/// # Source
/// The perfect gas, ISO 2533:1975, clause 2.
#[inline]
#[must_use]
pub fn density(static_pressure: Pressure, sat: Temperature) -> Density {
    Density::kilograms_per_cubic_meter(
        static_pressure.to_pascals() / (SPECIFIC_GAS_CONSTANT_J_KG_K * sat.to_kelvin()),
    )
}

/// Temperature ratio θ = T/T0, of a static or a total temperature. `[atmosphere.5]`
#[doc(alias = "theta")]
#[inline]
#[must_use]
pub fn temperature_ratio(temperature: Temperature) -> f64 {
    temperature.to_kelvin() / SEA_LEVEL_TEMPERATURE_K
}

/// Pressure ratio δ = p/p0. `[atmosphere.5]`
#[doc(alias = "delta")]
#[inline]
#[must_use]
pub fn pressure_ratio(pressure: Pressure) -> f64 {
    pressure.to_pascals() / SEA_LEVEL_PRESSURE_PA
}

/// Density ratio σ = ρ/ρ0, which is δ/θ. `[atmosphere.5]`
#[doc(alias = "sigma")]
#[inline]
#[must_use]
pub fn density_ratio(density: Density) -> f64 {
    density.to_kilograms_per_cubic_meter() / SEA_LEVEL_DENSITY_KG_M3
}

/// Speed of sound at a static air temperature.
///
/// ```text
/// a = √(γ R SAT)                                                    [atmosphere.6]
/// ```
///
/// NaN for a negative temperature.
///
/// # Source
/// ISO 2533:1975, clause 2.
#[inline]
#[must_use]
pub fn speed_of_sound(sat: Temperature) -> SpeedOfSound {
    SpeedOfSound::meters_per_second(
        (RATIO_OF_SPECIFIC_HEATS * SPECIFIC_GAS_CONSTANT_J_KG_K * sat.to_kelvin()).sqrt(),
    )
}

/// Deviation of the day from the standard one: SAT − T(hp) with [`temperature`]. `[atmosphere.1]`
///
/// # Errors
/// [`OutOfDomain`] for a pressure altitude outside −2000 to 20 000 m, and for NaN.
#[inline]
pub fn isa_deviation(
    pressure_altitude: PressureAltitude,
    sat: Temperature,
) -> Result<TemperatureDifference, OutOfDomain> {
    Ok(sat - temperature(pressure_altitude)?)
}

fn check_pressure_altitude_m(pressure_altitude: PressureAltitude) -> Result<f64, OutOfDomain> {
    check_within(
        "pressure altitude",
        "m",
        pressure_altitude.to_meters(),
        LOWEST_PRESSURE_ALTITUDE_M,
        HIGHEST_PRESSURE_ALTITUDE_M,
    )
}

fn temperature_k(pressure_altitude_m: f64) -> f64 {
    if pressure_altitude_m <= TROPOPAUSE_PRESSURE_ALTITUDE_M {
        SEA_LEVEL_TEMPERATURE_K - LAPSE_RATE_K_M * pressure_altitude_m
    } else {
        TROPOPAUSE_TEMPERATURE_K
    }
}

fn pressure_pa(pressure_altitude_m: f64) -> f64 {
    if pressure_altitude_m <= TROPOPAUSE_PRESSURE_ALTITUDE_M {
        troposphere_pressure_pa(pressure_altitude_m)
    } else {
        let above_tropopause_m = pressure_altitude_m - TROPOPAUSE_PRESSURE_ALTITUDE_M;
        tropopause_pressure_pa() * (-above_tropopause_m / ISOTHERMAL_SCALE_HEIGHT_M).exp()
    }
}

fn troposphere_pressure_pa(pressure_altitude_m: f64) -> f64 {
    let temperature_ratio = temperature_k(pressure_altitude_m) / SEA_LEVEL_TEMPERATURE_K;
    SEA_LEVEL_PRESSURE_PA * temperature_ratio.powf(TROPOSPHERE_PRESSURE_EXPONENT)
}

fn pressure_altitude_m(static_pressure_pa: f64) -> f64 {
    let tropopause_pressure_pa = tropopause_pressure_pa();
    if static_pressure_pa >= tropopause_pressure_pa {
        let temperature_ratio =
            (static_pressure_pa / SEA_LEVEL_PRESSURE_PA).powf(1.0 / TROPOSPHERE_PRESSURE_EXPONENT);
        SEA_LEVEL_TEMPERATURE_K / LAPSE_RATE_K_M * (1.0 - temperature_ratio)
    } else {
        TROPOPAUSE_PRESSURE_ALTITUDE_M
            - ISOTHERMAL_SCALE_HEIGHT_M * (static_pressure_pa / tropopause_pressure_pa).ln()
    }
}

/// p11, computed and not typed: a rounded literal here would make a step of the pressure at 11 km. The argument is
/// constant, so an optimizing compiler removes the power.
fn tropopause_pressure_pa() -> f64 {
    troposphere_pressure_pa(TROPOPAUSE_PRESSURE_ALTITUDE_M)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_domain_is_closed_and_refused_outside() {
        for pressure_altitude_m in [-2000.0, 20_000.0] {
            let pressure_altitude = PressureAltitude::meters(pressure_altitude_m);
            assert!(temperature(pressure_altitude).is_ok());
            let static_pressure = pressure(pressure_altitude).unwrap();
            let back = super::pressure_altitude(static_pressure).unwrap();
            assert!((back.to_meters() - pressure_altitude_m).abs() < 1e-8);
            // However it was rounded, the result is inside the domain.
            assert!(temperature(back).is_ok(), "{back:?}");
        }
        for pressure_altitude_m in [-2000.001, 20_000.001, f64::NAN, f64::INFINITY] {
            let pressure_altitude = PressureAltitude::meters(pressure_altitude_m);
            assert!(temperature(pressure_altitude).is_err(), "{pressure_altitude_m}");
            assert!(pressure(pressure_altitude).is_err(), "{pressure_altitude_m}");
            assert!(isa_deviation(pressure_altitude, Temperature::kelvin(220.0)).is_err());
        }
        // The pressures of 20 000 and −2000 m are 5474.877 and 127 773.730 Pa.
        for static_pressure_pa in [5474.87, 127_773.74, 0.0, -1.0, f64::NAN] {
            assert!(super::pressure_altitude(Pressure::pascals(static_pressure_pa)).is_err());
        }
    }

    #[test]
    fn refusal_names_quantity_value_and_limits() {
        let error = pressure(PressureAltitude::meters(21_000.0)).unwrap_err();
        assert_eq!(error.to_string(), "pressure altitude 21000 m outside -2000 to 20000 m");
        let error = super::pressure_altitude(Pressure::pascals(1.0)).unwrap_err();
        assert_eq!((error.quantity, error.unit), ("static pressure", "Pa"));
    }

    #[test]
    fn the_layers_meet() {
        // Both laws at 11 000 m give p11; a millimeter apart they differ by ρ g0 dh = 3.57e-3 Pa, not by a step.
        let at = |pressure_altitude_m: f64| {
            pressure(PressureAltitude::meters(pressure_altitude_m)).unwrap().to_pascals()
        };
        let step_pa = at(11_000.0) - at(11_000.001);
        assert!((step_pa - 0.363_918 * 9.80665 * 0.001).abs() < 1e-6, "{step_pa}");
        let below = super::pressure_altitude(Pressure::pascals(at(11_000.0))).unwrap();
        assert!((below.to_meters() - 11_000.0).abs() < 1e-8);
    }

    #[test]
    fn a_warm_day_is_thinner_by_its_temperature() {
        // ρ ∝ 1/SAT at one pressure: +10 K on 216.65 K is 216.65/226.65 = 0.955879.
        let static_pressure = pressure(PressureAltitude::feet(39_000.0)).unwrap();
        let standard = density(static_pressure, Temperature::kelvin(216.65));
        let warm = density(static_pressure, Temperature::kelvin(226.65));
        let ratio = warm.to_kilograms_per_cubic_meter() / standard.to_kilograms_per_cubic_meter();
        assert!((ratio - 0.955_879).abs() < 1e-6);
    }
}
