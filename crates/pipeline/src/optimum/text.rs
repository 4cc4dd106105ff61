//! The best levels and Mach numbers as a table for a person.

use std::collections::BTreeSet;
use std::fmt::Write;

use super::condition::{BestLevel, ConditionOptimum};
use super::speeds::Kind;
use crate::summary::aligned;

/// The best level of each condition and way to choose the Mach number, one line each.
#[must_use]
pub fn table(conditions: &[ConditionOptimum]) -> String {
    let days: BTreeSet<String> = conditions.iter().map(day).collect();
    let one_day = days.len() == 1;
    let mut head = vec!["kind, mass kg"];
    head.extend((!one_day).then_some("ISA, wind"));
    head.extend(["FL", "Mach", "book FL, M", "saves kg/h"]);
    let mut rows: Vec<Vec<String>> = vec![head.into_iter().map(str::to_owned).collect()];
    let mut uninformed = Vec::new();
    let mut marked = false;
    for condition in conditions {
        if condition.best.is_empty() {
            uninformed.push(format!("{:.0} kg", condition.mass_kg));
        }
        for best in &condition.best {
            marked |= is_marked(condition, best);
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
    if marked {
        text.push_str(
            "* Mach number or level at the edge of what was asked for or of what guide or flights inform: the aircraft's own \
             optimum may be beyond it.\n",
        );
    }
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
    let level_interval = best.pressure_altitude_ci95.filter(|[low, high]| low < high);
    vec![
        format!("{kind} {:.0}", condition.mass_kg),
        format!("{}{}", level(best.pressure_altitude_ft), interval(level_interval, &level)),
        format!("{}{}{mark}", mach(best.mach), interval(speed.and_then(|s| s.mach_ci95), &mach)),
        format!("{} {}", level(best.book_pressure_altitude_ft), mach(best.book_mach)),
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
