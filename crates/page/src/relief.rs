//! The drag surface in three dimensions: how far learning has moved each node, over Mach number and lift coefficient.
//!
//! Drawn by the painter's order: facets that are farther away first. A script turns it: every piece names the corners that it joins
//! (`data-p`), and the drawing has them once (`data-at`).

use maud::{Markup, html};

use crate::chart::{Axis, Key, Mark, Tick, legend, thinned};
use crate::place::Place;
use crate::shade;
use crate::solid::{Camera, Solid};
use crate::surface::{Nodes, change, full_percent};
use crate::text::breakpoint;
use crate::view::{Point, TailView};

/// Nodes along each axis at most: with all of them a page of thirty tails grows by less than 1 MB.
const MOST_NODES: usize = 12;
/// Flown points at most. Our choice: they show where, not how many.
const MOST_POINTS: usize = 150;
/// Half the height of the box, where half its sides are 1.
const HALF_HEIGHT: f64 = 0.6;
/// Of labels from the box.
const LABEL: f64 = 1.14;
/// Of names of axes from the box.
const NAME: f64 = 1.55;

/// The three scales of the box.
struct Scales {
    mach: Axis,
    lift_coefficient: Axis,
    change: Axis,
}

impl Scales {
    /// A corner of the box, from −1 to 1 (upright: half the height of the box).
    fn at(&self, mach: f64, lift_coefficient: f64, change: f64) -> [f64; 3] {
        let side = |axis: &Axis, value| 2.0 * axis.share(value) - 1.0;
        [
            side(&self.mach, mach),
            side(&self.lift_coefficient, lift_coefficient),
            HALF_HEIGHT * side(&self.change, change),
        ]
    }
}

/// A node that is drawn.
#[derive(Clone, Copy)]
struct Node {
    mach: f64,
    lift_coefficient: f64,
    change: f64,
    /// Half its 95 % interval where a segment has adapted it and the law has one.
    half: Option<f64>,
    informed: bool,
}

/// What facets are drawn of.
struct Surface<'a> {
    /// Lift coefficient by row, Mach number by column.
    nodes: &'a [Vec<Node>],
    /// Change of full colour, %.
    full: f64,
    flown: &'a [&'a Point],
}

/// The drawing; nothing where nothing was learnt.
pub(crate) fn relief(view: &TailView, place: &Place<'_>) -> Markup {
    let Some((rows, columns)) = Nodes::of_surface(view, MOST_NODES) else { return html! {} };
    let nodes: Vec<Vec<Node>> = rows
        .chosen
        .iter()
        .map(|row| columns.chosen.iter().map(|column| node(view, *row, *column)).collect())
        .collect();
    let scales = scales(&nodes);
    let full = full_percent(view, &rows, &columns);
    let mut solid = Solid::new(Camera::HOME);
    floor(&mut solid, &scales);
    let flown: Vec<&Point> = thinned(view.points.len(), MOST_POINTS.min(place.most_points))
        .into_iter()
        .map(|k| &view.points[k])
        .collect();
    facets(&mut solid, &scales, &Surface { nodes: &nodes, full, flown: &flown });
    edges_of_initial(&mut solid, &scales, &nodes);
    bars(&mut solid, &scales, &nodes);
    labels(&mut solid, &scales);
    let title = format!("{}: drag surface in three dimensions", place.tail);
    let description = format!(
        "Change of the drag coefficient against the initial table at {} nodes over Mach number and lift coefficient; the map of the \
         same nodes has the numbers.",
        rows.chosen.len() * columns.chosen.len()
    );
    figure(view, &solid.draw(&place.id("relief"), &title, &description))
}

fn figure(view: &TailView, drawing: &Markup) -> Markup {
    let mut entries = vec![(Key::Line, "initial", "edge of the initial table")];
    if view.polars.half_width95.is_some() {
        entries.push((Key::Line, "within", "95 % interval of a node that segments have adapted"));
    }
    entries.push((Key::Mark(Mark::Dot), "observed", "flown"));
    html! {
        figure {
            figcaption {
                b { "The drag surface before and after." }
                " Height: change of the drag coefficient, %; colours as in the map. Points: where it was flown."
            }
            (legend(&entries))
            (drawing)
        }
    }
}

fn node(view: &TailView, row: usize, column: usize) -> Node {
    let polars = &view.polars;
    let k = polars.node(row, column);
    let informed = polars.informed[k];
    Node {
        mach: polars.mach[column],
        lift_coefficient: polars.lift_coefficient[row],
        change: change(view, k),
        half: polars.half_width95.as_ref().filter(|_| informed).map(|half| 100.0 * half[k]),
        informed,
    }
}

fn scales(nodes: &[Vec<Node>]) -> Scales {
    let all = || nodes.iter().flatten();
    let half = |node: &Node| node.half.unwrap_or(0.0);
    let low = all().map(|node| node.change - half(node)).fold(0.0, f64::min);
    let high = all().map(|node| node.change + half(node)).fold(0.0, f64::max);
    let (first, last) = (nodes[0][0], nodes[nodes.len() - 1][nodes[0].len() - 1]);
    Scales {
        mach: Axis::within(first.mach, last.mach, 4),
        lift_coefficient: Axis::within(first.lift_coefficient, last.lift_coefficient, 4),
        change: Axis::around(low, high, 4),
    }
}

/// Lines of the scales on the floor, and the upright scale at the left.
fn floor(solid: &mut Solid, scales: &Scales) {
    let ground = scales.change.first();
    let (mach, lift) = (&scales.mach, &scales.lift_coefficient);
    let mut lines = Vec::new();
    let with_ends = |axis: &Axis| -> Vec<f64> {
        let ticks = axis.ticks().iter().map(|tick| tick.at);
        ticks.chain([axis.first(), axis.last()]).collect()
    };
    for at in with_ends(mach) {
        lines.push(scales.at(at, lift.first(), ground));
        lines.push(scales.at(at, lift.last(), ground));
    }
    for at in with_ends(lift) {
        lines.push(scales.at(mach.first(), at, ground));
        lines.push(scales.at(mach.last(), at, ground));
    }
    solid.below("grid", &lines);
    let upright = [scales.change.first(), scales.change.last()]
        .map(|at| scales.at(mach.first(), lift.last(), at));
    solid.piece("frame", &upright, "");
}

fn facets(solid: &mut Solid, scales: &Scales, surface: &Surface<'_>) {
    // Each is written in the words of many facets.
    let mach: Vec<String> = surface.nodes[0].iter().map(|node| breakpoint(node.mach)).collect();
    let lift_coefficient: Vec<String> =
        surface.nodes.iter().map(|row| breakpoint(row[0].lift_coefficient)).collect();
    for (row, rows) in surface.nodes.windows(2).enumerate() {
        for column in 1..rows[0].len() {
            let corners =
                [rows[0][column - 1], rows[0][column], rows[1][column], rows[1][column - 1]];
            let mean = corners.iter().map(|node| node.change).sum::<f64>() / 4.0;
            let faint = if corners.iter().any(|node| node.informed) { "" } else { " faint" };
            let tip = format!(
                "Mach {} to {}, CL {} to {}\n{mean:+.1} % in the mean",
                mach[column - 1],
                mach[column],
                lift_coefficient[row],
                lift_coefficient[row + 1]
            );
            let at = corners.map(|node| scales.at(node.mach, node.lift_coefficient, node.change));
            let class = format!("cell facet {}{faint}", shade::class(mean, surface.full));
            solid.piece(&class, &at, &tip);
            let flown = surface.flown.iter().filter_map(|point| height(&corners, point));
            let flown =
                flown.map(|(point, change)| scales.at(point.mach, point.lift_coefficient, change));
            solid.dots_on(&at, "dot observed", &flown.collect::<Vec<_>>());
        }
    }
}

/// The change at a flown point of a facet, bilinear between its corners; none beside it.
fn height<'a>(corners: &[Node; 4], point: &'a Point) -> Option<(&'a Point, f64)> {
    let share = |value: f64, from: f64, to: f64| (value - from) / (to - from);
    let across = share(point.mach, corners[0].mach, corners[1].mach);
    let along =
        share(point.lift_coefficient, corners[0].lift_coefficient, corners[3].lift_coefficient);
    // Half-open: a point between two facets lies on one.
    if !((0.0..1.0).contains(&across) && (0.0..1.0).contains(&along)) {
        return None;
    }
    let between = |one: &Node, other: &Node| one.change + across * (other.change - one.change);
    let (near, far) = (between(&corners[0], &corners[1]), between(&corners[3], &corners[2]));
    Some((point, near + along * (far - near)))
}

/// The edges of the initial table, which is the plane of no change; from node to node, so that each is in front or behind.
fn edges_of_initial(solid: &mut Solid, scales: &Scales, nodes: &[Vec<Node>]) {
    let at = |node: &Node| scales.at(node.mach, node.lift_coefficient, 0.0);
    let mut edge = |line: &[&Node]| {
        for pair in line.windows(2) {
            solid.piece("line initial", &[at(pair[0]), at(pair[1])], "");
        }
    };
    for row in [&nodes[0], &nodes[nodes.len() - 1]] {
        edge(&row.iter().collect::<Vec<_>>());
    }
    for column in [0, nodes[0].len() - 1] {
        edge(&nodes.iter().map(|row| &row[column]).collect::<Vec<_>>());
    }
}

fn bars(solid: &mut Solid, scales: &Scales, nodes: &[Vec<Node>]) {
    for node in nodes.iter().flatten() {
        let Some(half) = node.half else { continue };
        let ends = [node.change - half, node.change + half];
        let ends = ends.map(|end| scales.at(node.mach, node.lift_coefficient, end));
        solid.piece("line within", &ends, "");
    }
}

fn labels(solid: &mut Solid, scales: &Scales) {
    let ground = -HALF_HEIGHT;
    let side = |axis: &Axis, tick: &Tick| 2.0 * axis.share(tick.at) - 1.0;
    for tick in scales.mach.ticks() {
        solid.text("tick", [side(&scales.mach, tick), -LABEL, ground], &tick.label);
    }
    for tick in scales.lift_coefficient.ticks() {
        solid.text("tick", [-LABEL, side(&scales.lift_coefficient, tick), ground], &tick.label);
    }
    for tick in scales.change.ticks() {
        let height = HALF_HEIGHT * side(&scales.change, tick);
        solid.text("tick", [-LABEL, LABEL, height], &tick.label);
    }
    solid.text("label", [0.1, -NAME, ground], "Mach number");
    solid.text("label", [-NAME, 0.1, ground], "CL");
    solid.text("label", [-LABEL, LABEL, HALF_HEIGHT + 0.2], "change, %");
}
