//! A point in its cell: the position that reading and changing a table need.

use crate::axis::Position;

/// The cell that holds a point, and the point's position in it. Made by [`Grid::locate`](crate::Grid::locate).
///
/// The four nodes are always in the order (low x, low y), (low x, high y), (high x, low y), (high x, high y).
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    x: Position,
    y: Position,
    y_count: usize,
}

impl Cell {
    #[inline]
    pub(crate) const fn new(x: Position, y: Position, y_count: usize) -> Self {
        Self { x, y, y_count }
    }

    /// Indices of the four nodes.
    #[must_use]
    #[inline]
    pub const fn nodes(&self) -> [usize; 4] {
        let low = self.x.index * self.y_count + self.y.index;
        let high = low + self.y_count;
        [low, low + 1, high, high + 1]
    }

    /// Index of the breakpoint at the cell's low end along x and along y.
    #[must_use]
    #[inline]
    pub const fn indices(&self) -> (usize, usize) {
        (self.x.index, self.y.index)
    }

    /// Bilinear weights of the four nodes; they are not negative and sum to 1.
    ///
    /// A point on a node has exactly the weights 1, 0, 0, 0; a point on a grid line has two weights of exactly 0.
    ///
    /// # Source
    /// Book `[tables.3]`; Ghazi et al. 2020, equations (9)–(11).
    #[must_use]
    #[inline]
    pub fn weights(&self) -> [f64; 4] {
        let (u, v) = self.local();
        Self::weights_of(u, v)
    }

    /// The weights at shares of a cell's widths.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    pub(crate) fn weights_of(u: f64, v: f64) -> [f64; 4] {
        let (left, below) = (1.0 - u, 1.0 - v);
        [left * below, left * v, u * below, u * v]
    }

    /// Distance from the point to each of the four nodes, divided by the cell's diagonal: 0 at a node, 1 at the
    /// corner opposite to it. x and y are taken as they are, without scaling.
    ///
    /// # Source
    /// Book `[tables.4]`; Ghazi et al. 2020, equations (25), (26).
    #[must_use]
    #[inline]
    pub fn normalized_distances(&self) -> [f64; 4] {
        // One formula for distances and diagonal: the opposite corner has exactly 1.
        let length = |x: f64, y: f64| (x * x + y * y).sqrt();
        let diagonal = length(self.x.width, self.y.width);
        [
            length(self.x.above_low, self.y.above_low) / diagonal,
            length(self.x.above_low, self.y.below_high) / diagonal,
            length(self.x.below_high, self.y.above_low) / diagonal,
            length(self.x.below_high, self.y.below_high) / diagonal,
        ]
    }

    /// Whether the point was outside the grid and was moved to the nearest edge.
    #[must_use]
    #[inline]
    pub const fn held(&self) -> bool {
        self.x.held || self.y.held
    }

    /// Position in the cell: `(u, v)`, each 0 at the low and 1 at the high end.
    #[must_use]
    #[inline]
    pub fn local(&self) -> (f64, f64) {
        (self.x.above_low / self.x.width, self.y.above_low / self.y.width)
    }

    /// Widths of the cell along x and y.
    #[must_use]
    #[inline]
    pub const fn widths(&self) -> (f64, f64) {
        (self.x.width, self.y.width)
    }

    pub(crate) const fn held_along(&self) -> (bool, bool) {
        (self.x.held, self.y.held)
    }
}
