//! The best levels and Mach numbers as a table for a person.

use std::collections::BTreeSet;
use std::fmt::Write;

use super::condition::{BestLevel, ConditionOptimum, NoSaving};
use super::largest_against_predict_percent;
use super::speeds::{Kind, OpenEnds};
use crate::summary::aligned;

/// The best level of each condition and way to choose the Mach number, one line each. `highest_ft` is the highest pressure altitude
/// that the guide has or flights flew.
#[must_use]
pub fn table(conditions: &[ConditionOptimum], highest_ft: Option<f64>) -> String {
    let days: BTreeSet<String> = conditions.iter().map(day).collect();
    let one_day = days.len() == 1;
    let mut head = vec!["kind, mass kg"];
    head.extend((!one_day).then_some("ISA, wind"));
    head.extend(["FL", "Mach", "book FL, M", "saves kg/h"]);
    let mut rows: Vec<Vec<String>> = vec![head.into_iter().map(str::to_owned).collect()];
    for condition in conditions {
        for best in &condition.best {
            let mut cells = row(condition, best);
            if !one_day {
                cells.insert(1, day(condition));
            }
            rows.push(cells);
        }
    }
    let mut text = String::new();
    if let (true, Some(day)) = (one_day, days.first()) {
        let _ = writeln!(text, "ISA deviation in °C, tailwind in kt: {day}");
    }
    text.push_str(&aligned(&rows));
    text.push_str(
        "In parentheses: 95 % intervals. FL: flight level, hundreds of feet. Wind: tailwind, kt. Saved: the tail's own level and Mach number against the book's, at the book's ground \
         speed; with a cost index time counts as fuel.\n",
    );
    text.push_str(&notes(conditions, highest_ft));
    text
}

/// What is to be known of these rows, a line each.
fn notes(conditions: &[ConditionOptimum], highest_ft: Option<f64>) -> String {
    let mut text = String::new();
    let all = || {
        conditions.iter().flat_map(|condition| condition.best.iter().map(move |b| (condition, b)))
    };
    if all().any(|(condition, best)| is_marked(condition, best) || best.book_at_edge) {
        text.push_str(
            "* at a level or a Mach number: it lies at the edge of what was asked for or of what guide or flights inform; the \
             aircraft's own optimum, or the book's, may be beyond it.\n",
        );
    }
    if all().any(|(condition, best)| open_ends(condition, best).iter().any(Option::is_some)) {
        text.push_str(
            "* at an end of an interval: models drawn from what is known have their optimum at that edge; the interval may reach \
             beyond it.\n",
        );
    }
    if all().any(|(_, best)| best.beyond_flights == Some(true)) {
        text.push_str(
            "~ Beyond what the learnt flights flew: what they showed is continued there, and is less sure (`beyond_flights`).\n",
        );
    }
    if let Some(percent) = largest_against_predict_percent(conditions) {
        let _ = writeln!(
            text,
            "Fuel flow is smooth between the nodes of the table: at these optima, all levels, at most {percent:.2} % from what \
             `predict` states with the same drag, straight between them."
        );
    }
    text.push_str(&unshown(all().filter_map(|(_, best)| best.saving_ci95)));
    let reasons: BTreeSet<NoSaving> = all().filter_map(|(_, best)| best.no_saving).collect();
    for reason in reasons {
        text.push_str(match reason {
            NoSaving::LongRange => "",
            NoSaving::NoBook => "– for a saving: the guide informs none of these levels.\n",
            NoSaving::BookAtEdge => {
                "– for a saving: the book's optimum lies at the edge of the guide, so that what the book makes it fly is not \
                 known.\n"
            }
            NoSaving::OwnAtEdge => {
                "– for a saving: the aircraft's own optimum lies at the edge of what is informed.\n"
            }
        });
    }
    text.push_str(&limits(all().map(|(_, best)| best.pressure_altitude_ft), highest_ft));
    text
}

/// How many savings the flights do not show. What an optimum is believed to save is more than it does, since it is where the model says
/// least.
fn unshown(savings: impl Iterator<Item = [f64; 2]>) -> String {
    let (mut all, mut none) = (0, 0);
    for [low, _] in savings {
        all += 1;
        none += usize::from(low <= 0.0);
    }
    if none == 0 {
        return String::new();
    }
    format!(
        "The intervals of {none} of {all} savings hold zero: these flights do not show that the tail's own choice is better there, and the \
         book's is as good.\n"
    )
}

/// What is asked for and has no optimum at any level, each with the reason.
#[must_use]
pub fn without_optimum(conditions: &[ConditionOptimum]) -> Vec<String> {
    let without = conditions.iter().filter(|condition| condition.best.is_empty());
    let words = without.map(|condition| {
        let against = if condition.tailwind_kt < 0.0 {
            ", or the wind is stronger than the aircraft is fast"
        } else {
            ""
        };
        format!(
            "mass {:.0} kg, ISA deviation {:+.0} °C, tailwind {:+.0} kt: no optimum, neither guide nor flights inform the model at \
             any of these levels{against}",
            condition.mass_kg, condition.isa_deviation_k, condition.tailwind_kt
        )
    });
    words.collect()
}

/// Which ends of the level's and of the Mach number's interval are open.
fn open_ends(condition: &ConditionOptimum, best: &BestLevel) -> [Option<OpenEnds>; 2] {
    let of_mach = condition.speed_at(best).and_then(|speed| speed.mach_ci95_open);
    let level = best.pressure_altitude_ci95_open.filter(|_| is_wide(best));
    [level, of_mach]
}

/// Whether the level's interval is more than the level itself.
fn is_wide(best: &BestLevel) -> bool {
    best.pressure_altitude_ci95.is_some_and(|[low, high]| low < high)
}

/// An interval in parentheses, its open ends marked.
fn interval(ends: Option<[f64; 2]>, open: Option<OpenEnds>, of: impl Fn(f64) -> String) -> String {
    let (lower, upper) = open.map_or((false, false), OpenEnds::sides);
    let mark = |is_open: bool| if is_open { "*" } else { "" };
    ends.map_or_else(String::new, |[low, high]| {
        format!(" ({}{}–{}{})", of(low), mark(lower), of(high), mark(upper))
    })
}

/// That a level is chosen without the limits of the aircraft, and whether it is higher than anything that the model knows of.
fn limits(levels_ft: impl Iterator<Item = f64>, highest_ft: Option<f64>) -> String {
    let Some(best_ft) = levels_ft.reduce(f64::max) else { return String::new() };
    let above = highest_ft.filter(|highest_ft| best_ft > highest_ft + 1.0);
    let above = above.map_or_else(String::new, |highest_ft| {
        format!(" Neither guide nor flights have a point above FL {:.0}.", highest_ft / 100.0)
    });
    format!(
        "Thrust, buffet, ceiling, MMO and VMO are not known to a model: hold levels and Mach numbers to those of the aircraft.{above}\n"
    )
}

fn row(condition: &ConditionOptimum, best: &BestLevel) -> Vec<String> {
    let mark = |is_at_edge: bool| if is_at_edge { "*" } else { "" };
    let (level_mark, mach_mark) = (mark(best.at_edge), mark(is_mach_at_edge(condition, best)));
    let beyond = if best.beyond_flights == Some(true) { "~" } else { "" };
    let [level_open, mach_open] = open_ends(condition, best);
    let mach_ci95 = condition.speed_at(best).and_then(|speed| speed.mach_ci95);
    let kind = match best.kind {
        Kind::MaximumRange => "max range",
        Kind::LongRange => "long range",
        Kind::CostIndex => "cost index",
    };
    let level = |value: f64| format!("{:.0}", value / 100.0);
    let mach = |value: f64| format!("{value:.3}");
    let saved = best.saving_kg_h.map_or_else(
        || "–".to_owned(),
        |saving| {
            let range = best.saving_ci95;
            let range =
                range.map_or_else(String::new, |[low, high]| format!(" ({low:.1} to {high:.1})"));
            format!("{saving:.1}{range}")
        },
    );
    let book = best.book_pressure_altitude_ft.zip(best.book_mach).map_or_else(
        || "–".to_owned(),
        |(book_ft, book_mach)| {
            format!("{} {}{}", level(book_ft), mach(book_mach), mark(best.book_at_edge))
        },
    );
    let level_interval = best.pressure_altitude_ci95.filter(|_| is_wide(best));
    let level_interval = interval(level_interval, level_open, level);
    vec![
        format!("{kind} {:.0}", condition.mass_kg),
        format!("{}{level_mark}{beyond}{level_interval}", level(best.pressure_altitude_ft)),
        format!("{}{mach_mark}{}", mach(best.mach), interval(mach_ci95, mach_open, mach)),
        book,
        saved,
    ]
}

fn day(condition: &ConditionOptimum) -> String {
    format!("{:+.0}, {:+.0}", condition.isa_deviation_k, condition.tailwind_kt)
}

fn is_marked(condition: &ConditionOptimum, best: &BestLevel) -> bool {
    best.at_edge || is_mach_at_edge(condition, best)
}

fn is_mach_at_edge(condition: &ConditionOptimum, best: &BestLevel) -> bool {
    condition.speed_at(best).is_some_and(|speed| speed.edge.is_some())
}
