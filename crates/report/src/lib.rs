//! Cruise-report text and other layouts into [`flight::Report`], and reports back into text.

pub mod cruise_text;
mod decode;
mod line;
mod number;
mod refusal;

pub use cruise_text::{Parsed, Reader};
pub use decode::MAXIMUM_TEXT_BYTES;
pub use refusal::{Found, Refusal, RefusalKind};
