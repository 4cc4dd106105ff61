//! Report files in, stabilised segments out: in parallel, file by file; only the segments of a file are kept.

use std::io::Read;
use std::path::{Path, PathBuf};

use flight::Severity;
use pipeline::checksum::sha256;
use pipeline::reduction::ReducedFlight;
use rayon::prelude::*;
use report::mapping::Mapping;
use report::{Parsed, Reader};
use segmenter::TrimCriteria;

use crate::failure::RefusedReport;
use crate::progress::Bar;

/// One flight, reduced to its segments.
#[derive(Clone, Debug)]
pub(crate) struct FlightRead {
    /// File it came from.
    pub(crate) path: PathBuf,
    /// SHA-256 of the uncompressed content, hexadecimal.
    pub(crate) content: String,
    /// What it was reduced to.
    pub(crate) reduced: ReducedFlight,
}

impl FlightRead {
    /// The order of flying; of two reports of one flight, the order of their paths.
    pub(crate) fn order(&self, other: &Self) -> std::cmp::Ordering {
        (&self.reduced.identity, &self.path).cmp(&(&other.reduced.identity, &other.path))
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
}

impl Reading {
    /// Reports that were met, used or refused.
    pub(crate) fn files(&self) -> usize {
        self.flights.len() + self.refused.len()
    }
}

/// Reads files and finds their segments; file by file in parallel, results in the order of the files.
pub(crate) fn read_all(
    files: &[PathBuf],
    mapping: Option<&Mapping>,
    criteria: &TrimCriteria,
    progress: &Bar,
) -> Reading {
    let read: Vec<(Vec<FlightRead>, Vec<RefusedReport>)> = files
        .par_iter()
        .map_init(Buffers::default, |buffers, path| {
            let result = read_file(path, mapping, criteria, buffers);
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

/// Buffers that a worker reuses from file to file.
#[derive(Default)]
struct Buffers {
    raw: Vec<u8>,
    unpacked: Vec<u8>,
    reader: Reader,
}

fn read_file(
    path: &Path,
    mapping: Option<&Mapping>,
    criteria: &TrimCriteria,
    buffers: &mut Buffers,
) -> (Vec<FlightRead>, Vec<RefusedReport>) {
    let refuse = |line, column, reason: String| RefusedReport {
        path: path.to_owned(),
        line,
        column,
        reason,
    };
    buffers.raw.clear();
    let opened = std::fs::File::open(path).and_then(|mut file| file.read_to_end(&mut buffers.raw));
    if let Err(error) = opened {
        return (Vec::new(), vec![refuse(None, None, error.to_string())]);
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
    let file_name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into());
    let parsed = match mapping {
        None => buffers.reader.read(bytes).map(|parsed| vec![parsed]),
        Some(mapping) => mapping.read_named(bytes, &file_name),
    };
    let parsed = match parsed {
        Ok(parsed) => parsed,
        Err(refusal) => return of_refusal(&refusal),
    };
    let content = sha256(bytes);
    let mut flights = Vec::new();
    let mut refused = Vec::new();
    for Parsed { report, findings } in parsed {
        let mut notes = Vec::new();
        for finding in findings {
            if finding.severity >= Severity::Warning {
                tracing::warn!(file = %path.display(), line = finding.line, "{}", finding.message);
            }
            notes.push(finding.message);
        }
        match ReducedFlight::from_report(report, criteria, notes) {
            Ok(reduced) => {
                flights.push(FlightRead {
                    path: path.to_owned(),
                    content: content.clone(),
                    reduced,
                });
            }
            Err(error) => refused.push(refuse(None, None, error.to_string())),
        }
    }
    (flights, refused)
}
