//! A fleet's part of `diagnosis.json`.

use diagnose::{FleetFinding, ModelOf};
use serde::{Deserialize, Serialize};

use super::{DiagnosedFleet, level_name};
use crate::diagnosis_document::MagnitudeRecord;

/// All tails of a type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FleetRecord {
    /// The type.
    pub aircraft_type: String,
    /// `type` where all tails are held against one model, `tail` where each has its own.
    pub model_of: String,
    /// Whether every model has learnt flights; documents of older programs do not say.
    #[serde(default = "taught")]
    pub taught: bool,
    /// What was found, that of the type first, then tail by tail.
    pub findings: Vec<FleetFindingRecord>,
    /// Expected share of false ones among them.
    pub false_share: f64,
    /// How much tails differ beyond what was found on them, every effect relative to its typical size.
    pub spread_of_typical: f64,
    /// Smooth discrepancy that all tails share, % of fuel flow.
    pub smooth_discrepancy_percent: f64,
    /// Sizes in the type.
    pub effects: Vec<FleetEffectRecord>,
    /// The tails.
    pub tails: Vec<FleetTailRecord>,
    /// Tails without a flight inside the table.
    pub left_out: Vec<String>,
}

const fn taught() -> bool {
    true
}

/// An effect that acts in the type or on one tail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FleetFindingRecord {
    /// `type`, `tail` or `sensor`: that of the effect.
    pub level: String,
    /// Every level that the class leaves open, that of the effect first.
    pub levels: Vec<String>,
    /// The tail; `null` for the type.
    pub tail: Option<String>,
    /// The effect.
    pub effect: String,
    /// Effects that these flights cannot distinguish from it, itself first.
    pub class: Vec<String>,
    /// That one of the class acts there.
    pub probability: f64,
    /// That it is this effect.
    pub effect_probability: f64,
    /// In the type: the size that all share. On a tail: by how much it differs from its type.
    pub magnitude: MagnitudeRecord,
}

/// Size of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FleetEffectRecord {
    /// The effect.
    pub effect: String,
    /// Its size, shrunk.
    pub magnitude: MagnitudeRecord,
}

/// A tail of a fleet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FleetTailRecord {
    /// The tail.
    pub tail: String,
    /// Flights that were used.
    pub flights: usize,
    /// Segments that were used.
    pub segments: usize,
    /// Noise over what was stated or learnt.
    pub noise: f64,
    /// Sizes of the effects that were found anywhere, that of the type included.
    pub effects: Vec<FleetEffectRecord>,
}

impl From<&DiagnosedFleet> for FleetRecord {
    fn from(fleet: &DiagnosedFleet) -> Self {
        let diagnosis = &fleet.diagnosis;
        let effect = |place: usize, magnitude: &diagnose::Magnitude| FleetEffectRecord {
            effect: diagnosis.effects[place].to_string(),
            magnitude: MagnitudeRecord::of(diagnosis.effects[place], *magnitude),
        };
        let found = fleet.found_effects();
        let tails = fleet.tails.iter().enumerate().map(|(tail, member)| FleetTailRecord {
            tail: member.tail.clone(),
            flights: member.reduced.flights,
            segments: member.reduced.segments,
            noise: diagnosis.noise[tail],
            effects: found.iter().map(|&k| effect(k, &diagnosis.of_tails[tail][k])).collect(),
        });
        Self {
            aircraft_type: fleet.aircraft_type.clone(),
            model_of: match fleet.model_of {
                ModelOf::Type => "type".to_owned(),
                ModelOf::Tail => "tail".to_owned(),
            },
            taught: fleet.taught,
            findings: diagnosis.findings.iter().map(|found| finding(fleet, found)).collect(),
            false_share: diagnosis.false_share,
            spread_of_typical: diagnosis.spread_of_typical,
            smooth_discrepancy_percent: 100.0 * diagnosis.smooth_amplitude,
            effects: diagnosis.of_type.iter().enumerate().map(|(k, m)| effect(k, m)).collect(),
            tails: tails.collect(),
            left_out: fleet.left_out.clone(),
        }
    }
}

fn finding(fleet: &DiagnosedFleet, found: &FleetFinding) -> FleetFindingRecord {
    FleetFindingRecord {
        level: level_name(found.level).to_owned(),
        levels: found.levels.iter().map(|&level| level_name(level).to_owned()).collect(),
        tail: found.tail.map(|tail| fleet.tails[tail].tail.clone()),
        effect: found.effect.to_string(),
        class: found.class.iter().map(ToString::to_string).collect(),
        probability: found.probability,
        effect_probability: found.effect_probability,
        magnitude: MagnitudeRecord::of(found.effect, found.magnitude),
    }
}
