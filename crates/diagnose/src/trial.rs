//! Scores of blind trials: what was planted against what was diagnosed. The planting is the caller's.

pub mod places;

use std::collections::BTreeMap;

use flight::effect::EffectId;
use serde::{Deserialize, Serialize};

use crate::output::{Diagnosis, VerdictKind};

/// A probability from which a name counts as sure.
const SURE: f64 = 0.9;
/// Distance from the nearest pair from which a struck effect cannot be imitated, and from the nearest other from which an
/// effect can be told apart.
const INIMITABLE: f64 = 5.0;
const SEPARABLE: f64 = 4.0;
/// Gap above which closure is scored, and spread within the data above which a gap has a place, %.
const CLOSABLE: f64 = 0.5;
const PLACED: f64 = 0.35;
/// Bins of stated probability for the calibration error.
const BINS: usize = 10;

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
    /// The most probable effect, and how probable it is.
    pub top: Option<(String, f64)>,
    /// The three most probable effects.
    pub top_three: Vec<String>,
    /// The verdict's class, and the class of the top effect at typical sizes.
    pub class: Vec<String>,
    /// The 90 % credible set.
    pub credible: Vec<String>,
    /// Effects that the verdict names.
    pub named: Vec<String>,
    /// Estimated over true size − 1 of the first planted effect, where it is on top.
    pub size_error: Option<f64>,
    /// Whether the 95 % interval holds the true size.
    pub interval_holds: Option<bool>,
    /// Closure of the whole explainable gap on unseen flights.
    pub closure: Option<f64>,
    /// Share of the planted effect's own gap that the named effects remove, where the caller knows it: it takes the same
    /// flights flown without the effect.
    #[serde(default)]
    pub planted_closure: Option<f64>,
    /// Where the gap was said to lie, where the caller knows where it truly lies.
    #[serde(default)]
    pub located: Option<Located>,
    /// Rms of the gap before, %.
    pub gap_rms_percent: f64,
    /// Distance of the planted effect from the nearest other one, and from the nearest pair, at typical size.
    pub nearest: Option<(f64, f64)>,
}

/// Where the gap was said to lie against where it truly lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Located {
    /// Standard deviation of the planted gap within the data, %: how much of it has a place at all.
    pub spread_percent: f64,
    /// Whether a place was reported that is none by chance (p ≤ 0.05), "everywhere" being no place.
    pub significant: bool,
    /// Whether its first place is along the variable that the planted gap follows closest.
    pub driver_named: bool,
    /// Overlap of the first place with the truly worst region of equal size: intersection over union.
    pub overlap: f64,
}

/// A share with its 95 % interval (Wilson).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// Successes.
    pub count: usize,
    /// Trials.
    pub of: usize,
    /// Their ratio; 0 for no trial.
    pub share: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// Scores over cases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    /// Cases with an effect of the library: a gap was reported.
    pub reported: Share,
    /// Of the reported: the planted effect is on top.
    pub top_one: Share,
    /// The same where the nearest other effect is at least 4 standard deviations away.
    pub top_one_separable: Share,
    /// Of the reported: the planted effect is among the three most probable.
    pub top_three: Share,
    /// Of the reported: the planted effect is on top or in the top effect's class.
    pub class: Share,
    /// Named with probability ≥ 0.9 and wrong, of all cases.
    pub sure_and_wrong: Share,
    /// Named with probability ≥ 0.9, of the reported.
    pub sure: Share,
    /// 90 % credible sets that hold the planted effect, of the reported.
    pub credible: Share,
    /// Nulls with the verdict `no_gap`.
    pub silent: Share,
    /// Struck effects that no pair imitates (5 standard deviations): outside the library.
    pub abstained: Share,
    /// Struck effects of that kind that were named surely.
    pub struck_and_sure: Share,
    /// Nulls on which an effect was named with probability ≥ 0.9.
    pub null_and_sure: Share,
    /// Effects that no library has: outside the library.
    pub outside: Share,
    /// Effects that no library has and that were named surely.
    pub outside_and_sure: Share,
    /// Pairs of which the verdict names both and nothing else.
    pub pair_exact: Share,
    /// Pairs of which both are named or in the verdict's class.
    pub pair_class: Share,
    /// Pairs of which one is on top.
    pub pair_top: Share,
    /// Planted gaps that vary by 0.35 % or more within the data: a place was reported.
    pub place_significant: Share,
    /// Of those gaps: the variable that drives the gap was named.
    pub place_driver: Share,
    /// Nulls: a place was reported.
    pub place_alarm: Share,
    /// Median overlap of the place with the truly worst region, over the gaps that vary.
    pub place_overlap_median: Option<f64>,
    /// 95 % intervals of size that hold the truth, where the effect is on top.
    pub intervals: Share,
    /// Expected calibration error of the top effect's probability, over the reported.
    pub calibration_error: f64,
    /// Median closure where the gap is above 0.5 %.
    pub closure_median: Option<f64>,
    /// Median share of the planted effect's own gap that the named effects remove, where the gap is above 0.5 %.
    pub planted_closure_median: Option<f64>,
    /// Median of |size error|.
    pub size_error_median: Option<f64>,
    /// Planted → on top (`no_gap`, `outside_library` where nothing is named) → count.
    pub confusion: BTreeMap<String, BTreeMap<String, usize>>,
}

impl Case {
    /// Takes from a diagnosis what counts.
    #[must_use]
    pub fn of(planted: Planted, found: &Diagnosis) -> Self {
        let top = found.causes.first().map(|cause| (cause.effect.clone(), cause.probability));
        let own = planted.effects.first();
        let detectable =
            own.and_then(|(name, _)| found.detectable.iter().find(|d| d.effect == *name));
        let mut class = found.verdict.class.clone();
        if let Some((name, _)) = &top {
            let typical = found.detectable.iter().find(|d| d.effect == *name);
            class.extend(typical.into_iter().flat_map(|d| d.class.iter().cloned()));
        }
        let total: f64 = found.causes.iter().map(|cause| cause.probability).sum();
        let mut sum = 0.0;
        let mut credible = Vec::new();
        for cause in &found.causes {
            if sum >= 0.9 * total {
                break;
            }
            sum += cause.probability;
            credible.push(cause.effect.clone());
        }
        let magnitude = own
            .zip(found.causes.first())
            .filter(|((name, _), cause)| *name == cause.effect)
            .map(|((_, size), cause)| (*size, &cause.magnitude));
        Self {
            verdict: found.verdict.kind,
            top,
            top_three: found.causes.iter().take(3).map(|cause| cause.effect.clone()).collect(),
            class,
            credible,
            named: found.verdict.effects.clone(),
            planted_closure: None,
            located: None,
            size_error: magnitude.map(|(size, found)| found.value / size - 1.0),
            interval_holds: magnitude
                .map(|(size, found)| found.ci95[0] <= size && size <= found.ci95[1]),
            closure: found.verdict.closure,
            gap_rms_percent: found.gap.rms_percent,
            nearest: detectable.map(|d| (d.nearest_other, d.nearest_pair)),
            planted,
        }
    }

    /// Takes the distance of the planted effect from others out of a diagnosis with the whole library: one that was struck
    /// does not know it.
    pub fn take_distance(&mut self, whole: &Diagnosis) {
        let name = self.truth();
        let own = whole.detectable.iter().find(|d| d.effect == name);
        self.nearest = own.map(|d| (d.nearest_other, d.nearest_pair));
    }

    fn is_null(&self) -> bool {
        self.planted.effects.is_empty()
    }

    fn is_pair(&self) -> bool {
        self.planted.effects.len() > 1
    }

    /// No library has what was planted.
    fn is_outside(&self) -> bool {
        self.planted.effects.iter().any(|(name, _)| EffectId::from_name(name).is_none())
    }

    fn is_single(&self) -> bool {
        !self.is_null() && !self.is_pair() && !self.is_outside() && !self.is_struck()
    }

    fn is_named(&self, name: &str) -> bool {
        self.verdict == VerdictKind::Effects && self.named.iter().any(|n| n == name)
    }

    fn is_struck(&self) -> bool {
        self.planted.effects.iter().any(|(name, _)| self.planted.struck.contains(name))
    }

    fn truth(&self) -> &str {
        self.planted.effects.first().map_or("nothing", |(name, _)| name)
    }

    fn top_is(&self, name: &str) -> bool {
        self.top.as_ref().is_some_and(|(top, _)| top == name)
    }

    fn on_top(&self) -> bool {
        self.top_is(self.truth())
    }

    fn is_sure(&self) -> bool {
        self.verdict == VerdictKind::Effects && self.top.as_ref().is_some_and(|t| t.1 >= SURE)
    }
}

impl Share {
    /// Successes among trials, with Wilson's interval.
    ///
    /// # Source
    /// Wilson, J. Am. Stat. Assoc. 22 (1927).
    #[must_use]
    pub fn of(count: usize, of: usize) -> Self {
        if of == 0 {
            return Self { count, of, share: 0.0, ci95: [0.0, 1.0] };
        }
        let z2 = 1.96 * 1.96;
        let (n, p) = (of as f64, count as f64 / of as f64);
        let center = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
        let half = 1.96 / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
        Self { count, of, share: p, ci95: [(center - half).max(0.0), (center + half).min(1.0)] }
    }

    fn among<'a>(cases: impl IntoIterator<Item = &'a Case>, yes: impl Fn(&Case) -> bool) -> Self {
        let (mut count, mut of) = (0, 0);
        for case in cases {
            of += 1;
            count += usize::from(yes(case));
        }
        Self::of(count, of)
    }
}

/// Scores cases. `struck_distance` tells how far a struck effect is from the nearest pair of others where the case itself
/// does not ([`Case::take_distance`]): its own column is not in the library that was searched.
#[must_use]
pub fn score(cases: &[Case], struck_distance: impl Fn(&str) -> Option<f64>) -> Scores {
    let planted: Vec<&Case> = cases.iter().filter(|c| c.is_single()).collect();
    let reported: Vec<&Case> =
        planted.iter().copied().filter(|c| c.verdict != VerdictKind::NoGap).collect();
    let separable =
        reported.iter().copied().filter(|c| c.nearest.is_some_and(|n| n.0 >= SEPARABLE));
    let nulls = || cases.iter().filter(|c| c.is_null());
    let struck = || {
        cases.iter().filter(|c| {
            let distance = c.nearest.map(|n| n.1).or_else(|| struck_distance(c.truth()));
            c.is_struck() && distance.is_some_and(|d| d >= INIMITABLE)
        })
    };
    let outside = || cases.iter().filter(|c| c.is_outside() && !c.is_struck());
    let pairs = || cases.iter().filter(|c| c.is_pair() && !c.is_struck() && !c.is_outside());
    // What hangs on no variable has no place that could be named: scatter between flights differs by flight at random.
    let has_place = |c: &&Case| {
        EffectId::from_name(c.truth()).is_some_and(|id| !id.entry().driven_by.is_empty())
    };
    let placed = || {
        planted
            .iter()
            .copied()
            .filter(has_place)
            .filter_map(|c| c.located.as_ref())
            .filter(|l| l.spread_percent >= PLACED)
    };
    let mut confusion: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for case in cases.iter().filter(|c| !c.is_struck() && !c.is_pair()) {
        let said = match case.verdict {
            VerdictKind::NoGap => "no_gap".to_owned(),
            VerdictKind::OutsideLibrary => "outside_library".to_owned(),
            VerdictKind::InsufficientData => "insufficient_data".to_owned(),
            VerdictKind::Effects => case.top.as_ref().map_or_else(String::new, |t| t.0.clone()),
        };
        *confusion.entry(case.truth().to_owned()).or_default().entry(said).or_default() += 1;
    }
    let named = |c: &&Case| c.verdict == VerdictKind::Effects;
    Scores {
        reported: Share::among(planted.iter().copied(), |c| c.verdict != VerdictKind::NoGap),
        top_one: Share::among(reported.iter().copied(), |c| named(&c) && c.on_top()),
        top_one_separable: Share::among(separable, |c| named(&c) && c.on_top()),
        top_three: Share::among(reported.iter().copied(), |c| {
            named(&c) && c.top_three.iter().any(|name| name == c.truth())
        }),
        class: Share::among(reported.iter().copied(), |c| {
            named(&c) && (c.on_top() || c.class.iter().any(|name| name == c.truth()))
        }),
        sure_and_wrong: Share::among(planted.iter().copied(), |c| c.is_sure() && !c.on_top()),
        sure: Share::among(reported.iter().copied(), Case::is_sure),
        credible: Share::among(reported.iter().copied(), |c| {
            c.credible.iter().any(|name| name == c.truth())
        }),
        silent: Share::among(nulls(), |c| c.verdict == VerdictKind::NoGap),
        abstained: Share::among(struck(), |c| c.verdict == VerdictKind::OutsideLibrary),
        struck_and_sure: Share::among(struck(), Case::is_sure),
        null_and_sure: Share::among(nulls(), Case::is_sure),
        outside: Share::among(outside(), |c| c.verdict == VerdictKind::OutsideLibrary),
        outside_and_sure: Share::among(outside(), Case::is_sure),
        pair_exact: Share::among(pairs(), |c| {
            c.named.len() == 2 && c.planted.effects.iter().all(|(name, _)| c.is_named(name))
        }),
        pair_class: Share::among(pairs(), |c| {
            c.planted.effects.iter().all(|(name, _)| c.is_named(name) || c.class.contains(name))
        }),
        pair_top: Share::among(pairs(), |c| {
            named(&c) && c.planted.effects.iter().any(|(name, _)| c.top_is(name))
        }),
        place_significant: Share::of(placed().filter(|l| l.significant).count(), placed().count()),
        place_driver: Share::of(placed().filter(|l| l.driver_named).count(), placed().count()),
        place_alarm: {
            let located = || nulls().filter_map(|c| c.located.as_ref());
            Share::of(located().filter(|l| l.significant).count(), located().count())
        },
        place_overlap_median: median(placed().map(|l| l.overlap).collect()),
        intervals: Share::among(
            reported.iter().copied().filter(|c| c.interval_holds.is_some()),
            |c| c.interval_holds == Some(true),
        ),
        calibration_error: calibration_error(&reported),
        closure_median: median(closable(&reported).filter_map(|c| c.closure).collect()),
        planted_closure_median: median(
            closable(&reported).filter_map(|c| c.planted_closure).collect(),
        ),
        size_error_median: median(
            reported.iter().filter_map(|c| c.size_error).map(f64::abs).collect(),
        ),
        confusion,
    }
}

fn closable<'a>(cases: &'a [&'a Case]) -> impl Iterator<Item = &'a Case> {
    cases.iter().copied().filter(|c| c.gap_rms_percent > CLOSABLE)
}

/// Σ over bins of stated probability: share of the cases × |mean stated − observed|.
fn calibration_error(cases: &[&Case]) -> f64 {
    let mut bins = [(0.0, 0.0, 0.0); BINS];
    let mut total = 0.0;
    for case in cases {
        let Some((_, probability)) = &case.top else { continue };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a probability times the number of bins"
        )]
        let bin = ((probability * BINS as f64) as usize).min(BINS - 1);
        bins[bin].0 += 1.0;
        bins[bin].1 += probability;
        bins[bin].2 += f64::from(u8::from(case.on_top()));
        total += 1.0;
    }
    bins.iter().filter(|bin| bin.0 > 0.0).map(|bin| (bin.1 - bin.2).abs() / total).sum()
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
mod tests {
    use super::*;

    #[test]
    fn wilson_by_published_values() {
        // Newcombe, Statistics in Medicine 17 (1998), table I, method 3: 81 of 263, and 0 of 20.
        let share = Share::of(81, 263);
        assert!((share.ci95[0] - 0.2553).abs() < 1e-4, "{share:?}");
        assert!((share.ci95[1] - 0.3662).abs() < 1e-4, "{share:?}");
        let none = Share::of(0, 20);
        assert!(none.ci95[0].abs() < 1e-12 && (none.ci95[1] - 0.1611).abs() < 1e-4, "{none:?}");
    }

    fn case(truth: &str, top: &str, probability: f64) -> Case {
        Case {
            planted: Planted { effects: vec![(truth.to_owned(), 1.0)], struck: vec![] },
            verdict: VerdictKind::Effects,
            top: Some((top.to_owned(), probability)),
            top_three: vec![top.to_owned()],
            class: vec![top.to_owned()],
            credible: vec![top.to_owned()],
            named: vec![top.to_owned()],
            planted_closure: None,
            located: None,
            size_error: None,
            interval_holds: None,
            closure: Some(0.9),
            gap_rms_percent: 1.0,
            nearest: Some((10.0, 10.0)),
        }
    }

    #[test]
    fn scores_by_hand() {
        let [a, b] = ["drag_factor", "tsfc_factor"];
        let cases = [case(a, a, 0.95), case(a, b, 0.95), case(b, b, 0.55)];
        let scores = score(&cases, |_| None);
        assert_eq!((scores.top_one.count, scores.top_one.of), (2, 3));
        assert_eq!((scores.sure_and_wrong.count, scores.sure_and_wrong.of), (1, 3));
        // Bins: 0.9…1.0 states 1.9 for one right of two, 0.5…0.6 states 0.55 for one right: (0.9 + 0.45)/3.
        assert!((scores.calibration_error - 0.45).abs() < 1e-12);
        assert_eq!(scores.confusion[a][b], 1);
        assert_eq!(scores.closure_median, Some(0.9));
    }

    #[test]
    fn every_kind_of_case_counts_where_it_belongs() {
        let [a, b] = ["drag_factor", "tsfc_factor"];
        let mut pair = case(a, a, 0.95);
        pair.planted.effects.push((b.to_owned(), 1.0));
        pair.named = vec![b.to_owned(), a.to_owned()];
        let half = Case { named: vec![a.to_owned()], ..pair.clone() };
        let mut null = case(a, a, 0.95);
        null.planted.effects.clear();
        let silent = Case { verdict: VerdictKind::NoGap, ..null.clone() };
        let mut struck = case(a, b, 0.95);
        struck.planted.struck = vec![a.to_owned()];
        let imitable = Case { nearest: Some((10.0, 4.9)), ..struck.clone() };
        let outside =
            Case { verdict: VerdictKind::OutsideLibrary, ..case("outside_mach_bump", a, 0.3) };
        let place =
            Located { spread_percent: 0.4, significant: true, driver_named: false, overlap: 0.7 };
        let placed = Case { located: Some(place.clone()), ..case("wave_drag", a, 0.95) };
        // Scatter between flights hangs on no variable.
        let nowhere = Case { located: Some(place), ..case("fuel_heating_value", a, 0.95) };
        let scores =
            score(&[pair, half, null, silent, struck, imitable, outside, placed, nowhere], |_| {
                None
            });
        let of = |share: Share| (share.count, share.of);
        assert_eq!(of(scores.pair_exact), (1, 2));
        assert_eq!(of(scores.pair_class), (1, 2));
        assert_eq!(of(scores.pair_top), (2, 2));
        assert_eq!(of(scores.silent), (1, 2));
        assert_eq!(of(scores.null_and_sure), (1, 2));
        // Only one of the struck effects cannot be imitated.
        assert_eq!(of(scores.abstained), (0, 1));
        assert_eq!(of(scores.struck_and_sure), (1, 1));
        assert_eq!(of(scores.outside), (1, 1));
        assert_eq!(of(scores.top_one), (0, 2));
        assert_eq!(of(scores.place_significant), (1, 1));
        assert_eq!(of(scores.place_driver), (0, 1));
        assert_eq!(scores.place_overlap_median, Some(0.7));
    }
}
