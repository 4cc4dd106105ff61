//! `PLAN.ron`: the input of a simulation.

mod design;

use serde::{Deserialize, Serialize};
use units::OutOfDomain;

use crate::aircraft::{AircraftError, AircraftTruth, Preset, Switch, TruthPhysics};
use crate::effect::PlannedEffect;
use crate::fleet::FleetPlan;
use crate::route::{Autopilot, Earth, FlightPlan};
use crate::sensor::{Columns, Sensors};
use crate::terms::References;
use crate::weather::Weather;

pub use design::FleetDesign;

/// Most flights of a tail: a fleet's life, and what fits into memory.
pub(crate) const MOST_FLIGHTS: usize = 1_000_000;
pub(crate) use design::legs;

/// A plan: aircraft, weather, sensors, effects, tails and flights. Only `seed` is required, and `tails` or a `fleet`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// All random numbers are derived from it.
    pub seed: u64,
    /// Which aircraft.
    #[serde(default)]
    pub aircraft: AircraftChoice,
    /// The truth's physics beyond the model's equations.
    #[serde(default = "TruthPhysics::full", alias = "richness")]
    pub physics: TruthPhysics,
    /// Which properties of the Earth the truth has.
    #[serde(default = "Earth::full")]
    pub earth: Earth,
    /// The air.
    #[serde(default)]
    pub weather: Weather,
    /// The autopilot.
    #[serde(default)]
    pub autopilot: Autopilot,
    /// The sensors.
    #[serde(default)]
    pub sensors: SensorChoice,
    /// The recorded columns.
    #[serde(default)]
    pub columns: Columns,
    /// What differs from flight to flight.
    #[serde(default)]
    pub scatter: Scatter,
    /// How it is recorded.
    #[serde(default)]
    pub recording: Recording,
    /// Smooth errors of drag and fuel flow over the whole envelope, drawn for every tail separately.
    #[serde(default)]
    pub smooth_errors: SmoothErrorSizes,
    /// Effects of every tail.
    #[serde(default)]
    pub effects: Vec<PlannedEffect>,
    /// Clutter: every other effect of the library is present too, with a size drawn with this share of the typical one
    /// as standard deviation; positive for effects that only have one sign. Effects whose coefficient is known are not
    /// included.
    #[serde(default)]
    pub clutter_share: f64,
    /// The tails, one by one.
    #[serde(default)]
    pub tails: Vec<TailPlan>,
    /// A fleet of one type, in addition to them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fleet: Option<FleetPlan>,
}

/// Which aircraft.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum AircraftChoice {
    /// A built-in one.
    Preset(Preset),
    /// One defined in the plan.
    Custom(Box<AircraftTruth>),
}

impl Default for AircraftChoice {
    fn default() -> Self {
        Self::Preset(Preset::CitationX)
    }
}

/// Which sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[expect(clippy::large_enum_variant, reason = "one of these exists in a plan")]
pub enum SensorChoice {
    /// The truth itself.
    Perfect,
    /// The truth, rounded as in the format's example.
    Rounded,
    /// Those of a transport aircraft.
    #[default]
    Transport,
    /// Defined in the plan.
    Custom(Sensors),
}

impl SensorChoice {
    /// The sensors themselves.
    #[must_use]
    pub fn sensors(&self) -> Sensors {
        match self {
            Self::Perfect => Sensors::perfect(),
            Self::Rounded => Sensors::rounded(),
            Self::Transport => Sensors::transport(),
            Self::Custom(sensors) => *sensors,
        }
    }
}

/// Quantities that differ from flight to flight, and are constant within one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Scatter {
    /// Standard deviation of the fuel's heating value, %.
    pub heating_value_percent: f64,
    /// Standard deviation of true minus recorded zero-fuel mass, % of maximum zero-fuel mass.
    pub zero_fuel_mass_percent: f64,
    /// Standard deviation of what an engine's thrust is drawn with, %, before all are divided by their mean: √(1 − 1/engines) of it
    /// is left about the mean, 0.71 for two engines.
    pub throttle_split_percent: f64,
    /// Standard deviation of the roll held in straight flight, degrees.
    pub roll_trim_deg: f64,
    /// Standard deviation of the change of that roll, degrees per hour.
    pub roll_trim_drift_deg_h: f64,
    /// Roll at which a crew trims, degrees: no more than this is held.
    pub roll_trim_limit_deg: f64,
}

impl Default for Scatter {
    /// Heating value and mass as in the gap diagnosis' prototype (0.3 %, 80 kg of 11.1 t), the rest our choice.
    fn default() -> Self {
        Self {
            heating_value_percent: 0.3,
            zero_fuel_mass_percent: 0.7,
            throttle_split_percent: 0.7,
            roll_trim_deg: 0.45,
            roll_trim_drift_deg_h: 0.1,
            roll_trim_limit_deg: 0.65,
        }
    }
}

impl Scatter {
    /// All flights alike.
    #[must_use]
    pub const fn none() -> Self {
        Self {
            heating_value_percent: 0.0,
            zero_fuel_mass_percent: 0.0,
            throttle_split_percent: 0.0,
            roll_trim_deg: 0.0,
            roll_trim_drift_deg_h: 0.0,
            roll_trim_limit_deg: 0.65,
        }
    }
}

/// How flights are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Recording {
    /// Interval of the samples, s.
    pub interval_s: f64,
    /// Longest step of the simulation, s; at most 1.
    pub longest_step_s: f64,
    /// Minutes between top of climb and the start of the recording.
    pub after_top_of_climb_min: f64,
    /// Whether the true state of each sample is kept.
    pub true_states: Switch,
}

impl Default for Recording {
    /// Ghazi et al. (2020): every 60 s, from 15 min after top of climb.
    fn default() -> Self {
        Self {
            interval_s: 60.0,
            longest_step_s: 1.0,
            after_top_of_climb_min: 15.0,
            true_states: Switch::Off,
        }
    }
}

/// Standard deviations of smooth errors, %.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SmoothErrorSizes {
    /// Of drag.
    pub drag_percent: f64,
    /// Of fuel flow.
    pub fuel_flow_percent: f64,
}

/// One tail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TailPlan {
    /// Registration, as `TAIL` in reports.
    pub tail: String,
    /// Effects of this tail, beyond those of all.
    #[serde(default)]
    pub effects: Vec<PlannedEffect>,
    /// TSFC of each engine above new, %.
    #[serde(default)]
    pub engine_deterioration_percent: Vec<f64>,
    /// Conditions at which effects are zero; when left out, the means over the tail's flights, over those of all tails in a plan
    /// with effects of all, over those of the fleet in a plan with a fleet.
    #[serde(default)]
    pub references: Option<References>,
    /// Its flights.
    pub flights: Flights,
}

/// The flights of a tail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Flights {
    /// One by one.
    Listed(Vec<FlightPlan>),
    /// Drawn from ranges.
    Designed(Box<FleetDesign>),
}

/// Why a plan cannot be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// The text is not RON of this shape.
    #[error("plan: {0}")]
    Format(#[from] ron::error::SpannedError),
    /// The aircraft is invalid.
    #[error(transparent)]
    Aircraft(#[from] AircraftError),
    /// A number outside reasonable limits.
    #[error("plan: {0}")]
    Value(#[from] OutOfDomain),
    /// Two tails of one name: their streams would be the same.
    #[error("plan: tail {tail} occurs twice")]
    DoubledTail {
        /// The name.
        tail: String,
    },
    /// An effect that a tail carries twice, without dates that distinguish the two.
    #[error("plan: tail {tail} has the effect {effect} twice")]
    DoubledEffect {
        /// The tail.
        tail: String,
        /// The effect's name.
        effect: String,
    },
    /// Two flights of a tail with one name: the second report would replace the first.
    #[error("plan: tail {tail} has the flight {flight} twice")]
    DoubledFlight {
        /// The tail.
        tail: String,
        /// The flight.
        flight: String,
    },
    /// Neither tails nor a fleet.
    #[error("plan: no tail; `tails` or `fleet` is needed")]
    NoTails,
    /// A tail that the fleet does not have.
    #[error("plan: the fleet has no tail {tail}")]
    UnknownTail {
        /// The name.
        tail: String,
    },
    /// A tail without flights.
    #[error("plan: tail {tail} has no flight")]
    NoFlights {
        /// The name.
        tail: String,
    },
    /// A flight without a route.
    #[error("plan: tail {tail} flight {flight} has {found} waypoints, at least 2 are needed")]
    Waypoints {
        /// Tail.
        tail: String,
        /// Flight.
        flight: String,
        /// How many it has.
        found: usize,
    },
    /// An effect of an engine that the aircraft does not have.
    #[error("plan: {effect} on an aircraft with {engines} engines")]
    Engine {
        /// The effect's name.
        effect: String,
        /// Engines of the aircraft.
        engines: usize,
    },
    /// A designed flight that the aircraft cannot fly anywhere in the ranges.
    #[error("plan: tail {tail}: no flight within the ranges can be flown in {tries} tries")]
    Infeasible {
        /// Tail.
        tail: String,
        /// Draws made.
        tries: usize,
    },
}

impl Plan {
    /// From the text of a plan.
    ///
    /// # Errors
    /// [`PlanError::Format`] with line and column. Numbers are checked when the plan becomes a simulation.
    pub fn from_ron(text: &str) -> Result<Self, PlanError> {
        let options = ron::Options::default()
            .with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        Ok(options.from_str(text)?)
    }

    /// As the text of a plan.
    ///
    /// # Errors
    /// None in practice: every part of a plan has a text.
    pub fn to_ron(&self) -> Result<String, ron::Error> {
        let options = ron::Options::default()
            .with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        options.to_string_pretty(self, ron::ser::PrettyConfig::default())
    }

    /// A plan of one designed tail, everything else by default.
    #[must_use]
    pub fn of_one_tail(seed: u64, tail: &str, design: FleetDesign) -> Self {
        Self {
            seed,
            aircraft: AircraftChoice::default(),
            physics: TruthPhysics::full(),
            earth: Earth::full(),
            weather: Weather::default(),
            autopilot: Autopilot::default(),
            sensors: SensorChoice::default(),
            columns: Columns::default(),
            scatter: Scatter::default(),
            recording: Recording::default(),
            smooth_errors: SmoothErrorSizes::default(),
            effects: Vec::new(),
            clutter_share: 0.0,
            tails: vec![TailPlan {
                tail: tail.to_owned(),
                effects: Vec::new(),
                engine_deterioration_percent: Vec::new(),
                references: None,
                flights: Flights::Designed(Box::new(design)),
            }],
            fleet: None,
        }
    }
}
