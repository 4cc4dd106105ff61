//! The smooth surface of one table, prepared for very many values.

use crate::{Axis, Cell, Table};

use super::end_slopes;

/// Nodes along an axis that take part in a value.
const NODES: usize = 4;

/// The surface of [`SmoothCell`](super::SmoothCell) through the nodes of one table, prepared: the weights of an axis are
/// polynomials that each of its cells keeps, and the nodes about a cell lie beside one another. A value costs a fifth, and is
/// the same within rounding.
#[derive(Clone, Debug)]
pub struct SmoothTable {
    along_x: Vec<Weights>,
    along_y: Vec<Weights>,
    /// Values at the nodes with a border of zeros, x outer and y inner.
    values: Vec<f64>,
    /// Values of a row of them.
    width: usize,
}

/// Of the four breakpoints about a cell of an axis: coefficients of the powers of the share of the cell's width, from the lowest.
type Weights = [[f64; NODES]; NODES];

impl SmoothTable {
    /// Of a table.
    #[must_use]
    pub fn new(table: &Table) -> Self {
        let grid = table.grid();
        let (rows, columns) = (grid.x().len(), grid.y().len());
        let width = columns + 2;
        let mut values = vec![0.0; (rows + 2) * width];
        for (row, of_row) in table.values().chunks_exact(columns).enumerate() {
            let start = (row + 1) * width + 1;
            values[start..start + columns].copy_from_slice(of_row);
        }
        Self { along_x: weights(grid.x()), along_y: weights(grid.y()), values, width }
    }

    /// The value at a located point.
    ///
    /// # Panics
    /// Where the cell is of a larger grid.
    #[must_use]
    #[inline]
    pub fn value(&self, cell: &Cell) -> f64 {
        let (row, column) = cell.indices();
        let (u, v) = cell.local();
        let (along_x, along_y) = (at(&self.along_x[row], u), at(&self.along_y[column], v));
        // The border shifts both by one: the first of the four breakpoints is the one below the cell.
        let corner = row * self.width + column;
        let mut value = 0.0;
        for (k, weight) in along_x.iter().enumerate() {
            let start = corner + k * self.width;
            let [a, b, c, d] = along_y;
            if let [p, q, r, s] = self.values[start..start + NODES] {
                value += weight * ((a * p + b * q) + (c * r + d * s));
            }
        }
        value
    }
}

/// The weights of the four breakpoints at a share of the cell's width.
#[inline]
fn at(weights: &Weights, share: f64) -> [f64; NODES] {
    weights.map(|[a, b, c, d]| a + share * (b + share * (c + share * d)))
}

/// The weights of each cell of an axis; 0 for breakpoints that do not exist.
fn weights(axis: &Axis) -> Vec<Weights> {
    let points = axis.breakpoints();
    let of_cell = |cell: usize| {
        let width = points[cell + 1] - points[cell];
        // Hermite's cubics for the values and the slopes at both ends.
        let mut found = [[0.0; NODES]; NODES];
        found[1] = [1.0, 0.0, -3.0, 2.0];
        found[2] = [0.0, 0.0, 3.0, -2.0];
        let cubics = [[0.0, 1.0, -2.0, 1.0], [0.0, 0.0, -1.0, 1.0]];
        for (of_end, cubic) in end_slopes(points, cell).iter().zip(cubics) {
            for (found, weight) in found.iter_mut().zip(of_end) {
                for (into, coefficient) in found.iter_mut().zip(cubic) {
                    *into += weight * width * coefficient;
                }
            }
        }
        found
    };
    (0..points.len() - 1).map(of_cell).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::{Grid, Outside, SmoothCell};

    use super::*;

    /// The oracle is the surface asked point by point, on axes of two, three and more uneven breakpoints.
    #[test]
    fn prepared_it_is_the_same_surface() {
        let axes = [vec![0.1, 0.6], vec![0.1, 0.3, 0.6], vec![0.1, 0.15, 0.3, 0.35, 0.6]];
        for x in &axes {
            for y in &axes {
                let axis = |points: &Vec<f64>| Axis::new(points.clone()).unwrap();
                let grid = Arc::new(Grid::new(axis(x), axis(y)));
                let value = |node| {
                    let (x, y) = grid.coordinates(node);
                    (5.0 * x).sin() + 2.0 * x * y + (7.0 * y).cos()
                };
                let values = (0..grid.nodes()).map(value).collect();
                let table = Table::new(Arc::clone(&grid), values).unwrap();
                let prepared = SmoothTable::new(&table);
                for step in 0..=2500 {
                    let x = 0.1 + 0.01 * f64::from(step % 51);
                    let y = 0.1 + 0.01 * f64::from(step / 51);
                    let known = SmoothCell::locate(&grid, x, y).unwrap().value_of(&table);
                    let cell = grid.locate(x, y, Outside::Error).unwrap();
                    let found = prepared.value(&cell);
                    assert!((found - known).abs() < 1e-14, "{x} {y}: {found}, {known}");
                }
            }
        }
    }
}
