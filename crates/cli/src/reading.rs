//! Report files in, stabilised segments out: in parallel, file by file; only the segments of a file are kept.

mod bytes;
pub(crate) mod heads;
mod recording;

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use pipeline::reading::recordings::{self, Done, Job, Mapped};
use pipeline::reading::{FileRead, FlightReader};
use rayon::prelude::*;
use report::mapping::Mapping;
use segmenter::TrimCriteria;

use crate::parquet_text;
use crate::progress::Bar;
use recording::Opened;

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

/// The text of a recording: the bytes of a file, or the rows of a Parquet file as comma-separated text.
#[derive(Debug)]
pub(crate) struct Recording {
    pub(crate) bytes: Vec<u8>,
    /// Whether the text was made here, with commas and decimal points whatever a mapping says.
    is_from_table: bool,
}

impl Recording {
    /// Reads a recording.
    ///
    /// # Errors
    /// Why it is not read.
    pub(crate) fn read(path: &Path) -> Result<Self, String> {
        let mut bytes = Vec::new();
        bytes::read(path, &mut bytes)?;
        let is_from_table = parquet_text::is_parquet(&bytes);
        if is_from_table {
            bytes = parquet_text::csv_of_file(path)?;
        }
        Ok(Self { bytes, is_from_table })
    }

    /// The mapping as it applies to this text.
    pub(crate) fn mapped_by<'m>(&self, mapping: &'m Mapping) -> Cow<'m, Mapping> {
        if self.is_from_table {
            Cow::Owned(mapping.comma_separated())
        } else {
            Cow::Borrowed(mapping)
        }
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
        let Some(mapping) = &self.mapping else {
            return match bytes::read(path, &mut buffers.raw) {
                Ok(()) => buffers.reader.read(path, &buffers.raw, None, &self.criteria),
                Err(reason) => refused(reason),
            };
        };
        let criteria = &self.criteria;
        match recording::open(path) {
            Ok(Opened::Text(source)) => {
                recordings::read(&Mapped { path, mapping, criteria }, source, &in_parallel)
            }
            Ok(Opened::Parquet) => match parquet_text::csv_of_file(path) {
                Ok(bytes) => {
                    let mapping = &mapping.comma_separated();
                    let mapped = Mapped { path, mapping, criteria };
                    recordings::read(&mapped, bytes.as_slice(), &in_parallel)
                }
                Err(reason) => refused(reason),
            },
            Err(reason) => refused(reason),
        }
    }
}

fn in_parallel(jobs: Vec<Job>, work: &(dyn Fn(Job) -> Done + Sync)) -> Vec<Done> {
    jobs.into_par_iter().map(work).collect()
}
