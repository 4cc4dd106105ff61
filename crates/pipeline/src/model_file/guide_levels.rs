//! What a guide's rows say of drag by level, beside a table over lift coefficient and Mach number.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use perf_model::{GuideLevel, GuideLevels, GuidePlace, guide_terms};

/// What rows leave of a table by level: places, and drag over that of the table, less 1; `None` where there are too few rows.
///
/// ```text
/// r_k = X_k (b_k + e_k) + ε,   b_kj = u_j0 + u_j1 h_k + Σ_i w_ji·max(0, h_k − h_i)                        [bayes.16]
/// u ~ N(0, σ_j²),   w_ji ~ N(0, ω_j²·(h_i+1 − h_i−1)/2),   e_kj ~ N(0, τ_j²),   ε ~ N(0, s²)
/// ```
///
/// `r_k` are the shares at level k, the rows of `X_k` 1 and both places from -1 to 1, `h` the levels from -1 to 1. `b` is what drag
/// does over levels; what a level has of its own, `e`, is not: drag is smooth over levels, and rows that were flown at a level are
/// off together. Variances are those of the largest evidence, by [`ROUNDS`] rounds of expectation and maximisation, or
/// [`ROUNDS_NEARBY`] from those of nearly the same rows; what levels do not differ in shrinks to nothing.
pub(super) fn levels_of_rows(
    rows: &[(GuidePlace, f64)],
    nearby: Option<&Variances>,
) -> Option<(GuideLevels, Variances)> {
    let range = |of: fn(&GuidePlace) -> f64| {
        let values = rows.iter().map(|(place, _)| of(place));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    };
    let ranges = [range(|place| place.lift_coefficient), range(|place| place.mach)];
    let groups = by_level(rows, ranges);
    // A plane at each level is told by more rows than it has numbers.
    if !(2..=MOST_LEVELS).contains(&groups.len()) || rows.len() < 4 * groups.len() {
        return None;
    }
    let smooth = Smooth::new(&groups);
    let variances = smooth.likeliest(nearby, rows.len())?;
    let planes = smooth.planes(&variances)?;
    let levels = groups
        .iter()
        .zip(planes)
        .map(|(of, shares)| GuideLevel { pressure_altitude_m: of.pressure_altitude_m, shares });
    Some((GuideLevels::new(ranges, levels.collect()).ok()?, variances))
}

/// Pressure altitudes that differ by less are one level, m: levels are printed to 100 ft, and converted.
pub(super) const ONE_LEVEL_M: f64 = 10.0;

/// Guides print levels; where there are more than every thousand feet, rows are of flights that change their level.
const MOST_LEVELS: usize = 64;

/// Rounds of expectation and maximisation, from what is usual and from what was found of nearly the same rows. Our choice.
const ROUNDS: usize = 60;
const ROUNDS_NEARBY: usize = 8;

/// Planes that are smooth over levels.
struct Smooth<'a> {
    groups: &'a [Group],
    /// What every weight is at each level: levels down, weights across.
    basis: DMatrix<f64>,
    /// Of how much of ω² the variance of each weight is; of the first two weights of σ².
    widths: Vec<f64>,
}

/// Variances of the terms of [`levels_of_rows`], for each of the three of a plane where they are more.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variances {
    /// s².
    within: f64,
    /// τ².
    own: Vector3<f64>,
    /// σ².
    line: Vector3<f64>,
    /// ω².
    bend: Vector3<f64>,
}

/// Weights, three for each column of the basis, and how well they are known.
struct Weights {
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    /// Covariance of what each level has of its own where its plane is known.
    own: Vec<Matrix3<f64>>,
}

impl<'a> Smooth<'a> {
    /// Of two levels and more.
    fn new(groups: &'a [Group]) -> Self {
        let levels = groups.len();
        let (low, high) = (groups[0].pressure_altitude_m, groups[levels - 1].pressure_altitude_m);
        let at = |k: usize| 2.0 * (groups[k].pressure_altitude_m - low) / (high - low) - 1.0;
        let basis = DMatrix::from_fn(levels, levels, |k, column| match column {
            0 => 1.0,
            1 => at(k),
            _ => (at(k) - at(column - 1)).max(0.0),
        });
        let width = |column: usize| match column {
            0 | 1 => 1.0,
            _ => 0.5 * (at(column) - at(column - 2)),
        };
        Self { groups, basis, widths: (0..levels).map(width).collect() }
    }

    /// The plane at each level; `None` where variances are none.
    fn planes(&self, variances: &Variances) -> Option<Vec<[f64; 3]>> {
        let mean = self.weights(variances)?.mean;
        let plane = |k: usize| core::array::from_fn(|term| self.share(&mean, k, term));
        Some((0..self.groups.len()).map(plane).collect())
    }

    /// The variances of the largest evidence.
    fn likeliest(&self, nearby: Option<&Variances>, rows: usize) -> Option<Variances> {
        let square: f64 = self.groups.iter().map(|of| of.square).sum();
        let all = Vector3::repeat(square / rows as f64);
        let usual = Variances { within: all[0], own: all, line: all, bend: all };
        let mut found = nearby.copied().unwrap_or(usual);
        let rounds = if nearby.is_some() { ROUNDS_NEARBY } else { ROUNDS };
        for _ in 0..rounds {
            found = self.maximised(&found, &self.weights(&found)?, rows);
        }
        Some(found)
    }

    fn share(&self, weights: &DVector<f64>, level: usize, term: usize) -> f64 {
        self.bends_below(level).map(|(column, value)| value * weights[3 * column + term]).sum()
    }

    /// The columns of the basis that are not 0 at a level, with their values there.
    fn bends_below(&self, level: usize) -> impl Iterator<Item = (usize, f64)> {
        let values = self.basis.row(level);
        let columns = 0..values.len();
        columns.map(move |column| (column, values[column])).filter(|(_, value)| *value != 0.0)
    }

    /// The weights by these variances: what a level has of its own is integrated out.
    fn weights(&self, variances: &Variances) -> Option<Weights> {
        let size = 3 * self.groups.len();
        let mut precision = DMatrix::<f64>::zeros(size, size);
        let mut product = DVector::<f64>::zeros(size);
        let mut own = Vec::with_capacity(self.groups.len());
        let within = variances.within;
        for (level, of) in self.groups.iter().enumerate() {
            let of_own = of.own(variances)?;
            let left = Matrix3::identity() - of.gram * of_own / within;
            let (told, of_rows) = (left * of.gram / within, left * of.product / within);
            own.push(of_own);
            for (a, value) in self.bends_below(level) {
                let mut rows = product.fixed_rows_mut::<3>(3 * a);
                rows += of_rows * value;
                for (b, other) in self.bends_below(level) {
                    let mut block = precision.fixed_view_mut::<3, 3>(3 * a, 3 * b);
                    block += told * (value * other);
                }
            }
        }
        // Of S P S + 1, with S the standard deviations before the rows: a variance may be 0.
        let scale = DVector::from_fn(size, |weight, _| self.prior(variances, weight).sqrt());
        let inner = DMatrix::from_fn(size, size, |a, b| {
            let both = 0.5 * (precision[(a, b)] + precision[(b, a)]);
            scale[a] * both * scale[b] + if a == b { 1.0 } else { 0.0 }
        });
        let factor = inner.cholesky()?;
        let mean = factor.solve(&product.component_mul(&scale)).component_mul(&scale);
        let mut covariance = factor.inverse();
        for (a, b) in (0..size).flat_map(|a| (0..size).map(move |b| (a, b))) {
            covariance[(a, b)] *= scale[a] * scale[b];
        }
        Some(Weights { mean, covariance, own })
    }

    /// Variance of a weight before the rows.
    fn prior(&self, variances: &Variances, weight: usize) -> f64 {
        let (column, term) = (weight / 3, weight % 3);
        let of = if column < 2 { variances.line } else { variances.bend };
        of[term] * self.widths[column]
    }

    /// The variances under which what was found is likeliest.
    fn maximised(&self, before: &Variances, found: &Weights, rows: usize) -> Variances {
        let levels = self.groups.len();
        let none = Vector3::zeros();
        let mut next = Variances { within: 0.0, own: none, line: none, bend: none };
        for (level, (of, own)) in self.groups.iter().zip(&found.own).enumerate() {
            let smooth = Vector3::from_fn(|term, _| self.share(&found.mean, level, term));
            let of_smooth = self.covariance_at(found, level);
            let lean = own * of.gram / before.within;
            let beside = own * (of.product - of.gram * smooth) / before.within;
            let of_beside = own + lean * of_smooth * lean.transpose();
            next.own += beside.component_mul(&beside) + of_beside.diagonal();
            let left = Matrix3::identity() - lean;
            let both = left * of_smooth * left.transpose() + own;
            next.within += of.left(&(smooth + beside), &both);
        }
        next.own /= levels as f64;
        next.within /= rows as f64;
        for weight in 0..3 * levels {
            let (column, term) = (weight / 3, weight % 3);
            let square = found.mean[weight].powi(2) + found.covariance[(weight, weight)];
            let of = if column < 2 { &mut next.line } else { &mut next.bend };
            let count = if column < 2 { 2 } else { levels - 2 };
            of[term] += square / (self.widths[column] * count as f64);
        }
        next
    }

    /// Covariance of the plane at a level.
    fn covariance_at(&self, found: &Weights, level: usize) -> Matrix3<f64> {
        let mut covariance = Matrix3::zeros();
        for (a, value) in self.bends_below(level) {
            for (b, other) in self.bends_below(level) {
                let block = found.covariance.fixed_view::<3, 3>(3 * a, 3 * b);
                covariance += block * (value * other);
            }
        }
        covariance
    }
}

/// Rows of one level: sums of products.
struct Group {
    pressure_altitude_m: f64,
    gram: Matrix3<f64>,
    product: Vector3<f64>,
    square: f64,
}

impl Group {
    /// Covariance of what the level has of its own, where its smooth plane is known.
    fn own(&self, variances: &Variances) -> Option<Matrix3<f64>> {
        let scale = Matrix3::from_diagonal(&variances.own.map(f64::sqrt));
        let inner = scale * self.gram * scale / variances.within + Matrix3::identity();
        Some(scale * inner.cholesky()?.inverse() * scale)
    }

    /// Sum of squares that a plane leaves, and of what is not known of it.
    fn left(&self, plane: &Vector3<f64>, covariance: &Matrix3<f64>) -> f64 {
        let fitted = self.square - 2.0 * plane.dot(&self.product) + plane.dot(&(self.gram * plane));
        fitted.max(0.0) + (self.gram * covariance).trace()
    }
}

fn by_level(rows: &[(GuidePlace, f64)], ranges: [(f64, f64); 2]) -> Vec<Group> {
    let level_m = |row: &(GuidePlace, f64)| row.0.pressure_altitude.to_meters();
    let mut sorted = rows.to_vec();
    sorted.sort_by(|a, b| level_m(a).total_cmp(&level_m(b)));
    let groups = sorted.chunk_by(|a, b| level_m(b) - level_m(a) < ONE_LEVEL_M).map(|rows| {
        let mut group = Group {
            pressure_altitude_m: rows.iter().map(level_m).sum::<f64>() / rows.len() as f64,
            gram: Matrix3::zeros(),
            product: Vector3::zeros(),
            square: 0.0,
        };
        for (place, share) in rows {
            let terms = Vector3::from(guide_terms(*place, ranges));
            group.gram += terms * terms.transpose();
            group.product += *share * terms;
            group.square += share * share;
        }
        group
    });
    groups.collect()
}

#[cfg(test)]
mod tests;
