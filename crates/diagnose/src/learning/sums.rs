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

use faer::Mat;

use crate::learning::outliers::Weights;
use crate::learning::rows::ChannelRows;
use crate::learning::turned::TurnedFlights;
use crate::math::linear::{add_gram, subtract_gram, symmetrize};

/// Rows that are multiplied together. Our choice: products are fast, and what waits for them is small.
const ROWS_TOGETHER: usize = 384;
/// Columns that are turned into rows together. Our choice: one line of a cache.
const COLUMNS_TOGETHER: usize = 8;

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
    pub(super) fn new(rows: &ChannelRows, weights: &Weights, turned: &mut TurnedFlights) -> Self {
        let size = rows.columns.ncols();
        let rank = rows.loadings.len();
        let mut own = Mat::<f64>::zeros(size, size);
        let turned_of = |range: &Range<usize>| rank.min(range.len());
        let mut common = Mat::<f64>::zeros(size, rows.groups.iter().map(turned_of).sum());
        let mut eigenvalues = Vec::with_capacity(common.ncols());
        let scales = scales(rows, weights);
        for together in together(rows) {
            let first = rows.groups[together.start].start;
            let white = whitened(rows, &together, &scales);
            add_gram(&mut own, white.transpose());
            for group in together {
                let range = rows.groups[group].clone();
                let share = rows.shares[group];
                let of_group = 1.0 / (share * weights.groups[group]).sqrt();
                let flight = turned.flight(rows, group, &scales);
                let at = eigenvalues.len();
                let squared = |length: &f64| (of_group * of_group * length, share);
                eigenvalues.extend(flight.lengths.iter().map(squared));
                for (r, loading) in flight.loadings.iter().enumerate() {
                    let into = common.col_as_slice_mut(at + r);
                    for (row, u) in loading.iter().enumerate() {
                        let values = white.col_as_slice(range.start - first + row);
                        let by = of_group * u;
                        for (into, value) in into.iter_mut().zip(values) {
                            *into += by * value;
                        }
                    }
                }
            }
        }
        symmetrize(&mut own);
        let counted = |(range, share): (&Range<usize>, &f64)| share * range.len() as f64;
        let values = rows.groups.iter().zip(&rows.shares).map(counted).sum();
        Self { own, common, eigenvalues, values }
    }

    /// Σ XᵀD⁻¹X alone, the residual as last column.
    pub(super) fn own(rows: &ChannelRows, weights: &Weights) -> Mat<f64> {
        let size = rows.columns.ncols();
        let mut own = Mat::<f64>::zeros(size, size);
        let scales = scales(rows, weights);
        for together in together(rows) {
            add_gram(&mut own, whitened(rows, &together, &scales).transpose());
        }
        symmetrize(&mut own);
        own
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

/// Rows through the inverse of their noise: w²C⁻¹X of the columns without the residual, at a ratio ρ of the noise between flights
/// over that within.
pub(super) fn through_noise(
    rows: &ChannelRows,
    weights: &Weights,
    ratio: f64,
    turned: &mut TurnedFlights,
) -> Mat<f64> {
    let square = ratio * ratio;
    let scales = scales(rows, weights);
    let mut through = Mat::<f64>::zeros(rows.variance.len(), rows.width());
    for (group, range) in rows.groups.iter().enumerate() {
        let of_group = square / (rows.shares[group] * weights.groups[group]);
        let flight = turned.flight(rows, group, &scales);
        let scales = &scales[range.clone()];
        for column in 0..rows.width() {
            let from = &rows.columns.col_as_slice(column)[range.clone()];
            let into = &mut through.col_as_slice_mut(column)[range.clone()];
            for ((slot, value), scale) in into.iter_mut().zip(from).zip(scales) {
                *slot = value * scale;
            }
            for (loading, length) in flight.loadings.iter().zip(&flight.lengths) {
                let common: f64 = loading.iter().zip(&*into).map(|(u, x)| u * x).sum();
                let by = common * of_group / (of_group * length + 1.0);
                for (slot, u) in into.iter_mut().zip(loading) {
                    *slot -= by * u;
                }
            }
            for (slot, scale) in into.iter_mut().zip(scales) {
                *slot *= scale;
            }
        }
    }
    through
}

/// Products of the columns with the residual: the last row of the lower triangle of a Gram matrix.
pub(super) fn right_side(gram: &Mat<f64>) -> Vec<f64> {
    let width = gram.nrows() - 1;
    (0..width).map(|column| gram[(width, column)]).collect()
}

/// One over the standard deviation of each row.
fn scales(rows: &ChannelRows, weights: &Weights) -> Vec<f64> {
    let mut scales = vec![0.0; rows.variance.len()];
    for (range, share) in rows.groups.iter().zip(&rows.shares) {
        for row in range.clone() {
            scales[row] = (share * weights.rows[row] / rows.variance[row]).sqrt();
        }
    }
    scales
}

/// Groups whose rows are multiplied together: a flight alone has too few for fast products.
fn together(rows: &ChannelRows) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    let mut first_row = 0;
    for (group, range) in rows.groups.iter().enumerate() {
        match ranges.last_mut() {
            Some(last) if range.end - first_row <= ROWS_TOGETHER => last.end = group + 1,
            _ => {
                first_row = range.start;
                ranges.push(group..group + 1);
            }
        }
    }
    ranges
}

/// The rows of neighbouring groups, each times its scale, as columns.
fn whitened(rows: &ChannelRows, groups: &Range<usize>, scales: &[f64]) -> Mat<f64> {
    let range = rows.groups[groups.start].start..rows.groups[groups.end - 1].end;
    let scales = &scales[range.clone()];
    let size = rows.columns.ncols();
    let mut white = Mat::<f64>::zeros(size, range.len());
    for first in (0..size).step_by(COLUMNS_TOGETHER) {
        let last = (first + COLUMNS_TOGETHER).min(size);
        let from: Vec<&[f64]> =
            (first..last).map(|column| &rows.columns.col_as_slice(column)[range.clone()]).collect();
        for (at, scale) in scales.iter().enumerate() {
            let into = &mut white.col_as_slice_mut(at)[first..last];
            for (into, from) in into.iter_mut().zip(&from) {
                *into = from[at] * scale;
            }
        }
    }
    white
}

#[cfg(test)]
mod tests {
    use faer::Side;
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
        // One, two and more loadings; more than rows of a flight.
        for loadings in [1, 2, 3, 5] {
            gram_is_that_of_the_inverse_covariance(loadings);
        }
    }

    fn gram_is_that_of_the_inverse_covariance(of: usize) {
        let (count, columns, mut k) = (11, 4, 0.0);
        let rows = ChannelRows {
            columns: Mat::from_fn(count, columns, |_, _| number(&mut k)),
            variance: (0..count).map(|_| 1.0 + number(&mut k)).collect(),
            loadings: (0..of).map(|_| (0..count).map(|_| number(&mut k)).collect()).collect(),
            groups: vec![0..4, 4..5, 5..11],
            shares: vec![0.3, 1.0, 0.8],
        };
        let weights = Weights {
            rows: (0..count).map(|_| 0.7 + number(&mut k)).collect(),
            groups: vec![1.0, 0.3, 0.8],
        };
        let sums = ChannelSums::new(&rows, &weights, &mut TurnedFlights::default());
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
            let through =
                through_noise(&rows, &weights, between / within, &mut TurnedFlights::default());
            let by_rows = through.transpose() * rows.columns.subcols(0, columns - 1);
            for (i, j) in (0..columns - 1).flat_map(|i| (0..columns - 1).map(move |j| (i, j))) {
                let found = by_rows[(i, j)] / (within * within);
                assert!((found - expected[(i, j)]).abs() < 1e-9 * (1.0 + found.abs()));
            }
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
