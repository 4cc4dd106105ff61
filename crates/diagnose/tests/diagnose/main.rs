//! Tests of the whole crate from outside, in one program: each would be linked by itself.

mod applied;
mod bad_input;
mod contributions;
mod engines;
mod floors;
mod outliers;
mod places;
mod throttle;
