//! Local adaptation of a drag table to observations.
