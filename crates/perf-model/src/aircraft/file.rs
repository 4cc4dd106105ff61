//! The aircraft file as it is written: plain data, every number checked where it is read.

use lut::surface::Basis;
use lut::{Axis, AxisError};
use ron::value::RawValue;
use serde::de::Error;
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::limits::{self, MAXIMUM_BREAKPOINTS, TABLE_LIFT_COEFFICIENT, TABLE_MACH};
use super::{AircraftError, SensorDeviations};

/// The content of an aircraft file. [`Aircraft::new`](super::Aircraft::new) checks it and makes the aircraft.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Aircraft", deny_unknown_fields)]
pub struct AircraftFile {
    /// Name for display ("Cessna Citation X").
    #[serde(deserialize_with = "name")]
    pub name: String,
    /// The value of `AIRCRAFT` in the type's cruise reports ("C750").
    #[serde(deserialize_with = "type_code")]
    pub type_code: String,
    /// Number of engines, 1 to 4.
    #[serde(deserialize_with = "engines")]
    pub engines: u8,
    /// Wing area that the coefficients refer to, m².
    #[serde(deserialize_with = "limits::wing_area_m2::deserialize")]
    pub wing_area_m2: f64,
    /// The TSFC law.
    pub tsfc: TsfcFile,
    /// The look-up table's axes.
    pub table: TableFile,
    /// The polynomial that is fitted to the guide; the first basis where the file states none.
    #[serde(default = "separable")]
    pub polynomial: Basis,
    /// Mean aerodynamic chord, m.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "limits::mean_aerodynamic_chord_m::deserialize_optional",
        serialize_with = "limits::serialize_optional"
    )]
    pub mean_aerodynamic_chord_m: Option<f64>,
    /// Drag-divergence Mach number at lift coefficient 0.35.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "limits::drag_divergence_mach::deserialize_optional",
        serialize_with = "limits::serialize_optional"
    )]
    pub drag_divergence_mach: Option<f64>,
    /// Lower heating value that the guide's fuel flows are for, MJ/kg.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "limits::reference_lhv_mj_kg::deserialize_optional",
        serialize_with = "limits::serialize_optional"
    )]
    pub reference_lhv_mj_kg: Option<f64>,
    /// How far the drag of the guide may be off before anything is learnt, % of drag; 0 states that the table is exact. Law
    /// `bayes`' own prior where the file states none.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "limits::table_uncertainty_percent::deserialize_optional",
        serialize_with = "limits::serialize_optional"
    )]
    pub table_uncertainty_percent: Option<f64>,
    /// Standard deviations of what is recorded.
    #[serde(default)]
    pub sensors: SensorDeviations,
}

/// The constants of the TSFC law `[forces.5]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TsfcFile {
    /// Static TSFC at sea level of the standard day, lb/(lbf h).
    #[serde(deserialize_with = "limits::static_lb_per_lbf_h::deserialize")]
    pub static_lb_per_lbf_h: f64,
    /// Exponent of 1 + M.
    #[serde(deserialize_with = "limits::mach_exponent::deserialize")]
    pub mach_exponent: f64,
}

/// The axes of the look-up table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableFile {
    /// Lift coefficients.
    #[serde(deserialize_with = "lift_coefficient_axis")]
    pub lift_coefficient: AxisFile,
    /// Mach numbers.
    #[serde(deserialize_with = "mach_axis")]
    pub mach: AxisFile,
}

/// An axis as it is written: `(from, to, step)` or `[breakpoint, breakpoint, …]`.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisFile {
    /// Evenly spaced: from, to, step. Breakpoints are the doubles nearest to their decimals.
    Step {
        /// First breakpoint.
        from: f64,
        /// Last breakpoint.
        to: f64,
        /// Distance between neighbors.
        step: f64,
    },
    /// Breakpoint by breakpoint.
    Breakpoints(Vec<f64>),
}

impl TableFile {
    pub(super) fn lift_coefficient_axis(&self) -> Result<Axis, AircraftError> {
        self.lift_coefficient.checked("lift coefficient", TABLE_LIFT_COEFFICIENT)
    }

    pub(super) fn mach_axis(&self) -> Result<Axis, AircraftError> {
        self.mach.checked("Mach number", TABLE_MACH)
    }
}

impl AxisFile {
    fn axis(&self) -> Result<Axis, AxisError> {
        match self {
            Self::Step { from, to, step } => Axis::from_step(*from, *to, *step),
            Self::Breakpoints(breakpoints) => Axis::new(breakpoints.clone()),
        }
    }

    fn checked(
        &self,
        quantity: &'static str,
        (minimum, maximum): (f64, f64),
    ) -> Result<Axis, AircraftError> {
        let axis = self.axis().map_err(|source| AircraftError::Axis { axis: quantity, source })?;
        if axis.len() > MAXIMUM_BREAKPOINTS {
            return Err(AircraftError::AxisTooLong {
                axis: quantity,
                breakpoints: axis.len(),
                maximum: MAXIMUM_BREAKPOINTS,
            });
        }
        for end in [axis.first(), axis.last()] {
            units::check_within(quantity, "-", end, minimum, maximum)?;
        }
        Ok(axis)
    }
}

impl<'de> Deserialize<'de> for AxisFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        // To serde a RON tuple and a RON list are the same sequence: only the text distinguishes them.
        let raw = Box::<RawValue>::deserialize(deserializer)?;
        let text = limits::without_leading_comments(raw.get_ron());
        if text.starts_with('[') {
            return limits::from_text(text).map(Self::Breakpoints);
        }
        let (from, to, step) = limits::from_text(text)?;
        Ok(Self::Step { from, to, step })
    }
}

impl Serialize for AxisFile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Step { from, to, step } => {
                let mut tuple = serializer.serialize_tuple(3)?;
                for number in [from, to, step] {
                    tuple.serialize_element(number)?;
                }
                tuple.end()
            }
            Self::Breakpoints(breakpoints) => breakpoints.serialize(serializer),
        }
    }
}

pub(super) fn check_text(field: &'static str, text: &str) -> Result<(), AircraftError> {
    if text.trim() == text && !text.is_empty() {
        Ok(())
    } else {
        Err(AircraftError::Text { field })
    }
}

pub(super) fn check_engines(engines: u8) -> Result<(), AircraftError> {
    if (1..=flight::MAXIMUM_ENGINES).contains(&usize::from(engines)) {
        Ok(())
    } else {
        Err(AircraftError::Engines { found: engines, maximum: flight::MAXIMUM_ENGINES })
    }
}

fn separable() -> Basis {
    Basis::SeparableQuadratic
}

fn name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let text = String::deserialize(deserializer)?;
    check_text("name", &text).map_err(D::Error::custom)?;
    Ok(text)
}

fn type_code<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let text = String::deserialize(deserializer)?;
    check_text("type_code", &text).map_err(D::Error::custom)?;
    Ok(text)
}

fn engines<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u8, D::Error> {
    let engines = u8::deserialize(deserializer)?;
    check_engines(engines).map_err(D::Error::custom)?;
    Ok(engines)
}

fn lift_coefficient_axis<'de, D: Deserializer<'de>>(deserializer: D) -> Result<AxisFile, D::Error> {
    let axis = AxisFile::deserialize(deserializer)?;
    axis.checked("lift coefficient", TABLE_LIFT_COEFFICIENT).map_err(D::Error::custom)?;
    Ok(axis)
}

fn mach_axis<'de, D: Deserializer<'de>>(deserializer: D) -> Result<AxisFile, D::Error> {
    let axis = AxisFile::deserialize(deserializer)?;
    axis.checked("Mach number", TABLE_MACH).map_err(D::Error::custom)?;
    Ok(axis)
}
