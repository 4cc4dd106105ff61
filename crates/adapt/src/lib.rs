//! Local adaptation of a drag table to observations, segment by segment.
//!
//! What it is not: it reads no reports, knows neither engine nor atmosphere, and never sees a whole fleet. An
//! [`Observation`](flight::Observation) carries all that a table can learn from a segment; carrying what was learnt
//! over to nodes that were never visited is another crate's task.
//!
//! The one design decision: a law is a value with its settings and no memory. The learnt [`State`](paper::State)
//! belongs to the caller, and the returned [`Update`](paper::Update) holds every number before and after, so that a
//! ledger, a log or an undo needs nothing else.
//!
//! Limits: order matters. Segments are learnt in order of time, flights in order of START; the law [`paper`] gives
//! another table for another order. See that module for its other limits.
//!
//! ```
//! use std::sync::Arc;
//! use adapt::paper::{PaperLaw, State, Update};
//! use flight::{Observation, ObservationVariance, Timestamp};
//! use lut::{Axis, Grid, Table};
//!
//! let grid = Arc::new(Grid::new(Axis::from_step(0.3, 0.5, 0.1)?, Axis::from_step(0.7, 0.9, 0.1)?));
//! let mut state = State::new(Table::new(grid, vec![0.030; 9])?);
//! let observation = Observation {
//!     time: Timestamp::UNIX_EPOCH,
//!     lift_coefficient: 0.42,
//!     mach: 0.78,
//!     drag_coefficient: 0.033,
//!     fuel_flow_total_kg_s: 0.33,
//!     fuel_flow_per_drag_coefficient_kg_s: 10.0,
//!     variance: ObservationVariance { segment: 1e-4, flight: 1e-4 },
//! };
//! // 100 · 10 · (0.033 − 0.030)/0.33 = 9.09 %: beyond the threshold.
//! let update = PaperLaw::ghazi_2020().adapt(&mut state, &observation);
//! assert!(matches!(update, Update::Adapted { error_percent, .. } if (error_percent - 9.0909).abs() < 1e-4));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bayes;
pub mod paper;
