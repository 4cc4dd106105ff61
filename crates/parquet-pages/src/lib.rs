//! Pages of Parquet files: headers, codecs, values. Bytes in, values out: where a page is in its file is known to the caller.
//!
//! A page is what a column is written in: a header in Thrift's compact protocol, then values, packed by a codec. Everything here is
//! refused rather than believed: lengths that lie, places outside their dictionary, what unpacks to more than its header states.
//! Source: the format's specification, `parquet.thrift`, `Encodings.md`, `Compression.md` of apache/parquet-format.

mod codec;
mod column;
mod compact;
mod header;
mod levels;
mod places;

pub use codec::{Codec, MOST_PAGE_BYTES, unpack};
pub use column::{Column, Form, Values};
pub use compact::Compact;
pub use header::{Header, Kind, header};
use levels::{all_are_there, without_levels};

/// Why a page is not read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Damage {
    /// Bytes that are not what the codec writes.
    #[error("a page that is no {codec} data: {reason}")]
    NotPacked {
        /// The codec.
        codec: Codec,
        /// What its reader reports.
        reason: String,
    },
    /// Another length than the header states.
    #[error("a page of {found} bytes, expected {stated}, as its header states")]
    OtherLength {
        /// Bytes that there are.
        found: usize,
        /// Bytes that the header states.
        stated: usize,
    },
    /// More than any writer packs into one page.
    #[error("a page of {stated} bytes, expected {MOST_PAGE_BYTES} at most")]
    TooLarge {
        /// Bytes that the header states.
        stated: usize,
    },
    /// A place that the dictionary does not have.
    #[error("a place that its dictionary of {length} does not have")]
    PlaceUnknown {
        /// Entries of the dictionary.
        length: usize,
    },
    /// Something that a column without missing values has otherwise: it may be sound.
    #[error("a column that is read in another way, for its {0}")]
    Otherwise(&'static str),
    /// Values that end before their page's number of them.
    #[error("a page that ends within its values")]
    EndsEarly,
}
