//! Cruise-report text and other layouts into [`flight::Report`], and reports back into text.

pub mod cruise_text;
mod decode;
mod line;
pub mod mapping;
mod number;
mod refusal;
mod text_layout;
mod write;

pub use cruise_text::{Parsed, Reader};
pub use decode::{MAXIMUM_TEXT_BYTES, unpack};
pub use mapping::{Mapping, MappingError};
pub use refusal::{Found, Refusal, RefusalKind};
pub use text_layout::{Decimals, TextLayout, UnitUnknown};
pub use write::{WriteError, write};
