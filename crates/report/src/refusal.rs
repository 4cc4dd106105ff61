//! Why a text is refused: where, what was found, what was expected.

use core::fmt;
use std::io;

use flight::ReportDataError;
use flight::column::{COLUMN_NAMES, Column};

/// A refusal with its position. The caller adds the name of the file.
///
/// Lines are physical lines from 1. Columns are characters (Unicode scalar values) from 1 in the physical line; a tab
/// is one character and a byte-order mark is none. Something missing at the end is one character past the end.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}, column {column}: found {found}, expected {kind}{}", self.meant())]
pub struct Refusal {
    /// Physical line from 1.
    pub line: usize,
    /// Character in that line from 1.
    pub column: usize,
    /// The text found there.
    pub found: Found,
    /// What is wrong; displays as what was expected.
    pub kind: RefusalKind,
}

impl Refusal {
    /// "; did you mean MACH?" where a name that is not known is like one that is.
    fn meant(&self) -> String {
        let Found::Text(found) = &self.found else { return String::new() };
        let near = match &self.kind {
            RefusalKind::ColumnUnknown => {
                nearest(found, COLUMN_NAMES.split(' ').map(|name| name.trim_matches(',')))
            }
            RefusalKind::UnitUnknown { column } => {
                nearest(found, column.units().iter().map(|unit| unit.name))
            }
            _ => None,
        };
        near.map_or_else(String::new, |name| format!("; did you mean {name}?"))
    }
}

/// What was found where something else was expected.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Found {
    /// Text as sent, at most 60 characters of it.
    Text(String),
    /// This many fields in a row.
    Fields(usize),
    /// This many units.
    Units(usize),
    /// This many rows.
    Rows(usize),
    /// A byte that no text contains.
    Byte(u8),
    /// The line ended.
    EndOfLine,
    /// The text ended.
    EndOfText,
    /// A number that was computed from what was sent, with its unit.
    Number {
        /// The number.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
}

impl Found {
    /// The text, cut after 60 characters.
    pub(crate) fn text(text: &str) -> Self {
        const KEPT: usize = 60;
        match text.char_indices().nth(KEPT) {
            Some((end, _)) => Self::Text(format!("{}…", &text[..end])),
            None => Self::Text(text.to_owned()),
        }
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => write!(f, "{text:?}"),
            Self::Fields(count) => write!(f, "{count} fields"),
            Self::Units(count) => write!(f, "{count} units"),
            Self::Rows(count) => write!(f, "{count} rows"),
            Self::Byte(byte) => write!(f, "byte 0x{byte:02x}"),
            Self::EndOfLine => f.write_str("the end of the line"),
            Self::EndOfText => f.write_str("the end of the text"),
            Self::Number { value, unit } => write!(f, "{} {unit}", without_rounding(*value)),
        }
    }
}

/// A number in twelve significant digits: what a conversion of units adds behind them was never recorded.
fn without_rounding(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// What is wrong, one variant per rule of the format. Displays as what was expected instead.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RefusalKind {
    /// The first line with content is not the format's name.
    WrongFirstLine,
    /// A version of the format that this program does not read.
    UnsupportedVersion,
    /// A required header key is absent.
    HeaderKeyMissing {
        /// The key.
        key: &'static str,
    },
    /// A header key that is allowed once appears twice.
    HeaderKeyDoubled {
        /// The key.
        key: &'static str,
        /// Line of its first appearance.
        first_line: usize,
    },
    /// A header value that is not of its form.
    HeaderValueMalformed {
        /// The key.
        key: &'static str,
        /// The form in words.
        form: &'static str,
    },
    /// The text ends before a line that begins with `TIME`.
    ColumnNamesMissing,
    /// A column name that the format does not define and that does not begin with `X-`.
    ColumnUnknown,
    /// A column name that appears twice.
    ColumnDoubled {
        /// Character in the line where it appears first.
        first_column: usize,
    },
    /// A required column is absent.
    ColumnMissing {
        /// The column.
        column: Column,
    },
    /// An engine is left out: its columns are numbered from 1 without a gap.
    EngineMissing {
        /// The column that should be there too.
        column: Column,
    },
    /// Rotor speed and fuel flow are not of the same engines.
    EnginesDiffer {
        /// The column that should be there too.
        column: Column,
    },
    /// Fuel flow both of all engines and engine by engine.
    FuelFlowTwice,
    /// The text ends before the line of units.
    UnitsMissing,
    /// More or fewer units than columns.
    UnitCountWrong {
        /// Number of columns.
        expected: usize,
    },
    /// A unit in which the column is not read.
    UnitUnknown {
        /// The column.
        column: Column,
    },
    /// A row with fewer fields than columns.
    TooFewFields {
        /// Number of columns.
        expected: usize,
    },
    /// A row with more fields than columns.
    TooManyFields {
        /// Number of columns.
        expected: usize,
    },
    /// A field that is not a number, or one too large for any quantity.
    NotANumber {
        /// The column.
        column: Column,
    },
    /// A value outside its column's range.
    OutOfRange {
        /// The column.
        column: Column,
        /// The limit that it violates, in the unit of the file.
        limit: f64,
        /// That unit.
        unit: &'static str,
    },
    /// Time that does not strictly increase.
    TimeNotIncreasing {
        /// Time of the row before, in the unit of the file.
        previous: f64,
        /// That unit.
        unit: &'static str,
    },
    /// Time far ahead of the row before, which the rows behind go on from.
    TimeAhead {
        /// Time of the row behind, in the unit of the file.
        next: f64,
        /// That unit.
        unit: &'static str,
    },
    /// Fuel used that falls by more than the counter's step.
    FuelUsedFalls {
        /// Its largest value so far, in the unit of the file.
        largest: f64,
        /// How far below it may lie.
        tolerance: f64,
        /// The unit of both.
        unit: &'static str,
    },
    /// A mass at or below zero.
    MassNotPositive {
        /// Which: `ZFW`, `FOB` or `gross mass`.
        mass: &'static str,
    },
    /// The last row has no line end and is not complete.
    LastRowUnfinished {
        /// Number of columns.
        expected: usize,
    },
    /// Compressed text that ends too early.
    GzipTruncated,
    /// Compressed text that does not decompress, or whose checksum is wrong.
    GzipCorrupt,
    /// Bytes that are not UTF-8.
    InvalidUtf8,
    /// A NUL byte.
    NulByte,
    /// Fewer than three rows.
    TooFewRows,
    /// More text than any recording has; protects against decompression bombs.
    TooLarge {
        /// The limit in bytes.
        limit_bytes: usize,
    },
    /// The source of the text could not be read to its end.
    Unreadable {
        /// Kind of the input error.
        error: io::ErrorKind,
    },
    /// Columns that are readable one by one but do not make a report.
    Inconsistent(ReportDataError),
    /// A recording of another layout without a line of column names.
    SourceNamesMissing,
    /// A column that the mapping names and the recording does not have.
    SourceColumnMissing {
        /// Its name.
        name: String,
        /// What may have been meant: the nearest name, or another separator; empty where nothing is near.
        hint: String,
    },
    /// Columns from which the mapping cannot make a report.
    SourceColumnsUnfit {
        /// The reason.
        reason: String,
    },
    /// A column that the mapping names and the recording has twice.
    SourceColumnDoubled {
        /// Its name.
        name: String,
    },
    /// A text that the header needs and the recording leaves empty.
    SourceTextMissing {
        /// The header key.
        key: &'static str,
    },
    /// A field of a recording that is not a number.
    SourceNotANumber {
        /// The recording's name of the column.
        name: String,
    },
    /// An instant of a recording that is not of the form that the mapping states.
    SourceInstantMalformed,
    /// Gross mass that rises by more than the mapping allows.
    GrossMassRises {
        /// Its smallest value so far, kg.
        smallest_kg: f64,
        /// What the mapping allows, kg.
        admissible_rise_kg: f64,
    },
    /// A table that cannot be read.
    TableUnreadable {
        /// Why.
        reason: String,
    },
    /// Averaged points where a report of samples is wanted.
    PointsForSamples,
    /// Rows of a flight behind those with which it was taken to have ended.
    FlightCameBack {
        /// Line of its last row before.
        last_line: usize,
        /// Why it was not waited for.
        limit: FlightLimit,
    },
    /// A recording without a level part that is long enough.
    NoLevelPart {
        /// How long it must be, s.
        needed_s: f64,
    },
}

/// Why the rows of a flight are no longer waited for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum FlightLimit {
    /// So much of flights that seem to be over is kept while none has come back, bytes.
    KeptBytes(usize),
    /// So many flights may be open at once.
    OpenFlights(usize),
    /// So much of open flights may be held, bytes.
    OpenBytes(usize),
    /// The other flights are so much later than its last row.
    Gap {
        /// s.
        gap_s: f64,
    },
}

impl fmt::Display for FlightLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::KeptBytes(bytes) => {
                write!(f, "{bytes} bytes of finished flights are kept")
            }
            Self::OpenFlights(flights) => write!(f, "at most {flights} flights are open at once"),
            Self::OpenBytes(bytes) => write!(f, "at most {bytes} bytes of open flights are held"),
            Self::Gap { gap_s } => {
                write!(f, "the flights around are more than {gap_s} s past its last row")
            }
        }
    }
}

impl RefusalKind {
    /// Stable name of the kind, for counting.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::WrongFirstLine => "wrong-first-line",
            Self::UnsupportedVersion => "unsupported-version",
            Self::HeaderKeyMissing { .. } => "header-key-missing",
            Self::HeaderKeyDoubled { .. } => "header-key-doubled",
            Self::HeaderValueMalformed { .. } => "header-value-malformed",
            Self::ColumnNamesMissing => "column-names-missing",
            Self::ColumnUnknown => "column-unknown",
            Self::ColumnDoubled { .. } => "column-doubled",
            Self::ColumnMissing { .. } => "column-missing",
            Self::EngineMissing { .. } => "engine-missing",
            Self::EnginesDiffer { .. } => "engines-differ",
            Self::FuelFlowTwice => "fuel-flow-twice",
            Self::UnitsMissing => "units-missing",
            Self::UnitCountWrong { .. } => "unit-count-wrong",
            Self::UnitUnknown { .. } => "unit-unknown",
            Self::TooFewFields { .. } => "too-few-fields",
            Self::TooManyFields { .. } => "too-many-fields",
            Self::NotANumber { .. } => "not-a-number",
            Self::OutOfRange { .. } => "out-of-range",
            Self::TimeNotIncreasing { .. } => "time-not-increasing",
            Self::TimeAhead { .. } => "time-ahead",
            Self::FuelUsedFalls { .. } => "fuel-used-falls",
            Self::MassNotPositive { .. } => "mass-not-positive",
            Self::LastRowUnfinished { .. } => "last-row-unfinished",
            Self::GzipTruncated => "gzip-truncated",
            Self::GzipCorrupt => "gzip-corrupt",
            Self::InvalidUtf8 => "invalid-utf8",
            Self::NulByte => "nul-byte",
            Self::TooFewRows => "too-few-rows",
            Self::TooLarge { .. } => "too-large",
            Self::Unreadable { .. } => "unreadable",
            Self::Inconsistent(_) => "inconsistent",
            Self::SourceNamesMissing => "source-names-missing",
            Self::SourceColumnMissing { .. } => "source-column-missing",
            Self::SourceColumnsUnfit { .. } => "source-columns-unfit",
            Self::SourceColumnDoubled { .. } => "source-column-doubled",
            Self::SourceTextMissing { .. } => "source-text-missing",
            Self::SourceNotANumber { .. } => "source-not-a-number",
            Self::SourceInstantMalformed => "source-instant-malformed",
            Self::GrossMassRises { .. } => "gross-mass-rises",
            Self::TableUnreadable { .. } => "table-unreadable",
            Self::PointsForSamples => "points-for-samples",
            Self::FlightCameBack { .. } => "flight-came-back",
            Self::NoLevelPart { .. } => "no-level-part",
        }
    }
}

impl fmt::Display for RefusalKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WrongFirstLine => f.write_str("\"CRUISE-REPORT 1\" as the first line"),
            Self::UnsupportedVersion => f.write_str("version 1 of the format"),
            Self::HeaderKeyMissing { key } => {
                write!(f, "header key {key} before the column names")
            }
            Self::HeaderKeyDoubled { key, first_line } => {
                write!(f, "{key} once (it is in line {first_line} already)")
            }
            Self::HeaderValueMalformed { key, form } => write!(f, "{form} after {key}"),
            Self::ColumnNamesMissing => f.write_str("a line of column names that begins with TIME"),
            Self::ColumnUnknown => {
                write!(f, "one of {COLUMN_NAMES} (k from 1 to 4), or a name that begins with X-")
            }
            Self::ColumnDoubled { first_column } => {
                write!(f, "each column once (it is at column {first_column} already)")
            }
            Self::ColumnMissing { column } => write_missing_column(f, *column),
            Self::EngineMissing { column } => {
                write!(f, "{} too: engines count from 1 without a gap", column.name())
            }
            Self::EnginesDiffer { column } => {
                write!(f, "{} too: N2 and WF are of the same engines", column.name())
            }
            Self::FuelFlowTwice => {
                f.write_str("either WF(k) of each engine or WF of all engines, not both")
            }
            Self::UnitsMissing => f.write_str("a line of units"),
            Self::UnitCountWrong { expected } => write!(f, "{expected} units, one per column"),
            Self::UnitUnknown { column } => write_units(f, *column),
            Self::TooFewFields { expected } | Self::TooManyFields { expected } => {
                write!(f, "{expected} fields, one per column")
            }
            Self::NotANumber { column } => {
                let or_dash = if column.is_optional() { " or -" } else { "" };
                write!(f, "a number{or_dash} in {}", column.name())
            }
            Self::OutOfRange { column, limit, unit } => write_range(f, *column, *limit, unit),
            Self::TimeNotIncreasing { previous, unit } => {
                write!(f, "TIME above that of the row before, {previous} {unit}")
            }
            Self::TimeAhead { next, unit } => write!(f, "TIME below that behind it, {next} {unit}"),
            Self::FuelUsedFalls { largest, tolerance, unit } => write!(
                f,
                "FU no more than {tolerance} {unit} below its largest value so far, {largest} {unit}"
            ),
            Self::MassNotPositive { mass } => write!(f, "{mass} above zero"),
            Self::LastRowUnfinished { expected } => {
                write!(f, "a complete row of {expected} fields and a line end")
            }
            Self::GzipTruncated => f.write_str("more compressed text: the gzip file is truncated"),
            Self::GzipCorrupt => f.write_str("compressed text: the gzip file is corrupt"),
            Self::InvalidUtf8 => f.write_str("UTF-8 text"),
            Self::NulByte => f.write_str("text without NUL bytes"),
            Self::TooFewRows => f.write_str("at least 3 rows"),
            Self::TooLarge { limit_bytes } => write!(f, "at most {limit_bytes} bytes of text"),
            Self::Unreadable { error } => write!(f, "readable input: {error}"),
            Self::Inconsistent(error) => write!(f, "columns that make a report: {error}"),
            Self::SourceNamesMissing => f.write_str("a line of column names"),
            Self::SourceColumnsUnfit { reason } => {
                write!(f, "columns from which the mapping makes a report: {reason}")
            }
            Self::SourceColumnMissing { name, hint } => {
                write!(f, "a column named {name:?}{hint}")
            }
            Self::SourceColumnDoubled { name } => write!(f, "one column named {name:?}"),
            Self::SourceTextMissing { key } => write!(f, "text for {key}"),
            Self::SourceNotANumber { name } => write!(f, "a number or nothing in {name:?}"),
            Self::SourceInstantMalformed => f.write_str(INSTANT),
            Self::GrossMassRises { smallest_kg, admissible_rise_kg } => write!(
                f,
                "gross mass no more than {admissible_rise_kg} kg above its smallest value so far, {smallest_kg} kg"
            ),
            Self::TableUnreadable { reason } => write!(f, "rows that can be read ({reason})"),
            Self::PointsForSamples => f.write_str(SAMPLES),
            Self::FlightCameBack { last_line, limit } => write_came_back(f, *last_line, *limit),
            Self::NoLevelPart { needed_s } => write_level_part(f, *needed_s),
        }
    }
}

const INSTANT: &str = "an instant like 2018-05-20 14:14:21, with an offset or one in the mapping";
const SAMPLES: &str =
    "samples, of which a cruise report consists; the mapping's rows are averaged points";

fn write_came_back(
    f: &mut fmt::Formatter<'_>,
    last_line: usize,
    limit: FlightLimit,
) -> fmt::Result {
    write!(
        f,
        "no more rows of this flight, which ended in line {last_line} ({limit}): sort the table by tail, flight and time"
    )
}

fn write_level_part(f: &mut fmt::Formatter<'_>, needed_s: f64) -> fmt::Result {
    write!(f, "a level part of at least {needed_s} s, as the mapping's cruise requires")
}

fn write_range(f: &mut fmt::Formatter<'_>, column: Column, limit: f64, unit: &str) -> fmt::Result {
    write!(f, "{} of {} (limit here {limit} {unit})", column.name(), column.range().words)
}

fn write_missing_column(f: &mut fmt::Formatter<'_>, column: Column) -> fmt::Result {
    match column {
        Column::FuelFlowEngine(_) | Column::FuelFlowTotal => {
            f.write_str("column WF(k) for each engine, or WF of all engines")
        }
        Column::N2(_) => f.write_str("column N2(k) for each engine, or MISSING N2 in the header"),
        Column::StaticAirTemperature | Column::Roll | Column::Drift => {
            write!(f, "column {0}, or MISSING {0} in the header", column.name())
        }
        _ => write!(f, "column {}", column.name()),
    }
}

fn write_units(f: &mut fmt::Formatter<'_>, column: Column) -> fmt::Result {
    for (index, unit) in column.units().iter().enumerate() {
        if index > 0 {
            f.write_str(if index + 1 == column.units().len() { " or " } else { ", " })?;
        }
        f.write_str(unit.name)?;
    }
    write!(f, " for {}", column.name())
}

/// The candidate nearest to a name: at most a third of its letters are inserted, left out, replaced or exchanged with the next,
/// upper and lower case aside; or it is cut off at its half or later.
#[must_use]
pub fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let lower = name.to_lowercase();
    let distance = |candidate: &str| {
        let candidate = candidate.to_lowercase();
        // Half of a name and more is one slip: it was not written to its end.
        let cut_off = candidate.starts_with(&lower)
            && 2 * lower.len() >= candidate.len()
            && candidate != lower;
        if cut_off { 1 } else { strsim::osa_distance(&lower, &candidate) }
    };
    candidates
        .into_iter()
        .map(|candidate| (distance(candidate), candidate))
        .filter(|(distance, candidate)| 3 * distance <= candidate.len().max(name.len()))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn what_is_near() {
        assert_eq!(nearest("kts", ["kt", "m/s"]), Some("kt"));
        assert_eq!(nearest("altitud_ft", ["time", "altitude_ft"]), Some("altitude_ft"));
        // Letters that changed places are one slip.
        assert_eq!(nearest("mahc", ["mass", "mach"]), Some("mach"));
        assert_eq!(nearest("x", ["altitude_ft"]), None);
        assert_eq!(nearest("acropol", ["traffic-a320", "acropole-a320"]), Some("acropole-a320"));
        assert_eq!(nearest("alt", ["altitude_ft"]), None);
    }
}
