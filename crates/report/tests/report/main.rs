//! Tests of the whole crate from outside, in one program: each would be linked by itself.

mod dates;
mod first_mappings;
mod guides;
mod layouts;
mod mapping;
mod mapping_forms;
mod mapping_slips;
mod reading;
mod refusals;
mod start_masses;
mod streaming;
mod tables;
mod writing;
