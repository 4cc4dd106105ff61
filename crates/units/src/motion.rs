//! Rates, forces, areas, angles.

use crate::convert::{
    METERS_PER_SECOND_PER_FOOT_PER_MINUTE, NEWTONS_PER_POUND_FORCE, RADIANS_PER_DEGREE,
};
use crate::quantity::{additive, quantity};

quantity!(
    /// Vertical speed: rate of pressure altitude unless the argument's name says otherwise.
    VerticalSpeed, "m/s",
    [(meters_per_second, to_meters_per_second, 1.0, "m/s"),
     (feet_per_minute, to_feet_per_minute, METERS_PER_SECOND_PER_FOOT_PER_MINUTE, "ft/min")]
);
quantity!(
    /// Acceleration.
    Acceleration, "m/s²",
    [(meters_per_second_squared, to_meters_per_second_squared, 1.0, "m/s²")]
);
quantity!(
    /// Force: thrust, drag, weight.
    Force, "N",
    [(newtons, to_newtons, 1.0, "newtons"),
     (pounds_force, to_pounds_force, NEWTONS_PER_POUND_FORCE, "pounds-force")]
);
quantity!(
    /// Area, for example of the wing.
    Area, "m²",
    [(square_meters, to_square_meters, 1.0, "m²")]
);
quantity!(
    /// Angle: latitude, heading, roll; the argument's name states which.
    Angle, "rad",
    [(radians, to_radians, 1.0, "radians"), (degrees, to_degrees, RADIANS_PER_DEGREE, "degrees")]
);
additive!(Acceleration, Force, Angle, VerticalSpeed);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_factors() {
        // NIST SP 811: 1 lbf = 4.448 222 N; 100 ft/min = 0.508 m/s.
        assert!((Force::pounds_force(1.0).to_newtons() - 4.448_222).abs() < 1e-6);
        let climb = VerticalSpeed::feet_per_minute(100.0).to_meters_per_second();
        assert!((climb - 0.508).abs() < 1e-12);
        assert!((Angle::degrees(180.0).to_radians() - core::f64::consts::PI).abs() < 1e-15);
    }
}
