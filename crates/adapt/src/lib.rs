//! Adaptation of a drag table to observations, by one of two laws.
//!
//! Law [`bayes`], the default, holds a smooth correction of the whole table with its uncertainty: every node learns from every
//! flight, those that were never visited too, and knows how little that is. Law [`paper`] is the published local adaptation: a
//! segment whose error exceeds a threshold moves the four nodes around it.
//!
//! What it is not: it reads no reports, knows neither engine nor atmosphere, and never sees a whole fleet. An
//! [`Observation`](flight::Observation) carries all that a table can learn from a segment. Carrying what law `paper` learnt over to
//! nodes that were never visited is another crate's task, the global refit.
//!
//! The one design decision: a law is settings, and what is learnt belongs to the caller, as a value:
//! [`BayesState`](bayes::BayesState), sums of information that two states can be merged by, or [`State`](paper::State), two tables.
//! Every step returns what it did ([`FlightUpdate`](bayes::FlightUpdate), [`Update`](paper::Update): of law `paper` every number
//! before and after), for a ledger or a log.
//!
//! Limits: for both laws drag is a function of lift coefficient and Mach number, and anything else is an error of the flight. Of
//! law `bayes` only the weights of outliers and ageing depend on the order of flights; law `paper` gives another table for another
//! order, so that segments are learnt in order of time, flights in order of START. Each module states its other limits.
//!
//! Law `bayes`, of a flight of five segments with 5 % more drag than the table has:
//!
//! ```
//! use std::sync::Arc;
//! use adapt::bayes::{BayesSettings, BayesState};
//! use flight::{Observation, ObservationVariance, Timestamp};
//! use lut::{Axis, Grid, Outside, Table};
//!
//! let grid = Arc::new(Grid::new(Axis::from_step(0.2, 0.6, 0.05)?, Axis::from_step(0.7, 0.9, 0.05)?));
//! let initial = Table::new(Arc::clone(&grid), vec![0.030; grid.nodes()])?;
//! let mut state = BayesState::new(&initial, BayesSettings::physical_2026())?;
//! let observation = Observation {
//!     time: Timestamp::UNIX_EPOCH,
//!     lift_coefficient: 0.42,
//!     mach: 0.78,
//!     drag_coefficient: 0.0315,
//!     fuel_flow_total_kg_s: 0.33,
//!     fuel_flow_per_drag_coefficient_kg_s: 10.0,
//!     variance: ObservationVariance { segment: 2.5e-5, flight: 2e-5 },
//! };
//! state.learn_flight(&[observation; 5]);
//! let posterior = state.solve()?;
//! // Nearly all of the 5 % where it flew, and less with more uncertainty at a node that it never came near.
//! let flown = grid.locate(0.42, 0.78, Outside::Error)?;
//! let far = grid.locate(0.2, 0.9, Outside::Error)?;
//! let more = |cell| posterior.drag().interpolate(cell) / 0.030 - 1.0;
//! assert!((0.045..0.05).contains(&more(&flown)) && more(&far) < more(&flown));
//! assert!(posterior.relative_variance(&far) > posterior.relative_variance(&flown));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Law `paper`, of one segment with 10 % more:
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
