#![no_main]

#[allow(dead_code)]
#[path = "../../crates/cli/tests/hostile/entries.rs"]
mod entries;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| entries::model(bytes));
