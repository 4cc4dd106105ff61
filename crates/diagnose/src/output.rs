//! What a diagnosis says, as types: effects are [`EffectId`]s, places are [`Region`]s, advice is a [`Measurement`].
//!
//! No words and no file format: whoever prints or stores a diagnosis chooses those.

use std::collections::BTreeMap;

use effects::{Effects, Variable};
use flight::effect::{EffectId, HiddenParameter, NeededInput};

use crate::output::addition::Addition;
use crate::output::form::{ActsOn, FoundForm};
use crate::output::measurement::Separation;
use crate::output::note::{LeftOutReason, Note};
use crate::output::region::Region;
use crate::output::verdict::{Closure, Verdict};

pub(crate) mod addition;
pub(crate) mod form;
pub(crate) mod measurement;
pub(crate) mod note;
pub(crate) mod region;
pub(crate) mod verdict;

/// The diagnosis of one set of flights.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnosis {
    /// Flights that were used.
    pub flights: usize,
    /// Segments that were used.
    pub segments: usize,
    /// The gap before anything is added to the model.
    pub gap: Gap,
    /// Where the gap lies, the most striking place first.
    pub r#where: Vec<Slice>,
    /// Causes, the most probable first.
    pub causes: Vec<Cause>,
    /// What each effect makes of the gap, all of the library acting at once; the likeliest largest one first. Empty where no gap
    /// is detected.
    pub contributions: Vec<Contribution>,
    /// Effects that this data cannot test, and what they need.
    pub not_testable: Vec<NotTestable>,
    /// The conclusion.
    pub verdict: Verdict,
    /// What the verdict would add to the model; `None` where it names no effect.
    pub addition: Option<Addition>,
    /// For every testable effect the size that would just be seen, and its class.
    pub detectable: Vec<Detectable>,
    /// Probability that something outside the library acts, and the variable that it depends on.
    pub outside: OutsideLibrary,
    /// The gap of each flight by a choice and fit that has not seen it, in the order of the flights that were used; empty where
    /// closure is not measured.
    pub held_out: Vec<HeldOutFlight>,
    /// Segments left out, by reason.
    pub left_out: BTreeMap<LeftOutReason, usize>,
    /// Outliers among them: their places among all segments that the model can predict, in the order of the input.
    pub outliers: Vec<usize>,
    /// What was assumed, in the order in which it was.
    pub notes: Vec<Note>,
}

/// The gap: ln recorded − ln predicted fuel flow, in per cent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Mean.
    pub mean_percent: f64,
    /// Root mean square.
    pub rms_percent: f64,
    /// 95 % interval of the rms, by flight.
    pub rms_ci95: [f64; 2],
    /// Root mean square that noise alone makes: the propagated one.
    pub noise_floor_rms_percent: f64,
    /// The same by replicates: what differs between like segments of one flight. `None` where closure is not measured, or
    /// for too few of them.
    pub floor_by_replicates_rms_percent: Option<f64>,
    /// What a flexible model leaves on flights it was not fitted to: an upper bound. `None` where closure is not measured.
    pub floor_by_held_out_fit_rms_percent: Option<f64>,
    /// Whether there is more than noise.
    pub detected: bool,
    /// Probability of as large a deviation without any effect, all effects looked at.
    pub p_value: f64,
}

impl Gap {
    /// Where nothing was measured: zeros, and no gap detected.
    pub(crate) const UNMEASURED: Self = Self {
        mean_percent: 0.0,
        rms_percent: 0.0,
        rms_ci95: [0.0; 2],
        noise_floor_rms_percent: 0.0,
        floor_by_replicates_rms_percent: None,
        floor_by_held_out_fit_rms_percent: None,
        detected: false,
        p_value: 1.0,
    };
}

/// A place where the gap lies.
#[derive(Clone, Debug, PartialEq)]
pub struct Slice {
    /// The place.
    pub region: Region,
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
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// The effect.
    pub effect: EffectId,
    /// Probability that it is the larger one of what acts.
    pub probability: f64,
    /// The same without the prior sizes of effects: any effect may change fuel flow by any amount within ±5 %.
    pub probability_flat: f64,
    /// Effects that this data cannot tell from it, itself first.
    pub class: Vec<EffectId>,
    /// Its size.
    pub magnitude: Magnitude,
    /// Root mean square of the gap with it in the model, on flights it was not fitted to; `None` where not computed.
    pub rms_after_percent: Option<f64>,
    /// How much of the explainable gap it closes on those flights.
    pub closure: Option<Closure>,
    /// What it has beyond its size; [`HiddenParameter::None`] for most effects.
    pub hidden: HiddenParameter,
}

/// What one effect makes of the gap, all effects of the library acting at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// The effect.
    pub effect: EffectId,
    /// Its size: mean and 95 % interval.
    pub magnitude: Magnitude,
    /// Root mean square of the change of fuel flow that it makes, %: mean over what is believed of its size.
    pub rms_percent: f64,
    /// 95 % interval of that.
    pub rms_ci95: [f64; 2],
    /// Probability that it makes the largest change of all.
    pub leads: f64,
}

/// The gap of one flight that choice and fit have not seen, root mean squares over its segments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldOutFlight {
    /// Its segments.
    pub segments: usize,
    /// Before anything is added.
    pub before_rms_percent: f64,
    /// With what the other flights would add.
    pub after_rms_percent: f64,
    /// What noise alone is expected to make.
    pub noise_rms_percent: f64,
}

/// A size in the effect's unit ([`flight::effect::EffectEntry::unit`]), with its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnitude {
    /// Size.
    pub value: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// An effect that cannot be tested.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotTestable {
    /// The effect.
    pub effect: EffectId,
    /// What would have to be recorded.
    pub needs: Vec<NeededInput>,
}

/// What an effect would have to be to be seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Detectable {
    /// The effect.
    pub effect: EffectId,
    /// Smallest size, in the effect's unit, seen with about 60 % probability; `None` where it is larger than is believed in of any
    /// aircraft.
    pub smallest: Option<f64>,
    /// Its hidden parameter at that size, the usual value; none of an effect that has a date, which is in the middle of the flights.
    pub hidden: HiddenParameter,
    /// Effects that this data cannot tell from it at typical sizes, itself included.
    pub class: Vec<EffectId>,
    /// Distance at the typical size from the nearest single other effect, in noise standard deviations.
    pub nearest_other: f64,
    /// Distance at the typical size from the nearest pair of others.
    pub nearest_pair: f64,
    /// Measurements and flights on purpose that would tell it, at the typical size, from the nearest other effect of its
    /// class, the best first; empty where none is nearer than three noise standard deviations.
    pub separations: Vec<Separation>,
}

/// Probability of a cause outside the library.
#[derive(Clone, Debug, PartialEq)]
pub struct OutsideLibrary {
    /// Probability.
    pub probability: f64,
    /// Whether every effect of the library was looked for, and not only some that the caller chose.
    pub looked_for_all: bool,
    /// The variable that what is left depends on; `None` where no function of one was tried.
    pub variable: Option<Variable>,
    /// What it acts on.
    pub acts_on: Option<ActsOn>,
    /// Where the verdict is such a cause: functions of single variables that describe it, of different kinds, the most probable
    /// first.
    pub forms: Vec<FoundForm>,
    /// What the first of them would add to the model; only where a person asks for it.
    pub addition: Option<Addition>,
}

impl Diagnosis {
    /// The verdict's effects as they are switched on in a model, hidden parameters included; empty where the verdict names
    /// none.
    #[must_use]
    pub fn effects(&self) -> Effects {
        self.addition.as_ref().map_or_else(Effects::none, |addition| addition.layer().effects)
    }
}
