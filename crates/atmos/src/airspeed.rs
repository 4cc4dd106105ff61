//! Mach number, TAS, CAS and EAS, each from each; impact and dynamic pressure.
//!
//! Functions of calibrated airspeed or impact pressure are for subsonic flow: the Pitot tube of a supersonic aircraft
//! is behind a shock and obeys another law. Outside 0 ≤ M ≤ 1 or 0 ≤ CAS ≤ a0 these functions return NaN, not the value
//! of a law that does not hold there.
//!
//! `(1 + x)^n − 1` is computed as `exp_m1(n·ln_1p(x))` throughout, so that slow airspeeds keep their digits.

use units::{
    CalibratedAirspeed, Density, EquivalentAirspeed, Mach, Pressure, Temperature, TrueAirspeed,
};

use crate::constants::{
    RATIO_OF_SPECIFIC_HEATS, SEA_LEVEL_DENSITY_KG_M3, SEA_LEVEL_PRESSURE_PA,
    SEA_LEVEL_TEMPERATURE_K, SPECIFIC_GAS_CONSTANT_J_KG_K,
};
use crate::isa::speed_of_sound;

/// γ/(γ − 1) = 3.5.
const COMPRESSION_EXPONENT: f64 = RATIO_OF_SPECIFIC_HEATS / (RATIO_OF_SPECIFIC_HEATS - 1.0);
/// (γ − 1)/2 = 0.2.
const HEATING_FACTOR: f64 = (RATIO_OF_SPECIFIC_HEATS - 1.0) / 2.0;

/// True airspeed of a Mach number: V = M·a(SAT). `[atmosphere.7]`
#[inline]
#[must_use]
pub fn mach_to_true_airspeed(mach: Mach, sat: Temperature) -> TrueAirspeed {
    TrueAirspeed::meters_per_second(mach.value() * speed_of_sound(sat).to_meters_per_second())
}

/// Mach number of a true airspeed: M = V/a(SAT). `[atmosphere.7]`
#[inline]
#[must_use]
pub fn true_airspeed_to_mach(true_airspeed: TrueAirspeed, sat: Temperature) -> Mach {
    Mach::new(true_airspeed.to_meters_per_second() / speed_of_sound(sat).to_meters_per_second())
}

/// Static air temperature in which a true airspeed is a Mach number: SAT = (V/M)²/(γR). `[atmosphere.7]`
///
/// As exact as the air data computer that makes the true airspeed of the same two numbers. NaN or infinite at Mach 0.
#[inline]
#[must_use]
pub fn static_air_temperature(true_airspeed: TrueAirspeed, mach: Mach) -> Temperature {
    let speed_of_sound_m_s = true_airspeed.to_meters_per_second() / mach.value();
    let per_kelvin = RATIO_OF_SPECIFIC_HEATS * SPECIFIC_GAS_CONSTANT_J_KG_K;
    Temperature::kelvin(speed_of_sound_m_s * speed_of_sound_m_s / per_kelvin)
}

/// Impact pressure: total minus static pressure, measured by the airspeed indicator.
///
/// ```text
/// qc = p·((1 + (γ−1)/2·M²)^(γ/(γ−1)) − 1)                           [atmosphere.8]
/// ```
///
/// NaN outside 0 ≤ M ≤ 1.
///
/// # Source
/// Isentropic compression: NACA Report 1135 (1953); Anderson, *Modern Compressible Flow*, equation (3.30).
#[inline]
#[must_use]
pub fn impact_pressure(mach: Mach, static_pressure: Pressure) -> Pressure {
    Pressure::pascals(static_pressure.to_pascals() * impact_pressure_ratio(mach.value()))
}

/// Dynamic pressure q = ½ρV². `[atmosphere.9]`
///
/// Not the impact pressure: that is larger by the compressibility of air, 17 % at Mach 0.8.
#[inline]
#[must_use]
pub fn dynamic_pressure(density: Density, true_airspeed: TrueAirspeed) -> Pressure {
    let true_airspeed_m_s = true_airspeed.to_meters_per_second();
    Pressure::pascals(
        0.5 * density.to_kilograms_per_cubic_meter() * true_airspeed_m_s * true_airspeed_m_s,
    )
}

/// Calibrated airspeed of a Mach number at a static pressure.
///
/// ```text
/// CAS = a0·√(2/(γ−1)·((qc/p0 + 1)^((γ−1)/γ) − 1))                   [atmosphere.10]
/// ```
///
/// with qc of [`impact_pressure`]. NaN outside 0 ≤ M ≤ 1 and where the result would exceed a0.
///
/// # Source
/// The definition of calibrated airspeed: the airspeed at sea level of the standard day with that impact pressure.
#[inline]
#[must_use]
pub fn mach_to_calibrated_airspeed(mach: Mach, static_pressure: Pressure) -> CalibratedAirspeed {
    let impact_pressure_pa = impact_pressure(mach, static_pressure).to_pascals();
    let sea_level_mach = mach_of_impact_pressure_ratio(impact_pressure_pa / SEA_LEVEL_PRESSURE_PA);
    CalibratedAirspeed::meters_per_second(sea_level_mach * sea_level_speed_of_sound_m_s())
}

/// Mach number of a calibrated airspeed at a static pressure: the inverse of [`mach_to_calibrated_airspeed`].
///
/// ```text
/// M = √(2/(γ−1)·((qc/p + 1)^((γ−1)/γ) − 1))                         [atmosphere.11]
/// ```
///
/// with qc of CAS/a0 at p0 by `[atmosphere.8]`. NaN outside 0 ≤ CAS ≤ a0 and where the result would exceed 1.
#[inline]
#[must_use]
pub fn calibrated_airspeed_to_mach(
    calibrated_airspeed: CalibratedAirspeed,
    static_pressure: Pressure,
) -> Mach {
    let sea_level_mach =
        calibrated_airspeed.to_meters_per_second() / sea_level_speed_of_sound_m_s();
    let impact_pressure_pa = SEA_LEVEL_PRESSURE_PA * impact_pressure_ratio(sea_level_mach);
    Mach::new(mach_of_impact_pressure_ratio(impact_pressure_pa / static_pressure.to_pascals()))
}

/// Calibrated airspeed of a true airspeed: by way of the Mach number, so subsonic like it. `[atmosphere.10]`
#[inline]
#[must_use]
pub fn true_airspeed_to_calibrated_airspeed(
    true_airspeed: TrueAirspeed,
    static_pressure: Pressure,
    sat: Temperature,
) -> CalibratedAirspeed {
    mach_to_calibrated_airspeed(true_airspeed_to_mach(true_airspeed, sat), static_pressure)
}

/// True airspeed of a calibrated airspeed: by way of the Mach number, so subsonic like it. `[atmosphere.11]`
#[inline]
#[must_use]
pub fn calibrated_airspeed_to_true_airspeed(
    calibrated_airspeed: CalibratedAirspeed,
    static_pressure: Pressure,
    sat: Temperature,
) -> TrueAirspeed {
    mach_to_true_airspeed(calibrated_airspeed_to_mach(calibrated_airspeed, static_pressure), sat)
}

/// Equivalent airspeed of a true airspeed: EAS = V·√(ρ/ρ0). `[atmosphere.12]`
#[inline]
#[must_use]
pub fn true_airspeed_to_equivalent_airspeed(
    true_airspeed: TrueAirspeed,
    density: Density,
) -> EquivalentAirspeed {
    EquivalentAirspeed::meters_per_second(
        true_airspeed.to_meters_per_second() * density_ratio_root(density),
    )
}

/// True airspeed of an equivalent airspeed: V = EAS/√(ρ/ρ0). `[atmosphere.12]`
#[inline]
#[must_use]
pub fn equivalent_airspeed_to_true_airspeed(
    equivalent_airspeed: EquivalentAirspeed,
    density: Density,
) -> TrueAirspeed {
    TrueAirspeed::meters_per_second(
        equivalent_airspeed.to_meters_per_second() / density_ratio_root(density),
    )
}

/// qc/p of a subsonic Mach number, NaN for others.
fn impact_pressure_ratio(mach: f64) -> f64 {
    (COMPRESSION_EXPONENT * (HEATING_FACTOR * subsonic(mach).powi(2)).ln_1p()).exp_m1()
}

/// The Mach number that compresses air by qc/p, NaN where it is not subsonic.
fn mach_of_impact_pressure_ratio(impact_pressure_ratio: f64) -> f64 {
    subsonic(
        ((impact_pressure_ratio.ln_1p() / COMPRESSION_EXPONENT).exp_m1() / HEATING_FACTOR).sqrt(),
    )
}

fn subsonic(mach: f64) -> f64 {
    if (0.0..=1.0).contains(&mach) { mach } else { f64::NAN }
}

fn sea_level_speed_of_sound_m_s() -> f64 {
    speed_of_sound(Temperature::kelvin(SEA_LEVEL_TEMPERATURE_K)).to_meters_per_second()
}

fn density_ratio_root(density: Density) -> f64 {
    (density.to_kilograms_per_cubic_meter() / SEA_LEVEL_DENSITY_KG_M3).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::isa;

    const SEA_LEVEL: Pressure = Pressure::pascals(SEA_LEVEL_PRESSURE_PA);

    #[test]
    fn calibrated_is_true_airspeed_at_sea_level_of_the_standard_day() {
        // The definition of calibrated airspeed.
        let sat = Temperature::kelvin(SEA_LEVEL_TEMPERATURE_K);
        for knots in [1.0, 100.0, 250.0, 500.0, 660.0] {
            let calibrated =
                true_airspeed_to_calibrated_airspeed(TrueAirspeed::knots(knots), SEA_LEVEL, sat);
            assert!((calibrated.to_knots() / knots - 1.0).abs() < 1e-14, "{calibrated}");
        }
    }

    /// ICAO Doc 7488: at 11 000 m the speed of sound is 295.069 m/s, at 216.65 K.
    #[test]
    fn temperature_of_the_tables_speed_of_sound() {
        let speed = TrueAirspeed::meters_per_second(0.8 * 295.069);
        let sat = static_air_temperature(speed, Mach::new(0.8));
        assert!((sat.to_kelvin() - 216.65).abs() < 0.001, "{sat:?}");
    }

    #[test]
    fn impact_pressure_at_mach_one() {
        // Total over static pressure at Mach 1 is 1.2^3.5 = 1.892929 (NACA Report 1135, table I: p/pt = 0.5283).
        let impact_pressure_pa = impact_pressure(Mach::new(1.0), SEA_LEVEL).to_pascals();
        assert!((impact_pressure_pa / SEA_LEVEL_PRESSURE_PA - 0.892929).abs() < 1e-6);
        assert!((1.0 / (impact_pressure_pa / SEA_LEVEL_PRESSURE_PA + 1.0) - 0.5283).abs() < 5e-5);
    }

    #[test]
    fn compressibility_at_mach_0_8() {
        // By hand: 1.128^3.5 = 1.524342, so qc/p = 0.524342; q/p = 0.7·0.64 = 0.448; qc/q = 1.1704.
        let sat = Temperature::kelvin(216.65);
        let static_pressure = Pressure::pascals(20_000.0);
        let true_airspeed = mach_to_true_airspeed(Mach::new(0.8), sat);
        let dynamic = dynamic_pressure(isa::density(static_pressure, sat), true_airspeed);
        let impact = impact_pressure(Mach::new(0.8), static_pressure);
        assert!((dynamic.to_pascals() - 0.448 * 20_000.0).abs() < 1e-8);
        assert!((impact / dynamic - 1.1704).abs() < 5e-5);
    }

    #[test]
    fn slow_airspeeds_keep_their_digits() {
        // Incompressible limit: CAS = EAS. A plain power minus 1 is wrong by 1e-8 here.
        let static_pressure = Pressure::pascals(25_000.0);
        let sat = Temperature::kelvin(220.0);
        let true_airspeed = TrueAirspeed::meters_per_second(0.001);
        let calibrated = true_airspeed_to_calibrated_airspeed(true_airspeed, static_pressure, sat);
        let density = isa::density(static_pressure, sat);
        let equivalent = true_airspeed_to_equivalent_airspeed(true_airspeed, density);
        let ratio = calibrated.to_meters_per_second() / equivalent.to_meters_per_second();
        assert!((ratio - 1.0).abs() < 1e-11, "{ratio}");
    }

    #[test]
    fn equivalent_airspeed_by_hand() {
        // σ = 0.25: EAS = TAS/2.
        let density = Density::kilograms_per_cubic_meter(SEA_LEVEL_DENSITY_KG_M3 / 4.0);
        let equivalent = true_airspeed_to_equivalent_airspeed(TrueAirspeed::knots(480.0), density);
        assert!((equivalent.to_knots() - 240.0).abs() < 1e-12);
        let back = equivalent_airspeed_to_true_airspeed(equivalent, density);
        assert!((back.to_knots() - 480.0).abs() < 1e-12);
    }

    #[test]
    fn no_value_where_the_law_does_not_hold() {
        for mach in [-0.1, 1.001, f64::NAN, f64::INFINITY] {
            assert!(!impact_pressure(Mach::new(mach), SEA_LEVEL).is_finite(), "{mach}");
            assert!(!mach_to_calibrated_airspeed(Mach::new(mach), SEA_LEVEL).is_finite());
        }
        for meters_per_second in [-1.0, 341.0, f64::NAN] {
            let calibrated = CalibratedAirspeed::meters_per_second(meters_per_second);
            assert!(!calibrated_airspeed_to_mach(calibrated, SEA_LEVEL).is_finite());
        }
        // Subsonic CAS, supersonic Mach number: 600 kt CAS at 12 km.
        let high = Pressure::pascals(19_330.0);
        assert!(!calibrated_airspeed_to_mach(CalibratedAirspeed::knots(600.0), high).is_finite());
        // Subsonic Mach number, CAS above a0: Mach 0.99 at −2000 m.
        let low = Pressure::pascals(127_774.0);
        assert!(!mach_to_calibrated_airspeed(Mach::new(0.99), low).is_finite());
    }
}
