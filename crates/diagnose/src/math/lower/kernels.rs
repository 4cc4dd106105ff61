//! The loops over small lower triangles, compiled for the vectors that a processor has.
//!
//! They go block by block over arrays of [`LANES`] numbers that are loaded, changed and stored as a whole: slices whose ends a
//! compiler has to find out become one number at a time.

#![expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
#![expect(clippy::needless_range_loop, reason = "iterators are calls of their own there")]

use faer::Mat;

use super::{Block, Inverse, LANES, Lower};

/// Columns that are looked at together: what is read serves them all.
const TOGETHER: usize = 4;

/// Cholesky's factor, four columns at a time: what they explain is taken from two later ones at once.
pub(super) struct Factor<'a> {
    pub(super) of: &'a mut Lower,
}

impl pulp::NullaryFnOnce for Factor<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Lower { size, blocks, values } = self.of;
        let (size, blocks) = (*size, *blocks);
        for first in (0..size).step_by(TOGETHER) {
            let count = (size - first).min(TOGETHER);
            let (known, later) = values.split_at_mut((first + count) * blocks);
            let panel = &mut known[first * blocks..];
            if !factor_panel(panel, blocks, first) {
                return false;
            }
            let mut column = first + count;
            let mut pairs = later.chunks_exact_mut(2 * blocks);
            for pair in &mut pairs {
                take_from_pair(panel, pair, blocks, column);
                column += 2;
            }
            let last = pairs.into_remainder();
            if !last.is_empty() {
                take_from_one(panel, last, blocks, column);
            }
        }
        clear_above(values, size, blocks);
        true
    }
}

/// Factors a few neighbouring columns from which all earlier ones are taken; `false` where one has no positive pivot.
#[inline(always)]
fn factor_panel(panel: &mut [Block], blocks: usize, first: usize) -> bool {
    for own in 0..panel.len() / blocks {
        let (before, rest) = panel.split_at_mut(own * blocks);
        let column = &mut rest[..blocks];
        let (start, lane) = ((first + own) / LANES, (first + own) % LANES);
        for earlier in 0..own {
            let earlier = &before[earlier * blocks..][..blocks];
            let by = earlier[start][lane];
            for block in start..blocks {
                let known = earlier[block];
                let mut values = column[block];
                for lane in 0..LANES {
                    values[lane] -= by * known[lane];
                }
                column[block] = values;
            }
        }
        let pivot = column[start][lane];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        let root = pivot.sqrt();
        let share = 1.0 / root;
        for block in start..blocks {
            let mut values = column[block];
            for lane in 0..LANES {
                values[lane] *= share;
            }
            column[block] = values;
        }
        column[start][lane] = root;
    }
    true
}

/// Takes what four columns explain from two later ones.
#[inline(always)]
fn take_from_pair(panel: &[Block], pair: &mut [Block], blocks: usize, column: usize) {
    let start = column / LANES;
    let a = &panel[..blocks];
    let b = &panel[blocks..][..blocks];
    let c = &panel[2 * blocks..][..blocks];
    let d = &panel[3 * blocks..][..blocks];
    let (one, two) = pair.split_at_mut(blocks);
    let two = &mut two[..blocks];
    let (row, lane) = (start, column % LANES);
    let first = [a[row][lane], b[row][lane], c[row][lane], d[row][lane]];
    let (row, lane) = ((column + 1) / LANES, (column + 1) % LANES);
    let second = [a[row][lane], b[row][lane], c[row][lane], d[row][lane]];
    for block in start..blocks {
        let (a, b, c, d) = (a[block], b[block], c[block], d[block]);
        let (mut x, mut y) = (one[block], two[block]);
        for lane in 0..LANES {
            x[lane] -= (first[0] * a[lane] + first[1] * b[lane])
                + (first[2] * c[lane] + first[3] * d[lane]);
        }
        for lane in 0..LANES {
            y[lane] -= (second[0] * a[lane] + second[1] * b[lane])
                + (second[2] * c[lane] + second[3] * d[lane]);
        }
        (one[block], two[block]) = (x, y);
    }
}

/// Takes what four columns explain from the last one.
#[inline(always)]
fn take_from_one(panel: &[Block], last: &mut [Block], blocks: usize, column: usize) {
    let (start, lane) = (column / LANES, column % LANES);
    for known in panel.chunks_exact(blocks) {
        let by = known[start][lane];
        for block in start..blocks {
            let known = known[block];
            let mut values = last[block];
            for lane in 0..LANES {
                values[lane] -= by * known[lane];
            }
            last[block] = values;
        }
    }
}

/// Entries above the diagonal are zero, as the loops take for granted.
#[inline(always)]
fn clear_above(values: &mut [Block], size: usize, blocks: usize) {
    for column in 0..size {
        // The second of a pair begins in the block of the first.
        for row in column.saturating_sub(1) / LANES * LANES..column {
            values[column * blocks + row / LANES][row % LANES] = 0.0;
        }
    }
}

pub(super) struct AddShare<'a> {
    pub(super) into: &'a mut [Block],
    pub(super) share: f64,
    pub(super) from: &'a [Block],
}

impl pulp::NullaryFnOnce for AddShare<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { into, share, from } = self;
        let from = &from[..into.len()];
        for block in 0..into.len() {
            let (mut values, from) = (into[block], from[block]);
            for lane in 0..LANES {
                values[lane] += share * from[lane];
            }
            into[block] = values;
        }
    }
}

pub(super) struct Solve<'a> {
    pub(super) factor: &'a Lower,
    pub(super) right: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        solve_lower(self.factor, self.right);
    }
}

/// L⁻¹·b in place.
#[inline(always)]
pub(super) fn solve_lower(factor: &Lower, right: &mut [f64]) {
    let size = factor.size;
    for row in 0..size {
        let column = &factor.values[row * factor.blocks..][..factor.blocks];
        let column = &column.as_flattened()[row..size];
        let right = &mut right[row..size];
        let value = right[0] / column[0];
        right[0] = value;
        for i in 1..column.len() {
            right[i] -= value * column[i];
        }
    }
}

pub(super) struct Invert<'a> {
    pub(super) factor: &'a Lower,
}

impl pulp::NullaryFnOnce for Invert<'_> {
    type Output = Inverse;

    /// Row after row, a block of columns at a time: each row lacks what all rows before explain of it.
    #[inline(always)]
    fn call(self) -> Inverse {
        let Lower { size, blocks, values: ref known } = *self.factor;
        let mut rows = vec![[0.0; LANES]; size * blocks];
        for block in 0..blocks {
            let first = block * LANES;
            for lane in 0..LANES.min(size - first) {
                rows[(first + lane) * blocks + block][lane] = 1.0;
            }
            for row in first..size {
                let column = &known[row * blocks..][..blocks].as_flattened()[..size];
                let share = 1.0 / column[row];
                let mut own = rows[row * blocks + block];
                for lane in 0..LANES {
                    own[lane] *= share;
                }
                rows[row * blocks + block] = own;
                let mut at = (row + 1) * blocks + block;
                for later in row + 1..size {
                    let by = column[later];
                    let mut values = rows[at];
                    for lane in 0..LANES {
                        values[lane] -= by * own[lane];
                    }
                    rows[at] = values;
                    at += blocks;
                }
            }
        }
        Inverse { size, blocks, rows }
    }
}

pub(super) struct SubtractProducts<'a> {
    pub(super) from: &'a mut Lower,
    pub(super) of: &'a Mat<f64>,
    pub(super) first: usize,
}

impl pulp::NullaryFnOnce for SubtractProducts<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { from, of, first } = self;
        for column in 0..from.size {
            let known = of.col_as_slice(first + column);
            for row in column..from.size {
                *from.at_mut(row, column) -= dot(of.col_as_slice(first + row), known);
            }
        }
    }
}

pub(super) struct TransposedTimesItself<'a> {
    pub(super) of: &'a Inverse,
}

impl pulp::NullaryFnOnce for TransposedTimesItself<'_> {
    type Output = Lower;

    /// The sum of every row's product with itself, four rows at a time into two columns.
    #[inline(always)]
    fn call(self) -> Lower {
        let Inverse { size, blocks, ref rows } = *self.of;
        let mut product = Lower::zeros(size);
        let whole = size / TOGETHER * TOGETHER;
        for row in (0..whole).step_by(TOGETHER) {
            let rows = &rows[row * blocks..][..TOGETHER * blocks];
            let mut column = 0;
            for pair in product.values[..(row + TOGETHER) * blocks].chunks_exact_mut(2 * blocks) {
                add_to_pair(rows, pair, (row + TOGETHER - 1) / LANES + 1, column);
                column += 2;
            }
        }
        for row in whole..size {
            let own = &rows[row * blocks..][..blocks];
            for column in 0..=row {
                let by = own[column / LANES][column % LANES];
                let into = &mut product.values[column * blocks..][..blocks];
                for block in column / LANES..=row / LANES {
                    let own = own[block];
                    let mut values = into[block];
                    for lane in 0..LANES {
                        values[lane] += by * own[lane];
                    }
                    into[block] = values;
                }
            }
        }
        clear_above(&mut product.values, size, blocks);
        product
    }
}

/// Adds the products of four rows, up to a block, to two columns that lie in one block of rows.
#[inline(always)]
fn add_to_pair(rows: &[Block], pair: &mut [Block], end: usize, column: usize) {
    let blocks = rows.len() / TOGETHER;
    let (start, lane) = (column / LANES, column % LANES);
    let a = &rows[start..end];
    let b = &rows[blocks..][start..end];
    let c = &rows[2 * blocks..][start..end];
    let d = &rows[3 * blocks..][start..end];
    let first = [a[0][lane], b[0][lane], c[0][lane], d[0][lane]];
    let second = [a[0][lane + 1], b[0][lane + 1], c[0][lane + 1], d[0][lane + 1]];
    let (one, two) = pair.split_at_mut(blocks);
    let (one, two) = (&mut one[start..end], &mut two[start..end]);
    for block in 0..end - start {
        let (a, b, c, d) = (a[block], b[block], c[block], d[block]);
        let (mut x, mut y) = (one[block], two[block]);
        for lane in 0..LANES {
            x[lane] += (first[0] * a[lane] + first[1] * b[lane])
                + (first[2] * c[lane] + first[3] * d[lane]);
        }
        for lane in 0..LANES {
            y[lane] += (second[0] * a[lane] + second[1] * b[lane])
                + (second[2] * c[lane] + second[3] * d[lane]);
        }
        (one[block], two[block]) = (x, y);
    }
}

#[inline(always)]
fn sum([a, b, c, d, e, f, g, h]: Block) -> f64 {
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

/// Σ a·b.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, a_rest) = a.as_chunks::<LANES>();
    let (b, b_rest) = b[..a.len() * LANES + a_rest.len()].as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for k in 0..a.len() {
        let (a, b) = (a[k], b[k]);
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let mut rest = 0.0;
    for k in 0..a_rest.len() {
        rest += a_rest[k] * b_rest[k];
    }
    sum(sums) + rest
}
