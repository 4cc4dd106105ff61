//! Polynomial surfaces of six coefficients, and their least-squares fit.
//!
//! The fit goes through an orthogonal decomposition (Householder QR, then the singular values of its 6×6 triangle)
//! and never through normal equations, which would square the condition number.

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};
use serde::{Deserialize, Serialize};

mod beside;
mod error;

pub use beside::{FitBeside, fit_beside};
pub use error::{FitError, Undetermined};

/// Number of coefficients of either basis.
pub const COEFFICIENTS: usize = 6;

/// Smallest singular value, relative to the largest, that still counts as determined. Taken of the design whose
/// columns are scaled to length 1, so that the units of x and y do not matter. At 1e-10 the worst direction keeps about
/// six of a double's sixteen digits. Book `[tables.9]`.
const RANK_TOLERANCE: f64 = 1e-10;

/// The six functions of x and y that a surface is a sum of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Basis {
    /// `1, y, y², x², x² y, x² y²`: a parabola in x whose two coefficients are parabolas in y,
    /// `p0 + p1 y + p2 y² + (p3 + p4 y + p5 y²) x²`.
    SeparableQuadratic,
    /// `1, y, x, y², x y, x²`: every quadratic in x and y.
    FullQuadratic,
}

/// A polynomial surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// The functions that the coefficients multiply.
    pub basis: Basis,
    /// The coefficients in the basis' order.
    pub coefficients: [f64; COEFFICIENTS],
}

/// A surface fitted to points, and how well they determine it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The surface.
    pub surface: Surface,
    /// Rank of the design: always 6, because a lower rank is refused.
    pub rank: usize,
    /// Ratio of largest to smallest singular value of the weighted design √w·X, columns not scaled.
    pub condition_number: f64,
    /// Root of the weighted mean of squared residuals, √(Σ w r² / Σ w).
    pub residual_rms: f64,
}

impl Basis {
    /// The six functions at a point.
    ///
    /// # Source
    /// Book `[tables.6]`, `[tables.7]`; Ghazi et al. 2020, equation (15), whose printed form is open.
    #[must_use]
    #[inline]
    pub fn row(self, x: f64, y: f64) -> [f64; COEFFICIENTS] {
        match self {
            Self::SeparableQuadratic => {
                let (xx, yy) = (x * x, y * y);
                [1.0, y, yy, xx, xx * y, xx * yy]
            }
            Self::FullQuadratic => [1.0, y, x, y * y, x * y, x * x],
        }
    }

    /// How many different values of x (for the first basis: of |x|) and of y the points must have.
    pub(crate) const fn distinct_needed(self) -> (usize, usize) {
        match self {
            Self::SeparableQuadratic => (2, 3),
            Self::FullQuadratic => (3, 3),
        }
    }
}

impl Surface {
    /// The surface's value.
    #[must_use]
    #[inline]
    pub fn value(&self, x: f64, y: f64) -> f64 {
        let row = self.basis.row(x, y);
        row.iter().zip(&self.coefficients).map(|(term, coefficient)| term * coefficient).sum()
    }
}

/// Fits a surface to points `(x, y, z, weight)` by weighted least squares: minimises Σ weight·(z − surface)².
///
/// ```
/// use lut::surface::{Basis, fit};
///
/// let truth = |x: f64, y: f64| 0.02 + 0.01 * y + (0.05 + 0.03 * y * y) * x * x;
/// let points: Vec<_> = (0..20)
///     .map(|i| (0.1 + 0.1 * f64::from(i % 5), 0.5 + 0.1 * f64::from(i / 5)))
///     .map(|(x, y)| (x, y, truth(x, y), 1.0))
///     .collect();
/// let fit = fit(Basis::SeparableQuadratic, &points)?;
/// assert!((fit.surface.value(0.33, 0.66) - truth(0.33, 0.66)).abs() < 1e-12);
/// # Ok::<(), lut::surface::FitError>(())
/// ```
///
/// # Errors
/// [`FitError`] where a number is not finite, a weight is negative, fewer than six points have a positive weight, or
/// the points leave a direction undetermined.
///
/// # Source
/// Book `[tables.8]`; Ghazi et al. 2020, equation (29) without its normal equations.
pub fn fit(basis: Basis, points: &[(f64, f64, f64, f64)]) -> Result<Fit, FitError> {
    check(basis, points)?;
    let (design, mut target) = weighted(basis, points);

    let qr = design.qr();
    let triangle: Matrix6<f64> = qr.r().fixed_view::<COEFFICIENTS, COEFFICIENTS>(0, 0).into();
    qr.q_tr_mul(&mut target);

    // R has the design's singular values. The rank is judged on columns of length 1, the solution on R as it is.
    let mut scaled = triangle;
    for mut column in scaled.column_iter_mut() {
        let length = column.norm();
        if length > 0.0 {
            column /= length;
        }
    }
    let condition_number = condition_number(&triangle);
    let singular = scaled.svd(false, true);
    let largest = singular.singular_values.max();
    let rank = singular.rank(RANK_TOLERANCE * largest);
    let right_hand_side: Vector6<f64> = target.fixed_rows::<COEFFICIENTS>(0).into();
    let solution = triangle.solve_upper_triangular(&right_hand_side);
    let Some(solution) = solution.filter(|_| rank == COEFFICIENTS) else {
        let null = singular.v_t.map(|v_t| v_t.row(COEFFICIENTS - 1).transpose());
        let undetermined = error::undetermined(basis, points, null.as_ref());
        return Err(FitError::RankDeficient { rank, condition_number, undetermined });
    };

    let surface = Surface { basis, coefficients: solution.into() };
    let (mut squares, mut weights) = (0.0, 0.0);
    for &(x, y, z, weight) in points {
        let residual = z - surface.value(x, y);
        squares += weight * residual * residual;
        weights += weight;
    }
    Ok(Fit { surface, rank, condition_number, residual_rms: (squares / weights).sqrt() })
}

/// The design and what it is fitted to, each row times the root of its weight.
fn weighted(basis: Basis, points: &[(f64, f64, f64, f64)]) -> (DMatrix<f64>, DVector<f64>) {
    let roots: Vec<f64> = points.iter().map(|&(_, _, _, weight)| weight.sqrt()).collect();
    let design = DMatrix::from_fn(points.len(), COEFFICIENTS, |i, k| {
        let (x, y, _, _) = points[i];
        roots[i] * basis.row(x, y)[k]
    });
    let values = points.iter().zip(&roots).map(|(point, root)| root * point.2);
    (design, DVector::from_iterator(points.len(), values))
}

fn check(basis: Basis, points: &[(f64, f64, f64, f64)]) -> Result<(), FitError> {
    for (index, &(x, y, z, weight)) in points.iter().enumerate() {
        if !(weight.is_finite() && weight >= 0.0) {
            return Err(FitError::WeightInvalid { index, weight });
        }
        // Squares of huge coordinates overflow: the decomposition would never terminate on an infinity.
        let row = basis.row(x, y);
        if !row.iter().chain([&x, &y, &z]).all(|number| (number * number * weight).is_finite()) {
            return Err(FitError::NotFinite { index, x, y, z });
        }
    }
    let weighted = points.iter().filter(|point| point.3 > 0.0).count();
    if weighted < COEFFICIENTS {
        return Err(FitError::TooFewPoints { points: weighted });
    }
    Ok(())
}

fn condition_number(triangle: &Matrix6<f64>) -> f64 {
    let values = triangle.singular_values();
    values.max() / values.min()
}
