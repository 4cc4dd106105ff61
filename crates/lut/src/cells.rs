//! Cells of several points of one grid: one array for each quantity, so that what is read of a table at all of them is computed
//! several points in one instruction.

#![expect(
    clippy::inline_always,
    reason = "compiled for the vectors of the caller, which a call of its own would not be"
)]
use crate::{Cell, Grid, Outside};

/// The cells that hold `N` points of one grid, and the points' positions in them. Filled by [`locate`](Self::locate).
///
/// A place without a point in the grid has a cell all the same, so that all places are computed alike: what is read there has no
/// meaning. [`is_inside`](Self::is_inside) tells.
#[derive(Clone, Debug)]
pub struct Cells<const N: usize> {
    /// Indices of the breakpoints at the cells' low ends, and nodes along y.
    rows: [usize; N],
    columns: [usize; N],
    y_count: usize,
    shares: ([f64; N], [f64; N]),
    is_inside: [bool; N],
}

impl<const N: usize> Default for Cells<N> {
    fn default() -> Self {
        Self {
            rows: [0; N],
            columns: [0; N],
            y_count: 2,
            shares: ([0.0; N], [0.0; N]),
            is_inside: [false; N],
        }
    }
}

impl<const N: usize> Cells<N> {
    /// Finds the cells of points, each as [`Grid::locate`] with [`Outside::Error`] does.
    #[inline(always)]
    pub fn locate(&mut self, grid: &Grid, x: &[f64; N], y: &[f64; N]) {
        self.y_count = grid.y().len();
        let mut is_off = [true; N];
        grid.x().place_all(x, &mut self.rows, &mut self.shares.0, &mut is_off);
        grid.y().place_all(y, &mut self.columns, &mut self.shares.1, &mut is_off);
        self.is_inside = is_off;
        for place in 0..N {
            if !is_off[place] {
                self.at_an_edge(grid, place, (x[place], y[place]));
            }
        }
    }

    /// On a breakpoint, at an edge or outside.
    #[cold]
    fn at_an_edge(&mut self, grid: &Grid, place: usize, (x, y): (f64, f64)) {
        let found = grid.locate(x, y, Outside::Error);
        self.is_inside[place] = found.is_ok();
        let (indices, local) =
            found.map_or(((0, 0), (0.0, 0.0)), |cell| (cell.indices(), cell.local()));
        (self.rows[place], self.columns[place]) = indices;
        (self.shares.0[place], self.shares.1[place]) = local;
    }

    /// Whether there is a point of the grid at a place.
    ///
    /// # Panics
    /// Where `place` is not below `N`.
    #[must_use]
    #[inline(always)]
    pub const fn is_inside(&self, place: usize) -> bool {
        self.is_inside[place]
    }

    /// As [`Cell::nodes`] of one of the cells.
    ///
    /// # Panics
    /// Where `place` is not below `N`.
    #[must_use]
    #[inline(always)]
    pub const fn nodes(&self, place: usize) -> [usize; 4] {
        let low = self.rows[place] * self.y_count + self.columns[place];
        let high = low + self.y_count;
        [low, low + 1, high, high + 1]
    }

    /// As [`Cell::weights`] of one of the cells.
    ///
    /// # Panics
    /// Where `place` is not below `N`.
    #[must_use]
    #[inline(always)]
    pub fn weights(&self, place: usize) -> [f64; 4] {
        Cell::weights_of(self.shares.0[place], self.shares.1[place])
    }

    /// As [`Cell::indices`] of one of the cells.
    #[inline(always)]
    pub(crate) const fn indices(&self, place: usize) -> (usize, usize) {
        (self.rows[place], self.columns[place])
    }

    /// As [`Cell::local`] of all cells.
    #[inline(always)]
    pub(crate) const fn shares(&self) -> (&[f64; N], &[f64; N]) {
        (&self.shares.0, &self.shares.1)
    }
}

#[cfg(test)]
mod tests;
