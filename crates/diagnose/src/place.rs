//! Where the gap lies.

pub(crate) mod binned_variable;
mod draws;
pub(crate) mod find;
mod likelihood;
pub(crate) mod members;
mod null;
mod regions;
pub(crate) mod segment_gaps;
