//! A fleet of one type: what all tails share, what single tails and their sensors have, and what happens to them.
//!
//! A fleet is drawn into tails with effects, each of which knows whose it is (type, tail or sensor). Effects of the fleet are
//! zero at one condition for all tails, the mean over all flights of the fleet: at each tail's own, every tail would have
//! another effect of the type. Draws are keyed by tail, so that another tail or effect moves none of them.

mod draw;
mod life;
mod record;

use flight::Timestamp;
use serde::{Deserialize, Serialize};

use crate::aircraft::Switch;
use crate::effect::PlannedEffect;
use crate::plan::FleetDesign;
use crate::terms::References;

pub(crate) use draw::{DrawnEffect, DrawnFleet, DrawnTail};
pub(crate) use life::Lives;
pub use life::{Life, LifeEvent, Recovery};
pub use record::{FleetEvent, Planted, PlantedLevel, events_csv};

/// A fleet of a plan. Only `tails` is required.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FleetPlan {
    /// How many tails.
    pub tails: usize,
    /// Beginning of their names; a number of three digits follows.
    #[serde(default = "tail_prefix")]
    pub prefix: String,
    /// The flights of each tail.
    #[serde(default)]
    pub flights: Box<FleetDesign>,
    /// Conditions at which its effects are zero; the means over all its flights when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub references: Option<References>,
    /// Effects that all tails share.
    #[serde(default)]
    pub type_effects: Vec<TypeEffect>,
    /// Effects of some tails or of their sensors.
    #[serde(default)]
    pub tail_effects: Vec<TailEffects>,
    /// Dirt of the airframe, and washes.
    #[serde(default)]
    pub airframe: Option<Upkeep>,
    /// Deterioration of each engine, washes and changes of engines.
    #[serde(default)]
    pub engines: Option<Upkeep>,
    /// What is done at a given instant.
    #[serde(default)]
    pub events: Vec<PlannedEvent>,
}

fn tail_prefix() -> String {
    "T-".to_owned()
}

/// An effect of the type.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TypeEffect {
    /// Which, and how large on average.
    pub effect: PlannedEffect,
    /// Standard deviation between tails, relative to the size.
    #[serde(default)]
    pub scatter: f64,
}

/// Effects that each of some tails has: a fault, a sensor that is off, a retrofit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TailEffects {
    /// Which. With `from` they begin at that instant, with `until` they end.
    pub effects: Vec<PlannedEffect>,
    /// Which tails.
    pub of: Chosen,
    /// Instants between which the beginning is drawn, for each tail; instead of `from`.
    #[serde(default, with = "crate::effect::optional_timestamps")]
    pub between: Option<(Timestamp, Timestamp)>,
    /// Standard deviation between tails, relative to the size.
    #[serde(default)]
    pub scatter: f64,
    /// Whether the sign is drawn for each tail.
    #[serde(default)]
    pub either_sign: Switch,
    /// Kind of an event that is written to `EVENTS.csv` when they begin, such as `retrofit`; none when left out.
    #[serde(default)]
    pub event: Option<String>,
}

/// Which tails of a fleet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Chosen {
    /// All.
    All,
    /// These.
    Tails(Vec<String>),
    /// So many, drawn.
    Drawn(usize),
    /// This share of them, drawn.
    Share(f64),
}

/// How airframes or engines deteriorate and what is done about it. Each tail, each engine, is drawn on its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Upkeep {
    /// Standard deviation of the level between tails or engines, %: of the airframe's zero-lift drag, or of TSFC.
    pub level_percent: f64,
    /// Deterioration per year of a clean airframe or a new engine, %.
    pub percent_per_year: f64,
    /// Years of deterioration on the first date, drawn between these.
    pub age_years: (f64, f64),
    /// Days from one wash to the next, drawn between these; no washes when left out.
    pub wash_every_days: Option<(f64, f64)>,
    /// Share of what has gathered that a wash takes back.
    pub wash_takes_back: f64,
    /// Changes of each engine per year. A new one has a level of its own and begins without deterioration.
    pub changes_per_year: f64,
}

impl Default for Upkeep {
    /// Nothing deteriorates. A wash takes back seven tenths, as the falls of the histories do.
    fn default() -> Self {
        Self {
            level_percent: 0.0,
            percent_per_year: 0.0,
            age_years: (0.0, 0.0),
            wash_every_days: None,
            wash_takes_back: 0.7,
            changes_per_year: 0.0,
        }
    }
}

/// Something that is done to tails at a given instant, and written to `EVENTS.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedEvent {
    /// To which tails.
    pub of: Chosen,
    /// When.
    #[serde(with = "crate::effect::timestamp")]
    pub at: Timestamp,
    /// What.
    pub what: Work,
}

/// What is done to a tail.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Work {
    /// The airframe is washed; takes back the share that `airframe` states.
    Wash,
    /// All engines are washed; takes back the share that `engines` states.
    EngineWash,
    /// An engine is exchanged for another of this level, %.
    EngineChange {
        /// Which, from 1.
        engine: u8,
        /// TSFC of the other, % above the type's.
        level_percent: f64,
    },
}
