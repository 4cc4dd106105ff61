//! Outlier weights: Student weights of a flight and of its segments, fixed when the flight is learnt.
//!
//! A difficult file. The weights need a prediction with its variance, for every flight; a solve over the grid would
//! cost a thousand times the rest. A quadratic in lift coefficient and Mach number, learnt along with the grid's
//! information from the same weighted segments, is enough to distinguish 10 % from 1 %, and what a quadratic cannot
//! hold is added to its variance. It never affects the table.
//!
//! Of one flight, `y = φ·a + f + e`: a the six coefficients, f the flight's common error, e the segments' own. With
//! Student errors as scale mixtures, the expectation–maximization weights are (Lange, Little and Taylor 1989)
//!
//! ```text
//! w_i = (ν + 1)/(ν + E[e_i²]/d_i)      w_f = (ν + 1)/(ν + E[f²]/s²)
//! ```
//!
//! with expectations over a and f given the whole flight. By this, a correct first flight of a fleet that is 5 % off is
//! not an outlier: the level of a, 10 % wide, explains it, and f stays small.

use super::BayesSettings;
use super::settings::{PATCH_LIFT_COEFFICIENT, PATCH_MACH};

/// Coefficients of the quadratic.
pub(super) const TERMS: usize = 6;
/// Entries of their information's lower triangle.
pub(super) const TRIANGLE: usize = TERMS * (TERMS + 1) / 2;
/// The coefficients and the flight's common error.
const UNKNOWNS: usize = TERMS + 1;

/// Iterations end when no weight changes by more than this share of its value. Weights between 0.8 and 1.2 have
/// practically the same effect; what matters is 0.05 instead of 0.8.
const WEIGHT_TOLERANCE: f64 = 0.05;
/// Clean flights need 2 or 3.
const MAXIMUM_ITERATIONS: usize = 30;

/// The learnt part of the expected residual: information about the quadratic's coefficients, without prior.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ExpectedResidual {
    pub(super) matrix: [f64; TRIANGLE],
    pub(super) vector: [f64; TERMS],
}

/// Constants of the outlier weights, from the settings and the middle of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WeightSettings {
    middle: (f64, f64),
    /// Prior precisions of the coefficients.
    precisions: [f64; TERMS],
    /// Variance of what a quadratic cannot hold.
    remainder: f64,
    degrees_of_freedom: f64,
}

/// A segment whose outlier weight is sought.
#[derive(Clone, Copy, Debug)]
pub(super) struct SegmentResidual {
    pub(super) lift_coefficient: f64,
    pub(super) mach: f64,
    /// Observed relative excess of drag over the initial table.
    pub(super) residual: f64,
    /// Variance of the segment alone.
    pub(super) variance: f64,
}

/// Outlier weights of one flight.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FlightWeights {
    /// Of each segment; around 1 for an ordinary one, at most 1 + 1/ν.
    pub(super) weights: Vec<f64>,
    /// Of the flight's common error.
    pub(super) flight_weight: f64,
    /// For each segment: residual minus the prediction before this flight.
    pub(super) surprises: Vec<f64>,
}

impl WeightSettings {
    pub(super) fn new(settings: &BayesSettings, middle: (f64, f64)) -> Self {
        let values = settings.values();
        let (c, m) = (PATCH_LIFT_COEFFICIENT, PATCH_MACH);
        // Standard deviations of 1, u, v, u², u·v, v² with u, v in patches from the middle. The last three are half
        // the second derivatives; over half a patch they are what a quadratic would miss of a bend.
        let bend_c = values.bend_std_per_lift_coefficient_squared * c * c / 2.0;
        let bend_m = values.bend_std_per_mach_squared * m * m / 2.0;
        let standard_deviations = [
            values.correction_std,
            values.slope_std_per_lift_coefficient * c,
            values.slope_std_per_mach * m,
            bend_c,
            values.bend_std_per_lift_coefficient_mach * c * m,
            bend_m,
        ];
        Self {
            middle,
            precisions: standard_deviations.map(|std| 1.0 / (std * std)),
            remainder: (bend_c * bend_c + bend_m * bend_m) / 16.0,
            degrees_of_freedom: values.student_degrees_of_freedom,
        }
    }

    /// The quadratic's terms, and 1 for the flight's common error.
    fn terms(&self, segment: &SegmentResidual) -> [f64; UNKNOWNS] {
        let u = (segment.lift_coefficient - self.middle.0) / PATCH_LIFT_COEFFICIENT;
        let v = (segment.mach - self.middle.1) / PATCH_MACH;
        [1.0, u, v, u * u, u * v, v * v, 1.0]
    }

    /// (ν + 1)/(ν + square): square the expected squared error over its variance.
    fn weight(&self, square: f64) -> f64 {
        (self.degrees_of_freedom + 1.0) / (self.degrees_of_freedom + square)
    }
}

impl ExpectedResidual {
    pub(super) const fn new() -> Self {
        Self { matrix: [0.0; TRIANGLE], vector: [0.0; TERMS] }
    }

    /// Weights of a flight's segments against all flights before.
    ///
    /// # Source
    /// Book `[bayes.6]`, `[bayes.7]`.
    pub(super) fn weigh(
        &self,
        settings: &WeightSettings,
        residuals: &[SegmentResidual],
        flight_variance: f64,
    ) -> FlightWeights {
        let terms: Vec<[f64; UNKNOWNS]> =
            residuals.iter().map(|segment| settings.terms(segment)).collect();
        let flight_variance = flight_variance + settings.remainder;
        let mut before = System::new(self, settings);
        before.matrix[UNKNOWNS - 1][UNKNOWNS - 1] = 1.0 / flight_variance;

        let mut expected = before.clone();
        expected.factor();
        let known = expected.solve();
        let surprises = residuals
            .iter()
            .zip(&terms)
            .map(|(segment, row)| segment.residual - dot(row, &known))
            .collect();

        let mut weights = vec![1.0; residuals.len()];
        let mut flight_weight = 1.0;
        for _ in 0..MAXIMUM_ITERATIONS {
            let mut system = before.clone();
            system.matrix[UNKNOWNS - 1][UNKNOWNS - 1] = flight_weight / flight_variance;
            for ((segment, row), weight) in residuals.iter().zip(&terms).zip(&weights) {
                system.add(row, segment.residual, weight / segment.variance);
            }
            system.factor();
            let solution = system.solve();
            let mut change: f64 = 0.0;
            for ((segment, row), weight) in residuals.iter().zip(&terms).zip(&mut weights) {
                let error = segment.residual - dot(row, &solution);
                let square = (error * error + system.variance(row)) / segment.variance;
                let new = settings.weight(square);
                change = change.max((new - *weight).abs() / *weight);
                *weight = new;
            }
            let common = solution[UNKNOWNS - 1];
            let square = (common * common + system.variance_of_last()) / flight_variance;
            let new = settings.weight(square);
            change = change.max((new - flight_weight).abs() / flight_weight);
            flight_weight = new;
            if change <= WEIGHT_TOLERANCE {
                break;
            }
        }
        FlightWeights { weights, flight_weight, surprises }
    }

    /// Learns a flight with its weights, all times `share`.
    pub(super) fn learn(
        &mut self,
        settings: &WeightSettings,
        residuals: &[SegmentResidual],
        flight_weights: &FlightWeights,
        flight_variance: f64,
        share: f64,
    ) {
        let mut common = [0.0; TERMS];
        let (mut precision_sum, mut residual_sum) = (0.0, 0.0);
        for (segment, weight) in residuals.iter().zip(&flight_weights.weights) {
            let row = settings.terms(segment);
            let precision = weight / segment.variance;
            self.add(&row, share * precision, segment.residual);
            for (sum, term) in common.iter_mut().zip(&row) {
                *sum += precision * term;
            }
            precision_sum += precision;
            residual_sum += precision * segment.residual;
        }
        let variance = (flight_variance + settings.remainder) / flight_weights.flight_weight;
        let factor = share / (1.0 / variance + precision_sum);
        let mut entries = self.matrix.iter_mut();
        for (i, sum) in common.iter().enumerate() {
            for (other, entry) in common[..=i].iter().zip(entries.by_ref()) {
                *entry -= factor * sum * other;
            }
            self.vector[i] -= factor * sum * residual_sum;
        }
    }

    pub(super) fn scale(&mut self, factor: f64) {
        self.matrix.iter_mut().chain(&mut self.vector).for_each(|number| *number *= factor);
    }

    pub(super) fn merge(&mut self, other: &Self) {
        let theirs = other.matrix.iter().chain(&other.vector);
        self.matrix.iter_mut().chain(&mut self.vector).zip(theirs).for_each(|(a, b)| *a += b);
    }

    fn add(&mut self, row: &[f64; UNKNOWNS], precision: f64, residual: f64) {
        let mut entries = self.matrix.iter_mut();
        for i in 0..TERMS {
            for (other, entry) in row[..=i].iter().zip(entries.by_ref()) {
                *entry += precision * row[i] * other;
            }
            self.vector[i] += precision * row[i] * residual;
        }
    }
}

/// Normal equations of seven unknowns and, after [`factor`](Self::factor), their Cholesky factor. Lower triangle.
///
/// Normal equations on purpose: the prior keeps them well conditioned, and they only determine weights.
#[derive(Clone)]
struct System {
    matrix: [[f64; UNKNOWNS]; UNKNOWNS],
    vector: [f64; UNKNOWNS],
}

impl System {
    /// Prior and what was learnt before; no information about the flight's common error yet.
    fn new(expected: &ExpectedResidual, settings: &WeightSettings) -> Self {
        let mut system = Self { matrix: [[0.0; UNKNOWNS]; UNKNOWNS], vector: [0.0; UNKNOWNS] };
        let mut entries = expected.matrix.iter();
        for i in 0..TERMS {
            for (entry, &value) in system.matrix[i][..=i].iter_mut().zip(entries.by_ref()) {
                *entry = value;
            }
            system.matrix[i][i] += settings.precisions[i];
            system.vector[i] = expected.vector[i];
        }
        system
    }

    fn add(&mut self, row: &[f64; UNKNOWNS], residual: f64, precision: f64) {
        for i in 0..UNKNOWNS {
            let pull = precision * row[i];
            for (entry, term) in self.matrix[i].iter_mut().zip(&row[..=i]) {
                *entry += pull * term;
            }
            self.vector[i] += pull * residual;
        }
    }

    /// Cholesky in place; the diagonal keeps reciprocals.
    fn factor(&mut self) {
        for i in 0..UNKNOWNS {
            for j in 0..=i {
                let mut sum = self.matrix[i][j];
                for k in 0..j {
                    sum -= self.matrix[i][k] * self.matrix[j][k];
                }
                self.matrix[i][j] = if i == j { 1.0 / sum.sqrt() } else { sum * self.matrix[j][j] };
            }
        }
    }

    fn solve(&self) -> [f64; UNKNOWNS] {
        let mut solution = self.forward(&self.vector);
        for i in (0..UNKNOWNS).rev() {
            let mut sum = solution[i];
            for (row, value) in self.matrix.iter().zip(&solution).skip(i + 1) {
                sum -= row[i] * value;
            }
            solution[i] = sum * self.matrix[i][i];
        }
        solution
    }

    fn forward(&self, vector: &[f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
        let mut solution = *vector;
        for i in 0..UNKNOWNS {
            let mut sum = solution[i];
            for (entry, value) in self.matrix[i].iter().zip(&solution[..i]) {
                sum -= entry * value;
            }
            solution[i] = sum * self.matrix[i][i];
        }
        solution
    }

    /// Variance of a linear combination of the unknowns.
    fn variance(&self, row: &[f64; UNKNOWNS]) -> f64 {
        let half = self.forward(row);
        dot(&half, &half)
    }

    fn variance_of_last(&self) -> f64 {
        let reciprocal = self.matrix[UNKNOWNS - 1][UNKNOWNS - 1];
        reciprocal * reciprocal
    }
}

fn dot(a: &[f64; UNKNOWNS], b: &[f64; UNKNOWNS]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
