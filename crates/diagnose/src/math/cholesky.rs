//! The Cholesky factor of a symmetric positive definite matrix, with what the search asks of it.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltParams, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Auto, Mat, Par, Spec};

/// Share of a variance that is nothing but rounding.
const ROUNDING: f64 = 1e-9;

/// Cholesky factor of a symmetric positive definite matrix.
#[derive(Debug)]
pub(crate) struct Cholesky {
    lower: Mat<f64>,
}

impl Cholesky {
    /// Factors a matrix by its lower triangle; `None` where it is not positive definite.
    pub(crate) fn new(matrix: &Mat<f64>) -> Option<Self> {
        Self::in_place(matrix.clone())
    }

    /// The same of a matrix that is needed no more.
    pub(crate) fn in_place(mut matrix: Mat<f64>) -> Option<Self> {
        let parameters: Spec<LltParams, f64> = <LltParams as Auto<f64>>::auto().into();
        let need = cholesky_in_place_scratch::<f64>(matrix.nrows(), Par::Seq, parameters);
        let mut memory = MemBuffer::new(need);
        let (stack, exact) = (MemStack::new(&mut memory), LltRegularization::default());
        cholesky_in_place(matrix.as_mut(), exact, Par::Seq, stack, parameters).ok()?;
        for column in 1..matrix.ncols() {
            matrix.col_as_slice_mut(column)[..column].fill(0.0);
        }
        let is_finite = (0..matrix.nrows()).all(|k| matrix[(k, k)].is_finite());
        is_finite.then_some(Self { lower: matrix })
    }

    /// ln of the determinant.
    pub(crate) fn ln_determinant(&self) -> f64 {
        2.0 * (0..self.lower.nrows()).map(|k| self.lower[(k, k)].ln()).sum::<f64>()
    }

    /// L⁻¹·B in place.
    pub(crate) fn solve_lower(&self, right: &mut Mat<f64>) {
        solve_lower_triangular_in_place(self.lower.as_ref(), right.as_mut(), Par::Seq);
    }

    /// A⁻¹·B in place.
    pub(crate) fn solve(&self, right: &mut Mat<f64>) {
        self.solve_lower(right);
        self.solve_upper(right);
    }

    /// L⁻ᵀ·B in place.
    pub(crate) fn solve_upper(&self, right: &mut Mat<f64>) {
        solve_upper_triangular_in_place(self.lower.transpose(), right.as_mut(), Par::Seq);
    }

    /// The factor.
    pub(crate) const fn lower(&self) -> &Mat<f64> {
        &self.lower
    }
}

/// Lower Cholesky factor of the first `count` rows of a small covariance whose diagonal is positive, on the stack. Its sums
/// run in another order than faer's, so that the two agree to rounding only.
pub(crate) fn small_cholesky<const N: usize>(
    covariance: &[[f64; N]; N],
    count: usize,
) -> [[f64; N]; N] {
    // Every row has a variance of its own; the floor only guards against a sensor declared perfect.
    small_lower(covariance, count, |left, _| left.max(1e-14).sqrt())
}

/// The same of a covariance that may be singular: columns to which nothing new is left are zero. A variance below a billionth of
/// a row's own is rounding.
pub(crate) fn semidefinite_cholesky<const N: usize>(
    covariance: &[[f64; N]; N],
    count: usize,
) -> [[f64; N]; N] {
    let is_new = |left: f64, variance: f64| left > ROUNDING * variance;
    let pivot = |left: f64, variance| if is_new(left, variance) { left.sqrt() } else { 0.0 };
    small_lower(covariance, count, pivot)
}

/// Rows of a factor one by one; `pivot` makes an entry of the diagonal of what is left of a row's variance, and of that variance.
fn small_lower<const N: usize>(
    covariance: &[[f64; N]; N],
    count: usize,
    pivot: impl Fn(f64, f64) -> f64,
) -> [[f64; N]; N] {
    let mut factor = [[0.0; N]; N];
    for row in 0..count {
        for column in 0..=row {
            let inner: f64 = (0..column).map(|k| factor[row][k] * factor[column][k]).sum();
            let left = covariance[row][column] - inner;
            factor[row][column] = if row == column {
                pivot(left, covariance[row][row])
            } else if factor[column][column] > 0.0 {
                left / factor[column][column]
            } else {
                0.0
            };
        }
    }
    factor
}

/// `L⁻¹·values` with a factor of [`small_cholesky`].
pub(crate) fn solve_small_lower<const N: usize>(
    factor: &[[f64; N]; N],
    values: &[f64; N],
    count: usize,
) -> [f64; N] {
    let mut solved = [0.0; N];
    for row in 0..count {
        let inner: f64 = (0..row).map(|k| factor[row][k] * solved[k]).sum();
        solved[row] = (values[row] - inner) / factor[row][row];
    }
    solved
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factor_by_hand() {
        // [[4, 2], [2, 5]]: L = [[2, 0], [1, 2]], determinant 16, solution of [8, 9] is [1.375, 1.25].
        let matrix = Mat::from_fn(2, 2, |i, j| [[4.0, 2.0], [2.0, 5.0]][i][j]);
        let factor = Cholesky::new(&matrix).unwrap();
        assert!((factor.ln_determinant() - 16.0_f64.ln()).abs() < 1e-15);
        let mut right = Mat::from_fn(2, 1, |i, _| [8.0, 9.0][i]);
        factor.solve(&mut right);
        assert!((right[(0, 0)] - 1.375).abs() < 1e-15 && (right[(1, 0)] - 1.25).abs() < 1e-15);
        assert!(Cholesky::new(&Mat::from_fn(2, 2, |_, _| -1.0)).is_none());
    }

    /// By hand: (2, 1)(2, 1)ᵀ + (0, 0, 3)(0, 0, 3)ᵀ has rank 2, and the factor its two columns in their places.
    #[test]
    fn a_singular_covariance_has_a_factor_with_columns_of_zeros() {
        let covariance = [[4.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 9.0]];
        let factor = semidefinite_cholesky(&covariance, 3);
        assert_eq!(factor, [[2.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 3.0]]);
        assert_eq!(semidefinite_cholesky(&[[0.0; 3]; 3], 3), [[0.0; 3]; 3]);
    }
}
