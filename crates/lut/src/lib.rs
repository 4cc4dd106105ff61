//! Checked axes, rectangular look-up tables with their cell weights and gradients, and six-coefficient polynomial
//! surfaces.
//!
//! What it is not: a general interpolation library. Tables have two axes and are bilinear, with one smooth surface through
//! their nodes ([`SmoothCell`]) for who needs slopes; there are no terms of aviation, no units and no policy about what
//! to do with a value.
//!
//! The one design decision: looking up has two steps. [`Grid::locate`] turns a point into a [`Cell`] (four nodes, four
//! weights, four distances), and a [`Table`] is read with the cell. Code that changes a table needs the cell anyway,
//! and tables that share a [`Grid`] are read with one search. Where there are very many points, [`Cells`] are some of them side
//! by side.
//!
//! Limits:
//! - A coordinate within [`SNAP`] of a breakpoint *is* that breakpoint; this rule is applied first. Axes whose
//!   breakpoints lie closer than twice that are refused.
//! - Outside the grid there is no value: the caller gets [`OutsideGrid`], or asks for [`Outside::Hold`] and finds
//!   [`Cell::held`] set. Nothing is extrapolated.
//! - [`Table::values_mut`] lends plain numbers: the borrower must keep them finite.
//!
//! ```
//! use std::sync::Arc;
//! use lut::{Axis, Grid, Outside, Table};
//!
//! let grid = Arc::new(Grid::new(Axis::from_step(0.1, 0.8, 0.05)?, Axis::new(vec![0.5, 0.6, 0.9])?));
//! let values = (0..grid.nodes()).map(|node| { let (x, y) = grid.coordinates(node); x + 2.0 * y }).collect();
//! let table = Table::new(Arc::clone(&grid), values)?;
//!
//! let cell = grid.locate(0.42, 0.75, Outside::Error)?;
//! assert!((table.interpolate(&cell) - 1.92).abs() < 1e-12);
//! assert!(grid.locate(0.42, 0.95, Outside::Error).is_err());
//! assert!(grid.locate(0.42, 0.95, Outside::Hold)?.held());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis;
mod cell;
mod cells;
mod grid;
mod smooth;
pub mod surface;
mod table;

pub use axis::{Axis, AxisError, SNAP};
pub use cell::Cell;
pub use cells::Cells;
pub use grid::{Grid, Outside, OutsideGrid};
pub use smooth::{SmoothCell, SmoothTable};
pub use table::{Table, TableError};
