//! Aircraft, drag, TSFC, fuel flow both ways, initial model from a flight-planning guide.

pub mod aircraft;
mod columns;
mod csv_text;
pub mod forces;
pub mod fuel_flow;
mod guide;
pub mod initial;
pub mod model;
mod points;
pub mod specific_range;
pub mod state;
pub mod tsfc;
pub mod variance;

pub use aircraft::{Aircraft, AircraftError};
pub use csv_text::{CsvColumn, CsvError, CsvErrorReason};
pub use guide::{Guide, GuidePoint};
pub use initial::{InitialModel, InitialModelError, initial_model};
pub use model::{ModelError, ObserveError, PerformanceModel, PredictError, Prediction};
pub use points::{FlightPoint, FlightPointRow, FlightPoints};
pub use state::SegmentState;
