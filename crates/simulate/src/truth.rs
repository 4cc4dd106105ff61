//! `TRUTH.json`: the truth, for scoring a diagnosis. Never an input of one.

use flight::Timestamp;
use serde::{Deserialize, Serialize};

use flight::effect::StepTarget;

use crate::effect::{TruthEffect, optional_timestamp, timestamp};
use crate::fleet::{FleetEvent, Life, Planted};
use crate::state::{EnergyBook, MassBook};
use crate::terms::{MAXIMUM_ENGINES, References};

/// Name and version of this document.
pub const TRUTH_SCHEMA: &str = "cruisefit.truth/1";

/// The truth of a simulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Always [`TRUTH_SCHEMA`].
    pub schema: String,
    /// The plan's seed.
    pub seed: u64,
    /// Type code of the aircraft.
    pub aircraft: String,
    /// The tails, in the plan's order.
    pub tails: Vec<TailTruth>,
    /// Of a fleet: every planted effect and whose it is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub planted: Vec<Planted>,
    /// Of a fleet: what was done to which tail, as in `EVENTS.csv`, with what it changed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<FleetEvent>,
}

/// The truth of a tail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TailTruth {
    /// Registration.
    pub tail: String,
    /// Its effects.
    pub effects: Vec<EffectTruth>,
    /// Its clutter: small effects.
    pub clutter: Vec<EffectTruth>,
    /// Level and deterioration of its airframe, if the fleet has any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub airframe: Option<Life>,
    /// The same of each engine.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub engines: Vec<Life>,
    /// Conditions at which effects are zero.
    pub references: References,
    /// Its flights, in order.
    pub flights: Vec<FlightTruth>,
}

/// A true effect.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EffectTruth {
    /// Which.
    pub id: TruthEffect,
    /// Size in its unit.
    pub size: f64,
    /// From when, if the plan gave it.
    #[serde(default, with = "optional_timestamp")]
    pub from: Option<Timestamp>,
    /// Until when, if the plan gave it.
    #[serde(default, with = "optional_timestamp", skip_serializing_if = "Option::is_none")]
    pub until: Option<Timestamp>,
    /// `step_change`: of what.
    #[serde(default)]
    pub target: Option<StepTarget>,
    /// Its position, if the plan gave one.
    #[serde(default)]
    pub at: Option<f64>,
}

/// The truth of a flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlightTruth {
    /// Tail.
    pub tail: String,
    /// Flight.
    pub flight: String,
    /// Start of the recording.
    #[serde(with = "timestamp")]
    pub start: Timestamp,
    /// Lower heating value of the fuel, MJ/kg.
    pub lower_heating_value_mj_kg: f64,
    /// Zero-fuel mass, kg.
    pub zero_fuel_mass_kg: f64,
    /// Zero-fuel mass on the load sheet, kg.
    pub recorded_zero_fuel_mass_kg: f64,
    /// Fuel on board at engine start, kg.
    pub fuel_on_board_kg: f64,
    /// Share of each engine in the thrust.
    pub thrust_shares: [f64; MAXIMUM_ENGINES],
    /// Roll held in straight flight when the recording starts, degrees.
    pub roll_trim_deg: f64,
    /// Mean ISA deviation that the flight's air was drawn with, K.
    pub isa_deviation_k: f64,
    /// Minutes in turbulence.
    pub turbulence_min: f64,
    /// Energy balance.
    pub energy: EnergyBook,
    /// Fuel balance.
    pub mass: MassBook,
}
