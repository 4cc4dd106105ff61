//! Months and fleets from what `adapt` has learnt: deviations, changes, events, fuel factors, costs; as tables, JSON and text.
//!
//! [`TailDeviations`] turns a tail's model and segments, or what was kept of them flight by flight ([`MonitoredFlight`]), into a
//! deviation per flight, crate `monitor` reads the series, and
//! [`MonitorDocument`] holds every result once: the CSV tables ([`tables`]), the JSON and the text are made from it.

mod deviations;
mod document;
mod events;
mod fleet;
mod flights;
mod flights_table;
mod order;
mod tables;
mod tail;
mod text;
mod told;

pub use ::monitor::airbus::monitored_fuel_factor_percent;
pub use deviations::{BeforeLearning, TailDeviations};
pub use document::{
    AirbusTerms, AlertDocument, ChangeDocument, CostDocument, EventDocument, Figure, FleetDocument,
    FlightDocument, MonitorDocument, MonthDocument, SCHEMA, StepInGapDocument, TailDocument,
    TypeConditions,
};
pub use events::{Event, EventsError, instant, read_events, warn_of_events};
pub use flights::{MeanConditions, MonitoredFlight, curve_of_flights, flights_of};
pub use flights_table::{flights_to_csv, read_flights};
pub use tables::{FLIGHTS, NamedTable, flights_by_tail, tables, tables_but_flights};
pub use tail::{MonitorOptions, Monitored, MonitoredTail, monitor_tail};
pub use text::{Rows, text};
