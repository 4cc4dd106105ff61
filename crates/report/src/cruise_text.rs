//! The cruise report, format 1, from bytes.

mod assemble;
mod columns;
mod header;
mod rows;

use std::io::BufRead;

use flight::{Finding, FlightIdentity, Report};

use crate::decode;
use crate::line::Lines;
use crate::refusal::{Found, Refusal, RefusalKind};
use columns::Field;
pub(crate) use header::parse_instant;

/// Name of the format, first word of its first line.
pub(crate) const FORMAT_NAME: &str = "CRUISE-REPORT";
/// The only version.
pub(crate) const FORMAT_VERSION: &str = "1";

/// A report and the findings about its text.
#[derive(Clone, Debug, PartialEq)]
pub struct Parsed {
    /// The report as sent.
    pub report: Report,
    /// The findings, in the order of the text.
    pub findings: Vec<Finding>,
    /// Rows of a recording that are left out because they cannot be read, or hold a number out of range.
    pub left_out: usize,
}

/// Who flew and when.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// Type code of the aircraft.
    pub aircraft_type: String,
    /// Tail, START, flight.
    pub identity: FlightIdentity,
}

/// The head of a report from its first bytes, plain or gzip; `None` where they do not hold a whole and correct header,
/// so that only the whole report can decide.
#[must_use]
pub fn head(beginning: &[u8]) -> Option<Head> {
    let mut unpacked = Vec::new();
    let text = decode::beginning(beginning, &mut unpacked)?;
    let mut lines = Lines::new(text);
    read_first_line(&mut lines).ok()?;
    let (header, _) = header::read(&mut lines, &mut Vec::new()).ok()?;
    Some(Head { aircraft_type: header.aircraft_type, identity: header.identity })
}

/// Reads cruise reports, one after the other, with the same buffers: nothing is allocated for a row.
#[derive(Clone, Debug, Default)]
pub struct Reader {
    streamed: Vec<u8>,
    unpacked: Vec<u8>,
    fields: Vec<Field>,
    values: Vec<f64>,
}

impl Reader {
    /// A reader with empty buffers.
    #[must_use]
    pub const fn new() -> Self {
        Self { streamed: Vec::new(), unpacked: Vec::new(), fields: Vec::new(), values: Vec::new() }
    }

    /// Reads one report from its bytes, plain or gzip.
    ///
    /// # Errors
    /// The first [`Refusal`] in reading order.
    pub fn read(&mut self, bytes: &[u8]) -> Result<Parsed, Refusal> {
        let text = decode::text(bytes, &mut self.unpacked)?;
        read_text(text, &mut self.fields, &mut self.values)
    }

    /// Reads one report from a stream, plain or gzip, to the stream's end.
    ///
    /// # Errors
    /// The first [`Refusal`] in reading order, also for a stream that cannot be read.
    pub fn read_from(&mut self, stream: impl BufRead) -> Result<Parsed, Refusal> {
        decode::bytes_of(stream, &mut self.streamed)?;
        let text = decode::text(&self.streamed, &mut self.unpacked)?;
        read_text(text, &mut self.fields, &mut self.values)
    }
}

fn read_text(
    text: &str,
    fields: &mut Vec<Field>,
    values: &mut Vec<f64>,
) -> Result<Parsed, Refusal> {
    let mut lines = Lines::new(text);
    let mut findings = Vec::new();
    read_first_line(&mut lines)?;
    let (header, names) = header::read(&mut lines, &mut findings)?;
    let engines = columns::read(names, &mut lines, &header, fields, &mut findings)?;
    let first_row = lines.clone();
    let rows = rows::read(&mut lines, fields, values, &mut findings)?;
    if rows < 3 {
        return Err(lines.refuse_end(Found::Rows(rows), RefusalKind::TooFewRows));
    }
    let report = assemble::report(header, fields, engines, values)
        .map_err(|error| assemble::refusal(error, first_row))?;
    Ok(Parsed { report, findings, left_out: 0 })
}

fn read_first_line(lines: &mut Lines<'_>) -> Result<(), Refusal> {
    let Some(line) = lines.next_of_meaning() else {
        return Err(lines.refuse_end(Found::EndOfText, RefusalKind::WrongFirstLine));
    };
    let (name, version) = line.meaning().split_first();
    if name.text != FORMAT_NAME {
        return Err(line.refuse_word(line.meaning(), RefusalKind::WrongFirstLine));
    }
    match version.text {
        FORMAT_VERSION => Ok(()),
        "" => Err(line.refuse_end(Found::EndOfLine, RefusalKind::UnsupportedVersion)),
        _ => Err(line.refuse_word(version, RefusalKind::UnsupportedVersion)),
    }
}
