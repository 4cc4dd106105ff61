//! The initial model: a six-coefficient polynomial through the rows of a flight-planning guide.
//!
//! A guide may have full rank for the arithmetic and still not determine the polynomial: rows of one weight at one
//! altitude lie on one curve of lift coefficient over Mach number, and away from that curve the polynomial is free. The
//! condition number does not distinguish this from a good guide with a narrow band of Mach numbers (both are near 1e5).
//! So the criterion is the quantity of interest itself: how much an error of the rows grows at a node within the
//! guide's own range.

use std::sync::Arc;

use atmos::{airspeed, isa};
use flight::Finding;
use lut::surface::{self, Surface};
use lut::{SNAP, Table};
use units::OutOfDomain;

use crate::fuel_flow::{self, CruiseConditions};
use crate::tsfc::tsfc;
use crate::{Aircraft, Guide, GuidePoint, PerformanceModel, forces};

mod amplification;
mod error;
mod findings;
mod odd_row;

pub use error::{InitialModelError, Undetermined};

/// Largest growth of an error from the guide's rows to a node within its range. At 100 an error of 1 % in the rows is
/// as large as the drag itself: the guide carries no information there. Guides that span weights and speeds reach 1 to
/// 3; rows of one weight at one altitude 1e4 and more.
pub const MAXIMUM_AMPLIFICATION: f64 = 100.0;

/// A model from a guide, and how well the guide determines it.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialModel {
    /// The model.
    pub model: PerformanceModel,
    /// The fit.
    pub fit: GuideFit,
    /// Findings about the guide.
    pub findings: Vec<Finding>,
}

/// How well the polynomial fits the guide, and the range of the guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideFit {
    /// Rows of the guide.
    pub points: usize,
    /// Rank of the design; always 6.
    pub rank: usize,
    /// Ratio of largest to smallest singular value of the design, columns not scaled.
    pub condition_number: f64,
    /// Root mean square of the residuals, in drag coefficient.
    pub residual_rms: f64,
    /// Root mean square of the residuals, % of each row's drag coefficient, which is % of its fuel flow.
    pub residual_rms_percent: f64,
    /// The row with the largest residual: its line, and guide minus polynomial in % of the guide.
    pub worst_row: (u64, f64),
    /// Largest growth of an independent error of the rows to a node or corner within the guide's range.
    pub amplification: f64,
    /// Smallest and largest lift coefficient of the guide.
    pub lift_coefficients: (f64, f64),
    /// Smallest and largest Mach number of the guide.
    pub machs: (f64, f64),
    /// Number of different weights.
    pub weights: usize,
    /// Number of different pressure altitudes.
    pub pressure_altitudes: usize,
    /// Nodes of the table outside the guide's range.
    pub extrapolated_nodes: usize,
}

/// A guide's row reduced to the drag table's terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideObservation {
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Mach number.
    pub mach: f64,
    /// Drag coefficient that corresponds to the fuel flow.
    pub drag_coefficient: f64,
}

/// Reduces a row of a guide: level, unaccelerated flight.
///
/// ```text
/// M = V/√(γ R SAT),  CL = m·g0/(q·S),  CD = Wf/(TSFC·q·S)              [forces.9]
/// ```
///
/// # Errors
/// [`OutOfDomain`] for a pressure altitude or Mach number outside its domain.
///
/// # Source
/// Ghazi et al. 2020, equations (12)–(14).
pub fn observe_guide_point(
    aircraft: &Aircraft,
    point: &GuidePoint,
) -> Result<GuideObservation, OutOfDomain> {
    let sat = point.static_air_temperature()?;
    let mach = point.mach()?;
    let density = isa::density(isa::pressure(point.pressure_altitude)?, sat);
    let conditions = CruiseConditions {
        dynamic_pressure: airspeed::dynamic_pressure(density, point.true_airspeed),
        wing_area: aircraft.wing_area(),
        tsfc: tsfc(aircraft.tsfc_law(), isa::temperature_ratio(sat), mach),
        mass: point.mass,
        acceleration: units::Acceleration::meters_per_second_squared(0.0),
    };
    Ok(GuideObservation {
        lift_coefficient: forces::lift_coefficient(
            point.mass,
            conditions.dynamic_pressure,
            conditions.wing_area,
        ),
        mach: mach.value(),
        drag_coefficient: fuel_flow::observed_drag_coefficient(&conditions, point.fuel_flow_total),
    })
}

/// The initial model: the polynomial of the aircraft's basis through the guide, by ordinary least squares; every node
/// of the table takes its value; nodes outside the guide's range are marked as extrapolated.
///
/// # Errors
/// [`InitialModelError`] with the reason where the guide does not determine the polynomial, or where the polynomial is
/// not positive at a node.
///
/// # Source
/// Book `[forces.8]`, `[forces.9]`; Ghazi et al. 2020, equations (12)–(15).
pub fn initial_model(
    aircraft: &Aircraft,
    guide: &Guide,
) -> Result<InitialModel, InitialModelError> {
    let rows = guide
        .points()
        .iter()
        .map(|point| {
            observe_guide_point(aircraft, point)
                .map_err(|domain| InitialModelError::OutOfDomain { line: point.line, domain })
        })
        .collect::<Result<Vec<_>, _>>()?;
    let points: Vec<(f64, f64, f64, f64)> = rows
        .iter()
        .map(|row| (row.lift_coefficient, row.mach, row.drag_coefficient, 1.0))
        .collect();
    let fit = surface::fit(aircraft.polynomial(), &points)
        .map_err(|error| error::from_fit(error, guide.points().len()))?;

    let lift_coefficients = range(rows.iter().map(|row| row.lift_coefficient));
    let machs = range(rows.iter().map(|row| row.mach));
    let grid = aircraft.grid();
    let inside = |(lift_coefficient, mach): (f64, f64)| {
        within(lift_coefficient, lift_coefficients) && within(mach, machs)
    };
    let coordinates: Vec<(f64, f64)> =
        (0..grid.nodes()).map(|node| grid.coordinates(node)).collect();
    let extrapolated: Vec<bool> = coordinates.iter().map(|&node| !inside(node)).collect();

    let corners = [lift_coefficients.0, lift_coefficients.1]
        .into_iter()
        .flat_map(|lift_coefficient| [(lift_coefficient, machs.0), (lift_coefficient, machs.1)]);
    let judged = coordinates.iter().copied().filter(|&node| inside(node)).chain(corners);
    let worst = amplification::worst(aircraft.polynomial(), &points, judged);
    let weights = distinct(guide.points().iter().map(|point| point.mass.to_kilograms()));
    let pressure_altitudes =
        distinct(guide.points().iter().map(|point| point.pressure_altitude.to_meters()));
    // Written so that NaN is refused too.
    if worst.factor.is_nan() || worst.factor > MAXIMUM_AMPLIFICATION {
        return Err(InitialModelError::PoorlyDetermined {
            amplification: worst.factor,
            maximum: MAXIMUM_AMPLIFICATION,
            lift_coefficient: worst.at.0,
            mach: worst.at.1,
            rows: rows.len(),
            weights,
            pressure_altitudes,
            condition_number: fit.condition_number,
        });
    }

    let drag_table = table_of(aircraft, &fit.surface, &coordinates)?;
    let extrapolated_nodes = extrapolated.iter().filter(|&&mark| mark).count();
    let model = PerformanceModel::new(aircraft.clone(), fit.surface, drag_table, extrapolated)
        .map_err(|source| error::from_model(source, inside, (lift_coefficients, machs)))?;
    let residuals_percent = residuals_percent(&rows, &fit.surface);
    let fit = GuideFit {
        points: rows.len(),
        rank: fit.rank,
        condition_number: fit.condition_number,
        residual_rms: fit.residual_rms,
        residual_rms_percent: root_mean_square(&residuals_percent),
        worst_row: worst_row(guide, &residuals_percent),
        amplification: worst.factor,
        lift_coefficients,
        machs,
        weights,
        pressure_altitudes,
        extrapolated_nodes,
    };
    let mut findings = findings::of_guide(aircraft, guide, (&rows, &residuals_percent), &fit);
    findings.extend(findings::coarse_table(&model, &rows));
    Ok(InitialModel { model, fit, findings })
}

/// How far each row's drag lies above the polynomial, %.
fn residuals_percent(rows: &[GuideObservation], polynomial: &Surface) -> Vec<f64> {
    rows.iter()
        .map(|row| {
            100.0 * (1.0 - polynomial.value(row.lift_coefficient, row.mach) / row.drag_coefficient)
        })
        .collect()
}

/// The polynomial at every node.
fn table_of(
    aircraft: &Aircraft,
    polynomial: &Surface,
    coordinates: &[(f64, f64)],
) -> Result<Table, InitialModelError> {
    let values = coordinates
        .iter()
        .map(|&(lift_coefficient, mach)| polynomial.value(lift_coefficient, mach))
        .collect();
    Table::new(Arc::clone(aircraft.grid()), values).map_err(InitialModelError::Table)
}

/// Smallest and largest; for no values, infinities the wrong way round.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// Inclusive; a value within the table's snap distance of the limit counts as on it.
fn within(value: f64, (low, high): (f64, f64)) -> bool {
    low - value <= SNAP && value - high <= SNAP
}

/// Number of values that differ by more than rounding in a unit conversion.
fn distinct(values: impl Iterator<Item = f64>) -> usize {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|next, kept| *next - *kept <= 1e-6);
    values.len()
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

fn worst_row(guide: &Guide, residuals_percent: &[f64]) -> (u64, f64) {
    guide.points().iter().zip(residuals_percent).fold(
        (0, 0.0),
        |worst: (u64, f64), (point, &residual)| {
            if residual.abs() > worst.1.abs() { (point.line, residual) } else { worst }
        },
    )
}

#[cfg(test)]
mod tests;
