//! Gravity of the WGS 84 ellipsoid, and what moving over a turning Earth does to weight.
//!
//! Latitudes are geodetic, north positive. They are not checked: beyond ±90° the formulas go on periodically.
//! The ellipsoid is smooth: the real Earth's gravity differs from it by up to about 0.003 m/s² (0.03 %) over mountains
//! and trenches.

use units::{Acceleration, Angle, GeometricAltitude};

use crate::constants::{
    EARTH_ROTATION_RATE_RAD_S, WGS84_CENTRIFUGAL_RATIO, WGS84_ECCENTRICITY_SQUARED,
    WGS84_FLATTENING, WGS84_GRAVITY_EQUATOR_M_S2, WGS84_SEMI_MAJOR_AXIS_M,
    WGS84_SOMIGLIANA_CONSTANT,
};

/// Normal gravity on the ellipsoid, where nothing moves over the Earth.
///
/// ```text
/// γ0 = γe·(1 + k sin²φ)/√(1 − e² sin²φ)                             [atmosphere.16]
/// ```
///
/// # Source
/// Somigliana; NGA.STND.0036 (2014), equation (4-1).
#[doc(alias = "Somigliana")]
#[inline]
#[must_use]
pub fn normal_gravity(latitude: Angle) -> Acceleration {
    Acceleration::meters_per_second_squared(normal_gravity_m_s2(sine_squared(latitude)))
}

/// Gravity at a height over the ellipsoid, where nothing moves over the Earth: free air, to second order.
///
/// ```text
/// γ = γ0·(1 − 2(1 + f + m − 2f sin²φ)·h/a + 3·(h/a)²)               [atmosphere.17]
/// ```
///
/// For cruise heights: the third order, −4(h/a)³, is 1e-7 of gravity at 20 km. It is not checked.
///
/// # Source
/// NGA.STND.0036 (2014), equation (4-3).
#[inline]
#[must_use]
pub fn gravity(latitude: Angle, geometric_altitude: GeometricAltitude) -> Acceleration {
    let sine_squared = sine_squared(latitude);
    let height_ratio = geometric_altitude.to_meters() / WGS84_SEMI_MAJOR_AXIS_M;
    let first_order = 2.0
        * (1.0 + WGS84_FLATTENING + WGS84_CENTRIFUGAL_RATIO
            - 2.0 * WGS84_FLATTENING * sine_squared);
    let free_air_ratio = 1.0 - first_order * height_ratio + 3.0 * height_ratio * height_ratio;
    Acceleration::meters_per_second_squared(normal_gravity_m_s2(sine_squared) * free_air_ratio)
}

/// By how much motion over the Earth reduces apparent gravity (Eötvös): the weight that lift must carry is
/// m·([`gravity`] − this).
///
/// ```text
/// Δg = 2Ω·V_east·cos φ + V_east²/(N + h) + V_north²/(M + h)         [atmosphere.18]
/// N = a/√(1 − e² sin²φ)      M = N·(1 − e²)/(1 − e² sin²φ)
/// ```
///
/// Velocities are over the ground. N and M are the ellipsoid's radii of curvature along east and north.
/// Positive: lighter. Flying west below about 930·cos φ m/s: negative, heavier.
///
/// # Source
/// Vertical part of the Coriolis and transport accelerations in local-level axes; Groves, *Principles of GNSS,
/// Inertial, and Multisensor Integrated Navigation Systems*, equations (5.41) and (5.44), radii (2.105) and (2.106).
#[doc(alias = "Eotvos")]
#[inline]
#[must_use]
pub fn earth_motion_acceleration(
    latitude: Angle,
    velocity_east_m_s: f64,
    velocity_north_m_s: f64,
    geometric_altitude: GeometricAltitude,
) -> Acceleration {
    let bracket = 1.0 - WGS84_ECCENTRICITY_SQUARED * sine_squared(latitude);
    let radius_east_m = WGS84_SEMI_MAJOR_AXIS_M / bracket.sqrt();
    let radius_north_m = radius_east_m * (1.0 - WGS84_ECCENTRICITY_SQUARED) / bracket;
    let height_m = geometric_altitude.to_meters();
    let coriolis_m_s2 =
        2.0 * EARTH_ROTATION_RATE_RAD_S * velocity_east_m_s * latitude.to_radians().cos();
    let centripetal_m_s2 = velocity_east_m_s * velocity_east_m_s / (radius_east_m + height_m)
        + velocity_north_m_s * velocity_north_m_s / (radius_north_m + height_m);
    Acceleration::meters_per_second_squared(coriolis_m_s2 + centripetal_m_s2)
}

/// Coriolis parameter f = 2Ω sin φ, 1/s; negative in the south. `[atmosphere.19]`
#[inline]
#[must_use]
pub fn coriolis_parameter(latitude: Angle) -> f64 {
    2.0 * EARTH_ROTATION_RATE_RAD_S * latitude.to_radians().sin()
}

fn sine_squared(latitude: Angle) -> f64 {
    let sine = latitude.to_radians().sin();
    sine * sine
}

fn normal_gravity_m_s2(sine_squared: f64) -> f64 {
    WGS84_GRAVITY_EQUATOR_M_S2 * (1.0 + WGS84_SOMIGLIANA_CONSTANT * sine_squared)
        / (1.0 - WGS84_ECCENTRICITY_SQUARED * sine_squared).sqrt()
}
