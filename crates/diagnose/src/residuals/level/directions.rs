//! The variance of what a model has learnt, in independent directions.
//!
//! A difficult file. With L the lower Cholesky factor of the covariance of the coefficients, the variance at a point whose terms
//! are x is |Lᵀx|². The terms of a smooth function depend on one variable, so that their part of Lᵀx is a curve in as many
//! directions as L has columns: it is tabulated, and a point costs four rows of the table instead of exponentials and their
//! products with L. The same holds for the drag table's loadings, bilinear between nodes, of which each gets a row. L is
//! triangular: a term has no part in directions after its own. Terms are ordered so that those with most rows come first.

#![expect(clippy::needless_range_loop, reason = "loops count, as those over lanes")]

use std::sync::OnceLock;

use faer::Mat;
use lut::Cells;
use perf_model::LevelBlock;

use crate::baseline::Baseline;
use crate::math::cholesky::Cholesky;
use crate::math::lanes::{LANES, Lanes, WHOLE, add_product, lowest_bits, map};
use crate::residuals::level::functions::{Functions, MOST, Tabulated, Values};
use crate::signals::table_uncertainty::TableUncertainty;

/// Directions that are summed together: two of the widest vectors that are compiled for. With more of them, more are summed that a term
/// does not reach.
const TOGETHER: usize = 16;

/// Rows of a table for each length of a function. Cubics through four of them are off by 0.0234·f⁗·16⁻⁴ at most: a millionth of
/// the function's prior deviation, as the kernel's fourth derivative is 3.
const ROWS_PER_LENGTH: f64 = 16.0;

/// Lengths beyond the knots up to which a table goes: the kernel is 1e-14 there.
const TAIL_LENGTHS: f64 = 8.0;

/// Most products of two variables.
const MOST_PRODUCTS: usize = MOST * (MOST - 1) / 2;

/// Most drag rises.
pub(super) const MOST_RISES: usize = 8;

/// Some directions. Of single precision: a part in ten million, far below what a standard deviation is worth.
type Some32 = [f32; TOGETHER];

/// Rows of one length: for each [`TOGETHER`] directions that they reach to, their values row after row.
type Rows = Vec<Vec<Some32>>;

/// Learnt coefficients in independent directions.
#[derive(Clone, Debug)]
pub(super) struct Directions {
    products: Rows,
    rises: Rows,
    /// Functions by the number of their terms, fewest first: their places, and the tables.
    functions: Vec<(usize, Table)>,
    drag: Option<DragRows>,
    level: Rows,
}

/// A smooth function's part, at rows of equally distant places.
#[derive(Clone, Debug)]
struct Table {
    first: f64,
    count: usize,
    rows: Rows,
    /// What the part grows by for each length beyond the table.
    slope: Rows,
}

/// The drag table's part at its nodes, each computed when it is asked for: a large table has many that nobody visits.
#[derive(Clone, Debug)]
struct DragRows {
    uncertainty: TableUncertainty,
    /// A row for each loading.
    loadings: Rows,
    of_nodes: Vec<OnceLock<Vec<Some32>>>,
}

/// Where the points of a block lie in a function's table.
struct Places {
    /// First of four rows, their weights, and lengths beyond the table.
    first: [usize; LANES],
    weights: [Lanes; 4],
    beyond: Lanes,
}

/// The parts of the points of a block in [`TOGETHER`] directions.
type Parts = [Some32; LANES];

impl Directions {
    /// `rises` are places among the standing effects; `None` where the covariance is not positive definite.
    pub(super) fn new(baseline: &Baseline, functions: &Functions, rises: &[usize]) -> Option<Self> {
        let layout = baseline.layout();
        let of_functions = functions.places();
        let products = of_functions.last().map_or(1, |range| range.end)..baseline.products_end();
        let standing = layout.standing_effects.start;
        let mut by_terms: Vec<usize> = (0..of_functions.len()).collect();
        by_terms.sort_by_key(|function| of_functions[*function].len());
        let mut columns: Vec<usize> = products.clone().collect();
        columns.extend(rises.iter().map(|place| standing + place));
        for function in &by_terms {
            columns.extend(of_functions[*function].clone());
        }
        columns.extend(layout.drag.clone());
        columns.push(0);
        let factor = Factor::new(baseline, &columns)?;
        let mut next = products.len() + rises.len();
        let mut tables = Vec::new();
        for function in by_terms {
            let one = &functions.smooth()[function];
            tables.push((function, Table::new(one, &factor, next)));
            next += of_functions[function].len();
        }
        let nodes = baseline.table.as_ref().map(|uncertainty| DragRows {
            uncertainty: uncertainty.clone(),
            loadings: factor.rows(next, layout.drag.len()),
            of_nodes: vec![OnceLock::new(); uncertainty.grid().nodes()],
        });
        Some(Self {
            products: factor.rows(0, products.len()),
            rises: factor.rows(products.len(), rises.len()),
            functions: tables,
            drag: nodes,
            level: factor.rows(columns.len() - 1, 1),
        })
    }

    /// Adds the variance at each point of a block, whose drag rises have these slopes. Function by function: the rows of a table that
    /// points share stay in a near cache.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[inline(always)]
    pub(super) fn add_variances(
        &self,
        (values, rises): (&Values, &[Lanes]),
        points: &LevelBlock,
        variances: &mut Lanes,
    ) {
        let count = points.count.min(LANES);
        let blocks = self.level.len();
        let mut parts: Vec<Parts> = Vec::with_capacity(blocks);
        for rows in &self.level {
            parts.push([rows[0]; LANES]);
        }
        self.add_products((values, rises), count, &mut parts);
        for (function, table) in &self.functions {
            let places = table.places(values.lengths(*function));
            for block in 0..table.rows.len().min(blocks) {
                for place in 0..count {
                    table.add((&places, place), block, &mut parts[block][place]);
                }
            }
        }
        if let Some(drag) = &self.drag {
            drag.add(&points.cells, count, &mut parts);
        }
        for place in 0..count {
            variances[place] += sum_of_squares(&parts, place);
        }
    }

    /// Adds the parts of products of the variables and of drag rises.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn add_products(
        &self,
        (values, rises): (&Values, &[Lanes]),
        count: usize,
        parts: &mut [Parts],
    ) {
        let mut products = [[0.0; LANES]; MOST_PRODUCTS];
        let mut row = 0;
        for first in 0..self.functions.len().min(MOST) {
            for second in first + 1..self.functions.len().min(MOST) {
                let (a, b) = (values.factors(first), values.factors(second));
                add_product(&mut products[row], 1.0, a, b);
                row += 1;
            }
        }
        for (rows, times) in [(&self.products, &products[..]), (&self.rises, rises)] {
            for block in 0..rows.len().min(parts.len()) {
                for place in 0..count {
                    let mut sum = parts[block][place];
                    for k in 0..rows[block].len().min(times.len()) {
                        add_row(&mut sum, times[k][place], &rows[block][k]);
                    }
                    parts[block][place] = sum;
                }
            }
        }
    }
}

/// |part|² of a point, in an order that does not depend on the width of vectors.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn sum_of_squares(parts: &[Parts], place: usize) -> f64 {
    let mut squares = [0.0_f32; TOGETHER];
    for of_block in parts {
        let part = of_block[place];
        for k in 0..TOGETHER {
            squares[k] += part[k] * part[k];
        }
    }
    let mut sums = [0.0_f32; 8];
    for from in (0..TOGETHER).step_by(8) {
        for k in 0..8 {
            sums[k] += squares[from + k];
        }
    }
    let [a, b, c, d, e, f, g, h] = sums;
    let pair = |one: f32, other: f32| f64::from(one) + f64::from(other);
    (pair(a, b) + pair(c, d)) + (pair(e, f) + pair(g, h))
}

/// `sum += times·row`.
#[expect(clippy::inline_always, reason = "as above")]
#[inline(always)]
fn add_row(sum: &mut Some32, times: f64, row: &Some32) {
    let times = single(times);
    for k in 0..TOGETHER {
        sum[k] += times * row[k];
    }
}

impl Table {
    fn new(one: &Tabulated, factor: &Factor, start: usize) -> Self {
        let (first_knot, last_knot) = one.prepared().knots();
        let first = first_knot - TAIL_LENGTHS;
        let lengths = last_knot - first_knot + 2.0 * TAIL_LENGTHS;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some hundred")]
        let count = (lengths * ROWS_PER_LENGTH).ceil() as usize + 1;
        let terms = one.prepared().len();
        let mut rows: Rows = vec![Vec::new(); blocks(start + terms)];
        let mut of_place = vec![[0.0]; terms];
        for row in 0..count {
            one.prepared().write(&[first + row as f64 / ROWS_PER_LENGTH], &mut of_place);
            push(&mut rows, &factor.sum(start, of_place.iter().map(|[term]| *term)));
        }
        let mut slope: Rows = vec![Vec::new(); rows.len()];
        push(&mut slope, &factor.sum(start, core::iter::once(1.0)));
        Self { first, count, rows, slope }
    }

    /// Where points lie in it, in lengths: on a cubic through four rows, beyond the table on a straight line.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn places(&self, z: &Lanes) -> Places {
        let (last, last_low) = ((self.count - 1) as f64, (self.count - 3) as f64);
        let t = map(z, |z| (z - self.first) * ROWS_PER_LENGTH);
        let held = map(&t, |t| if t > 0.0 { t } else { 0.0 });
        let held = map(&held, |t| if t < last { t } else { last });
        // Its second row: the whole number below or, where it is as good, above.
        let low = map(&held, |t| if t > 1.5 { t - 0.5 } else { 1.0 });
        let low = map(&low, |t| if t < last_low { t } else { last_low } + WHOLE);
        let none = [0.0; LANES];
        let mut places = Places { first: [0; LANES], weights: [none; 4], beyond: none };
        for lane in 0..LANES {
            let x = held[lane] - (low[lane] - WHOLE);
            let (below, above, far) = (x + 1.0, x - 1.0, x - 2.0);
            places.weights[0][lane] = -SIXTH * (x * above * far);
            places.weights[1][lane] = 0.5 * (below * above * far);
            places.weights[2][lane] = -0.5 * (below * x * far);
            places.weights[3][lane] = SIXTH * (below * x * above);
            places.beyond[lane] = (t[lane] - held[lane]) / ROWS_PER_LENGTH;
        }
        for lane in 0..LANES {
            places.first[lane] = lowest_bits(low[lane]) - 1;
        }
        places
    }

    /// Adds its part at a point.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn add(&self, (places, place): (&Places, usize), block: usize, part: &mut Some32) {
        let mut sum = *part;
        let first = places.first[place];
        let rows = &self.rows[block][first..first + 4];
        for k in 0..4 {
            add_row(&mut sum, places.weights[k][place], &rows[k]);
        }
        let beyond = places.beyond[place];
        if beyond != 0.0 {
            add_row(&mut sum, beyond, &self.slope[block][0]);
        }
        *part = sum;
    }
}

const SIXTH: f64 = 1.0 / 6.0;

impl DragRows {
    /// Adds the parts at points.
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn add(&self, cells: &Cells<LANES>, count: usize, parts: &mut [Parts]) {
        for place in 0..count {
            let (weights, [a, b, c, d]) = (cells.weights(place), cells.nodes(place));
            let nodes = [self.row(a), self.row(b), self.row(c), self.row(d)];
            for block in 0..parts.len() {
                let mut sum = parts[block][place];
                for k in 0..4 {
                    if block < nodes[k].len() {
                        add_row(&mut sum, weights[k], &nodes[k][block]);
                    }
                }
                parts[block][place] = sum;
            }
        }
    }

    #[inline]
    fn row(&self, node: usize) -> &[Some32] {
        let Some(row) = self.of_nodes.get(node) else { return &[] };
        row.get_or_init(|| {
            let loadings = self.uncertainty.row(node);
            let of_block = |rows: &Vec<Some32>| {
                let mut sum = [0.0; TOGETHER];
                for (loading, row) in loadings.iter().zip(rows) {
                    for (sum, value) in sum.iter_mut().zip(row) {
                        *sum += loading * f64::from(*value);
                    }
                }
                sum.map(single)
            };
            self.loadings.iter().map(of_block).collect()
        })
    }
}

/// Adds a row, with zeros to its end.
fn push(rows: &mut Rows, row: &[f64]) {
    for (block, of_block) in rows.iter_mut().enumerate() {
        let mut values = [0.0; TOGETHER];
        for (slot, value) in values.iter_mut().zip(row.iter().skip(block * TOGETHER)) {
            *slot = single(*value);
        }
        of_block.push(values);
    }
}

/// How many times [`TOGETHER`] directions the first terms reach to.
fn blocks(terms: usize) -> usize {
    terms.div_ceil(TOGETHER).max(1)
}

/// The lower Cholesky factor of a covariance.
struct Factor {
    /// Row after row up to the diagonal.
    rows: Vec<Vec<f64>>,
}

impl Factor {
    /// Of these columns of a baseline's covariance.
    fn new(baseline: &Baseline, columns: &[usize]) -> Option<Self> {
        let rows = baseline.factor();
        let rows =
            Mat::from_fn(columns.len(), rows.ncols(), |row, column| rows[(columns[row], column)]);
        let factor = Cholesky::new(&(&rows * rows.transpose()))?;
        let lower = factor.lower();
        let row = |row: usize| (0..=row).map(|column| lower[(row, column)]).collect();
        Some(Self { rows: (0..lower.nrows()).map(row).collect() })
    }

    /// The part of terms from `start` on.
    fn sum(&self, start: usize, terms: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut sum = Vec::new();
        for (row, term) in self.rows[start..].iter().zip(terms) {
            sum.resize(row.len(), 0.0);
            for (sum, value) in sum.iter_mut().zip(row) {
                *sum += value * term;
            }
        }
        sum
    }

    /// Rows of the factor itself, all as wide as the last.
    fn rows(&self, start: usize, count: usize) -> Rows {
        let mut rows: Rows = vec![Vec::new(); blocks(start + count)];
        for row in start..start + count {
            push(&mut rows, &self.sum(row, core::iter::once(1.0)));
        }
        rows
    }
}

#[expect(clippy::cast_possible_truncation, reason = "single precision is meant")]
const fn single(value: f64) -> f32 {
    value as f32
}
