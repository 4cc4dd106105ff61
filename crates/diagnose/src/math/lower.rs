//! Lower triangles of small symmetric matrices: the search of a baseline factors some hundred of them a tail, with tens of rows
//! each, for which general kernels cost several times their arithmetic.
//!
//! Sums run column by column, or over eight partial sums, whatever vectors a processor has: the same bits everywhere.

use faer::Mat;

/// Partial sums of a product.
const LANES: usize = 8;
/// Rows below which no wider vectors are asked for. Our choice: asking costs as much as their arithmetic.
const FEW: usize = 16;

/// A square matrix by its lower triangle, column after column; what is above the diagonal has no meaning.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lower {
    size: usize,
    values: Vec<f64>,
}

#[expect(clippy::needless_range_loop, reason = "columns of one length, which compilers see so")]
impl Lower {
    /// All of it zero.
    pub(crate) fn zeros(size: usize) -> Self {
        Self { size, values: vec![0.0; size * size] }
    }

    /// The lower triangle of a matrix.
    pub(crate) fn of(matrix: &Mat<f64>) -> Self {
        let mut lower = Self::zeros(matrix.nrows());
        lower.add(1.0, matrix);
        lower
    }

    pub(crate) const fn size(&self) -> usize {
        self.size
    }

    /// An entry on the diagonal or below.
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.values[column * self.size + row]
    }

    pub(crate) fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.values[column * self.size + row]
    }

    /// A column from its diagonal on.
    fn column(&self, column: usize) -> &[f64] {
        &self.values[column * self.size + column..(column + 1) * self.size]
    }

    /// Becomes `B + share·A`, A with as many rows and columns or more.
    pub(crate) fn set_sum(&mut self, base: &Self, share: f64, added: &Mat<f64>) {
        self.size = base.size;
        self.values.resize(base.size * base.size, 0.0);
        for column in 0..self.size {
            let count = self.size - column;
            let at = column * self.size + column;
            let (base, added) =
                (&base.values[at..][..count], &added.col_as_slice(column)[column..]);
            let (into, added) = (&mut self.values[at..][..count], &added[..count]);
            for i in 0..count {
                into[i] = base[i] + share * added[i];
            }
        }
    }

    /// Becomes `1 + Σ share·C`.
    pub(crate) fn set_one_and_sum<'a>(&mut self, parts: impl Iterator<Item = (f64, &'a Self)>) {
        self.values.fill(0.0);
        for (share, part) in parts {
            self.size = part.size;
            self.values.resize(part.values.len(), 0.0);
            for column in 0..self.size {
                let (at, count) = (column * self.size + column, self.size - column);
                let (into, from) = (&mut self.values[at..][..count], &part.values[at..][..count]);
                for i in 0..count {
                    into[i] += share * from[i];
                }
            }
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
            let count = self.size - column;
            let from = &from.col_as_slice(column)[column..][..count];
            let into = &mut self.values[column * self.size + column..][..count];
            for i in 0..count {
                into[i] += share * from[i];
            }
        }
    }

    /// `A += share·C`.
    pub(crate) fn add_to(&self, share: f64, into: &mut Mat<f64>) {
        for column in 0..self.size {
            let count = self.size - column;
            let into = &mut into.col_as_slice_mut(column)[column..][..count];
            let from = self.column(column);
            for i in 0..count {
                into[i] += share * from[i];
            }
        }
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
        pulp::Arch::new().dispatch(Factor { size: self.size, values: &mut self.values })
    }

    /// ln of the determinant of the matrix of which this is the factor.
    pub(crate) fn ln_determinant(&self) -> f64 {
        2.0 * (0..self.size).map(|k| self.at(k, k).ln()).sum::<f64>()
    }

    /// L⁻¹·b in place.
    pub(crate) fn solve_lower(&self, right: &mut [f64]) {
        if self.size < FEW {
            solve_lower(self, right, 0);
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
    pub(crate) fn inverse(&self) -> Self {
        pulp::Arch::new().dispatch(Inverse { factor: self })
    }

    /// LᵀL of a lower triangle: of the inverse of a factor it is the inverse of the matrix.
    pub(crate) fn transposed_times_itself(&self) -> Self {
        pulp::Arch::new().dispatch(TransposedTimesItself { of: self })
    }
}

/// Cholesky's factor, two columns at a time and four earlier ones into both: what is read is used more than once.
struct Factor<'a> {
    size: usize,
    values: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Factor<'_> {
    type Output = bool;

    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    fn call(self) -> bool {
        let Self { size, values } = self;
        let mut column = 0;
        while column < size {
            let (known, rest) = values.split_at_mut(column * size);
            let count = size - column;
            if count == 1 {
                let own = &mut rest[column];
                for k in 0..column {
                    let by = known[k * size + column];
                    *own -= by * by;
                }
                return finish(core::slice::from_mut(own));
            }
            let (first, second) = rest.split_at_mut(size);
            let first = &mut first[column..size];
            let second = &mut second[column + 1..size];
            take_earlier(known, (size, column), first, second);
            if !finish(first) {
                return false;
            }
            let below = &first[1..][..second.len()];
            let by = below[0];
            for i in 0..below.len() {
                second[i] -= by * below[i];
            }
            if !finish(second) {
                return false;
            }
            column += 2;
        }
        true
    }
}

/// Takes what earlier columns explain from two columns, each from its diagonal on.
#[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
#[inline(always)]
fn take_earlier(
    known: &[f64],
    (size, column): (usize, usize),
    first: &mut [f64],
    second: &mut [f64],
) {
    let count = size - column;
    let (head, tail) = first.split_at_mut(1);
    let tail = &mut tail[..count - 1];
    let second = &mut second[..count - 1];
    let of = |k: usize| &known[k * size + column..][..count];
    let mut k = 0;
    while k + 4 <= column {
        let (a, b, c, d) = (of(k), of(k + 1), of(k + 2), of(k + 3));
        let by = [a[0], b[0], c[0], d[0]];
        head[0] -= (by[0] * by[0] + by[1] * by[1]) + (by[2] * by[2] + by[3] * by[3]);
        let (a, b, c, d) = (&a[1..], &b[1..], &c[1..], &d[1..]);
        let (a, b) = (&a[..count - 1], &b[..count - 1]);
        let (c, d) = (&c[..count - 1], &d[..count - 1]);
        let next = [a[0], b[0], c[0], d[0]];
        for i in 0..count - 1 {
            tail[i] -= (by[0] * a[i] + by[1] * b[i]) + (by[2] * c[i] + by[3] * d[i]);
            second[i] -= (next[0] * a[i] + next[1] * b[i]) + (next[2] * c[i] + next[3] * d[i]);
        }
        k += 4;
    }
    while k < column {
        let a = of(k);
        let by = a[0];
        head[0] -= by * by;
        let a = &a[1..][..count - 1];
        let next = a[0];
        for i in 0..count - 1 {
            tail[i] -= by * a[i];
            second[i] -= next * a[i];
        }
        k += 1;
    }
}

/// Divides a column by the root of its first entry; `false` where that is not positive.
#[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
#[inline(always)]
fn finish(column: &mut [f64]) -> bool {
    let pivot = column[0];
    if !(pivot > 0.0 && pivot.is_finite()) {
        return false;
    }
    let root = pivot.sqrt();
    let share = 1.0 / root;
    for value in &mut *column {
        *value *= share;
    }
    column[0] = root;
    true
}

struct Solve<'a> {
    factor: &'a Lower,
    right: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Solve<'_> {
    type Output = ();

    #[expect(clippy::inline_always, reason = "as the factor")]
    #[inline(always)]
    fn call(self) {
        solve_lower(self.factor, self.right, 0);
    }
}

struct Inverse<'a> {
    factor: &'a Lower,
}

impl pulp::NullaryFnOnce for Inverse<'_> {
    type Output = Lower;

    #[expect(clippy::inline_always, reason = "as the factor")]
    #[inline(always)]
    fn call(self) -> Lower {
        let size = self.factor.size;
        let mut inverse = Lower::zeros(size);
        for column in 0..size {
            let values = &mut inverse.values[column * size..][..size];
            values[column] = 1.0;
            solve_lower(self.factor, values, column);
        }
        inverse
    }
}

struct TransposedTimesItself<'a> {
    of: &'a Lower,
}

impl pulp::NullaryFnOnce for TransposedTimesItself<'_> {
    type Output = Lower;

    #[expect(clippy::inline_always, reason = "as the factor")]
    #[inline(always)]
    fn call(self) -> Lower {
        let size = self.of.size;
        let mut product = Lower::zeros(size);
        for row in 0..size {
            let own = &self.of.values[row * size + row..][..size - row];
            for column in 0..=row {
                let other = &self.of.values[column * size + row..][..size - row];
                product.values[column * size + row] = dot(own, other);
            }
        }
        product
    }
}

/// L⁻¹·b in place, b zero before `first`.
#[expect(clippy::inline_always, reason = "compiled for the vectors of its callers")]
#[inline(always)]
fn solve_lower(factor: &Lower, right: &mut [f64], first: usize) {
    let size = factor.size;
    for row in first..size {
        let count = size - row;
        let column = &factor.values[row * size + row..][..count];
        let right = &mut right[row..][..count];
        let value = right[0] / column[0];
        right[0] = value;
        for i in 1..count {
            right[i] -= value * column[i];
        }
    }
}

/// Σ a·b.
#[expect(clippy::inline_always, reason = "compiled for the vectors of its callers")]
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len();
    let b = &b[..count];
    let mut sums = [0.0; LANES];
    let mut at = 0;
    while at + LANES <= count {
        let (a, b) = (&a[at..][..LANES], &b[at..][..LANES]);
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
        at += LANES;
    }
    let mut rest = 0.0;
    for k in at..count {
        rest += a[k] * b[k];
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + b) + (c + d)) + ((e + f) + (g + h)) + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::cholesky::Cholesky;

    /// faer's factor, solutions and inverse of the same matrices, of sizes that are multiples of lanes and are not.
    #[test]
    fn factor_solutions_and_inverse_are_those_of_faer() {
        for size in [1, 2, 5, 8, 17, 40] {
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
