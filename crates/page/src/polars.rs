//! Drag polars: initial and final table over lift coefficient at the Mach numbers that were flown, with the drag that
//! was observed there.

use maud::{Markup, html};

use crate::chart::{Axis, Chart, Key, Mark, legend, thinned};
use crate::place::Place;
use crate::text::breakpoint;
use crate::view::{Point, TailView};
use pipeline::summary::counted;

/// Panels at most.
const PANELS: usize = 4;
/// Nodes beyond the outermost segment that are still drawn.
const NODES_BEYOND: usize = 2;
/// Observed points within this share of the curves' range beyond the curves are on the scale: one wrong report must not
/// flatten the polars.
const ROOM_FOR_POINTS: f64 = 0.5;

/// Scales that all panels share, and the nodes on them.
struct Frame {
    first_node: usize,
    last_node: usize,
    x: Axis,
    y: Axis,
}

/// Polars in panels, one for each Mach number.
pub(crate) fn polars(view: &TailView, place: &Place<'_>) -> Markup {
    let machs = mach_numbers(view);
    let shown = thinned(view.points.len(), place.most_points);
    let frame = Frame::around(view, &machs);
    let mut entries = vec![(Key::Line, "initial", "initial table")];
    if view.polars.learnt {
        entries.push((
            Key::Line,
            "final",
            if view.adapted { "final table" } else { "table as given" },
        ));
        entries.push((Key::Mark(Mark::Disc), "final", "node that a segment has adapted"));
    }
    entries.push((Key::Mark(Mark::Ring), "final", "node that no segment has adapted"));
    entries.push((
        Key::Mark(Mark::Diamond),
        "final",
        "the same, and outside the guide: extrapolated",
    ));
    entries.push((Key::Mark(Mark::Dot), "observed", "segment, observed"));
    let grid = &view.polars.lift_coefficient;
    html! {
        figure.wide {
            figcaption {
                b { "Drag polars." }
                " Drag coefficient over lift coefficient"
                @if view.polars.half_width95.is_some() { ", nodes with their 95 % interval," }
                " at the Mach numbers of the table nearest to most segments. Each \
                 segment is drawn at the Mach number nearest to its own, up to half a step away: points lie off a curve \
                 for that reason too."
            }
            (legend(&entries))
            div.panels {
                @for mach in machs {
                    (panel(view, &frame, mach, &shown, place))
                }
            }
            @if frame.first_node > 0 || frame.last_node + 1 < grid.len() {
                p.note {
                    "Drawn from lift coefficient " (breakpoint(grid[frame.first_node])) " to "
                    (breakpoint(grid[frame.last_node])) "; the table goes from "
                    (breakpoint(grid[0])) " to " (breakpoint(grid[grid.len() - 1])) "."
                }
            }
            @if shown.len() < view.points.len() {
                p.note { (place.thinned_words(shown.len(), view.points.len(), "segments")) }
            }
        }
    }
}

fn panel(
    view: &TailView,
    frame: &Frame,
    mach: usize,
    shown: &[usize],
    place: &Place<'_>,
) -> Markup {
    let polars = &view.polars;
    let near = |point: &Point| nearest(&polars.mach, point.mach) == mach;
    let segments = view.points.iter().filter(|point| near(point)).count();
    let observed: Vec<(f64, f64)> = shown
        .iter()
        .map(|k| &view.points[*k])
        .filter(|point| near(point))
        .map(|point| (point.lift_coefficient, point.drag_coefficient))
        .collect();
    let curve = |values: &[f64]| {
        let nodes = frame.first_node..=frame.last_node;
        nodes
            .map(|k| (polars.lift_coefficient[k], values[polars.node(k, mach)]))
            .collect::<Vec<_>>()
    };
    let (initial, current) = (curve(&polars.initial), curve(&polars.current));
    let nodes = |wanted: fn(bool, bool) -> bool| {
        let nodes = frame.first_node..=frame.last_node;
        let nodes = nodes
            .map(|k| (k, polars.node(k, mach)))
            .filter(|(_, node)| wanted(polars.informed[*node], polars.extrapolated[*node]));
        nodes
            .map(|(k, node)| (polars.lift_coefficient[k], polars.current[node]))
            .collect::<Vec<_>>()
    };
    let uncertain = intervals(view, frame, mach);
    let heading =
        format!("Mach {}: {}", breakpoint(polars.mach[mach]), counted(segments, "segment"));
    let informed = nodes(|informed, _| informed);
    let chart = Chart {
        id: place.id(&format!("polar-{mach}")),
        title: format!("{}: drag polar at Mach {}", place.tail, breakpoint(polars.mach[mach])),
        description: format!(
            "Drag coefficient over lift coefficient in the tables, and {} observed nearest to this Mach \
             number. {} of {} drawn nodes were adapted.",
            counted(segments, "segment"),
            informed.len(),
            current.len()
        ),
        width: 500.0,
        height: 300.0,
        x: frame.x.clone(),
        y: frame.y.clone(),
        x_label: "lift coefficient CL".to_owned(),
        y_label: "drag coefficient CD".to_owned(),
    };
    let beyond = chart.beyond(&observed);
    let marks = html! {
        (chart.marks(&observed, Mark::Dot, "observed"))
        (chart.intervals(&uncertain, "span"))
        (chart.polyline(&initial, "initial"))
        @if polars.learnt { (chart.polyline(&current, "final")) }
        (chart.marks(&nodes(|informed, extrapolated| !informed && !extrapolated), Mark::Ring, "final"))
        (chart.marks(&nodes(|informed, extrapolated| !informed && extrapolated), Mark::Diamond, "final"))
        (chart.marks(&informed, Mark::Disc, "final"))
    };
    html! {
        div {
            p.panel { (heading) }
            (chart.draw(&marks))
            @if beyond > 0 {
                p.note { (counted(beyond, "observed point")) " beyond the drawn range." }
            }
        }
    }
}

/// 95 % intervals of the drawn nodes at a Mach number, over lift coefficient; the law states them relative to the initial table.
fn intervals(view: &TailView, frame: &Frame, mach: usize) -> Vec<(f64, (f64, f64))> {
    let polars = &view.polars;
    let Some(half) = &polars.half_width95 else { return Vec::new() };
    (frame.first_node..=frame.last_node)
        .map(|k| {
            let node = polars.node(k, mach);
            let (at, half) = (polars.current[node], half[node] * polars.initial[node]);
            (polars.lift_coefficient[k], (at - half, at + half))
        })
        .collect()
}

impl Frame {
    fn around(view: &TailView, machs: &[usize]) -> Self {
        let polars = &view.polars;
        let grid = &polars.lift_coefficient;
        let (first_node, last_node) =
            nodes_near(grid, view.points.iter().map(|point| point.lift_coefficient));
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for node in
            machs.iter().flat_map(|mach| (first_node..=last_node).map(|k| polars.node(k, *mach)))
        {
            low = low.min(polars.initial[node]).min(polars.current[node]);
            high = high.max(polars.initial[node]).max(polars.current[node]);
        }
        let room = ROOM_FOR_POINTS * (high - low);
        let (least, most) = (low - room, high + room);
        for point in &view.points {
            if machs.contains(&nearest(&polars.mach, point.mach))
                && (least..=most).contains(&point.drag_coefficient)
            {
                low = low.min(point.drag_coefficient);
                high = high.max(point.drag_coefficient);
            }
        }
        let margin = 0.04 * (grid[last_node] - grid[first_node]);
        Self {
            first_node,
            last_node,
            x: Axis::within(grid[first_node] - margin, grid[last_node] + margin, 6),
            y: Axis::around(low, high, 6),
        }
    }
}

/// Breakpoints of Mach number nearest to most segments, in order; without segments, some in the middle.
fn mach_numbers(view: &TailView) -> Vec<usize> {
    let mach = &view.polars.mach;
    let mut segments = vec![0_usize; mach.len()];
    for point in &view.points {
        segments[nearest(mach, point.mach)] += 1;
    }
    let mut chosen: Vec<usize> = (0..mach.len()).filter(|k| segments[*k] > 0).collect();
    // A stable sort: of equal counts the lower Mach number comes first.
    chosen.sort_by_key(|k| std::cmp::Reverse(segments[*k]));
    chosen.truncate(PANELS);
    if chosen.is_empty() {
        let middle = mach.len() / 2;
        chosen.extend(middle.saturating_sub(1)..(middle + 1).min(mach.len()));
    }
    chosen.sort_unstable();
    chosen
}

/// First and last node to draw: those about the segments and two more at each side; all without segments.
pub(crate) fn nodes_near(grid: &[f64], flown: impl Iterator<Item = f64> + Clone) -> (usize, usize) {
    let inside = flown.filter(|value| grid[0] <= *value && *value <= grid[grid.len() - 1]);
    let low = inside.clone().fold(f64::INFINITY, f64::min);
    let high = inside.fold(f64::NEG_INFINITY, f64::max);
    if low > high {
        return (0, grid.len() - 1);
    }
    let below = grid.partition_point(|node| *node <= low);
    let above = grid.partition_point(|node| *node < high);
    (below.saturating_sub(1 + NODES_BEYOND), (above + NODES_BEYOND).min(grid.len() - 1))
}

/// The breakpoint nearest to a value; of two equally near, the lower one.
fn nearest(breakpoints: &[f64], value: f64) -> usize {
    let mut best = 0;
    for (k, breakpoint) in breakpoints.iter().enumerate() {
        if (breakpoint - value).abs() < (breakpoints[best] - value).abs() {
            best = k;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_breakpoint() {
        let mach = [0.70, 0.75, 0.85];
        assert_eq!(
            [0.1, 0.72, 0.73, 0.81, 2.0].map(|value| nearest(&mach, value)),
            [0, 0, 1, 2, 2]
        );
    }
}
