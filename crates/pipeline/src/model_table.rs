//! A model's drag table, and the polynomial behind it, as tables of named columns.

use adapt::bayes::{PolynomialError, polynomial_export};
use lut::surface::{self, Basis, COEFFICIENTS, FitError, Surface};

use crate::columns::Columns;
use crate::export::{informed, rms_and_largest};
use crate::model_file::ModelFile;

/// Why no polynomial follows from a table.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ModelPolynomialError {
    /// A table learnt by law `bayes`.
    #[error(transparent)]
    Posterior(#[from] PolynomialError),
    /// Any other table.
    #[error(transparent)]
    Fit(#[from] FitError),
}

/// One row per node: coordinates, drag coefficients, confidence, and whether the guide left it extrapolated.
pub fn table(model: &ModelFile) -> Columns {
    let drag = model.drag_coefficient();
    let grid = model.grid();
    let nodes = || 0..grid.nodes();
    let mut columns = Columns::default();
    columns.number("lift_coefficient", nodes().map(|node| Some(grid.coordinates(node).0)));
    columns.number("mach", nodes().map(|node| Some(grid.coordinates(node).1)));
    columns.number("drag_coefficient", nodes().map(|node| Some(drag.value_at_node(node))));
    let confidence = model.confidence();
    columns.number(
        "confidence",
        nodes().map(|node| Some(confidence.map_or(1.0, |confidence| confidence[node]))),
    );
    let initial = model.initial.drag_table();
    columns
        .number("initial_drag_coefficient", nodes().map(|node| Some(initial.value_at_node(node))));
    columns
        .count("extrapolated", nodes().map(|node| u64::from(model.initial.extrapolated()[node])));
    columns
}

/// One row per coefficient of the polynomial fitted to the table: its value and, where the law knows it, its covariance with
/// each of the six.
///
/// # Errors
/// A table whose nodes do not determine the polynomial.
pub fn polynomial(model: &ModelFile) -> Result<Columns, ModelPolynomialError> {
    let (surface, covariance) = surface_of(model)?;
    let mut columns = Columns::default();
    columns.count("coefficient", 0..surface.coefficients.len() as u64);
    columns.text("term", terms(surface.basis).map(str::to_owned).into_iter());
    columns.number("value", surface.coefficients.iter().map(|value| Some(*value)));
    if let Some(covariance) = covariance {
        for other in 0..surface.coefficients.len() {
            columns.number(
                format!("covariance_{other}"),
                covariance.iter().map(|row| Some(row[other])),
            );
        }
    }
    Ok(columns)
}

/// What the polynomial misses of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolynomialMiss {
    /// Root mean square over the nodes that guide or flights inform, % of drag.
    pub rms_percent: f64,
    /// The largest of them, without its sign, % of drag.
    pub maximum_percent: f64,
}

/// What the polynomial misses at the nodes of the table that guide or flights inform.
///
/// # Errors
/// As for [`polynomial`].
pub fn polynomial_miss(model: &ModelFile) -> Result<PolynomialMiss, ModelPolynomialError> {
    let (surface, _) = surface_of(model)?;
    let grid = model.grid();
    let is_informed = informed(model);
    let misses: Vec<f64> = (0..grid.nodes())
        .filter(|node| is_informed[*node])
        .map(|node| {
            let (lift_coefficient, mach) = grid.coordinates(node);
            let drag = model.drag_coefficient().value_at_node(node);
            100.0 * (surface.value(lift_coefficient, mach) / drag - 1.0)
        })
        .collect();
    let [rms_percent, maximum_percent] = rms_and_largest(&misses).unwrap_or_default();
    Ok(PolynomialMiss { rms_percent, maximum_percent })
}

/// The polynomial and, by law `bayes`, the covariance of its coefficients.
type SurfaceKnown = (Surface, Option<[[f64; COEFFICIENTS]; COEFFICIENTS]>);

fn surface_of(model: &ModelFile) -> Result<SurfaceKnown, ModelPolynomialError> {
    let basis = model.initial.polynomial().basis;
    if let Some(posterior) = model.posterior() {
        let export = polynomial_export(posterior, basis)?;
        return Ok((export.surface, Some(export.covariance)));
    }
    let grid = model.grid();
    let points: Vec<_> = (0..grid.nodes())
        .map(|node| {
            let (x, y) = grid.coordinates(node);
            (x, y, model.drag_coefficient().value_at_node(node), 1.0)
        })
        .collect();
    Ok((surface::fit(basis, &points)?.surface, None))
}

/// What each coefficient of a drag polynomial multiplies, of Mach number M and lift coefficient CL.
const fn terms(basis: Basis) -> [&'static str; COEFFICIENTS] {
    match basis {
        Basis::SeparableQuadratic => ["1", "M", "M^2", "CL^2", "M CL^2", "M^2 CL^2"],
        Basis::FullQuadratic => ["1", "M", "CL", "M^2", "M CL", "CL^2"],
    }
}
