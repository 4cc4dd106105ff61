//! Gravity of the WGS 84 ellipsoid, and the effect of motion over the rotating Earth on weight.
//!
//! Latitudes are geodetic, north positive. They are not checked: beyond ±90° the formulas continue periodically.
//! Heights are above the ellipsoid in the formulas; above mean sea level differs by at most about 100 m, 3e-5 of gravity.
//! The ellipsoid is smooth: the real Earth's gravity differs from it by a few 0.001 m/s² (a few 0.01 %) over mountains
//! and trenches.

use units::{Acceleration, Angle, GeometricAltitude};

use crate::constants::{
    EARTH_ROTATION_RATE_RAD_S, WGS84_CENTRIFUGAL_RATIO, WGS84_ECCENTRICITY_SQUARED,
    WGS84_FLATTENING, WGS84_GRAVITY_EQUATOR_M_S2, WGS84_SEMI_MAJOR_AXIS_M,
    WGS84_SOMIGLIANA_CONSTANT,
};

/// Normal gravity on the ellipsoid, for a body at rest relative to the Earth.
///
/// ```text
/// γ0 = γe·(1 + k sin²φ)/√(1 − e² sin²φ)                             [atmosphere.16]
/// ```
///
/// # Source
/// Somigliana's closed formula; NIMA TR8350.2 (3rd edition, 2000), equation (4-1).
#[doc(alias = "Somigliana")]
#[inline]
#[must_use]
pub fn normal_gravity(latitude: Angle) -> Acceleration {
    Acceleration::meters_per_second_squared(normal_gravity_m_s2(sine_squared(latitude)))
}

/// Gravity at a height over the ellipsoid, for a body at rest relative to the Earth: free air, to second order.
///
/// ```text
/// γ = γ0·(1 − 2(1 + f + m − 2f sin²φ)·h/a + 3·(h/a)²)               [atmosphere.17]
/// ```
///
/// The second-order term is 1e-5 of gravity at 12 km, and costs nothing. The third, −4(h/a)³, is 1.2e-7 at 20 km.
/// Height is not checked.
///
/// A pressure altitude is not a height (on a day 10 K warm, 12 000 m of it are about 12 500 m):
///
/// ```compile_fail
/// use units::{Angle, PressureAltitude};
/// let _ = atmos::gravity::gravity(Angle::degrees(45.0), PressureAltitude::feet(39_000.0));
/// ```
///
/// # Source
/// NIMA TR8350.2 (3rd edition, 2000), equation (4-3).
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

/// Reduction of apparent gravity by motion over the Earth (Eötvös): the weight that lift must carry is m·([`gravity`] −
/// this).
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
/// Vertical part of the Coriolis and transport accelerations in local-level axes: Groves, *Principles of GNSS,
/// Inertial, and Multisensor Integrated Navigation Systems* (2nd edition), chapters 2 and 5; Harlan, *Eötvös
/// corrections for airborne gravimetry*, J. Geophys. Res. 73 (1968).
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::{
        WGS84_GRAVITATIONAL_CONSTANT_M3_S2, WGS84_GRAVITY_POLE_M_S2, WGS84_SEMI_MINOR_AXIS_M,
    };
    use units::convert::{METERS_PER_SECOND_PER_KNOT, STANDARD_GRAVITY_M_S2};

    const CRUISE: GeometricAltitude = GeometricAltitude::feet(41_000.0);

    fn m_s2(acceleration: Acceleration) -> f64 {
        acceleration.to_meters_per_second_squared()
    }

    #[test]
    fn derived_constants_are_the_published_ones() {
        // NIMA TR8350.2, tables 3.3 and 3.4: e², k, m, b as printed there.
        assert!((WGS84_ECCENTRICITY_SQUARED - 6.69437999014e-3).abs() < 1e-14);
        assert!((WGS84_SOMIGLIANA_CONSTANT - 0.00193185265241).abs() < 2e-11);
        assert!((WGS84_CENTRIFUGAL_RATIO - 0.00344978650684).abs() < 1e-14);
        assert!((WGS84_SEMI_MINOR_AXIS_M - 6356752.3142).abs() < 1e-4);
    }

    #[test]
    fn published_normal_gravity() {
        // WGS 84 (NIMA TR8350.2, table 3.4): equator 9.7803253, pole 9.8321849 m/s²; at 45° 9.80620.
        for (latitude_deg, published, tolerance) in [
            (0.0, 9.7803253, 5e-8),
            (45.0, 9.80620, 5e-6),
            (-45.0, 9.80620, 5e-6),
            (90.0, 9.8321849, 5e-8),
            (-90.0, WGS84_GRAVITY_POLE_M_S2, 1e-12),
        ] {
            let ours = m_s2(normal_gravity(Angle::degrees(latitude_deg)));
            assert!((ours - published).abs() <= tolerance, "{latitude_deg}°: {ours}");
        }
    }

    #[test]
    fn free_air_gravity_is_that_of_the_spherical_harmonics() {
        // An independent way, without Somigliana: gradient of the normal potential with J2 and J4 of WGS 84 (TR8350.2),
        // minus the centrifugal acceleration; on the equator and over a pole, where the vertical is radial.
        let (j2, j4) = (1.082629821313e-3, -2.37091120e-6);
        for height_m in [0.0, 5000.0, 12_000.0, 20_000.0] {
            let height = GeometricAltitude::meters(height_m);
            let r = WGS84_SEMI_MAJOR_AXIS_M + height_m;
            let s = (WGS84_SEMI_MAJOR_AXIS_M / r).powi(2);
            let equator = WGS84_GRAVITATIONAL_CONSTANT_M3_S2 / (r * r)
                * (1.0 + 1.5 * j2 * s - 15.0 / 8.0 * j4 * s * s)
                - EARTH_ROTATION_RATE_RAD_S.powi(2) * r;
            let r = WGS84_SEMI_MINOR_AXIS_M + height_m;
            let s = (WGS84_SEMI_MAJOR_AXIS_M / r).powi(2);
            let pole = WGS84_GRAVITATIONAL_CONSTANT_M3_S2 / (r * r)
                * (1.0 - 3.0 * j2 * s - 5.0 * j4 * s * s);
            // J6 and beyond: 5e-8; the third order of the height: 1.2e-7 at 20 km.
            let ours = m_s2(gravity(Angle::degrees(0.0), height));
            assert!((ours / equator - 1.0).abs() < 2e-7, "{height_m} m: {ours} {equator}");
            let ours = m_s2(gravity(Angle::degrees(90.0), height));
            assert!((ours / pole - 1.0).abs() < 2e-7, "{height_m} m: {ours} {pole}");
        }
    }

    #[test]
    fn deficit_at_cruise() {
        // Against g0 at 41 000 ft: −0.66, −0.40, −0.15 % at 0, 45, 80°: first order 1 − 2h/R with R = 6371 km, by hand.
        for (latitude_deg, percent) in [(0.0, -0.66), (45.0, -0.40), (80.0, -0.15)] {
            let ratio = m_s2(gravity(Angle::degrees(latitude_deg), CRUISE)) / STANDARD_GRAVITY_M_S2;
            assert!((100.0 * (ratio - 1.0) - percent).abs() < 0.006, "{latitude_deg}°: {ratio}");
        }
    }

    #[test]
    fn earth_motion_by_hand() {
        // 45°, 240 m/s, 12 497 m. 2Ω V cos φ = 2·7.292115e-5·240·0.7071068 = 0.0247503 m/s².
        // N = 6 388 838 m: 240²/(N + h) = 57 600/6 401 335 = 0.0089981; M = 6 367 382 m: 57 600/6 379 879 = 0.0090284.
        let latitude = Angle::degrees(45.0);
        for (east_m_s, north_m_s, expected_m_s2) in [
            (240.0, 0.0, 0.0247503 + 0.0089981),
            (-240.0, 0.0, -0.0247503 + 0.0089981),
            (0.0, 240.0, 0.0090284),
            (0.0, -240.0, 0.0090284),
            (0.0, 0.0, 0.0),
        ] {
            let ours = m_s2(earth_motion_acceleration(latitude, east_m_s, north_m_s, CRUISE));
            assert!((ours - expected_m_s2).abs() < 1.1e-7, "{east_m_s} {north_m_s}: {ours}");
        }
    }

    #[test]
    fn earth_motion_against_the_surveyors_formula() {
        // Glicken (1962), as airborne gravimetry uses it: 7.503 V cos φ sin χ + 0.004154 V² mGal, V in knots, on a
        // sphere at sea level: the ellipsoid and the height change the second term by less than 0.7 %.
        for (latitude_deg, track_deg, ground_speed_kt) in [
            (0.0, 90.0, 250.0_f64),
            (45.0, 60.0, 450.0),
            (60.0, 270.0, 500.0),
            (-30.0, 200.0, 480.0),
        ] {
            let (sine, cosine) = f64::to_radians(track_deg).sin_cos();
            let latitude = Angle::degrees(latitude_deg);
            let ground_speed_m_s = ground_speed_kt * METERS_PER_SECOND_PER_KNOT;
            let ours_mgal = 1e5
                * m_s2(earth_motion_acceleration(
                    latitude,
                    ground_speed_m_s * sine,
                    ground_speed_m_s * cosine,
                    GeometricAltitude::meters(0.0),
                ));
            let second_mgal = 0.004154 * ground_speed_kt * ground_speed_kt;
            let glicken_mgal =
                7.503 * ground_speed_kt * latitude.to_radians().cos() * sine + second_mgal;
            let tolerance_mgal = 0.007 * second_mgal + 0.2;
            assert!(
                (ours_mgal - glicken_mgal).abs() < tolerance_mgal,
                "{ours_mgal} {glicken_mgal}"
            );
        }
    }

    #[test]
    fn coriolis_parameter_is_published() {
        // 1.0313e-4 1/s at 45°, 1.4584e-4 at the pole: any meteorology text.
        assert!((coriolis_parameter(Angle::degrees(45.0)) - 1.0313e-4).abs() < 5e-9);
        assert!((coriolis_parameter(Angle::degrees(-90.0)) + 1.4584e-4).abs() < 5e-9);
        assert!(coriolis_parameter(Angle::degrees(0.0)).abs() < 1e-30);
    }
}
