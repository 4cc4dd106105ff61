//! How uncertain an observed drag coefficient is: the sensors' standard deviations propagated to first order.
//!
//! The quantity of interest is the residual y = ln CD observed − ln CD table(CL, M): an error of Mach number, mass or
//! pressure moves the observed drag coefficient *and* the point at which the table is read, and the two partly cancel.
//! The derivation is the book's page on uncertainty.

use atmos::constants::SPECIFIC_GAS_CONSTANT_J_KG_K;
use atmos::isa;
use flight::{ObservationVariance, Segment};
use lut::{Cell, Table};
use units::convert::STANDARD_GRAVITY_M_S2;
use units::{Acceleration, Force, Mach, Mass, OutOfDomain, PressureAltitude, Temperature};

use crate::Aircraft;
use crate::state::SegmentState;

/// Logarithmic slopes of a drag table at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableSlopes {
    /// ∂ln CD/∂ln CL.
    pub along_ln_lift_coefficient: f64,
    /// ∂ln CD/∂M.
    pub along_mach: f64,
}

/// Derivatives of the residual y with respect to recorded quantities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualSensitivity {
    /// ∂y/∂ln Wf: ratio of net thrust to drag, 1 in steady flight.
    pub ln_fuel_flow: f64,
    /// ∂y/∂M, per unit of Mach number; true airspeed changes with Mach number.
    pub mach: f64,
    /// ∂y/∂SAT, 1/K; true airspeed changes with temperature.
    pub static_air_temperature_per_k: f64,
    /// ∂y/∂V̇G, s²/m.
    pub acceleration_s2_per_m: f64,
    /// ∂y/∂ln m.
    pub ln_mass: f64,
    /// ∂y/∂h, 1/m, with h pressure altitude; Mach number and true airspeed are held.
    pub pressure_altitude_per_m: f64,
}

/// What the derivatives depend on at a recorded point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RecordedPoint {
    pub(crate) mach: Mach,
    pub(crate) static_air_temperature: Temperature,
    /// That of the ISA at the pressure altitude.
    pub(crate) standard_temperature: Temperature,
    pub(crate) mass: Mass,
    pub(crate) acceleration: Acceleration,
    pub(crate) drag: Force,
    pub(crate) net_thrust: Force,
}

impl RecordedPoint {
    fn of_state(
        pressure_altitude: PressureAltitude,
        state: &SegmentState,
    ) -> Result<Self, OutOfDomain> {
        Ok(Self {
            mach: state.mach,
            static_air_temperature: Temperature::kelvin(
                state.temperature_ratio * atmos::constants::SEA_LEVEL_TEMPERATURE_K,
            ),
            standard_temperature: isa::temperature(pressure_altitude)?,
            mass: state.conditions.mass,
            acceleration: state.conditions.acceleration,
            drag: state.drag(),
            net_thrust: state.net_thrust,
        })
    }
}

impl TableSlopes {
    /// The slopes of a table with positive values at a located point.
    #[must_use]
    pub fn at(drag_table: &Table, cell: &Cell, lift_coefficient: f64) -> Self {
        let drag_coefficient = drag_table.interpolate(cell);
        let (along_lift_coefficient, along_mach) = drag_table.gradient(cell);
        Self {
            along_ln_lift_coefficient: along_lift_coefficient * lift_coefficient / drag_coefficient,
            along_mach: along_mach / drag_coefficient,
        }
    }
}

impl ResidualSensitivity {
    /// The derivatives at a segment's state.
    ///
    /// ```text
    /// ∂y/∂ln Wf = F/D                                                    [uncertainty.2]
    /// ∂y/∂M     = (−2 + 2λ − (F/D)·n·M/(1+M))/M − μ                      [uncertainty.3]
    /// ∂y/∂SAT   = −(F/D)/(2·SAT)                                         [uncertainty.4]
    /// ∂y/∂V̇G    = −m/D                                                   [uncertainty.5]
    /// ∂y/∂ln m  = −λ − m·V̇G/D                                            [uncertainty.6]
    /// ∂y/∂h     = (1 − λ)·g0/(R·T_ISA(h))                                [uncertainty.7]
    /// ```
    ///
    /// with F net thrust, D drag, n the TSFC law's exponent, λ = ∂ln CD/∂ln CL and μ = ∂ln CD/∂M of the table.
    ///
    /// # Errors
    /// [`OutOfDomain`] for a pressure altitude outside the atmosphere's domain.
    ///
    /// # Source
    /// Book, page on uncertainty; checked by finite differences.
    pub fn new(
        aircraft: &Aircraft,
        pressure_altitude: PressureAltitude,
        state: &SegmentState,
        slopes: TableSlopes,
    ) -> Result<Self, OutOfDomain> {
        Ok(Self::at(aircraft, &RecordedPoint::of_state(pressure_altitude, state)?, slopes))
    }

    #[inline]
    fn at(aircraft: &Aircraft, point: &RecordedPoint, slopes: TableSlopes) -> Self {
        let mach = point.mach.value();
        let drag_n = point.drag.to_newtons();
        let mass_kg = point.mass.to_kilograms();
        let acceleration_m_s2 = point.acceleration.to_meters_per_second_squared();
        let thrust_over_drag = point.net_thrust.to_newtons() / drag_n;
        let lambda = slopes.along_ln_lift_coefficient;
        let tsfc_slope = aircraft.tsfc_law().mach_exponent * mach / (1.0 + mach);
        let sat_k = point.static_air_temperature.to_kelvin();
        let isa_temperature_k = point.standard_temperature.to_kelvin();
        Self {
            ln_fuel_flow: thrust_over_drag,
            mach: (-2.0 + 2.0 * lambda - thrust_over_drag * tsfc_slope) / mach - slopes.along_mach,
            static_air_temperature_per_k: -0.5 * thrust_over_drag / sat_k,
            acceleration_s2_per_m: -mass_kg / drag_n,
            ln_mass: -lambda - mass_kg * acceleration_m_s2 / drag_n,
            pressure_altitude_per_m: (1.0 - lambda) * STANDARD_GRAVITY_M_S2
                / (SPECIFIC_GAS_CONSTANT_J_KG_K * isa_temperature_k),
        }
    }
}

/// Variance of a segment's residual: its own part, and the part common to all segments of its flight.
///
/// ```text
/// segment: Σ (∂y/∂x·σx)² over fuel flow, Mach number, SAT, acceleration, pressure altitude   [uncertainty.8]
/// flight:  (∂y/∂ln Wf·σLHV)² + (∂y/∂ln m·σm)²                                                [uncertainty.9]
/// ```
///
/// # Errors
/// [`OutOfDomain`] for a pressure altitude outside the atmosphere's domain.
pub fn observation_variance(
    aircraft: &Aircraft,
    segment: &Segment,
    state: &SegmentState,
    slopes: TableSlopes,
) -> Result<ObservationVariance, OutOfDomain> {
    let means = &segment.means;
    let pressure_altitude = PressureAltitude::meters(means.pressure_altitude_m);
    let fuel_flow_relative_variance = total_fuel_flow_relative_variance(
        aircraft.sensors().fuel_flow_percent / 100.0,
        &means.fuel_flow_engine_kg_s,
        aircraft.engines(),
    );
    let point = RecordedPoint::of_state(pressure_altitude, state)?;
    Ok(propagated(aircraft, &point, slopes, fuel_flow_relative_variance, segment.samples()))
}

/// The sensors' standard deviations by the derivatives at a point, for a segment of this many samples.
#[inline]
pub(crate) fn propagated(
    aircraft: &Aircraft,
    point: &RecordedPoint,
    slopes: TableSlopes,
    fuel_flow_relative_variance: f64,
    samples: usize,
) -> ObservationVariance {
    let sensors = aircraft.sensors();
    let sensitivity = ResidualSensitivity::at(aircraft, point, slopes);
    let square = |x: f64| x * x;
    let segment_variance = square(sensitivity.ln_fuel_flow) * fuel_flow_relative_variance
        + square(sensitivity.mach * sensors.mach)
        + square(sensitivity.static_air_temperature_per_k * sensors.static_air_temperature_k)
        + square(
            sensitivity.acceleration_s2_per_m
                * mean_acceleration_deviation_m_s2(sensors.acceleration_m_s2, samples),
        )
        + square(sensitivity.pressure_altitude_per_m * sensors.pressure_altitude_m);
    let mass = sensors.mass.relative_to(point.mass);
    let flight_variance =
        square(sensitivity.ln_fuel_flow * sensors.lower_heating_value_percent / 100.0)
            + square(sensitivity.ln_mass * mass);
    ObservationVariance { segment: segment_variance, flight: flight_variance }
}

/// Relative variance of total fuel flow when the readings of all engines have independent errors of the same relative
/// size.
///
/// ```text
/// σ²·Σ Wk²/(Σ Wk)²,  σ²/n for n engines that burn alike                                  [uncertainty.10]
/// ```
///
/// `fuel_flow_engine_kg_s` is empty where engines are not recorded separately; they then count as alike.
#[must_use]
pub fn total_fuel_flow_relative_variance(
    engine_relative_deviation: f64,
    fuel_flow_engine_kg_s: &[f64],
    engines: usize,
) -> f64 {
    let total: f64 = fuel_flow_engine_kg_s.iter().sum();
    let squares: f64 = fuel_flow_engine_kg_s.iter().map(|flow| flow * flow).sum();
    let share = if total > 0.0 { squares / (total * total) } else { 1.0 / engines.max(1) as f64 };
    engine_relative_deviation * engine_relative_deviation * share
}

/// Standard deviation of a segment's mean acceleration, m/s².
///
/// ```text
/// σ(mean) = σa/√N                                                                        [uncertainty.11]
/// ```
///
/// for N samples whose errors are independent. If ground speed were in error, its forward differences would telescope
/// and the error of their mean would fall as 1/N; but in turbulence the error is not in the speed: fuel flow is read at
/// N moments and does not see what thrust did between them. On simulated fleets in turbulence the error of the mean
/// fell as 1/√N (book, page on uncertainty).
#[must_use]
pub fn mean_acceleration_deviation_m_s2(sample_deviation_m_s2: f64, samples: usize) -> f64 {
    sample_deviation_m_s2 / (samples.max(1) as f64).sqrt()
}

#[cfg(test)]
pub(crate) mod tests;
