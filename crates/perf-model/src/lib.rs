//! Aircraft, drag, TSFC, fuel flow both ways, initial model from a flight-planning guide.

pub mod aircraft;
pub mod forces;
pub mod fuel_flow;
pub mod specific_range;
pub mod state;
pub mod tsfc;

pub use aircraft::{Aircraft, AircraftError};
