//! Small dense linear algebra over faer: products into one triangle, parts of a matrix.

use faer::{Mat, MatRef, Par};

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

/// `C −= AᵀA` of a symmetric C, both triangles.
pub(crate) fn subtract_own_product(from: &mut Mat<f64>, columns: &Mat<f64>) {
    add_symmetric(from, columns.transpose(), -1.0);
    symmetrize(from);
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
