//! Law `bayes` as its users see it: on fleets flown in JSBSim, on virtual fleets, and with hostile input.
#![expect(clippy::unwrap_used, clippy::panic, reason = "tests")]
#![expect(clippy::float_cmp, reason = "bits that must be the same")]
#![expect(clippy::disallowed_methods, reason = "golden files are read from the neighboring folder")]

mod addition;
mod fleet;
mod golden;
mod guard;
mod half_life;
mod outliers;
mod resolution;
mod tuning;
mod virtual_fleets;
