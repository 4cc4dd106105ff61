//! Report files in, stabilised segments out: in parallel, file by file; only the segments of a file are kept.

mod bytes;
pub(crate) mod heads;

use std::path::{Path, PathBuf};

use pipeline::reading::{FileRead, FlightReader};
use rayon::prelude::*;
use report::mapping::Mapping;
use segmenter::TrimCriteria;

use crate::progress::Bar;

pub(crate) use pipeline::reading::{FlightRead, Reading, RefusedReport};

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

/// The bytes of a file.
///
/// # Errors
/// Why it is not read.
pub(crate) fn bytes_of(path: &Path) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    bytes::read(path, &mut bytes)?;
    Ok(bytes)
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
        if let Err(reason) = bytes::read(path, &mut buffers.raw) {
            return (Vec::new(), vec![RefusedReport::whole(path.to_owned(), reason)]);
        }
        buffers.reader.read(path, &buffers.raw, self.mapping.as_ref(), &self.criteria)
    }
}
