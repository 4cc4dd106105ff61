//! What flights that were not flown would add to the Gram of effects, nuisance integrated out.

use faer::{Mat, Par};

use crate::math::cholesky::Cholesky;

/// What the data at hand know of the nuisance: `LLᵀ = 1 + G_zz`, and how the nuisance imitates the columns,
/// `T = (1 + G_zz)⁻¹ G_zk`.
pub(crate) struct Known {
    factor: Option<Cholesky>,
    imitation: Mat<f64>,
}

/// Whitened rows of one flight: columns less what the nuisance makes of them, and `H = L⁻¹Zᵀ`.
pub(crate) struct FlightInformation {
    columns: Mat<f64>,
    reach: Mat<f64>,
}

impl Known {
    /// From the Gram of all columns: those of `kept`, and the nuisance, of unit prior variance.
    pub(crate) fn from_gram(
        gram: &Mat<f64>,
        kept: &[usize],
        nuisance: core::ops::Range<usize>,
    ) -> Option<Self> {
        let (first, count) = (nuisance.start, nuisance.len());
        let mut imitation = Mat::from_fn(count, kept.len(), |i, j| gram[(first + i, kept[j])]);
        if count == 0 {
            return Some(Self { factor: None, imitation });
        }
        let factor = Cholesky::new(&Mat::from_fn(count, count, |i, j| {
            gram[(first + i, first + j)] + if i == j { 1.0 } else { 0.0 }
        }))?;
        factor.solve(&mut imitation);
        Some(Self { factor: Some(factor), imitation })
    }

    /// A flight's whitened rows: columns first, then nuisance.
    pub(crate) fn flight(&self, rows: &Mat<f64>) -> FlightInformation {
        let (kept, count) = (self.imitation.ncols(), self.imitation.nrows());
        let nuisance = rows.subcols(kept, count);
        let mut columns = rows.subcols(0, kept).to_owned();
        let mut reach = nuisance.transpose().to_owned();
        if let Some(factor) = &self.factor {
            columns -= nuisance * &self.imitation;
            factor.solve_lower(&mut reach);
        }
        FlightInformation { columns, reach }
    }
}

/// What numbers of flights of each kind add together.
///
/// ```text
/// ΔG = X̃ᵀ(1 + HᵀH)⁻¹X̃,  X̃ = X − Z(1 + G_zz)⁻¹G_zk,  H = L⁻¹Zᵀ,  LLᵀ = 1 + G_zz           [diagnosis.45]
/// ```
///
/// X and Z are their whitened rows, G the Gram of the flights that were flown. It is what integrating the nuisance out of
/// all flights together gives, less what it gives of those flown, at the cost of the few new rows. `n` equal flights are
/// one with rows √n times as large. `None` where the numbers are not finite.
pub(crate) fn added(flights: &[(&FlightInformation, f64)]) -> Option<Mat<f64>> {
    let rows: usize = flights.iter().map(|(flight, _)| flight.columns.nrows()).sum();
    let (first, _) = flights.first()?;
    let mut columns = Mat::<f64>::zeros(rows, first.columns.ncols());
    let mut reach = Mat::<f64>::zeros(first.reach.nrows(), rows);
    let mut at = 0;
    for (flight, number) in flights {
        let root = number.sqrt();
        for row in 0..flight.columns.nrows() {
            for column in 0..columns.ncols() {
                columns[(at + row, column)] = root * flight.columns[(row, column)];
            }
            for nuisance in 0..reach.nrows() {
                reach[(nuisance, at + row)] = root * flight.reach[(nuisance, row)];
            }
        }
        at += flight.columns.nrows();
    }
    let mut covariance = Mat::<f64>::identity(rows, rows);
    faer::linalg::matmul::matmul(
        covariance.as_mut(),
        faer::Accum::Add,
        reach.transpose(),
        reach.as_ref(),
        1.0,
        Par::Seq,
    );
    Cholesky::new(&covariance)?.solve_lower(&mut columns);
    Some(columns.transpose() * &columns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::eliminate::integrate_out;

    /// Two effects and no nuisance. Flown: rows (1, 1), so that both look alike, d² = 1 − 1²/1 = 0. A flight with rows
    /// (2, 0) and (0, 1): with two of it G = [[1 + 2·4, 1], [1, 1 + 2·1]], d² = 9 − 1/3.
    #[test]
    fn two_effects_by_hand() {
        let gram = Mat::from_fn(2, 2, |_, _| 1.0);
        let known = Known::from_gram(&gram, &[0, 1], 2..2).unwrap();
        let flight = known.flight(&Mat::from_fn(2, 2, |i, j| [[2.0, 0.0], [0.0, 1.0]][i][j]));
        let then = &gram + added(&[(&flight, 2.0)]).unwrap();
        let (square, slope) = crate::advice::distances::squared(&then, 0, 1, 1.0);
        assert!((square - (9.0 - 1.0 / 3.0)).abs() < 1e-14, "{square}");
        assert!((slope - 1.0 / 3.0).abs() < 1e-15);
    }

    /// One effect with a nuisance of unit prior that looks just like it. Flown: one row (1, 1), G = 1 − 1/(1 + 1) = 1/2. A
    /// flight with row (1, −1): all together G = 2 − 0²/(1 + 2) = 2, so it adds 3/2.
    #[test]
    fn nuisance_by_hand() {
        let gram = Mat::from_fn(2, 2, |_, _| 1.0);
        let known = Known::from_gram(&gram, &[0], 1..2).unwrap();
        let flight = known.flight(&Mat::from_fn(1, 2, |_, j| [1.0, -1.0][j]));
        assert!((added(&[(&flight, 1.0)]).unwrap()[(0, 0)] - 1.5).abs() < 1e-14);
    }

    /// Against the nuisance integrated out of all rows at once, [diagnosis.18]; and more flights never tell less.
    #[test]
    fn as_all_rows_at_once_and_never_less() {
        let value = |i: usize, j: usize, salt: f64| {
            (1.7 * i as f64 + 0.9 * (j * j) as f64 + salt).sin() * (1.0 + 0.3 * j as f64)
        };
        let flown = Mat::from_fn(40, 7, |i, j| value(i, j, 0.3));
        let a = Mat::from_fn(6, 7, |i, j| value(i, j, 5.1));
        let b = Mat::from_fn(9, 7, |i, j| value(i, j, 8.7));
        let gram = flown.transpose() * &flown;
        let (kept, out) = ([0, 1, 2], [3, 4, 5, 6]);
        let integrated =
            |gram: &Mat<f64>| integrate_out(gram, &kept, &out, &[1.0; 4]).unwrap().matrix;
        let known = Known::from_gram(&gram, &kept, 3..7).unwrap();
        let (fa, fb) = (known.flight(&a), known.flight(&b));
        let sum = &gram
            + faer::Scale(3.0) * (a.transpose() * &a)
            + faer::Scale(2.0) * (b.transpose() * &b);
        let expected = integrated(&sum);
        let now = integrated(&gram);
        let found = &now + added(&[(&fa, 3.0), (&fb, 2.0)]).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                assert!((found[(i, j)] - expected[(i, j)]).abs() < 1e-11);
            }
        }
        let mut before = now;
        for number in 1..6 {
            let then = integrated(&gram) + added(&[(&fa, f64::from(number))]).unwrap();
            for k in 0..3 {
                for l in (0..3).filter(|&l| l != k) {
                    let square = |g: &Mat<f64>| crate::advice::distances::squared(g, k, l, 1.0).0;
                    assert!(square(&then) >= square(&before) - 1e-12);
                }
            }
            before = then;
        }
    }
}
