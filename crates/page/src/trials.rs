//! `trials.html`: what blind trials planted against what the diagnosis found, and whether its probabilities and intervals hold.

use maud::{Markup, html};

use crate::chart::{Axis, Chart, Key, Mark, legend};
use crate::frame::framed;
use crate::matrix::{self, Confusion};
use pipeline::summary::counted;

/// Results of blind trials, as the page needs them. Every number is one of `trials.json`.
#[derive(Clone, Debug, Default)]
pub struct TrialsPage {
    /// Seed and plan, in words.
    pub plan: Vec<String>,
    /// SHA-256 over the sealed truths.
    pub seal_sha256: String,
    /// Cases that were scored.
    pub cases: usize,
    /// Cases that came to nothing, with the reason.
    pub failed: Vec<(usize, String)>,
    /// Goals with what was reached.
    pub goals: Vec<TrialGoal>,
    /// Scores by model, background and size.
    pub groups: Vec<TrialGroup>,
}

/// A goal and what was reached.
#[derive(Clone, Debug)]
pub struct TrialGoal {
    /// Of which group.
    pub group: String,
    /// The goal: "≥ 0.97".
    pub goal: String,
    /// What was reached.
    pub reached: TrialScore,
    /// Whether it is met; `None` without a case.
    pub met: Option<bool>,
}

/// A score.
#[derive(Clone, Debug)]
pub struct TrialScore {
    /// What it is.
    pub words: String,
    /// What was reached; `None` without a case.
    pub value: Option<f64>,
    /// Its 95 % interval, where it is a share.
    pub ci95: Option<[f64; 2]>,
    /// Cases behind it, where it is a share.
    pub of: Option<usize>,
}

/// Scores of one model, background and size.
#[derive(Clone, Debug, Default)]
pub struct TrialGroup {
    /// Which.
    pub name: String,
    /// Its cases, in words.
    pub cases: String,
    /// Scores, in the order of the page.
    pub scores: Vec<TrialScore>,
    /// What was planted against what was found.
    pub confusion: Confusion,
    /// Stated probabilities against what is right.
    pub calibration: Vec<TrialCalibration>,
    /// Cases by the tenth of its stated distribution in which the planted size lies.
    pub size_tenths: [usize; 10],
}

/// Cases whose most probable effect was stated with a probability in a range.
#[derive(Clone, Copy, Debug)]
pub struct TrialCalibration {
    /// The range.
    pub range: [f64; 2],
    /// Mean of the stated probabilities.
    pub stated: f64,
    /// Share of the cases in which it was that effect.
    pub right: f64,
    /// 95 % interval of the share.
    pub ci95: [f64; 2],
    /// Cases.
    pub of: usize,
}

/// The page of blind trials.
#[must_use]
pub fn trials(page: &TrialsPage) -> String {
    let body = html! {
        p.run {
            "cruisefit " (env!("CARGO_PKG_VERSION")) "; " (counted(page.cases, "case")) ", " (page.failed.len())
            " that came to nothing; " (page.plan.join("; ")) "."
        }
        p.note {
            "A virtual aircraft flies with an effect that its model lacks; the diagnosis sees the recordings, never the effect. The truths \
             were sealed before the first diagnosis: SHA-256 " code { (page.seal_sha256) } ". Intervals are of 95 % (Wilson's, of shares)."
        }
        (card(page))
        (goals(page))
        @if !page.groups.is_empty() {
            section {
                h2 { "Groups" }
                @for (number, group) in page.groups.iter().enumerate() {
                    details.tail open[number == 0] {
                        summary { h3 { (group.name) } " " span { (group.cases) } }
                        div id=(format!("group-{number}")) { (section(group, number)) }
                    }
                }
            }
        }
        @if !page.failed.is_empty() {
            section {
                h2 { "Cases that came to nothing" }
                ul { @for (case, reason) in &page.failed { li { "Case " (case) ": " (reason) } } }
            }
        }
    };
    framed("Blind trials of the diagnosis", &body)
}

/// Goals met and missed, in words.
fn card(page: &TrialsPage) -> Markup {
    let judged: Vec<&TrialGoal> = page.goals.iter().filter(|goal| goal.met.is_some()).collect();
    let missed: Vec<&&TrialGoal> = judged.iter().filter(|goal| goal.met == Some(false)).collect();
    // A goal within the interval of what was reached is not missed for certain.
    let within = |goal: &TrialGoal| {
        let limit: Option<f64> =
            goal.goal.split(' ').next_back().and_then(|text| text.parse().ok());
        limit
            .zip(goal.reached.ci95)
            .is_some_and(|(limit, [low, high])| (low..=high).contains(&limit))
    };
    html! {
        dl.verdict.gap[!missed.is_empty()] {
            dt { "Goals" }
            dd {
                @if judged.is_empty() { "None of these cases has a goal: goals are for effects of their typical size." }
                @else {
                    b { (judged.len() - missed.len()) " of " (counted(judged.len(), "goal")) " met." }
                    @if !missed.is_empty() {
                        " Missed:"
                        ul { @for goal in &missed { li {
                            (goal.group) ": " (goal.reached.words) ", " (goal.goal) ", reached " (number(&goal.reached))
                            @if within(goal) { "; the goal is within the interval, more cases would tell" }
                        } } }
                    }
                }
            }
        }
    }
}

fn number(score: &TrialScore) -> String {
    let value = score.value.map_or_else(|| "–".to_owned(), |value| format!("{value:.3}"));
    match (score.ci95, score.of) {
        (Some([low, high]), Some(of)) => format!("{value} ({low:.3} to {high:.3}, of {of})"),
        _ => value,
    }
}

fn goals(page: &TrialsPage) -> Markup {
    html! {
        @if !page.goals.is_empty() {
            details.more {
                summary { "Every goal" }
                div.scroll tabindex="0" role="region" aria-label="Goals" {
                    table.bars.sort.data data-name="goals" {
                        thead { tr {
                            th scope="col" { "group" } th scope="col" { "score" } th scope="col" { "goal" } th scope="col" { "reached" }
                            th scope="col" { "from" } th scope="col" { "to" } th scope="col" { "cases" } th scope="col" { "met" }
                        } }
                        tbody { @for goal in &page.goals { tr {
                            th scope="row" { (goal.group) }
                            td { (goal.reached.words) }
                            td.number { (goal.goal) }
                            (score_cells(&goal.reached))
                            td { @match goal.met { Some(true) => "met", Some(false) => "missed", None => "–" } }
                        } } }
                    }
                }
            }
        }
    }
}

/// Value, ends of its interval, cases.
fn score_cells(score: &TrialScore) -> Markup {
    let [low, high] = score.ci95.map_or([None, None], |ends| ends.map(Some));
    html! {
        @for value in [score.value, low, high] {
            td.number data-v=[value] { (value.map_or_else(|| "–".to_owned(), |value| format!("{value:.3}"))) }
        }
        td.number data-v=[score.of] { (score.of.map_or_else(|| "–".to_owned(), |of| of.to_string())) }
    }
}

fn section(group: &TrialGroup, number: usize) -> Markup {
    html! {
        (scores(group))
        (confusion(group, number))
        div.figures {
            (calibration(group, number))
            (tenths(group, number))
        }
    }
}

fn scores(group: &TrialGroup) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label=(format!("Scores, {}", group.name)) {
            table.bars.data data-name="scores" {
                thead { tr {
                    th scope="col" { "score" } th.drawn scope="col" { "0 to 1" } th scope="col" { "reached" } th scope="col" { "from" }
                    th scope="col" { "to" } th scope="col" { "cases" }
                } }
                tbody { @for score in &group.scores { tr {
                    th scope="row" { (score.words) }
                    td.drawn { (spark(score)) }
                    (score_cells(score))
                } } }
            }
        }
    }
}

/// A share with its interval on a scale from 0 to 1.
fn spark(score: &TrialScore) -> Markup {
    let at = |value: f64| 4.0 + 136.0 * value.clamp(0.0, 1.0);
    html! {
        @if let (Some(value), Some([low, high])) = (score.value, score.ci95) {
            svg.spark viewBox="0 0 144 14" aria-hidden="true" {
                path class="frame" d=(format!("M{:.1} 0V14M{:.1} 0V14", at(0.0), at(1.0))) {}
                path class="span" d=(format!("M{:.1} 7H{:.1}", at(low), at(high))) {}
                path class="disc after" d=(format!("M{:.1} 7h0", at(value))) {}
            }
        }
    }
}

fn confusion(group: &TrialGroup, number: usize) -> Markup {
    html! {
        @if !group.confusion.is_empty() {
            figure {
                figcaption {
                    b { "Planted and found." } " A row for each effect planted, a column for what was found most probable; blue is right, orange \
                    wrong, the darker the larger the share of the row. Struck effects and pairs are in the scores alone."
                }
                div.scroll tabindex="0" role="region" aria-label=(format!("Confusions, {}", group.name)) {
                    div style=(format!("min-width:{}px;max-width:{}px", matrix::width(&group.confusion) * 0.8, matrix::width(&group.confusion) * 1.3)) {
                        (matrix::matrix(&group.name, &group.confusion, number))
                    }
                }
                details.more {
                    summary { "The same as a table" }
                    div.scroll tabindex="0" role="region" aria-label=(format!("Table of confusions, {}", group.name)) {
                        table.bars.sort.data data-name="confusion" {
                            thead { tr {
                                th scope="col" { "planted" } th scope="col" { "found" } th scope="col" { "cases" } th scope="col" { "right" }
                            } }
                            tbody { @for (planted, row) in &group.confusion { @for (found, count) in row { tr {
                                th scope="row" { (planted) }
                                td { (found) }
                                td.number data-v=(count) { (count) }
                                td { @if matrix::is_right(planted, found) { "yes" } @else { "no" } }
                            } } } }
                        }
                    }
                }
            }
        }
    }
}

/// Stated probability against the share that is right.
fn calibration(group: &TrialGroup, number: usize) -> Markup {
    let bins = &group.calibration;
    let chart = Chart {
        id: format!("calibration-{number}"),
        title: format!("{}: stated probabilities", group.name),
        description: "Share of the cases in which the most probable effect was the planted one, over its stated probability, with 95 % \
                      intervals; on the diagonal where probabilities hold."
            .to_owned(),
        width: 520.0,
        height: 340.0,
        x: Axis::within(0.0, 1.0, 5),
        y: Axis::within(0.0, 1.0, 5),
        x_label: "stated probability of the first cause".to_owned(),
        y_label: "share that is right".to_owned(),
    };
    let points: Vec<(f64, f64)> = bins.iter().map(|bin| (bin.stated, bin.right)).collect();
    let intervals: Vec<(f64, (f64, f64))> =
        bins.iter().map(|bin| (bin.stated, (bin.ci95[0], bin.ci95[1]))).collect();
    let marks = html! {
        (chart.polyline(&[(0.0, 0.0), (1.0, 1.0)], "mean"))
        (chart.intervals(&intervals, "interval"))
        (chart.marks(&points, Mark::Disc, "before"))
        @for bin in bins {
            (chart.cell((bin.range[0], bin.range[1]), (0.0, 1.0), "hit", &format!(
                "stated {:.2}: right {:.2} ({:.2} to {:.2}), {}",
                bin.stated, bin.right, bin.ci95[0], bin.ci95[1], counted(bin.of, "case")
            )))
        }
    };
    html! {
        @if !bins.is_empty() {
            figure {
                figcaption {
                    b { "Do probabilities hold?" } " Of single effects for which a gap was reported. Above the diagonal the first cause is right more often than \
                    stated, below it less often."
                }
                (legend(&[(Key::Mark(Mark::Disc), "before", "cases, with 95 % interval"), (Key::Line, "mean", "where probabilities hold")]))
                (chart.draw(&marks))
                div.scroll tabindex="0" role="region" aria-label=(format!("Calibration, {}", group.name)) {
                    table.small.data data-name="calibration" {
                        thead { tr {
                            th scope="col" { "stated from" } th scope="col" { "to" } th scope="col" { "mean" } th scope="col" { "right" }
                            th scope="col" { "from" } th scope="col" { "to" } th scope="col" { "cases" }
                        } }
                        tbody { @for bin in bins { tr {
                            @for value in bin.range { td { (format!("{value:.1}")) } }
                            @for value in [bin.stated, bin.right, bin.ci95[0], bin.ci95[1]] {
                                td data-v=(value) { (format!("{value:.3}")) }
                            }
                            td data-v=(bin.of) { (bin.of) }
                        } } }
                    }
                }
            }
        }
    }
}

/// Where planted sizes lie in their stated distributions.
fn tenths(group: &TrialGroup, number: usize) -> Markup {
    let counts = &group.size_tenths;
    let cases: usize = counts.iter().sum();
    let expected = cases as f64 / 10.0;
    // 1.96 standard deviations of a count with probability 0.1, the normal limit of the binomial distribution.
    let half = pipeline::statistics::NORMAL_95 * (0.9 * expected).sqrt();
    let largest = counts.iter().copied().max().unwrap_or(0) as f64;
    let chart = Chart {
        id: format!("tenths-{number}"),
        title: format!("{}: stated sizes", group.name),
        description: format!(
            "{} by the tenth of its stated distribution in which the planted size lies; {expected:.1} in each where stated sizes hold.",
            counted(cases, "case")
        ),
        width: 520.0,
        height: 340.0,
        x: Axis::of_names(&(1..=10).map(|tenth| tenth.to_string()).collect::<Vec<_>>()),
        y: Axis::around(0.0, largest.max(expected + half), 5),
        x_label: "tenth of the stated distribution of the size".to_owned(),
        y_label: "cases".to_owned(),
    };
    let marks = html! {
        @for (k, &count) in counts.iter().enumerate() {
            @let at = k as f64;
            (chart.cell((at + 0.1, at + 0.9), (0.0, count as f64), "less4", &format!("tenth {}: {}", k + 1, counted(count, "case"))))
        }
        (chart.horizontal(expected, "zero"))
        (chart.horizontal((expected - half).max(0.0), "mean"))
        (chart.horizontal(expected + half, "mean"))
    };
    html! {
        @if cases > 0 {
            figure {
                figcaption {
                    b { "Do sizes and their intervals hold?" } " Where the planted size lies in its stated distribution, of single effects found first. \
                    Level where they hold; high at both ends: intervals are too short; high in the middle: too long; leaning: sizes are off."
                }
                (legend(&[(Key::Line, "zero", "expected"), (Key::Line, "mean", "95 % of the counts lie between")]))
                (chart.draw(&marks))
                table.small.data data-name="size-tenths" {
                    thead { tr { @for tenth in 1..=10 { th scope="col" { (tenth) } } } }
                    tbody { tr { @for count in counts { td data-v=(count) { (count) } } } }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
