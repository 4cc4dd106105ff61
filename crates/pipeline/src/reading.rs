//! The bytes of a report or recording into reduced flights, and what was refused of them.

pub mod recordings;

use std::cmp::Ordering;
use std::fmt::{Display, Formatter};
use std::path::{Path, PathBuf};

use flight::{Finding, Report, Severity, Timestamp};
use report::mapping::{MappedPoints, Mapping, Source};
use report::{Parsed, Reader, Refusal};
use segmenter::TrimCriteria;

use crate::check::{check_points, check_report};
use crate::checksum::sha256;
use crate::learnt_flights::instant_after;
use crate::models::TYPE_NOT_STATED;
use crate::reduction::ReducedFlight;
use crate::summary::RefusedSummary;
use crate::{flights_table, segments_table};
use recordings::Mapped;

/// One flight, reduced to its segments.
#[derive(Clone, Debug)]
pub struct FlightRead {
    /// File it came from, or what its caller calls its bytes.
    pub path: PathBuf,
    /// By what its content is known again: SHA-256 of the uncompressed report, hexadecimal; of a recording read with a
    /// mapping, `flight:` and SHA-256 of the flight as it was read, so that a corrected mapping is other content.
    pub content: String,
    /// The same: other programs wrote SHA-256 of a recording's whole file here.
    pub content_of_file: String,
    /// The instant of its last sample.
    pub end: Timestamp,
    /// What it was reduced to.
    pub reduced: ReducedFlight,
}

impl FlightRead {
    /// The order of flying; of two reports of one flight, the order of their paths.
    pub fn order(&self, other: &Self) -> Ordering {
        (&self.reduced.identity, &self.path).cmp(&(&other.reduced.identity, &other.path))
    }

    /// Whether this is the content of a ledger's entry.
    pub fn has_content(&self, content: &str) -> bool {
        self.content == content || self.content_of_file == content
    }

    /// Adds this flight's notes to those of its tail, each sentence once.
    pub fn add_notes(&self, notes: &mut Vec<String>) {
        for note in &self.reduced.notes {
            if !notes.contains(note) {
                notes.push(note.clone());
            }
        }
    }
}

/// A report that was refused while the batch continued.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RefusedReport {
    /// File, or what its caller calls its bytes.
    pub path: PathBuf,
    /// Physical line from 1, where the refusal has one.
    pub line: Option<usize>,
    /// Column (character) from 1, where the refusal has one.
    pub column: Option<usize>,
    /// What was found and what was expected.
    pub reason: String,
}

impl RefusedReport {
    /// A report refused as a whole: no position in it is at fault.
    pub fn whole(path: PathBuf, reason: impl Display) -> Self {
        Self { path, line: None, column: None, reason: reason.to_string() }
    }

    /// A report refused at a position of its text.
    pub fn at(path: PathBuf, refusal: &Refusal) -> Self {
        Self {
            path,
            line: Some(refusal.line),
            column: Some(refusal.column),
            reason: format!("found {}, expected {}", refusal.found, refusal.kind),
        }
    }
}

impl From<&RefusedReport> for RefusedSummary {
    fn from(refused: &RefusedReport) -> Self {
        Self {
            path: refused.path.display().to_string(),
            line: refused.line,
            column: refused.column,
            reason: refused.reason.clone(),
        }
    }
}

impl Display for RefusedReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.path.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
            if let Some(column) = self.column {
                write!(f, ":{column}")?;
            }
        }
        write!(f, ": {}", self.reason)
    }
}

/// All results from a set of files, in the order of the files.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// Flights.
    pub flights: Vec<FlightRead>,
    /// Files, or parts of them, that were refused.
    pub refused: Vec<RefusedReport>,
    /// Copies of reports that are used once.
    pub copies: usize,
    /// Other files of the folders, which were not read.
    pub other_files: usize,
}

impl Reading {
    /// Reports that were met, used or refused.
    pub const fn files(&self) -> usize {
        self.flights.len() + self.refused.len() + self.copies
    }
}

/// What a file came to: its flights, and what was refused of it.
pub type FileRead = (Vec<FlightRead>, Vec<RefusedReport>);

/// Whether flights are checked for what is wrong with their data while their samples are at hand: it takes a sixth of the time in
/// which a recording is read, and most commands have no use for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Checks {
    /// They are.
    #[default]
    Made,
    /// They are not: [`ReducedFlight::check`] is `None`.
    LeftOut,
}

/// Reads one report after the other into the same buffers.
#[derive(Default)]
pub struct FlightReader {
    unpacked: Vec<u8>,
    reader: Reader,
    checks: Checks,
}

impl std::fmt::Debug for FlightReader {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FlightReader").finish_non_exhaustive()
    }
}

impl FlightReader {
    /// From here on flights are checked, or are not.
    pub const fn with_checks(&mut self, checks: Checks) -> &mut Self {
        self.checks = checks;
        self
    }

    /// The flights in the bytes of a cruise report, of a table of segments or, with a mapping, of a recording (plain or gzip),
    /// and what of them was refused. `path` is what results call the bytes; a mapping may take a text of the header from its file name.
    pub fn read(
        &mut self,
        path: &Path,
        bytes: &[u8],
        mapping: Option<&Mapping>,
        criteria: &TrimCriteria,
    ) -> FileRead {
        if let Some(mapping) = mapping {
            return match Source::text(bytes) {
                Ok(mut source) => {
                    let mapped = Mapped { path, mapping, criteria, checks: self.checks };
                    recordings::read(&mapped, &mut source, &recordings::one_by_one)
                }
                Err(refusal) => (Vec::new(), vec![RefusedReport::at(path.to_owned(), &refusal)]),
            };
        }
        if segments_table::is_table(bytes) {
            return read_segments(path, bytes);
        }
        // Content is identified by its uncompressed bytes: a report that was compressed later is the same report.
        let parsed = report::unpack(bytes, &mut self.unpacked)
            .and_then(|bytes| self.reader.read(bytes).map(|parsed| (sha256(bytes), parsed)));
        let (content, parsed) = match parsed {
            Ok(parsed) => parsed,
            Err(refusal) => {
                return (Vec::new(), vec![RefusedReport::at(path.to_owned(), &refusal)]);
            }
        };
        match reduce(path, parsed, content, (criteria, self.checks)) {
            Ok(flight) => (vec![flight], Vec::new()),
            Err(reason) => (Vec::new(), vec![RefusedReport::whole(path.to_owned(), reason)]),
        }
    }

    /// SHA-256 of the uncompressed content of a file, whose bytes these are.
    ///
    /// # Errors
    /// Bytes that cannot be unpacked.
    pub fn content_of(&mut self, path: &Path, bytes: &[u8]) -> Result<String, RefusedReport> {
        let bytes = report::unpack(bytes, &mut self.unpacked).map_err(|refusal| {
            let reason = format!("found {}, expected {}", refusal.found, refusal.kind);
            RefusedReport::whole(path.to_owned(), reason)
        })?;
        Ok(sha256(bytes))
    }
}

/// The flights in a table of segments, as this program writes it.
fn read_segments(path: &Path, bytes: &[u8]) -> FileRead {
    let segments = match segments_table::read(bytes) {
        Ok(segments) => segments,
        Err(error) => return (Vec::new(), vec![RefusedReport::whole(path.to_owned(), error)]),
    };
    let mut flights = flights_table::from_segments(segments, TYPE_NOT_STATED);
    for flight in &mut flights {
        path.clone_into(&mut flight.path);
        flight.reduced.notes.push(
            "segments as they were written: trim criteria and checks of samples were applied before, if at all"
                .to_owned(),
        );
    }
    (flights, Vec::new())
}

fn reduce(
    path: &Path,
    parsed: Parsed,
    content: String,
    (criteria, checks): (&TrimCriteria, Checks),
) -> Result<FlightRead, String> {
    let Parsed { report, findings, left_out } = parsed;
    let notes = notes_of(path, findings);
    let end = end_of(&report)?;
    let check = (checks == Checks::Made)
        .then(|| check_report(&report).with_rows_left_out(report.len(), left_out));
    let reduced =
        ReducedFlight::from_report(report, criteria, notes).map_err(|error| error.to_string())?;
    let check = check.map(|check| check.with_incomplete_minutes(&reduced.tally));
    let reduced = ReducedFlight { check, ..reduced };
    flight_read(path, content, end, reduced)
}

fn reduce_points(
    path: &Path,
    mut points: MappedPoints,
    (criteria, checks): (&TrimCriteria, Checks),
    content_of: fn(&Report) -> String,
) -> Result<FlightRead, String> {
    let notes = notes_of(path, std::mem::take(&mut points.parsed.findings));
    let end = end_of(&points.parsed.report)?;
    // With another averaging time the same numbers say something else.
    let content = format!("{}:{}", content_of(&points.parsed.report), points.averaged_over_s);
    let check = (checks == Checks::Made).then(|| {
        let Parsed { report, left_out, .. } = &points.parsed;
        check_points(report).with_rows_left_out(report.len(), *left_out)
    });
    let reduced =
        ReducedFlight::from_points(points, criteria, notes).map_err(|error| error.to_string())?;
    let reduced = ReducedFlight { check, ..reduced };
    flight_read(path, content, end, reduced)
}

fn notes_of(path: &Path, findings: Vec<Finding>) -> Vec<String> {
    warn_of(path, &findings);
    findings.into_iter().map(|finding| finding.message).collect()
}

/// Warns of what was found in a file, notes left out.
pub fn warn_of(path: &Path, findings: &[Finding]) {
    for finding in findings.iter().filter(|finding| finding.severity >= Severity::Warning) {
        tracing::warn!(file = %path.display(), line = finding.line, "{}", finding.message);
    }
}

fn end_of(report: &Report) -> Result<Timestamp, String> {
    let start = report.header().identity.start;
    let last_s = report.columns().time_s.last().copied().unwrap_or_default();
    instant_after(start, last_s)
        .ok_or_else(|| format!("the last TIME, {last_s} s after START, is no date"))
}

fn flight_read(
    path: &Path,
    content: String,
    end: Timestamp,
    reduced: ReducedFlight,
) -> Result<FlightRead, String> {
    if let Some(column) = reduced.segments.iter().find_map(segments_table::not_finite) {
        return Err(format!("the mean of {column} over a segment is not a finite number"));
    }
    let content_of_file = content.clone();
    Ok(FlightRead { path: path.to_owned(), content_of_file, content, end, reduced })
}
