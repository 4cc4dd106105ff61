//! Oracles: the levels that rows were made of, and the evidence that their variances maximise, by dense algebra.

use test_support::Random;
use units::PressureAltitude;

use super::*;

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
    let levels = levels_of_rows(&rows(share), None).unwrap().0;
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
}

/// ln evidence of all shares, dense: their covariance is the sum of those of lines, of bends, of what levels have of their own, and of
/// rows.
fn ln_evidence(rows: &[(GuidePlace, f64)], variances: &Variances) -> f64 {
    let ranges = levels_of_rows(rows, None).unwrap().0.ranges();
    let heights: Vec<f64> = rows.iter().map(|row| row.0.pressure_altitude.to_meters()).collect();
    let mut levels = heights.clone();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let (low, high) = (levels[0], levels[levels.len() - 1]);
    let scaled = |height: f64| 2.0 * (height - low) / (high - low) - 1.0;
    let covariance = DMatrix::from_fn(rows.len(), rows.len(), |a, b| {
        let terms = |row: usize| guide_terms(rows[row].0, ranges);
        let (at_a, at_b) = (scaled(heights[a]), scaled(heights[b]));
        let mut sum = if a == b { variances.within } else { 0.0 };
        for term in 0..3 {
            let mut plane = variances.line[term] * (1.0 + at_a * at_b);
            for three in levels.windows(3) {
                let [below, middle, above] = [three[0], three[1], three[2]].map(scaled);
                let (up_a, up_b) = ((at_a - middle).max(0.0), (at_b - middle).max(0.0));
                plane += variances.bend[term] * 0.5 * (above - below) * up_a * up_b;
            }
            if heights[a].to_bits() == heights[b].to_bits() {
                plane += variances.own[term];
            }
            sum += terms(a)[term] * terms(b)[term] * plane;
        }
        sum
    });
    let left = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.1));
    let factor = covariance.cholesky().unwrap();
    let ln_determinant: f64 = factor.l().diagonal().iter().map(|of| 2.0 * of.ln()).sum();
    -0.5 * (ln_determinant + left.dot(&factor.solve(&left)))
}

/// Each round makes the evidence larger, and after all of them it hardly grows along any variance.
#[test]
fn variances_are_those_of_the_largest_evidence() {
    let rows = rows(noisy);
    let groups = by_level(&rows, levels_of_rows(&rows, None).unwrap().0.ranges());
    let smooth = Smooth::new(&groups);
    let variances = smooth.likeliest(None, rows.len()).unwrap();
    let best = ln_evidence(&rows, &variances);
    let after = smooth.maximised(&variances, &smooth.weights(&variances).unwrap(), rows.len());
    assert!(ln_evidence(&rows, &after) >= best);
    for factor in [0.4, 2.5] {
        let other = Variances { within: factor * variances.within, ..variances };
        assert!(best > ln_evidence(&rows, &other) + 1.0, "{variances:?}");
        for term in 0..3 {
            let moved = |of: fn(&mut Variances) -> &mut Vector3<f64>| {
                let mut other = variances;
                of(&mut other)[term] *= factor;
                ln_evidence(&rows, &other)
            };
            for other in
                [moved(|of| &mut of.line), moved(|of| &mut of.bend), moved(|of| &mut of.own)]
            {
                // A variance that has nothing to tell of goes to 0 round by round.
                assert!(best > other - 0.1, "{best} {other} {term} {factor} {variances:?}");
            }
        }
    }
}

/// Oracle: the conditional mean of a Gaussian, dense.
#[test]
fn planes_are_what_rows_say_of_them() {
    let rows = rows(noisy);
    let groups = by_level(&rows, levels_of_rows(&rows, None).unwrap().0.ranges());
    let smooth = Smooth::new(&groups);
    let variances = smooth.likeliest(None, rows.len()).unwrap();
    let found = smooth.weights(&variances).unwrap().mean;
    let ranges = levels_of_rows(&rows, None).unwrap().0.ranges();
    let level_of = |row: usize| {
        let at_m = rows[row].0.pressure_altitude.to_meters();
        groups.iter().position(|of| (of.pressure_altitude_m - at_m).abs() < 1.0).unwrap()
    };
    let design = DMatrix::from_fn(rows.len(), 12, |row, weight| {
        let terms = guide_terms(rows[row].0, ranges);
        smooth.basis[(level_of(row), weight / 3)] * terms[weight % 3]
    });
    let prior =
        DMatrix::from_diagonal(&DVector::from_fn(12, |weight, _| smooth.prior(&variances, weight)));
    let noise = DMatrix::from_fn(rows.len(), rows.len(), |a, b| {
        let terms = |row: usize| Vector3::from(guide_terms(rows[row].0, ranges));
        let own = terms(a).component_mul(&terms(b)).dot(&variances.own);
        let of_level = if level_of(a) == level_of(b) { own } else { 0.0 };
        of_level + if a == b { variances.within } else { 0.0 }
    });
    let left = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.1));
    let covariance = &design * &prior * design.transpose() + noise;
    let expected = prior * design.transpose() * covariance.cholesky().unwrap().solve(&left);
    assert!((&found - &expected).amax() < 1e-9, "{found} {expected}");
}

#[test]
fn levels_that_differ_in_nothing_have_little_share() {
    let mut normal = Random::new(7, 0);
    let mut random = rows(|_, _, _| 0.0);
    for row in &mut random {
        row.1 = normal.normal(0.0, 0.003);
    }
    let rms = |values: &mut dyn Iterator<Item = f64>| values.map(|of| of * of).sum::<f64>().sqrt();
    let levels = levels_of_rows(&random, None).unwrap().0;
    let of_levels = rms(&mut random.iter().map(|(place, _)| levels.factor(*place) - 1.0));
    assert!(of_levels < 0.4 * rms(&mut random.iter().map(|(_, share)| *share)), "{levels:?}");
    for few in [&random[..7], &[]] {
        assert_eq!(levels_of_rows(few, None).map(|found| found.0), None);
    }
    // Rows of flights that change their level are no levels.
    for (at, row) in random.iter_mut().enumerate() {
        row.0.pressure_altitude = PressureAltitude::meters(6_000.0 + 90.0 * (at / 4) as f64);
    }
    let many = (0..5).flat_map(|of| {
        random.iter().map(move |row| {
            let by_m = 18.0 * f64::from(of);
            let at_m = row.0.pressure_altitude.to_meters() + by_m;
            (GuidePlace { pressure_altitude: PressureAltitude::meters(at_m), ..row.0 }, row.1)
        })
    });
    assert!(levels_of_rows(&many.collect::<Vec<_>>(), None).is_none());
}
