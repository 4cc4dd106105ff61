//! Scores of a run: by model, background and size, each with its goal.

use serde::Serialize;

use crate::case::CaseResult;
use crate::fleets::{FleetGroup, FleetResult, fleet_groups};
use crate::plan::{Background, Floor, Kind, ReferenceModel, TrialPlan};
use crate::scored_case::Case;
use crate::scores::{ScoreName, Scores};

/// Schema of `trials.json`.
const SCHEMA: &str = "cruisefit.trials/1";

/// `trials.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Trials {
    schema: &'static str,
    /// Seed of the plan.
    pub seed: u64,
    /// SHA-256 over the sealed truths, as printed before the first diagnosis.
    pub seal_sha256: String,
    /// Cases that came to nothing, with the reason.
    pub failed: Vec<(usize, String)>,
    /// Scores by model, background and size.
    pub groups: Vec<Group>,
    /// The goals at typical sizes, each with what was reached.
    pub goals: Vec<Goal>,
    /// Every case.
    pub cases: Vec<CaseResult>,
    /// Of fleets: scores by part, every fleet, and those that came to nothing with the reason.
    #[serde(flatten)]
    pub fleets: FleetTrials,
}

/// What came of the fleets of a plan; nothing is written where it has none.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FleetTrials {
    /// Fleets that came to nothing, with the reason.
    #[serde(rename = "failed_fleets", skip_serializing_if = "Vec::is_empty")]
    pub failed: Vec<(usize, String)>,
    /// Scores by part.
    #[serde(rename = "fleet_groups", skip_serializing_if = "Vec::is_empty")]
    pub groups: Vec<FleetGroup>,
    /// Every fleet.
    #[serde(rename = "fleets", skip_serializing_if = "Vec::is_empty")]
    pub results: Vec<FleetResult>,
}

impl FleetTrials {
    /// Scores every fleet of a plan, in the order of their numbers.
    #[must_use]
    pub fn new(
        plan: &TrialPlan,
        mut results: Vec<FleetResult>,
        mut failed: Vec<(usize, String)>,
    ) -> Self {
        results.sort_by_key(|fleet| fleet.fleet);
        failed.sort();
        Self { failed, groups: fleet_groups(&plan.fleets, &results), results }
    }
}

/// Scores of one model, background and size.
#[derive(Clone, Debug, Serialize)]
pub struct Group {
    /// Which model.
    #[serde(rename = "denied")]
    pub reference_model: ReferenceModel,
    /// On which background.
    pub background: Background,
    /// Size over the typical size.
    pub times: f64,
    /// Cases by kind: single effects, nulls, struck, outside, pairs.
    pub cases: [usize; 5],
    /// Flights and segments of a case, mean.
    pub segments_mean: f64,
    /// Noise floor, mean of the cases, %.
    pub noise_floor_rms_percent: f64,
    /// Scores.
    pub scores: Scores,
}

/// A goal and what was reached.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Goal {
    /// Which model.
    #[serde(rename = "denied")]
    pub reference_model: ReferenceModel,
    /// On which background.
    pub background: Background,
    /// Which score.
    pub score: ScoreName,
    /// What it means.
    pub words: &'static str,
    /// Whether more is better.
    pub at_least: bool,
    /// The goal.
    pub goal: f64,
    /// What was reached; `None` without a case.
    pub reached: Option<f64>,
    /// Its 95 % interval, where it is a share.
    pub ci95: Option<[f64; 2]>,
    /// Cases behind it, where it is a share.
    pub of: Option<usize>,
    /// Whether it is met.
    pub met: Option<bool>,
}

/// A floor that was not reached.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorMissed {
    /// The floor.
    pub floor: Floor,
    /// What was reached; `None` without a case.
    pub reached: Option<f64>,
}

/// The goals at typical sizes on a clean background: the score, whether more is better, the goal. Our choice: they are what
/// the diagnosis is developed against, and a goal that is missed is printed as missed.
const CLEAN: [(ScoreName, bool, f64); 13] = [
    (ScoreName::Class, true, 0.97),
    (ScoreName::TopOneSeparable, true, 0.95),
    (ScoreName::SureAndWrong, false, 0.005),
    (ScoreName::Silent, true, 0.98),
    (ScoreName::Abstained, true, 0.85),
    (ScoreName::ClosureMedian, true, 0.98),
    (ScoreName::SizeErrorMedian, false, 0.06),
    (ScoreName::Credible, true, 0.95),
    (ScoreName::CalibrationError, false, 0.05),
    (ScoreName::PlaceSignificant, true, 0.95),
    (ScoreName::PlaceDriver, true, 0.90),
    (ScoreName::PlaceOverlapMedian, true, 0.80),
    (ScoreName::PlaceAlarm, false, 0.07),
];
/// Against a model that law `bayes` has taught.
const ADAPTED: [(ScoreName, bool, f64); 8] = [
    (ScoreName::Class, true, 0.95),
    (ScoreName::TopOneSeparable, true, 0.93),
    (ScoreName::SureAndWrong, false, 0.01),
    (ScoreName::Silent, true, 0.97),
    (ScoreName::ClosureMedian, true, 0.93),
    (ScoreName::CalibrationError, false, 0.06),
    (ScoreName::PlaceSignificant, true, 0.80),
    (ScoreName::PlaceDriver, true, 0.75),
];
/// Against a guide whose drag is off.
const INITIAL: [(ScoreName, bool, f64); 3] = [
    (ScoreName::Class, true, 0.95),
    (ScoreName::SureAndWrong, false, 0.01),
    (ScoreName::Silent, true, 0.95),
];
/// With sensors that the aircraft file misstates.
const MISSTATED: [(ScoreName, bool, f64); 2] =
    [(ScoreName::Class, true, 0.93), (ScoreName::Silent, true, 0.95)];
/// The same on a background of small other effects and smooth errors of the table.
const CLUTTER: [(ScoreName, bool, f64); 2] =
    [(ScoreName::TopOne, true, 0.65), (ScoreName::Credible, true, 0.92)];

/// Scores every case, in the order of their numbers.
pub fn summarize(
    plan: &TrialPlan,
    seal_sha256: String,
    mut cases: Vec<CaseResult>,
    mut failed: Vec<(usize, String)>,
) -> Trials {
    cases.sort_by_key(|case| case.case);
    failed.sort();
    let mut keys: Vec<(ReferenceModel, Background, f64)> = Vec::new();
    for case in &cases {
        let key = (case.reference_model, case.background, case.times);
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
    let groups: Vec<Group> = keys
        .into_iter()
        .map(|(reference_model, background, times)| {
            let own = |case: &&CaseResult| {
                (case.reference_model, case.background) == (reference_model, background)
                    && case.times.total_cmp(&times).is_eq()
            };
            group(reference_model, background, times, &cases.iter().filter(own).collect::<Vec<_>>())
        })
        .collect();
    let goals = groups.iter().flat_map(goals_of).collect();
    Trials {
        schema: SCHEMA,
        seed: plan.seed,
        seal_sha256,
        failed,
        groups,
        goals,
        cases,
        fleets: FleetTrials::default(),
    }
}

/// The floors of a plan that were not reached. A floor of a score without a case is missed.
pub fn floors_missed(plan: &TrialPlan, trials: &Trials) -> Vec<FloorMissed> {
    let missed = |floor: &Floor| {
        let group = trials.groups.iter().find(|group| {
            (group.reference_model, group.background) == (floor.reference_model, floor.background)
                && group.times.total_cmp(&floor.times).is_eq()
        });
        let reached = group.and_then(|group| group.scores.reached(floor.score).value());
        let holds = reached.is_some_and(|value| {
            floor.least.is_none_or(|least| value >= least)
                && floor.most.is_none_or(|most| value <= most)
        });
        (!holds).then_some(FloorMissed { floor: *floor, reached })
    };
    plan.floors.iter().filter_map(missed).collect()
}

fn group(
    reference_model: ReferenceModel,
    background: Background,
    times: f64,
    own: &[&CaseResult],
) -> Group {
    let count = |kind| own.iter().filter(|case| case.kind == kind).count();
    let mean = |of: &dyn Fn(&CaseResult) -> f64| {
        own.iter().map(|case| of(case)).sum::<f64>() / own.len() as f64
    };
    let scored: Vec<Case> = own.iter().map(|case| case.scored.clone()).collect();
    Group {
        reference_model,
        background,
        times,
        cases: [Kind::Single, Kind::Null, Kind::Struck, Kind::Outside, Kind::Pair].map(count),
        segments_mean: mean(&|case| case.segments as f64),
        noise_floor_rms_percent: mean(&|case| case.noise_floor_rms_percent),
        scores: Scores::from_cases(&scored),
    }
}

fn goals_of(group: &Group) -> Vec<Goal> {
    #[expect(clippy::float_cmp, reason = "the number 1 as a plan writes it")]
    let typical = group.times == 1.0;
    let goals: &[(ScoreName, bool, f64)] = match (group.background, group.reference_model) {
        _ if !typical => &[],
        (Background::Clutter, _) => &CLUTTER,
        (Background::Clean, ReferenceModel::Exact) => &CLEAN,
        (Background::Clean, ReferenceModel::Adapted) => &ADAPTED,
        (Background::Clean, ReferenceModel::Initial | ReferenceModel::Guide) => &INITIAL,
        (Background::Clean, ReferenceModel::Misstated) => &MISSTATED,
    };
    goals
        .iter()
        .map(|&(score, at_least, goal)| {
            let reached = group.scores.reached(score);
            let (value, share) = (reached.value(), reached.share());
            Goal {
                reference_model: group.reference_model,
                background: group.background,
                score,
                words: score.score().words,
                at_least,
                goal,
                reached: value,
                ci95: share.map(|share| share.ci95),
                of: share.map(|share| share.of),
                met: value.map(|value| if at_least { value >= goal } else { value <= goal }),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scored_case::Planted;
    use pipeline::diagnosis_document::VerdictKind;

    fn result(case: usize, kind: Kind, verdict: VerdictKind) -> CaseResult {
        let effects = match kind {
            Kind::Null => vec![],
            _ => vec![("drag_factor".to_owned(), 2.0)],
        };
        CaseResult {
            case,
            truth_sha256: String::new(),
            reference_model: ReferenceModel::Exact,
            background: Background::Clean,
            kind,
            times: 1.0,
            flights: 60,
            segments: 600,
            named: vec![],
            outside_probability: 0.0,
            outside_variable: None,
            noise_floor_rms_percent: 0.5,
            scored: Case {
                planted: Planted { effects, struck: vec![] },
                verdict,
                of_table: false,
                top: Some(("drag_factor".to_owned(), 0.8)),
                top_three: vec![],
                class: vec![],
                credible: vec![],
                named: vec!["drag_factor".to_owned()],
                size_error: None,
                interval_holds: None,
                size_position: None,
                closure: None,
                planted_closure: None,
                located: None,
                gap_rms_percent: 1.0,
                nearest: None,
                largest: None,
                attainable: None,
            },
        }
    }

    #[test]
    fn goals_and_floors_by_hand() {
        let text = "(seed: 1, parts: [(denied: exact, background: clean, kind: null, repeats: 1)], floors: [
            (denied: exact, background: clean, score: silent, least: 0.5),
            (denied: exact, background: clean, score: silent, least: 0.6),
            (denied: exact, background: clean, score: class, least: 0.9),
            (denied: adapted, background: clean, score: class, least: 0.1),
        ])";
        let plan = TrialPlan::from_ron(text).unwrap();
        let cases = vec![
            result(3, Kind::Single, VerdictKind::Effects),
            result(1, Kind::Null, VerdictKind::NoGap),
            result(2, Kind::Null, VerdictKind::Effects),
        ];
        let trials = summarize(&plan, "abc".to_owned(), cases, vec![]);
        assert_eq!(trials.cases.iter().map(|case| case.case).collect::<Vec<_>>(), [1, 2, 3]);
        assert_eq!(trials.groups.len(), 1);
        assert_eq!(trials.groups[0].cases, [1, 2, 0, 0, 0]);
        let goal = |score| trials.goals.iter().find(|goal| goal.score == score).unwrap();
        // One of two nulls is silent, and the one effect is on top.
        assert_eq!(
            (goal(ScoreName::Silent).reached, goal(ScoreName::Silent).met),
            (Some(0.5), Some(false))
        );
        assert_eq!(
            (goal(ScoreName::Class).reached, goal(ScoreName::Class).met),
            (Some(1.0), Some(true))
        );
        assert_eq!(goal(ScoreName::Abstained).met, None);
        let missed = floors_missed(&plan, &trials);
        assert_eq!(missed.len(), 2);
        assert_eq!((missed[0].floor.least, missed[0].reached), (Some(0.6), Some(0.5)));
        assert_eq!(missed[1].reached, None);
    }
}
