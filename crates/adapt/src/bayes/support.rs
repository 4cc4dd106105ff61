//! Where corrections live: on the table's own nodes, or, of a fine table, on fewer.
//!
//! A correction is smooth: its prior lets it bend over some hundredths of Mach number and of lift coefficient, whatever the
//! table's cells. A table of 300 by 300 nodes would take hours and more memory than a workstation has, and its correction
//! would be the same.

use std::sync::Arc;

use lut::{Axis, Cell, Grid, Outside, Table};

/// Most breakpoints of an axis that all carry a correction. Our choice: over a usual range of 0.5 of Mach number and 0.7 of
/// lift coefficient corrections are then 0.013 and 0.018 apart, a third of the least width over which the prior lets them bend
/// by their own size.
const MOST_BREAKPOINTS: usize = 40;

/// The grid of the corrections, and the way from the table's grid to it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Support {
    table: Arc<Grid>,
    /// `None` where it is the table's own.
    thinned: Option<Arc<Grid>>,
}

impl Support {
    /// For tables on this grid.
    pub(super) fn new(table: &Arc<Grid>) -> Self {
        let thinned = match (thinned(table.x()), thinned(table.y())) {
            (None, None) => None,
            (x, y) => Some(Arc::new(Grid::new(
                x.unwrap_or_else(|| table.x().clone()),
                y.unwrap_or_else(|| table.y().clone()),
            ))),
        };
        Self { table: Arc::clone(table), thinned }
    }

    /// The grid of the corrections.
    pub(super) const fn grid(&self) -> &Arc<Grid> {
        match &self.thinned {
            Some(grid) => grid,
            None => &self.table,
        }
    }

    /// Whether it has fewer nodes than the table.
    pub(super) const fn is_thinned(&self) -> bool {
        self.thinned.is_some()
    }

    /// The corrections that act at a point of the table, and how they do: [`super::coefficients`] on the table's own nodes, the
    /// bilinear weights on fewer.
    pub(super) fn terms(&self, initial: &Table, cell: &Cell) -> Terms {
        let Some(grid) = &self.thinned else {
            let coefficients = super::coefficients(initial, cell);
            return Terms { nodes: cell.nodes(), coefficients, bilinear: cell.weights() };
        };
        let (x, y) = self.table.coordinates(cell.nodes()[0]);
        let ((u, v), (width, height)) = (cell.local(), cell.widths());
        at(grid, x + u * width, y + v * height)
    }

    /// The same at a node of the table.
    fn terms_at_node(&self, node: usize) -> Terms {
        match &self.thinned {
            Some(grid) => {
                let (x, y) = self.table.coordinates(node);
                at(grid, x, y)
            }
            None => Terms {
                nodes: [node; 4],
                coefficients: [1.0, 0.0, 0.0, 0.0],
                bilinear: [1.0, 0.0, 0.0, 0.0],
            },
        }
    }

    /// What values at the corrections are at the nodes of the table.
    pub(super) fn at_table(&self, values: Vec<f64>) -> Vec<f64> {
        if !self.is_thinned() {
            return values;
        }
        let of = |node: usize| self.terms_at_node(node).sum(|node| values[node]);
        (0..self.table.nodes()).map(of).collect()
    }

    /// Variances at the nodes of the table by covariances of neighboring corrections.
    pub(super) fn variances(&self, covariance: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let of = |node: usize| match self.thinned {
            None => covariance(node, node),
            Some(_) => self.terms_at_node(node).variance(&covariance),
        };
        (0..self.table.nodes()).map(of).collect()
    }

    /// A combination of corrections at nodes of the table as one of the corrections that there are.
    pub(super) fn combination(&self, of_table: &[(usize, f64)]) -> Vec<(usize, f64)> {
        if !self.is_thinned() {
            return of_table.to_vec();
        }
        let spread = |&(node, value): &(usize, f64)| {
            let Terms { nodes, coefficients, .. } = self.terms_at_node(node);
            nodes.into_iter().zip(coefficients.map(|weight| weight * value))
        };
        of_table.iter().flat_map(spread).collect()
    }
}

/// The corrections that act at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms {
    pub(super) nodes: [usize; 4],
    /// Their factors in the correction there; they sum to 1.
    pub(super) coefficients: [f64; 4],
    /// Bilinear weights.
    pub(super) bilinear: [f64; 4],
}

impl Terms {
    /// The correction there.
    pub(super) fn sum(&self, correction: impl Fn(usize) -> f64) -> f64 {
        self.nodes.iter().zip(&self.coefficients).map(|(&node, c)| c * correction(node)).sum()
    }

    /// Its variance.
    pub(super) fn variance(&self, covariance: impl Fn(usize, usize) -> f64) -> f64 {
        let mut variance = 0.0;
        for (&node, own) in self.nodes.iter().zip(&self.coefficients) {
            for (&other, by) in self.nodes.iter().zip(&self.coefficients) {
                variance += own * by * covariance(node, other);
            }
        }
        variance
    }
}

fn at(grid: &Grid, x: f64, y: f64) -> Terms {
    // The grid spans the table's: held is only what rounding puts beyond its edge.
    match grid.locate(x, y, Outside::Hold) {
        Ok(cell) => {
            let weights = cell.weights();
            Terms { nodes: cell.nodes(), coefficients: weights, bilinear: weights }
        }
        Err(_) => Terms { nodes: [0; 4], coefficients: [0.0; 4], bilinear: [0.0; 4] },
    }
}

/// [`MOST_BREAKPOINTS`] of the breakpoints, as evenly by their places as whole numbers allow, the first and the last among them;
/// `None` where all may stay.
fn thinned(axis: &Axis) -> Option<Axis> {
    let points = axis.breakpoints();
    if points.len() <= MOST_BREAKPOINTS {
        return None;
    }
    let (last, most) = (points.len() - 1, MOST_BREAKPOINTS - 1);
    Axis::new((0..=most).map(|k| points[(k * last + most / 2) / most]).collect()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(x: usize, y: usize) -> Arc<Grid> {
        let axis = |count: usize| Axis::new((0..count).map(|k| k as f64).collect()).unwrap();
        Arc::new(Grid::new(axis(x), axis(y)))
    }

    #[test]
    fn a_usual_table_is_corrected_at_its_own_nodes() {
        let support = Support::new(&grid(40, 7));
        assert!(!support.is_thinned());
        assert_eq!(support.at_table(vec![2.0; 280]), vec![2.0; 280]);
        assert_eq!(support.combination(&[(3, 0.5)]), vec![(3, 0.5)]);
    }

    /// A correction that is bilinear stays what it is: x + 2y at every node of the table.
    #[test]
    fn a_fine_table_has_fewer_corrections_from_edge_to_edge() {
        let table = grid(301, 41);
        let support = Support::new(&table);
        let fewer = support.grid();
        assert_eq!((fewer.x().len(), fewer.y().len()), (40, 40));
        assert_eq!((fewer.x().first(), fewer.x().last()), (0.0, 300.0));
        assert_eq!((fewer.y().first(), fewer.y().last()), (0.0, 40.0));
        let value = |(x, y): (f64, f64)| x + 2.0 * y;
        let values = (0..fewer.nodes()).map(|node| value(fewer.coordinates(node))).collect();
        for (node, found) in support.at_table(values).into_iter().enumerate() {
            let expected = value(table.coordinates(node));
            assert!((found - expected).abs() < 1e-9 * (1.0 + expected), "{node}");
        }
    }

    /// Bilinear weights have their point as their mean: at points inside cells of the table, which are not cells of the
    /// corrections and neither 1 wide nor square, the coordinates come back.
    #[test]
    fn corrections_act_at_the_point_they_are_asked_for() {
        let axis = |count: usize, step: f64| {
            Axis::new((0..count).map(|k| step * k as f64).collect()).unwrap()
        };
        let table = Arc::new(Grid::new(axis(101, 0.5), axis(81, 0.25)));
        let support = Support::new(&table);
        let initial = Table::new(Arc::clone(&table), vec![1.0; table.nodes()]).unwrap();
        for (x, y) in [(0.1, 0.2), (7.6, 3.9), (12.3, 10.1), (49.9, 19.9)] {
            let cell = table.locate(x, y, Outside::Error).unwrap();
            let terms = support.terms(&initial, &cell);
            let fewer = support.grid();
            let found = (
                terms.sum(|node| fewer.coordinates(node).0),
                terms.sum(|node| fewer.coordinates(node).1),
            );
            assert!((found.0 - x).abs() < 1e-9 && (found.1 - y).abs() < 1e-9, "{found:?}");
        }
    }
}
