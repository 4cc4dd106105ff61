//! What the factor of a drag table's uncertainty leaves out, at a point and on average over many.
//!
//! Of a node that flights visit it is the little that its columns do not hold, which changes its sign between one chosen node
//! and the next; of a node that nobody visits it is nearly all, and one thing wherever one flies there.

use std::collections::BTreeMap;

use effects::Response;
use lut::Outside;

use crate::signals::table_uncertainty::{NEGLIGIBLE_SHARE, TableUncertainty};

/// A node and its weight in a prediction of ln net thrust, or of ln fuel flow.
pub(crate) type Weighted = (usize, f64);

impl TableUncertainty {
    /// Nodes about a point, with their weights; none outside the grid.
    pub(crate) fn corners(&self, response: &Response) -> Option<[Weighted; 4]> {
        let (lift, mach) = (response.lift_coefficient, response.mach);
        let cell = self.grid.locate(lift, mach, Outside::Hold).ok()?;
        let (nodes, weights) = (cell.nodes(), cell.weights());
        Some(core::array::from_fn(|k| (nodes[k], weights[k])))
    }

    /// Variance of the relative error at a point that the factor leaves out.
    pub(crate) fn left_out(&self, response: &Response) -> f64 {
        let corners = self.corners(response);
        let sum: f64 = corners.iter().flatten().map(|(node, w)| w * self.left_of(*node)).sum();
        sum * sum
    }

    /// Standard deviation of what it leaves out of the nodes that nobody visits.
    pub(crate) fn left_out_unvisited(&self, corners: &[Weighted]) -> f64 {
        let unvisited = corners.iter().filter(|(node, _)| !self.is_held(*node));
        unvisited.map(|(node, weight)| weight * self.left_of(*node)).sum()
    }

    /// Variance of a sum over visited nodes of what it leaves out of them. Nodes that lean most on one chosen node err together,
    /// others do not.
    ///
    /// ```text
    /// Σ_p (Σ_(n at p) w_n·√v_n)²,   n at the pivot p of the largest |ℓ_n·ℓ_p|/|ℓ_p|, v_n what is left of it      [baseline.9]
    /// ```
    pub(crate) fn left_out_visited(&self, weights: &BTreeMap<usize, f64>) -> f64 {
        let mut by_pivot: BTreeMap<usize, f64> = BTreeMap::new();
        for (&node, weight) in weights.iter().filter(|(node, _)| self.is_held(**node)) {
            *by_pivot.entry(self.nearest_pivot(node)).or_default() += weight * self.left_of(node);
        }
        by_pivot.values().map(|sum| sum * sum).sum()
    }

    fn left_of(&self, node: usize) -> f64 {
        self.left.get(node).copied().unwrap_or(0.0).sqrt()
    }

    /// Whether the factor holds as much of a node as it does of visited ones.
    fn is_held(&self, node: usize) -> bool {
        let left = self.left.get(node).copied().unwrap_or(0.0);
        left <= NEGLIGIBLE_SHARE * (left + self.covariance(node, node))
    }

    fn nearest_pivot(&self, node: usize) -> usize {
        let likeness = |pivot: usize| {
            self.covariance(node, pivot).abs() / self.covariance(pivot, pivot).sqrt()
        };
        let pivots = self.pivots.iter().copied();
        pivots.max_by(|&a, &b| likeness(a).total_cmp(&likeness(b))).unwrap_or(node)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use lut::{Axis, Grid};

    const SIDE: usize = 24;

    fn covariance(a: usize, b: usize, length: f64) -> f64 {
        let at = |node: usize| ((node / SIDE) as f64, (node % SIDE) as f64);
        let ((x, y), (u, v)) = (at(a), at(b));
        let likeness = (-((x - u).powi(2) + (y - v).powi(2)) / (2.0 * length * length)).exp();
        2.5e-3 * (likeness + if a == b { 1e-6 } else { 0.0 })
    }

    /// A table of which a square in the middle is visited.
    fn visited() -> Vec<usize> {
        (6..18).flat_map(|x| (6..18).map(move |y| x * SIDE + y)).collect()
    }

    fn table(length: f64) -> TableUncertainty {
        let axis = || Axis::new((0..SIDE).map(|k| k as f64).collect()).unwrap();
        let variances = vec![covariance(0, 0, length); SIDE * SIDE];
        let column = |node: usize| (0..SIDE * SIDE).map(|b| covariance(node, b, length)).collect();
        let grid = Arc::new(Grid::new(axis(), axis()));
        TableUncertainty::from_columns(grid, &visited(), &variances, column).unwrap()
    }

    /// Variance of the sum of what is left, and of the same if all nodes erred together. The oracle is the covariance of all
    /// nodes less the factor's, written out.
    fn dense(table: &TableUncertainty, weights: &BTreeMap<usize, f64>, length: f64) -> (f64, f64) {
        let mut exact = 0.0;
        for (&a, of_a) in weights {
            for (&b, of_b) in weights {
                exact += of_a * of_b * (covariance(a, b, length) - table.covariance(a, b));
            }
        }
        let together: f64 = weights.iter().map(|(&node, w)| w * table.left_of(node)).sum();
        (exact, together * together)
    }

    /// Means over a band, a spot and all of what is visited: never below half of what is left, and below what it would be if all
    /// nodes erred together.
    #[test]
    fn means_over_visited_nodes_are_near_what_is_left_of_them() {
        for length in [2.0, 4.0, 8.0] {
            let table = table(length);
            let near = |node: &usize, x: usize, y: usize| {
                (node / SIDE).abs_diff(9) < x && (node % SIDE).abs_diff(12) < y
            };
            for (x, y) in [(20, 20), (2, 20), (20, 2), (3, 3)] {
                let nodes: Vec<usize> =
                    visited().into_iter().filter(|node| near(node, x, y)).collect();
                let share = 1.0 / nodes.len() as f64;
                let weights: BTreeMap<usize, f64> =
                    nodes.into_iter().map(|node| (node, share)).collect();
                let (exact, together) = dense(&table, &weights, length);
                let found = table.left_out_visited(&weights);
                assert!(found > 0.5 * exact, "{length} {x} {y}: {found} {exact}");
                assert!(found < 0.7 * together, "{length} {x} {y}: {found} {together}");
            }
        }
    }

    /// A single visited node has what is left of it; one that nobody visits is not among them.
    #[test]
    fn one_node_has_what_is_left_of_it() {
        let table = table(4.0);
        let node = 9 * SIDE + 11;
        let found = table.left_out_visited(&BTreeMap::from([(node, 0.5)]));
        assert!((found - 0.25 * table.left[node]).abs() < 1e-18, "{found}");
        let corner = BTreeMap::from([(0, 1.0)]);
        assert!(table.left_out_visited(&corner) <= 0.0);
        assert!((table.left_out_unvisited(&[(0, 1.0)]) - table.left[0].sqrt()).abs() < 1e-15);
    }
}
