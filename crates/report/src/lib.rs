//! Cruise reports from text and back, recordings of other layouts into reports, refusals with their position.
//!
//! What it is: [`Reader`] turns the bytes of a cruise report, format 1, into a [`flight::Report`]; [`write()`] turns a
//! report into text; a [`Mapping`] turns delimited text of another layout into reports. What it is not: there is no
//! file access here (bytes and streams come from the caller), nothing is averaged or judged, and the aircraft file is
//! not known here, so the caller compares the number of engines with it.
//!
//! The one design decision: a report is read whole or refused whole. A [`Refusal`] names the first line and character
//! that break a rule of the format, the text found there and what was expected, so that a person can repair it. Unusual
//! but usable data is reported as findings together with the report. No value is clipped, filled in or dropped in
//! silence.
//!
//! Limits: text of more than [`MAXIMUM_TEXT_BYTES`] out of a stream or gzip is refused. Where a recording gives only the
//! fuel flow of all engines and no rotor speed, its range is that of four engines. Free text of the header keeps blanks
//! inside but not at its ends.
//!
//! ```
//! use report::{Reader, TextLayout, write};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = "\
//! CRUISE-REPORT 1
//! AIRCRAFT A320
//! TAIL     D-ABCD
//! FLIGHT   12
//! START    2024-03-01T10:00:00Z
//! ZFW      52000 kg
//! FOB      13000 kg
//! MISSING  N2 ROLL DRIFT
//! TIME ALT SAT MACH VTAS GSPD WF FU
//! s ft degC - kt kt kg/h kg
//! 0 36000 -56.5 0.780 447 450 2400 1200
//! 60 36000 -56.5 0.780 447 450 2410 1240
//! 120 36000 -56.5 0.781 447 451 2405 1280
//! ";
//! let mut reader = Reader::new();
//! let parsed = reader.read(text.as_bytes())?;
//! assert_eq!(parsed.report.columns().mach[2], 0.781);
//!
//! let refusal = reader.read(text.replace("-56.5 0.781", "-56.5 1.781").as_bytes()).unwrap_err();
//! assert_eq!(
//!     refusal.to_string(),
//!     "line 13, column 17: found \"1.781\", expected MACH of 0.1 to 0.99 (limit here 0.99 -)"
//! );
//!
//! let exact = write(&parsed.report, &TextLayout::exact(), &["written by an example"])?;
//! assert_eq!(reader.read(exact.as_bytes())?.report, parsed.report);
//! # Ok(())
//! # }
//! ```

pub mod cruise_text;
mod decode;
mod line;
pub mod mapping;
mod number;
mod refusal;
mod text_layout;
mod write;

pub use cruise_text::{Head, Parsed, Reader, head};
pub use decode::{MAXIMUM_TEXT_BYTES, unpack};
pub use mapping::{Mapping, MappingError};
pub use refusal::{FlightLimit, Found, Refusal, RefusalKind, nearest};
pub use text_layout::{Decimals, TextLayout, UnitUnknown};
pub use write::{WriteError, write};
