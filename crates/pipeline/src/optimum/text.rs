//! The best levels and Mach numbers as a table for a person.

use std::collections::BTreeSet;
use std::fmt::Write;

use super::condition::{BestLevel, ConditionOptimum, NoSaving};
use super::speeds::Kind;
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
            "* Mach number or level at the edge of what was asked for or of what guide or flights inform: the aircraft's own \
             optimum, or the book's, may be beyond it.\n",
        );
    }
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
    let uninformed = conditions.iter().filter(|condition| condition.best.is_empty());
    let mut uninformed: Vec<String> =
        uninformed.map(|condition| format!("{:.0} kg", condition.mass_kg)).collect();
    if !uninformed.is_empty() {
        uninformed.dedup();
        let _ = writeln!(
            text,
            "Neither guide nor flights inform any level at {}.",
            uninformed.join(", ")
        );
    }
    text
}

/// That a level is chosen without the limits of the aircraft, and whether it is higher than anything that the model knows of.
fn limits(levels_ft: impl Iterator<Item = f64>, highest_ft: Option<f64>) -> String {
    let Some(best_ft) = levels_ft.reduce(f64::max) else { return String::new() };
    let above = highest_ft.filter(|highest_ft| best_ft > highest_ft + 1.0);
    let above = above.map_or_else(String::new, |highest_ft| {
        format!(" Neither guide nor flights have a point above FL {:.0}.", highest_ft / 100.0)
    });
    format!(
        "Thrust, buffet and ceiling are not known to a model: hold the levels to those of the aircraft.{above}\n"
    )
}

fn row(condition: &ConditionOptimum, best: &BestLevel) -> Vec<String> {
    let mark = if is_marked(condition, best) { "*" } else { "" };
    let speed = speed_of(condition, best);
    let kind = match best.kind {
        Kind::MaximumRange => "max range",
        Kind::LongRange => "long range",
        Kind::CostIndex => "cost index",
    };
    let interval = |interval: Option<[f64; 2]>, of: &dyn Fn(f64) -> String| {
        interval.map_or_else(String::new, |[low, high]| format!(" ({}–{})", of(low), of(high)))
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
            let mark = if best.book_at_edge { "*" } else { "" };
            format!("{} {}{mark}", level(book_ft), mach(book_mach))
        },
    );
    let level_interval = best.pressure_altitude_ci95.filter(|[low, high]| low < high);
    vec![
        format!("{kind} {:.0}", condition.mass_kg),
        format!("{}{}", level(best.pressure_altitude_ft), interval(level_interval, &level)),
        format!("{}{}{mark}", mach(best.mach), interval(speed.and_then(|s| s.mach_ci95), &mach)),
        book,
        saved,
    ]
}

fn day(condition: &ConditionOptimum) -> String {
    format!("{:+.0}, {:+.0}", condition.isa_deviation_k, condition.tailwind_kt)
}

fn is_marked(condition: &ConditionOptimum, best: &BestLevel) -> bool {
    best.at_edge || speed_of(condition, best).is_some_and(|speed| speed.edge.is_some())
}

/// The optimum Mach number at the best level.
fn speed_of<'c>(
    condition: &'c ConditionOptimum,
    best: &BestLevel,
) -> Option<&'c super::condition::SpeedOptimum> {
    let level = condition
        .levels
        .iter()
        .find(|level| level.pressure_altitude_ft.total_cmp(&best.pressure_altitude_ft).is_eq())?;
    level.speeds.iter().find(|speed| speed.kind == best.kind)
}
