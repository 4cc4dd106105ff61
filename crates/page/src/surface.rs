//! The drag surface: how far learning has moved it, how sure that is, and where it was flown.

use maud::{Markup, html};

use crate::chart::{Axis, Chart, Key, Mark, legend, thinned};
use crate::place::Place;
use crate::polars::nodes_near;
use crate::shade;
use crate::text::{breakpoint, signed_tenths};
use crate::view::TailView;

/// Flown points at most. Our choice: they show where, not how many.
const MOST_POINTS: usize = 300;
/// Nodes along each axis at most, so that a fine table does not make a large page; of a finer one every second, third, … is drawn.
const MOST_NODES: usize = 16;
/// Least change of full colour, %.
const LEAST_FULL_PERCENT: f64 = 2.0;

/// Nodes that are drawn along an axis, with the edges between them.
pub(crate) struct Nodes {
    pub(crate) chosen: Vec<usize>,
    edges: Vec<f64>,
}

impl Nodes {
    /// Those about what was flown, evenly chosen where they are more than `most`.
    fn about(grid: &[f64], flown: impl Iterator<Item = f64> + Clone, most: usize) -> Self {
        let (first, last) = nodes_near(grid, flown);
        let step = (last - first + 1).div_ceil(most);
        let chosen: Vec<usize> = (first..=last).step_by(step).collect();
        let at: Vec<f64> = chosen.iter().map(|k| grid[*k]).collect();
        let mut edges: Vec<f64> =
            at.windows(2).map(|pair| f64::midpoint(pair[0], pair[1])).collect();
        if let ([one, two, ..], [.., before, end]) = (at.as_slice(), at.as_slice()) {
            edges.insert(0, one - (two - one) / 2.0);
            edges.push(end + (end - before) / 2.0);
        }
        Self { chosen, edges }
    }

    /// Lift coefficients and Mach numbers that are drawn; `None` where nothing was learnt, or where they are no surface.
    pub(crate) fn of_surface(view: &TailView, most: usize) -> Option<(Self, Self)> {
        let (polars, points) = (&view.polars, &view.points);
        let lift_coefficients = points.iter().map(|point| point.lift_coefficient);
        let rows = Self::about(&polars.lift_coefficient, lift_coefficients, most);
        let columns = Self::about(&polars.mach, points.iter().map(|point| point.mach), most);
        let is_drawn = polars.learnt && rows.chosen.len() > 1 && columns.chosen.len() > 1;
        is_drawn.then_some((rows, columns))
    }
}

/// The map; nothing where nothing was learnt.
pub(crate) fn surface(view: &TailView, place: &Place<'_>) -> Markup {
    let polars = &view.polars;
    let Some((rows, columns)) = Nodes::of_surface(view, MOST_NODES) else { return html! {} };
    let full = full_percent(view, &rows, &columns);
    let ends = |edges: &[f64]| Axis::within(edges[0], edges[edges.len() - 1], 6);
    let chart = Chart {
        id: place.id("surface"),
        title: format!("{}: change of the drag surface", place.tail),
        description: format!(
            "Drag coefficient of the present table against the initial one at {} nodes of Mach number and lift coefficient, and where \
             segments were flown.",
            rows.chosen.len() * columns.chosen.len()
        ),
        width: 500.0,
        height: 290.0,
        x: ends(&columns.edges),
        y: ends(&rows.edges),
        x_label: "Mach number".to_owned(),
        y_label: "lift coefficient CL".to_owned(),
    };
    let flown: Vec<(f64, f64)> = thinned(view.points.len(), MOST_POINTS.min(place.most_points))
        .into_iter()
        .map(|k| (view.points[k].mach, view.points[k].lift_coefficient))
        .collect();
    // Each is written in the words of many cells.
    let words_of = |grid: &[f64], nodes: &Nodes| -> Vec<String> {
        nodes.chosen.iter().map(|k| breakpoint(grid[*k])).collect()
    };
    let (lift_coefficient, mach) =
        (words_of(&polars.lift_coefficient, &rows), words_of(&polars.mach, &columns));
    html! {
        figure {
            figcaption {
                b { "Change of the drag surface." }
                " Pale: nodes that no segment has adapted."
            }
            (legend(&[
                (Key::Area, "more5", &format!("more drag than in the initial table, full colour from {full:.1} %")),
                (Key::Area, "less5", "less drag"),
                (Key::Mark(Mark::Dot), "observed", "flown"),
            ]))
            (chart.draw(&html! {
                @for (i, row) in rows.chosen.iter().enumerate() {
                    @for (j, column) in columns.chosen.iter().enumerate() {
                        (chart.cell(
                            (columns.edges[j], columns.edges[j + 1]),
                            (rows.edges[i], rows.edges[i + 1]),
                            &look(view, polars.node(*row, *column), full),
                            &tip(view, polars.node(*row, *column), &mach[j], &lift_coefficient[i]),
                        ))
                    }
                }
                (chart.marks(&flown, Mark::Dot, "observed"))
            }))
        }
    }
}

/// Class of a node's cell.
fn look(view: &TailView, node: usize, full: f64) -> String {
    let faint = if view.polars.informed[node] { "" } else { " faint" };
    format!("{}{faint}", shade::class(change(view, node), full))
}

/// The change of full colour, %.
pub(crate) fn full_percent(view: &TailView, rows: &Nodes, columns: &Nodes) -> f64 {
    let node = |row: &usize, column: &usize| view.polars.node(*row, *column);
    let nodes = rows.chosen.iter().flat_map(|row| columns.chosen.iter().map(|c| node(row, c)));
    nodes.map(|node| change(view, node).abs()).fold(LEAST_FULL_PERCENT, f64::max)
}

/// By how much learning has moved a node, %.
pub(crate) fn change(view: &TailView, node: usize) -> f64 {
    100.0 * (view.polars.current[node] / view.polars.initial[node] - 1.0)
}

fn tip(view: &TailView, node: usize, mach: &str, lift_coefficient: &str) -> String {
    let polars = &view.polars;
    let (initial, current) = (polars.initial[node], polars.current[node]);
    let within = polars
        .half_width95
        .as_ref()
        .map_or_else(String::new, |half| format!(" ± {:.1}", 100.0 * half[node]));
    format!(
        "Mach {mach}, CL {lift_coefficient}\nCD {initial:.4} to {current:.4}: {}{within} %",
        signed_tenths(change(view, node))
    )
}
