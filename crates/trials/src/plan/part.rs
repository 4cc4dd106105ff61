//! A part of a plan: model, background, what is planted, how often; and the scores that must be reached.

use serde::{Deserialize, Serialize};

use crate::scores::ScoreName;

/// What the model that is diagnosed was made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReferenceModel {
    /// The truth without the effect, sampled on a fine grid.
    Exact,
    /// A wrong initial model, adapted by law `bayes` to clean flights.
    Adapted,
    /// A guide whose drag is off smoothly, that no flight has taught. What is planted is what no table can hold.
    Initial,
    /// The same guide as rows of fuel flow, made into a model as `cruisefit init` makes it: the aircraft's polynomial through them,
    /// so that it lacks the drag rise too.
    Guide,
    /// As `Exact`, with an aircraft file that states sensors three times better or worse than they are, and nothing of what they
    /// keep through a flight or drift by.
    Misstated,
}

impl ReferenceModel {
    /// Whether it has the error of a guide that no flight has taught.
    pub(super) const fn is_of_guide(self) -> bool {
        matches!(self, Self::Initial | Self::Guide)
    }
}

/// What acts in addition to the planted effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Background {
    /// Noise.
    Clean,
    /// Noise, every other effect small, and smooth errors of the table.
    Clutter,
}

/// What is planted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// One effect of the library; `repeats` times each.
    Single,
    /// Nothing; `repeats` times.
    Null,
    /// One effect, struck from the library of the diagnosis; `repeats` times each.
    Struck,
    /// One effect that no library has; `repeats` times each.
    Outside,
    /// Two effects of the library; `repeats` pairs.
    Pair,
}

/// A part of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Which model.
    #[serde(rename = "denied")]
    pub reference_model: ReferenceModel,
    /// Which background.
    pub background: Background,
    /// What is planted.
    pub kind: Kind,
    /// Size over the typical size. Effects whose coefficient is known are only flown at 1.
    #[serde(default = "super::once")]
    pub times: f64,
    /// Where given, sizes are drawn from `times` to this, evenly in their logarithm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub times_to: Option<f64>,
    /// How often.
    pub repeats: usize,
}

/// A score that must be reached.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Floor {
    /// Of which model.
    #[serde(rename = "denied")]
    pub reference_model: ReferenceModel,
    /// On which background.
    pub background: Background,
    /// At which size.
    #[serde(default = "super::once")]
    pub times: f64,
    /// Which score.
    pub score: ScoreName,
    /// Least value that passes.
    #[serde(default)]
    pub least: Option<f64>,
    /// Largest value that passes.
    #[serde(default)]
    pub most: Option<f64>,
}

impl Part {
    /// What distinguishes it from every other part of a plan.
    pub fn label(&self) -> String {
        let Self { reference_model, background, kind, times, .. } = self;
        let to = self.times_to.map_or_else(String::new, |to| format!("-{to}"));
        format!("{reference_model:?}/{background:?}/{kind:?}/{times}{to}")
    }
}
