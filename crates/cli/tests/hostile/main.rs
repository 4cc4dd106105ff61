//! Hostile input: a value or a refusal, never a panic, a hang or memory without bounds.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![expect(clippy::disallowed_methods, reason = "tests write files and run the program")]

mod bounded;
mod corpora;
mod edited;
#[allow(dead_code, unreachable_pub, reason = "the fuzz targets share this file")]
mod entries;
mod injected;
