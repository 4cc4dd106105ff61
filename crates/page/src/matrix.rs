//! What was planted against what was found: the confusion matrix of blind trials.

use std::collections::{BTreeMap, BTreeSet};

use flight::effect::EffectId;
use maud::{Markup, html};

use crate::chart::{Axis, Chart};

/// Cases by what was planted, then by what was found.
pub type Confusion = BTreeMap<String, BTreeMap<String, usize>>;

/// Width and height of a cell.
const CELL: f64 = 18.0;
/// Room for the names at the left and below.
const NAMES: f64 = 190.0;

/// Width of the drawing.
pub(crate) fn width(confusion: &Confusion) -> f64 {
    NAMES + CELL * columns(confusion).len() as f64 + 40.0
}

/// Whether that is what should have been found: the effect itself, no gap where nothing was planted, outside the library where
/// the library does not have it.
pub(crate) fn is_right(planted: &str, found: &str) -> bool {
    match planted {
        "nothing" => found == "no_gap",
        _ if EffectId::from_name(planted).is_none() => found == "outside_library",
        _ => planted == found,
    }
}

/// What was found, that of an effect planted first, in the order of the rows.
fn columns(confusion: &Confusion) -> Vec<&str> {
    let found: BTreeSet<&str> =
        confusion.values().flat_map(|row| row.keys()).map(String::as_str).collect();
    let mut columns: Vec<&str> =
        confusion.keys().map(String::as_str).filter(|name| found.contains(name)).collect();
    columns.extend(found.iter().filter(|name| !confusion.contains_key(**name)));
    columns
}

/// The drawing: a row for each thing planted, a column for each thing found; full colour is all cases of the row.
pub(crate) fn matrix(name: &str, confusion: &Confusion, number: usize) -> Markup {
    let columns = columns(confusion);
    let (width, height) = (columns.len() as f64, confusion.len() as f64);
    let chart = Chart {
        id: format!("confusion-{number}"),
        title: name.to_owned(),
        description: "Blind trials: planted by row, found by column.".to_owned(),
        width: NAMES + CELL * width + 40.0,
        height: NAMES + CELL * height + 40.0,
        x: Axis::within(0.0, width, 1),
        y: Axis::within(0.0, height, 1),
        x_label: String::new(),
        y_label: String::new(),
    };
    html! {
        svg viewBox=(format!("0 0 {} {}", chart.width, chart.height)) role="img"
            aria-labelledby=(format!("{0}-title {0}-desc", chart.id)) {
            title id=(format!("{}-title", chart.id)) { (chart.title) }
            desc id=(format!("{}-desc", chart.id)) { (chart.description) }
            @for (k, column) in columns.iter().enumerate() {
                @let x = NAMES + CELL * (k as f64 + 0.7);
                text class="tick" text-anchor="start" transform=(format!("translate({x} {}) rotate(-60)", NAMES - 6.0)) { (column) }
            }
            @for (k, (planted, row)) in confusion.iter().enumerate() {
                @let y = NAMES + CELL * k as f64;
                @let cases: usize = row.values().sum();
                text class="tick" text-anchor="end" x=(NAMES - 6.0) y=(y + 13.0) { (planted) }
                @for (place, column) in columns.iter().enumerate() {
                    @let count = row.get(*column).copied().unwrap_or(0);
                    @let x = NAMES + CELL * place as f64;
                    @let right = is_right(planted, column);
                    rect class=(cell_class(count, cases, right)) x=(x) y=(y) width=(CELL) height=(CELL) {}
                    @if count > 0 {
                        text class="tick" text-anchor="middle" x=(x + CELL / 2.0) y=(y + 13.0) { (count) }
                    }
                }
            }
        }
    }
}

/// Right ones are blue, wrong ones orange.
fn cell_class(count: usize, cases: usize, right: bool) -> String {
    let share = count as f64 / cases.max(1) as f64;
    let shade = if right { -share } else { share };
    if count == 0 {
        "cell".to_owned()
    } else {
        format!("cell {}", crate::shade::class(shade, 1.25))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_should_have_been_found() {
        let right = [
            ("drag_factor", "drag_factor"),
            ("nothing", "no_gap"),
            ("outside_mach_bump", "outside_library"),
        ];
        assert!(right.iter().all(|(planted, found)| is_right(planted, found)));
        let wrong = [
            ("drag_factor", "no_gap"),
            ("nothing", "drag_factor"),
            ("drag_factor", "outside_library"),
            ("outside_mach_bump", "outside_mach_bump"),
        ];
        assert!(!wrong.iter().any(|(planted, found)| is_right(planted, found)));
    }
}
