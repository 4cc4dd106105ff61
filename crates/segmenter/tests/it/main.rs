//! Segments of reports, from the report on: against reference results and hand computations.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests; clippy.toml covers test functions only"
)]

mod criteria;
mod golden;
mod missing;
mod pieces;
mod points;
mod properties;
mod support;
