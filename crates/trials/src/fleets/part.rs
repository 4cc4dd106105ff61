//! What a plan says of fleets.

use serde::{Deserialize, Serialize};

use crate::plan::once;

/// Fleets of a plan. Only `repeats` is required.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FleetPart {
    /// Tails of a fleet.
    #[serde(default = "twenty")]
    pub tails: usize,
    /// Flights of each.
    #[serde(default = "twelve")]
    pub flights: usize,
    /// How many effects of the type: none or one.
    #[serde(default = "one")]
    pub type_effects: usize,
    /// Share of the tails with an effect of their own or of a sensor, half of them each.
    #[serde(default = "three_tenths")]
    pub disturbed_share: f64,
    /// Share of the tails, others than those, with a step at a date.
    #[serde(default)]
    pub step_share: f64,
    /// Size of a step, % of drag or fuel flow.
    #[serde(default = "once")]
    pub step_percent: f64,
    /// Size of the other effects over the typical size.
    #[serde(default = "once")]
    pub times: f64,
    /// How many fleets.
    pub repeats: usize,
}

const fn twenty() -> usize {
    20
}

const fn twelve() -> usize {
    12
}

const fn one() -> usize {
    1
}

const fn three_tenths() -> f64 {
    0.3
}

/// A fleet before it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FleetSpec {
    /// Its number, from 1.
    pub number: usize,
    /// The part that it belongs to.
    pub part: FleetPart,
    /// 32 random bytes of this fleet alone.
    pub draws: [u8; 32],
}

impl FleetPart {
    /// What distinguishes it from every other part of a plan.
    pub(crate) fn label(&self) -> String {
        format!(
            "fleet/{}/{}/{}/{}/{}/{}/{}",
            self.tails,
            self.flights,
            self.type_effects,
            self.disturbed_share,
            self.step_share,
            self.step_percent,
            self.times
        )
    }

    /// The first value that makes no trial: field, value, what is expected.
    pub(crate) fn wrong(&self) -> Option<(&'static str, String, &'static str)> {
        let checks = [
            ("fleets: tails", self.tails as f64, (3.0, 999.0), "3 to 999"),
            ("fleets: flights", self.flights as f64, (3.0, 5000.0), "3 to 5000"),
            ("fleets: type_effects", self.type_effects as f64, (0.0, 1.0), "0 or 1"),
            ("fleets: disturbed_share", self.disturbed_share, (0.0, 1.0), "0 to 1"),
            (
                "fleets: step_share",
                self.step_share,
                // 0.2 is more than 1 less 0.8 in binary.
                (0.0, 1.0 - self.disturbed_share + 1e-9),
                "0 to what disturbed_share leaves",
            ),
            ("fleets: step_percent", self.step_percent, (0.01, 10.0), "0.01 to 10"),
            ("fleets: times", self.times, (0.01, 10.0), "0.01 to 10"),
            ("fleets: repeats", self.repeats as f64, (1.0, 1000.0), "1 to 1000"),
        ];
        checks
            .into_iter()
            .find(|(_, value, (least, most), _)| !(*least..=*most).contains(value))
            .map(|(field, value, _, expected)| (field, value.to_string(), expected))
    }
}
