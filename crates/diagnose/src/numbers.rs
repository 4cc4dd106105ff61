//! The list of every number that decides.

use crate::deciding::DecidingNumber;
use crate::{priors, thresholds};

/// Every number of this crate that decides what is believed or what is answered, in groups.
///
/// The constants that are used and this list are made from one definition. The book's page "Every number that decides" is made
/// from it.
#[must_use]
pub fn numbers_that_decide() -> Vec<DecidingNumber> {
    let mut numbers = priors::numbers();
    numbers.extend(thresholds::numbers());
    numbers
}
