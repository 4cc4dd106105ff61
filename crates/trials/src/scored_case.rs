//! What counts of one case: what was planted against what was diagnosed.

use diagnose::{Detectable, Diagnosis, Magnitude};
use flight::effect::EffectId;
use pipeline::diagnosis_document::VerdictKind;
use serde::{Deserialize, Serialize};

/// A probability from which a name counts as sure. Our choice.
const SURE: f64 = 0.9;

/// What was planted in one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Planted {
    /// Names and sizes of the effects; empty for a null. An effect outside the library has a name that no library has.
    pub effects: Vec<(String, f64)>,
    /// Names that were struck from the library for the diagnosis.
    pub struck: Vec<String>,
}

/// What counts of one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// What was planted.
    pub planted: Planted,
    /// The verdict.
    pub verdict: VerdictKind,
    /// Whether it is that a guide's drag is off. Everything below is then of what acts beside it.
    #[serde(default)]
    pub of_table: bool,
    /// The most probable effect, and how probable it is.
    pub top: Option<(String, f64)>,
    /// The three most probable effects.
    pub top_three: Vec<String>,
    /// The verdict's class, as printed.
    pub class: Vec<String>,
    /// The 90 % credible set.
    pub credible: Vec<String>,
    /// Effects that the verdict names.
    pub named: Vec<String>,
    /// Estimated over true size − 1 of the first planted effect, where it is on top.
    pub size_error: Option<f64>,
    /// Whether the 95 % interval holds the true size.
    pub interval_holds: Option<bool>,
    /// Planted less estimated size over the half of the 95 % interval on that side, where it is on top: within ±1 the
    /// interval holds it. `None` in results of older programs too.
    #[serde(default)]
    pub size_position: Option<f64>,
    /// Closure of the whole explainable gap on unseen flights.
    pub closure: Option<f64>,
    /// Share of the planted effect's own gap that the named effects remove, where the caller knows it: it takes the same
    /// flights flown without the effect.
    #[serde(default)]
    pub planted_closure: Option<f64>,
    /// The region reported for the gap, where the caller knows the true one.
    #[serde(default)]
    pub located: Option<Located>,
    /// Rms of the gap before, %.
    pub gap_rms_percent: f64,
    /// Distance of the planted effect from the nearest other one, and from the nearest pair, at typical size.
    pub nearest: Option<(f64, f64)>,
    /// The effect that most probably makes the largest change, all effects looked at at once.
    #[serde(default)]
    pub largest: Option<String>,
    /// The effect that one would name who knows the variances of the clutter, where the caller asked.
    #[serde(default)]
    pub attainable: Option<String>,
}

/// The region reported for the gap against the true one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Located {
    /// Standard deviation of the planted gap within the data, %: how much of it has a place at all.
    pub spread_percent: f64,
    /// Whether a region was reported that is not by chance (p ≤ 0.05); "everywhere" is not a region.
    pub significant: bool,
    /// Whether its first place is along the variable that the planted gap follows closest.
    pub driver_named: bool,
    /// Overlap of the first place with the truly worst region of equal size: intersection over union.
    pub overlap: f64,
}

impl Case {
    /// Takes from a diagnosis what counts.
    #[must_use]
    pub fn from_diagnosis(planted: Planted, found: &Diagnosis) -> Self {
        let of_table = found.verdict.is_of_table();
        let beside = found.verdict.found().map_or(&[][..], |found| &found.beside);
        let top = if of_table {
            beside.first().map(|beside| (beside.effect.to_string(), beside.probability))
        } else {
            found.causes.first().map(|cause| (cause.effect.to_string(), cause.probability))
        };
        let own = planted.effects.first();
        let detectable = own.and_then(|(name, _)| detectable_of(found, name));
        let class = if of_table {
            beside.iter().flat_map(|beside| names(&beside.class)).collect()
        } else {
            names(found.verdict.class())
        };
        let total: f64 = found.causes.iter().map(|cause| cause.probability).sum();
        let mut sum = 0.0;
        let mut credible = Vec::new();
        for cause in &found.causes {
            if sum >= 0.9 * total {
                break;
            }
            sum += cause.probability;
            credible.push(cause.effect.to_string());
        }
        let magnitude = own
            .zip(found.causes.iter().find(|cause| cause.effect != EffectId::DragTable))
            .filter(|((name, _), cause)| *name == cause.effect.to_string())
            .map(|((_, size), cause)| (*size, &cause.magnitude));
        Self {
            verdict: VerdictKind::from(&found.verdict),
            of_table,
            top,
            top_three: found.causes.iter().take(3).map(|cause| cause.effect.to_string()).collect(),
            class,
            credible,
            named: found
                .verdict
                .effects()
                .iter()
                .filter(|id| **id != EffectId::DragTable)
                .map(ToString::to_string)
                .collect(),
            planted_closure: None,
            located: None,
            size_error: magnitude.map(|(size, found)| found.value / size - 1.0),
            interval_holds: magnitude
                .map(|(size, found)| found.ci95[0] <= size && size <= found.ci95[1]),
            size_position: magnitude.and_then(|(size, found)| position(size, found)),
            closure: found.verdict.closure().map(|closure| closure.share),
            gap_rms_percent: found.gap.rms_percent,
            nearest: detectable.map(|d| (d.nearest_other, d.nearest_pair)),
            largest: found.contributions.first().map(|largest| largest.effect.to_string()),
            attainable: None,
            planted,
        }
    }

    /// Takes the distance of the planted effect from others out of a diagnosis with the whole library: one that was struck
    /// does not know it.
    pub fn take_distance(&mut self, whole: &Diagnosis) {
        let own = detectable_of(whole, self.truth());
        self.nearest = own.map(|d| (d.nearest_other, d.nearest_pair));
    }

    pub(crate) fn is_null(&self) -> bool {
        self.planted.effects.is_empty()
    }

    pub(crate) fn is_pair(&self) -> bool {
        self.planted.effects.len() > 1
    }

    /// No library has what was planted.
    pub(crate) fn is_outside(&self) -> bool {
        self.planted.effects.iter().any(|(name, _)| EffectId::from_name(name).is_none())
    }

    pub(crate) fn is_single(&self) -> bool {
        !self.is_null() && !self.is_pair() && !self.is_outside() && !self.is_struck()
    }

    pub(crate) fn is_named(&self, name: &str) -> bool {
        self.verdict == VerdictKind::Effects && self.named.iter().any(|n| n == name)
    }

    pub(crate) fn is_struck(&self) -> bool {
        self.planted.effects.iter().any(|(name, _)| self.planted.struck.contains(name))
    }

    pub(crate) fn truth(&self) -> &str {
        self.planted.effects.first().map_or("nothing", |(name, _)| name)
    }

    pub(crate) fn top_is(&self, name: &str) -> bool {
        self.top.as_ref().is_some_and(|(top, _)| top == name)
    }

    pub(crate) fn on_top(&self) -> bool {
        self.top_is(self.truth())
    }

    pub(crate) fn is_sure(&self) -> bool {
        self.verdict == VerdictKind::Effects && self.top.as_ref().is_some_and(|t| t.1 >= SURE)
    }

    /// The verdict names effects, and the planted one is the most probable.
    pub(crate) fn names_first(&self) -> bool {
        self.names_effects() && self.on_top()
    }

    pub(crate) fn names_effects(&self) -> bool {
        self.verdict == VerdictKind::Effects && !self.is_table_alone()
    }

    /// A guide's drag is off, and nothing else is named.
    pub(crate) fn is_table_alone(&self) -> bool {
        self.of_table && self.top.is_none()
    }

    /// Nothing is said of what was asked for: no gap, or a guide's drag alone.
    pub(crate) fn is_silent(&self) -> bool {
        self.verdict == VerdictKind::NoGap || self.is_table_alone()
    }

    /// The verdict in one name, for the table of confusions.
    pub(crate) fn said(&self) -> String {
        match self.verdict {
            VerdictKind::NoGap => "no_gap".to_owned(),
            VerdictKind::OutsideLibrary => "outside_library".to_owned(),
            VerdictKind::InsufficientData => "insufficient_data".to_owned(),
            VerdictKind::Effects if self.is_table_alone() => "drag_table".to_owned(),
            VerdictKind::Effects => self.top.as_ref().map_or_else(String::new, |t| t.0.clone()),
        }
    }
}

/// Where a size lies in an interval around an estimate: 0 at the estimate, ±1 at the ends; `None` where it has no length.
fn position(size: f64, found: &Magnitude) -> Option<f64> {
    let away = size - found.value;
    let half = if away < 0.0 { found.value - found.ci95[0] } else { found.ci95[1] - found.value };
    (half > 0.0).then(|| away / half)
}

fn names(effects: &[EffectId]) -> Vec<String> {
    effects.iter().map(ToString::to_string).collect()
}

/// What a diagnosis reports about an effect by name; `None` for one outside its library.
fn detectable_of<'a>(found: &'a Diagnosis, name: &str) -> Option<&'a Detectable> {
    let id = EffectId::from_name(name)?;
    found.detectable.iter().find(|detectable| detectable.effect == id)
}
