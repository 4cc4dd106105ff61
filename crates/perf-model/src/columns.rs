//! The columns of guide and flight points: names with their unit, and limits. Limits that the cruise report also has
//! are taken from there.

use crate::csv_text::Column;

/// A column with its own limits; the reason is in the comment next to it.
const fn column(
    name: &'static str,
    quantity: &'static str,
    unit: &'static str,
    minimum: f64,
    maximum: f64,
) -> Column {
    Column { name, quantity, unit, minimum, maximum }
}

// From a light single to the largest aircraft ever flown (640 t), and in pounds.
pub(crate) const WEIGHT_LB: Column = column("weight_lb", "gross weight", "lb", 500.0, 1_500_000.0);
pub(crate) const MASS_KG: Column = column("mass_kg", "gross mass", "kg", 225.0, 680_000.0);
pub(crate) const PRESSURE_ALTITUDE_FT: Column =
    column("pressure_altitude_ft", "pressure altitude", "ft", -2000.0, 60_000.0);
pub(crate) const TRUE_AIRSPEED_KT: Column =
    column("true_airspeed_kt", "true airspeed", "kt", 50.0, 1000.0);
pub(crate) const MACH: Column = column("mach", "Mach number", "Mach", MINIMUM_MACH, MAXIMUM_MACH);
// All engines: four times the report's limit for one engine. Zero is not cruise.
pub(crate) const FUEL_FLOW_LB_H: Column =
    column("fuel_flow_lb_h", "total fuel flow", "lb/h", 1.0, 400_000.0);
pub(crate) const FUEL_FLOW_KG_H: Column =
    column("fuel_flow_kg_h", "total fuel flow", "kg/h", 0.5, 181_000.0);
// As the cruise report's limit for one engine, and a single engine's smallest.
pub(crate) const FUEL_FLOW_PER_ENGINE_LB_H: Column =
    column("fuel_flow_per_engine_lb_h", "fuel flow per engine", "lb/h", 1.0, 100_000.0);
pub(crate) const FUEL_FLOW_PER_ENGINE_KG_H: Column =
    column("fuel_flow_per_engine_kg_h", "fuel flow per engine", "kg/h", 0.5, 45_000.0);
// Hundreds of feet.
pub(crate) const FLIGHT_LEVEL: Column =
    column("flight_level", "pressure altitude", "flight level", -20.0, 600.0);
// Wider than any certified envelope (about ±40 K); a column of absolute temperatures is still detected.
pub(crate) const ISA_DEVIATION_C: Column =
    column("isa_deviation_c", "deviation from the ISA", "°C", -50.0, 50.0);
pub(crate) const CG_PERCENT_MAC: Column =
    column("cg_percent_mac", "center of gravity", "%MAC", -50.0, 150.0);
pub(crate) const LATITUDE_DEG: Column = column("latitude_deg", "latitude", "deg", -90.0, 90.0);
pub(crate) const TRUE_HEADING_DEG: Column =
    column("true_heading_deg", "true heading", "deg", -360.0, 360.0);
pub(crate) const ANTI_ICE: Column = column("anti_ice", "anti-ice bleed", "-", 0.0, 1.0);
/// Not a number: read by its own function.
pub(crate) const DATE: Column = column("date", "date", "-", 0.0, 0.0);

/// Smallest Mach number, as in the cruise report.
pub(crate) const MINIMUM_MACH: f64 = 0.1;
/// Largest Mach number, as in the cruise report.
pub(crate) const MAXIMUM_MACH: f64 = 0.99;

#[cfg(test)]
mod tests {
    use flight::column::Column as ReportColumn;
    use units::convert::{METERS_PER_FOOT, METERS_PER_SECOND_PER_KNOT};

    use super::*;

    #[test]
    fn limits_are_those_of_the_cruise_report() {
        for (ours, report, factor) in [
            (PRESSURE_ALTITUDE_FT, ReportColumn::PressureAltitude, METERS_PER_FOOT),
            (TRUE_AIRSPEED_KT, ReportColumn::TrueAirspeed, METERS_PER_SECOND_PER_KNOT),
            (MACH, ReportColumn::Mach, 1.0),
            (CG_PERCENT_MAC, ReportColumn::CenterOfGravity, 1.0),
            (LATITUDE_DEG, ReportColumn::Latitude, 1.0),
            (TRUE_HEADING_DEG, ReportColumn::TrueHeading, 1.0),
            (ANTI_ICE, ReportColumn::AntiIce, 1.0),
        ] {
            let range = report.range();
            assert_eq!(range.minimum, Some(ours.minimum * factor), "{}", ours.name);
            assert_eq!(range.maximum, Some(ours.maximum * factor), "{}", ours.name);
        }
    }

    /// A flight level is a hundred feet of pressure altitude, below sea level too.
    #[test]
    #[expect(clippy::float_cmp, reason = "whole numbers are exact")]
    fn flight_levels_are_hundreds_of_feet() {
        assert_eq!(100.0 * FLIGHT_LEVEL.minimum, PRESSURE_ALTITUDE_FT.minimum);
        assert_eq!(100.0 * FLIGHT_LEVEL.maximum, PRESSURE_ALTITUDE_FT.maximum);
    }
}
