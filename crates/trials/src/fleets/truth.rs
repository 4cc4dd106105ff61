//! What is sealed of a fleet.

use serde::{Deserialize, Serialize};
use simulate::Planted;

use super::part::FleetPart;

/// Schema of a fleet's truth.
pub(super) const SEALED_FLEET_SCHEMA: &str = "cruisefit.trial-fleet-truth/1";

/// What was planted in one fleet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FleetTruth {
    /// Always `cruisefit.trial-fleet-truth/1`.
    pub schema: String,
    /// Number of the fleet.
    pub fleet: usize,
    /// The part of the plan.
    pub part: FleetPart,
    /// What was planted and whose it is; a step has a date.
    pub planted: Vec<Planted>,
}

impl FleetTruth {
    /// The text that is sealed, with a final line end.
    ///
    /// # Errors
    /// None that is known: what JSON refuses to write.
    pub fn to_text(&self) -> Result<String, serde_json::Error> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(text)
    }
}
