//! The Cholesky factor of a symmetric positive definite matrix, with what the search asks of it.

use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Mat, Par, Side};

/// Cholesky factor of a symmetric positive definite matrix.
#[derive(Debug)]
pub(crate) struct Factor {
    lower: Mat<f64>,
}

impl Factor {
    /// Factors a matrix by its lower triangle; `None` where it is not positive definite.
    pub(crate) fn of(matrix: &Mat<f64>) -> Option<Self> {
        let llt = matrix.llt(Side::Lower).ok()?;
        let lower = llt.L().to_owned();
        (0..lower.nrows()).all(|k| lower[(k, k)].is_finite()).then_some(Self { lower })
    }

    /// ln of the determinant.
    pub(crate) fn ln_determinant(&self) -> f64 {
        2.0 * (0..self.lower.nrows()).map(|k| self.lower[(k, k)].ln()).sum::<f64>()
    }

    /// L⁻¹·B in place.
    pub(crate) fn half_solve(&self, right: &mut Mat<f64>) {
        solve_lower_triangular_in_place(self.lower.as_ref(), right.as_mut(), Par::Seq);
    }

    /// A⁻¹·B in place.
    pub(crate) fn solve(&self, right: &mut Mat<f64>) {
        self.half_solve(right);
        solve_upper_triangular_in_place(self.lower.transpose(), right.as_mut(), Par::Seq);
    }

    /// The factor.
    pub(crate) const fn lower(&self) -> &Mat<f64> {
        &self.lower
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factor_by_hand() {
        // [[4, 2], [2, 5]]: L = [[2, 0], [1, 2]], determinant 16, solution of [8, 9] is [1.375, 1.25].
        let matrix = Mat::from_fn(2, 2, |i, j| [[4.0, 2.0], [2.0, 5.0]][i][j]);
        let factor = Factor::of(&matrix).unwrap();
        assert!((factor.ln_determinant() - 16.0_f64.ln()).abs() < 1e-15);
        let mut right = Mat::from_fn(2, 1, |i, _| [8.0, 9.0][i]);
        factor.solve(&mut right);
        assert!((right[(0, 0)] - 1.375).abs() < 1e-15 && (right[(1, 0)] - 1.25).abs() < 1e-15);
        assert!(Factor::of(&Mat::from_fn(2, 2, |_, _| -1.0)).is_none());
    }
}
