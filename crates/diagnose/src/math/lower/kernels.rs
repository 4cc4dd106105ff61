//! The loops over small lower triangles, compiled for the vectors that a processor has.

use faer::Mat;

use super::Lower;

/// Partial sums of a product.
const LANES: usize = 8;

/// Cholesky's factor, two columns at a time and four earlier ones into both: what is read is used more than once.
pub(super) struct Factor<'a> {
    pub(super) size: usize,
    pub(super) values: &'a mut [f64],
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

pub(super) struct Solve<'a> {
    pub(super) factor: &'a Lower,
    pub(super) right: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Solve<'_> {
    type Output = ();

    #[expect(clippy::inline_always, reason = "as the factor")]
    #[inline(always)]
    fn call(self) {
        solve_lower(self.factor, self.right, 0);
    }
}

pub(super) struct Inverse<'a> {
    pub(super) factor: &'a Lower,
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

pub(super) struct SubtractProducts<'a> {
    pub(super) from: &'a mut Lower,
    pub(super) of: &'a Mat<f64>,
    pub(super) first: usize,
}

impl pulp::NullaryFnOnce for SubtractProducts<'_> {
    type Output = ();

    #[expect(clippy::inline_always, reason = "as the factor")]
    #[inline(always)]
    fn call(self) {
        let Self { from, of, first } = self;
        for column in 0..from.size {
            let known = of.col_as_slice(first + column);
            for row in column..from.size {
                from.values[column * from.size + row] -= dot(of.col_as_slice(first + row), known);
            }
        }
    }
}

pub(super) struct TransposedTimesItself<'a> {
    pub(super) of: &'a Lower,
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
pub(super) fn solve_lower(factor: &Lower, right: &mut [f64], first: usize) {
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
