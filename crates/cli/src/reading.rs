//! Report files in, stabilised segments out: in parallel, file by file; only the segments of a file are kept.

mod bytes;
pub(crate) mod heads;
pub(crate) mod recording;

use std::path::{Path, PathBuf};

use pipeline::reading::recordings::{self, Mapped, Workers};
use pipeline::reading::{Checks, FileRead, FlightReader};
use rayon::prelude::*;
use report::MAXIMUM_TEXT_BYTES;
use report::mapping::Mapping;
use segmenter::TrimCriteria;

use crate::files::standard_input;
use crate::parquet_batches;
use crate::progress::Bar;
pub(crate) use recording::{is_parquet, open};

pub(crate) use pipeline::reading::{FlightRead, Reading, RefusedReport};

/// How files are read.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    /// For recordings of another layout.
    pub(crate) mapping: Option<Mapping>,
    /// Which samples are steady.
    pub(crate) criteria: TrimCriteria,
    /// Whether flights are checked.
    pub(crate) checks: Checks,
}

/// Buffers that a worker reuses from file to file.
#[derive(Default)]
pub(crate) struct Buffers {
    raw: Vec<u8>,
    reader: FlightReader,
}

impl Buffers {
    /// SHA-256 of a file's uncompressed content.
    ///
    /// # Errors
    /// A file that cannot be read or unpacked.
    pub(crate) fn content_of(&mut self, path: &Path) -> Result<String, RefusedReport> {
        bytes::read(path, &mut self.raw)
            .map_err(|reason| RefusedReport::whole(path.to_owned(), reason))?;
        self.reader.content_of(path, &self.raw)
    }
}

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
        let refused = |reason| (Vec::new(), vec![RefusedReport::whole(path.to_owned(), reason)]);
        let Some(mapping) = self.mapping.as_ref().filter(|_| !is_own(path, &mut buffers.raw))
        else {
            return match read_unmapped(path, &mut buffers.raw) {
                Ok(()) => {
                    let reader = buffers.reader.with_checks(self.checks);
                    reader.read(path, &buffers.raw, None, &self.criteria)
                }
                Err(reason) => refused(reason),
            };
        };
        let (criteria, checks) = (&self.criteria, self.checks);
        let mapped = Mapped { path, mapping, criteria, checks };
        match open(path) {
            Ok(mut source) => recordings::read(&mapped, &mut source, &in_parallel),
            Err(reason) => refused(reason),
        }
    }
}

/// Bytes that show what a file is.
const BEGINNING_BYTES: u64 = 64;

/// Whether a file is a cruise report by its first line, plain or gzip.
pub(crate) fn is_cruise_report(path: &Path) -> bool {
    let mut beginning = Vec::new();
    bytes::read_beginning(path, heads::BEGINNING_BYTES, &mut beginning).is_ok()
        && (beginning.starts_with(FIRST_WORD) || report::head(&beginning).is_some())
}

/// What the first line of a cruise report begins with.
const FIRST_WORD: &[u8] = b"CRUISE-REPORT";

/// Whether a file is what this program writes, which no mapping is for: a cruise report, or a table of segments.
fn is_own(path: &Path, beginning: &mut Vec<u8>) -> bool {
    bytes::read_beginning(path, BEGINNING_BYTES, beginning).is_ok()
        && (beginning.starts_with(FIRST_WORD) || pipeline::segments_table::is_table(beginning))
}

/// The bytes of a report or of a table of segments; of one in Parquet, its rows as text.
fn read_unmapped(path: &Path, bytes: &mut Vec<u8>) -> Result<(), String> {
    bytes::read(path, bytes)?;
    if is_parquet(bytes) {
        let file = standard_input::file(path).map_err(|error| error.to_string())?;
        *bytes = parquet_batches::csv_of_file(&file, MAXIMUM_TEXT_BYTES)?;
        if !pipeline::segments_table::is_table(bytes) {
            return Err(
                "a Parquet file that is no table of segments: --mapping is needed".to_owned()
            );
        }
    }
    Ok(())
}

fn in_parallel(work: &(dyn Fn() + Sync), run: &mut dyn FnMut(&Workers<'_>)) {
    let count = rayon::current_num_threads();
    rayon::in_place_scope(|scope| run(&Workers { count, call: &|| scope.spawn(|_| work()) }));
}
