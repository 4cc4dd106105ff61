//! The conclusion of a diagnosis.

use effects::Variable;
use flight::effect::EffectId;

use crate::output::measurement::Separation;

/// The conclusion.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// No gap beyond the noise.
    NoGap,
    /// Too little to say anything.
    InsufficientData(Insufficient),
    /// A gap that is real and that no library effect explains.
    OutsideLibrary(Unexplained),
    /// One effect, or a set acting together.
    Effects(Found),
}

/// Why the data is too little for a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Insufficient {
    /// No segment lies inside the drag table.
    NothingInside {
        /// Segments that were given.
        segments: usize,
    },
    /// Too few flights.
    Flights {
        /// Flights found.
        found: usize,
        /// Flights needed.
        needed: usize,
    },
    /// Too few segments.
    Segments {
        /// Segments found.
        found: usize,
        /// Segments needed.
        needed: usize,
    },
    /// No effect of the library can be tested.
    NothingTestable,
    /// All segments were flown at the same conditions.
    OneCondition,
    /// The residuals of all segments are equal: fuel flow was computed, not measured.
    ComputedFuelFlow,
}

/// A real gap that no effect of the library explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unexplained {
    /// Probability that this is so.
    pub probability: f64,
    /// How much of the gap the leading effect closes on unseen flights; `None` where the gap is too small to measure it.
    pub closure: Option<Closure>,
    /// The variable that the gap depends on; `None` where no function of one was tried.
    pub variable: Option<Variable>,
    /// The leading effect of the library all the same.
    pub nearest: EffectId,
    /// Share of the explainable gap that it closes: on unseen flights, else on the same ones; `None` where the gap is too
    /// small for either.
    pub nearest_closes: Option<f64>,
}

/// Effects that explain the gap.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Effects that act; never empty. A guide's table that is off comes first, then the largest.
    pub effects: Vec<EffectId>,
    /// Effects that this data cannot tell from the first, itself first; where a table is off, then those that it cannot tell
    /// from what acts beside it.
    pub class: Vec<EffectId>,
    /// Members of the class that are not like the first: alone, and at a size that is usual for them, they may be many standard
    /// deviations away. The probabilities leave them open all the same, acting together with another effect for example.
    pub credible: Vec<EffectId>,
    /// Probability of the first effect.
    pub probability: f64,
    /// What acts beside a guide's table that is off, and no table can hold, the most probable first; else what is named together
    /// with the first effect, with what these flights cannot tell from it.
    pub beside: Vec<Beside>,
    /// How much of the gap the effects close on unseen flights; `None` where the gap is too small to measure it.
    pub closure: Option<Closure>,
    /// What the effects leave that depends on one variable.
    pub rest: Option<Rest>,
    /// Measurements and flights on purpose that would separate the class, the best first.
    pub separations: Vec<Separation>,
}

/// What acts beside a guide's table that is off, or together with the leading effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside {
    /// The effect.
    pub effect: EffectId,
    /// Effects that it may be instead, itself first.
    pub class: Vec<EffectId>,
    /// Probability that it acts.
    pub probability: f64,
}

/// What named effects leave of the gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rest {
    /// What it is.
    pub kind: RestKind,
    /// The variable that it depends on; `None` where no function of one was tried.
    pub variable: Option<Variable>,
}

/// What is left beside a named effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestKind {
    /// The effect itself, in another form than the library's.
    OtherForm,
    /// Something else.
    SomethingElse,
}

/// Share of the explainable gap that is closed on flights that neither choice nor fit has seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closure {
    /// The share; 1 is all of it, below 0 the gap widens.
    pub share: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
}

impl Closure {
    /// Whether it is surely more than a share: the lower end of its interval decides.
    pub(crate) const fn is_surely_more_than(&self, share: f64) -> bool {
        self.ci95[0] > share
    }
}

impl Verdict {
    /// What was found, where effects explain the gap.
    #[must_use]
    pub const fn found(&self) -> Option<&Found> {
        match self {
            Self::Effects(found) => Some(found),
            _ => None,
        }
    }

    /// Whether the drag of a guide is off, which adapting cures.
    #[must_use]
    pub fn is_of_table(&self) -> bool {
        self.effects().first() == Some(&EffectId::DragTable)
    }

    /// The named effects, the largest first; empty where none is named.
    #[must_use]
    pub fn effects(&self) -> &[EffectId] {
        self.found().map_or(&[], |found| &found.effects)
    }

    /// Effects that this data cannot tell from the first, itself first; empty where none is named.
    #[must_use]
    pub fn class(&self) -> &[EffectId] {
        self.found().map_or(&[], |found| &found.class)
    }

    /// How much of the gap closes on unseen flights; `None` where there is none or it is too small.
    #[must_use]
    pub const fn closure(&self) -> Option<Closure> {
        match self {
            Self::NoGap | Self::InsufficientData(_) => None,
            Self::OutsideLibrary(unexplained) => unexplained.closure,
            Self::Effects(found) => found.closure,
        }
    }
}
