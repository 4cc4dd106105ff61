//! A public performance model of 68 transport types: the method of Poll and Schumann.
//!
//! Drag from friction (a power of the Reynolds number), lift and a rise with Mach number; fuel flow from an overall
//! propulsive efficiency that depends on Mach number and thrust. Its authors expect fuel burn within 5 % in the majority of
//! cases; it knows neither the engine option of a tail nor its age. It is where to begin for who has no guide
//! ([`guide`]); nothing else depends on it.
//!
//! # Source
//! D. I. A. Poll, U. Schumann: An estimation method for the fuel burn and other performance characteristics of civil
//! transport aircraft in the cruise, Part 1 and Part 2, The Aeronautical Journal 125 (1284), 2021,
//! doi 10.1017/aer.2020.62 and 10.1017/aer.2020.124; Part 3, 126 (1300), 2022, doi 10.1017/aer.2021.50. Equations as
//! arranged in pycontrails 0.63.5 (Apache-2.0), whose table of 28 March 2025 gives the parameters of each type.

use core::f64::consts::PI;

use atmos::constants::RATIO_OF_SPECIFIC_HEATS;
use atmos::{airspeed, isa, viscosity};
use units::convert::STANDARD_GRAVITY_M_S2;
use units::{
    FuelFlowTotal, Mach, Mass, OutOfDomain, Pressure, PressureAltitude, Temperature,
    TemperatureDifference, Tsfc, check_within,
};

use crate::Guide;

pub mod guide;
mod types;

pub use types::{Parameters, Represented, find, represented, types};

/// Lower heating value that the model's fuel flows are for, MJ/kg: that of pycontrails' Jet A-1.
pub const LOWER_HEATING_VALUE_MJ_KG: f64 = 43.13;

/// What the authors state of the model's fuel burn, %: of the 68 types with parameters of their own.
pub const STATED_ACCURACY_PERCENT: f64 = 5.0;

/// Mach numbers that the equations of this module are for. Below 0.4 the efficiency has further terms.
pub const MACH: (f64, f64) = (0.4, 0.95);

/// Level, unaccelerated flight of an aircraft by the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cruise {
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Drag coefficient.
    pub drag_coefficient: f64,
    /// Thrust over that of the highest efficiency at this Mach number.
    pub relative_thrust: f64,
    /// Overall propulsive efficiency: thrust power over heating power of the fuel.
    pub efficiency: f64,
    /// Thrust-specific fuel consumption.
    pub tsfc: Tsfc,
    /// Fuel flow of all engines.
    pub fuel_flow_total: FuelFlowTotal,
}

/// Fuel flow of level cruise.
///
/// # Errors
/// [`OutOfDomain`] outside [`MACH`], and for a pressure altitude outside the atmosphere's domain.
pub fn cruise(
    aircraft: &Parameters,
    mass: Mass,
    pressure_altitude: PressureAltitude,
    mach: Mach,
    isa_deviation: TemperatureDifference,
) -> Result<Cruise, OutOfDomain> {
    check_within("Mach number of the public model", "Mach", mach.value(), MACH.0, MACH.1)?;
    let sat = isa::temperature(pressure_altitude)? + isa_deviation;
    let pressure = isa::pressure(pressure_altitude)?;
    let dynamic_pressure_pa =
        0.5 * RATIO_OF_SPECIFIC_HEATS * pressure.to_pascals() * mach.value().powi(2);
    let lift_coefficient =
        mass.to_kilograms() * STANDARD_GRAVITY_M_S2 / (dynamic_pressure_pa * aircraft.wing_area_m2);
    let reynolds = reynolds_number(aircraft, pressure, sat, mach);
    let drag_coefficient = drag_coefficient(aircraft, lift_coefficient, mach, reynolds);
    // Level and unaccelerated: the thrust coefficient is the drag coefficient.
    let relative_thrust = drag_coefficient / best_thrust_coefficient(aircraft, mach);
    let efficiency = relative_efficiency(relative_thrust) * highest_efficiency(aircraft, mach);
    let true_airspeed = airspeed::mach_to_true_airspeed(mach, sat);
    let tsfc_si =
        true_airspeed.to_meters_per_second() / (efficiency * LOWER_HEATING_VALUE_MJ_KG * 1e6);
    let drag_n = drag_coefficient * dynamic_pressure_pa * aircraft.wing_area_m2;
    Ok(Cruise {
        lift_coefficient,
        drag_coefficient,
        relative_thrust,
        efficiency,
        tsfc: Tsfc::kilograms_per_newton_second(tsfc_si),
        fuel_flow_total: FuelFlowTotal::kilograms_per_second(tsfc_si * drag_n),
    })
}

/// Mean of a guide's fuel flow against the model's, % of the model's, over the guide's rows of cruise; `None` where there is
/// none within [`MACH`].
#[must_use]
pub fn mean_deviation_percent(aircraft: &Parameters, guide: &Guide) -> Option<f64> {
    let deviations: Vec<f64> = guide
        .points()
        .iter()
        .filter_map(|point| {
            let mach = point.mach().ok()?;
            let model =
                cruise(aircraft, point.mass, point.pressure_altitude, mach, point.isa_deviation);
            let ratio = point.fuel_flow_total.to_kilograms_per_second()
                / model.ok()?.fuel_flow_total.to_kilograms_per_second();
            ratio.is_finite().then_some(100.0 * (ratio - 1.0))
        })
        .collect();
    let count = deviations.len() as f64;
    (count > 0.0).then(|| deviations.iter().sum::<f64>() / count)
}

/// Reynolds number of the square root of the wing area: Re = √S·V·ρ/μ.
///
/// # Source
/// Poll and Schumann 2021, Part 1, equations (3) and (25).
#[must_use]
pub fn reynolds_number(
    aircraft: &Parameters,
    pressure: Pressure,
    sat: Temperature,
    mach: Mach,
) -> f64 {
    viscosity::reynolds_number(
        isa::density(pressure, sat),
        airspeed::mach_to_true_airspeed(mach, sat),
        aircraft.wing_area_m2.sqrt(),
        viscosity::dynamic_viscosity(sat),
    )
}

/// Drag coefficient: CD = CD0 + CL²/(π·AR·e) + CDW, with CD0 = Cf·ψ0 and Cf = 0.0269/Re^0.14.
///
/// # Source
/// Poll and Schumann 2021, Part 1, equations (8), (9) and (28).
#[must_use]
pub fn drag_coefficient(
    aircraft: &Parameters,
    lift_coefficient: f64,
    mach: Mach,
    reynolds_number: f64,
) -> f64 {
    let zero_lift = aircraft.psi_0 * 0.0269 / reynolds_number.powf(0.14);
    let span_efficiency = span_efficiency(aircraft, zero_lift);
    let induced = lift_coefficient.powi(2) / (PI * aircraft.aspect_ratio * span_efficiency);
    zero_lift + induced + wave_drag_coefficient(aircraft, lift_coefficient, mach)
}

/// Oswald's span efficiency: e = w/(1.03 + δ2 + k1·π·AR), k1 = 0.8·(1 − 0.53·cos Λ)·CD0, with w = 1.075 for winglets and 1
/// without.
///
/// # Source
/// Poll and Schumann 2021, Part 1, equation (12); Part 2, equation (13).
#[must_use]
pub fn span_efficiency(aircraft: &Parameters, zero_lift_drag_coefficient: f64) -> f64 {
    let winglets = if aircraft.has_winglets { 1.075 } else { 1.0 };
    let viscous = 0.8 * (1.0 - 0.53 * aircraft.cos_sweep) * zero_lift_drag_coefficient;
    winglets / (1.03 + aircraft.delta_2 + viscous * PI * aircraft.aspect_ratio)
}

/// Wave drag coefficient: CDW = cos³Λ·j1·(X − j2)² + 70·(X − Xref)⁴ where X exceeds j2 and Xref, X = M·cos Λ/(Mw −
/// 0.1·CL/cos²Λ).
///
/// # Source
/// Poll and Schumann 2022, Part 3; the factor 70 is that of pycontrails for all types.
#[must_use]
pub fn wave_drag_coefficient(aircraft: &Parameters, lift_coefficient: f64, mach: Mach) -> f64 {
    let cos_sweep = aircraft.cos_sweep;
    let technology = aircraft.wing_constant - 0.1 * lift_coefficient / cos_sweep.powi(2);
    let position = mach.value() * cos_sweep / technology;
    let gradual = (position - aircraft.j_2).max(0.0);
    let steep = (position - aircraft.x_ref).max(0.0);
    cos_sweep.powi(3) * aircraft.j_1 * gradual.powi(2) + 70.0 * steep.powi(4)
}

/// Thrust coefficient of the highest efficiency at a Mach number.
///
/// # Source
/// Poll and Schumann 2021, Part 2, the function h2.
#[must_use]
pub fn best_thrust_coefficient(aircraft: &Parameters, mach: Mach) -> f64 {
    let (mach, design) = (mach.value(), aircraft.design_mach);
    let h2 = (1.0 + 0.55 * mach) / (1.0 + 0.55 * design) / (mach / design).powi(2);
    h2 * aircraft.design_thrust_coefficient
}

/// Highest overall propulsive efficiency at a Mach number: η = η1·M^η2.
///
/// # Source
/// Poll and Schumann 2021, Part 2, equation (35).
#[must_use]
pub fn highest_efficiency(aircraft: &Parameters, mach: Mach) -> f64 {
    aircraft.eta_1 * mach.value().powf(aircraft.eta_2)
}

/// Efficiency over the highest one at the same Mach number, by relative thrust; for Mach numbers from 0.4 on.
///
/// # Source
/// Poll and Schumann 2021, Part 2: the polynomials with σ = −0.43.
#[must_use]
pub fn relative_efficiency(relative_thrust: f64) -> f64 {
    const SIGMA: f64 = -0.43;
    let x = relative_thrust;
    if x < 0.3 {
        let linear = 10.0 * (1.0 + 0.8 * SIGMA);
        let square = 33.3333 * (-1.0 - 0.97 * SIGMA);
        let cube = 37.037 * (1.0 + SIGMA);
        x * (linear + x * (square + x * cube))
    } else {
        1.0 + SIGMA + x * (-2.0 * SIGMA + SIGMA * x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The source has the two polynomials meet at 0.3 with one slope, and their highest value, 1, at a relative thrust of 1.
    #[test]
    fn the_two_polynomials_meet() {
        let slope = |x: f64| (relative_efficiency(x + 1e-6) - relative_efficiency(x - 1e-6)) / 2e-6;
        let (below, above) = (relative_efficiency(0.3 - 1e-9), relative_efficiency(0.3));
        assert!((below - above).abs() < 1e-4, "{below} {above}");
        assert!((slope(0.3 - 2e-6) - slope(0.3 + 2e-6)).abs() < 1e-3);
        assert!((relative_efficiency(1.0) - 1.0).abs() < 1e-12 && slope(1.0).abs() < 1e-6);
        assert!(relative_efficiency(0.0).abs() < 1e-12);
    }
}
