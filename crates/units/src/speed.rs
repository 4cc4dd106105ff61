//! Speeds: every kind its own type, for all are meters per second.

use crate::convert::METERS_PER_SECOND_PER_KNOT;
use crate::quantity::{additive, quantity};

quantity!(
    /// True airspeed (TAS): speed through the air.
    TrueAirspeed, "m/s",
    [(meters_per_second, to_meters_per_second, 1.0, "m/s"),
     (knots, to_knots, METERS_PER_SECOND_PER_KNOT, "knots")]
);
quantity!(
    /// Calibrated airspeed (CAS): what the impact pressure means at sea level.
    CalibratedAirspeed, "m/s",
    [(meters_per_second, to_meters_per_second, 1.0, "m/s"),
     (knots, to_knots, METERS_PER_SECOND_PER_KNOT, "knots")]
);
quantity!(
    /// Equivalent airspeed (EAS): what the dynamic pressure means at sea level.
    EquivalentAirspeed, "m/s",
    [(meters_per_second, to_meters_per_second, 1.0, "m/s"),
     (knots, to_knots, METERS_PER_SECOND_PER_KNOT, "knots")]
);
quantity!(
    /// Ground speed: speed over the ground, what along-path acceleration is taken from.
    GroundSpeed, "m/s",
    [(meters_per_second, to_meters_per_second, 1.0, "m/s"),
     (knots, to_knots, METERS_PER_SECOND_PER_KNOT, "knots")]
);
quantity!(
    /// Speed of sound.
    SpeedOfSound, "m/s",
    [(meters_per_second, to_meters_per_second, 1.0, "m/s"),
     (knots, to_knots, METERS_PER_SECOND_PER_KNOT, "knots")]
);
quantity!(
    /// Mach number: true airspeed over speed of sound.
    Mach, "Mach",
    [(new, value, 1.0, "the ratio itself")]
);
additive!(TrueAirspeed, CalibratedAirspeed, EquivalentAirspeed, GroundSpeed);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_knot_is_a_nautical_mile_an_hour() {
        let speed = TrueAirspeed::knots(3600.0);
        assert!((speed.to_meters_per_second() - 1852.0).abs() < 1e-9);
        assert!((speed.to_knots() - 3600.0).abs() < 1e-9);
    }
}
