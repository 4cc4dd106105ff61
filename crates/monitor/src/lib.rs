//! What changed, when and by how much: one aircraft's deviations from a reference over months and years, and a fleet's.
//!
//! What it is: [`Series`] holds a deviation per flight, [`History::fit`] reads it: the [`Noise`] of flights, the
//! [`Change`]s with probability and the interval of their dates, a trend and the [`Levels`] between the changes, the effect of
//! recorded events. [`months`] groups flights, [`fleet_mean`] tails, whose levels
//! [`to_common_conditions`] puts to common conditions, [`airbus`] has the terms in which operators report,
//! [`cost`] what a deviation costs, [`AlertRule`] what somebody should look at.
//! What it is not: it knows no model and no segment. Whoever has both computes the deviations, 100·ln(recorded/predicted) fuel
//! flow, and decides of what reference they speak.
//!
//! The one design decision: flights between two changes lie on a straight line, lines of different pieces are independent, and
//! the probability of every division into pieces is summed exactly. The penalty for a change is its
//! evidence, not a constant that was tuned; dates have intervals; a new night costs the same however long the history.
//!
//! Limits:
//! - A deviation that all flights share (a meter that always read 1 % high) is not seen, and not in any interval.
//! - Errors of successive flights may be correlated to first order; a level that wanders more slowly than that is a change.
//! - One trend serves all pieces of a tail. After an engine change with another deterioration it is a mean of both.
//!
//! ```
//! use monitor::{ChangeBeliefs, FlightDeviation, History, Series};
//!
//! // A flight a day, ± 0.3 %, and a wash on day 60 that brings 1 %.
//! let mut flights = Vec::new();
//! for day in 0..120_i64 {
//!     let level = if day < 60 { 1.4 } else { 0.4 };
//!     let noise = [0.3, -0.2, 0.1, -0.3, 0.2][(day * 7 % 5) as usize];
//!     let time = flight::Timestamp::from_second(86_400 * day)?;
//!     flights.extend(FlightDeviation::of_segments(time, &[level + noise + 0.1, level + noise - 0.1]));
//! }
//! let series = Series::new(flights)?;
//! let wash = flight::Timestamp::from_second(86_400 * 60)?;
//! let history = History::fit(&series, &[wash], &ChangeBeliefs::of_2026()).ok_or("no flight")?;
//! assert_eq!(history.changes.len(), 1);
//! assert_eq!(history.changes[0].event, Some(0));
//! let effect = history.events[0].effect_percent.ok_or("flights before and after")?;
//! assert!((effect.value + 1.0).abs() < effect.half_width95());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod airbus;
mod alert;
mod conditions;
pub mod cost;
mod filter;
mod fleet;
mod history;
mod levels;
mod months;
mod noise;
mod piece;
mod series;
pub mod settings;

pub use alert::{Alert, AlertRule, AlertRuleError};
pub use conditions::{FlownConditions, FlownFlight, to_common_conditions};
pub use fleet::{FleetMean, fleet_mean};
pub use history::{
    Bearing, Change, EventEffect, History, KnownSteps, StepInGap, weighted_mean_percent,
};
pub use levels::{Estimate, Levels, NORMAL_95};
pub use months::{Month, months};
pub use noise::Noise;
pub use series::{CONDITIONS, FlightDeviation, Series, SeriesError, years_between};
pub use settings::ChangeBeliefs;
