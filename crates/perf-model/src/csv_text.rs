//! Comma-separated text with a header: shared by guide and flight points.
//!
//! A file is read whole and refused at its first fault, with line, column and what was expected. Columns are found by
//! name, in any order; columns whose name begins with `X-` are ignored, as in cruise reports.

use core::fmt;
use std::collections::BTreeMap;
use std::io::Read;

use units::{OutOfDomain, check_within};

/// A column that a file may have: its name carries the unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Column {
    pub(crate) name: &'static str,
    pub(crate) quantity: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) minimum: f64,
    pub(crate) maximum: f64,
}

/// Columns that a file may have, and names beside them that it may have without a meaning.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known<'a> {
    pub(crate) columns: &'a [Column],
    pub(crate) without_meaning: &'a [&'a str],
}

impl Known<'_> {
    fn has(self, name: &str) -> bool {
        name.starts_with("X-")
            || self.columns.iter().any(|column| column.name == name)
            || self.without_meaning.contains(&name)
    }
}

/// Why text is not a guide or a list of flight points.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}{}: {reason}", At(.column.as_ref()))]
pub struct CsvError {
    /// Line of the file, from 1.
    pub line: u64,
    /// The column, where the fault is in one.
    pub column: Option<CsvColumn>,
    /// What is wrong.
    pub reason: CsvErrorReason,
}

/// A column of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CsvColumn {
    /// Number from 1.
    pub number: usize,
    /// Its name in the header, or the text found there.
    pub name: String,
}

/// What is wrong with a file of comma-separated text.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CsvErrorReason {
    /// No line with column names.
    #[error("no header, expected column names: {known}")]
    NoHeader {
        /// Names that the file may have.
        known: String,
    },
    /// A header without rows.
    #[error("no rows after the header")]
    NoRows,
    /// A name that the file does not define.
    #[error("unknown column, expected one of {known}, or a name beginning with X-")]
    UnknownColumn {
        /// Names that the file may have.
        known: String,
    },
    /// Names with another separator between them.
    #[error("names with {found:?} between them, expected ','")]
    OtherSeparator {
        /// The separator.
        found: char,
    },
    /// A name that appears twice.
    #[error("column appears twice, first as column {first}")]
    DuplicatedColumn {
        /// Number of the first, from 1.
        first: usize,
    },
    /// A required column that is absent.
    #[error("missing column {expected}")]
    MissingColumn {
        /// Its name, or the names of which one is required.
        expected: String,
    },
    /// A flow of one engine where the number of engines is not known.
    #[error("fuel flow per engine needs the number of engines, as an aircraft file states it")]
    EnginesUnknown,
    /// Two columns of the same quantity in different units.
    #[error("column is the same quantity as {other}, expected only one of the two")]
    ConflictingColumn {
        /// The other one.
        other: &'static str,
    },
    /// A row with too few or too many fields.
    #[error("{found} fields, expected {expected} as in the header")]
    FieldCount {
        /// Fields found.
        found: usize,
        /// Columns of the header.
        expected: usize,
    },
    /// A quote that is open where the text ends.
    #[error(
        "a quote opens in this row and is never closed; expected \"\" for a quote inside a field"
    )]
    QuoteOpen,
    /// Bytes that are not UTF-8.
    #[error("not UTF-8 text")]
    NotUtf8,
    /// A field that is not a finite decimal number.
    #[error("found {found:?}, expected a number")]
    NotANumber {
        /// The field.
        found: String,
    },
    /// A field that is neither 0 nor 1.
    #[error("found {found:?}, expected 0 or 1")]
    NotZeroOrOne {
        /// The field.
        found: String,
    },
    /// A field that is not a date.
    #[error("found {found:?}, expected a date as 2018-05-20 or 2018-05-20T14:14:21Z")]
    NotADate {
        /// The field.
        found: String,
    },
    /// A number that the quantity cannot have.
    #[error("found {found:?}, expected {} to {} {} ({})", .domain.minimum, .domain.maximum, .domain.unit, .domain.quantity)]
    OutOfDomain {
        /// The field.
        found: String,
        /// The domain.
        domain: OutOfDomain,
    },
    /// Fields that are each possible but not together.
    #[error("together with the row's other fields: {domain}")]
    Inconsistent {
        /// The resulting quantity, and its limits.
        domain: OutOfDomain,
    },
}

/// Read behind a text: a row of its own, unless a quote is open.
const END: &[u8] = b"\n\x04\n";
const END_FIELD: &str = "\x04";

/// The line of the row in which a quote opens that a text of comma-separated values never closes: all rows behind it would be one
/// field. `None` where every quote is closed.
#[must_use]
pub fn open_quote(text: &[u8]) -> Option<u64> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .from_reader(Read::chain(text, END));
    let mut record = csv::ByteRecord::new();
    let (mut line, mut is_open) = (1, false);
    while reader.read_byte_record(&mut record).unwrap_or(false) {
        line = line_of(text, record.position());
        is_open = record.iter().ne([END_FIELD.as_bytes()]);
    }
    is_open.then_some(line)
}

/// A file as text: names and fields as sent.
#[derive(Debug)]
pub(crate) struct CsvText {
    header_line: u64,
    pub(crate) header: Vec<String>,
    pub(crate) rows: Vec<Row>,
}

/// A row as sent, with its line.
#[derive(Debug)]
pub(crate) struct Row {
    pub(crate) line: u64,
    pub(crate) fields: Vec<String>,
}

impl CsvText {
    /// Splits the text and checks the header against the columns the file may have.
    pub(crate) fn read(text: &[u8], known: Known<'_>) -> Result<Self, CsvError> {
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true) // lengths are compared here, for a message with line and counts
            .from_reader(Read::chain(text, END));
        let mut record = csv::ByteRecord::new();
        let mut rows = Vec::new();
        // Reading bytes from memory into a flexible byte record cannot fail; an error is treated as the end.
        while reader.read_byte_record(&mut record).unwrap_or(false) {
            let line = line_of(text, record.position());
            rows.push(Row { line, fields: utf8_fields(&record, line)? });
        }
        let last = rows.pop();
        if let Some(Row { line, .. }) = last.filter(|last| last.fields != [END_FIELD]) {
            return Err(CsvError::new(line, CsvErrorReason::QuoteOpen));
        }
        let mut rows = rows.into_iter();
        let Some(Row { line: header_line, fields: header }) = rows.next() else {
            return Err(CsvError::new(1, CsvErrorReason::NoHeader { known: names(known.columns) }));
        };
        check_header(header_line, &header, known)?;
        let rows: Vec<Row> = rows.collect();
        for row in &rows {
            if row.fields.len() != header.len() {
                let (found, expected) = (row.fields.len(), header.len());
                return Err(CsvError::new(
                    row.line,
                    CsvErrorReason::FieldCount { found, expected },
                ));
            }
        }
        if rows.is_empty() {
            return Err(CsvError::new(header_line, CsvErrorReason::NoRows));
        }
        Ok(Self { header_line, header, rows })
    }

    /// A header whose rows are somewhere else, checked like that of a text.
    pub(crate) fn of_header(header: Vec<String>, known: Known<'_>) -> Result<Self, CsvError> {
        check_header(1, &header, known)?;
        Ok(Self { header_line: 1, header, rows: Vec::new() })
    }

    /// Index of a column, if the file has it.
    pub(crate) fn find(&self, column: &Column) -> Option<usize> {
        self.header.iter().position(|name| name.trim() == column.name)
    }

    /// Index of a required column.
    pub(crate) fn require(&self, column: &Column) -> Result<usize, CsvError> {
        self.find(column).ok_or_else(|| self.missing(column.name.to_owned()))
    }

    /// Which of two columns of the same meaning the file has, and where; `None` where it has neither.
    pub(crate) fn find_either<'c>(
        &self,
        [first, second]: [&'c Column; 2],
    ) -> Result<Option<(usize, &'c Column)>, CsvError> {
        match (self.find(first), self.find(second)) {
            (Some(one), Some(other)) => {
                let (index, other) =
                    if one < other { (other, first.name) } else { (one, second.name) };
                Err(self.header_error(index, CsvErrorReason::ConflictingColumn { other }))
            }
            (Some(index), None) => Ok(Some((index, first))),
            (None, Some(index)) => Ok(Some((index, second))),
            (None, None) => Ok(None),
        }
    }

    /// The column that the file has of several of one meaning, of which one is required, and where it is.
    pub(crate) fn require_one_of<'c>(
        &self,
        columns: &[&'c Column],
    ) -> Result<(usize, &'c Column), CsvError> {
        let mut found: Vec<(usize, &'c Column)> =
            columns.iter().filter_map(|column| Some((self.find(column)?, *column))).collect();
        found.sort_by_key(|(index, _)| *index);
        match found[..] {
            [one] => Ok(one),
            [(_, first), (index, _), ..] => {
                Err(self
                    .header_error(index, CsvErrorReason::ConflictingColumn { other: first.name }))
            }
            [] => {
                let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
                Err(self.missing(names.join(" or ")))
            }
        }
    }

    /// A field as a number within its column's limits.
    pub(crate) fn number(&self, row: &Row, index: usize, column: &Column) -> Result<f64, CsvError> {
        let found = row.fields[index].trim();
        let Some(value) = parse_number(found) else {
            return Err(self.error(row, index, CsvErrorReason::NotANumber { found: found.into() }));
        };
        within(column, value).map_err(|domain| {
            self.error(row, index, CsvErrorReason::OutOfDomain { found: found.into(), domain })
        })
    }

    /// Like [`number`](Self::number); an empty field or `-` means "not available".
    pub(crate) fn optional_number(
        &self,
        row: &Row,
        index: Option<usize>,
        column: &Column,
    ) -> Result<Option<f64>, CsvError> {
        match index.filter(|&index| is_available(&row.fields[index])) {
            Some(index) => self.number(row, index, column).map(Some),
            None => Ok(None),
        }
    }

    /// An error at a field.
    pub(crate) fn error(&self, row: &Row, index: usize, reason: CsvErrorReason) -> CsvError {
        CsvError { line: row.line, ..self.header_error(index, reason) }
    }

    pub(crate) fn header_error(&self, index: usize, reason: CsvErrorReason) -> CsvError {
        let name = self.header[index].trim().to_owned();
        CsvError {
            line: self.header_line,
            column: Some(CsvColumn { number: index + 1, name }),
            reason,
        }
    }

    fn missing(&self, expected: String) -> CsvError {
        CsvError::new(self.header_line, CsvErrorReason::MissingColumn { expected })
    }
}

impl CsvError {
    /// Whether nothing but a value is missing: an empty field, `-` or NaN, where a number is needed.
    #[must_use]
    pub fn is_missing_value(&self) -> bool {
        matches!(&self.reason, CsvErrorReason::NotANumber { found } if !is_available(found))
    }

    fn new(line: u64, reason: CsvErrorReason) -> Self {
        Self { line, column: None, reason }
    }
}

/// A number within its column's limits.
pub(crate) fn within(column: &Column, value: f64) -> Result<f64, OutOfDomain> {
    check_within(column.quantity, column.unit, value, column.minimum, column.maximum)
}

/// Whether a field has a value: NaN is none, as programs write it that have no other word.
pub(crate) fn is_available(field: &str) -> bool {
    let field = field.trim();
    !matches!(field, "" | "-") && !field.eq_ignore_ascii_case("nan")
}

/// `, column 4 (fuel_flow_lb_h)`, or empty.
struct At<'a>(Option<&'a CsvColumn>);

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(CsvColumn { number, name }) => write!(f, ", column {number} ({name})"),
            None => Ok(()),
        }
    }
}

fn check_header(line: u64, header: &[String], known: Known<'_>) -> Result<(), CsvError> {
    // A header can hold a hundred thousand names.
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    for (index, name) in header.iter().enumerate() {
        let name = name.trim();
        let error = |reason| CsvError {
            line,
            column: Some(CsvColumn { number: index + 1, name: name.to_owned() }),
            reason,
        };
        if let Some(first) = places.insert(name, index) {
            return Err(error(CsvErrorReason::DuplicatedColumn { first: first + 1 }));
        }
        if !known.has(name) {
            let between = |mark: &char| header.len() == 1 && name.contains(*mark);
            let other = [';', '\t', '|'].into_iter().find(between);
            let unknown = || CsvErrorReason::UnknownColumn { known: names(known.columns) };
            let reason =
                other.map_or_else(unknown, |found| CsvErrorReason::OtherSeparator { found });
            return Err(error(reason));
        }
    }
    Ok(())
}

fn names(known: &[Column]) -> String {
    let names: Vec<&str> = known.iter().map(|column| column.name).collect();
    names.join(", ")
}

fn utf8_fields(record: &csv::ByteRecord, line: u64) -> Result<Vec<String>, CsvError> {
    record
        .iter()
        .enumerate()
        .map(|(index, field)| {
            core::str::from_utf8(field).map(str::to_owned).map_err(|_| CsvError {
                line,
                column: Some(CsvColumn {
                    number: index + 1,
                    name: String::from_utf8_lossy(field).into_owned(),
                }),
                reason: CsvErrorReason::NotUtf8,
            })
        })
        .collect()
}

/// Line of a record, from 1. The reader's own position is where it started to search, before empty lines.
fn line_of(text: &[u8], position: Option<&csv::Position>) -> u64 {
    let Some(position) = position else { return 1 };
    let start = usize::try_from(position.byte()).unwrap_or(usize::MAX).min(text.len());
    let skipped = text[start..].iter().take_while(|byte| matches!(byte, b'\n' | b'\r'));
    let empty_lines: u64 = skipped.map(|&byte| u64::from(byte == b'\n')).sum();
    position.line() + empty_lines
}

/// A finite decimal number: what `f64` reads, without its words for infinity and NaN.
pub(crate) fn parse_number(text: &str) -> Option<f64> {
    let decimal =
        text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E'));
    let value: f64 = if decimal { text.parse().ok()? } else { return None };
    value.is_finite().then_some(value)
}
