//! Scores of blind trials: what was planted against what was diagnosed. The planting is the caller's.

pub mod places;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::output::{Diagnosis, VerdictKind};

/// A probability from which a name counts as sure.
const SURE: f64 = 0.9;
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
    /// Estimated over true size − 1 of the first planted effect, where it is on top.
    pub size_error: Option<f64>,
    /// Whether the 95 % interval holds the true size.
    pub interval_holds: Option<bool>,
    /// Closure on unseen flights and rms of the gap, %.
    pub closure: Option<f64>,
    /// Rms of the gap before, %.
    pub gap_rms_percent: f64,
    /// Distance of the planted effect from the nearest other one, and from the nearest pair, at typical size.
    pub nearest: Option<(f64, f64)>,
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
    /// 95 % intervals of size that hold the truth, where the effect is on top.
    pub intervals: Share,
    /// Expected calibration error of the top effect's probability, over the reported.
    pub calibration_error: f64,
    /// Median closure where the gap is above 0.5 %.
    pub closure_median: Option<f64>,
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
            size_error: magnitude.map(|(size, found)| found.value / size - 1.0),
            interval_holds: magnitude
                .map(|(size, found)| found.ci95[0] <= size && size <= found.ci95[1]),
            closure: found.verdict.closure,
            gap_rms_percent: found.gap.rms_percent,
            nearest: detectable.map(|d| (d.nearest_other, d.nearest_pair)),
            planted,
        }
    }

    fn is_null(&self) -> bool {
        self.planted.effects.is_empty()
    }

    fn is_struck(&self) -> bool {
        self.planted.effects.iter().any(|(name, _)| self.planted.struck.contains(name))
    }

    fn truth(&self) -> &str {
        self.planted.effects.first().map_or("nothing", |(name, _)| name)
    }

    fn on_top(&self) -> bool {
        self.top.as_ref().is_some_and(|(name, _)| name == self.truth())
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

/// Scores cases. `struck_distance` tells how far a struck effect is from the nearest pair of others: its own column is not
/// in the library that was searched, so that the caller takes it from a diagnosis with the whole library.
#[must_use]
pub fn score(cases: &[Case], struck_distance: impl Fn(&str) -> Option<f64>) -> Scores {
    let planted: Vec<&Case> = cases.iter().filter(|c| !c.is_null() && !c.is_struck()).collect();
    let reported: Vec<&Case> =
        planted.iter().copied().filter(|c| c.verdict != VerdictKind::NoGap).collect();
    let separable = reported.iter().copied().filter(|c| c.nearest.is_some_and(|n| n.0 >= 4.0));
    let nulls = || cases.iter().filter(|c| c.is_null());
    let struck = || {
        cases
            .iter()
            .filter(|c| c.is_struck() && struck_distance(c.truth()).is_some_and(|d| d >= 5.0))
    };
    let mut confusion: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for case in cases.iter().filter(|c| !c.is_struck()) {
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
        intervals: Share::among(
            reported.iter().copied().filter(|c| c.interval_holds.is_some()),
            |c| c.interval_holds == Some(true),
        ),
        calibration_error: calibration_error(&reported),
        closure_median: median(
            reported.iter().filter(|c| c.gap_rms_percent > 0.5).filter_map(|c| c.closure).collect(),
        ),
        size_error_median: median(
            reported.iter().filter_map(|c| c.size_error).map(f64::abs).collect(),
        ),
        confusion,
    }
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
            size_error: None,
            interval_holds: None,
            closure: Some(0.9),
            gap_rms_percent: 1.0,
            nearest: Some((10.0, 10.0)),
        }
    }

    #[test]
    fn scores_by_hand() {
        let cases = [case("a", "a", 0.95), case("a", "b", 0.95), case("b", "b", 0.55)];
        let scores = score(&cases, |_| None);
        assert_eq!((scores.top_one.count, scores.top_one.of), (2, 3));
        assert_eq!((scores.sure_and_wrong.count, scores.sure_and_wrong.of), (1, 3));
        // Bins: 0.9…1.0 states 1.9 for one right of two, 0.5…0.6 states 0.55 for one right: (0.9 + 0.45)/3.
        assert!((scores.calibration_error - 0.45).abs() < 1e-12);
        assert_eq!(scores.confusion["a"]["b"], 1);
        assert_eq!(scores.closure_median, Some(0.9));
    }
}
