//! Whitening: rows of a flight scaled so that their noise is independent and of unit variance.
//!
//! Difficult: the covariance of a flight is block diagonal by segment plus a few common errors. Segments are whitened
//! by their own small Cholesky factor, then the flight by (1 + UUᵀ)^(−1/2), which differs from 1 only in the span of the
//! few columns of U. That is exact, and linear in segments.

use faer::{Mat, Side};

use crate::math::cholesky::solve_small_lower;
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::signals::channels::ByChannel;

/// L⁻¹·values with the segment's own Cholesky factor.
pub(crate) fn whiten_within_segment(
    row: &SegmentRow,
    values: &ByChannel,
    channels: usize,
) -> ByChannel {
    solve_small_lower(&row.noise.factor, values, channels)
}

/// Loadings on what the segments of a flight have in common, each segment whitened by its own noise: U, in so many rows.
pub(crate) fn common_loadings(
    data: &PreparedFlights<'_>,
    segments: &[SegmentRow],
    rows: usize,
) -> Mat<f64> {
    let channels = data.channels.count();
    let rank = segments.first().map_or(0, |row| row.noise.common.len());
    let mut common = Mat::<f64>::zeros(rows, rank);
    for (index, row) in segments.iter().enumerate() {
        for (column, loading) in row.noise.common.iter().enumerate() {
            let white = whiten_within_segment(row, loading, channels);
            for channel in 0..channels {
                common[(index * channels + channel, column)] = white[channel];
            }
        }
    }
    common
}

/// Multiplies the rows of every segment by its weight.
fn weigh(data: &PreparedFlights<'_>, segments: &[SegmentRow], rows: &mut Mat<f64>) {
    let channels = data.channels.count();
    for (index, row) in segments.iter().enumerate().filter(|(_, row)| row.weight < 1.0) {
        for place in index * channels..(index + 1) * channels {
            for column in 0..rows.ncols() {
                rows[(place, column)] *= row.weight;
            }
        }
    }
}

/// Whitens what the segments of a flight have in common, rows ← (1 + UUᵀ)^(−1/2)·rows, and weighs them.
///
/// ```text
/// UᵀU = QΛQᵀ,  V = UQΛ^(−1/2),  (1 + UUᵀ)^(−1/2) = 1 − V·diag(1 − (1 + λ)^(−1/2))·Vᵀ        [diagnosis.16]
/// ```
///
/// Returns `ln|1 + UᵀU|`, what the common errors add to the ln of the covariance's determinant.
pub(crate) fn whiten_flight(
    data: &PreparedFlights<'_>,
    segments: &[SegmentRow],
    matrix: &mut Mat<f64>,
) -> f64 {
    let common = common_loadings(data, segments, matrix.nrows());
    let rank = common.ncols();
    let inner = common.transpose() * &common;
    let Ok(eigen) = inner.self_adjoint_eigen(Side::Lower) else { return 0.0 };
    let rotated = &common * eigen.U();
    let values = eigen.S().column_vector();
    let mut basis = Mat::<f64>::zeros(matrix.nrows(), rank);
    let mut shrunk = Mat::<f64>::zeros(matrix.nrows(), rank);
    let mut ln_determinant = 0.0;
    for column in 0..rank {
        let value = values[column];
        ln_determinant += value.max(0.0).ln_1p();
        if value <= 1e-12 {
            continue;
        }
        let shrink = 1.0 - 1.0 / (1.0 + value).sqrt();
        for row in 0..matrix.nrows() {
            basis[(row, column)] = rotated[(row, column)] / value.sqrt();
            shrunk[(row, column)] = shrink * basis[(row, column)];
        }
    }
    let projected = basis.transpose() * &*matrix;
    faer::linalg::matmul::matmul(
        matrix.as_mut(),
        faer::Accum::Add,
        shrunk.as_ref(),
        projected.as_ref(),
        -1.0,
        faer::Par::Seq,
    );
    weigh(data, segments, matrix);
    ln_determinant
}
