//! Months and fleets from what `adapt` has learnt: deviations, changes, events, fuel factors, costs; as tables, JSON and text.
//!
//! [`TailDeviations`] turns a tail's model and segments into a deviation per flight, crate `monitor` reads the series, and
//! [`MonitorDocument`] holds every result once: the CSV tables ([`tables`]), the JSON and the text are made from it.

mod deviations;
mod document;
mod events;
mod tables;
mod tail;
mod text;

pub use deviations::{BeforeLearning, MonitoredFlight, ReferenceConditions, TailDeviations};
pub use document::{
    AirbusTerms, AlertDocument, ChangeDocument, CostDocument, EventDocument, Figure, FleetDocument,
    FlightDocument, MonitorDocument, MonthDocument, ReferenceDocument, SCHEMA, TailDocument,
};
pub use events::{Event, EventsError, read_events};
pub use tables::{NamedTable, tables};
pub use tail::{MonitorOptions, MonitoredTail};
pub use text::{Rows, text};
