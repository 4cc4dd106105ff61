//! A virtual aircraft (in work).
mod aircraft;
mod effect;
mod state;
mod terms;
mod trim;

pub use aircraft::*;
pub use effect::*;
pub use terms::References;
pub use trim::{TrimError, TrimPoint, Trimmed};
