//! Why a text is refused: where, what was found, what was expected.

use std::io;

use flight::ReportDataError;
use flight::column::{COLUMN_NAMES, Column};

mod near;
mod words;

pub use near::nearest;
pub(crate) use words::counted;

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

/// Seconds of the day around midnight, about which a recording may lack some minutes.
const LAST_OF_DAY_S: core::ops::RangeInclusive<f64> = 85_800.0..=86_400.0;
const FIRST_OF_DAY_S: core::ops::Range<f64> = 0.0..600.0;
const BEGINS_AGAIN: &str =
    "; is midnight between them? time: TimeOfDay(…) in the mapping reads seconds of the day";

impl Refusal {
    /// Whether time falls as seconds of the day do at midnight.
    pub(crate) fn is_over_midnight(&self) -> bool {
        let (RefusalKind::TimeNotIncreasing { previous, .. }, Found::Text(found)) =
            (&self.kind, &self.found)
        else {
            return false;
        };
        LAST_OF_DAY_S.contains(previous)
            && found.parse().is_ok_and(|found| FIRST_OF_DAY_S.contains(&found))
    }

    /// "; did you mean MACH?" where a name that is not known is like one that is.
    fn meant(&self) -> String {
        if self.is_over_midnight() {
            return BEGINS_AGAIN.to_owned();
        }
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
        /// The time without a row before it, where that is long enough for another flight to have begun, s.
        gap_s: Option<f64>,
    },
    /// Fuel flow that would be integrated over a time without a row in which another flight may have begun.
    FlowOverGap {
        /// The longest such time within a flight, s.
        longest_s: f64,
    },
    /// A start mass that is another one further on in a flight.
    StartMassChanges {
        /// The one before, kg.
        before_kg: f64,
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
    /// Most rows of a flight lack a number that the report needs.
    SourceColumnEmpty {
        /// The recording's name of the column that most of them lack.
        name: String,
    },
    /// An instant of a recording that is not of the form that the mapping states.
    SourceInstantMalformed,
    /// A date that can be read with day and month exchanged only.
    SourceDayAndMonth,
    /// Gross mass that rises by more than the mapping allows.
    GrossMassRises {
        /// Its smallest value so far, kg.
        smallest_kg: f64,
        /// What the mapping allows, kg.
        admissible_rise_kg: f64,
        /// The time without a row before it, where that is long enough for another flight to have begun, s.
        gap_s: Option<f64>,
    },
    /// A gross mass that goes together neither with those before nor with those behind.
    GrossMassJumps {
        /// The one before it, kg.
        around_kg: f64,
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
