//! One aircraft type: the checked content of the aircraft file.

use std::sync::Arc;

use lut::surface::Basis;
use lut::{AxisError, Grid};
use serde::{Deserialize, Serialize};
use units::{Area, Mach, OutOfDomain};

use crate::tsfc::TsfcLaw;

mod file;
mod limits;
mod sensors;

pub use file::{AircraftFile, AxisFile, TableFile, TsfcFile};
pub use sensors::{AirDataDrift, FlightBias, FuelFlowDrift, MassDeviation, SensorDeviations};

/// One aircraft type. Every number is within its limits, and the table's grid is built.
///
/// Reads and writes as an [`AircraftFile`], alone or as a part of a larger file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "AircraftFile", into = "AircraftFile")]
pub struct Aircraft {
    file: AircraftFile,
    grid: Arc<Grid>,
}

/// Why text or numbers do not make a valid aircraft.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AircraftError {
    /// The text is not a valid aircraft file: syntax, an unknown or missing field, a number out of its limits.
    #[error("line {line}, column {column}: {reason}")]
    File {
        /// Line from 1.
        line: usize,
        /// Column from 1: where reading stopped, that is just after a value that is out of its limits.
        column: usize,
        /// What is wrong at that position.
        reason: Box<ron::Error>,
    },
    /// A number out of its limits.
    #[error(transparent)]
    OutOfDomain(#[from] OutOfDomain),
    /// No engine, or more than a report can have.
    #[error("{found} engines, expected 1 to {maximum}")]
    Engines {
        /// Engines found.
        found: u8,
        /// Largest number.
        maximum: usize,
    },
    /// A text that is empty, or begins or ends with a blank.
    #[error("{field} is empty or has blanks around it")]
    Text {
        /// The field.
        field: &'static str,
    },
    /// Breakpoints that do not make an axis.
    #[error("table axis of {axis}: {source}")]
    Axis {
        /// The axis.
        axis: &'static str,
        /// The reason.
        source: AxisError,
    },
    /// An axis with more breakpoints than a table may have.
    #[error("table axis of {axis}: {breakpoints} breakpoints, at most {maximum} are admitted")]
    AxisTooLong {
        /// The axis.
        axis: &'static str,
        /// Breakpoints found.
        breakpoints: usize,
        /// Largest number.
        maximum: usize,
    },
}

impl Aircraft {
    /// Checks the content of an aircraft file and builds the table's grid.
    ///
    /// # Errors
    /// [`AircraftError`] for the first value out of its limits.
    pub fn new(file: AircraftFile) -> Result<Self, AircraftError> {
        file::check_text("name", &file.name)?;
        file::check_text("type_code", &file.type_code)?;
        file::check_engines(file.engines)?;
        limits::wing_area_m2::check(file.wing_area_m2)?;
        limits::static_lb_per_lbf_h::check(file.tsfc.static_lb_per_lbf_h)?;
        limits::mach_exponent::check(file.tsfc.mach_exponent)?;
        file.mean_aerodynamic_chord_m.map(limits::mean_aerodynamic_chord_m::check).transpose()?;
        file.drag_divergence_mach.map(limits::drag_divergence_mach::check).transpose()?;
        file.reference_lhv_mj_kg.map(limits::reference_lhv_mj_kg::check).transpose()?;
        file.table_uncertainty_percent.map(limits::table_uncertainty_percent::check).transpose()?;
        file.sensors.check()?;
        let grid = Grid::new(file.table.lift_coefficient_axis()?, file.table.mach_axis()?);
        Ok(Self { file, grid: Arc::new(grid) })
    }

    /// Reads an aircraft file.
    ///
    /// ```
    /// let aircraft = perf_model::Aircraft::from_ron(
    ///     r#"(
    ///         name: "Cessna Citation X",
    ///         type_code: "C750",
    ///         engines: 2,
    ///         wing_area_m2: 48.96,
    ///         tsfc: (static_lb_per_lbf_h: 0.405, mach_exponent: 1.05),
    ///         table: (lift_coefficient: (0.10, 0.70, 0.05), mach: (0.50, 0.95, 0.05)),
    ///     )"#,
    /// )?;
    /// assert_eq!(aircraft.grid().nodes(), 13 * 10);
    /// # Ok::<(), perf_model::AircraftError>(())
    /// ```
    ///
    /// # Errors
    /// [`AircraftError::File`] with line and column.
    pub fn from_ron(text: &str) -> Result<Self, AircraftError> {
        let file: AircraftFile = ron::from_str(text).map_err(|error| AircraftError::File {
            line: error.span.end.line,
            column: error.span.end.col,
            reason: Box::new(error.code),
        })?;
        Self::new(file)
    }

    /// The same aircraft with other standard deviations of its sensors, as the entry `sensors` of an aircraft file states
    /// them.
    ///
    /// # Errors
    /// [`AircraftError`] for a text that is no such entry, or a value out of its limits.
    pub fn with_sensors_ron(&self, text: &str) -> Result<Self, AircraftError> {
        let sensors = ron::from_str(text).map_err(|error| AircraftError::File {
            line: error.span.end.line,
            column: error.span.end.col,
            reason: Box::new(error.code),
        })?;
        Self::new(AircraftFile { sensors, ..self.file.clone() })
    }

    /// Writes the aircraft file; reading it back gives the same bits in every number. Defaults are written out.
    ///
    /// # Errors
    /// What the writer of RON refuses; a checked aircraft holds nothing of the kind.
    pub fn to_ron(&self) -> Result<String, ron::Error> {
        let mut text = ron::ser::to_string_pretty(&self.file, ron::ser::PrettyConfig::new())?;
        text.push('\n');
        Ok(text)
    }

    /// The content of the aircraft file.
    #[must_use]
    pub const fn file(&self) -> &AircraftFile {
        &self.file
    }

    /// Name for display.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.file.name
    }

    /// The value of `AIRCRAFT` in the type's reports.
    #[must_use]
    pub fn type_code(&self) -> &str {
        &self.file.type_code
    }

    /// Number of engines, 1 to 4.
    #[must_use]
    pub fn engines(&self) -> usize {
        usize::from(self.file.engines)
    }

    /// Wing area that the coefficients refer to.
    #[must_use]
    pub const fn wing_area(&self) -> Area {
        Area::square_meters(self.file.wing_area_m2)
    }

    /// The TSFC law.
    #[must_use]
    pub const fn tsfc_law(&self) -> TsfcLaw {
        TsfcLaw {
            static_tsfc: units::Tsfc::pounds_per_pound_force_hour(
                self.file.tsfc.static_lb_per_lbf_h,
            ),
            mach_exponent: self.file.tsfc.mach_exponent,
        }
    }

    /// The table's grid: lift coefficient outer, Mach number inner.
    #[must_use]
    pub const fn grid(&self) -> &Arc<Grid> {
        &self.grid
    }

    /// The polynomial that is fitted to the guide and to the table.
    #[must_use]
    pub const fn polynomial(&self) -> Basis {
        self.file.polynomial
    }

    /// Mean aerodynamic chord, m, where the file states it.
    #[must_use]
    pub const fn mean_aerodynamic_chord_m(&self) -> Option<f64> {
        self.file.mean_aerodynamic_chord_m
    }

    /// Drag-divergence Mach number at lift coefficient 0.35, where the file states it.
    #[must_use]
    pub fn drag_divergence_mach(&self) -> Option<Mach> {
        self.file.drag_divergence_mach.map(Mach::new)
    }

    /// Lower heating value that the guide's fuel flows are for, MJ/kg, where the file states it.
    #[must_use]
    pub const fn reference_lower_heating_value_mj_kg(&self) -> Option<f64> {
        self.file.reference_lhv_mj_kg
    }

    /// How far the drag of the guide may be off before anything is learnt, % of drag, where the file states it; 0 states that
    /// the table is exact.
    #[must_use]
    pub const fn table_uncertainty_percent(&self) -> Option<f64> {
        self.file.table_uncertainty_percent
    }

    /// Standard deviations of what is recorded.
    #[must_use]
    pub const fn sensors(&self) -> &SensorDeviations {
        &self.file.sensors
    }
}

impl TryFrom<AircraftFile> for Aircraft {
    type Error = AircraftError;
    fn try_from(file: AircraftFile) -> Result<Self, AircraftError> {
        Self::new(file)
    }
}

impl From<Aircraft> for AircraftFile {
    fn from(aircraft: Aircraft) -> Self {
        aircraft.file
    }
}

#[cfg(test)]
mod tests;
