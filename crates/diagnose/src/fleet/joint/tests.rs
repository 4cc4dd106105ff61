//! Oracle: the full joint normal distribution of all tails, as dense matrices of nalgebra, conditioned on all rows at once.

use nalgebra::{DMatrix, DVector};

use super::*;
use crate::math::random::RandomStream;

const EFFECTS: usize = 3;
const SHARED: usize = 2;
const COLUMNS: usize = EFFECTS + SHARED;
const ROWS: usize = 9;
const TAILS: usize = 4;

struct Dense {
    /// Rows of each tail: effects, shared columns, residual.
    rows: Vec<DMatrix<f64>>,
    own: Vec<[f64; EFFECTS]>,
    shared: [f64; COLUMNS],
}

fn made_up() -> Dense {
    let mut random = RandomStream::new(16, 3);
    let rows = (0..TAILS)
        .map(|_| {
            let mut values = vec![0.0; ROWS * (COLUMNS + 1)];
            random.fill(&mut values);
            DMatrix::from_vec(ROWS, COLUMNS + 1, values)
        })
        .collect();
    // A tail without deviations, one with a single one, and an effect that the type has not.
    let own = vec![[0.3, 0.0, 2.0], [0.0; EFFECTS], [0.0, 1.5, 0.0], [0.7, 0.4, 0.2]];
    Dense { rows, own, shared: [1.2, 0.0, 0.5, 1.0, 2.5] }
}

fn gram(rows: &DMatrix<f64>) -> TailGram {
    let gram = rows.transpose() * rows;
    let matrix = Mat::from_fn(COLUMNS + 1, COLUMNS + 1, |i, j| gram[(i, j)]);
    TailGram { matrix, rows: ROWS as f64 }
}

/// Mean and covariance of `(u, η_1, …, η_T)` given every row of these tails, and ln of the density of those rows.
fn dense(of: &Dense, tails: &[usize]) -> (DVector<f64>, DMatrix<f64>, f64) {
    let unknowns = COLUMNS + EFFECTS * TAILS;
    let mut prior = DMatrix::zeros(unknowns, unknowns);
    for (k, deviation) in of.shared.iter().enumerate() {
        prior[(k, k)] = deviation * deviation;
    }
    for (tail, own) in of.own.iter().enumerate() {
        for (k, deviation) in own.iter().enumerate() {
            let at = COLUMNS + EFFECTS * tail + k;
            prior[(at, at)] = deviation * deviation;
        }
    }
    let mut columns = DMatrix::zeros(ROWS * tails.len(), unknowns);
    let mut y = DVector::zeros(ROWS * tails.len());
    for (place, &tail) in tails.iter().enumerate() {
        for row in 0..ROWS {
            for k in 0..COLUMNS {
                columns[(ROWS * place + row, k)] = of.rows[tail][(row, k)];
            }
            for k in 0..EFFECTS {
                columns[(ROWS * place + row, COLUMNS + EFFECTS * tail + k)] =
                    of.rows[tail][(row, k)];
            }
            y[ROWS * place + row] = of.rows[tail][(row, COLUMNS)];
        }
    }
    let noise = DMatrix::identity(y.len(), y.len());
    let covariance = &columns * &prior * columns.transpose() + noise;
    let inverse = covariance.clone().try_inverse().unwrap();
    let gain = &prior * columns.transpose() * &inverse;
    let ln_determinant = 2.0
        * covariance.cholesky().unwrap().l().diagonal().iter().map(|value| value.ln()).sum::<f64>();
    let ln = -0.5 * (ln_determinant + (y.transpose() * &inverse * &y)[(0, 0)]);
    (&gain * &y, &prior - &gain * &columns * &prior, ln)
}

/// What the Schur complements make of all tails: their sum, and what each added.
fn summed(of: &Dense) -> (TypeGram, Vec<Mat<f64>>) {
    let mut total = TypeGram::zero(COLUMNS + 1);
    let added: Vec<Mat<f64>> =
        of.rows.iter().zip(&of.own).map(|(rows, own)| gram(rows).of_shared(own).unwrap()).collect();
    for own in &added {
        total.add(own, ROWS as f64);
    }
    (total, added)
}

#[test]
fn the_type_is_that_of_the_joint_distribution() {
    let made_up = made_up();
    let (total, _) = summed(&made_up);
    let (mean, covariance, _) = dense(&made_up, &[0, 1, 2, 3]);
    let moments = Shared::new(&total.matrix, &made_up.shared).unwrap().moments(COLUMNS).unwrap();
    for (k, (value, deviation)) in moments.into_iter().enumerate() {
        assert!((value - mean[k]).abs() < 1e-10, "{k}: {value} {}", mean[k]);
        assert!((deviation - covariance[(k, k)].max(0.0).sqrt()).abs() < 1e-10, "{k}");
    }
}

#[test]
fn a_tail_together_with_its_type_is_that_of_the_joint_distribution() {
    let made_up = made_up();
    let (total, added) = summed(&made_up);
    let (mean, covariance, _) = dense(&made_up, &[0, 1, 2, 3]);
    for (tail, of_tail) in added.iter().enumerate() {
        let others = total.without(of_tail, &made_up.shared).unwrap();
        let own = &made_up.own[tail];
        let (found, spread) = gram(&made_up.rows[tail]).together(&others, own).unwrap();
        let of_own = (0..EFFECTS).filter(|&k| own[k] > 0.0);
        let places: Vec<usize> = others
            .columns
            .iter()
            .copied()
            .chain(of_own.map(|k| COLUMNS + EFFECTS * tail + k))
            .collect();
        assert_eq!(places.len(), found.len());
        for (a, &at) in places.iter().enumerate() {
            assert!((found[a] - mean[at]).abs() < 1e-9, "{tail} {at}: {} {}", found[a], mean[at]);
            for (b, &other) in places.iter().enumerate() {
                assert!(
                    (spread[(a, b)] - covariance[(at, other)]).abs() < 1e-9,
                    "{tail} {at} {other}"
                );
            }
        }
    }
}

/// The evidence of a tail's own effects, given the other tails, is the ratio of joint densities.
#[test]
fn evidence_of_own_effects_is_that_of_the_joint_distribution() {
    let mut made_up = made_up();
    let tail = 0;
    let ln_given_others = |of: &Dense| dense(of, &[0, 1, 2, 3]).2 - dense(of, &[1, 2, 3]).2;
    let (total, added) = summed(&made_up);
    let others = total.without(&added[tail], &made_up.shared).unwrap();
    let own_gram = gram(&made_up.rows[tail]).of_own(EFFECTS, &others).unwrap();
    let mut found = Vec::new();
    let mut expected = Vec::new();
    for own in [[0.0; EFFECTS], [0.8, 0.0, 0.0], [0.3, 0.0, 2.0]] {
        made_up.own[tail] = own;
        expected.push(ln_given_others(&made_up));
        let out: Vec<usize> = (0..EFFECTS).filter(|&k| own[k] > 0.0).collect();
        let deviations: Vec<f64> = out.iter().map(|&k| own[k]).collect();
        let left = integrate_out(&own_gram, &[EFFECTS], &out, &deviations).unwrap();
        found.push(-0.5 * (left.ln_determinant + left.matrix[(0, 0)]));
    }
    for k in 1..found.len() {
        let (found, expected) = (found[k] - found[0], expected[k] - expected[0]);
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}

/// A tail whose noise is twice the stated one counts a quarter.
#[test]
fn a_noisier_tail_counts_less() {
    let made_up = made_up();
    let mut tail = gram(&made_up.rows[0]);
    let before = tail.matrix[(1, 2)];
    tail.rescale(4.0);
    assert!((4.0 * tail.matrix[(1, 2)] - before).abs() < 1e-12);
}
