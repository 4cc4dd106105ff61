//! A file that several columns are read from at the same time.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::sync::{Arc, Mutex, PoisonError};

use bytes::Bytes;
use parquet::errors::ParquetError;
use parquet::file::reader::{ChunkReader, Length};

/// A file whose readers each have a place of their own. Handles of one file share their place, so that columns which are
/// read at the same time would take each other's pages.
#[derive(Clone)]
pub(crate) struct SharedFile {
    file: Arc<Mutex<File>>,
    length: u64,
}

/// Reads on from a place.
pub(crate) struct Reader {
    file: SharedFile,
    place: u64,
}

impl SharedFile {
    pub(super) fn new(file: File) -> io::Result<Self> {
        let length = file.metadata()?.len();
        Ok(Self { file: Arc::new(Mutex::new(file)), length })
    }

    /// Reads as many bytes as there is room for.
    pub(super) fn read_whole(&self, place: u64, bytes: &mut [u8]) -> io::Result<()> {
        Reader { file: self.clone(), place }.read_exact(bytes)
    }

    fn read_at(&self, place: u64, bytes: &mut [u8]) -> io::Result<usize> {
        // A place is set before every read: one that was left by a panic does no harm.
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(place))?;
        file.read(bytes)
    }
}

impl Read for Reader {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read_at(self.place, bytes)?;
        self.place += read as u64;
        Ok(read)
    }
}

impl Length for SharedFile {
    fn len(&self) -> u64 {
        self.length
    }
}

impl ChunkReader for SharedFile {
    type T = BufReader<Reader>;

    fn get_read(&self, start: u64) -> Result<Self::T, ParquetError> {
        // For the header of a page, which is some dozens of bytes.
        const HEADER_BYTES: usize = 1 << 10;
        Ok(BufReader::with_capacity(HEADER_BYTES, Reader { file: self.clone(), place: start }))
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes, ParquetError> {
        // A damaged file can claim any length.
        if start.checked_add(length as u64).is_none_or(|end| end > self.length) {
            return Err(ParquetError::EOF(format!(
                "{length} bytes at {start} are not in the file"
            )));
        }
        let mut bytes = vec![0; length];
        Reader { file: self.clone(), place: start }.read_exact(&mut bytes)?;
        Ok(bytes.into())
    }
}
