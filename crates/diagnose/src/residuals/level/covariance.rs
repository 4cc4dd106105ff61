//! The variance of what a model has learnt, as one quadratic form.

use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::{Accum, Mat, MatRef, Par};

use crate::baseline::Baseline;
use crate::math::cholesky::Cholesky;

/// Points whose variances are computed together: enough that their product with the covariance's factor is most of the work.
pub(super) const TOGETHER: usize = 32;

/// Lower Cholesky factor of the covariance of remainder terms, drag rises and loadings of the drag table.
#[derive(Clone, Debug)]
pub(super) struct Covariance {
    factor: Mat<f64>,
}

impl Covariance {
    /// `rises` are places among the standing effects; `None` where the covariance is not positive definite.
    pub(super) fn new(baseline: &Baseline, rises: &[usize]) -> Option<Self> {
        let layout = baseline.layout();
        let standing = layout.standing_effects.start;
        let columns: Vec<usize> = layout
            .remainder
            .clone()
            .chain(rises.iter().map(|place| standing + place))
            .chain(layout.drag)
            .collect();
        let rows = baseline.factor();
        let rows =
            Mat::from_fn(columns.len(), rows.ncols(), |row, column| rows[(columns[row], column)]);
        let factor = Cholesky::new(&(&rows * rows.transpose()))?;
        Some(Self { factor: factor.lower().clone() })
    }

    pub(super) fn width(&self) -> usize {
        self.factor.nrows()
    }

    /// The variance at each of [`TOGETHER`] points of what leans on the columns so, column after column.
    ///
    /// ```text
    /// V = |xᵀL|²
    /// ```
    pub(super) fn variances(&self, loadings: &[f64]) -> [f64; TOGETHER] {
        let width = self.width();
        let mut turned = Mat::<f64>::zeros(TOGETHER, width);
        matmul(
            turned.as_mut(),
            BlockStructure::Rectangular,
            Accum::Replace,
            MatRef::from_column_major_slice(loadings, TOGETHER, width),
            BlockStructure::Rectangular,
            self.factor.as_ref(),
            BlockStructure::TriangularLower,
            1.0,
            Par::Seq,
        );
        let mut variances = [0.0; TOGETHER];
        for column in 0..width {
            for (variance, value) in variances.iter_mut().zip(turned.col_as_slice(column)) {
                *variance += value * value;
            }
        }
        variances
    }
}
