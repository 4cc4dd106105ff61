//! Gram matrices of whitened columns: all that the search looks at.

use faer::Mat;

use crate::math::cholesky::Cholesky;
use crate::math::linear::{add_gram, symmetrize};

/// Rows that are multiplied together: a flight alone has too few for fast products.
const WAITING_ROWS: usize = 384;

/// Gram matrix of all columns, and how many recorded values are behind it: a value that counts less is a part of one.
#[derive(Clone, Debug)]
pub(crate) struct Gram {
    pub(crate) matrix: Mat<f64>,
    pub(crate) rows: f64,
}

/// A Gram in the making.
#[derive(Clone, Debug)]
pub(crate) struct Sum {
    gram: Gram,
    /// Rows that are not yet in the Gram.
    waiting: Mat<f64>,
    waiting_rows: usize,
}

impl Sum {
    pub(crate) fn new(columns: usize) -> Self {
        Self {
            gram: Gram { matrix: Mat::zeros(columns, columns), rows: 0.0 },
            waiting: Mat::zeros(WAITING_ROWS, columns),
            waiting_rows: 0,
        }
    }

    /// Adds a flight's whitened rows, in which `recorded` values were recorded; other rows are zero and count for nothing.
    /// They wait until there are many, whose products are made faster.
    pub(crate) fn add(&mut self, rows: &Mat<f64>, recorded: f64) {
        self.gram.rows += recorded;
        if self.waiting_rows + rows.nrows() > self.waiting.nrows() {
            self.multiply_waiting();
        }
        if rows.nrows() > self.waiting.nrows() {
            add_gram(&mut self.gram.matrix, rows.as_ref());
            return;
        }
        let range = self.waiting_rows..self.waiting_rows + rows.nrows();
        for column in 0..rows.ncols() {
            self.waiting.col_as_slice_mut(column)[range.clone()]
                .copy_from_slice(rows.col_as_slice(column));
        }
        self.waiting_rows = range.end;
    }

    pub(crate) fn finish(mut self) -> Gram {
        self.multiply_waiting();
        symmetrize(&mut self.gram.matrix);
        self.gram
    }

    fn multiply_waiting(&mut self) {
        add_gram(&mut self.gram.matrix, self.waiting.subrows(0, self.waiting_rows));
        self.waiting_rows = 0;
    }
}

impl Gram {
    /// Posterior means of the sizes of `columns` with independent normal priors about 0, all other columns left out; `None`
    /// where the matrix is not positive definite.
    pub(crate) fn fit(
        &self,
        columns: &[usize],
        deviations: &[f64],
        residual: usize,
    ) -> Option<Mat<f64>> {
        let mut sizes = Mat::from_fn(columns.len(), 1, |i, _| self.matrix[(columns[i], residual)]);
        self.normal(columns, deviations)?.solve(&mut sizes);
        Some(sizes)
    }

    /// Posterior variance of a combination `weights` of the same sizes, whatever the residual; `None` as for
    /// [`fit`](Self::fit).
    pub(crate) fn variance(
        &self,
        columns: &[usize],
        deviations: &[f64],
        weights: &[f64],
    ) -> Option<f64> {
        let mut solved = Mat::from_fn(columns.len(), 1, |i, _| weights[i]);
        self.normal(columns, deviations)?.solve(&mut solved);
        Some(weights.iter().enumerate().map(|(i, weight)| weight * solved[(i, 0)]).sum())
    }

    fn normal(&self, columns: &[usize], deviations: &[f64]) -> Option<Cholesky> {
        let gram = &self.matrix;
        let mut normal =
            Mat::from_fn(columns.len(), columns.len(), |i, j| gram[(columns[i], columns[j])]);
        for (k, deviation) in deviations.iter().enumerate() {
            normal[(k, k)] += 1.0 / (deviation * deviation);
        }
        Cholesky::new(&normal)
    }
}
