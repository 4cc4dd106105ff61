//! Gram matrices of the whitened columns, one for each fold of flights: all that the search looks at.

use faer::Mat;

use crate::design::Design;
use crate::linear::{Factor, add_gram, gather, subtract_product, symmetrize};

/// Folds for everything that is judged on flights it has not seen.
pub(crate) const FOLDS: usize = 5;
/// Rows that are multiplied together: a flight alone has too few for fast products.
const WAITING_ROWS: usize = 384;

/// Gram matrix of all columns, and the number of rows behind it.
#[derive(Clone, Debug)]
pub(crate) struct Gram {
    pub(crate) matrix: Mat<f64>,
    pub(crate) rows: usize,
}

/// One Gram a fold; flights take turns.
#[derive(Clone, Debug)]
pub(crate) struct Folds {
    /// Lower triangles.
    grams: Vec<Gram>,
    /// Sum of all folds but one, and of all; made when first asked for, since every refinement asks again.
    sums: [core::cell::OnceCell<Gram>; FOLDS + 1],
    /// Rows of one fold that are not yet in its Gram.
    waiting: Mat<f64>,
    waiting_rows: usize,
    waiting_of: usize,
}

/// Fold of a flight by its place in the order of flying.
pub(crate) const fn fold_of(flight: usize) -> usize {
    flight % FOLDS
}

impl Folds {
    pub(crate) fn empty(design: &Design<'_>) -> Self {
        let empty = || Gram { matrix: Mat::zeros(design.columns, design.columns), rows: 0 };
        Self {
            grams: (0..FOLDS).map(|_| empty()).collect(),
            sums: Default::default(),
            waiting: Mat::zeros(WAITING_ROWS, design.columns),
            waiting_rows: 0,
            waiting_of: 0,
        }
    }

    /// Adds a flight's whitened rows; [`finish`](Self::finish) when all are in. Rows wait until there are many, whose products
    /// are made faster: flights of one fold had better come one after the other.
    pub(crate) fn add(&mut self, flight: usize, rows: &Mat<f64>) {
        let fold = fold_of(flight);
        self.grams[fold].rows += rows.nrows();
        if fold != self.waiting_of || self.waiting_rows + rows.nrows() > self.waiting.nrows() {
            self.multiply_waiting();
            self.waiting_of = fold;
        }
        if rows.nrows() > self.waiting.nrows() {
            add_gram(&mut self.grams[fold].matrix, rows.as_ref());
            return;
        }
        let range = self.waiting_rows..self.waiting_rows + rows.nrows();
        for column in 0..rows.ncols() {
            self.waiting.col_as_slice_mut(column)[range.clone()]
                .copy_from_slice(rows.col_as_slice(column));
        }
        self.waiting_rows = range.end;
    }

    pub(crate) fn finish(&mut self) {
        self.multiply_waiting();
        self.waiting = Mat::zeros(0, 0);
    }

    fn multiply_waiting(&mut self) {
        let rows = self.waiting.subrows(0, self.waiting_rows);
        add_gram(&mut self.grams[self.waiting_of].matrix, rows);
        self.waiting_rows = 0;
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
        symmetrize(&mut sum.matrix);
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

/// Columns with independent normal priors that were integrated out, kept so that columns which change can follow.
///
/// ```text
/// G' = G_kk − G_kz S (1 + S G_zz S)⁻¹ S G_zk,   ln det += ln|1 + S G_zz S|,   S = diag(sd)     [diagnosis.18]
/// ```
#[derive(Debug)]
pub(crate) struct Elimination {
    kept: Vec<usize>,
    out: Vec<usize>,
    deviations: Vec<f64>,
    factor: Option<Factor>,
    /// L⁻¹·S·G_zk, L the Cholesky factor of 1 + S G_zz S.
    projected: Mat<f64>,
}

/// Columns that take the place of others: their products with all columns of a Gram, and with each other.
#[derive(Clone, Debug)]
pub(crate) struct Changed {
    pub(crate) cross: Mat<f64>,
    pub(crate) own: Mat<f64>,
}

impl Elimination {
    /// Integrates `out` out; `None` where the matrix is not positive definite.
    pub(crate) fn of(
        gram: &Mat<f64>,
        kept: Vec<usize>,
        out: Vec<usize>,
        deviations: Vec<f64>,
    ) -> Option<(Self, Reduced)> {
        let mut matrix = gather(gram, &kept, &kept);
        let found = Self::projection(gram, kept, out, deviations)?;
        if found.factor.is_some() {
            subtract_product(&mut matrix, &found.projected, &found.projected);
        }
        let ln_determinant = found.ln_determinant();
        Some((found, Reduced { matrix, ln_determinant }))
    }

    /// The same without making the matrix that is left.
    pub(crate) fn projection(
        gram: &Mat<f64>,
        kept: Vec<usize>,
        out: Vec<usize>,
        deviations: Vec<f64>,
    ) -> Option<Self> {
        if out.is_empty() {
            return Some(Self { kept, out, deviations, factor: None, projected: Mat::zeros(0, 0) });
        }
        let mut inner = gather(gram, &out, &out);
        for j in 0..out.len() {
            for (i, value) in inner.col_as_slice_mut(j).iter_mut().enumerate() {
                *value *= deviations[i] * deviations[j];
            }
            inner[(j, j)] += 1.0;
        }
        let factor = Factor::of(&inner)?;
        let mut projected = gather(gram, &out, &kept);
        for j in 0..kept.len() {
            for (value, deviation) in projected.col_as_slice_mut(j).iter_mut().zip(&deviations) {
                *value *= deviation;
            }
        }
        factor.half_solve(&mut projected);
        Some(Self { kept, out, deviations, factor: Some(factor), projected })
    }

    pub(crate) fn ln_determinant(&self) -> f64 {
        self.factor.as_ref().map_or(0.0, Factor::ln_determinant)
    }

    /// What the columns that are out explain of the product of two kept ones.
    pub(crate) fn explained(&self, a: usize, b: usize) -> f64 {
        if self.factor.is_none() {
            return 0.0;
        }
        let (a, b) = (self.projected.col_as_slice(a), self.projected.col_as_slice(b));
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    /// What becomes of changed columns, none of which is among those that are out: products with the kept ones.
    pub(crate) fn follow(&self, changed: &Changed) -> Changed {
        let all: Vec<usize> = (0..changed.own.ncols()).collect();
        let mut cross = gather(&changed.cross, &self.kept, &all);
        let mut own = changed.own.clone();
        if let Some(factor) = &self.factor {
            let mut projected = gather(&changed.cross, &self.out, &all);
            for j in 0..all.len() {
                for (value, deviation) in
                    projected.col_as_slice_mut(j).iter_mut().zip(&self.deviations)
                {
                    *value *= deviation;
                }
            }
            factor.half_solve(&mut projected);
            subtract_product(&mut cross, &self.projected, &projected);
            subtract_product(&mut own, &projected, &projected);
        }
        Changed { cross, own }
    }
}

impl Changed {
    /// Writes the columns to these places of a symmetric matrix.
    pub(crate) fn write(&self, matrix: &mut Mat<f64>, places: &[usize]) {
        for (k, &place) in places.iter().enumerate() {
            for (row, &value) in self.cross.col_as_slice(k).iter().enumerate() {
                matrix[(row, place)] = value;
                matrix[(place, row)] = value;
            }
        }
        for (k, &a) in places.iter().enumerate() {
            for (l, &b) in places.iter().enumerate() {
                matrix[(a, b)] = self.own[(k, l)];
            }
        }
    }
}

/// Integrates out columns with independent normal priors, `[diagnosis.18]`; `None` where the matrix is not finite.
pub(crate) fn integrate_out(
    gram: &Mat<f64>,
    kept: &[usize],
    out: &[usize],
    deviations: &[f64],
) -> Option<Reduced> {
    let found = Elimination::of(gram, kept.to_vec(), out.to_vec(), deviations.to_vec())?;
    Some(found.1)
}
