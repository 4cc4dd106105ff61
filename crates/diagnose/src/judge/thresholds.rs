//! Thresholds of the decision rule.

/// A gap counts as real when nothing at all is less probable than this.
pub(crate) const CLEAN_PROBABILITY: f64 = 0.05;
/// Probability of a cause outside the library above which it is said.
pub(crate) const OUTSIDE_PROBABILITY: f64 = 0.5;
/// Half width of a 95 % interval in standard deviations.
pub(crate) const NORMAL_95: f64 = 1.96;
/// A gap whose excess over the noise floor is less than this share of the floor is too small to measure closure.
pub(crate) const SMALLEST_GAP: f64 = 0.15;
