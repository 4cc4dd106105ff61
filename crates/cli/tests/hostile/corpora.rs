//! The inputs that fuzzing found worth keeping, each of which once reached a part of the program that no other did.

use std::io::Read;
use std::path::Path;

use super::entries::{ENTRIES, Entry};

/// The inputs of a packed corpus: each behind its length in four bytes, little end first.
fn inputs(name: &str) -> Vec<Vec<u8>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = path.join("tests/hostile/corpora").join(name).with_extension("gz");
    let mut packed = flate2::read::GzDecoder::new(std::fs::File::open(path).unwrap());
    let mut inputs = Vec::new();
    let mut length = [0; 4];
    while packed.read_exact(&mut length).is_ok() {
        let mut input = vec![0; usize::try_from(u32::from_le_bytes(length)).unwrap()];
        packed.read_exact(&mut input).unwrap();
        inputs.push(input);
    }
    inputs
}

/// Each is read or refused: what panics is named by its place in the corpus.
fn run(name: &str, entry: Entry) {
    let inputs = inputs(name);
    assert!(inputs.len() > 100, "{name}: {}", inputs.len());
    for (place, input) in inputs.iter().enumerate() {
        let result = std::panic::catch_unwind(|| entry(input));
        assert!(result.is_ok(), "{name}: input {place} of {} bytes", input.len());
    }
}

#[test]
fn every_kept_input_is_read_or_refused() {
    for (name, entry) in ENTRIES {
        run(name, entry);
    }
}

#[test]
fn every_kept_parquet_and_arrow_file_is_read_or_refused() {
    run("columnar", cli::read_columnar);
}
