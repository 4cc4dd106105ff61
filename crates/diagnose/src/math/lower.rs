//! Lower triangles of small symmetric matrices: the search of a baseline factors some hundred of them a tail, with tens of rows
//! each, for which general kernels cost several times their arithmetic.
//!
//! Sums run column by column, or over eight partial sums, whatever vectors a processor has: the same bits everywhere.

mod kernels;

use faer::Mat;

use kernels::{
    AddShare, Factor, Invert, Solve, SubtractProducts, TransposedTimesItself, solve_lower,
};

pub(crate) use kernels::dot;

/// Numbers of a column that lie, and are computed, together: two of the widest vectors that are compiled for.
const LANES: usize = 8;
/// Rows below which no wider vectors are asked for. Our choice: asking costs as much as their arithmetic.
const FEW: usize = 16;

type Block = [f64; LANES];

/// A square matrix by its lower triangle, column after column in blocks of rows. Above the diagonal, and behind the last row, it is
/// zero.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lower {
    size: usize,
    /// Blocks of a column.
    blocks: usize,
    values: Vec<Block>,
}

impl Lower {
    /// All of it zero.
    pub(crate) fn zeros(size: usize) -> Self {
        let blocks = size.div_ceil(LANES);
        Self { size, blocks, values: vec![[0.0; LANES]; size * blocks] }
    }

    /// The lower triangle of a matrix.
    pub(crate) fn of(matrix: &Mat<f64>) -> Self {
        let mut lower = Self::zeros(matrix.nrows());
        lower.add(1.0, matrix);
        lower
    }

    /// An entry on the diagonal or below.
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.values[column * self.blocks + row / LANES][row % LANES]
    }

    pub(crate) fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.values[column * self.blocks + row / LANES][row % LANES]
    }

    /// A column from its diagonal on.
    fn column(&self, column: usize) -> &[f64] {
        let blocks = &self.values[column * self.blocks..][..self.blocks];
        &blocks.as_flattened()[column..self.size]
    }

    fn column_mut(&mut self, column: usize) -> &mut [f64] {
        let blocks = &mut self.values[column * self.blocks..][..self.blocks];
        &mut blocks.as_flattened_mut()[column..self.size]
    }

    /// Becomes `B + share·A`, of matrices of one size.
    pub(crate) fn set_sum(&mut self, base: &Self, share: f64, added: &Self) {
        self.clone_from(base);
        self.add_share(share, added);
    }

    /// `C += share·A`, of matrices of one size.
    pub(crate) fn add_share(&mut self, share: f64, added: &Self) {
        pulp::Arch::new().dispatch(AddShare { into: &mut self.values, share, from: &added.values });
    }

    /// Becomes `1 + Σ share·C`, of matrices of one size.
    pub(crate) fn set_one_and_sum<'a>(&mut self, parts: impl Iterator<Item = (f64, &'a Self)>) {
        self.values.fill([0.0; LANES]);
        for (share, part) in parts {
            (self.size, self.blocks) = (part.size, part.blocks);
            self.values.resize(part.values.len(), [0.0; LANES]);
            self.add_share(share, part);
        }
        for k in 0..self.size {
            *self.at_mut(k, k) += 1.0;
        }
    }

    /// `C·v`.
    pub(crate) fn times(&self, vector: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.size];
        for column in 0..self.size {
            let values = self.column(column);
            product[column] += dot(values, &vector[column..]);
            for (into, value) in product[column + 1..].iter_mut().zip(&values[1..]) {
                *into += value * vector[column];
            }
        }
        product
    }

    /// `C += share·A`, A with as many rows and columns or more.
    pub(crate) fn add(&mut self, share: f64, from: &Mat<f64>) {
        for column in 0..self.size {
            let into = self.column_mut(column);
            let from = &from.col_as_slice(column)[column..][..into.len()];
            for (into, from) in into.iter_mut().zip(from) {
                *into += share * from;
            }
        }
    }

    /// `A += share·C`.
    pub(crate) fn add_to(&self, share: f64, into: &mut Mat<f64>) {
        for column in 0..self.size {
            let from = self.column(column);
            let into = &mut into.col_as_slice_mut(column)[column..][..from.len()];
            for (into, from) in into.iter_mut().zip(from) {
                *into += share * from;
            }
        }
    }

    /// `C −= SᵀS` with as many columns of S as C has, from `first` on.
    pub(crate) fn subtract_products(&mut self, of: &Mat<f64>, first: usize) {
        pulp::Arch::new().dispatch(SubtractProducts { from: self, of, first });
    }

    /// The triangle, with zeros above it.
    pub(crate) fn to_mat(&self) -> Mat<f64> {
        let mut matrix = Mat::zeros(self.size, self.size);
        self.add_to(1.0, &mut matrix);
        matrix
    }

    /// Becomes its Cholesky factor; `false` where it is not positive definite, and what it is then has no meaning.
    #[must_use]
    pub(crate) fn factor(&mut self) -> bool {
        pulp::Arch::new().dispatch(Factor { of: self })
    }

    /// ln of the determinant of the matrix of which this is the factor.
    pub(crate) fn ln_determinant(&self) -> f64 {
        2.0 * (0..self.size).map(|k| self.at(k, k).ln()).sum::<f64>()
    }

    /// L⁻¹·b in place.
    pub(crate) fn solve_lower(&self, right: &mut [f64]) {
        if self.size < FEW {
            solve_lower(self, right);
        } else {
            pulp::Arch::new().dispatch(Solve { factor: self, right });
        }
    }

    /// L⁻ᵀ·b in place.
    pub(crate) fn solve_upper(&self, right: &mut [f64]) {
        for row in (0..self.size).rev() {
            let column = self.column(row);
            let known = dot(&column[1..], &right[row + 1..self.size]);
            right[row] = (right[row] - known) / column[0];
        }
    }

    /// L⁻¹ of a factor.
    pub(crate) fn inverse(&self) -> Inverse {
        pulp::Arch::new().dispatch(Invert { factor: self })
    }
}

/// The inverse of a factor, row after row in blocks of columns.
#[derive(Clone, Debug)]
pub(crate) struct Inverse {
    size: usize,
    blocks: usize,
    rows: Vec<Block>,
}

impl Inverse {
    pub(crate) const fn size(&self) -> usize {
        self.size
    }

    /// An entry on the diagonal or below.
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.rows[row * self.blocks + column / LANES][column % LANES]
    }

    /// Its transpose times itself: the inverse of the matrix that was factored.
    pub(crate) fn transposed_times_itself(&self) -> Lower {
        pulp::Arch::new().dispatch(TransposedTimesItself { of: self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::cholesky::Cholesky;

    /// faer's factor, solutions and inverse of the same matrices, of sizes that are multiples of lanes and are not.
    #[test]
    fn factor_solutions_and_inverse_are_those_of_faer() {
        for size in [1, 2, 3, 4, 5, 7, 8, 15, 17, 31, 40, 63] {
            let number = |k: usize| (k as f64 * 0.618_033_988_749_895).fract() - 0.5;
            let raw = Mat::from_fn(size + 3, size, |i, j| number(7 * i + 13 * j + 1));
            let mut matrix = raw.transpose() * &raw;
            for k in 0..size {
                matrix[(k, k)] += 0.1;
            }
            let known = Cholesky::new(&matrix).unwrap();
            let mut found = Lower::zeros(size);
            found.add(1.0, &matrix);
            assert!(found.factor());
            let same = |one: f64, other: f64| {
                assert!(
                    (one - other).abs() < 1e-10 * other.abs().max(1.0),
                    "{size}: {one} {other}"
                );
            };
            same(found.ln_determinant(), known.ln_determinant());
            let mut right = Mat::from_fn(size, 1, |k, _| number(k + 3));
            let mut ours: Vec<f64> = right.col_as_slice(0).to_vec();
            known.solve(&mut right);
            found.solve_lower(&mut ours);
            found.solve_upper(&mut ours);
            for (one, other) in ours.iter().zip(right.col_as_slice(0)) {
                same(*one, *other);
            }
            let mut inverse = Mat::identity(size, size);
            known.solve(&mut inverse);
            let ours = found.inverse().transposed_times_itself();
            for column in 0..size {
                for row in column..size {
                    same(found.at(row, column), known.lower()[(row, column)]);
                    same(ours.at(row, column), inverse[(row, column)]);
                }
            }
        }
    }

    #[test]
    fn what_is_not_positive_definite_has_no_factor() {
        for values in [[1.0, 2.0, 1.0], [f64::NAN, 0.0, 1.0], [0.0, 0.0, 1.0]] {
            let mut matrix = Lower::zeros(2);
            *matrix.at_mut(0, 0) = values[0];
            *matrix.at_mut(1, 0) = values[1];
            *matrix.at_mut(1, 1) = values[2];
            assert!(!matrix.factor(), "{values:?}");
        }
    }
}
