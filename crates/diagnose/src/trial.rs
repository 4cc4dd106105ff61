//! Scoring of blind trials.
