use core::f64::consts::FRAC_2_PI;

use super::*;
use crate::math::cholesky::Cholesky;

/// Oracle: faer's factor.
#[test]
fn the_factor_is_that_of_dense_algebra() {
    let gram = Mat::from_fn(5, 5, |i, j| {
        let near = ((i + 2 * j) % 5 + (j + 2 * i) % 5) as f64;
        if i == j { 40.0 } else { near }
    });
    let product: Vec<f64> = (0..5).map(|i| f64::from(i) - 1.5).collect();
    let precisions = [0.5, 1.0, 2.0, 0.0, 3.0];
    let mut whole = gram.clone();
    (0..5).for_each(|k| whole[(k, k)] += precisions[k]);
    let expected = Cholesky::new(&whole).unwrap();
    let mut solved = Mat::from_fn(5, 1, |i, _| product[i]);
    let right = solved.clone();
    expected.solve(&mut solved);
    let candidate = Candidate { gram: Lower::of(&gram), product, ln_weight: 0.0 };
    let factor = Factor::new(&candidate, &precisions).unwrap();
    let explained: f64 = (0..5).map(|k| right[(k, 0)] * solved[(k, 0)]).sum();
    let ln_evidence = 0.5 * (explained - expected.ln_determinant());
    assert!((factor.ln_evidence() - ln_evidence).abs() < 1e-12);
    let mut found = factor.half.clone();
    factor.lower.solve_upper(&mut found);
    for (found, expected) in found.iter().zip(solved.col_as_slice(0)) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
}

/// Oracle: both factors. Precisions as far apart as they can be, and nearly alike; columns that are all but the same.
#[test]
fn the_gain_of_an_exchange_is_that_of_two_factors() {
    let gram = Mat::from_fn(20, 20, |i, j| match (i, j) {
        (i, j) if i == j => 400.0 + i as f64,
        (0, 1) | (1, 0) => 399.5,
        _ => ((i * j) % 7) as f64,
    });
    let product = (0..20).map(|i| 30.0 * f64::from(i) - 200.0).collect();
    let candidate = Candidate { gram: Lower::of(&gram), product, ln_weight: 0.0 };
    let mut precisions: Vec<f64> = (0..20).map(|k| 0.5 + 3.0 * f64::from(k)).collect();
    (precisions[3], precisions[7], precisions[8]) = (1e12, 1e4, 0.5001);
    for (more, less) in [(0, 1), (1, 0), (0, 3), (5, 7), (0, 8), (12, 19)] {
        let mut after = precisions.clone();
        after.swap(more, less);
        let change = precisions[less] - precisions[more];
        let before = Factor::new(&candidate, &precisions).unwrap();
        let expected = Factor::new(&candidate, &after).unwrap().ln_evidence();
        let expected = expected - before.ln_evidence();
        let found = before.gain_of_exchange(more, less, change);
        let tolerance = 1e-9 + 1e-15 * change.abs();
        assert!((found - expected).abs() < tolerance, "{more} {less}: {found} {expected}");
    }
}

fn candidate(gram: f64, product: f64, ln_weight: f64) -> Candidate {
    let gram = Lower::of(&Mat::from_fn(1, 1, |_, _| gram));
    Candidate { gram, product: vec![product], ln_weight }
}

fn prior(kept: usize) -> Horseshoe {
    Horseshoe { common_scale: 0.5, slab: 4.0, sweeps: (500, kept), seed: 20 }
}

/// Evidence, mean and mean square of one coefficient by the trapezium rule over ln λ and ln τ; given both, all is normal.
fn integrated(gram: f64, product: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for i in -300..=300 {
        for j in -300..=300 {
            let (own, common) = ((0.05 * f64::from(i)).exp(), (0.05 * f64::from(j)).exp());
            // Densities of half-Cauchy numbers, in their logarithms.
            let density = FRAC_2_PI * own / (1.0 + own * own) * FRAC_2_PI * common
                / 0.5
                / (1.0 + (common / 0.5).powi(2));
            let spread = (own * common).powi(-2);
            let precision = gram + spread + 1.0 / 16.0;
            let mean = product / precision;
            // ∫ N(β; 0, 1/spread)·N(β; 0, 16)·exp(product·β − ½ gram·β²) dβ but for constants.
            let weight = density * (spread / precision).sqrt() * (0.5 * product * mean).exp();
            sums[0] += weight;
            sums[1] += weight * mean;
            sums[2] += weight * (mean * mean + 1.0 / precision);
        }
    }
    [sums[0], sums[1] / sums[0], sums[2] / sums[0]]
}

/// One coefficient, of about one and of about four standard deviations. Oracle: numerical integration.
#[test]
fn one_coefficient_by_integration() {
    for (gram, product) in [(4.0, 2.0), (4.0, 9.0)] {
        let draws = draw(&[candidate(gram, product, 0.0)], prior(60_000)).unwrap();
        let values: Vec<f64> = (0..draws.ncols()).map(|k| draws[(0, k)]).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
        let [_, expected, expected_square] = integrated(gram, product);
        // Four standard errors of some 6 000 independent draws.
        let tolerance = 4.0 * (expected_square - expected * expected).sqrt() / 6_000_f64.sqrt();
        assert!((mean - expected).abs() < tolerance, "{mean} {expected} {tolerance}");
        assert!((square - expected_square).abs() < 4.0 * tolerance, "{square} {expected_square}");
        // A shrunk mean: neither nothing nor least squares.
        assert!(expected > 0.05 && expected < product / gram, "{expected}");
    }
}

/// Two backgrounds, one of which explains what the coefficient would: the share of draws in each is that of its evidence.
#[test]
fn backgrounds_are_chosen_by_evidence() {
    let (gram, products) = (4.0, [6.0, 1.0]);
    let [first, second] = products.map(|product| integrated(gram, product)[0]);
    // Weights that make the two about as probable.
    let lns = [0.0, (first / second).ln() - 0.4];
    let candidates = [candidate(gram, 6.0, lns[0]), candidate(gram, 1.0, lns[1])];
    let mut chain = Chain::new(1, prior(0));
    let mut chosen = 0_u32;
    for sweep in 0..120_000 {
        if sweep % SWEEPS_TO_A_BACKGROUND == 0 {
            chain.choose(&candidates).unwrap();
            chosen += u32::try_from(chain.candidate).unwrap();
        }
        let factor = chain.exchange(&candidates[chain.candidate]).unwrap();
        chain.draw_coefficients(&factor);
        chain.draw_scales();
    }
    let share = f64::from(chosen) / 12_000.0;
    let expected = 1.0 / (1.0 + 0.4_f64.exp());
    assert!((share - expected).abs() < 0.03, "{share} {expected}");
}

/// Two columns that are all but one and the same: each is the larger one in half of the draws. Oracle: symmetry. One chain
/// that moved one column at a time would stay with the first that it met.
#[test]
fn of_two_like_columns_each_leads_half_of_the_time() {
    let gram = Mat::from_fn(6, 6, |i, j| match (i, j) {
        (i, j) if i == j => 400.0,
        (0, 1) | (1, 0) => 399.9,
        _ => 0.0,
    });
    let product = (0..6).map(|i| if i < 2 { 400.0 } else { 0.0 }).collect();
    let draws = draw(
        &[Candidate { gram: Lower::of(&gram), product, ln_weight: 0.0 }],
        Horseshoe { common_scale: 0.05, ..prior(4_000) },
    );
    let draws = draws.unwrap();
    let first = (0..4_000).filter(|k| draws[(0, *k)].abs() > draws[(1, *k)].abs()).count();
    assert!((1_400..2_600).contains(&first), "{first}");
    // Mostly one of them makes all of it, and seldom both a half.
    let one = (0..4_000).filter(|k| {
        let share = draws[(0, *k)] / (draws[(0, *k)] + draws[(1, *k)]);
        !(0.2..0.8).contains(&share)
    });
    assert!(one.count() > 2_000);
}

/// Shapes of whole and of half numbers: mean and variance are the shape.
#[test]
fn gamma_numbers_have_their_moments() {
    let mut random = RandomStream::new(3, 0);
    for halves in [3, 8] {
        let numbers: Vec<f64> = (0..40_000).map(|_| half_gamma(&mut random, halves)).collect();
        let shape = halves as f64 / 2.0;
        let mean = numbers.iter().sum::<f64>() / 40_000.0;
        let variance = numbers.iter().map(|n| (n - mean).powi(2)).sum::<f64>() / 40_000.0;
        assert!((mean - shape).abs() < 5.0 * (shape / 40_000.0).sqrt(), "{mean} {shape}");
        assert!((variance / shape - 1.0).abs() < 0.1, "{variance} {shape}");
    }
}
