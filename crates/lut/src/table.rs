//! Values at the nodes of a grid.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::{Cell, Cells, Grid};

/// Values at the nodes of a grid, bilinear between them.
///
/// Cells must come from the table's own grid (or an equal one): using a cell of another grid is a programming error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Parts", into = "Parts")]
pub struct Table {
    grid: Arc<Grid>,
    values: Vec<f64>,
}

/// Why values do not make a table.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// The number of values differs from the number of nodes.
    #[error("{values} values for {nodes} nodes")]
    Length {
        /// How many values were given.
        values: usize,
        /// How many nodes the grid has.
        nodes: usize,
    },
    /// A value is not finite.
    #[error("value of node {node} is {value}, not a finite number")]
    NotFinite {
        /// The node.
        node: usize,
        /// The value given.
        value: f64,
    },
}

impl Table {
    /// A table of these values, one per node, x outer and y inner.
    ///
    /// # Errors
    /// [`TableError`] where the number of values is not the grid's, or a value is not finite.
    pub fn new(grid: Arc<Grid>, values: Vec<f64>) -> Result<Self, TableError> {
        if values.len() != grid.nodes() {
            return Err(TableError::Length { values: values.len(), nodes: grid.nodes() });
        }
        if let Some((node, &value)) =
            values.iter().enumerate().find(|(_, value)| !value.is_finite())
        {
            return Err(TableError::NotFinite { node, value });
        }
        Ok(Self { grid, values })
    }

    /// The grid, shared.
    #[must_use]
    pub const fn grid(&self) -> &Arc<Grid> {
        &self.grid
    }

    /// The value at a node.
    ///
    /// # Panics
    /// Where `node` is not a node of the grid.
    #[must_use]
    pub fn value_at_node(&self, node: usize) -> f64 {
        self.values[node]
    }

    /// All values, in node order.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// All values, for changes. Keep them finite: reading does not check again.
    #[must_use]
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// The bilinear value at a located point; at a node exactly the node's value.
    ///
    /// # Panics
    /// Where the cell is of a larger grid.
    ///
    /// # Source
    /// Book `[tables.2]`, `[tables.3]`; Ghazi et al. 2020, equations (9)–(11).
    #[must_use]
    #[inline]
    pub fn interpolate(&self, cell: &Cell) -> f64 {
        let [a, b, c, d] = self.corners(cell);
        let [wa, wb, wc, wd] = cell.weights();
        wa * a + wb * b + wc * c + wd * d
    }

    /// The bilinear values at several located points, to the same bits.
    ///
    /// # Panics
    /// Where the cells are of a larger grid.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[must_use]
    #[inline(always)]
    pub fn interpolate_all<const N: usize>(&self, cells: &Cells<N>) -> [f64; N] {
        bilinear(&self.corners_of_all(cells), cells)
    }

    /// As [`corners`](Self::corners) of all cells.
    #[expect(clippy::inline_always, reason = "as above")]
    #[expect(clippy::needless_range_loop, reason = "loops over several points count")]
    #[inline(always)]
    fn corners_of_all<const N: usize>(&self, cells: &Cells<N>) -> [[f64; N]; 4] {
        let mut corners = [[0.0; N]; 4];
        for place in 0..N {
            let nodes = cells.nodes(place);
            for k in 0..4 {
                corners[k][place] = self.values[nodes[k]];
            }
        }
        corners
    }

    /// The bilinear values at several located points, as [`interpolate_all`](Self::interpolate_all) has them, and their slopes along x,
    /// on a grid line those of the cell that a point belongs to.
    ///
    /// # Panics
    /// Where the cells are of a larger grid.
    ///
    /// # Source
    /// Book `[tables.5]`.
    #[expect(clippy::inline_always, reason = "as above")]
    #[expect(clippy::needless_range_loop, reason = "as above")]
    #[must_use]
    #[inline(always)]
    pub fn values_and_slopes_along_x<const N: usize>(
        &self,
        cells: &Cells<N>,
    ) -> ([f64; N], [f64; N]) {
        let corners = self.corners_of_all(cells);
        let values = bilinear(&corners, cells);
        let mut per_width = [0.0; N];
        for place in 0..N {
            per_width[place] = 1.0 / self.grid.x().width(cells.indices(place).0);
        }
        let (_, v) = cells.shares();
        let mut slopes = [0.0; N];
        for place in 0..N {
            let low_y = corners[2][place] - corners[0][place];
            let high_y = corners[3][place] - corners[1][place];
            slopes[place] = (low_y + v[place] * (high_y - low_y)) * per_width[place];
        }
        (values, slopes)
    }

    /// Slopes along x and y of the bilinear surface at a located point.
    ///
    /// On a grid line it is the slope of the cell that the point belongs to. Where the point is held at an edge, the
    /// value does not change further out, and the slope across that edge is 0.
    ///
    /// # Panics
    /// Where the cell is of a larger grid.
    ///
    /// # Source
    /// Book `[tables.5]`: the derivative of the bilinear form.
    #[must_use]
    #[inline]
    pub fn gradient(&self, cell: &Cell) -> (f64, f64) {
        let [a, b, c, d] = self.corners(cell);
        let (u, v) = cell.local();
        let (width_x, width_y) = cell.widths();
        let (held_x, held_y) = cell.held_along();
        let along_x = ((1.0 - v) * (c - a) + v * (d - b)) / width_x;
        let along_y = ((1.0 - u) * (b - a) + u * (d - c)) / width_y;
        (if held_x { 0.0 } else { along_x }, if held_y { 0.0 } else { along_y })
    }

    #[inline]
    fn corners(&self, cell: &Cell) -> [f64; 4] {
        let [a, b, c, d] = cell.nodes();
        [self.values[a], self.values[b], self.values[c], self.values[d]]
    }
}

/// A table in the form of a file: the grid in full. Tables that share a grid should be written by their owner, with the
/// grid once.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Table", deny_unknown_fields)]
struct Parts {
    grid: Grid,
    values: Vec<f64>,
}

impl TryFrom<Parts> for Table {
    type Error = TableError;
    fn try_from(parts: Parts) -> Result<Self, TableError> {
        Self::new(Arc::new(parts.grid), parts.values)
    }
}

impl From<Table> for Parts {
    fn from(table: Table) -> Self {
        Self { grid: Arc::unwrap_or_clone(table.grid), values: table.values }
    }
}

/// Values between the corners of cells.
#[expect(clippy::inline_always, reason = "compiled for the vectors of the caller")]
#[inline(always)]
fn bilinear<const N: usize>(corners: &[[f64; N]; 4], cells: &Cells<N>) -> [f64; N] {
    let (u, v) = cells.shares();
    let mut values = [0.0; N];
    for place in 0..N {
        let [wa, wb, wc, wd] = Cell::weights_of(u[place], v[place]);
        values[place] = wa * corners[0][place]
            + wb * corners[1][place]
            + wc * corners[2][place]
            + wd * corners[3][place];
    }
    values
}
