//! Evidence against numerical integration.

use super::*;

/// Every hypothesis: none, one of three effects (one of them with two columns, one of them scatter), every pair.
#[test]
fn prior_masses_sum_to_one() {
    let prior = Prior { mean: 0.0, scales: [(1.0, 0.0); 3], count: 1, sign: EffectSign::Either };
    let scorer = Scorer {
        priors: vec![prior; 3],
        effect_of: vec![0, 1, 1],
        ln_choices: vec![0.0, 2.0_f64.ln(), 2.0_f64.ln()],
        effects: 3,
        age_of: vec![None; 2],
        held: vec![false; 2],
        rows: 10.0,
    };
    let mass = |columns: &[usize], flight_scatter_percent: Option<f64>| {
        scorer.ln_prior(&Hypothesis { columns: columns.to_vec(), flight_scatter_percent }).exp()
    };
    let mut total: f64 = [&[][..], &[0], &[1], &[2], &[0, 1], &[0, 2]]
        .into_iter()
        .map(|columns| mass(columns, None))
        .sum();
    for percent in FLIGHT_SCATTER_SIZES_PERCENT {
        for columns in [&[][..], &[0], &[1], &[2]] {
            total += mass(columns, Some(percent));
        }
    }
    assert!((total - 1.0).abs() < 1e-12, "{total}");
}

#[test]
fn signs_by_the_normal_table() {
    // Φ(1.96) = 0.975 002: 2·(0.95·0.975002 + 0.05·0.024998) = 1.855 004.
    assert!((ln_sign(EffectSign::Positive, 1.96).exp() - 1.855_004).abs() < 1e-5);
    assert!(ln_sign(EffectSign::Either, -5.0).abs() < 1e-300);
}

/// The density of what is left times the prior of the noise's variance, integrated on a grid of ln of the variance.
#[test]
fn evidence_of_what_is_left_is_the_integral_over_the_noise() {
    let rows = 30.0;
    let integral = |square: f64, ln_determinant: f64| {
        let of_ln_variance = |k: i32| {
            let v = (f64::from(k) * 0.01).exp();
            let density = -0.5 * (ln_determinant + rows * v.ln() + square / v);
            let prior = -0.5 * NOISE_FREEDOM * (v.ln() + 1.0 / v);
            (density + prior).exp() * 0.01
        };
        (-300..=300).map(of_ln_variance).sum::<f64>().ln()
    };
    let (known, closed) = (integral(30.0, 0.0), ln_evidence_of_left(rows, 30.0, 0.0));
    for (square, ln_determinant) in [(30.0, 3.0), (5.0, 0.0), (90.0, -2.0), (300.0, 7.0)] {
        let expected = integral(square, ln_determinant) - known;
        let found = ln_evidence_of_left(rows, square, ln_determinant) - closed;
        assert!((found - expected).abs() < 1e-8, "{square}: {found} {expected}");
    }
}

/// The closed form against the marginal likelihood integrated on a grid of θ and of ln of the noise scale.
#[test]
fn evidence_against_numerical_integration() {
    let (gram, product, square, rows) = (7.0, 5.0, 12.0, 9.0);
    let matrix = faer::Mat::from_fn(2, 2, |i, j| [[gram, product], [product, square]][i][j]);
    let at = Background::small(&matrix, &[0], 1, 0.0);
    let prior = Prior { mean: 0.3, scales: [(0.8, 0.0); 3], count: 1, sign: EffectSign::Either };
    let scorer = Scorer {
        priors: vec![prior],
        effect_of: vec![0],
        ln_choices: vec![0.0],
        effects: 1,
        age_of: vec![None],
        held: vec![false],
        rows,
    };
    // p(y|θ, v) ∝ v^(−n/2) exp(−|y − Xθ|²/2v), θ ~ N(μ, s² v), v ~ inverse gamma(ν0/2, ν0/2).
    let integral = |with: bool| {
        let mut sum = 0.0;
        for i in 0..400 {
            let v = (f64::from(i - 200) * 0.015).exp();
            let weight_v = v.powf(-0.5 * NOISE_FREEDOM) * (-0.5 * NOISE_FREEDOM / v).exp();
            if !with {
                sum += weight_v * v.powf(-0.5 * rows) * (-0.5 * square / v).exp() * 0.015;
                continue;
            }
            for j in 0..800 {
                let theta = -3.0 + f64::from(j) * 0.0075;
                let rest = square - 2.0 * product * theta + gram * theta * theta;
                let z2 = (theta - 0.3_f64).powi(2) / (0.64 * v);
                let density = (-0.5 * z2).exp() / (0.8 * (2.0 * core::f64::consts::PI * v).sqrt());
                sum += weight_v
                    * v.powf(-0.5 * rows)
                    * (-0.5 * rest / v).exp()
                    * density
                    * 0.0075
                    * 0.015;
            }
        }
        sum.ln()
    };
    let expected = integral(true) - integral(false);
    let found = scorer.one(&at, 0, 0.0).ln - scorer.none(&at);
    assert!((found - expected).abs() < 2e-3, "{found} {expected}");
}

/// The same of two effects that the data confuse, each with a prior of its own.
#[test]
fn evidence_of_two_effects_against_numerical_integration() {
    let (gram, product, square, rows) = ([[7.0, 2.0], [2.0, 5.0]], [5.0, -3.0], 12.0, 9.0);
    let matrix = faer::Mat::from_fn(3, 3, |i, j| match (i, j) {
        (2, 2) => square,
        (2, k) | (k, 2) => product[k],
        (i, j) => gram[i][j],
    });
    let at = Background::small(&matrix, &[0, 1], 2, 0.0);
    let prior = |mean: f64, deviation: f64| Prior {
        mean,
        scales: [(deviation, 0.0); 3],
        count: 1,
        sign: EffectSign::Either,
    };
    let scorer = Scorer {
        priors: vec![prior(0.3, 0.8), prior(-0.2, 0.6)],
        effect_of: vec![0, 1],
        ln_choices: vec![0.0; 2],
        effects: 2,
        age_of: vec![None; 2],
        held: vec![false; 2],
        rows,
    };
    let normal = |theta: f64, mean: f64, variance: f64| {
        (-0.5 * (theta - mean).powi(2) / variance).exp()
            / (core::f64::consts::TAU * variance).sqrt()
    };
    let (mut both, mut none) = (0.0, 0.0);
    let step = 0.05;
    for i in -40..40 {
        let v = (0.075 * f64::from(i)).exp();
        let of_noise = |rest: f64| {
            let prior = v.powf(-0.5 * NOISE_FREEDOM) * (-0.5 * NOISE_FREEDOM / v).exp();
            prior * v.powf(-0.5 * rows) * (-0.5 * rest / v).exp()
        };
        none += of_noise(square);
        for a in (-80..80).map(|k| step * f64::from(k)) {
            for b in (-80..80).map(|k| step * f64::from(k)) {
                let rest = square - 2.0 * (product[0] * a + product[1] * b)
                    + gram[0][0] * a * a
                    + 2.0 * gram[0][1] * a * b
                    + gram[1][1] * b * b;
                let density = normal(a, 0.3, 0.64 * v) * normal(b, -0.2, 0.36 * v);
                both += of_noise(rest) * density * step * step;
            }
        }
    }
    let found = scorer.two(&at, [0, 1], [0.0; 2]).ln - scorer.none(&at);
    let expected = (both / none).ln();
    assert!((found - expected).abs() < 2e-3, "{found} {expected}");
}
