//! Flights between two changes: sums that grow by one flight at a time, and how well a straight line explains a piece.

use crate::settings::ChangeBeliefs;

/// Running sums of weight, x (years), y (%) and their products; the sums of any piece are differences of two.
#[derive(Clone, Debug)]
pub(crate) struct RunningSums {
    rows: Vec<[f64; 6]>,
}

/// A piece: weight, means, and sums of squares and products about the means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    pub(crate) weight: f64,
    pub(crate) mean_x: f64,
    pub(crate) mean_y: f64,
    pub(crate) sxx: f64,
    pub(crate) sxy: f64,
    pub(crate) syy: f64,
}

impl RunningSums {
    pub(crate) fn new() -> Self {
        Self { rows: vec![[0.0; 6]] }
    }

    pub(crate) fn push(&mut self, x: f64, y: f64, weight: f64) {
        let last = self.rows[self.rows.len() - 1];
        let step = [1.0, x, x * x, y, x * y, y * y];
        self.rows.push(core::array::from_fn(|k| last[k] + weight * step[k]));
    }

    /// The flights `from..to`; at least one.
    pub(crate) fn piece(&self, from: usize, to: usize) -> Piece {
        let (a, b) = (&self.rows[from], &self.rows[to]);
        let [weight, x, xx, y, xy, yy] = core::array::from_fn(|k| b[k] - a[k]);
        let (mean_x, mean_y) = (x / weight, y / weight);
        Piece {
            weight,
            mean_x,
            mean_y,
            // Rounding may leave a piece of one flight slightly below zero.
            sxx: (xx - x * mean_x).max(0.0),
            sxy: xy - x * mean_y,
            syy: (yy - y * mean_y).max(0.0),
        }
    }
}

/// A density as factor·e^exponent: one logarithm fewer than its logarithm takes, and no overflow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Evidence {
    pub(crate) factor: f64,
    pub(crate) exponent: f64,
}

impl Piece {
    /// Density of a piece's deviations, less Π √(w/2π), which no division into pieces changes.
    ///
    /// ```text
    /// ½ Σ_o exp −½ [Syy + ln(1 + s²W) + ȳ²W/(1 + s²W) + ln(1 + o²Sxx) − o²Sxy²/(1 + o²Sxx)]  [monitoring.6]
    /// ```
    ///
    /// The line's level at the piece's mean date is normal about 0 with deviation s, its slope about 0 with one of two
    /// deviations o; both are integrated out, which charges each piece for its two parameters.
    pub(crate) fn evidence(&self, beliefs: &ChangeBeliefs) -> Evidence {
        let of_level = 1.0 + beliefs.level_deviation_percent.powi(2) * self.weight;
        let square = self.syy + self.mean_y * self.mean_y * self.weight / of_level;
        let by_slope = |deviation: f64| {
            let slope = deviation * deviation;
            let of_slope = 1.0 + slope * self.sxx;
            (slope * self.sxy * self.sxy / of_slope, (of_level * of_slope).sqrt())
        };
        let (gain, volume) = by_slope(beliefs.slope_deviation_percent_per_year);
        let (small_gain, small_volume) = by_slope(beliefs.small_slope_deviation_percent_per_year);
        // The larger gain stands outside, so that no exponential is too large.
        let less = (-0.5 * (gain - small_gain).abs()).exp();
        let (of_gain, of_small_gain) = if gain >= small_gain { (1.0, less) } else { (less, 1.0) };
        Evidence {
            factor: 0.5 * (of_gain / volume + of_small_gain / small_volume),
            exponent: -0.5 * (square - gain.max(small_gain)),
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    /// Oracle: the mean of two multivariate normal densities with covariance D + s²·11ᵀ + o²·xxᵀ, by dense Cholesky.
    #[test]
    fn evidence_is_the_dense_normal_density() {
        let beliefs = ChangeBeliefs::of_2026();
        let x = [0.1, 0.25, 0.3, 0.9, 1.4];
        let y = [0.4, -0.3, 1.1, 0.2, 0.9];
        let w = [4.0, 1.0, 2.5, 0.7, 3.0];
        let mut sums = RunningSums::new();
        sums.push(-3.0, 7.0, 2.0); // not of the piece
        for k in 0..5 {
            sums.push(x[k], y[k], w[k]);
        }
        let piece = sums.piece(1, 6);
        let y = DVector::from_row_slice(&y);
        let log_density = |slope: f64| {
            let covariance = DMatrix::from_fn(5, 5, |i, j| {
                beliefs.level_deviation_percent.powi(2)
                    + slope.powi(2) * (x[i] - piece.mean_x) * (x[j] - piece.mean_x)
                    + if i == j { 1.0 / w[i] } else { 0.0 }
            });
            let cholesky = covariance.cholesky().unwrap();
            let square = y.dot(&cholesky.solve(&y));
            let log_determinant = 2.0 * cholesky.l().diagonal().map(f64::ln).sum();
            let left_out: f64 = w.iter().map(|w| w.ln()).sum();
            -0.5 * (square + log_determinant + left_out)
        };
        let ages = log_density(beliefs.slope_deviation_percent_per_year);
        let hardly = log_density(beliefs.small_slope_deviation_percent_per_year);
        assert!((ages - hardly).abs() > 0.1, "the two slopes are told apart");
        let dense = (0.5 * (ages.exp() + hardly.exp())).ln();
        let evidence = piece.evidence(&beliefs);
        assert!((evidence.factor.ln() + evidence.exponent - dense).abs() < 1e-10);
    }
}
