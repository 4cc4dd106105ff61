//! The six-coefficient polynomial nearest to a posterior, with its covariance.

use faer::Mat;
use lut::surface::{self, Basis, COEFFICIENTS, FitError, Surface};

use super::Posterior;

/// A polynomial surface of drag over (lift coefficient, Mach number) and its uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub struct PolynomialExport {
    /// The surface.
    pub surface: Surface,
    /// Covariance of its coefficients, from the table's. It does not include what a polynomial cannot hold.
    pub covariance: [[f64; COEFFICIENTS]; COEFFICIENTS],
    /// What it cannot hold: root of the weighted mean squared difference to the table, in drag coefficient.
    pub residual_rms: f64,
    /// Condition number of the weighted design.
    pub condition_number: f64,
}

/// Why there is no polynomial.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolynomialError {
    /// The grid does not determine it.
    #[error(transparent)]
    Fit(#[from] FitError),
}

/// Fits a polynomial to a posterior's drag table over all nodes, each weighted by its precision.
///
/// The covariance is B·S·Bᵀ with S the nodes' covariance and B the linear map from nodes to coefficients, by QR.
///
/// # Errors
/// [`PolynomialError`] where the grid has too few nodes for six coefficients.
///
/// # Source
/// Book `[bayes.11]`.
pub fn polynomial_export(
    posterior: &Posterior,
    basis: Basis,
) -> Result<PolynomialExport, PolynomialError> {
    let grid = posterior.drag().grid();
    let initial = posterior.initial().values();
    // Standard deviation of each node's drag coefficient.
    let deviations: Vec<f64> =
        initial.iter().zip(posterior.standard_deviation()).map(|(drag, std)| drag * std).collect();
    let points: Vec<(f64, f64, f64, f64)> = (0..grid.nodes())
        .map(|node| {
            let (x, y) = grid.coordinates(node);
            let weight = 1.0 / (deviations[node] * deviations[node]);
            (x, y, posterior.drag().value_at_node(node), weight)
        })
        .collect();
    let fit = surface::fit(basis, &points)?;

    let design = Mat::from_fn(grid.nodes(), COEFFICIENTS, |node, k| {
        let (x, y) = grid.coordinates(node);
        basis.row(x, y)[k] / deviations[node]
    });
    let qr = design.qr();
    let mut map = qr.compute_thin_Q().transpose().to_owned();
    faer::linalg::triangular_solve::solve_upper_triangular_in_place(
        qr.thin_R(),
        map.as_mut(),
        faer::Par::Seq,
    );
    let columns: Vec<Vec<(usize, f64)>> = (0..COEFFICIENTS)
        .map(|k| {
            let of_node = |node: usize| map[(k, node)] / deviations[node] * initial[node];
            (0..grid.nodes()).map(|node| (node, of_node(node))).collect()
        })
        .collect();
    let covariances = posterior.covariances_of(&columns);
    let mut covariance = [[0.0; COEFFICIENTS]; COEFFICIENTS];
    for (row, values) in covariance.iter_mut().zip(&covariances) {
        row.copy_from_slice(values);
    }
    Ok(PolynomialExport {
        surface: fit.surface,
        covariance,
        residual_rms: fit.residual_rms,
        condition_number: fit.condition_number,
    })
}
