//! The gap over Mach number and lift coefficient.

use diagnose::SegmentGap;
use maud::{Markup, html};

use super::Tail;
use crate::chart::{Axis, Chart, Key, legend};
use crate::shade;
use crate::text::signed;
use pipeline::summary::counted;

/// Cells along Mach number and lift coefficient, about.
const COLUMNS: usize = 9;
const ROWS: usize = 7;
/// The least gap of full colour, %.
const LEAST_FULL_PERCENT: f64 = 1.0;

/// Segments of a cell.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    segments: usize,
    sum_percent: f64,
    in_region: usize,
}

/// The map of a page's tail.
pub(super) fn map(tail: &Tail<'_>) -> Markup {
    let place = tail.diagnosed.diagnosis.r#where.first();
    let marked = place.is_some_and(|place| !place.region.conditions.is_empty());
    gap_map(&tail.id, tail.diagnosed.name(), &tail.figures.segments, marked)
}

/// The map of these segments; where a region is marked, cells mostly of it have an outline.
pub(crate) fn gap_map(id: &str, name: &str, segments: &[SegmentGap], marked: bool) -> Markup {
    let (x, y) = (
        scale(segments, |one| one.mach, COLUMNS),
        scale(segments, |one| one.lift_coefficient, ROWS),
    );
    let columns = x.ticks().len().saturating_sub(1);
    let mut cells = vec![Cell::default(); columns * y.ticks().len().saturating_sub(1)];
    for segment in segments {
        let (Some(column), Some(row)) =
            (place(&x, segment.mach), place(&y, segment.lift_coefficient))
        else {
            continue;
        };
        let cell = &mut cells[row * columns + column];
        cell.segments += 1;
        cell.sum_percent += segment.before_percent;
        cell.in_region += usize::from(segment.in_region);
    }
    let mean = |cell: &Cell| cell.sum_percent / cell.segments as f64;
    let largest = cells
        .iter()
        .filter(|cell| cell.segments > 2)
        .map(|cell| mean(cell).abs())
        .fold(0.0, f64::max);
    let full = largest.max(LEAST_FULL_PERCENT);
    let edge = |axis: &Axis, k: usize| (axis.ticks()[k].at, axis.ticks()[k + 1].at);
    let label =
        |axis: &Axis, k: usize| format!("{}–{}", axis.ticks()[k].label, axis.ticks()[k + 1].label);
    let chart = Chart {
        id: format!("{id}-map"),
        title: format!("{name}: gap over Mach number and lift coefficient"),
        description: format!(
            "Mean gap before anything is added, in cells, of {}.",
            counted(segments.len(), "segment")
        ),
        width: 500.0,
        height: 330.0,
        x,
        y,
        x_label: "Mach number".to_owned(),
        y_label: "lift coefficient CL".to_owned(),
    };
    let marks = html! {
        @for (k, cell) in cells.iter().enumerate().filter(|(_, cell)| cell.segments > 0) {
            @let (row, column) = (k / columns, k % columns);
            @let within = marked && 2 * cell.in_region > cell.segments;
            (chart.cell(
                edge(&chart.x, column),
                edge(&chart.y, row),
                &format!("{}{}", shade::class(mean(cell), full), if within { " within" } else { "" }),
                &format!(
                    "Mach {}, CL {}\ngap {} %, {}",
                    label(&chart.x, column),
                    label(&chart.y, row),
                    signed(Some(mean(cell))),
                    counted(cell.segments, "segment")
                ),
            ))
        }
    };
    html! {
        figure {
            figcaption {
                b { "Where the gap is." } " Mean gap of the segments in each cell."
                @if marked { " Outlined: the place named above." }
            }
            (legend(&[
                (Key::Area, "more5", &format!("burns more than predicted, full colour from {full:.1} %")),
                (Key::Area, "less5", "burns less than predicted"),
            ]))
            (chart.draw(&marks))
        }
    }
}

fn scale(segments: &[SegmentGap], of: fn(&SegmentGap) -> f64, cells: usize) -> Axis {
    let low = segments.iter().map(of).fold(f64::INFINITY, f64::min);
    let high = segments.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
    Axis::around(low, high, cells)
}

/// The cell between two ticks that holds a value.
fn place(axis: &Axis, value: f64) -> Option<usize> {
    let above = axis.ticks().partition_point(|tick| tick.at <= value);
    // The last tick belongs to the last cell.
    axis.holds(value).then(|| above.clamp(1, axis.ticks().len() - 1) - 1)
}
