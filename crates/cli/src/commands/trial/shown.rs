//! Results of blind trials as their page shows them.

use page::{TrialCalibration, TrialGoal, TrialGroup, TrialScore, TrialsPage};
use trials::{FleetGroup, FleetScore, fleet_words};
use trials::{Goal, Group, SCORES, Score, TrialPlan, Trials, group_words};

/// The page of these results.
pub(super) fn page_of(plan: &TrialPlan, trials: &Trials) -> TrialsPage {
    let of_goal = |goal: &Goal| {
        let is_of = |group: &&Group| {
            (group.reference_model, group.background) == (goal.reference_model, goal.background)
        };
        // Goals are of typical sizes.
        #[expect(clippy::float_cmp, reason = "the number 1 as a plan writes it")]
        let group = trials.groups.iter().filter(is_of).find(|group| group.times == 1.0);
        TrialGoal {
            group: group.map_or_else(String::new, |group| group_words(group).0),
            goal: format!("{} {}", if goal.at_least { "≥" } else { "≤" }, goal.goal),
            reached: TrialScore {
                words: goal.words.to_owned(),
                value: goal.reached,
                ci95: goal.ci95,
                of: goal.of,
            },
            met: goal.met,
        }
    };
    TrialsPage {
        plan: plan_words(plan),
        seal_sha256: trials.seal_sha256.clone(),
        cases: trials.cases.len(),
        failed: trials.failed.iter().chain(&trials.fleets.failed).cloned().collect(),
        goals: trials.goals.iter().map(of_goal).chain(goals_of_fleets(trials)).collect(),
        groups: trials
            .groups
            .iter()
            .map(group_of)
            .chain(trials.fleets.groups.iter().map(group_of_fleets))
            .collect(),
    }
}

fn goals_of_fleets(trials: &Trials) -> Vec<TrialGoal> {
    let mut goals = Vec::new();
    for group in &trials.fleets.groups {
        for score in &group.scores {
            let Some((at_least, goal)) = score.goal.filter(|_| score.reached.of > 0) else {
                continue;
            };
            goals.push(TrialGoal {
                group: fleet_words(group).0,
                goal: format!("{} {goal:.4}", if at_least { "≥" } else { "≤" }),
                reached: score_of_fleets(score),
                met: score.met,
            });
        }
    }
    goals
}

fn group_of_fleets(group: &FleetGroup) -> TrialGroup {
    let (name, cases) = fleet_words(group);
    let scores = group.scores.iter().filter(|score| score.reached.of > 0);
    TrialGroup {
        name,
        cases,
        scores: scores.map(score_of_fleets).collect(),
        ..TrialGroup::default()
    }
}

fn score_of_fleets(score: &FleetScore) -> TrialScore {
    TrialScore {
        words: score.words.to_owned(),
        value: Some(score.reached.share),
        ci95: Some(score.reached.ci95),
        of: Some(score.reached.of),
    }
}

/// Seed and plan in words.
fn plan_words(plan: &TrialPlan) -> Vec<String> {
    let mut words = vec![
        format!("seed {}", plan.seed),
        format!(
            "{} flights of {} h diagnosed, {} clean flights before them",
            plan.flights, plan.duration_h, plan.clean_flights
        ),
        format!("plan of {} parts (plan.ron)", plan.parts.len()),
    ];
    if !plan.effects.is_empty() {
        words.push(format!("{} effects of the library planted", plan.effects.len()));
    }
    words
}

fn group_of(group: &Group) -> TrialGroup {
    let (name, cases) = group_words(group);
    let mut rows: Vec<&Score> = SCORES.iter().filter(|score| score.row.is_some()).collect();
    rows.sort_by_key(|score| score.row);
    let score = |score: &Score| {
        let reached = group.scores.reached(score.name);
        let share = reached.share();
        let words = score.words.to_owned();
        let score = TrialScore {
            words,
            value: reached.value(),
            ci95: share.map(|share| share.ci95),
            of: share.map(|share| share.of),
        };
        score.value.is_some().then_some(score)
    };
    let calibration = group.scores.calibration.iter().map(|bin| TrialCalibration {
        range: [bin.from, bin.to],
        stated: bin.stated,
        right: bin.right.share,
        ci95: bin.right.ci95,
        of: bin.right.of,
    });
    TrialGroup {
        name,
        cases,
        scores: rows.into_iter().filter_map(score).collect(),
        confusion: group.scores.confusion.clone(),
        calibration: calibration.collect(),
        size_tenths: group.scores.size_tenths,
    }
}
