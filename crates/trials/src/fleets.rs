//! Blind trials of whole fleets: whose an effect is, how many findings are false, and the dates of steps.
//!
//! A fleet flies with effects of the type, of single tails and of their sensors, and with steps at dates. All tails are diagnosed
//! together against a model that a clean tail has taught, and each tail's deviations from that model are searched for changes.
//! The same three worlds as for single cases: [`DrawnFleet`] knows, [`FoundFleet`] is what was found without knowing, and
//! [`FleetTruth`] is sealed before and opened by the scorer.

mod draw;
mod found;
mod part;
mod score;
mod truth;

pub use draw::DrawnFleet;
pub use found::{FoundFleet, MonitoredTail};
pub use part::{FleetPart, FleetSpec};
pub(crate) use score::fleet_groups;
pub use score::{
    FleetGroup, FleetResult, FleetScore, FoundAs, FoundChange, JudgedFinding, LevelFound,
    PlantedFound, StepFound,
};
pub use truth::FleetTruth;
