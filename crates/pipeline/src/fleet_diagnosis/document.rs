//! A fleet's part of `diagnosis.json`.

use diagnose::{FleetFinding, ModelOf};
use serde::{Deserialize, Serialize};

use super::{DiagnosedFleet, level_name};
use crate::diagnosis_document::MagnitudeRecord;
use crate::statistics::{ErrorStatistics, mean_half_width95_by_flight};

/// Mean gap of a fleet, %, below which nothing is said of it. Our choice: twice the smallest gap of a tail.
const LEAST_SHARED_PERCENT: f64 = 0.3;

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
    /// Mean gap of the tails, whatever makes it; `null` of one tail and in documents of older programs.
    #[serde(default)]
    pub mean_gap_percent: Option<FleetGap>,
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

/// Mean gap of the tails of a type, 100·ln(recorded/predicted) fuel flow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FleetGap {
    /// The mean over tails, each as much.
    pub value: f64,
    /// Its 95 % interval, Student's, by tail.
    pub ci95: [f64; 2],
}

impl FleetGap {
    /// Of tails with these mean gaps; `None` of fewer than two.
    #[must_use]
    pub fn of_tails(gaps_percent: &[f64]) -> Option<Self> {
        let each: Vec<ErrorStatistics> =
            gaps_percent.iter().map(|gap| ErrorStatistics::from_errors(&[*gap])).collect();
        let half = mean_half_width95_by_flight(&each)?;
        let value = ErrorStatistics::from_errors(gaps_percent).mean?;
        Some(Self { value, ci95: [value - half, value + half] })
    }

    /// Whether all tails share something, whatever it is: its interval does not hold zero, and it is no trifle.
    #[must_use]
    pub fn is_shared(&self) -> bool {
        self.ci95[0] * self.ci95[1] > 0.0 && self.value.abs() >= LEAST_SHARED_PERCENT
    }

    /// "burn 2.06 % (1.95 to 2.17) more than the model says".
    #[must_use]
    pub fn in_words(&self) -> String {
        let sign = self.value.signum();
        let mut ends = self.ci95.map(|end| sign * end);
        ends.sort_by(f64::total_cmp);
        format!(
            "burn {:.2} % ({:.2} to {:.2}) {} than the model says",
            self.value.abs(),
            ends[0],
            ends[1],
            if sign > 0.0 { "more" } else { "less" }
        )
    }
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
            mean_gap_percent: fleet.mean_gap(),
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
