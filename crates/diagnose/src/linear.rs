//! Small dense linear algebra over faer: one Cholesky factor with what the search asks of it.

use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Mat, MatRef, Par, Side};

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

/// `C −= AᵀB`, in place.
pub(crate) fn subtract_product(from: &mut Mat<f64>, a: &Mat<f64>, b: &Mat<f64>) {
    faer::linalg::matmul::matmul(
        from.as_mut(),
        faer::Accum::Add,
        a.transpose(),
        b.as_ref(),
        -1.0,
        Par::Seq,
    );
}

/// `C += ZᵀZ`, lower triangle only.
pub(crate) fn add_gram(into: &mut Mat<f64>, rows: MatRef<'_, f64>) {
    add_symmetric(into, rows.transpose(), 1.0);
}

/// `C −= ZZᵀ`, lower triangle only.
pub(crate) fn subtract_gram(from: &mut Mat<f64>, columns: &Mat<f64>) {
    add_symmetric(from, columns.as_ref(), -1.0);
}

/// `C += share·AAᵀ`, lower triangle only.
fn add_symmetric(into: &mut Mat<f64>, left: MatRef<'_, f64>, share: f64) {
    use faer::linalg::matmul::triangular::{BlockStructure, matmul};
    matmul(
        into.as_mut(),
        BlockStructure::TriangularLower,
        faer::Accum::Add,
        left,
        BlockStructure::Rectangular,
        left.transpose(),
        BlockStructure::Rectangular,
        share,
        Par::Seq,
    );
}

/// Some rows and columns of a matrix, in this order.
pub(crate) fn gather(from: &Mat<f64>, rows: &[usize], columns: &[usize]) -> Mat<f64> {
    let mut into = Mat::<f64>::zeros(rows.len(), columns.len());
    // Most rows are neighbors, which are copied together.
    let runs: Vec<&[usize]> = rows.chunk_by(|a, b| a + 1 == *b).collect();
    for (k, &column) in columns.iter().enumerate() {
        let from = from.col_as_slice(column);
        let mut rest = into.col_as_slice_mut(k);
        for run in &runs {
            let (values, after) = rest.split_at_mut(run.len());
            values.copy_from_slice(&from[run[0]..run[0] + run.len()]);
            rest = after;
        }
    }
    into
}

/// Copies the lower triangle to the upper one.
pub(crate) fn symmetrize(matrix: &mut Mat<f64>) {
    for column in 1..matrix.ncols() {
        for row in 0..column {
            matrix[(row, column)] = matrix[(column, row)];
        }
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

    #[test]
    fn gathered_by_hand() {
        let from = Mat::from_fn(4, 3, |i, j| 10.0 * i as f64 + j as f64);
        let found = gather(&from, &[3, 0, 1, 1], &[2, 0]);
        let expected = [[32.0, 30.0], [2.0, 0.0], [12.0, 10.0], [12.0, 10.0]];
        assert_eq!(found, Mat::from_fn(4, 2, |i, j| expected[i][j]));
        assert_eq!(gather(&from, &[], &[1]).nrows(), 0);
    }

    #[test]
    fn gram_by_hand() {
        let rows = Mat::from_fn(2, 2, |i, j| [[1.0, 2.0], [3.0, 4.0]][i][j]);
        let mut gram = Mat::zeros(2, 2);
        add_gram(&mut gram, rows.as_ref());
        symmetrize(&mut gram);
        assert!((gram[(0, 1)] - 14.0).abs() < 1e-15 && (gram[(1, 1)] - 20.0).abs() < 1e-15);
        // Rows instead of columns: [1, 2]·[3, 4] = 11, and 1 + 4 = 5 is taken from 10.
        subtract_gram(&mut gram, &rows);
        assert!((gram[(1, 0)] - 3.0).abs() < 1e-15 && (gram[(0, 0)] - 5.0).abs() < 1e-15);
    }
}
