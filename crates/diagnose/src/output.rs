//! The diagnosis of one tail as it is written to `diagnosis.json`.

use std::collections::BTreeMap;

use effects::Effects;
use serde::{Deserialize, Serialize};

use crate::output::addition::Addition;

pub(crate) mod addition;

/// One tail's diagnosis. Field names and meanings are the format's; what it does not name is beside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Diagnosis {
    /// Whose; filled by the caller ("*" for a pool).
    pub tail: String,
    /// Flights that were used.
    pub flights: usize,
    /// Segments that were used.
    pub segments: usize,
    /// The gap before anything is added to the model.
    pub gap: Gap,
    /// Where the gap lies.
    pub r#where: Vec<Slice>,
    /// Causes, the most probable first.
    pub causes: Vec<Cause>,
    /// Effects that this data cannot test, and what they need.
    pub not_testable: Vec<NotTestable>,
    /// What it comes to.
    pub verdict: Verdict,
    /// What the verdict would add to the model; `null` where it names nothing.
    #[serde(default)]
    pub addition: Option<Addition>,
    /// For every testable effect the size that would just be seen, and its class.
    pub detectable: Vec<Detectable>,
    /// Probability that something outside the library acts, and the variable that it hangs on.
    pub outside: OutsideLibrary,
    /// Segments left out, by reason.
    pub left_out: BTreeMap<String, usize>,
    /// What was assumed: references of the data at hand, proxies, robust weights.
    pub notes: Vec<String>,
}

/// The gap: ln recorded − ln predicted fuel flow, in per cent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gap {
    /// Mean.
    pub mean_percent: f64,
    /// Root mean square.
    pub rms_percent: f64,
    /// 95 % interval of the rms, by flight.
    pub rms_ci95: [f64; 2],
    /// Root mean square that noise alone makes: the propagated one.
    pub noise_floor_rms_percent: f64,
    /// The same by replicates: what differs between like segments of one flight. `null` where closure is not measured, or
    /// for too few of them.
    #[serde(default)]
    pub floor_by_replicates_rms_percent: Option<f64>,
    /// What a flexible model leaves on flights it was not fitted to: an upper bound. `null` where closure is not measured.
    #[serde(default)]
    pub floor_by_held_out_fit_rms_percent: Option<f64>,
    /// Whether there is more than noise.
    pub detected: bool,
    /// Probability of as large a deviation without any effect, all effects looked at.
    pub p_value: f64,
}

/// A place where the gap lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Slice {
    /// In words.
    pub slice: String,
    /// Bounds by variable.
    pub bounds: BTreeMap<String, [Option<f64>; 2]>,
    /// Segments in it.
    pub segments: usize,
    /// Mean gap.
    pub mean_gap_percent: f64,
    /// 95 % interval by flight.
    pub ci95: [f64; 2],
    /// Share of the explainable gap.
    pub share_of_gap: f64,
    /// Accounts for the search.
    pub p_value: f64,
}

/// A cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cause {
    /// Name of the effect.
    pub effect: String,
    /// Probability that it is the larger one of what acts.
    pub probability: f64,
    /// Effects that this data cannot tell from it, itself first.
    pub class: Vec<String>,
    /// Its size.
    pub magnitude: Magnitude,
    /// Root mean square of the gap with it in the model, on flights it was not fitted to; `null` where not computed.
    pub rms_after_percent: Option<f64>,
    /// Share of the explainable gap that it closes on those flights.
    pub closure: Option<f64>,
    /// Interval of the closure.
    pub closure_ci95: Option<[f64; 2]>,
    /// Hidden parameters in words ("from 2019-06-02 on fuel flow"); empty for most effects.
    pub hidden: String,
}

/// Size with unit and interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Magnitude {
    /// Size in the effect's unit.
    pub value: f64,
    /// The unit.
    pub unit: String,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// An effect that cannot be tested.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NotTestable {
    /// Name of the effect.
    pub effect: String,
    /// Columns it needs.
    pub needs: Vec<String>,
}

/// Kind of a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VerdictKind {
    /// Nothing beyond the noise.
    NoGap,
    /// One effect, or a set acting together.
    Effects,
    /// A gap that is real and that no library effect explains.
    OutsideLibrary,
    /// Too little to say anything.
    InsufficientData,
}

/// The verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Kind.
    pub kind: VerdictKind,
    /// Effects that act.
    pub effects: Vec<String>,
    /// Effects that this data cannot tell from the first.
    pub class: Vec<String>,
    /// Probability of the first effect.
    pub probability: f64,
    /// Share of the explainable gap closed on unseen flights; `null` where the gap is too small.
    pub closure: Option<f64>,
    /// Its 95 % interval.
    pub closure_ci95: Option<[f64; 2]>,
    /// One sentence or two: what to do.
    pub advice: String,
    /// Measurements and flights on purpose that would separate the class, the best first.
    pub separations: Vec<Separation>,
}

/// A measurement, or flights on purpose, that separate two effects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Separation {
    /// The effect that would be told from the first.
    pub from: String,
    /// What to measure or to fly.
    pub measurement: String,
    /// Distance between them now, in standard deviations.
    pub distance_now: f64,
    /// And with the measurement or the flights.
    pub distance_then: f64,
    /// Of flights on purpose: with as many ordinary flights instead.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance_ordinary_flights: Option<f64>,
}

/// What an effect would have to be to be seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Detectable {
    /// Name of the effect.
    pub effect: String,
    /// Smallest size seen with about 60 % probability; `null` where the data say nothing about it.
    pub smallest: Option<f64>,
    /// Unit of the size.
    pub unit: String,
    /// Effects that this data cannot tell from it at typical sizes, itself included.
    pub class: Vec<String>,
    /// Distance at the typical size from the nearest single other effect, in noise standard deviations.
    pub nearest_other: f64,
    /// Distance at the typical size from the nearest pair of others.
    pub nearest_pair: f64,
    /// Measurements and flights on purpose that would tell it, at the typical size, from the nearest other effect of its
    /// class, the best first; empty where none is nearer than three noise standard deviations.
    #[serde(default)]
    pub separations: Vec<Separation>,
}

/// Probability of a cause outside the library.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutsideLibrary {
    /// Probability.
    pub probability: f64,
    /// The variable that what is left hangs on.
    pub variable: Option<String>,
    /// Whether it acts on thrust (drag, weight), fuel flow or one engine.
    pub acts_on: Option<String>,
}

impl Diagnosis {
    /// The verdict's effects as they are switched on in a model, hidden parameters included; empty where the verdict names
    /// none.
    #[must_use]
    pub fn effects(&self) -> Effects {
        self.addition
            .as_ref()
            .and_then(|addition| addition.layer().ok())
            .map_or_else(Effects::none, |layer| layer.effects)
    }
}

impl Separation {
    /// The distances in words: "3.1 to 5.2 standard deviations from `wave_drag`; six ordinary flights 3.3".
    #[must_use]
    pub fn distances_told(&self) -> String {
        let ordinary = self
            .distance_ordinary_flights
            .map_or_else(String::new, |distance| format!("; six ordinary flights {distance:.1}"));
        format!(
            "{:.1} to {:.1} standard deviations from {}{ordinary}",
            self.distance_now, self.distance_then, self.from
        )
    }
}
