//! Oracles: the levels that rows were made of, and the evidence that their variances maximise, by dense algebra.

use super::*;
use nalgebra::DMatrix;
use test_support::Random;

fn place(lift_coefficient: f64, mach: f64, at_m: f64) -> GuidePlace {
    GuidePlace { lift_coefficient, mach, pressure_altitude: PressureAltitude::meters(at_m) }
}

/// Rows at four levels, five lift coefficients and four Mach numbers.
fn rows(share: impl Fn(f64, f64, f64) -> f64) -> Vec<(GuidePlace, f64)> {
    let mut rows = Vec::new();
    for at_m in [9_000.0, 10_000.0, 11_000.0, 13_000.0] {
        for lift in [0.3, 0.4, 0.5, 0.6, 0.7] {
            for mach in [0.70, 0.75, 0.80, 0.85] {
                rows.push((place(lift, mach, at_m), share(lift, mach, at_m)));
            }
        }
    }
    rows
}

/// By lift coefficient and Mach number another plane at each level, and what no plane holds.
fn noisy(lift: f64, mach: f64, at_m: f64) -> f64 {
    let level = (at_m - 10_500.0) / 1_000.0;
    let phase = 37.0 * lift + 111.0 * mach + 0.013 * at_m;
    0.008 * level + 0.02 * level.sin() * (lift - 0.5) + 0.003 * phase.sin()
}

#[test]
fn planes_come_back_and_are_held_beyond_the_rows() {
    let share = |lift: f64, mach: f64, at_m: f64| {
        let level = (at_m - 11_000.0) / 2_000.0;
        level * (0.02 + 0.05 * (lift - 0.5) - 0.1 * (mach - 0.775)) + 1e-9 * (1e4 * lift).sin()
    };
    let levels = GuideLevels::of_rows(&rows(share));
    for (lift, mach, at_m) in [(0.37, 0.81, 9_000.0), (0.66, 0.72, 13_000.0), (0.5, 0.8, 9_500.0)] {
        let expected = 1.0 + share(lift, mach, at_m);
        let found = levels.factor(place(lift, mach, at_m));
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
    for (beyond, held) in [
        (place(0.9, 0.8, 9_000.0), place(0.7, 0.8, 9_000.0)),
        (place(0.5, 0.5, 10_500.0), place(0.5, 0.7, 10_500.0)),
        (place(0.5, 0.8, 20_000.0), place(0.5, 0.8, 13_000.0)),
        (place(0.5, 0.8, 0.0), place(0.5, 0.8, 9_000.0)),
    ] {
        assert!((levels.factor(beyond) - levels.factor(held)).abs() < 1e-15);
    }
    assert_eq!(GuideLevels::new(levels.ranges(), levels.levels().to_vec()).as_ref(), Ok(&levels));
}

/// ln evidence of all shares, dense: N(0, s² + X diag(τ²) Xᵀ) at each level.
fn ln_evidence(rows: &[(GuidePlace, f64)], within: f64, between: [f64; 3]) -> f64 {
    let ranges = GuideLevels::of_rows(rows).ranges();
    rows.chunk_by(|a, b| a.0.pressure_altitude == b.0.pressure_altitude)
        .map(|level| {
            let x = DMatrix::from_fn(level.len(), 3, |row, term| terms(level[row].0, ranges)[term]);
            let prior = DMatrix::from_diagonal(&nalgebra::DVector::from_row_slice(&between));
            let unit = DMatrix::<f64>::identity(level.len(), level.len());
            let covariance = &x * prior * x.transpose() + unit * within;
            let left = nalgebra::DVector::from_iterator(level.len(), level.iter().map(|row| row.1));
            let factor = covariance.cholesky().unwrap();
            let ln_determinant: f64 = factor.l().diagonal().iter().map(|of| 2.0 * of.ln()).sum();
            -0.5 * (ln_determinant + left.dot(&factor.solve(&left)))
        })
        .sum()
}

#[test]
fn variances_are_those_of_the_largest_evidence() {
    let rows = rows(noisy);
    let levels = GuideLevels::of_rows(&rows);
    // The variances that the planes were found with, from the planes and one more round.
    let groups = by_level(&rows, levels.ranges());
    let square = |term: usize| {
        levels.levels().iter().map(|level| level.shares[term].powi(2)).sum::<f64>() / 4.0
    };
    let left: f64 = groups
        .iter()
        .zip(levels.levels())
        .map(|(of, level)| of.left(&(Vector3::from(level.shares), Matrix3::zeros())))
        .sum();
    let within = left / (rows.len() as f64 - 8.0);
    let best = ln_evidence(&rows, within, [square(0), square(1), square(2).max(1e-12)]);
    for factor in [0.5, 2.0] {
        assert!(best > ln_evidence(&rows, factor * within, [square(0), square(1), square(2)]));
        for term in 0..2 {
            let mut other = [square(0), square(1), square(2)];
            other[term] *= factor * factor;
            assert!(best > ln_evidence(&rows, within, other), "{term} times {factor}");
        }
    }
}

#[test]
fn levels_that_differ_in_nothing_have_little_share() {
    let mut normal = Random::new(7, 0);
    let mut random = rows(|_, _, _| 0.0);
    for row in &mut random {
        row.1 = normal.normal(0.0, 0.003);
    }
    let rms = |values: &mut dyn Iterator<Item = f64>| values.map(|of| of * of).sum::<f64>().sqrt();
    let levels = GuideLevels::of_rows(&random);
    let of_levels = rms(&mut random.iter().map(|(place, _)| levels.factor(*place) - 1.0));
    assert!(of_levels < 0.4 * rms(&mut random.iter().map(|(_, share)| *share)), "{levels:?}");
    for few in [&random[..7], &[]] {
        assert_eq!(GuideLevels::of_rows(few), GuideLevels::default());
    }
}

#[test]
fn what_is_no_level_is_refused() {
    let level = |pressure_altitude_m, share| GuideLevel { pressure_altitude_m, shares: [share; 3] };
    let ranges = [(0.2, 0.6), (0.7, 0.9)];
    assert!(GuideLevels::new(ranges, vec![level(1.0, 0.1)]).is_ok());
    assert!(GuideLevels::new([(0.2, 0.2), (0.7, 0.9)], vec![level(1.0, 0.1)]).is_err());
    for wrong in [
        vec![level(1.0, 0.0), level(1.0, 0.0)],
        vec![level(f64::NAN, 0.0)],
        vec![level(1.0, f64::NAN)],
        vec![level(1.0, -0.5)],
    ] {
        assert!(GuideLevels::new(ranges, wrong).is_err());
    }
}
