//! Two axes, and the search for the cell of a point.

use serde::{Deserialize, Serialize};

use crate::{Axis, Cell};

/// A rectangular grid. Node `ix·ny + iy`: x is the outer, y the inner index.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    x: Axis,
    y: Axis,
}

/// What to do with a point outside the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outside {
    /// Refuse it.
    Error,
    /// Take the nearest edge instead and report it in [`Cell::held`]. A coordinate that is not finite is still refused.
    Hold,
}

/// A point outside a grid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("point ({x}, {y}) outside the grid {x_first} to {x_last} by {y_first} to {y_last}")]
#[non_exhaustive]
pub struct OutsideGrid {
    /// The point's x.
    pub x: f64,
    /// The point's y.
    pub y: f64,
    /// First breakpoint of the x axis.
    pub x_first: f64,
    /// Last breakpoint of the x axis.
    pub x_last: f64,
    /// First breakpoint of the y axis.
    pub y_first: f64,
    /// Last breakpoint of the y axis.
    pub y_last: f64,
}

impl Grid {
    /// The grid of two axes.
    #[must_use]
    pub const fn new(x: Axis, y: Axis) -> Self {
        Self { x, y }
    }

    /// The outer axis.
    #[must_use]
    pub const fn x(&self) -> &Axis {
        &self.x
    }

    /// The inner axis.
    #[must_use]
    pub const fn y(&self) -> &Axis {
        &self.y
    }

    /// Number of nodes.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.x.len() * self.y.len()
    }

    /// Coordinates of a node.
    ///
    /// # Panics
    /// Where `node` is not below [`nodes`](Self::nodes).
    #[must_use]
    pub fn coordinates(&self, node: usize) -> (f64, f64) {
        let count = self.y.len();
        (self.x.breakpoints()[node / count], self.y.breakpoints()[node % count])
    }

    /// The cell that holds a point.
    ///
    /// Cells are half-open, `[x_i, x_{i+1})`; the last node of an axis belongs to its last cell. A coordinate within
    /// [`SNAP`](crate::SNAP) of a breakpoint is that breakpoint; this rule is applied first.
    ///
    /// # Errors
    /// [`OutsideGrid`] where the point is outside and `outside` is [`Outside::Error`], or is not finite.
    #[expect(
        clippy::inline_always,
        reason = "a cell through memory costs more than the search: measured"
    )]
    #[inline(always)]
    pub fn locate(&self, x: f64, y: f64, outside: Outside) -> Result<Cell, OutsideGrid> {
        if self.x.spans(x) && self.y.spans(y) {
            let (along_x, along_y) = (self.x.position_unsnapped(x), self.y.position_unsnapped(y));
            if along_x.is_off_breakpoints() && along_y.is_off_breakpoints() {
                return Ok(Cell::new(along_x, along_y, self.y.len()));
            }
        }
        self.locate_with_care(x, y, outside)
    }

    /// On a breakpoint, at an edge or outside.
    #[cold]
    fn locate_with_care(&self, x: f64, y: f64, outside: Outside) -> Result<Cell, OutsideGrid> {
        let hold = outside == Outside::Hold;
        match (self.x.position(x, hold), self.y.position(y, hold)) {
            (Some(along_x), Some(along_y)) => Ok(Cell::new(along_x, along_y, self.y.len())),
            _ => Err(self.refuse(x, y)),
        }
    }

    fn refuse(&self, x: f64, y: f64) -> OutsideGrid {
        OutsideGrid {
            x,
            y,
            x_first: self.x.first(),
            x_last: self.x.last(),
            y_first: self.y.first(),
            y_last: self.y.last(),
        }
    }
}
