//! A smooth surface through the nodes of a table, for what needs its slope: where a bilinear surface has its optimum is
//! decided by its edges, which are the grid's and not the aircraft's.

mod table;

pub use table::SmoothTable;

use crate::{Axis, Grid, Outside, OutsideGrid, Table};

/// Nodes that take part in a value.
const NODES: usize = 16;

/// A point's nodes and their weights in the smooth surface. Made by [`SmoothCell::locate`].
///
/// Along each axis the curve in a cell is the cubic that takes the nodes' values at both ends, and there the slopes of
/// the parabolas through each end and its two neighbors (at the ends of an axis, of the parabola through the first or
/// last three). It is exact for surfaces of the second degree along each axis, its slope is continuous, and it does not
/// depend on the nodes being evenly spaced. An axis of two breakpoints gives a straight line.
///
/// ```text
/// value = Σ w_k·v_k   over the 4 × 4 nodes about the cell; some w_k are negative                    [tables.10]
/// ```
///
/// # Source
/// Cubic Hermite interpolation with the slopes of Bessel; de Boor, *A Practical Guide to Splines*, 1978, chapter IV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothCell {
    nodes: [usize; NODES],
    weights: [f64; NODES],
}

impl SmoothCell {
    /// The nodes and weights of a point of a grid.
    ///
    /// # Errors
    /// [`OutsideGrid`] as for [`Grid::locate`] with [`Outside::Error`].
    pub fn locate(grid: &Grid, x: f64, y: f64) -> Result<Self, OutsideGrid> {
        let cell = grid.locate(x, y, Outside::Error)?;
        let (u, v) = cell.local();
        let (low, columns) = (cell.nodes()[0], grid.y().len());
        let (row, column) = (low / columns, low % columns);
        let (along_x, along_y) = (weights(grid.x(), row, u), weights(grid.y(), column, v));
        let mut found = Self { nodes: [0; NODES], weights: [0.0; NODES] };
        for (k, (x_node, x_weight)) in along_x.iter().enumerate() {
            for (l, (y_node, y_weight)) in along_y.iter().enumerate() {
                found.nodes[4 * k + l] = x_node * columns + y_node;
                found.weights[4 * k + l] = x_weight * y_weight;
            }
        }
        Ok(found)
    }

    /// Each node that takes part, and its weight.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> {
        self.nodes.into_iter().zip(self.weights)
    }

    /// The value there of a surface with these values at the grid's nodes, in node order.
    ///
    /// # Panics
    /// Where there are fewer values than the grid has nodes.
    #[must_use]
    pub fn value(&self, values: &[f64]) -> f64 {
        self.nodes.iter().zip(&self.weights).map(|(&node, weight)| weight * values[node]).sum()
    }

    /// The value there of the smooth surface through a table's nodes.
    ///
    /// # Panics
    /// Where the table is on a smaller grid.
    #[must_use]
    pub fn value_of(&self, table: &Table) -> f64 {
        self.value(table.values())
    }
}

/// Four breakpoints about a cell of an axis and their weights at a share of the cell's width; those that do not exist
/// have weight 0.
fn weights(axis: &Axis, cell: usize, share: f64) -> [(usize, f64); 4] {
    let points = axis.breakpoints();
    let mut found = [(cell, 0.0); 4];
    for (slot, found) in found.iter_mut().enumerate() {
        found.0 = (cell + slot).saturating_sub(1).min(points.len() - 1);
    }
    let t = share;
    // Hermite's cubics for the values and the slopes at both ends.
    found[1].1 = (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t);
    found[2].1 = t * t * (3.0 - 2.0 * t);
    let width = points[cell + 1] - points[cell];
    let factors = [t * (1.0 - t) * (1.0 - t) * width, t * t * (t - 1.0) * width];
    for (of_end, factor) in end_slopes(points, cell).iter().zip(factors) {
        for (found, weight) in found.iter_mut().zip(of_end) {
            found.1 += factor * weight;
        }
    }
    found
}

/// The slopes at both ends of a cell as combinations of the values at the four breakpoints about it; 0 for those that do not
/// exist.
fn end_slopes(points: &[f64], cell: usize) -> [[f64; 4]; 2] {
    let mut found = [[0.0; 4]; 2];
    for (end, found) in found.iter_mut().enumerate() {
        for (node, weight) in slope(points, cell + end) {
            // Slots are cell − 1, cell, cell + 1, cell + 2.
            if weight != 0.0 {
                found[node + 1 - cell] = weight;
            }
        }
    }
    found
}

/// The slope at a breakpoint as a combination of values: of the parabola through it and its neighbors, or of the three
/// breakpoints at the end of the axis.
fn slope(points: &[f64], at: usize) -> [(usize, f64); 3] {
    let last = points.len() - 1;
    if last == 1 {
        let width = points[1] - points[0];
        return [(0, -1.0 / width), (1, 1.0 / width), (0, 0.0)];
    }
    let first = at.saturating_sub(1).min(last - 2);
    let x = [points[first], points[first + 1], points[first + 2]];
    let p = points[at];
    // Derivative of Lagrange's polynomials at p.
    let weight = |k: usize| {
        let (a, b) = (x[(k + 1) % 3], x[(k + 2) % 3]);
        (2.0 * p - a - b) / ((x[k] - a) * (x[k] - b))
    };
    [(first, weight(0)), (first + 1, weight(1)), (first + 2, weight(2))]
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use proptest::prelude::*;

    use super::*;

    fn uneven() -> Grid {
        let x = Axis::new(vec![0.1, 0.15, 0.3, 0.35, 0.6]).unwrap();
        Grid::new(x, Axis::new(vec![0.5, 0.7, 0.75, 0.9]).unwrap())
    }

    fn values(grid: &Grid, of: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let at = |node| grid.coordinates(node);
        (0..grid.nodes()).map(|node| of(at(node).0, at(node).1)).collect()
    }

    #[test]
    fn two_breakpoints_are_a_straight_line() {
        let axis = || Axis::new(vec![1.0, 3.0]).unwrap();
        let grid = Grid::new(axis(), axis());
        let nodes = values(&grid, |x, y| 2.0 * x - y);
        let found = SmoothCell::locate(&grid, 1.5, 2.75).unwrap().value(&nodes);
        assert!((found - 0.25).abs() < 1e-14, "{found}");
    }

    #[test]
    fn the_slope_is_continuous_where_a_bilinear_one_has_an_edge() {
        let grid = Arc::new(uneven());
        let table =
            Table::new(Arc::clone(&grid), values(&grid, |x, y| (9.0 * x * y).sin())).unwrap();
        let at = |x: f64| SmoothCell::locate(&grid, x, 0.72).unwrap().value_of(&table);
        let h = 1e-5;
        for edge in [0.15, 0.3, 0.35] {
            let (before, after) = ((at(edge) - at(edge - h)) / h, (at(edge + h) - at(edge)) / h);
            assert!((before - after).abs() < 1e-2, "{before} {after} at {edge}");
        }
    }

    #[test]
    fn outside_there_is_no_value() {
        assert!(SmoothCell::locate(&uneven(), 0.05, 0.6).is_err());
    }

    proptest! {
        #[test]
        fn exact_for_products_of_parabolas(
            x in 0.1_f64..0.6, y in 0.5_f64..0.9, a in -2.0_f64..2.0, b in -2.0_f64..2.0,
        ) {
            let truth = |x: f64, y: f64| (1.0 + a * x + b * x * x) * (0.3 - b * y + a * y * y);
            let grid = uneven();
            let found = SmoothCell::locate(&grid, x, y).unwrap().value(&values(&grid, truth));
            prop_assert!((found - truth(x, y)).abs() < 1e-12, "{found} {}", truth(x, y));
        }
    }
}
