//! The aircraft without any effect: atmosphere, drag, TSFC, and the model that holds them exactly.
#![expect(clippy::unwrap_used, reason = "constants that are known to be valid")]

use std::sync::Arc;

use effects::ExtendedModel;
use lut::surface::{Basis, Surface};
use perf_model::{Aircraft, PerformanceModel};

pub(super) const WING_M2: f64 = 48.96;
pub(super) const G0: f64 = 9.80665;
/// Gas constant of dry air, J/(kg K).
pub(super) const R: f64 = 287.05287;
/// Zero-lift drag coefficient.
pub(super) const CD0: f64 = 0.0188;
/// Induced drag over the square of the lift coefficient.
pub(super) const K: f64 = 0.056;

/// Temperature in K and pressure in Pa of the standard atmosphere at a pressure altitude in m, up to 20 km.
#[must_use]
pub fn isa(h: f64) -> (f64, f64) {
    if h < 11_000.0 {
        let t = 288.15 - 0.0065 * h;
        (t, 101_325.0 * (t / 288.15).powf(G0 / (0.0065 * R)))
    } else {
        (216.65, 22_632.06 * (-G0 * (h - 11_000.0) / (R * 216.65)).exp())
    }
}

/// Drag coefficient that compressibility adds.
pub(super) fn wave(mach: f64, lift: f64) -> f64 {
    20.0 * (mach - (0.797 - 0.085 * (lift - 0.35))).max(0.0).powi(4)
        + 0.0010 * ((mach - 0.60) / 0.3).max(0.0).powi(3)
}

/// The model that a diagnosis gets: the truth without any effect, on a grid so fine that it is exact.
///
/// # Panics
///
/// Never: its numbers are constants.
#[must_use]
pub fn exact_model() -> ExtendedModel {
    let aircraft = Aircraft::from_ron(
        r#"(
            name: "virtual", type_code: "VIRT", engines: 2, wing_area_m2: 48.96,
            tsfc: (static_lb_per_lbf_h: 0.48, mach_exponent: 0.8),
            table: (lift_coefficient: (0.08, 0.72, 0.005), mach: (0.50, 0.95, 0.005)),
            sensors: (
                fuel_flow_percent: 0.7071,
                mass: Percent(0.6),
                // These sensors keep nothing through a flight.
                flight_bias: (mach: 0, static_air_temperature_k: 0, n2_percent: 0, pressure_altitude_m: 0),
            ),
        )"#,
    )
    .unwrap();
    let grid = Arc::clone(aircraft.grid());
    let values = (0..grid.nodes())
        .map(|node| grid.coordinates(node))
        .map(|(lift, mach)| CD0 + K * lift * lift + wave(mach, lift))
        .collect();
    let table = lut::Table::new(Arc::clone(&grid), values).unwrap();
    let polynomial = Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] };
    let marks = vec![false; grid.nodes()];
    PerformanceModel::new(aircraft, polynomial, table, marks).unwrap().into()
}
