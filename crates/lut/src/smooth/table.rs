//! The smooth surface of one table, prepared for very many values.

use crate::{Axis, Cell, Cells, Table};

use super::end_slopes;

/// Nodes along an axis that take part in a value.
const NODES: usize = 4;

/// The surface of [`SmoothCell`](super::SmoothCell) through the nodes of one table, prepared: each cell keeps the coefficients of
/// its polynomial in the shares u and v of its widths. A value costs a tenth, and is the same within rounding.
///
/// ```text
/// value = Σ c_pq·u^p·v^q,  p and q from 0 to 3
/// ```
#[derive(Clone, Debug)]
pub struct SmoothTable {
    /// Coefficients of each cell, a row for each power of u; x outer and y inner.
    cells: Vec<Powers>,
    /// Cells along y.
    columns: usize,
    /// Inverse widths of the cells along x.
    per_width_x: Vec<f64>,
}

/// Of the four breakpoints about a cell of an axis: coefficients of the powers of the share of the cell's width, from the lowest.
type Weights = [[f64; NODES]; NODES];

/// Coefficients of products of powers.
type Powers = [[f64; NODES]; NODES];

impl SmoothTable {
    /// Of a table.
    #[must_use]
    pub fn new(table: &Table) -> Self {
        let grid = table.grid();
        let (rows, columns) = (grid.x().len(), grid.y().len());
        // A border of zeros about the values: the first of a cell's four breakpoints is the one below it.
        let width = columns + 2;
        let mut values = vec![0.0; (rows + 2) * width];
        for (row, of_row) in table.values().chunks_exact(columns).enumerate() {
            let start = (row + 1) * width + 1;
            values[start..start + columns].copy_from_slice(of_row);
        }
        let (along_x, along_y) = (weights(grid.x()), weights(grid.y()));
        let mut cells = Vec::with_capacity(along_x.len() * along_y.len());
        for (row, of_x) in along_x.iter().enumerate() {
            for (column, of_y) in along_y.iter().enumerate() {
                cells.push(powers((of_x, of_y), &values[row * width + column..], width));
            }
        }
        let per_width_x = (0..rows - 1).map(|row| 1.0 / grid.x().width(row)).collect();
        Self { cells, columns: columns - 1, per_width_x }
    }

    /// The value at a located point.
    ///
    /// # Panics
    /// Where the cell is of a larger grid.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[must_use]
    #[inline(always)]
    pub fn value(&self, cell: &Cell) -> f64 {
        let (u, v) = cell.local();
        let of_v = self.powers_of_v(cell.indices(), u);
        of_v[0] + v * (of_v[1] + v * (of_v[2] + v * of_v[3]))
    }

    /// The values at several located points, to the same bits.
    ///
    /// # Panics
    /// Where the cells are of a larger grid.
    #[expect(clippy::inline_always, reason = "as above")]
    #[must_use]
    #[inline(always)]
    pub fn values<const N: usize>(&self, cells: &Cells<N>) -> [f64; N] {
        let (u, v) = cells.shares();
        let mut powers = [[0.0; NODES]; N];
        for place in 0..N {
            powers[place] = self.powers_of_v(cells.indices(place), u[place]);
        }
        let mut values = [0.0; N];
        for place in 0..N {
            let (of_v, v) = (powers[place], v[place]);
            values[place] = of_v[0] + v * (of_v[1] + v * (of_v[2] + v * of_v[3]));
        }
        values
    }

    /// The same with their slopes along x.
    ///
    /// # Panics
    /// Where the cells are of a larger grid.
    #[expect(clippy::inline_always, reason = "as above")]
    #[must_use]
    #[inline(always)]
    pub fn values_and_slopes_along_x<const N: usize>(
        &self,
        cells: &Cells<N>,
    ) -> ([f64; N], [f64; N]) {
        let (u, v) = cells.shares();
        let mut powers = [[[0.0; NODES]; 2]; N];
        let mut per_width = [0.0; N];
        for place in 0..N {
            let indices = cells.indices(place);
            powers[place] = self.powers_of_v_and_slopes(indices, u[place]);
            per_width[place] = self.per_width_x[indices.0];
        }
        let (mut values, mut slopes) = ([0.0; N], [0.0; N]);
        for place in 0..N {
            let ([value, slope], v) = (powers[place], v[place]);
            values[place] = value[0] + v * (value[1] + v * (value[2] + v * value[3]));
            let of_share = slope[0] + v * (slope[1] + v * (slope[2] + v * slope[3]));
            slopes[place] = of_share * per_width[place];
        }
        (values, slopes)
    }

    /// Coefficients of the powers of v in a cell.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn powers_of_v(&self, (row, column): (usize, usize), u: f64) -> [f64; NODES] {
        let [constant, linear, square, cubic] = &self.cells[row * self.columns + column];
        let mut of_v = *cubic;
        for power in [square, linear, constant] {
            for k in 0..NODES {
                of_v[k] = of_v[k] * u + power[k];
            }
        }
        of_v
    }

    /// The same, and those of their slopes along u.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn powers_of_v_and_slopes(&self, (row, column): (usize, usize), u: f64) -> [[f64; NODES]; 2] {
        let [constant, linear, square, cubic] = &self.cells[row * self.columns + column];
        let (mut of_v, mut slope) = (*cubic, [0.0; NODES]);
        for power in [square, linear, constant] {
            for k in 0..NODES {
                slope[k] = slope[k] * u + of_v[k];
                of_v[k] = of_v[k] * u + power[k];
            }
        }
        [of_v, slope]
    }
}

/// The polynomial of a cell whose first node has the first of these values.
fn powers((of_x, of_y): (&Weights, &Weights), values: &[f64], width: usize) -> Powers {
    let mut found = [[0.0; NODES]; NODES];
    for (k, of_row) in of_x.iter().enumerate() {
        let mut of_v = [0.0; NODES];
        for (value, weights) in values[k * width..].iter().zip(of_y) {
            for (sum, weight) in of_v.iter_mut().zip(weights) {
                *sum += value * weight;
            }
        }
        for (into, weight) in found.iter_mut().zip(of_row) {
            for (into, of_v) in into.iter_mut().zip(of_v) {
                *into += weight * of_v;
            }
        }
    }
    found
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
                let mut cells = Cells::<1>::default();
                for step in 0..=2500 {
                    let x = 0.1 + 0.01 * f64::from(step % 51);
                    let y = 0.1 + 0.01 * f64::from(step / 51);
                    let known = SmoothCell::locate(&grid, x, y).unwrap().value_of(&table);
                    let cell = grid.locate(x, y, Outside::Error).unwrap();
                    let found = prepared.value(&cell);
                    assert!((found - known).abs() < 1e-14, "{x} {y}: {found}, {known}");
                    // Its slope inside a cell, by the difference over a step that stays there.
                    let (x, y) = (x + 0.005, y + 0.005);
                    let at = |x| Some(SmoothCell::locate(&grid, x, y).ok()?.value_of(&table));
                    let (Some(up), Some(down)) = (at(x + 1e-6), at(x - 1e-6)) else { continue };
                    cells.locate(&grid, &[x], &[y]);
                    let (values, slopes) = prepared.values_and_slopes_along_x(&cells);
                    assert_eq!(values[0].to_bits(), prepared.values(&cells)[0].to_bits());
                    let slope = (up - down) / 2e-6;
                    assert!((slopes[0] - slope).abs() < 1e-7, "{x} {y}: {slopes:?}, {slope}");
                }
            }
        }
    }
}
