//! Where the gap lies.

pub(crate) mod acceleration;
pub(crate) mod binned_variable;
pub(crate) mod draws;
pub(crate) mod find;
pub(crate) mod likelihood;
pub(crate) mod members;
pub(crate) mod named;
mod null;
pub(crate) mod regions;
pub(crate) mod segment_gaps;
pub(crate) mod told;
