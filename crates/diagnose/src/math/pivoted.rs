//! Which few columns of a Gram matrix hold all of it: the pivoted Cholesky decomposition.

use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::{Mat, Par};

/// Columns of a positive semidefinite matrix that hold the rest of it, and how they do.
#[derive(Clone, Debug)]
pub(crate) struct Pivoted {
    /// Columns, in the order in which they were chosen.
    pub(crate) pivots: Vec<usize>,
    /// Every column as a combination of the pivots: pivots × columns.
    pub(crate) transfer: Mat<f64>,
}

/// Pivots of the first `size` rows and columns, until no diagonal has more than `left` left.
///
/// ```text
/// A ≈ L Lᵀ,   T = (L Lₚ⁻¹)ᵀ,   A ≈ Tᵀ A_pp T,   Lₚ the rows of L at the pivots
/// ```
///
/// # Source
/// Harbrecht, Peters and Schneider 2012, doi 10.1016/j.apnum.2011.10.001.
pub(crate) fn pivoted(matrix: &Mat<f64>, size: usize, left: f64) -> Pivoted {
    let mut diagonal: Vec<f64> = (0..size).map(|k| matrix[(k, k)]).collect();
    let mut pivots: Vec<usize> = Vec::new();
    let mut factor: Vec<Vec<f64>> = Vec::new();
    while pivots.len() < size {
        let largest =
            (0..size).max_by(|&a, &b| diagonal[a].total_cmp(&diagonal[b]).then(b.cmp(&a)));
        let Some(pivot) = largest.filter(|&k| diagonal[k] > left) else { break };
        let mut column = matrix.col_as_slice(pivot)[..size].to_vec();
        for known in &factor {
            let by = known[pivot];
            for (value, known) in column.iter_mut().zip(known) {
                *value -= by * known;
            }
        }
        let root = diagonal[pivot].sqrt();
        for (value, diagonal) in column.iter_mut().zip(&mut diagonal) {
            *value /= root;
            *diagonal -= *value * *value;
        }
        diagonal[pivot] = f64::NEG_INFINITY;
        for &earlier in &pivots {
            column[earlier] = 0.0;
        }
        pivots.push(pivot);
        factor.push(column);
    }
    let rank = pivots.len();
    // Lₚ is lower triangular in the order of the pivots; T = Lₚ⁻ᵀ Lᵀ.
    let at_pivots = Mat::from_fn(rank, rank, |i, j| factor[j][pivots[i]]);
    let mut transfer = Mat::from_fn(rank, size, |k, column| factor[k][column]);
    solve_upper_triangular_in_place(at_pivots.transpose(), transfer.as_mut(), Par::Seq);
    Pivoted { pivots, transfer }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: the third column is the first plus twice the second, so that two pivots hold all three.
    #[test]
    fn a_column_that_others_hold_is_no_pivot() {
        let rows = [[1.0, 0.0, 1.0], [0.0, 1.0, 2.0], [1.0, 1.0, 3.0], [2.0, -1.0, 0.0]];
        let raw = Mat::from_fn(4, 3, |i, j| rows[i][j]);
        let gram = raw.transpose() * &raw;
        let found = pivoted(&gram, 3, 1e-9);
        assert_eq!(found.pivots.len(), 2);
        for column in 0..3 {
            for row in 0..4 {
                let combined: f64 =
                    (0..2).map(|k| raw[(row, found.pivots[k])] * found.transfer[(k, column)]).sum();
                assert!((combined - raw[(row, column)]).abs() < 1e-12, "{row} {column}");
            }
        }
    }
}
