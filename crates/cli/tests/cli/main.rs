//! Black-box tests of the binary: what it writes, what it prints, how it exits.

#![expect(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests of a program that reads and writes files; a test that cannot continue must stop"
)]

mod applied;
mod architecture;
mod bad_input;
mod browser;
mod by_hand;
mod check;
mod check_findings;
mod commands;
mod dates;
mod diagnosis;
mod export;
mod few_flights;
mod figures;
mod fleet;
mod folder;
mod gauges;
mod guide;
mod hostile_system;
mod json_schema;
mod left_alone;
mod merging;
mod monitor;
mod not_evaluated;
mod optimum;
mod pages;
mod parquet_points;
mod points;
mod project;
mod recordings;
mod reference;
mod remainder;
mod residuals;
mod same_bytes;
mod state;
mod support;
mod terminal;
mod trial;
mod versions;
