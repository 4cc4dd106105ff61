//! The scores of blind trials: one table, from which plans, `trials.json` and `trials.md` take them.

use std::collections::BTreeMap;

use flight::effect::EffectId;
use pipeline::diagnosis_document::VerdictKind;
use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize, Serializer};

use crate::calibration::{self, CalibrationBin};
use crate::scored_case::{Case, Located};
use crate::share::Share;

/// Distance from the nearest pair, in standard deviations, from which a struck effect cannot be imitated. Our choice.
const INIMITABLE: f64 = 5.0;
/// Distance from the nearest other effect, in standard deviations, from which an effect can be distinguished. Our choice.
const SEPARABLE: f64 = 4.0;
/// Gap above which closure is scored, %: below, noise decides how much of it closes. Our choice.
const CLOSABLE: f64 = 0.5;
/// Standard deviation of the planted gap within the data above which the gap has a place, %. Our choice.
const PLACED: f64 = 0.35;

/// One score, as it is reported.
#[derive(Clone, Copy, Debug)]
pub struct Score {
    /// What it is called, in a plan and in `trials.json` in snake case.
    pub name: ScoreName,
    /// Its row in the tables of `trials.md`, from 1; `None` where it is in `trials.json` alone.
    pub row: Option<u8>,
    /// What it is, for people.
    pub words: &'static str,
    of: fn(&SortedCases<'_>) -> Reached,
}

/// Makes the enum of names and the table of scores from one list, so that neither can lack what the other has.
macro_rules! scores {
    ($($name:ident, $row:expr, $words:literal, $of:expr;)*) => {
        /// The name of a score.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum ScoreName {
            $(#[doc = $words] $name,)*
        }

        /// Every score, in the order of `trials.json`.
        pub const SCORES: &[Score] = &[
            $(Score { name: ScoreName::$name, row: $row, words: $words, of: $of },)*
        ];
    };
}

scores! {
    Reported, Some(1), "A gap is reported where an effect is planted",
        |s| share(&s.planted, |c| !c.is_silent());
    TopOne, Some(2), "The planted effect is on top, of all reported",
        |s| share(&s.reported, Case::names_first);
    LeadsCauses, Some(3), "The planted effect leads the list of causes, whatever the verdict",
        |s| share(&s.planted, Case::on_top);
    LargestContribution, Some(4),
        "The planted effect makes the largest change, all effects looked at at once",
        |s| share(&s.planted, |c| c.largest.as_deref() == Some(c.truth()));
    AttainableTopOne, Some(5),
        "The ceiling of that: one who knows how all else varies, and the planted size, would name it",
        |s| {
            let known: Vec<&Case> =
                s.planted.iter().copied().filter(|c| c.attainable.is_some()).collect();
            share(&known, |c| c.attainable.as_deref() == Some(c.truth()))
        };
    TopOneSeparable, Some(6),
        "The planted effect is on top where the nearest other is 4 standard deviations away",
        |s| share(&s.separable, Case::names_first);
    TopThree, Some(7), "The planted effect is among the first three",
        |s| share(&s.reported, |c| {
            c.names_effects() && c.top_three.iter().any(|name| name == c.truth())
        });
    Class, Some(8), "The planted effect is on top or in the class of what is",
        |s| share(&s.reported, |c| {
            c.names_effects() && (c.on_top() || c.class.iter().any(|name| name == c.truth()))
        });
    SureAndWrong, Some(9), "Named with probability 0.9 or more, and wrong",
        |s| share(&s.planted, |c| c.is_sure() && !c.on_top());
    Sure, None, "Named with probability 0.9 or more, of all reported",
        |s| share(&s.reported, Case::is_sure);
    Credible, Some(10), "90 % credible sets that hold the planted effect",
        |s| share(&s.reported, |c| c.credible.iter().any(|name| name == c.truth()));
    Silent, Some(16), "No effect planted: no gap reported",
        |s| share(&s.nulls, Case::is_silent);
    Abstained, Some(18),
        "Effect struck from the library, no pair within 5 standard deviations: outside the library",
        |s| share(&s.struck, |c| c.verdict == VerdictKind::OutsideLibrary);
    StruckAndSure, Some(19), "Of those: another named with probability 0.9 or more",
        |s| share(&s.struck, Case::is_sure);
    NullAndSure, Some(17), "No effect planted: one named with probability 0.9 or more",
        |s| share(&s.nulls, Case::is_sure);
    Outside, Some(20), "Effect that no library has: outside the library",
        |s| share(&s.outside, |c| c.verdict == VerdictKind::OutsideLibrary);
    OutsideAndSure, Some(21), "Of those: one named with probability 0.9 or more",
        |s| share(&s.outside, Case::is_sure);
    PairExact, Some(22), "Pairs of which both are named and nothing else",
        |s| share(&s.pairs, |c| {
            c.named.len() == 2 && c.planted.effects.iter().all(|(name, _)| c.is_named(name))
        });
    PairClass, Some(23), "Pairs of which both are named or in the class",
        |s| share(&s.pairs, |c| {
            c.planted.effects.iter().all(|(name, _)| c.is_named(name) || c.class.contains(name))
        });
    PairTop, Some(24), "Pairs of which one is on top",
        |s| share(&s.pairs, |c| {
            c.names_effects() && c.planted.effects.iter().any(|(name, _)| c.top_is(name))
        });
    PlaceSignificant, Some(25), "Gaps that vary by 0.35 % with a variable: a place is reported",
        |s| located_share(&s.placed, |l| l.significant);
    PlaceDriver, Some(26), "Of those: the variable that drives the gap is named",
        |s| located_share(&s.placed, |l| l.driver_named);
    PlaceAlarm, Some(28), "No effect planted: a place is reported",
        |s| {
            let located: Vec<&Located> = s.nulls.iter().filter_map(|c| c.located.as_ref()).collect();
            located_share(&located, |l| l.significant)
        };
    PlaceOverlapMedian, Some(27), "Of those: overlap with the truly worst region, median",
        |s| Reached::Figure(median(s.placed.iter().map(|l| l.overlap).collect()));
    Intervals, Some(12), "95 % intervals of size that hold the truth",
        |s| {
            let on_top: Vec<&Case> =
                s.reported.iter().copied().filter(|c| c.interval_holds.is_some()).collect();
            share(&on_top, |c| c.interval_holds == Some(true))
        };
    CalibrationError, Some(11), "Expected calibration error",
        |s| Reached::Mean { value: calibration::error(&s.reported), of: s.reported.len() };
    ClosureMedian, Some(14), "Closure on unseen flights, median over gaps above 0.5 %",
        |s| Reached::Figure(median(closable(&s.reported).filter_map(|c| c.closure).collect()));
    PlantedClosureMedian, Some(15),
        "Share of the planted gap that the named effects remove, median over gaps above 0.5 %",
        |s| Reached::Figure(median(closable(&s.reported).filter_map(|c| c.planted_closure).collect()));
    SizeErrorMedian, Some(13), "Error of size, median",
        |s| Reached::Figure(median(
            s.reported.iter().filter_map(|c| c.size_error).map(f64::abs).collect(),
        ));
}

impl ScoreName {
    /// What is reported of it.
    #[must_use]
    pub fn score(self) -> &'static Score {
        // Enum and table come from one list: the position is the same in both.
        &SCORES[self as usize]
    }
}

/// What a score came to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Reached {
    /// A share of cases.
    Share(Share),
    /// A median; `None` without a case.
    Figure(Option<f64>),
    /// A mean; written as it is even where it is over no case.
    Mean {
        /// The mean.
        value: f64,
        /// Cases that it is over.
        of: usize,
    },
}

impl Reached {
    /// As a number; `None` without a case.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        match *self {
            Self::Share(_) => self.share().map(|share| share.share),
            Self::Figure(value) => value,
            Self::Mean { value, of } => (of > 0).then_some(value),
        }
    }

    /// The share, where it is one and there is a case.
    #[must_use]
    pub fn share(&self) -> Option<Share> {
        match *self {
            Self::Share(share) => (share.of > 0).then_some(share),
            _ => None,
        }
    }
}

impl Serialize for Reached {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Share(share) => share.serialize(serializer),
            Self::Figure(value) => value.serialize(serializer),
            Self::Mean { value, .. } => value.serialize(serializer),
        }
    }
}

/// Scores over cases: in JSON a field for every score of [`SCORES`], calibration and confusions.
#[derive(Clone, Debug, PartialEq)]
pub struct Scores {
    /// In the order of [`SCORES`].
    reached: Vec<Reached>,
    /// Stated probabilities against what is right, of all reported.
    pub calibration: Vec<CalibrationBin>,
    /// Cases by the tenth of its stated distribution in which the planted size lies, where the planted effect is on top.
    pub size_tenths: [usize; 10],
    /// Planted → on top (`no_gap`, `outside_library` where nothing is named) → count.
    pub confusion: BTreeMap<String, BTreeMap<String, usize>>,
}

impl Scores {
    /// Scores cases.
    #[must_use]
    pub fn from_cases(cases: &[Case]) -> Self {
        let sorted = SortedCases::new(cases);
        let mut confusion: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
        for case in cases.iter().filter(|c| !c.is_struck() && !c.is_pair()) {
            *confusion
                .entry(case.truth().to_owned())
                .or_default()
                .entry(case.said())
                .or_default() += 1;
        }
        Self {
            reached: SCORES.iter().map(|score| (score.of)(&sorted)).collect(),
            calibration: calibration::bins(&sorted.reported),
            size_tenths: calibration::size_tenths(&sorted.reported),
            confusion,
        }
    }

    /// What one score came to.
    #[must_use]
    pub fn reached(&self, name: ScoreName) -> Reached {
        self.reached[name as usize]
    }
}

impl Serialize for Scores {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(SCORES.len() + 3))?;
        for (score, reached) in SCORES.iter().zip(&self.reached) {
            map.serialize_entry(&score.name, reached)?;
        }
        map.serialize_entry("calibration", &self.calibration)?;
        map.serialize_entry("size_tenths", &self.size_tenths)?;
        map.serialize_entry("confusion", &self.confusion)?;
        map.end()
    }
}

/// Cases by what they are asked.
struct SortedCases<'a> {
    /// One effect of the library.
    planted: Vec<&'a Case>,
    /// Of those: a gap was reported.
    reported: Vec<&'a Case>,
    /// Of those: the nearest other effect is at least [`SEPARABLE`] away.
    separable: Vec<&'a Case>,
    /// Nothing planted.
    nulls: Vec<&'a Case>,
    /// Struck from the library, and no pair imitates it.
    struck: Vec<&'a Case>,
    /// No library has what was planted.
    outside: Vec<&'a Case>,
    /// Two effects.
    pairs: Vec<&'a Case>,
    /// Regions reported for gaps that vary with a variable.
    placed: Vec<&'a Located>,
}

impl<'a> SortedCases<'a> {
    fn new(cases: &'a [Case]) -> Self {
        let those = |of: &dyn Fn(&Case) -> bool| -> Vec<&'a Case> {
            cases.iter().filter(|case| of(case)).collect()
        };
        let planted = those(&Case::is_single);
        let reported: Vec<&Case> = planted.iter().copied().filter(|c| !c.is_silent()).collect();
        let separable = reported
            .iter()
            .copied()
            .filter(|c| c.nearest.is_some_and(|(other, _)| other >= SEPARABLE))
            .collect();
        // What depends on no variable has no place that could be named: scatter between flights differs by flight at
        // random.
        let has_place = |c: &&Case| {
            EffectId::from_name(c.truth()).is_some_and(|id| !id.entry().driven_by.is_empty())
        };
        let placed = planted
            .iter()
            .copied()
            .filter(has_place)
            .filter_map(|c| c.located.as_ref())
            .filter(|l| l.spread_percent >= PLACED)
            .collect();
        Self {
            nulls: those(&Case::is_null),
            struck: those(&|c| {
                c.is_struck() && c.nearest.is_some_and(|(_, pair)| pair >= INIMITABLE)
            }),
            outside: those(&|c| c.is_outside() && !c.is_struck()),
            pairs: those(&|c| c.is_pair() && !c.is_struck() && !c.is_outside()),
            planted,
            reported,
            separable,
            placed,
        }
    }
}

fn share(cases: &[&Case], yes: impl Fn(&Case) -> bool) -> Reached {
    Reached::Share(Share::among(cases, yes))
}

fn located_share(located: &[&Located], yes: impl Fn(&Located) -> bool) -> Reached {
    Reached::Share(Share::new(located.iter().filter(|l| yes(l)).count(), located.len()))
}

fn closable<'a>(cases: &'a [&'a Case]) -> impl Iterator<Item = &'a Case> {
    cases.iter().copied().filter(|c| c.gap_rms_percent > CLOSABLE)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        n if n % 2 == 1 => Some(values[middle]),
        _ => Some(f64::midpoint(values[middle - 1], values[middle])),
    }
}

#[cfg(test)]
mod tests;
