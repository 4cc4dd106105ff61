//! What a guide's rows say of drag by level, beside a table over lift coefficient and Mach number.

use lut::{SmoothCell, Table};
use nalgebra::{Matrix3, Vector3};
use units::PressureAltitude;

/// A guide as a book to be read: drag over lift coefficient and Mach number, times a factor by level.
///
/// Reynolds number, part load and the temperature in TSFC vary with the level where lift coefficient and Mach number do not: rows
/// of guides that know them are 1 to 3 % off any table.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideBook {
    /// Drag coefficient where the factor is 1.
    pub drag_table: Table,
    /// By how much it is more at each level.
    pub levels: GuideLevels,
}

/// By how much the drag of a guide's rows exceeds that of a table at each of its levels: a plane over lift coefficient and Mach
/// number at each. Empty where rows of one level differ as much from each other as levels do.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GuideLevels {
    /// Smallest and largest lift coefficient and Mach number of the rows.
    ranges: [(f64, f64); 2],
    levels: Vec<GuideLevel>,
}

/// One level of a guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideLevel {
    /// Pressure altitude, m.
    pub pressure_altitude_m: f64,
    /// Drag by the rows over that by the table, less 1: in the middle of lift coefficients and Mach numbers, and how much more it
    /// is at the largest of either.
    pub shares: [f64; 3],
}

/// A place in a guide.
#[derive(Clone, Copy, Debug)]
pub struct GuidePlace {
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Mach number.
    pub mach: f64,
    /// Pressure altitude.
    pub pressure_altitude: PressureAltitude,
}

/// Numbers that are no levels of a guide.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GuideLevelError {
    /// A level.
    #[error("level {0} m: expected pressure altitudes that rise, and shares between -0.5 and 0.5")]
    Level(f64),
    /// A range.
    #[error("from {0} to {1}: expected a range of lift coefficients or Mach numbers")]
    Range(f64, f64),
}

impl GuideBook {
    /// Drag coefficient at a place, of which `cell` is that of the table.
    #[must_use]
    pub fn drag_coefficient(&self, cell: &SmoothCell, place: GuidePlace) -> f64 {
        self.levels.factor(place) * cell.value_of(&self.drag_table)
    }
}

impl GuideLevels {
    /// Levels that were written.
    ///
    /// # Errors
    /// Pressure altitudes that do not rise, shares that no level has, or ranges that are none.
    pub fn new(ranges: [(f64, f64); 2], levels: Vec<GuideLevel>) -> Result<Self, GuideLevelError> {
        for (low, high) in ranges {
            if !(low.is_finite() && high.is_finite() && low < high) {
                return Err(GuideLevelError::Range(low, high));
            }
        }
        let mut below = f64::NEG_INFINITY;
        for GuideLevel { pressure_altitude_m, shares } in &levels {
            let rises = pressure_altitude_m.is_finite() && *pressure_altitude_m > below;
            if !(rises && shares.iter().all(|share| share.abs() < 0.5)) {
                return Err(GuideLevelError::Level(*pressure_altitude_m));
            }
            below = *pressure_altitude_m;
        }
        Ok(Self { ranges, levels })
    }

    /// What rows leave of a table: places, and drag over that of the table, less 1.
    ///
    /// ```text
    /// b_k = V_k X_kᵀ r_k/s²,   V_k = (X_kᵀX_k/s² + diag(1/τ_j²))⁻¹                                      [bayes.16]
    /// τ_j² = mean_k (b_kj² + V_kjj),   s² = Σ_k (|r_k − X_k b_k|² + tr X_k V_k X_kᵀ)/N
    /// ```
    ///
    /// `r_k` are the shares at level k, the rows of `X_k` 1 and both places from -1 to 1. Variances are those of the largest
    /// evidence, by [`ROUNDS`] rounds of expectation and maximisation; what levels do not differ in shrinks to nothing.
    pub(super) fn of_rows(rows: &[(GuidePlace, f64)]) -> Self {
        let range = |of: fn(&GuidePlace) -> f64| {
            let values = rows.iter().map(|(place, _)| of(place));
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
        };
        let ranges = [range(|place| place.lift_coefficient), range(|place| place.mach)];
        let groups = by_level(rows, ranges);
        // A plane at each level is told by more rows than it has numbers.
        if groups.len() < 2 || rows.len() < 4 * groups.len() {
            return Self::default();
        }
        let count = rows.len() as f64;
        let mut within = rows.iter().map(|(_, share)| share * share).sum::<f64>() / count;
        let mut between = Vector3::repeat(within);
        let mut planes = Vec::new();
        for _ in 0..ROUNDS {
            let found = groups.iter().map(|of| of.plane(between, within));
            let Some(found) = found.collect::<Option<Vec<_>>>() else { return Self::default() };
            planes = found;
            let of_levels = planes.len() as f64;
            between = planes
                .iter()
                .map(|(plane, covariance)| plane.component_mul(plane) + covariance.diagonal())
                .sum::<Vector3<f64>>()
                / of_levels;
            within =
                groups.iter().zip(&planes).map(|(of, plane)| of.left(plane)).sum::<f64>() / count;
        }
        let levels = groups.iter().zip(&planes).map(|(of, (plane, _))| GuideLevel {
            pressure_altitude_m: of.pressure_altitude_m,
            shares: [plane[0], plane[1], plane[2]],
        });
        Self::new(ranges, levels.collect()).unwrap_or_default()
    }

    /// The levels, the lowest first.
    #[must_use]
    pub fn levels(&self) -> &[GuideLevel] {
        &self.levels
    }

    /// Smallest and largest lift coefficient and Mach number of the rows.
    #[must_use]
    pub const fn ranges(&self) -> [(f64, f64); 2] {
        self.ranges
    }

    /// Factor on the drag of the table: linear between levels, held below and above them and beyond the rows.
    #[must_use]
    pub fn factor(&self, place: GuidePlace) -> f64 {
        let at_m = place.pressure_altitude.to_meters();
        let above = self.levels.partition_point(|level| level.pressure_altitude_m <= at_m);
        let terms = terms(place, self.ranges);
        let share = |level: &GuideLevel| Vector3::from(level.shares).dot(&terms);
        let below = above.checked_sub(1).map(|k| &self.levels[k]);
        1.0 + match (below, self.levels.get(above)) {
            (Some(low), Some(high)) => {
                let span_m = high.pressure_altitude_m - low.pressure_altitude_m;
                let upper = (at_m - low.pressure_altitude_m) / span_m;
                share(low) + upper * (share(high) - share(low))
            }
            (Some(end), None) | (None, Some(end)) => share(end),
            (None, None) => 0.0,
        }
    }
}

/// Rounds of expectation and maximisation. Our choice.
const ROUNDS: usize = 60;

/// 1, and lift coefficient and Mach number from -1 to 1 over their ranges, held at their ends.
fn terms(place: GuidePlace, [lift, mach]: [(f64, f64); 2]) -> Vector3<f64> {
    let over = |value: f64, (low, high): (f64, f64)| {
        (2.0 * (value - low) / (high - low) - 1.0).clamp(-1.0, 1.0)
    };
    Vector3::new(1.0, over(place.lift_coefficient, lift), over(place.mach, mach))
}

/// Rows of one level: sums of products.
struct Group {
    pressure_altitude_m: f64,
    gram: Matrix3<f64>,
    product: Vector3<f64>,
    square: f64,
}

impl Group {
    /// The plane and its covariance; `None` where variances are none.
    fn plane(&self, between: Vector3<f64>, within: f64) -> Option<(Vector3<f64>, Matrix3<f64>)> {
        // Of S G S/s² + 1, with S the standard deviations: levels may differ in nothing.
        let scale = Matrix3::from_diagonal(&between.map(f64::sqrt));
        let inner = scale * self.gram * scale / within + Matrix3::identity();
        let covariance = scale * inner.cholesky()?.inverse() * scale;
        Some((covariance * self.product / within, covariance))
    }

    /// Sum of squares that a plane leaves, and of what is not known of it.
    fn left(&self, (plane, covariance): &(Vector3<f64>, Matrix3<f64>)) -> f64 {
        let fitted = self.square - 2.0 * plane.dot(&self.product) + plane.dot(&(self.gram * plane));
        fitted.max(0.0) + (self.gram * covariance).trace()
    }
}

/// Pressure altitudes that differ by less are one level, m: levels are printed to 100 ft, and converted.
const ONE_LEVEL_M: f64 = 10.0;

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
            let terms = terms(*place, ranges);
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
