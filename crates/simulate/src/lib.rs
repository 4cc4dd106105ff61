//! A virtual aircraft: cruise reports with a known truth.
//!
//! What it is: a point-mass aircraft with an autopilot, flown second by second through wind, temperature and turbulence
//! over a round and rotating Earth, recorded by sensors with errors, with any effect of the library switched on in the
//! truth's own form, and some that no library has. It replaces a level-D simulator and is the basis of blind trials.
//! What it is not: a flight simulator (no climb, no stick, no pitch dynamics), or a performance model: it shares the
//! atmosphere with the other crates and none of the equations that are fitted to it.
//!
//! The one design decision: every random quantity has its own stream, keyed by seed, tail, flight and purpose. So a
//! flight is the same bytes whatever the order and the threads, and an effect changes what it should, but no weather
//! and no load sheet.
//!
//! Limits: the presets are synthetic; weather is frozen, the same at all levels, and drawn for each flight separately;
//! the autopilot uses the truth, not its sensors. Equations `[virtual.N]` and `[flow.N]` are in the book, pages "The
//! virtual aircraft" and "Level flight in geostrophic wind". No files, threads or clock: text in, data out.
//!
//! ```
//! use simulate::{Plan, Simulation};
//!
//! let plan = Plan::from_ron(
//!     r#"(
//!         seed: 2020,
//!         effects: [(id: "wave_drag", size: 0.006)],
//!         tails: [(tail: "T-001", flights: Designed((flights: 2, duration_h: (0.5, 0.5))))],
//!     )"#,
//! )?;
//! let simulation = Simulation::new(plan)?;
//! let flown = simulation.fly(1)?;
//! assert_eq!(flown.report.len(), 31);
//! assert!(flown.truth.energy.residual().abs() < 1e-6);
//! assert_eq!(simulation.fly(1)?.report, flown.report);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod aircraft;
mod effect;
mod fleet;
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
    InducedDrag, MassLimits, PartLoad, Preset, RotorDeck, Switch, ThrustLapse, TrimDrag,
    TruthPhysics, TsfcLaw, ZeroLiftDrag,
};
pub use effect::{OutsideEffect, PlannedEffect, TruthEffect, UnknownEffect};
pub use fleet::{
    Chosen, FleetEvent, FleetPlan, Life, LifeEvent, PlannedEvent, Planted, PlantedLevel, Recovery,
    TailEffects, TypeEffect, Upkeep, Work, events_csv,
};
pub use flight::effect::StepTarget;
pub use fly::FlightError;
pub use plan::{
    AircraftChoice, FleetDesign, Flights, Plan, PlanError, Recording, Scatter, SensorChoice,
    SmoothErrorSizes, TailPlan,
};
pub use route::{Autopilot, Change, Earth, FlightPlan, Loading};
pub use sensor::{ChannelSensor, Columns, DRIFT_TIME_CONSTANT_S, Faults, Sensors};
pub use simulation::{Flown, Simulation, SimulationError};
pub use state::{EnergyBook, MassBook, TrueState};
pub use terms::References;
pub use trim::{TrimError, TrimPoint, Trimmed};
pub use truth::{EffectTruth, FlightTruth, TRUTH_SCHEMA, TailTruth, Truth};
pub use weather::{Spread, Turbulence, Weather};

/// First comment of every simulated report: nobody must mistake it for a recording.
pub const REPORT_COMMENT: &str = "simulated with cruisefit, not a real aircraft";
