//! What a fleet's diagnosis says, as types.

use flight::effect::{EffectGroup, EffectId};

use crate::output::Magnitude;

/// Whose an effect is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FleetLevel {
    /// All tails share it: it belongs into the model of the type.
    Type,
    /// One tail has it.
    Tail,
    /// One tail's sensors have it.
    Sensor,
}

impl FleetLevel {
    /// Whose an effect is that one tail has.
    #[must_use]
    pub const fn on_tail(effect: EffectId) -> Self {
        match effect.entry().group {
            EffectGroup::Sensor => Self::Sensor,
            _ => Self::Tail,
        }
    }
}

/// The diagnosis of all tails of a type together.
#[derive(Clone, Debug, PartialEq)]
pub struct FleetDiagnosis {
    /// The effects that were looked for; sizes are in this order.
    pub effects: Vec<EffectId>,
    /// What was found, that of the type first, then tail by tail.
    pub findings: Vec<FleetFinding>,
    /// Expected share of false ones among the findings.
    pub false_share: f64,
    /// Size of every effect in the type.
    pub of_type: Vec<Magnitude>,
    /// Of every tail the size of every effect, that of the type included.
    pub of_tails: Vec<Vec<Magnitude>>,
    /// How much tails differ beyond what was found on them, every effect relative to its typical size.
    pub spread_of_typical: f64,
    /// Amplitude of the smooth discrepancy that all tails share, of fuel flow.
    pub smooth_amplitude: f64,
    /// Noise of each tail over what was stated or learnt.
    pub noise: Vec<f64>,
}

/// An effect that acts in the type or on one tail.
#[derive(Clone, Debug, PartialEq)]
pub struct FleetFinding {
    /// Whose it is, by the effect that leads.
    pub level: FleetLevel,
    /// Every level that its class leaves open, that of the leading effect first.
    pub levels: Vec<FleetLevel>,
    /// The tail, by its place; `None` for the type.
    pub tail: Option<usize>,
    /// The effect.
    pub effect: EffectId,
    /// Effects that these flights cannot distinguish from it, itself first.
    pub class: Vec<EffectId>,
    /// That one of the class acts there.
    pub probability: f64,
    /// That it is this effect.
    pub effect_probability: f64,
    /// In the type: the size that all share. On a tail: by how much it differs from its type.
    pub magnitude: Magnitude,
}
