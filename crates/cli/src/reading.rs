//! Report files in, stabilised segments out: in parallel, file by file; only the segments of a file are kept.

mod bytes;
pub(crate) mod distinct;
pub(crate) mod heads;
pub(crate) mod known;

use std::path::{Path, PathBuf};

use flight::{Severity, Timestamp};
use pipeline::checksum::sha256;
use pipeline::reduction::ReducedFlight;
use pipeline::segments_table;
use rayon::prelude::*;
use report::mapping::Mapping;
use report::{Parsed, Reader, TextLayout};
use segmenter::TrimCriteria;

use crate::failure::RefusedReport;
use crate::folder::flights::instant_after;
use crate::progress::Bar;

/// One flight, reduced to its segments.
#[derive(Clone, Debug)]
pub(crate) struct FlightRead {
    /// File it came from.
    pub(crate) path: PathBuf,
    /// By what its content is known again: SHA-256 of the uncompressed report, hexadecimal; of a recording read with a
    /// mapping, `read:` and SHA-256 of the flight as it was read, so that a corrected mapping is other content.
    pub(crate) content: String,
    /// SHA-256 of the uncompressed file: the content of a recording in folders of older programs.
    pub(crate) content_of_file: String,
    /// The instant of its last sample.
    pub(crate) end: Timestamp,
    /// What it was reduced to.
    pub(crate) reduced: ReducedFlight,
}

impl FlightRead {
    /// The order of flying; of two reports of one flight, the order of their paths.
    pub(crate) fn order(&self, other: &Self) -> std::cmp::Ordering {
        (&self.reduced.identity, &self.path).cmp(&(&other.reduced.identity, &other.path))
    }

    /// Whether this is the content of a ledger's entry.
    pub(crate) fn has_content(&self, content: &str) -> bool {
        self.content == content || self.content_of_file == content
    }

    /// Adds this flight's notes to those of its tail, each sentence once.
    pub(crate) fn add_notes(&self, notes: &mut Vec<String>) {
        for note in &self.reduced.notes {
            if !notes.contains(note) {
                notes.push(note.clone());
            }
        }
    }
}

/// All results from a set of files, in the order of the files.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reading {
    /// Flights.
    pub(crate) flights: Vec<FlightRead>,
    /// Files, or parts of them, that were refused.
    pub(crate) refused: Vec<RefusedReport>,
    /// Copies of reports that are used once.
    pub(crate) copies: usize,
}

impl Reading {
    /// Reports that were met, used or refused.
    pub(crate) fn files(&self) -> usize {
        self.flights.len() + self.refused.len() + self.copies
    }
}

/// How files are read.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    /// For recordings of another layout.
    pub(crate) mapping: Option<Mapping>,
    /// Which samples are steady.
    pub(crate) criteria: TrimCriteria,
}

/// Buffers that a worker reuses from file to file.
#[derive(Default)]
pub(crate) struct Buffers {
    raw: Vec<u8>,
    unpacked: Vec<u8>,
    reader: Reader,
}

impl Buffers {
    /// SHA-256 of a file's uncompressed content.
    ///
    /// # Errors
    /// A file that cannot be read or unpacked.
    pub(crate) fn content_of(&mut self, path: &Path) -> Result<String, RefusedReport> {
        bytes::read(path, &mut self.raw)
            .map_err(|reason| RefusedReport::whole(path.to_owned(), reason))?;
        let bytes = report::unpack(&self.raw, &mut self.unpacked).map_err(|refusal| {
            let reason = format!("found {}, expected {}", refusal.found, refusal.kind);
            RefusedReport::whole(path.to_owned(), reason)
        })?;
        Ok(sha256(bytes))
    }
}

/// What a file came to: its flights, and what was refused of it.
pub(crate) type FileRead = (Vec<FlightRead>, Vec<RefusedReport>);

impl Source {
    /// Reads files and finds their segments; file by file in parallel, results in the order of the files.
    pub(crate) fn read_all(&self, files: &[PathBuf], progress: &Bar) -> Reading {
        let read: Vec<FileRead> = files
            .par_iter()
            .map_init(Buffers::default, |buffers, path| {
                let result = self.read_file(path, buffers);
                progress.step();
                result
            })
            .collect();
        let mut reading = Reading::default();
        for (flights, refused) in read {
            reading.flights.extend(flights);
            reading.refused.extend(refused);
        }
        reading
    }

    /// Reads a file and finds the segments of its flights.
    pub(crate) fn read_file(&self, path: &Path, buffers: &mut Buffers) -> FileRead {
        let refuse = |line, column, reason: String| RefusedReport {
            path: path.to_owned(),
            line,
            column,
            reason,
        };
        if let Err(reason) = bytes::read(path, &mut buffers.raw) {
            return (Vec::new(), vec![refuse(None, None, reason)]);
        }
        let of_refusal = |refusal: &report::Refusal| {
            let reason = format!("found {}, expected {}", refusal.found, refusal.kind);
            (Vec::new(), vec![refuse(Some(refusal.line), Some(refusal.column), reason)])
        };
        // Content is identified by its uncompressed bytes: a report that was compressed later is the same report.
        let bytes = match report::unpack(&buffers.raw, &mut buffers.unpacked) {
            Ok(bytes) => bytes,
            Err(refusal) => return of_refusal(&refusal),
        };
        let parsed = match &self.mapping {
            None => buffers.reader.read(bytes).map(|parsed| vec![parsed]),
            Some(mapping) => {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                mapping.read_named(bytes, &name)
            }
        };
        let parsed = match parsed {
            Ok(parsed) => parsed,
            Err(refusal) => return of_refusal(&refusal),
        };
        let content_of_file = sha256(bytes);
        let mut flights = Vec::new();
        let mut refused = Vec::new();
        for parsed in parsed {
            match self.reduce(path, &content_of_file, parsed) {
                Ok(flight) => flights.push(flight),
                Err(reason) => refused.push(refuse(None, None, reason)),
            }
        }
        (flights, refused)
    }

    fn reduce(
        &self,
        path: &Path,
        content_of_file: &str,
        parsed: Parsed,
    ) -> Result<FlightRead, String> {
        let Parsed { report, findings } = parsed;
        let mut notes = Vec::new();
        for finding in findings {
            if finding.severity >= Severity::Warning {
                tracing::warn!(file = %path.display(), line = finding.line, "{}", finding.message);
            }
            notes.push(finding.message);
        }
        let start = report.header().identity.start;
        let last_s = report.columns().time_s.last().copied().unwrap_or_default();
        let end = instant_after(start, last_s)
            .ok_or_else(|| format!("the last TIME, {last_s} s after START, is no date"))?;
        let content = match &self.mapping {
            None => content_of_file.to_owned(),
            Some(_) => content_as_read(&report)?,
        };
        let reduced = ReducedFlight::from_report(report, &self.criteria, notes)
            .map_err(|error| error.to_string())?;
        if let Some(column) = reduced.segments.iter().find_map(segments_table::not_finite) {
            return Err(format!("the mean of {column} over a segment is not a finite number"));
        }
        Ok(FlightRead {
            path: path.to_owned(),
            content,
            content_of_file: content_of_file.to_owned(),
            end,
            reduced,
        })
    }
}

/// By what a flight out of a recording is known again: header and every sample, to the bit.
fn content_as_read(report: &flight::Report) -> Result<String, String> {
    let text =
        report::write(report, &TextLayout::exact(), &[]).map_err(|error| error.to_string())?;
    Ok(format!("read:{}", sha256(text.as_bytes())))
}
