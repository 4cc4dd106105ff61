//! The balance of forces in level flight, and the coefficients.
//!
//! Thrust acts along the path, gravity is standard gravity, the path is level and the air mass does not accelerate:
//! along-path acceleration is the rate of change of ground speed. What this leaves out (climb, turn, real gravity, the
//! earth's rotation) is left to the diagnosis.

use units::convert::STANDARD_GRAVITY_M_S2;
use units::{Acceleration, Area, Force, Mass, Pressure};

/// Lift of level flight: the weight. L = m·g0. `[forces.1]`
///
/// # Source
/// Ghazi et al. 2020, equation (2).
#[must_use]
pub fn lift(mass: Mass) -> Force {
    Force::newtons(mass.to_kilograms() * STANDARD_GRAVITY_M_S2)
}

/// Force that accelerates the aircraft along its path: m·V̇G, negative when it slows down. `[forces.2]`
#[must_use]
pub fn inertia(mass: Mass, acceleration: Acceleration) -> Force {
    Force::newtons(mass.to_kilograms() * acceleration.to_meters_per_second_squared())
}

/// Net thrust of all engines that drag and acceleration require: Fn = D + m·V̇G. `[forces.2]`
///
/// # Source
/// Ghazi et al. 2020, equation (1).
#[must_use]
pub fn thrust_required(drag: Force, inertia: Force) -> Force {
    drag + inertia
}

/// Lift coefficient of level flight.
///
/// ```text
/// CL = m·g0/(q·S),  q = ½ρV²                                         [forces.6]
/// ```
///
/// It is that of the trimmed aircraft, so that trim is part of lift and drag.
///
/// # Source
/// Ghazi et al. 2020, equations (6), (12), (20).
#[doc(alias = "CL")]
#[must_use]
pub fn lift_coefficient(mass: Mass, dynamic_pressure: Pressure, wing_area: Area) -> f64 {
    coefficient(lift(mass), dynamic_pressure, wing_area)
}

/// Drag of a drag coefficient: D = q·S·CD. `[forces.7]`
///
/// # Source
/// Ghazi et al. 2020, equation (7).
#[must_use]
pub fn drag(drag_coefficient: f64, dynamic_pressure: Pressure, wing_area: Area) -> Force {
    Force::newtons(drag_coefficient * dynamic_pressure.to_pascals() * wing_area.to_square_meters())
}

/// Drag coefficient of a drag: CD = D/(q·S). `[forces.7]`
#[doc(alias = "CD")]
#[must_use]
pub fn drag_coefficient(drag: Force, dynamic_pressure: Pressure, wing_area: Area) -> f64 {
    coefficient(drag, dynamic_pressure, wing_area)
}

fn coefficient(force: Force, dynamic_pressure: Pressure, wing_area: Area) -> f64 {
    force.to_newtons() / (dynamic_pressure.to_pascals() * wing_area.to_square_meters())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_by_hand() {
        // m = 10 000 kg, q = 10 000 Pa, S = 50 m²: CL = 98 066.5/500 000 = 0.196 133.
        let (dynamic_pressure, wing_area) =
            (Pressure::pascals(10_000.0), Area::square_meters(50.0));
        let lift_coefficient =
            lift_coefficient(Mass::kilograms(10_000.0), dynamic_pressure, wing_area);
        assert!((lift_coefficient - 0.196_133).abs() < 1e-15);
        let drag = drag(0.03, dynamic_pressure, wing_area); // 15 000 N
        assert!((drag.to_newtons() - 15_000.0).abs() < 1e-9);
        assert!((drag_coefficient(drag, dynamic_pressure, wing_area) - 0.03).abs() < 1e-15);
        // 0.1 m/s² of 10 000 kg need 1000 N more.
        let inertia =
            inertia(Mass::kilograms(10_000.0), Acceleration::meters_per_second_squared(0.1));
        assert!((thrust_required(drag, inertia).to_newtons() - 16_000.0).abs() < 1e-9);
    }

    #[test]
    fn a_knot_a_minute_against_published_size() {
        // An acceleration of 1 kt/min is 1.06 % of the drag of a business jet of 30 000 lb with 11.0 kN of drag
        // (published for flight level 410, Mach 0.80).
        let acceleration = Acceleration::meters_per_second_squared(1852.0 / 3600.0 / 60.0);
        let inertia = inertia(Mass::pounds(30_000.0), acceleration).to_newtons();
        assert!((100.0 * inertia / 11_000.0 - 1.06).abs() < 0.005, "{inertia}");
    }
}
