//! A segment reduced to a point of the drag table.

use flight::{Observation, Segment, Timestamp};
use units::{OutOfDomain, PressureAltitude};

use super::{OutsideTable, PerformanceModel};
use crate::variance::{self, TableSlopes};

/// Why a segment does not give an observation.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObserveError {
    /// A mean outside its domain.
    #[error(transparent)]
    OutOfDomain(#[from] OutOfDomain),
    /// The segment's lift coefficient and Mach number lie outside the table.
    #[error(transparent)]
    OutsideTable(#[from] OutsideTable),
    /// Recorded thrust and acceleration leave no drag.
    #[error(
        "drag {drag_n:.0} N is not positive: fuel flow corresponds to {net_thrust_n:.0} N of thrust, acceleration takes {inertia_n:.0} N"
    )]
    DragNotPositive {
        /// What is left for drag, N.
        drag_n: f64,
        /// Net thrust that corresponds to the recorded fuel flow, N.
        net_thrust_n: f64,
        /// Mass times recorded acceleration, N.
        inertia_n: f64,
    },
    /// The segment's instant is outside the range of timestamps.
    #[error("{time_s} s after START is not a valid instant")]
    NoInstant {
        /// Time since START, s.
        time_s: f64,
    },
}

impl PerformanceModel {
    /// The observation of a segment: lift coefficient, Mach number, observed drag coefficient (without a factor
    /// [by level](Self::levels)) and its variance.
    ///
    /// The variance includes the effect that an error of Mach number, mass or pressure moves the point along *this
    /// model's* table; see [`variance`].
    ///
    /// # Errors
    /// [`ObserveError`] where a mean is outside its domain, the point is outside the table, or thrust and acceleration
    /// leave no drag.
    ///
    /// # Source
    /// Book `[forces.6]`, `[forces.11]`, `[forces.14]`, `[uncertainty.1]`; Ghazi et al. 2020, equations (20)–(22).
    pub fn observe(&self, segment: &Segment) -> Result<Observation, ObserveError> {
        let means = &segment.means;
        let state = self.state_of(segment)?;
        let cell = self.locate(state.lift_coefficient, means.mach)?;
        let drag_n = state.drag().to_newtons();
        // Written so that NaN is refused too.
        if drag_n.is_nan() || drag_n <= 0.0 {
            let net_thrust_n = state.net_thrust.to_newtons();
            let inertia_n = net_thrust_n - drag_n;
            return Err(ObserveError::DragNotPositive { drag_n, net_thrust_n, inertia_n });
        }
        let slopes = TableSlopes::at(self.drag_table(), &cell, state.lift_coefficient);
        let observed = Observation {
            time: instant(segment)?,
            lift_coefficient: state.lift_coefficient,
            mach: means.mach,
            drag_coefficient: state.drag_coefficient,
            fuel_flow_total_kg_s: means.fuel_flow_total_kg_s,
            fuel_flow_per_drag_coefficient_kg_s:
                crate::fuel_flow::fuel_flow_per_drag_coefficient_kg_s(&state.conditions),
            variance: variance::observation_variance(self.aircraft(), segment, &state, slopes)?,
        };
        Ok(self.without_level(&observed, PressureAltitude::meters(means.pressure_altitude_m)))
    }
}

/// The segment's mean instant.
fn instant(segment: &Segment) -> Result<Timestamp, ObserveError> {
    let time_s = segment.means.time_s;
    let no_instant = ObserveError::NoInstant { time_s };
    if !time_s.is_finite() {
        return Err(no_instant);
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the cast saturates, and an instant that far away is not a timestamp"
    )]
    let nanoseconds = (time_s * 1e9).round() as i128;
    let start = segment.identity.start.as_nanosecond();
    Timestamp::from_nanosecond(start.saturating_add(nanoseconds)).map_err(|_| no_instant)
}
