//! What these flights cannot tell apart, and which measurements and flights on purpose could.

pub(crate) mod advisor;
pub(crate) mod classes;
pub(crate) mod distances;
pub(crate) mod flights;
pub(crate) mod measurements;
