//! The drag information in a segment.

use jiff::Timestamp;

/// Variances of an observed drag coefficient, relative to it (a standard deviation of 1 % is a variance of 1e-4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObservationVariance {
    /// Of this segment alone: fuel flow, Mach number, temperature, acceleration.
    pub segment: f64,
    /// Common to all segments of one flight: fuel heating value, loading.
    pub flight: f64,
}

/// A segment reduced to a point (lift coefficient, Mach number) with its observed drag coefficient.
///
/// Fuel flow is linear in the drag coefficient, so that the error ε of any table is `100 ·
/// fuel_flow_per_drag_coefficient · (drag_coefficient − table) / fuel_flow`: all that the adaptation needs, without
/// knowing engine or atmosphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// The segment's mean instant.
    pub time: Timestamp,
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Mach number.
    pub mach: f64,
    /// Observed drag coefficient.
    pub drag_coefficient: f64,
    /// Observed fuel flow of all engines, kg/s.
    pub fuel_flow_total_kg_s: f64,
    /// Change of predicted total fuel flow with drag coefficient, kg/s: dynamic pressure × wing area × TSFC.
    pub fuel_flow_per_drag_coefficient_kg_s: f64,
    /// Variance of the observed drag coefficient.
    pub variance: ObservationVariance,
}
