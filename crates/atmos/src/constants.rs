//! Every constant once, with its source. Derived constants are computed, never retyped.
//!
//! Standard gravity is in [`units::convert`], where the pound-force needs it too.

use units::convert::STANDARD_GRAVITY_M_S2;

/// Temperature at zero pressure altitude, K. ISO 2533:1975, main constants (exact).
pub const SEA_LEVEL_TEMPERATURE_K: f64 = 288.15;
/// Pressure at zero pressure altitude, Pa. ISO 2533:1975, main constants (exact).
pub const SEA_LEVEL_PRESSURE_PA: f64 = 101_325.0;
/// Specific gas constant of dry air, J/(kg K). ISO 2533:1975, main constants.
pub const SPECIFIC_GAS_CONSTANT_J_KG_K: f64 = 287.05287;
/// Ratio of specific heats of air. ISO 2533:1975, main constants (exact).
pub const RATIO_OF_SPECIFIC_HEATS: f64 = 1.4;
/// Fall of temperature with pressure altitude below the tropopause, K/m. ISO 2533:1975, layers (exact).
pub const LAPSE_RATE_K_M: f64 = 0.0065;
/// Pressure altitude of the tropopause, m. ISO 2533:1975, layers (exact).
pub const TROPOPAUSE_PRESSURE_ALTITUDE_M: f64 = 11_000.0;
/// Lowest pressure altitude that this crate accepts, m: the start of the tables of ISO 2533:1975.
pub const LOWEST_PRESSURE_ALTITUDE_M: f64 = -2000.0;
/// Highest pressure altitude that this crate accepts, m: the end of the isothermal layer. ISO 2533:1975, layers.
pub const HIGHEST_PRESSURE_ALTITUDE_M: f64 = 20_000.0;

/// Density at zero pressure altitude, kg/m³: p0/(R·T0), 1.225 to seven digits.
pub const SEA_LEVEL_DENSITY_KG_M3: f64 =
    SEA_LEVEL_PRESSURE_PA / (SPECIFIC_GAS_CONSTANT_J_KG_K * SEA_LEVEL_TEMPERATURE_K);
/// Temperature from the tropopause to the end of the isothermal layer, K: T0 − L·11 000 m.
pub const TROPOPAUSE_TEMPERATURE_K: f64 =
    SEA_LEVEL_TEMPERATURE_K - LAPSE_RATE_K_M * TROPOPAUSE_PRESSURE_ALTITUDE_M;
/// Exponent of the pressure law below the tropopause: g0/(R·L), about 5.2559.
pub const TROPOSPHERE_PRESSURE_EXPONENT: f64 =
    STANDARD_GRAVITY_M_S2 / (SPECIFIC_GAS_CONSTANT_J_KG_K * LAPSE_RATE_K_M);
/// Scale height of the isothermal layer, m: R·T11/g0, about 6342 m.
pub const ISOTHERMAL_SCALE_HEIGHT_M: f64 =
    SPECIFIC_GAS_CONSTANT_J_KG_K * TROPOPAUSE_TEMPERATURE_K / STANDARD_GRAVITY_M_S2;

/// Sutherland's coefficient of air βS, kg/(m s √K). ISO 2533:1975, main constants.
pub const SUTHERLAND_COEFFICIENT: f64 = 1.458e-6;
/// Sutherland's temperature of air S, K. ISO 2533:1975, main constants.
pub const SUTHERLAND_TEMPERATURE_K: f64 = 110.4;

/// Semi-major axis of the WGS 84 ellipsoid, m. NIMA TR8350.2 table 3.1 (exact).
pub const WGS84_SEMI_MAJOR_AXIS_M: f64 = 6_378_137.0;
/// Flattening of the WGS 84 ellipsoid. NIMA TR8350.2 table 3.1 (exact reciprocal).
pub const WGS84_FLATTENING: f64 = 1.0 / 298.257_223_563;
/// Geocentric gravitational constant with the atmosphere, m³/s². NIMA TR8350.2 table 3.1 (exact).
pub const WGS84_GRAVITATIONAL_CONSTANT_M3_S2: f64 = 3.986_004_418e14;
/// Earth's rate of rotation, rad/s. NIMA TR8350.2 table 3.1 (exact).
pub const EARTH_ROTATION_RATE_RAD_S: f64 = 7.292_115e-5;
/// Normal gravity at the equator, m/s². NIMA TR8350.2 table 3.4.
pub const WGS84_GRAVITY_EQUATOR_M_S2: f64 = 9.780_325_335_9;
/// Normal gravity at the poles, m/s². NIMA TR8350.2 table 3.4.
pub const WGS84_GRAVITY_POLE_M_S2: f64 = 9.832_184_937_8;

/// Semi-minor axis of the WGS 84 ellipsoid, m: a(1 − f).
pub const WGS84_SEMI_MINOR_AXIS_M: f64 = WGS84_SEMI_MAJOR_AXIS_M * (1.0 - WGS84_FLATTENING);
/// First eccentricity squared of the WGS 84 ellipsoid: f(2 − f).
pub const WGS84_ECCENTRICITY_SQUARED: f64 = WGS84_FLATTENING * (2.0 - WGS84_FLATTENING);
/// Somigliana's constant k: b·γp/(a·γe) − 1, 0.001 931 85.
pub const WGS84_SOMIGLIANA_CONSTANT: f64 = WGS84_SEMI_MINOR_AXIS_M * WGS84_GRAVITY_POLE_M_S2
    / (WGS84_SEMI_MAJOR_AXIS_M * WGS84_GRAVITY_EQUATOR_M_S2)
    - 1.0;
/// Ratio m of centrifugal to gravitational acceleration at the equator: Ω²a²b/GM, 0.003 449 79.
pub const WGS84_CENTRIFUGAL_RATIO: f64 = EARTH_ROTATION_RATE_RAD_S
    * EARTH_ROTATION_RATE_RAD_S
    * WGS84_SEMI_MAJOR_AXIS_M
    * WGS84_SEMI_MAJOR_AXIS_M
    * WGS84_SEMI_MINOR_AXIS_M
    / WGS84_GRAVITATIONAL_CONSTANT_M3_S2;
