//! Conversion factors to SI, each once, with its source.

/// Meters in a foot. International yard and pound agreement, 1959 (exact).
pub const METERS_PER_FOOT: f64 = 0.3048;
/// Meters in a nautical mile. International hydrographic conference, 1929 (exact).
pub const METERS_PER_NAUTICAL_MILE: f64 = 1852.0;
/// Meters per second in a knot (exact by definition: one nautical mile per hour).
pub const METERS_PER_SECOND_PER_KNOT: f64 = METERS_PER_NAUTICAL_MILE / 3600.0;
/// Meters per second in a foot per minute.
pub const METERS_PER_SECOND_PER_FOOT_PER_MINUTE: f64 = METERS_PER_FOOT / 60.0;
/// Kilograms in a pound. International yard and pound agreement, 1959 (exact).
pub const KILOGRAMS_PER_POUND: f64 = 0.45359237;
/// Standard acceleration of gravity, m/s². CGPM 1901; ISO 2533 table 1 (exact).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.80665;
/// Newtons in a pound-force: a pound under standard gravity.
pub const NEWTONS_PER_POUND_FORCE: f64 = KILOGRAMS_PER_POUND * STANDARD_GRAVITY_M_S2;
/// Kilograms per second in a pound per hour.
pub const KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR: f64 = KILOGRAMS_PER_POUND / 3600.0;
/// Kilograms per second in a kilogram per hour.
pub const KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR: f64 = 1.0 / 3600.0;
/// kg/(N s) in lb/(lbf h): the pounds cancel; one standard gravity and one hour remain.
pub const TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR: f64 = 1.0 / (3600.0 * STANDARD_GRAVITY_M_S2);
/// Kelvin at 0 °C. ITS-90 (exact).
pub const KELVIN_AT_ZERO_CELSIUS: f64 = 273.15;
/// Radians in a degree.
pub const RADIANS_PER_DEGREE: f64 = core::f64::consts::PI / 180.0;
/// Seconds in a day.
pub const SECONDS_PER_DAY: f64 = 86_400.0;
/// Days in a Julian year (IAU), the year of all ageing rates.
pub const DAYS_PER_YEAR: f64 = 365.25;
