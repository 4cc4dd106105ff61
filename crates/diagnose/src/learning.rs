//! How a baseline is learnt from the residuals of clean flights.

mod by_scales;
mod channel;
mod correlation;
mod deck;
mod dials;
mod evidence;
mod fit;
mod guide;
mod learn;
mod n2_rows;
mod outliers;
mod physical;
mod posterior;
mod prior;
mod rows;
mod sums;
mod turned;
mod unseen;

#[cfg(test)]
pub(crate) mod tests;
