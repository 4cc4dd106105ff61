//! The nouns that cruisefit's stages exchange: [`Report`], [`Track`], [`Segment`], [`Observation`], [`Finding`] and
//! everything about a physical [effect](effect::EffectId) except its physics.
//!
//! What it is not: there is no algorithm here. A stage crate depends on this one and never on another stage, so that
//! each can be used alone and replaced.
//!
//! The one design decision: plain data, valid by construction. Types with invariants ([`Report`], [`Track`]) have
//! private fields and one fallible constructor; the others are structs of named values with their unit in the name.
//! A `Report` holds what was sent; nothing that was derived ever overwrites it.
//!
//! ```
//! use flight::column::Column;
//!
//! let column = Column::from_name("N2(2)").expect("a column of the format");
//! assert_eq!(column, Column::N2(2));
//! assert_eq!(column.canonical_unit(), "%");
//! ```

pub mod column;
pub mod effect;
mod finding;
mod header;
mod observation;
mod optional_columns;
mod report;
mod segment;
mod track;

pub use finding::{Finding, Severity};
pub use header::{Assumption, FlightIdentity, MissingColumn, ReportHeader, seconds_since_1970};
pub use jiff::Timestamp;
pub use observation::{Observation, ObservationVariance};
pub use optional_columns::{OptionalColumn, OptionalColumns};
pub use report::{FuelFlowColumns, Report, ReportColumns, ReportDataError};
pub use segment::{Cruise, Segment, SegmentMeans};
pub use track::{
    DroppedRun, DroppedRunReason, SampleRun, Sampling, TemperatureSource, Track, TrackDataError,
    TrackParts,
};

/// Largest number of engines that a report may have.
pub const MAXIMUM_ENGINES: usize = 4;
