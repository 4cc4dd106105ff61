//! Parquet and Arrow files.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cli::read_columnar(bytes));
