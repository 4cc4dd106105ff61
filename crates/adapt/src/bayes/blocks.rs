//! A symmetric positive definite matrix over the nodes of a grid, in blocks along its diagonal.
//!
//! A difficult file. Nodes are taken row by row of one axis, and a block has enough rows that entries couple only
//! neighboring blocks: the matrix is block tridiagonal, and so is the part of its inverse that variances need. The
//! Cholesky factor has blocks L on the diagonal and B below it. The selected inverse S follows backwards (Takahashi,
//! Fagan and Chin 1973; here in blocks):
//!
//! ```text
//! A_{b+1,b} = B_b·L_bᵀ
//! G_b = B_b·L_b⁻¹      S_{b+1,b} = −S_{b+1,b+1}·G_b      S_{b,b} = (L_b·L_bᵀ)⁻¹ + G_bᵀ·S_{b+1,b+1}·G_b
//! ```
//!
//! One core on purpose (`Par::Seq`): the order of sums must not depend on the machine's load.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltError, LltParams, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, Auto, Mat, Par, Spec};
use lut::Grid;

/// Position of each node: blocks of whole rows, along the axis that makes the smaller blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layout {
    /// Nodes of the outer and of the inner axis, in the blocks' sense.
    outer: usize,
    inner: usize,
    /// Whether the grid's inner axis is the blocks' outer one.
    swapped: bool,
    rows_a_block: usize,
    grid_inner: usize,
}

impl Layout {
    /// A layout for entries that couple at most this many rows along x and along y.
    pub(super) fn new(grid: &Grid, reach_x: usize, reach_y: usize) -> Self {
        let (x, y) = (grid.x().len(), grid.y().len());
        let swapped = reach_y * x < reach_x * y;
        let (outer, inner, reach) = if swapped { (y, x, reach_y) } else { (x, y, reach_x) };
        Self { outer, inner, swapped, rows_a_block: reach.clamp(1, outer), grid_inner: y }
    }

    fn blocks(&self) -> usize {
        self.outer.div_ceil(self.rows_a_block)
    }

    fn block_size(&self, block: usize) -> usize {
        let rows = self.rows_a_block.min(self.outer - block * self.rows_a_block);
        rows * self.inner
    }

    /// Block of a node and its place in it.
    pub(super) fn place(&self, node: usize) -> (usize, usize) {
        let (x, y) = (node / self.grid_inner, node % self.grid_inner);
        let (row, column) = if self.swapped { (y, x) } else { (x, y) };
        (row / self.rows_a_block, row % self.rows_a_block * self.inner + column)
    }
}

/// The matrix, while it is summed. Only the lower triangle of diagonal blocks is used.
#[derive(Debug)]
pub(super) struct BlockMatrix {
    layout: Layout,
    /// Position of every node: thousands of additions would otherwise divide for it again and again.
    places: Vec<(usize, usize)>,
    diagonal: Vec<Mat<f64>>,
    below: Vec<Mat<f64>>,
}

impl BlockMatrix {
    pub(super) fn zeros(layout: Layout) -> Self {
        let blocks = layout.blocks();
        let size = |block: usize| layout.block_size(block);
        Self {
            layout,
            places: (0..layout.outer * layout.inner).map(|node| layout.place(node)).collect(),
            diagonal: (0..blocks).map(|b| Mat::zeros(size(b), size(b))).collect(),
            below: (1..blocks).map(|b| Mat::zeros(size(b), size(b - 1))).collect(),
        }
    }

    /// Adds to the entry of two nodes (and its mirror image).
    pub(super) fn add(&mut self, node: usize, other: usize, value: f64) {
        let (mut later, mut earlier) = (self.places[node], self.places[other]);
        if later < earlier {
            (later, earlier) = (earlier, later);
        }
        if later.0 == earlier.0 {
            self.diagonal[later.0][(later.1, earlier.1)] += value;
        } else {
            debug_assert_eq!(later.0, earlier.0 + 1, "entries couple neighboring blocks only");
            self.below[earlier.0][(later.1, earlier.1)] += value;
        }
    }

    /// The Cholesky factor; `None` where the matrix is not positive definite.
    pub(super) fn factor(mut self) -> Option<BlockFactor> {
        for block in 0..self.diagonal.len() {
            if block > 0 {
                let above = &self.below[block - 1];
                let diagonal = &mut self.diagonal[block];
                matmul(diagonal.as_mut(), Accum::Add, above, above.transpose(), -1.0, Par::Seq);
            }
            cholesky(&mut self.diagonal[block]).ok()?;
            if let Some(below) = self.below.get_mut(block) {
                let lower = self.diagonal[block].as_ref();
                solve_lower_triangular_in_place(lower, below.as_mut().transpose_mut(), Par::Seq);
            }
        }
        Some(BlockFactor { layout: self.layout, lower: self.diagonal, below: self.below })
    }
}

/// A Cholesky factor in blocks. The diagonal blocks hold unused values above their diagonal.
#[derive(Clone, Debug)]
pub(super) struct BlockFactor {
    layout: Layout,
    lower: Vec<Mat<f64>>,
    below: Vec<Mat<f64>>,
}

impl BlockFactor {
    /// Natural logarithm of the matrix' determinant.
    pub(super) fn log_determinant(&self) -> f64 {
        let logs = |lower: &Mat<f64>| (0..lower.nrows()).map(|k| lower[(k, k)].ln()).sum::<f64>();
        2.0 * self.lower.iter().map(logs).sum::<f64>()
    }

    /// A⁻¹·v, both in node order.
    pub(super) fn solve(&self, vector: &[f64]) -> Vec<f64> {
        let mut parts = self.parts(1);
        for (node, &value) in vector.iter().enumerate() {
            let (block, place) = self.layout.place(node);
            parts[block][(place, 0)] = value;
        }
        self.solve_column(&mut parts);
        (0..vector.len())
            .map(|node| {
                let (block, place) = self.layout.place(node);
                parts[block][(place, 0)]
            })
            .collect()
    }

    /// L⁻ᵀ·z in node order, for independent standard normal numbers z: a vector of covariance A⁻¹.
    pub(super) fn correlate(&self, standard_normal: &[f64]) -> Vec<f64> {
        let mut parts = self.parts(1);
        for (node, &value) in standard_normal.iter().enumerate() {
            let (block, place) = self.layout.place(node);
            parts[block][(place, 0)] = value;
        }
        self.solve_upper(&mut parts);
        (0..standard_normal.len())
            .map(|node| {
                let (block, place) = self.layout.place(node);
                parts[block][(place, 0)]
            })
            .collect()
    }

    /// Rᵀ·A⁻¹·R for columns R given as (node, value) lists: covariances of linear combinations of nodes.
    pub(super) fn quadratic_forms(&self, columns: &[Vec<(usize, f64)>]) -> Mat<f64> {
        let mut parts = self.parts(columns.len());
        for (column, entries) in columns.iter().enumerate() {
            for &(node, value) in entries {
                let (block, place) = self.layout.place(node);
                parts[block][(place, column)] += value;
            }
        }
        self.solve_lower(&mut parts);
        let mut forms = Mat::zeros(columns.len(), columns.len());
        for part in &parts {
            matmul(forms.as_mut(), Accum::Add, part.transpose(), part, 1.0, Par::Seq);
        }
        forms
    }

    /// The inverse's blocks on and next to the diagonal.
    pub(super) fn selected_inverse(&self) -> SelectedInverse {
        let last = self.lower.len() - 1;
        let mut diagonal = Vec::with_capacity(last + 1);
        let mut below = Vec::with_capacity(last);
        diagonal.push(inverse(&self.lower[last]));
        for block in (0..last).rev() {
            let (later, earlier) = (self.below[block].nrows(), self.below[block].ncols());
            // G = B·L⁻¹ is solved as Gᵀ = L⁻ᵀ·Bᵀ.
            let mut gain = self.below[block].clone();
            let upper = self.lower[block].transpose();
            solve_upper_triangular_in_place(upper, gain.as_mut().transpose_mut(), Par::Seq);
            let mut neighbor = Mat::zeros(later, earlier);
            let after = &diagonal[diagonal.len() - 1];
            matmul(neighbor.as_mut(), Accum::Replace, after, &gain, -1.0, Par::Seq);
            let mut own = inverse(&self.lower[block]);
            matmul(own.as_mut(), Accum::Add, gain.transpose(), &neighbor, -1.0, Par::Seq);
            diagonal.push(own);
            below.push(neighbor);
        }
        diagonal.reverse();
        below.reverse();
        SelectedInverse { layout: self.layout, diagonal, below }
    }

    fn parts(&self, columns: usize) -> Vec<Mat<f64>> {
        self.lower.iter().map(|lower| Mat::zeros(lower.nrows(), columns)).collect()
    }

    /// A single column, of which the solves below cost a dozen times the arithmetic.
    fn solve_column(&self, parts: &mut [Mat<f64>]) {
        for block in 0..parts.len() {
            let (before, rest) = parts.split_at_mut(block);
            let part = rest[0].col_as_slice_mut(0);
            if let Some(previous) = before.last() {
                let below = &self.below[block - 1];
                for (column, by) in previous.col_as_slice(0).iter().enumerate() {
                    subtract(part, *by, below.col_as_slice(column));
                }
            }
            let lower = &self.lower[block];
            for row in 0..part.len() {
                let column = &lower.col_as_slice(row)[row..];
                let value = part[row] / column[0];
                part[row] = value;
                subtract(&mut part[row + 1..], value, &column[1..]);
            }
        }
        self.solve_column_upper(parts);
    }

    fn solve_column_upper(&self, parts: &mut [Mat<f64>]) {
        for block in (0..parts.len()).rev() {
            let (before, after) = parts.split_at_mut(block + 1);
            let part = before[block].col_as_slice_mut(0);
            if let Some(next) = after.first() {
                let below = &self.below[block];
                for (column, value) in part.iter_mut().enumerate() {
                    *value -= product(below.col_as_slice(column), next.col_as_slice(0));
                }
            }
            let lower = &self.lower[block];
            for row in (0..part.len()).rev() {
                let column = &lower.col_as_slice(row)[row..];
                let known = product(&column[1..], &part[row + 1..]);
                part[row] = (part[row] - known) / column[0];
            }
        }
    }

    fn solve_lower(&self, parts: &mut [Mat<f64>]) {
        for block in 0..parts.len() {
            let (before, rest) = parts.split_at_mut(block);
            let part = &mut rest[0];
            if let Some(previous) = before.last() {
                let below = &self.below[block - 1];
                matmul(part.as_mut(), Accum::Add, below, previous, -1.0, Par::Seq);
            }
            solve_lower_triangular_in_place(self.lower[block].as_ref(), part.as_mut(), Par::Seq);
        }
    }

    fn solve_upper(&self, parts: &mut [Mat<f64>]) {
        for block in (0..parts.len()).rev() {
            let (before, after) = parts.split_at_mut(block + 1);
            let part = &mut before[block];
            if let Some(next) = after.first() {
                let below = self.below[block].transpose();
                matmul(part.as_mut(), Accum::Add, below, next, -1.0, Par::Seq);
            }
            solve_upper_triangular_in_place(self.lower[block].transpose(), part.as_mut(), Par::Seq);
        }
    }
}

/// `a −= by·b`.
fn subtract(a: &mut [f64], by: f64, b: &[f64]) {
    for (a, b) in a.iter_mut().zip(b) {
        *a -= by * b;
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The inverse at the positions where the matrix has blocks.
#[derive(Clone, Debug)]
pub(super) struct SelectedInverse {
    layout: Layout,
    diagonal: Vec<Mat<f64>>,
    below: Vec<Mat<f64>>,
}

impl SelectedInverse {
    /// The inverse's entry for two nodes of the same or of neighboring blocks; the corners of a cell always are.
    pub(super) fn entry(&self, node: usize, other: usize) -> f64 {
        let (mut later, mut earlier) = (self.layout.place(node), self.layout.place(other));
        if later < earlier {
            (later, earlier) = (earlier, later);
        }
        if later.0 == earlier.0 {
            self.diagonal[later.0][(later.1, earlier.1)]
        } else {
            debug_assert_eq!(later.0, earlier.0 + 1, "only neighboring blocks are kept");
            self.below[earlier.0][(later.1, earlier.1)]
        }
    }
}

fn cholesky(matrix: &mut Mat<f64>) -> Result<(), LltError> {
    let parameters: Spec<LltParams, f64> = <LltParams as Auto<f64>>::auto().into();
    let need = cholesky_in_place_scratch::<f64>(matrix.nrows(), Par::Seq, parameters);
    let mut memory = MemBuffer::new(need);
    let stack = MemStack::new(&mut memory);
    let exact = LltRegularization::default();
    cholesky_in_place(matrix.as_mut(), exact, Par::Seq, stack, parameters).map(|_| ())
}

/// (L·Lᵀ)⁻¹ in full.
fn inverse(lower: &Mat<f64>) -> Mat<f64> {
    let mut inverse = Mat::identity(lower.nrows(), lower.nrows());
    solve_lower_triangular_in_place(lower.as_ref(), inverse.as_mut(), Par::Seq);
    solve_upper_triangular_in_place(lower.transpose(), inverse.as_mut(), Par::Seq);
    inverse
}
