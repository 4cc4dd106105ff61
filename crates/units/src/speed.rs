//! Speeds: each kind has its own type, because all are in meters per second.

use crate::convert::METERS_PER_SECOND_PER_KNOT;
use crate::quantity::{additive, quantity};

quantity!(
    /// True airspeed (TAS): speed through the air.
    TrueAirspeed, "m/s",
    [(meters_per_second, to_meters_per_second, 1.0, "m/s"),
     (knots, to_knots, METERS_PER_SECOND_PER_KNOT, "knots")]
);
quantity!(
    /// Calibrated airspeed (CAS): the airspeed that has this impact pressure at sea level of the standard day.
    CalibratedAirspeed, "m/s",
    [(meters_per_second, to_meters_per_second, 1.0, "m/s"),
     (knots, to_knots, METERS_PER_SECOND_PER_KNOT, "knots")]
);
quantity!(
    /// Equivalent airspeed (EAS): the airspeed that has this dynamic pressure at sea level of the standard day.
    EquivalentAirspeed, "m/s",
    [(meters_per_second, to_meters_per_second, 1.0, "m/s"),
     (knots, to_knots, METERS_PER_SECOND_PER_KNOT, "knots")]
);
quantity!(
    /// Ground speed: speed over the ground; along-path acceleration is derived from it.
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
    /// Mach number: true airspeed divided by speed of sound.
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
