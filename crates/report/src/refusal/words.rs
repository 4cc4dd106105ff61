//! What was found and what was expected in words, and the stable name of each kind.

use core::fmt;

use flight::column::{COLUMN_NAMES, Column};

use super::{FlightLimit, Found, RefusalKind};

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => write!(f, "{text:?}"),
            Self::Fields(count) => f.write_str(&counted(*count, "field")),
            Self::Units(count) => f.write_str(&counted(*count, "unit")),
            Self::Rows(count) => f.write_str(&counted(*count, "row")),
            Self::Byte(byte) => write!(f, "byte 0x{byte:02x}"),
            Self::EndOfLine => f.write_str("the end of the line"),
            Self::EndOfText => f.write_str("the end of the text"),
            Self::Number { value, unit } => write!(f, "{} {unit}", without_rounding(*value)),
        }
    }
}

/// A number of things in words.
pub(crate) fn counted(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}

/// A number in twelve significant digits: what a conversion of units adds behind them was never recorded.
fn without_rounding(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
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
            Self::FlowOverGap { .. } => "flow-over-gap",
            Self::StartMassChanges { .. } => "start-mass-changes",
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
            Self::SourceColumnEmpty { .. } => "source-column-empty",
            Self::SourceInstantMalformed => "source-instant-malformed",
            Self::SourceDayAndMonth => "source-day-and-month",
            Self::GrossMassRises { .. } => "gross-mass-rises",
            Self::GrossMassJumps { .. } => "gross-mass-jumps",
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
            Self::TimeAhead { next, unit } => write_time_below(f, *next, unit),
            Self::FuelUsedFalls { largest, tolerance, unit, gap_s } => {
                write_fuel_fall(f, (*largest, *tolerance, unit), *gap_s)
            }
            Self::FlowOverGap { longest_s } => write_longest_gap(f, *longest_s),
            Self::StartMassChanges { before_kg } => write_start_mass(f, *before_kg),
            Self::MassNotPositive { mass } => write!(f, "{mass} above zero"),
            Self::LastRowUnfinished { expected } => write_whole_row(f, *expected),
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
            Self::SourceColumnMissing { name, hint } => write_column_named(f, name, hint),
            Self::SourceColumnDoubled { name } => write!(f, "one column named {name:?}"),
            Self::SourceTextMissing { key } => write!(f, "text for {key}"),
            Self::SourceNotANumber { name } => write!(f, "a number or nothing in {name:?}"),
            Self::SourceColumnEmpty { name } => write_lacking(f, name),
            Self::SourceInstantMalformed => f.write_str(INSTANT),
            Self::SourceDayAndMonth => f.write_str(DAY_AND_MONTH),
            Self::GrossMassRises { smallest_kg, admissible_rise_kg, gap_s } => {
                write_mass_rise(f, *smallest_kg, *admissible_rise_kg, *gap_s)
            }
            Self::GrossMassJumps { around_kg } => write_mass_around(f, *around_kg),
            Self::TableUnreadable { reason } => write!(f, "rows that can be read ({reason})"),
            Self::PointsForSamples => f.write_str(SAMPLES),
            Self::FlightCameBack { last_line, limit } => write_came_back(f, *last_line, *limit),
            Self::NoLevelPart { needed_s } => write_level_part(f, *needed_s),
        }
    }
}

const DAY_AND_MONTH: &str =
    "day and month in the order of format in the mapping (%d the day, %m the month), in all files";
const INSTANT: &str = "an instant like 2018-05-20 14:14:21, with an offset or one in the mapping";
const ANOTHER_FLIGHT: &str = ": another flight? new_flight_after_s in the mapping divides them";
const SAMPLES: &str =
    "samples, of which a cruise report consists; the mapping's rows are averaged points";

fn write_time_below(f: &mut fmt::Formatter<'_>, next: f64, unit: &str) -> fmt::Result {
    write!(f, "TIME below that of the next row of its flight, {next} {unit}")
}

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

fn write_mass_around(f: &mut fmt::Formatter<'_>, around_kg: f64) -> fmt::Result {
    write!(f, "gross mass as in the rows around it, {around_kg} kg")
}

fn write_mass_rise(
    f: &mut fmt::Formatter<'_>,
    smallest_kg: f64,
    admissible_rise_kg: f64,
    gap_s: Option<f64>,
) -> fmt::Result {
    write!(
        f,
        "gross mass no more than {admissible_rise_kg} kg above its smallest value so far, {smallest_kg} kg"
    )?;
    write_gap(f, gap_s)
}

fn write_column_named(f: &mut fmt::Formatter<'_>, name: &str, hint: &str) -> fmt::Result {
    write!(f, "a column named {name:?}{hint}")
}

fn write_lacking(f: &mut fmt::Formatter<'_>, name: &str) -> fmt::Result {
    write!(f, "every number that the report needs; most of these rows lack one in {name:?}")
}

fn write_fuel_fall(
    f: &mut fmt::Formatter<'_>,
    (largest, tolerance, unit): (f64, f64, &str),
    gap_s: Option<f64>,
) -> fmt::Result {
    write!(
        f,
        "FU no more than {tolerance} {unit} below its largest value so far, {largest} {unit}"
    )?;
    write_gap(f, gap_s)
}

fn write_whole_row(f: &mut fmt::Formatter<'_>, expected: usize) -> fmt::Result {
    write!(f, "a complete row of {expected} fields and a line end")
}

fn write_start_mass(f: &mut fmt::Formatter<'_>, before_kg: f64) -> fmt::Result {
    write!(f, "one start mass in a flight, {before_kg} kg{ANOTHER_FLIGHT}")
}

fn write_longest_gap(f: &mut fmt::Formatter<'_>, longest_s: f64) -> fmt::Result {
    write!(
        f,
        "no more than {longest_s} s without a row where fuel flow is integrated from a start mass{ANOTHER_FLIGHT}"
    )
}

fn write_gap(f: &mut fmt::Formatter<'_>, gap_s: Option<f64>) -> fmt::Result {
    let Some(gap_s) = gap_s else { return Ok(()) };
    write!(f, "; {gap_s} s without a row come before it{ANOTHER_FLIGHT}")
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
