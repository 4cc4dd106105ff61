//! Columns with known normal priors integrated out of a Gram matrix.

use faer::Mat;

use crate::math::cholesky::Cholesky;
use crate::math::linear::{gather, subtract_own_product, subtract_product};

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
    factor: Option<Cholesky>,
    /// `L⁻¹·S·G_zk`, L the Cholesky factor of `1 + S G_zz S`.
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
    pub(crate) fn new(
        gram: &Mat<f64>,
        kept: Vec<usize>,
        out: Vec<usize>,
        deviations: Vec<f64>,
    ) -> Option<(Self, Reduced)> {
        let mut matrix = gather(gram, &kept, &kept);
        let found = Self::projection(gram, kept, out, deviations)?;
        if found.factor.is_some() {
            subtract_own_product(&mut matrix, &found.projected);
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
        let factor = Cholesky::new(&inner)?;
        let mut projected = gather(gram, &out, &kept);
        for j in 0..kept.len() {
            for (value, deviation) in projected.col_as_slice_mut(j).iter_mut().zip(&deviations) {
                *value *= deviation;
            }
        }
        factor.solve_lower(&mut projected);
        Some(Self { kept, out, deviations, factor: Some(factor), projected })
    }

    pub(crate) fn ln_determinant(&self) -> f64 {
        self.factor.as_ref().map_or(0.0, Cholesky::ln_determinant)
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
            factor.solve_lower(&mut projected);
            subtract_product(&mut cross, &self.projected, &projected);
            subtract_own_product(&mut own, &projected);
        }
        Changed { cross, own }
    }
}

impl Changed {
    /// Writes the columns of these places into a part of a symmetric matrix: the rows and columns of `used`, some of them
    /// more than once.
    pub(crate) fn write_used(&self, part: &mut Mat<f64>, places: &[usize], used: &[usize]) {
        let which: Vec<Option<usize>> =
            used.iter().map(|of| places.iter().position(|place| place == of)).collect();
        for (column, k) in which.iter().enumerate() {
            let Some(k) = *k else { continue };
            for (row, of) in used.iter().enumerate() {
                let value = which[row].map_or_else(|| self.cross[(*of, k)], |l| self.own[(l, k)]);
                part[(row, column)] = value;
                part[(column, row)] = value;
            }
        }
    }

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
    let found = Elimination::new(gram, kept.to_vec(), out.to_vec(), deviations.to_vec())?;
    Some(found.1)
}

/// As [`integrate_out`] for a handful of neighboring columns of one prior standard deviation, without asking for memory.
pub(crate) fn integrate_few_out(
    gram: &Mat<f64>,
    kept: &[usize],
    out: core::ops::Range<usize>,
    deviation: f64,
) -> Option<Reduced> {
    const FEW: usize = 8;
    let (count, first) = (out.len(), out.start);
    if count > FEW || kept.len() > FEW {
        let out: Vec<usize> = out.collect();
        return integrate_out(gram, kept, &out, &vec![deviation; count]);
    }
    let mut matrix = gather(gram, kept, kept);
    // Rows: the Cholesky factor L of 1 + S G_zz S, then S G_kz L⁻ᵀ.
    let mut rows = [[0.0; FEW]; 2 * FEW];
    let mut ln_determinant = 0.0;
    for column in 0..count {
        let from = &gram.col_as_slice(first + column);
        for row in column..count + kept.len() {
            let own = row < count;
            let value = if own { from[first + row] * deviation } else { from[kept[row - count]] };
            let unit = if row == column { 1.0 } else { 0.0 };
            let inner: f64 = (0..column).map(|k| rows[row][k] * rows[column][k]).sum();
            let left = value * deviation + unit - inner;
            rows[row][column] =
                if row == column { left.sqrt() } else { left / rows[column][column] };
        }
        let pivot = rows[column][column];
        if !(pivot.is_finite() && pivot > 0.0) {
            return None;
        }
        ln_determinant += 2.0 * pivot.ln();
    }
    for i in 0..kept.len() {
        for j in 0..kept.len() {
            let explained: f64 = rows[count + i][..count]
                .iter()
                .zip(&rows[count + j][..count])
                .map(|(a, b)| a * b)
                .sum();
            matrix[(i, j)] -= explained;
        }
    }
    Some(Reduced { matrix, ln_determinant })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three columns and a residual: positive definite by its diagonal.
    fn gram() -> Mat<f64> {
        let gram = [
            [9.0, 2.0, -1.0, 3.0],
            [2.0, 7.0, 1.5, -2.0],
            [-1.0, 1.5, 5.0, 1.0],
            [3.0, -2.0, 1.0, 6.0],
        ];
        Mat::from_fn(4, 4, |i, j| gram[i][j])
    }

    #[test]
    fn one_column_out_by_hand() {
        // S = 0.5: 1 + 0.25·9 = 3.25; G_11 − 2·0.5·0.5·2/3.25 = 7 − 1/3.25; G_13 = −2 − 0.25·2·3/3.25.
        let left = integrate_out(&gram(), &[1, 3], &[0], &[0.5]).unwrap();
        assert!((left.ln_determinant - 3.25_f64.ln()).abs() < 1e-15);
        assert!((left.matrix[(0, 0)] - (7.0 - 1.0 / 3.25)).abs() < 1e-14);
        assert!((left.matrix[(1, 0)] - (-2.0 - 1.5 / 3.25)).abs() < 1e-14);
    }

    /// A few columns out by hand-written elimination and by faer's.
    #[test]
    fn few_columns_are_as_many() {
        let few = integrate_few_out(&gram(), &[0, 3], 1..3, 0.7).unwrap();
        let many = integrate_out(&gram(), &[0, 3], &[1, 2], &[0.7; 2]).unwrap();
        assert!((few.ln_determinant - many.ln_determinant).abs() < 1e-14);
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            assert!((few.matrix[(i, j)] - many.matrix[(i, j)]).abs() < 1e-14);
        }
        let none = integrate_few_out(&gram(), &[0, 3], 1..1, 0.7).unwrap();
        assert!((none.matrix[(0, 1)] - 3.0).abs() < 1e-15 && none.ln_determinant.abs() < 1e-300);
    }

    /// Columns that change and follow, against integrating out after the change.
    #[test]
    fn changed_columns_follow() {
        let (before, kept, out) = (gram(), vec![0, 2, 3], vec![1]);
        let changed = Changed {
            cross: Mat::from_fn(4, 1, |i, _| [2.0, -1.0, 0.5, 4.0][i]),
            own: Mat::from_fn(1, 1, |_, _| 8.0),
        };
        let mut after = before.clone();
        changed.write(&mut after, &[3]);
        let expected = integrate_out(&after, &kept, &out, &[0.6]).unwrap();
        let (elimination, left) = Elimination::new(&before, kept, out, vec![0.6]).unwrap();
        let followed = elimination.follow(&changed);
        let mut found = left.matrix;
        followed.write(&mut found, &[2]);
        assert!((left.ln_determinant - expected.ln_determinant).abs() < 1e-15);
        for i in 0..3 {
            for j in 0..3 {
                assert!((found[(i, j)] - expected.matrix[(i, j)]).abs() < 1e-14, "{i} {j}");
            }
        }
        let mut part = gather(&before, &[0, 3, 2], &[0, 3, 2]);
        changed.write_used(&mut part, &[3], &[0, 3, 2]);
        assert!((part[(0, 1)] - 2.0).abs() < 1e-15 && (part[(1, 2)] - 0.5).abs() < 1e-15);
        assert!((part[(1, 1)] - 8.0).abs() < 1e-15 && (part[(0, 2)] + 1.0).abs() < 1e-15);
    }
}
