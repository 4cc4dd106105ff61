//! What the fields of Parquet's metadata are.
//!
//! # Source
//! Apache Parquet, `parquet.thrift` of parquet-format 2.12.

/// Fields of a structure by their numbers.
pub(super) type Structure = &'static [(i64, Kind)];

/// What a field is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// A truth value.
    Truth,
    /// A number of one byte.
    Byte,
    /// A whole number of any length, or one of an enumeration.
    Number,
    /// A number of eight bytes.
    Double,
    /// A text or bytes.
    Bytes,
    /// A structure.
    Fields(Structure),
    /// A list.
    List(&'static Self),
}

use Kind::{Byte, Bytes, Double, Fields, List, Number, Truth};

/// `FileMetaData`.
pub(super) const FILE: Structure = &[
    (1, Number),
    (2, List(&Fields(SCHEMA_ELEMENT))),
    (3, Number),
    (4, List(&Fields(ROW_GROUP))),
    (5, List(&Fields(KEY_VALUE))),
    (6, Bytes),
    (7, List(&Fields(&[(1, NOTHING)]))),
    (8, Fields(&[(1, Fields(ENCRYPTION)), (2, Fields(ENCRYPTION))])),
    (9, Bytes),
];
const NOTHING: Kind = Fields(&[]);
const KEY_VALUE: Structure = &[(1, Bytes), (2, Bytes)];
const ENCRYPTION: Structure = &[(1, Bytes), (2, Bytes), (3, Truth)];

const SCHEMA_ELEMENT: Structure = &[
    (1, Number),
    (2, Number),
    (3, Number),
    (4, Bytes),
    (5, Number),
    (6, Number),
    (7, Number),
    (8, Number),
    (9, Number),
    (10, Fields(LOGICAL_TYPE)),
];
const LOGICAL_TYPE: Structure = &[
    (1, NOTHING),
    (2, NOTHING),
    (3, NOTHING),
    (4, NOTHING),
    (5, Fields(&[(1, Number), (2, Number)])),
    (6, NOTHING),
    (7, Fields(TIME)),
    (8, Fields(TIME)),
    (10, Fields(&[(1, Byte), (2, Truth)])),
    (11, NOTHING),
    (12, NOTHING),
    (13, NOTHING),
    (14, NOTHING),
    (15, NOTHING),
    (16, Fields(&[(1, Byte)])),
    (17, Fields(&[(1, Bytes)])),
    (18, Fields(&[(1, Bytes), (2, Number)])),
];
const TIME: Structure = &[(1, Truth), (2, Fields(&[(1, NOTHING), (2, NOTHING), (3, NOTHING)]))];

const ROW_GROUP: Structure = &[
    (1, List(&Fields(COLUMN_CHUNK))),
    (2, Number),
    (3, Number),
    (4, List(&Fields(&[(1, Number), (2, Truth), (3, Truth)]))),
    (5, Number),
    (6, Number),
    (7, Number),
];
const COLUMN_CHUNK: Structure = &[
    (1, Bytes),
    (2, Number),
    (3, Fields(COLUMN)),
    (4, Number),
    (5, Number),
    (6, Number),
    (7, Number),
    (8, Fields(&[(1, NOTHING), (2, Fields(&[(1, List(&Bytes)), (2, Bytes)]))])),
    (9, Bytes),
];
const COLUMN: Structure = &[
    (1, Number),
    (2, List(&Number)),
    (3, List(&Bytes)),
    (4, Number),
    (5, Number),
    (6, Number),
    (7, Number),
    (8, List(&Fields(KEY_VALUE))),
    (9, Number),
    (10, Number),
    (11, Number),
    (12, Fields(STATISTICS)),
    (13, List(&Fields(&[(1, Number), (2, Number), (3, Number)]))),
    (14, Number),
    (15, Number),
    (16, Fields(&[(1, Number), (2, List(&Number)), (3, List(&Number))])),
    (17, Fields(&[(1, Fields(BOX)), (2, List(&Number))])),
];
const STATISTICS: Structure = &[
    (1, Bytes),
    (2, Bytes),
    (3, Number),
    (4, Number),
    (5, Bytes),
    (6, Bytes),
    (7, Truth),
    (8, Truth),
];
const BOX: Structure = &[
    (1, Double),
    (2, Double),
    (3, Double),
    (4, Double),
    (5, Double),
    (6, Double),
    (7, Double),
    (8, Double),
];
