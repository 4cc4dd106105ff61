//! Whitening: rows of a flight scaled so that their noise is independent and of unit variance.
//!
//! Difficult: the covariance of a flight is block diagonal by segment plus a few common errors. Segments are whitened
//! by their own small Cholesky factor, then the flight by (1 + UUᵀ)^(−1/2), which differs from 1 only in the span of the
//! few columns of U. That is exact, and linear in segments.

use faer::{Mat, Side};

use crate::math::cholesky::solve_small_lower;
use crate::residuals::rows::{FlightRows, SegmentRow};
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

/// Whitens what the segments of a flight have in common, rows ← (1 + UUᵀ)^(−1/2)·rows.
///
/// ```text
/// UᵀU = QΛQᵀ,  V = UQΛ^(−1/2),  (1 + UUᵀ)^(−1/2) = 1 − V·diag(1 − (1 + λ)^(−1/2))·Vᵀ        [diagnosis.16]
/// ```
#[derive(Clone, Debug)]
pub(crate) struct FlightWhitening {
    /// V, and V times what it shrinks by.
    basis: Mat<f64>,
    shrunk: Mat<f64>,
    /// `ln|1 + UᵀU|`, what the common errors add to the ln of the covariance's determinant.
    pub(crate) ln_determinant: f64,
}

impl FlightWhitening {
    /// That of a flight.
    pub(crate) fn new(data: &PreparedFlights<'_>, flight: &FlightRows) -> Self {
        let segments = &data.segments[flight.segments.clone()];
        let rows = segments.len() * data.channels.count() + usize::from(flight.gauge.is_some());
        let common = common_loadings(data, segments, rows);
        let rank = common.ncols();
        let mut found = Self {
            basis: Mat::zeros(rows, rank),
            shrunk: Mat::zeros(rows, rank),
            ln_determinant: 0.0,
        };
        let inner = common.transpose() * &common;
        let Ok(eigen) = inner.self_adjoint_eigen(Side::Lower) else { return found };
        let rotated = &common * eigen.U();
        let values = eigen.S().column_vector();
        for column in 0..rank {
            let value = values[column];
            found.ln_determinant += value.max(0.0).ln_1p();
            if value <= 1e-12 {
                continue;
            }
            let shrink = 1.0 - 1.0 / (1.0 + value).sqrt();
            for row in 0..rows {
                found.basis[(row, column)] = rotated[(row, column)] / value.sqrt();
                found.shrunk[(row, column)] = shrink * found.basis[(row, column)];
            }
        }
        found
    }

    /// Whitens rows of the flight, and weighs them.
    pub(crate) fn whiten(
        &self,
        data: &PreparedFlights<'_>,
        flight: &FlightRows,
        matrix: &mut Mat<f64>,
    ) {
        let projected = self.basis.transpose() * &*matrix;
        faer::linalg::matmul::matmul(
            matrix.as_mut(),
            faer::Accum::Add,
            self.shrunk.as_ref(),
            projected.as_ref(),
            -1.0,
            faer::Par::Seq,
        );
        weigh(data, &data.segments[flight.segments.clone()], matrix);
    }
}
