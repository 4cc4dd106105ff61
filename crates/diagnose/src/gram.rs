//! Gram matrices of the whitened columns, one for each fold of flights: all that the search looks at.

use faer::Mat;

use crate::design::Design;
use crate::linear::{Factor, add_gram, subtract_product, symmetrize};

/// Folds for everything that is judged on flights it has not seen.
pub(crate) const FOLDS: usize = 5;

/// Gram matrix of all columns, and the number of rows behind it.
#[derive(Clone, Debug)]
pub(crate) struct Gram {
    pub(crate) matrix: Mat<f64>,
    pub(crate) rows: usize,
}

/// One Gram a fold; flights take turns.
#[derive(Clone, Debug)]
pub(crate) struct Folds {
    grams: Vec<Gram>,
    /// Sum of all folds but one, and of all; made when first asked for, since every refinement asks again.
    sums: [core::cell::OnceCell<Gram>; FOLDS + 1],
}

/// Fold of a flight by its place in the order of flying.
pub(crate) const fn fold_of(flight: usize) -> usize {
    flight % FOLDS
}

impl Folds {
    pub(crate) fn empty(design: &Design<'_>) -> Self {
        let empty = || Gram { matrix: Mat::zeros(design.columns, design.columns), rows: 0 };
        Self { grams: (0..FOLDS).map(|_| empty()).collect(), sums: Default::default() }
    }

    /// Adds a flight's whitened rows; [`finish`](Self::finish) when all are in.
    pub(crate) fn add(&mut self, flight: usize, rows: &Mat<f64>) {
        let gram = &mut self.grams[fold_of(flight)];
        add_gram(&mut gram.matrix, rows);
        gram.rows += rows.nrows();
    }

    pub(crate) fn finish(&mut self) {
        for gram in &mut self.grams {
            symmetrize(&mut gram.matrix);
        }
    }

    /// All flights but those of one fold; all where none is left out.
    pub(crate) fn without(&self, fold: Option<usize>) -> &Gram {
        self.sums[fold.unwrap_or(FOLDS)].get_or_init(|| self.sum_without(fold))
    }

    fn sum_without(&self, fold: Option<usize>) -> Gram {
        let mut kept =
            self.grams.iter().enumerate().filter(|(k, _)| Some(*k) != fold).map(|(_, gram)| gram);
        let Some(first) = kept.next() else {
            return Gram { matrix: Mat::zeros(0, 0), rows: 0 };
        };
        let mut sum = first.clone();
        for gram in kept {
            sum.matrix += &gram.matrix;
            sum.rows += gram.rows;
        }
        sum
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
        let gram = &self.matrix;
        let mut normal =
            Mat::from_fn(columns.len(), columns.len(), |i, j| gram[(columns[i], columns[j])]);
        for (k, deviation) in deviations.iter().enumerate() {
            normal[(k, k)] += 1.0 / (deviation * deviation);
        }
        let mut sizes = Mat::from_fn(columns.len(), 1, |i, _| gram[(columns[i], residual)]);
        Factor::of(&normal)?.solve(&mut sizes);
        Some(sizes)
    }
}

/// A Gram matrix from which columns of known prior were integrated out, over the columns that are left.
#[derive(Clone, Debug)]
pub(crate) struct Reduced {
    /// Over the columns of `kept`, in that order.
    pub(crate) matrix: Mat<f64>,
    /// −2 ln of the evidence's determinant so far.
    pub(crate) ln_determinant: f64,
}

/// Integrates out columns with independent normal priors.
///
/// ```text
/// G' = G_kk − G_kz S (1 + S G_zz S)⁻¹ S G_zk,   ln det += ln|1 + S G_zz S|,   S = diag(sd)     [diagnosis.18]
/// ```
///
/// `None` where the matrix is not finite.
pub(crate) fn integrate_out(
    gram: &Mat<f64>,
    kept: &[usize],
    out: &[usize],
    deviations: &[f64],
) -> Option<Reduced> {
    let mut matrix = Mat::from_fn(kept.len(), kept.len(), |i, j| gram[(kept[i], kept[j])]);
    if out.is_empty() {
        return Some(Reduced { matrix, ln_determinant: 0.0 });
    }
    let inner = Mat::from_fn(out.len(), out.len(), |i, j| {
        gram[(out[i], out[j])] * deviations[i] * deviations[j] + if i == j { 1.0 } else { 0.0 }
    });
    let factor = Factor::of(&inner)?;
    let mut projected =
        Mat::from_fn(out.len(), kept.len(), |i, j| gram[(out[i], kept[j])] * deviations[i]);
    factor.half_solve(&mut projected);
    subtract_product(&mut matrix, &projected, &projected);
    Some(Reduced { matrix, ln_determinant: factor.ln_determinant() })
}
