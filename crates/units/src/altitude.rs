//! Altitudes: two kinds that do not compare.

use crate::convert::METERS_PER_FOOT;
use crate::quantity::quantity;

quantity!(
    /// Pressure altitude: where in the ISA the static pressure occurs (1013.25 hPa datum). Not a height above ground.
    PressureAltitude, "m",
    [(meters, to_meters, 1.0, "meters"), (feet, to_feet, METERS_PER_FOOT, "feet")]
);
quantity!(
    /// Geometric altitude above mean sea level, as gravity sees it.
    GeometricAltitude, "m",
    [(meters, to_meters, 1.0, "meters"), (feet, to_feet, METERS_PER_FOOT, "feet")]
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flight_level_390_in_meters() {
        // 39 000 ft × 0.3048 m/ft (exact definition of the foot).
        assert!((PressureAltitude::feet(39_000.0).to_meters() - 11_887.2).abs() < 1e-9);
    }
}
