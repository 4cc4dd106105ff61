//! Recordings of other layouts into reports, by a mapping file.
//!
//! A mapping file (RON) states which column of a delimited text holds which quantity in which unit, what is derived,
//! and which parts of the recording are level cruise. `docs/src/guides/mapping.md` describes it.

mod cell_texts;
mod converter;
mod derive;
mod file;
mod first;
mod in_memory;
mod level;
mod numbers;
mod pieces;
mod plan;
mod source;
mod stream;
mod table;

use flight::column::{COLUMN_NAMES, Column};
use units::OutOfDomain;

use crate::cruise_text::Parsed;
use crate::refusal::Refusal;
pub use cell_texts::{date_text, text_runs, time_of_day_text};
pub use converter::Converter;
use derive::Limits;
use file::MappingFile;
pub use first::first_mapping;
pub use in_memory::{Cells, Lines, TableRows};
pub use pieces::{Piece, Pieces};
use plan::Plan;
pub use source::{Batches, Source};
pub use stream::{MappedFlight, MappedPoints, MappedReport, Stream};
use table::Recording;
pub use table::{Batch, BatchColumn, NO_INSTANT, Rows, line_of_names, local_text};

/// A mapping file that was checked.
#[derive(Clone, Debug)]
pub struct Mapping {
    file: MappingFile,
}

/// Why a text is not a mapping file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MappingError {
    /// Not RON, or not of the mapping's form.
    #[error("line {line}, column {column}: {source}")]
    Form {
        /// Line from 1.
        line: usize,
        /// Character from 1.
        column: usize,
        /// The message of the RON reader.
        source: Box<ron::Error>,
    },
    /// A version of the mapping file that this program does not read.
    #[error("mapping file of format {found}, expected format 1")]
    VersionUnknown {
        /// The version.
        found: u32,
    },
    /// A name that is not a quantity of the report; time and fuel used have entries of their own.
    #[error("quantity \"{name}\", expected one of {COLUMN_NAMES}, without TIME and FU{}", Meant(*near))]
    QuantityUnknown {
        /// The name.
        name: String,
        /// The name that is nearest.
        near: Option<&'static str>,
    },
    /// A column without its unit.
    #[error("no unit for {}, expected one of {}", column.name(), unit_names(*column))]
    UnitMissing {
        /// The quantity.
        column: Column,
    },
    /// A value that is both held and interpolated.
    #[error("hold_s and interpolate_s for one column, expected one of them")]
    HeldAndInterpolated,
    /// A required quantity of the report without a source.
    #[error("no source for {}", column.name())]
    QuantityNotMapped {
        /// The quantity.
        column: Column,
    },
    /// A derivation that does not give the quantity.
    #[error("{} cannot be derived by {source_name}", column.name())]
    SourceNotForQuantity {
        /// The quantity.
        column: Column,
        /// The derivation.
        source_name: &'static str,
    },
    /// Mach number, temperature and true airspeed that are derived from each other.
    #[error("MACH, SAT and VTAS are derived from each other")]
    Circular,
    /// Fuel flow both of all engines and engine by engine.
    #[error("WF both of all engines and engine by engine")]
    FuelFlowTwice,
    /// A unit in which the quantity is not read.
    #[error("unit \"{unit}\" for {}, expected one of {}{}", column.name(), unit_names(*column), Meant(*near))]
    UnitUnknown {
        /// The quantity.
        column: Column,
        /// The unit.
        unit: String,
        /// The unit that is nearest.
        near: Option<&'static str>,
    },
    /// An instant, or an offset, that is not RFC 3339.
    #[error("\"{text}\" is not an instant or offset of RFC 3339")]
    InstantMalformed {
        /// The text.
        text: String,
    },
    /// A separator or comment mark that could be part of a number, or is not ASCII.
    #[error("{character:?} cannot separate fields or begin comments")]
    SeparatorUnusable {
        /// The character.
        character: char,
    },
    /// The scatter of a quantity that no trim criterion limits the changes of.
    #[error("scatter of \"{name}\", expected one of ALT MACH GSPD SAT N2(1) N2(2) N2(3) N2(4)")]
    ScatterUnknown {
        /// The name.
        name: String,
    },
    /// An entry that averaged points cannot have.
    #[error("{entry} for averaged points, expected it for samples only")]
    NeedsSamples {
        /// The entry.
        entry: &'static str,
    },
    /// A number outside its limits.
    #[error(transparent)]
    OutOfDomain(#[from] OutOfDomain),
}

/// "; did you mean …?", or nothing.
struct Meant(Option<&'static str>);

impl core::fmt::Display for Meant {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.0.map_or(Ok(()), |name| write!(f, "; did you mean \"{name}\"?"))
    }
}

fn unit_names(column: Column) -> String {
    plan::units_of(column).map(|unit| unit.name).collect::<Vec<_>>().join(" ")
}

/// Time without a row after which another flight may have begun, s: turnarounds take no less. Our choice.
const SHORTEST_GAP_S: f64 = 1200.0;
/// An aircraft that is lower has landed, or is about to, or has just begun to climb. Our choice.
const LOW_M: f64 = 10_000.0 * units::convert::METERS_PER_FOOT;

/// Rows of which one altitude may be out of its range and costs no more than its row. Our choice, as for gross masses.
const ROWS_FOR_ONE_ALTITUDE: u64 = 20;

/// What a first mapping states as aircraft type where no column holds it.
pub const NO_TYPE: &str = "TYPE";

/// Mapping files built into the program: name and text, whose first lines say what it is for and where that is from.
pub const PRESETS: [(&str, &str); 8] = [
    ("traffic-a320", include_str!("../presets/traffic_a320.ron")),
    ("acropole-a320", include_str!("../presets/acropole_a320.ron")),
    ("phlab-c550", include_str!("../presets/phlab_c550.ron")),
    ("flight-data-analyzer", include_str!("../presets/flight_data_analyzer.ron")),
    ("nasa-dashlink", include_str!("../presets/nasa_dashlink.ron")),
    ("opensky-states", include_str!("../presets/opensky_states.ron")),
    ("traffic-tables", include_str!("../presets/traffic_tables.ron")),
    ("cruise-points", include_str!("../presets/cruise_points.ron")),
];

impl Mapping {
    /// Reads a mapping file.
    ///
    /// # Errors
    /// [`MappingError`] when the text is not a mapping file, or does not lead to a report.
    pub fn from_ron(text: &str) -> Result<Self, MappingError> {
        let options = ron::Options::default()
            .with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        let file: MappingFile = options.from_str(text).map_err(|error| MappingError::Form {
            line: error.span.start.line,
            column: error.span.start.col,
            source: Box::new(error.code),
        })?;
        Plan::new(file.clone())?;
        Ok(Self { file })
    }

    /// A built-in mapping, by its name in [`PRESETS`].
    #[must_use]
    pub fn preset(name: &str) -> Option<Self> {
        let (_, text) = PRESETS.iter().find(|(known, _)| *known == name)?;
        Self::from_ron(text).ok()
    }

    /// Whether its rows are averaged points.
    #[must_use]
    pub const fn is_of_points(&self) -> bool {
        matches!(self.file.rows, file::RowsAre::AveragedPoints { .. })
    }

    /// The same mapping for a table that was written as comma-separated text by this program, whatever the separators of
    /// the mapping's own files.
    #[must_use]
    pub fn comma_separated(&self) -> Self {
        let mut mapping = self.clone();
        mapping.file.separator = ',';
        mapping.file.decimal = '.';
        mapping.file.comment = None;
        mapping.file.thousands = None;
        mapping.file.names_line = 1;
        mapping.file.units_row = false;
        mapping
    }

    /// Reads a recording, plain or gzip: one report for each level part of each flight in it.
    ///
    /// # Errors
    /// The first [`Refusal`] in the file; also when no flight in it has a level part.
    pub fn read(&self, bytes: &[u8]) -> Result<Vec<Parsed>, Refusal> {
        self.read_with_name(bytes, None)
    }

    /// The same for a mapping that takes a text of the header from the file's name: `name` is that name without folder
    /// and ending.
    ///
    /// # Errors
    /// As [`Mapping::read`].
    pub fn read_named(&self, bytes: &[u8], file_name: &str) -> Result<Vec<Parsed>, Refusal> {
        self.read_with_name(bytes, Some(file_name))
    }

    fn read_with_name(
        &self,
        bytes: &[u8],
        file_name: Option<&str>,
    ) -> Result<Vec<Parsed>, Refusal> {
        let mut parsed = Vec::new();
        let findings =
            self.each(&mut Source::text(bytes)?, file_name, |report| parsed.push(report))?;
        if let Some(first) = parsed.first_mut() {
            first.findings.extend(findings);
        }
        Ok(parsed)
    }
}

/// The rows that become the report of a recording, part by part, and the duration of the longest level part before any
/// was rejected.
fn parts(plan: &Plan, recording: &Recording) -> (Vec<core::ops::Range<usize>>, f64) {
    let rows = recording.time_s.len();
    let fewest = plan.fewest_rows();
    match &plan.cruise {
        None if rows < fewest => (Vec::new(), 0.0),
        None => (core::iter::once(0..rows).collect(), 0.0),
        Some(criteria) => {
            let altitude = |(column, _): &&(Column, _)| *column == Column::PressureAltitude;
            let conversion = plan.recorded.iter().find(altitude);
            let mut pressure_altitude_m = Vec::with_capacity(rows);
            let limits = Limits::new(Column::PressureAltitude, None);
            let outside = conversion.map_or(0, |(_, conversion)| {
                let is_within = limits.contain();
                conversion.append_to(
                    &mut pressure_altitude_m,
                    &recording.numbers,
                    0..rows,
                    is_within,
                )
            });
            let is_altitude = |row: usize| limits.admit(pressure_altitude_m[row]);
            // Of more it is the column that is wrong, and not its rows.
            let most = rows as u64 / ROWS_FOR_ONE_ALTITUDE;
            if (1..=most).contains(&outside) {
                let kept: Vec<usize> = (0..rows).filter(|row| is_altitude(*row)).collect();
                return level::level_parts_of_rows(
                    &recording.time_s,
                    &pressure_altitude_m,
                    criteria,
                    &kept,
                );
            }
            level::level_parts(&recording.time_s, &pressure_altitude_m, criteria)
        }
    }
}
