//! A recording opened for reading: text as it is unpacked, Parquet, or Arrow.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use report::mapping::Source;

use super::bytes;
use crate::arrow_batches::{self, is_arrow};
use crate::parquet_batches;

/// What a Parquet file begins with.
const PARQUET_MAGIC: &[u8] = b"PAR1";
/// What a Zstandard frame begins with (RFC 8878, section 3.1.1).
const ZSTANDARD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];
/// Bytes that are read from a file at a time.
const BUFFER_BYTES: usize = 1 << 18;

/// Whether these are the first bytes of a Parquet file.
pub(crate) fn is_parquet(bytes: &[u8]) -> bool {
    bytes.starts_with(PARQUET_MAGIC)
}

/// Opens a recording.
///
/// # Errors
/// Why it is not read.
pub(crate) fn open(path: &Path) -> Result<Source<'static>, String> {
    let mut file = BufReader::with_capacity(BUFFER_BYTES, bytes::open(path)?);
    let beginning = file.fill_buf().map_err(|error| error.to_string())?;
    if is_parquet(beginning) {
        return parquet_batches::source(file.into_inner());
    }
    if is_arrow(beginning) {
        return arrow_batches::source(file);
    }
    let source = if beginning.starts_with(&ZSTANDARD_MAGIC) {
        Source::text(unpacked(file)?)
    } else {
        Source::text(file)
    };
    source.map_err(|refusal| refusal.to_string())
}

fn unpacked(file: BufReader<File>) -> Result<impl BufRead, String> {
    let decoder = zstd::stream::read::Decoder::with_buffer(file);
    decoder
        .map(|decoder| BufReader::with_capacity(BUFFER_BYTES, decoder))
        .map_err(|error| error.to_string())
}
