//! Fuel flow both ways: from drag to fuel flow, and from fuel flow back to drag.

use units::{Acceleration, Area, Force, FuelFlowTotal, Mass, Pressure, Tsfc};

use crate::forces;

/// What relates drag coefficient and fuel flow to each other at one moment of level flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CruiseConditions {
    /// Dynamic pressure ½ρV² with the true airspeed.
    pub dynamic_pressure: Pressure,
    /// Wing area.
    pub wing_area: Area,
    /// TSFC at this temperature and Mach number.
    pub tsfc: Tsfc,
    /// Gross mass.
    pub mass: Mass,
    /// Along-path acceleration: rate of change of ground speed.
    pub acceleration: Acceleration,
}

/// Fuel flow of all engines at a net thrust: Wf = Fn·TSFC. `[forces.4]`
///
/// # Source
/// Ghazi et al. 2020, equation (4).
#[must_use]
pub fn fuel_flow_total(net_thrust: Force, tsfc: Tsfc) -> FuelFlowTotal {
    FuelFlowTotal::kilograms_per_second(
        net_thrust.to_newtons() * tsfc.to_kilograms_per_newton_second(),
    )
}

/// Net thrust of all engines at a fuel flow: Fn = Wf/TSFC. `[forces.4]`
#[must_use]
pub fn net_thrust(fuel_flow_total: FuelFlowTotal, tsfc: Tsfc) -> Force {
    Force::newtons(
        fuel_flow_total.to_kilograms_per_second() / tsfc.to_kilograms_per_newton_second(),
    )
}

/// Predicted total fuel flow of a drag coefficient.
///
/// ```text
/// Ŵf = (q·S·CD + m·V̇G)·TSFC                                          [forces.12]
/// ```
///
/// Negative where the aircraft slows down faster than drag alone would make it, which is not cruise.
///
/// # Source
/// Ghazi et al. 2020, equation (23).
#[must_use]
pub fn predicted_fuel_flow(conditions: &CruiseConditions, drag_coefficient: f64) -> FuelFlowTotal {
    let drag = forces::drag(drag_coefficient, conditions.dynamic_pressure, conditions.wing_area);
    let inertia = forces::inertia(conditions.mass, conditions.acceleration);
    fuel_flow_total(forces::thrust_required(drag, inertia), conditions.tsfc)
}

/// Observed drag coefficient of a total fuel flow.
///
/// ```text
/// CD = (Wf/TSFC − m·V̇G)/(q·S)                                        [forces.11]
/// ```
///
/// Every disagreement between fuel flow and model is charged to drag, including the engine's part.
///
/// # Source
/// Ghazi et al. 2020, equation (22).
#[must_use]
pub fn observed_drag_coefficient(
    conditions: &CruiseConditions,
    fuel_flow_total: FuelFlowTotal,
) -> f64 {
    let drag = net_thrust(fuel_flow_total, conditions.tsfc)
        - forces::inertia(conditions.mass, conditions.acceleration);
    forces::drag_coefficient(drag, conditions.dynamic_pressure, conditions.wing_area)
}

/// Change of predicted total fuel flow with drag coefficient, kg/s: ∂Ŵf/∂CD = q·S·TSFC. `[forces.14]`
#[must_use]
pub fn fuel_flow_per_drag_coefficient_kg_s(conditions: &CruiseConditions) -> f64 {
    conditions.dynamic_pressure.to_pascals()
        * conditions.wing_area.to_square_meters()
        * conditions.tsfc.to_kilograms_per_newton_second()
}

/// Error of a predicted fuel flow, % of the observed one.
///
/// ```text
/// ε = 100·(Wf − Ŵf)/Wf                                               [forces.13]
/// ```
///
/// Positive: the aircraft burns more than the model predicts.
///
/// # Source
/// Ghazi et al. 2020, equation (24).
#[doc(alias = "epsilon")]
#[must_use]
pub fn fuel_flow_error_percent(observed: FuelFlowTotal, predicted: FuelFlowTotal) -> f64 {
    100.0 * ((observed - predicted) / observed)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn conditions(acceleration_m_s2: f64) -> CruiseConditions {
        CruiseConditions {
            dynamic_pressure: Pressure::pascals(8000.0),
            wing_area: Area::square_meters(50.0),
            tsfc: Tsfc::kilograms_per_newton_second(2e-5),
            mass: Mass::kilograms(14_000.0),
            acceleration: Acceleration::meters_per_second_squared(acceleration_m_s2),
        }
    }

    #[test]
    fn both_ways_by_hand_with_acceleration() {
        // q·S = 400 000 N. CD 0.03: D = 12 000 N; 0.005 m/s² of 14 000 kg: 70 N; Fn = 12 070 N; Wf = 0.2414 kg/s.
        let flow = predicted_fuel_flow(&conditions(0.005), 0.03);
        assert!((flow.to_kilograms_per_second() - 0.2414).abs() < 1e-15);
        // Back: 0.2414/2e-5 = 12 070 N; minus 70 N; divided by 400 000 N.
        let drag_coefficient = observed_drag_coefficient(&conditions(0.005), flow);
        assert!((drag_coefficient - 0.03).abs() < 1e-15);
        // Without the acceleration term the same flow gives a drag coefficient of 0.030 175.
        let drag_coefficient = observed_drag_coefficient(&conditions(0.0), flow);
        assert!((drag_coefficient - 0.030_175).abs() < 1e-15);
    }

    #[test]
    fn error_is_positive_when_the_aircraft_burns_more() {
        // (0.25 − 0.24)/0.25 = 4 %, by hand.
        let error = fuel_flow_error_percent(
            FuelFlowTotal::kilograms_per_second(0.25),
            FuelFlowTotal::kilograms_per_second(0.24),
        );
        assert!((error - 4.0).abs() < 1e-12);
    }

    #[test]
    fn six_percent_more_fuel_is_six_percent_more_drag() {
        // The published non-identifiability: an engine that burns 6 % more at the same drag, and 6 % more drag with the
        // same engine, are identical to [forces.11] in steady flight.
        let steady = conditions(0.0);
        let healthy = predicted_fuel_flow(&steady, 0.03);
        let worn_engine =
            FuelFlowTotal::kilograms_per_second(1.06 * healthy.to_kilograms_per_second());
        let dirty_airframe = predicted_fuel_flow(&steady, 1.06 * 0.03);
        let from_engine = observed_drag_coefficient(&steady, worn_engine);
        let from_airframe = observed_drag_coefficient(&steady, dirty_airframe);
        assert!((from_engine - from_airframe).abs() < 1e-15);
        assert!((from_engine - 0.0318).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn error_of_any_table_is_linear_in_its_drag_coefficient(
            observed in 0.01_f64..0.08, table in 0.01_f64..0.08, acceleration in -0.02_f64..0.02,
        ) {
            // [forces.14]: ε = 100·slope·(CD − CD table)/Wf, as documented for an Observation.
            let conditions = conditions(acceleration);
            let flow = predicted_fuel_flow(&conditions, observed);
            let direct = fuel_flow_error_percent(flow, predicted_fuel_flow(&conditions, table));
            let by_slope = 100.0 * fuel_flow_per_drag_coefficient_kg_s(&conditions)
                * (observed - table) / flow.to_kilograms_per_second();
            prop_assert!((direct - by_slope).abs() < 1e-9);
        }
    }
}
