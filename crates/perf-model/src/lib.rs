//! Aircraft, drag, TSFC, fuel flow both ways, initial model from a flight-planning guide.

pub mod aircraft;
mod columns;
mod csv_text;
pub mod forces;
pub mod fuel_flow;
mod guide;
mod points;
pub mod specific_range;
pub mod state;
pub mod tsfc;

pub use aircraft::{Aircraft, AircraftError};
pub use csv_text::{CsvColumn, CsvError, CsvErrorReason};
pub use guide::{Guide, GuidePoint};
pub use points::{FlightPoint, FlightPointRow, FlightPoints};
