//! The mapping file as it is written: RON into plain data; only the form is checked.

use core::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};

/// The only version of the mapping file.
pub(super) const FORMAT: u32 = 1;

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Mapping")]
pub(super) struct MappingFile {
    pub(super) format: u32,
    #[serde(default = "comma")]
    pub(super) separator: char,
    #[serde(default)]
    pub(super) comment: Option<char>,
    #[serde(default)]
    pub(super) not_available: Vec<String>,
    pub(super) aircraft: TextSource,
    pub(super) tail: TextSource,
    pub(super) flight: TextSource,
    #[serde(default)]
    pub(super) lower_heating_value_mj_kg: Option<f64>,
    #[serde(default)]
    pub(super) notes: Vec<(String, String)>,
    pub(super) time: TimeSource,
    pub(super) mass: MassSource,
    pub(super) quantities: Quantities,
    #[serde(default)]
    pub(super) out_of_range: OutOfRange,
    #[serde(default)]
    pub(super) cruise: Option<CruiseFile>,
}

/// What happens to a row with a recorded number outside its column's range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub(super) enum OutOfRange {
    /// The recording is refused, as a report is.
    #[default]
    Refuse,
    /// The row is left out and counted.
    LeaveRowOut,
}

/// The source of a text of the header.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) enum TextSource {
    /// The same in every file.
    Text(String),
    /// A column of the recording; where it changes, another recording begins.
    Column(String),
    /// The name of the file, which the caller knows.
    FileName,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum TimeSource {
    /// ISO text; `utc_offset` where the text has none.
    Timestamp {
        column: String,
        #[serde(default)]
        utc_offset: Option<String>,
    },
    /// Seconds since `start`.
    Seconds { column: String, start: String },
}

/// A number and its unit.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) struct WithUnit(pub(super) f64, pub(super) String);

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum MassSource {
    /// Gross mass, from whose fall fuel used is derived.
    GrossMass {
        column: String,
        unit: String,
        #[serde(default = "one")]
        scale: f64,
        #[serde(default)]
        zero_fuel_weight: Option<WithUnit>,
        largest_rise_kg: f64,
    },
    /// Fuel used since engine start, together with a load sheet.
    FuelUsed {
        column: String,
        unit: String,
        #[serde(default = "one")]
        scale: f64,
        zero_fuel_weight: WithUnit,
        fuel_on_board: WithUnit,
    },
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum QuantitySource {
    /// A column, in a unit of the report's format, times `scale`.
    Recorded {
        column: String,
        unit: String,
        #[serde(default = "one")]
        scale: f64,
    },
    /// The angle between two columns, −180 … 180°.
    Difference { column: String, minus: String, unit: String },
    /// Mach number from calibrated airspeed and pressure altitude.
    FromCalibratedAirspeed {
        column: String,
        unit: String,
        #[serde(default = "one")]
        scale: f64,
    },
    /// Mach number from true airspeed and static air temperature.
    FromTrueAirspeed,
    /// True airspeed from Mach number and static air temperature.
    FromMach,
    /// Static air temperature from total air temperature and Mach number.
    FromTotalTemperature { recovery_factor: f64 },
    /// Static air temperature of the ISA plus a deviation.
    Isa { deviation_k: f64 },
}

impl QuantitySource {
    pub(super) const fn name(&self) -> &'static str {
        match self {
            Self::Recorded { .. } => "Recorded",
            Self::Difference { .. } => "Difference",
            Self::FromCalibratedAirspeed { .. } => "FromCalibratedAirspeed",
            Self::FromTrueAirspeed => "FromTrueAirspeed",
            Self::FromMach => "FromMach",
            Self::FromTotalTemperature { .. } => "FromTotalTemperature",
            Self::Isa { .. } => "Isa",
        }
    }
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CruiseFile {
    pub(super) minimum_pressure_altitude_ft: f64,
    pub(super) band_ft: f64,
    pub(super) minimum_duration_s: f64,
    pub(super) trim_s: f64,
}

/// A RON map by name that refuses a repeated name; `BTreeMap` would silently keep the last.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Quantities(pub(super) Vec<(String, QuantitySource)>);

impl<'de> Deserialize<'de> for Quantities {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(QuantitiesVisitor)
    }
}

struct QuantitiesVisitor;

impl<'de> Visitor<'de> for QuantitiesVisitor {
    type Value = Quantities;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map from the names of report columns to where they come from")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Quantities, A::Error> {
        let mut quantities: Vec<(String, QuantitySource)> = Vec::new();
        while let Some((name, source)) = map.next_entry::<String, QuantitySource>()? {
            if quantities.iter().any(|(other, _)| *other == name) {
                return Err(serde::de::Error::custom(format_args!("{name} appears twice")));
            }
            quantities.push((name, source));
        }
        Ok(Quantities(quantities))
    }
}

const fn comma() -> char {
    ','
}

const fn one() -> f64 {
    1.0
}
