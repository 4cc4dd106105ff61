//! Tests of the whole crate from outside, in one program: each would be linked by itself.

mod ageing;
mod book;
mod bounded_influence;
mod corruption;
mod jsbsim;
mod monitoring;
mod presets;
mod recordings;
