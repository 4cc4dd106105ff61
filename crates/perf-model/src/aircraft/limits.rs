//! Limits of the numbers in the aircraft file: each bound once, for reading text and for building in code.
//!
//! A bound is checked while the text is read, so that the error knows its position.

use core::fmt::Display;

use ron::value::RawValue;
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer, Serializer};

/// A number with its bounds: `check` for code, `deserialize` for text, `deserialize_optional` for an optional field.
macro_rules! bounded {
    ($name:ident, $quantity:literal, $unit:literal, $minimum:expr, $maximum:expr) => {
        pub(in crate::aircraft) mod $name {
            use serde::{Deserialize, Deserializer, de::Error};
            use units::{OutOfDomain, check_within};

            pub(in crate::aircraft) fn check(value: f64) -> Result<f64, OutOfDomain> {
                check_within($quantity, $unit, value, $minimum, $maximum)
            }

            #[allow(dead_code, reason = "a field is optional or not")]
            pub(in crate::aircraft) fn deserialize<'de, D: Deserializer<'de>>(
                deserializer: D,
            ) -> Result<f64, D::Error> {
                check(f64::deserialize(deserializer)?).map_err(D::Error::custom)
            }

            #[allow(dead_code, reason = "a field is optional or not")]
            pub(in crate::aircraft) fn deserialize_optional<'de, D: Deserializer<'de>>(
                deserializer: D,
            ) -> Result<Option<f64>, D::Error> {
                super::optional(deserializer)?.map(check).transpose().map_err(D::Error::custom)
            }
        }
    };
}

// Largest wing ever flown is 905 m² (An-225).
bounded!(wing_area_m2, "wing area", "m²", 1.0, 2000.0);
// Turbojets reach about 1.2 without reheat; today's fans about 0.3.
bounded!(static_lb_per_lbf_h, "static TSFC", "lb/(lbf h)", 0.05, 3.0);
bounded!(mach_exponent, "TSFC Mach exponent", "-", -2.0, 4.0);
bounded!(mean_aerodynamic_chord_m, "mean aerodynamic chord", "m", 0.1, 30.0);
bounded!(drag_divergence_mach, "drag-divergence Mach number", "Mach", 0.4, 1.0);
// Kerosene is 42.8 to 43.5.
bounded!(reference_lhv_mj_kg, "reference lower heating value", "MJ/kg", 35.0, 50.0);
bounded!(table_uncertainty_percent, "uncertainty of the drag table", "%", 0.0, 50.0);

// Standard deviations. Two are divided by and may not be zero: fuel flow and N2.
bounded!(fuel_flow_percent, "standard deviation of fuel flow", "%", 0.001, 20.0);
bounded!(mach, "standard deviation of Mach number", "Mach", 0.0, 0.05);
bounded!(static_air_temperature_k, "standard deviation of SAT", "K", 0.0, 20.0);
bounded!(acceleration_m_s2, "standard deviation of acceleration", "m/s²", 0.0, 0.1);
bounded!(mass_percent, "standard deviation of mass", "%", 0.0, 20.0);
bounded!(mass_kg, "standard deviation of mass", "kg", 0.0, 50_000.0);
bounded!(lower_heating_value_percent, "standard deviation of heating value", "%", 0.0, 10.0);
bounded!(n2_percent, "standard deviation of N2", "%", 0.001, 10.0);
bounded!(n2_flight_bias_percent, "per-flight bias of N2", "%", 0.0, 10.0);
bounded!(fuel_flow_drift_percent, "drift of fuel flow", "%", 0.0, 20.0);
bounded!(drifting_share, "share of the air data's variance that drifts", "-", 0.0, 1.0);
bounded!(drift_time_s, "correlation time of the drift", "s", 1.0, 1e6);
bounded!(pressure_altitude_m, "standard deviation of pressure altitude", "m", 0.0, 500.0);

/// Limits of the table's lift-coefficient axis.
pub(super) const TABLE_LIFT_COEFFICIENT: (f64, f64) = (0.0, 3.0);
/// Limits of the table's Mach axis.
pub(super) const TABLE_MACH: (f64, f64) = (0.05, 1.2);
/// Longest axis: 1000 × 1000 nodes are more than any fleet can inform, and still fit into memory.
pub(super) const MAXIMUM_BREAKPOINTS: usize = 1000;

/// An optional number, written plainly or as `Some(…)`.
pub(super) fn optional<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<f64>, D::Error> {
    let raw = Box::<RawValue>::deserialize(deserializer)?;
    let text = without_leading_comments(raw.get_ron());
    if text.starts_with("Some") || text.starts_with("None") {
        from_text(text)
    } else {
        from_text(text).map(Some)
    }
}

/// Writes an optional number plainly. Absent ones are skipped before this is called.
#[expect(clippy::ref_option, reason = "the signature that serde calls")]
pub(super) fn serialize_optional<S: Serializer>(
    value: &Option<f64>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match value {
        Some(number) => serializer.serialize_f64(*number),
        None => serializer.serialize_none(),
    }
}

/// A piece of RON text as a value; its own error position is dropped because the outer reader knows a better one.
pub(super) fn from_text<T: DeserializeOwned, E: Error>(text: &str) -> Result<T, E> {
    ron::from_str(text).map_err(|error| custom(error.code))
}

/// RON text from its first character that is neither blank nor comment. The rest may still end in comments.
///
/// `RawValue::trim` does the same but panics on text that it cannot read again.
pub(super) fn without_leading_comments(text: &str) -> &str {
    let mut rest = text.trim_start();
    loop {
        if let Some(comment) = rest.strip_prefix("//") {
            rest = comment.split_once('\n').map_or("", |(_, after)| after).trim_start();
        } else if let Some(comment) = rest.strip_prefix("/*") {
            rest = after_block_comment(comment).trim_start();
        } else {
            return rest;
        }
    }
}

/// What follows a block comment whose opening has been read; block comments nest in RON.
fn after_block_comment(mut rest: &str) -> &str {
    let mut depth = 1_usize;
    while depth > 0 {
        let Some(at) = rest.find(['*', '/']) else { return "" };
        let pair = rest.get(at..at + 2);
        depth = match pair {
            Some("*/") => depth - 1,
            Some("/*") => depth + 1,
            _ => depth,
        };
        let length = if matches!(pair, Some("*/" | "/*")) { 2 } else { 1 };
        rest = &rest[at + length..];
    }
    rest
}

fn custom<E: Error>(message: impl Display) -> E {
    E::custom(message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leading_comments_are_skipped() {
        for (text, rest) in [
            ("(1, 2)", "(1, 2)"),
            (" \n// a [comment]\n // another\n [1]", "[1]"),
            ("/* a /* nested [ */ comment ** / */ [1] /* after */", "[1] /* after */"),
            ("/* open", ""),
            ("// to the end", ""),
            ("/*é*/Some(1)", "Some(1)"),
        ] {
            assert_eq!(without_leading_comments(text), rest);
        }
    }
}
