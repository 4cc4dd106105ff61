//! The best levels and Mach numbers as a table for a person.

use std::fmt::Write;

use super::condition::{BestLevel, ConditionOptimum};
use super::speeds::Kind;
use crate::summary::aligned;

/// The best level of each condition and way to choose the Mach number, one line each.
#[must_use]
pub fn table(conditions: &[ConditionOptimum]) -> String {
    let head = [
        "kind",
        "mass kg",
        "ISA",
        "tailwind kt",
        "level ft",
        "Mach",
        "book: level",
        "Mach",
        "saves kg/h",
    ];
    let mut rows: Vec<Vec<String>> = vec![head.map(str::to_owned).to_vec()];
    let mut uninformed = Vec::new();
    let mut marked = false;
    for condition in conditions {
        if condition.best.is_empty() {
            uninformed.push(format!("{:.0} kg", condition.mass_kg));
        }
        for best in &condition.best {
            marked |= is_marked(condition, best);
            rows.push(row(condition, best));
        }
    }
    let mut text = aligned(&rows);
    text.push_str(
        "In parentheses: 95 % intervals. Saved: the tail's own level and Mach number against the book's, at the book's ground \
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
        Kind::MaximumRange => "maximum range",
        Kind::LongRange => "long range",
        Kind::CostIndex => "cost index",
    };
    let interval = |interval: Option<[f64; 2]>, of: &dyn Fn(f64) -> String| {
        interval.map_or_else(String::new, |[low, high]| format!(" ({}–{})", of(low), of(high)))
    };
    let feet = |value: f64| format!("{value:.0}");
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
    vec![
        kind.to_owned(),
        format!("{:.0}", condition.mass_kg),
        format!("{:+.0}", condition.isa_deviation_k),
        format!("{:+.0}", condition.tailwind_kt),
        format!(
            "{}{}",
            feet(best.pressure_altitude_ft),
            interval(best.pressure_altitude_ci95, &feet)
        ),
        format!("{}{}{mark}", mach(best.mach), interval(speed.and_then(|s| s.mach_ci95), &mach)),
        feet(best.book_pressure_altitude_ft),
        mach(best.book_mach),
        saved,
    ]
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
