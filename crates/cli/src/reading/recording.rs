//! A recording opened for reading: text as it is unpacked, or Parquet.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::bytes;
use crate::parquet_text::is_parquet;

/// What a Zstandard frame begins with (RFC 8878, section 3.1.1).
const ZSTANDARD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];
/// Bytes that are read from a file at a time.
const BUFFER_BYTES: usize = 1 << 18;

/// A recording.
pub(super) enum Opened {
    /// Delimited text, plain, gzip, or unpacked from Zstandard.
    Text(Box<dyn BufRead + Send>),
    /// A table in columns.
    Parquet,
}

/// Opens a recording.
///
/// # Errors
/// Why it is not read.
pub(super) fn open(path: &Path) -> Result<Opened, String> {
    let mut file = BufReader::with_capacity(BUFFER_BYTES, bytes::open(path)?);
    let beginning = file.fill_buf().map_err(|error| error.to_string())?;
    if is_parquet(beginning) {
        return Ok(Opened::Parquet);
    }
    if beginning.starts_with(&ZSTANDARD_MAGIC) {
        return Ok(Opened::Text(Box::new(unpacked(file)?)));
    }
    Ok(Opened::Text(Box::new(file)))
}

fn unpacked(file: BufReader<File>) -> Result<impl BufRead + Send, String> {
    let decoder = zstd::stream::read::Decoder::with_buffer(file);
    decoder
        .map(|decoder| BufReader::with_capacity(BUFFER_BYTES, decoder))
        .map_err(|error| error.to_string())
}
