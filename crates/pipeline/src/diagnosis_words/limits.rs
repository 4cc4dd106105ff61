//! How much is told.

use diagnose::Verdict;

/// Number of causes other than the verdict's that are printed, and their least probability. Our choice: a dozen lines in all.
pub(crate) const OTHERS_TOLD: usize = 3;
pub(crate) const LEAST_TOLD: f64 = 0.02;
/// Measurements or flights that are printed. Our choice: the best two.
pub(crate) const SEPARATIONS_TOLD: usize = 2;
/// Distance, in standard deviations, that the second of them brings about at least. Our choice: below it two effects are of one class.
pub(crate) const TOLD_APART: f64 = 3.0;
/// Probability below which no cause is printed as one. Our choice: more probable than not.
const PROBABLE: f64 = 0.5;

/// What is said where no cause stands out, without a stop.
pub const NO_CAUSE_STANDS_OUT: &str = "no cause stands out";

/// Whether a cause of this probability is one to act on: more probable than not.
#[must_use]
pub fn stands_out(probability: f64) -> bool {
    probability >= PROBABLE
}

/// Whether a verdict names effects of which none stands out; that a guide's table is off is named otherwise.
#[must_use]
pub fn is_open(verdict: &Verdict) -> bool {
    let found = verdict.found().filter(|_| !verdict.is_of_table());
    found.is_some_and(|found| !stands_out(found.probability))
}
