//! What the tests of several crates share. A development dependency only; never published.
//!
//! - [`fleet`]: a virtual fleet on the level of segments, whose truth has other functional forms than the library's.
//! - [`looked_up`]: lookups in a table, for their instructions to be counted.
//! - [`reports`]: the format's sample report, and reports made from a few numbers.
//! - [`outside`]: material that cannot be shipped with the repository, and visible skips where it is absent.
//!
//! It depends on `flight`, `lut`, `perf-model` and `units` and on no crate above them: a crate that `diagnose` tests itself with
//! cannot name `diagnose`, whose types would then exist twice. For the same reason the unit tests inside `src/` of those
//! four crates can use only what is plain text or plain numbers here.
//!
//! ```
//! use test_support::fleet::{Background, Setup, fly};
//!
//! let fleet = fly(1, &Setup { flights: 2, ..Setup::default() }, &[], &Background::default());
//! assert_eq!(fleet.flights.len(), 2);
//! assert_eq!(fleet.flights[0].len(), 10);
//! ```

pub mod fleet;
mod lookups;
pub mod outside;
mod random;
pub mod reports;

pub use lookups::looked_up;
pub use outside::outside_data;
pub use random::Random;
