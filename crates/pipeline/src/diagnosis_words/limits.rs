//! How much is told.

/// Number of causes other than the verdict's that are printed, and their least probability. Our choice: a dozen lines in all.
pub(crate) const OTHERS_TOLD: usize = 3;
pub(crate) const LEAST_TOLD: f64 = 0.02;
/// Measurements or flights that are printed. Our choice: the best two.
pub(crate) const SEPARATIONS_TOLD: usize = 2;
/// Distance, in standard deviations, that the second of them brings about at least. Our choice: below it two effects are of one class.
pub(crate) const TOLD_APART: f64 = 3.0;
/// Probability below which no cause is printed as one. Our choice: more probable than not.
pub(crate) const PROBABLE: f64 = 0.5;
