//! Scores for people: `trials.md`, and what the terminal shows.

use std::collections::BTreeSet;
use std::fmt::Write;

use crate::fleets::{FleetGroup, FleetScore};
use crate::plan::{Background, ReferenceModel};
use crate::scores::{SCORES, Score};
use crate::share::Share;
use crate::summary::{Goal, Group, Trials};

/// `trials.md`.
pub fn markdown(trials: &Trials) -> String {
    let mut text = format!(
        "# Blind trials, seed {}\n\n{} cases, {} that came to nothing. SHA-256 over the sealed truths: `{}`.\nShares with \
         Wilson's 95 % interval and the number of cases behind them.\n",
        trials.seed,
        trials.cases.len(),
        trials.failed.len(),
        trials.seal_sha256
    );
    if !trials.goals.is_empty() {
        text.push_str("\n## Goals at typical sizes\n\n| model, background | score | goal | reached | |\n|---|---|---|---|---|\n");
        for goal in trials.goals.iter().filter(|goal| goal.reached.is_some()) {
            let _ = writeln!(
                text,
                "| {}, {} | {} | {} {} | {} | {} |",
                denied(goal.reference_model),
                background(goal.background),
                goal.words,
                if goal.at_least { "≥" } else { "≤" },
                goal.goal,
                reached(goal),
                verdict(goal)
            );
        }
    }
    for group in &trials.groups {
        group_table(group, &mut text);
    }
    for group in &trials.fleets.groups {
        let (name, fleets) = fleet_words(group);
        let _ = writeln!(
            text,
            "\n## {name}\n\n{fleets}.\n\n| score | goal | reached | |\n|---|---|---|---|"
        );
        for score in group.scores.iter().filter(|score| score.reached.of > 0) {
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} |",
                score.words,
                fleet_goal(score, ["≥", "≤"]),
                number(score.reached.share, Some(score.reached)),
                fleet_verdict(score)
            );
        }
    }
    for (case, reason) in &trials.failed {
        let _ = writeln!(text, "\nCase {case} came to nothing: {reason}");
    }
    for (fleet, reason) in &trials.fleets.failed {
        let _ = writeln!(text, "\nFleet {fleet} came to nothing: {reason}");
    }
    text
}

/// Which fleets, and how many.
#[must_use]
pub fn fleet_words(group: &FleetGroup) -> (String, String) {
    let part = &group.part;
    let mut name = format!(
        "fleets of {} tails, {} flights each, {} × typical",
        part.tails, part.flights, part.times
    );
    if part.type_effects == 0 && part.disturbed_share <= 0.0 {
        name = format!("fleets of {} tails, {} flights each, no effect", part.tails, part.flights);
    }
    if part.step_share > 0.0 {
        let _ = write!(name, ", steps of {} %", part.step_percent);
    }
    let fleets = format!(
        "{} fleets; {} effects of the type, an effect of its own or of a sensor on {:.0} % of the tails, a step on {:.0} %",
        group.fleets,
        part.type_effects,
        100.0 * part.disturbed_share,
        100.0 * part.step_share
    );
    (name, fleets)
}

fn fleet_goal(score: &FleetScore, [at_least, at_most]: [&str; 2]) -> String {
    score.goal.map_or_else(String::new, |(more, goal)| {
        format!("{} {}", if more { at_least } else { at_most }, (1e4 * goal).round() / 1e4)
    })
}

const fn fleet_verdict(score: &FleetScore) -> &'static str {
    match score.met {
        Some(true) => "met",
        Some(false) => "missed",
        None => "–",
    }
}

/// The goals in a dozen lines or two.
pub fn terminal(trials: &Trials) -> String {
    let mut text = String::new();
    for group in &trials.groups {
        let [single, null, struck, outside, pair] = group.cases;
        let _ = writeln!(
            text,
            "{} model, {}, {} x typical: {single} single effects, {null} without, {struck} struck, {outside} outside, {pair} pairs",
            denied(group.reference_model),
            background(group.background),
            group.times
        );
        let goals = trials.goals.iter().filter(|goal| {
            (goal.reference_model, goal.background) == (group.reference_model, group.background)
                && goal.reached.is_some()
        });
        #[expect(clippy::float_cmp, reason = "the number 1 as a plan writes it")]
        if group.times == 1.0 {
            for goal in goals {
                let _ = writeln!(
                    text,
                    "  {:<7} {} {} {}: {}",
                    verdict(goal),
                    goal.words,
                    if goal.at_least { ">=" } else { "<=" },
                    goal.goal,
                    reached(goal)
                );
            }
        }
    }
    for group in &trials.fleets.groups {
        let (name, fleets) = fleet_words(group);
        let _ = writeln!(text, "{}: {fleets}", name.replace('×', "x"));
        for score in group.scores.iter().filter(|score| score.reached.of > 0) {
            let _ = writeln!(
                text,
                "  {:<7} {}{}: {}",
                fleet_verdict(score),
                score.words,
                fleet_goal(score, [" >=", " <="]),
                number(score.reached.share, Some(score.reached))
            );
        }
    }
    text
}

/// Which group it is, and its cases by kind.
#[must_use]
pub fn group_words(group: &Group) -> (String, String) {
    let [single, null, struck, outside, pair] = group.cases;
    let name = format!(
        "{} model, {}, {} × typical",
        denied(group.reference_model),
        background(group.background),
        group.times
    );
    let cases = format!(
        "{single} single effects, {null} without effect, {struck} struck, {outside} outside the library, {pair} pairs; {:.0} \
         segments a case, noise floor {:.2} %",
        group.segments_mean, group.noise_floor_rms_percent
    );
    (name, cases)
}

fn group_table(group: &Group, text: &mut String) {
    let (name, cases) = group_words(group);
    let _ = writeln!(text, "\n## {name}\n\n{cases}.\n\n| score | |\n|---|---|");
    let mut rows: Vec<&Score> = SCORES.iter().filter(|score| score.row.is_some()).collect();
    rows.sort_by_key(|score| score.row);
    for score in rows {
        let reached = group.scores.reached(score.name);
        let Some(value) = reached.value() else { continue };
        let _ = writeln!(text, "| {} | {} |", score.words, number(value, reached.share()));
    }
    confusion(group, text);
}

fn confusion(group: &Group, text: &mut String) {
    let table = &group.scores.confusion;
    if table.is_empty() {
        return;
    }
    let said: BTreeSet<&String> = table.values().flat_map(|row| row.keys()).collect();
    let _ = writeln!(text, "\n| planted | said |\n|---|---|");
    for (truth, row) in table {
        let mut entries: Vec<(&String, usize)> =
            said.iter().filter_map(|name| Some((*name, *row.get(*name)?))).collect();
        entries.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
        let words: Vec<String> =
            entries.into_iter().map(|(name, count)| format!("{name} {count}")).collect();
        let _ = writeln!(text, "| {truth} | {} |", words.join(", "));
    }
}

fn number(value: f64, share: Option<Share>) -> String {
    match share {
        Some(share) => {
            format!("{value:.3} [{:.3}, {:.3}] of {}", share.ci95[0], share.ci95[1], share.of)
        }
        None => format!("{value:.3}"),
    }
}

fn reached(goal: &Goal) -> String {
    match (goal.reached, goal.ci95, goal.of) {
        (Some(value), Some(ci95), Some(of)) => {
            format!("{value:.3} [{:.3}, {:.3}] of {of}", ci95[0], ci95[1])
        }
        (Some(value), ..) => format!("{value:.3}"),
        _ => "no case".to_owned(),
    }
}

fn verdict(goal: &Goal) -> String {
    match (goal.met, goal.reached) {
        (Some(true), _) => "met".to_owned(),
        (Some(false), Some(_)) => "missed".to_owned(),
        _ => "–".to_owned(),
    }
}

const fn denied(denied: ReferenceModel) -> &'static str {
    match denied {
        ReferenceModel::Exact => "exact",
        ReferenceModel::Adapted => "adapted",
        ReferenceModel::Initial => "initial",
        ReferenceModel::Guide => "guide",
        ReferenceModel::Misstated => "misstated",
    }
}

const fn background(background: Background) -> &'static str {
    match background {
        Background::Clean => "clean",
        Background::Clutter => "clutter",
    }
}
