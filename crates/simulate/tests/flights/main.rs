//! The crate from the point of view of its users: flights, effects, plans.
#![allow(clippy::unwrap_used, reason = "helpers of tests, which clippy does not take for tests")]
#![allow(clippy::float_cmp, reason = "same input, same bits")]

mod common;
mod effects;
mod fleets;
mod motion;
mod plans;
