//! Sums over the flights of one channel from which its Gram matrix follows in closed form, whatever the noise: rows are looked
//! at once, however often noise is turned.
//!
//! With D the segments' own variance and U the loadings of a flight at factors of 1, w and b the factors within flights and
//! between them, ρ = b/w:
//!
//! ```text
//! UᵀD⁻¹U = QΛQᵀ,   p = XᵀD⁻¹UQ
//! w² Xᵀ(w²D + b²UUᵀ)⁻¹X = Σ XᵀD⁻¹X − Σ_r ρ²/(1 + ρ²λ_r)·p_r p_rᵀ
//! ln|w²D + b²UUᵀ| = ln|D| + n ln w² + Σ_r ln(1 + ρ²λ_r)                                    [diagnosis.40]
//! ```
//!
//! A flight of which only a share counts, because knowledge ages, adds that share of each.

use core::ops::Range;

use faer::{Mat, Side};

use crate::learning::outliers::Weights;
use crate::learning::rows::ChannelRows;
use crate::math::gram::Sum;
use crate::math::linear::subtract_gram;

/// Sums over rows whose noise has factors of 1.
pub(super) struct ChannelSums {
    /// Σ XᵀD⁻¹X, the residual as last column.
    own: Mat<f64>,
    /// p of every loading of every flight, one column each.
    common: Mat<f64>,
    /// Their λ, and the share of their flight that counts.
    eigenvalues: Vec<(f64, f64)>,
    /// Number of values, each as far as its flight counts.
    pub(super) values: f64,
}

impl ChannelSums {
    pub(super) fn new(rows: &ChannelRows, weights: &Weights) -> Self {
        let size = rows.columns.ncols();
        let rank = rows.loadings.len();
        let mut own = Sum::new(size);
        let mut common = Mat::<f64>::zeros(size, rank * rows.groups.len());
        let mut eigenvalues = vec![(0.0, 0.0); rank * rows.groups.len()];
        let mut values = 0.0;
        for (group, range) in rows.groups.iter().enumerate() {
            let share = rows.shares[group];
            values += share * range.len() as f64;
            let scale = scales(rows, weights, group);
            let white = whitened(rows, range, &scale);
            own.add(&white, range.len() as f64);
            let of_group = 1.0 / (share * weights.groups[group]).sqrt();
            let loadings = Mat::from_fn(range.len(), rank, |at, r| {
                rows.loadings[r][range.start + at] * scale[at] * of_group
            });
            let Ok(eigen) = (loadings.transpose() * &loadings).self_adjoint_eigen(Side::Lower)
            else {
                continue;
            };
            let rotated = &loadings * eigen.U();
            let projected = white.transpose() * &rotated;
            for r in 0..rank {
                let column = rank * group + r;
                eigenvalues[column] = (eigen.S().column_vector()[r].max(0.0), share);
                common.col_as_slice_mut(column).copy_from_slice(projected.col_as_slice(r));
            }
        }
        Self { own: own.finish().matrix, common, eigenvalues, values }
    }

    /// Σ XᵀD⁻¹X alone, the residual as last column.
    pub(super) fn own(rows: &ChannelRows, weights: &Weights) -> Mat<f64> {
        let mut own = Sum::new(rows.columns.ncols());
        for (group, range) in rows.groups.iter().enumerate() {
            let white = whitened(rows, range, &scales(rows, weights, group));
            own.add(&white, range.len() as f64);
        }
        own.finish().matrix
    }

    /// Gram matrix at a ratio ρ of the noise between flights over that within, times w²; lower triangle. And Σ ln(1 + ρ²λ).
    pub(super) fn gram(&self, ratio: f64) -> (Mat<f64>, f64) {
        let square = ratio * ratio;
        let mut gram = self.own.clone();
        let mut scaled = self.common.clone();
        let mut ln_common = 0.0;
        for (column, (value, of_flight)) in self.eigenvalues.iter().enumerate() {
            let share = ratio / (square * value + 1.0).sqrt();
            for slot in scaled.col_as_slice_mut(column) {
                *slot *= share;
            }
            ln_common += of_flight * (square * value).ln_1p();
        }
        subtract_gram(&mut gram, &scaled);
        (gram, ln_common)
    }
}

/// One over the standard deviation of each row of a group.
fn scales(rows: &ChannelRows, weights: &Weights, group: usize) -> Vec<f64> {
    let share = rows.shares[group];
    let of_row = |row: usize| (share * weights.rows[row] / rows.variance[row]).sqrt();
    rows.groups[group].clone().map(of_row).collect()
}

/// The rows of a group, each times its scale.
fn whitened(rows: &ChannelRows, range: &Range<usize>, scale: &[f64]) -> Mat<f64> {
    let mut white = Mat::<f64>::zeros(range.len(), rows.columns.ncols());
    for column in 0..white.ncols() {
        let from = &rows.columns.col_as_slice(column)[range.clone()];
        let into = white.col_as_slice_mut(column);
        for ((into, from), scale) in into.iter_mut().zip(from).zip(scale) {
            *into = from * scale;
        }
    }
    white
}

#[cfg(test)]
mod tests {
    use faer::linalg::solvers::Solve;

    use super::*;

    /// Numbers without order, from −½ to ½: the golden ratio's multiples.
    fn number(k: &mut f64) -> f64 {
        *k += 1.0;
        (*k * 0.618_033_988_749_895).fract() - 0.5
    }

    /// The same by the covariance of each flight, inverted (faer's Cholesky solver).
    #[test]
    fn gram_is_that_of_the_inverse_covariance_at_any_noise() {
        let (count, columns, mut k) = (11, 4, 0.0);
        let rows = ChannelRows {
            columns: Mat::from_fn(count, columns, |_, _| number(&mut k)),
            variance: (0..count).map(|_| 1.0 + number(&mut k)).collect(),
            loadings: (0..2).map(|_| (0..count).map(|_| number(&mut k)).collect()).collect(),
            groups: vec![0..4, 4..5, 5..11],
            shares: vec![0.3, 1.0, 0.8],
        };
        let weights = Weights {
            rows: (0..count).map(|_| 0.7 + number(&mut k)).collect(),
            groups: vec![1.0, 0.3, 0.8],
        };
        let sums = ChannelSums::new(&rows, &weights);
        for (within, between) in [(0.3, 1.9), (1.7, 0.4)] {
            let mut expected = Mat::<f64>::zeros(columns, columns);
            let mut ln_determinant = 0.0;
            for (group, range) in rows.groups.iter().enumerate() {
                let part = rows.columns.subrows(range.start, range.len()).to_owned();
                let covariance = Mat::from_fn(range.len(), range.len(), |i, j| {
                    let (i, j) = (range.start + i, range.start + j);
                    let own = if i == j { rows.variance[i] / weights.rows[i] } else { 0.0 };
                    let common: f64 = rows.loadings.iter().map(|u| u[i] * u[j]).sum();
                    within * within * own + between * between * common / weights.groups[group]
                });
                let share = rows.shares[group];
                ln_determinant += share * covariance.determinant().ln();
                let inverse = covariance.llt(Side::Lower).unwrap().solve(&part);
                expected += faer::Scale(share) * (part.transpose() * inverse);
            }
            let (gram, ln_common) = sums.gram(between / within);
            for column in 0..columns {
                for row in column..columns {
                    let found = gram[(row, column)] / (within * within);
                    let known = expected[(row, column)];
                    assert!((found - known).abs() < 1e-9 * (1.0 + known.abs()), "{found} {known}");
                }
            }
            let own: f64 = rows
                .groups
                .iter()
                .zip(&rows.shares)
                .flat_map(|(range, share)| range.clone().map(move |row| (row, share)))
                .map(|(row, share)| {
                    share * (within * within * rows.variance[row] / weights.rows[row]).ln()
                })
                .sum();
            assert!((own + ln_common - ln_determinant).abs() < 1e-10);
        }
    }
}
