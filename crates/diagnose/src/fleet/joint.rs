//! The joint normal distribution of what a type shares and what its tails have of their own, by Schur complements.
//!
//! ```text
//! y_t = C_t u + X_t η_t + e_t,   u ~ N(0, U),   η_t ~ N(0, Ω_t),   e_t ~ N(0, 1)                         [fleet.1]
//! H_t = [C y]ᵀ (1 + X Ω Xᵀ)⁻¹ [C y] of tail t,   u | all: precision U⁻¹ + Σ_t H_t,cc, right-hand side Σ_t H_t,cy
//! ```
//!
//! `C_t` has the columns of the effects (their sizes in the type, μ) and of everything else that tails share; `X_t` are those of
//! the effects again. A tail is its Gram over effects, shared columns and the residual.

use faer::Mat;

use crate::math::cholesky::Cholesky;
use crate::math::eliminate::integrate_out;
use crate::math::linear::gather;

/// A tail as the fleet keeps it: Gram over effects, shared columns, residual last.
#[derive(Clone, Debug)]
pub(crate) struct TailGram {
    pub(crate) matrix: Mat<f64>,
    /// Recorded values behind it.
    pub(crate) rows: f64,
}

/// What the sum of tails says of what is shared: over effects and shared columns, residual last.
#[derive(Clone, Debug)]
pub(crate) struct TypeGram {
    pub(crate) matrix: Mat<f64>,
    pub(crate) rows: f64,
}

/// A normal distribution of what is shared, over the columns that may differ from zero.
#[derive(Debug)]
pub(crate) struct Shared {
    /// Columns that may differ from zero.
    pub(crate) columns: Vec<usize>,
    mean: Mat<f64>,
    precision: Mat<f64>,
}

impl TypeGram {
    pub(crate) fn zero(columns: usize) -> Self {
        Self { matrix: Mat::zeros(columns, columns), rows: 0.0 }
    }

    /// Adds what a tail says of what is shared ([`TailGram::of_shared`]).
    pub(crate) fn add(&mut self, own: &Mat<f64>, rows: f64) {
        self.matrix += own;
        self.rows += rows;
    }

    /// The distribution of what is shared without one tail: `own` is what that tail added. `deviations` are the prior ones of
    /// every shared column, 0 for what is zero.
    pub(crate) fn without(&self, own: &Mat<f64>, deviations: &[f64]) -> Option<Shared> {
        Shared::new(&(&self.matrix - own), deviations)
    }
}

impl TailGram {
    /// What the tail says of what is shared where its own effects have these standard deviations: `H_t` of `[fleet.1]`.
    pub(crate) fn of_shared(&self, own_deviations: &[f64]) -> Option<Mat<f64>> {
        let out: Vec<usize> =
            (0..own_deviations.len()).filter(|&k| own_deviations[k] > 0.0).collect();
        let deviations: Vec<f64> = out.iter().map(|&k| own_deviations[k]).collect();
        let kept: Vec<usize> = (0..self.matrix.ncols()).collect();
        Some(integrate_out(&self.matrix, &kept, &out, &deviations)?.matrix)
    }

    /// Divides the tail's noise out once more: `square` is how much larger its square is than what was divided by so far.
    pub(crate) fn rescale(&mut self, square: f64) {
        for column in 0..self.matrix.ncols() {
            for value in self.matrix.col_as_slice_mut(column) {
                *value /= square;
            }
        }
    }

    /// The tail's Gram over its own effects and the residual, what is shared integrated out as the other tails know it.
    ///
    /// ```text
    /// B = A'_kk − A'_kc (P + A_cc)⁻¹ A'_ck,   y' = y − C m        [fleet.2]
    /// ```
    pub(crate) fn of_own(&self, effects: usize, others: &Shared) -> Option<Mat<f64>> {
        let last = self.matrix.ncols() - 1;
        let columns = &others.columns;
        let kept: Vec<usize> = (0..effects).chain([last]).collect();
        let mut own = gather(&self.matrix, &kept, &kept);
        if columns.is_empty() {
            return Some(own);
        }
        let inner = gather(&self.matrix, columns, columns);
        let mut cross = gather(&self.matrix, columns, &kept);
        // The residual beside the mean of what is shared.
        let moved = &inner * &others.mean;
        let by_mean = cross.transpose() * &others.mean;
        let square: f64 =
            (0..columns.len()).map(|c| others.mean[(c, 0)] * moved[(c, 0)]).sum::<f64>();
        own[(effects, effects)] += square - 2.0 * by_mean[(effects, 0)];
        for k in 0..effects {
            own[(k, effects)] -= by_mean[(k, 0)];
            own[(effects, k)] -= by_mean[(k, 0)];
        }
        for c in 0..columns.len() {
            cross[(c, effects)] -= moved[(c, 0)];
        }
        let factor = Cholesky::new(&(inner + &others.precision))?;
        factor.solve_lower(&mut cross);
        own -= cross.transpose() * &cross;
        Some(own)
    }

    /// Mean and covariance of what is shared and what the tail has of its own together, in the order of `others.columns`, then
    /// of the effects whose own deviation is not zero.
    pub(crate) fn together(
        &self,
        others: &Shared,
        own_deviations: &[f64],
    ) -> Option<(Vec<f64>, Mat<f64>)> {
        let last = self.matrix.ncols() - 1;
        let own: Vec<usize> =
            (0..own_deviations.len()).filter(|&k| own_deviations[k] > 0.0).collect();
        let shared = others.columns.len();
        let places: Vec<usize> = others.columns.iter().chain(&own).copied().collect();
        let mut precision = gather(&self.matrix, &places, &places);
        let mut right = gather(&self.matrix, &places, &[last]);
        let known = &others.precision * &others.mean;
        for a in 0..shared {
            right[(a, 0)] += known[(a, 0)];
            for b in 0..shared {
                precision[(a, b)] += others.precision[(a, b)];
            }
        }
        for (k, &effect) in own.iter().enumerate() {
            precision[(shared + k, shared + k)] += own_deviations[effect].powi(-2);
        }
        let factor = Cholesky::new(&precision)?;
        factor.solve(&mut right);
        let mut covariance = Mat::identity(places.len(), places.len());
        factor.solve(&mut covariance);
        Some((right.col_as_slice(0).to_vec(), covariance))
    }
}

impl Shared {
    /// From Gram and product with the residual (last), and prior standard deviations about zero.
    pub(crate) fn new(gram: &Mat<f64>, deviations: &[f64]) -> Option<Self> {
        let last = gram.ncols() - 1;
        let columns: Vec<usize> = (0..deviations.len()).filter(|&c| deviations[c] > 0.0).collect();
        let mut precision = gather(gram, &columns, &columns);
        for (place, &column) in columns.iter().enumerate() {
            precision[(place, place)] += deviations[column].powi(-2);
        }
        let mut mean = gather(gram, &columns, &[last]);
        if !columns.is_empty() {
            Cholesky::new(&precision)?.solve(&mut mean);
        }
        Some(Self { columns, mean, precision })
    }

    /// Mean and standard deviation of the first columns, 0 for what is zero.
    pub(crate) fn moments(&self, columns: usize) -> Option<Vec<(f64, f64)>> {
        let mut moments = vec![(0.0, 0.0); columns];
        if self.columns.is_empty() {
            return Some(moments);
        }
        let mut covariance = Mat::identity(self.columns.len(), self.columns.len());
        Cholesky::new(&self.precision)?.solve(&mut covariance);
        for (place, &column) in self.columns.iter().enumerate() {
            if let Some(moments) = moments.get_mut(column) {
                *moments = (self.mean[(place, 0)], covariance[(place, place)].sqrt());
            }
        }
        Some(moments)
    }
}

#[cfg(test)]
mod tests;
