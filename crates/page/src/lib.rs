//! What a run came to, as one plain page for a performance engineer to read, print and forward.

mod chart;
mod diagnosis;
mod envelope;
mod errors;
mod fleet;
mod frame;
mod place;
mod polars;
mod report;
#[cfg(test)]
mod samples;
mod style;
mod tail;
#[cfg(test)]
mod tests;
mod text;
mod view;

pub use diagnosis::diagnosis;
pub use report::report;
