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

/// Reads the rows of a Parquet or Arrow file in memory, both as the commands do: a recording's beginning, and all of it as text.
pub(crate) fn read_columnar(bytes: &[u8]) {
    /// So much of it: damage early in a file is met early.
    const MOST_BYTES: usize = 1 << 20;
    if is_arrow(bytes) {
        let source = arrow_batches::source(std::io::Cursor::new(bytes.to_vec()));
        let _ = source.map(|source| source.beginning(MOST_BYTES));
        return;
    }
    let Ok(file) = tempfile::NamedTempFile::new() else { return };
    if std::fs::write(file.path(), bytes).is_ok() {
        let _ = open(file.path()).map(|source| source.beginning(MOST_BYTES));
        let _ = parquet_batches::csv_of_file(file.path(), MOST_BYTES);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small files of every codec and layout that is read.
    fn layouts() -> Vec<(String, Vec<u8>)> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/layouts");
        let mut files: Vec<_> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| {
                let ending = path.extension().unwrap_or_default();
                ["parquet", "arrow", "arrows"].iter().any(|known| ending == *known)
            })
            .map(|path| (path.display().to_string(), std::fs::read(&path).unwrap()))
            .collect();
        files.sort();
        files
    }

    /// Bytes replaced, cut out, doubled, with half of the changes in the last 2 kB, where both formats keep what leads to the
    /// rest.
    #[test]
    fn damaged_parquet_and_arrow_are_values_or_refusals() {
        use rand_chacha::ChaCha8Rng;
        use rand_chacha::rand_core::{Rng as _, SeedableRng as _};
        let cases = std::env::var("PROPTEST_CASES").map_or(150, |cases| cases.parse().unwrap());
        let seed = std::env::var("PROPTEST_RNG_SEED").map_or(2020, |seed| seed.parse().unwrap());
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let files = layouts();
        assert!(files.len() >= 10, "{}", files.len());
        for (name, good) in &files {
            read_columnar(good);
            for case in 0..cases {
                let mut bytes = good.clone();
                for _ in 0..=random.next_u32() % 4 {
                    let length = bytes.len().max(1);
                    let range = if random.next_u32() % 2 == 0 { length } else { length.min(2048) };
                    let at = length - 1 - random.next_u32() as usize % range;
                    match random.next_u32() % 8 {
                        0 => bytes.truncate(at),
                        1 => drop(bytes.drain(at..(at + 7).min(length))),
                        2 => bytes.extend_from_within(at..),
                        3 => bytes[at..].iter_mut().take(4).for_each(|byte| *byte = 0xff),
                        _ => bytes[at] = random.next_u32().to_le_bytes()[0],
                    }
                    if bytes.is_empty() {
                        break;
                    }
                }
                let read = std::panic::catch_unwind(|| read_columnar(&bytes));
                assert!(read.is_ok(), "{name}, case {case} of seed {seed}");
            }
        }
    }
}
