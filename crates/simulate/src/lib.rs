//! A virtual aircraft (in work).
mod aircraft;
mod effect;
mod fly;
mod plan;
mod random;
mod references;
mod route;
mod sensor;
mod simulation;
mod smooth;
mod state;
pub mod study;
mod terms;
mod trim;
mod truth;
mod vector;
mod weather;

pub use aircraft::{
    AircraftError, AircraftTruth, Airframe, DragConditions, DragRise, Engine, Envelope, Friction,
    InducedDrag, MassLimits, PartLoad, Preset, Richness, RotorDeck, Switch, ThrustLapse, TrimDrag,
    TsfcLaw, ZeroLiftDrag,
};
pub use effect::{OutsideEffect, PlannedEffect, StepTarget, TruthEffect, UnknownEffect};
pub use fly::FlightError;
pub use plan::{
    AircraftChoice, FleetDesign, Flights, Plan, PlanError, Recording, Scatter, SensorChoice,
    SmoothErrorSizes, TailPlan,
};
pub use route::{Autopilot, Change, Earth, FlightPlan, Loading};
pub use sensor::{ChannelSensor, Columns, Faults, Sensors};
pub use simulation::{Flown, Simulation, SimulationError};
pub use state::{EnergyBook, MassBook, TrueState};
pub use terms::References;
pub use trim::{TrimError, TrimPoint, Trimmed};
pub use truth::{EffectTruth, FlightTruth, TRUTH_SCHEMA, TailTruth, Truth};
pub use weather::{Spread, Turbulence, Weather};
