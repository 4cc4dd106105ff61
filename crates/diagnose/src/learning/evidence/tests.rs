use super::*;
use crate::learning::outliers::Weights;
use crate::learning::rows::ChannelRows;
use crate::learning::turned::TurnedFlights;
use crate::math::cholesky::Cholesky;
use crate::priors::SCALE_OF_NOTHING;

/// A level and a slope over five values of two flights, all of them by hand as one normal distribution: the density of
/// N(0, X K Xᵀ + w²D + b²UUᵀ), whose inverse and determinant faer gives.
#[test]
fn evidence_is_the_density_of_what_was_recorded() {
    let columns =
        [[1.0, -0.4, 0.3], [1.0, 0.1, 0.9], [1.0, 0.5, -0.2], [1.0, 0.2, 1.1], [1.0, -1.0, 0.4]];
    let rows = ChannelRows {
        columns: Mat::from_fn(5, 3, |i, j| columns[i][j]),
        variance: vec![0.5, 0.7, 0.4, 1.0, 0.6],
        loadings: vec![vec![0.3, 0.4, 0.3, 0.5, 0.2]],
        groups: vec![0..3, 3..5],
        shares: vec![1.0; 2],
    };
    let sums = ChannelSums::new(&rows, &Weights::of_one(&rows), &mut TurnedFlights::default());
    let prior = Prior::of_roots(vec![
        Mat::from_fn(2, 2, |i, j| if i == j && i == 0 { 1.0 } else { 0.0 }),
        Mat::from_fn(2, 2, |i, j| if i == j && i == 1 { 1.0 } else { 0.0 }),
    ]);
    let density = |dials: &Dials| {
        let covariance = Mat::from_fn(5, 5, |i, j| {
            let own = if i == j { dials.within.powi(2) * rows.variance[i] } else { 0.0 };
            let same = (i < 3) == (j < 3);
            let common = if same { rows.loadings[0][i] * rows.loadings[0][j] } else { 0.0 };
            let slope = dials.scales[0].powi(2) * columns[i][1] * columns[j][1];
            own + dials.between.powi(2) * common + 1.0 + slope
        });
        let y = Mat::from_fn(5, 1, |i, _| columns[i][2]);
        let factor = Cholesky::new(&covariance).unwrap();
        let mut solved = y.clone();
        factor.solve(&mut solved);
        -0.5 * (factor.ln_determinant() + (y.transpose() * &solved)[(0, 0)])
    };
    let mut evidence = Evidence::new(&sums, &prior);
    let mut found = |within: f64, between: f64, scale: f64| {
        let dials = Dials { within, between, scales: [scale, 1.0, 1.0] };
        (evidence.ln_evidence(&dials) - evidence.ln_prior(&dials), density(&dials))
    };
    let (at, known) = found(0.6, 0.9, 0.8);
    for (within, between, scale) in [(0.3, 0.4, 2.0), (1.5, 0.1, 0.2), (0.6, 0.9, 1.1)] {
        let (other, other_known) = found(within, between, scale);
        assert!(((other - at) - (other_known - known)).abs() < 1e-10);
    }
    // With scales made cheap to move, at one ratio of the noise.
    let start = Dials { within: 0.6, between: 0.9, scales: [0.8, 1.0, 1.0] };
    evidence.prepare_scales(&start);
    for (within, scale) in [(0.6, 0.8), (0.6, 2.0), (0.6, 0.01), (1.2, 0.3)] {
        let scales = [scale, 1.0, 1.0];
        let dials = Dials { within, between: within * start.ratio(), scales };
        let by_scales = evidence.by_scales.as_mut().unwrap();
        assert!(by_scales.is_at(dials.ratio()) && by_scales.seen(&dials).is_some());
        let other = evidence.ln_evidence(&dials) - evidence.ln_prior(&dials);
        assert!(((other - at) - (density(&dials) - known)).abs() < 1e-10);
    }
}

/// Twelve flights of four values, a level and a slope of so many prior standard deviations, noise without order.
fn flights_with_slope(slope: f64) -> ChannelRows {
    let (flights, each) = (12, 4);
    let number = |k: usize| (k as f64 * 0.618_033_988_749_895).fract() - 0.5;
    let along = |row: usize| 2.0 * number(7 * row + 3);
    let value =
        |row: usize| 0.4 + slope * along(row) + number(row + 1) + number(row / each * 5 + 2);
    ChannelRows {
        columns: Mat::from_fn(flights * each, 3, |row, column| match column {
            0 => 1.0,
            1 => along(row),
            _ => value(row),
        }),
        variance: vec![0.1; flights * each],
        loadings: vec![vec![0.3; flights * each]],
        groups: (0..flights).map(|flight| flight * each..(flight + 1) * each).collect(),
        shares: vec![1.0; flights],
    }
}

/// The probability that only the level is off: the marginal likelihoods of both models by numerical integration over the
/// noise and the scale of the slope; the last slope is as large as the scale may be.
#[test]
fn level_alone_is_as_probable_as_by_integration() {
    let part = |at: usize| Mat::from_fn(2, 2, |i, j| f64::from(u8::from(i == j && i == at)));
    let prior = Prior::of_roots(vec![part(0), part(1)]);
    let mut between = 0;
    for slope in [0.0, 0.15, 0.25, 0.4, 1.5, 12.0] {
        let rows = flights_with_slope(slope);
        let sums = ChannelSums::new(&rows, &Weights::of_one(&rows), &mut TurnedFlights::default());
        let mut evidence = Evidence::new(&sums, &prior);
        let likeliest = evidence.likeliest(Dials::usual(), &[0.6, 0.3, 0.1, 0.05]);
        let points = evidence.points(likeliest);
        let least = SCALE_OF_NOTHING;
        let is_level = |point: &&Weighted| point.dials.scales[0] < 1.1 * least;
        let found: f64 = points.iter().filter(is_level).map(|point| point.weight).sum();

        let step = 0.1;
        let mut sum = |scales: &[f64]| -> f64 {
            let mut sum = 0.0;
            for within in (-25..25).map(|k| f64::from(k) * step) {
                for ratio in (-25..25).map(|k| f64::from(k) * step) {
                    for scale in scales {
                        let dials = Dials::at(&[within, ratio, *scale, 0.0, 0.0]);
                        sum += (evidence.ln_evidence(&dials) + 20.0).exp();
                    }
                }
            }
            sum
        };
        let scales: Vec<f64> = (-40..=22).map(|k| f64::from(k) * step).collect();
        let density = step / (SCALE_LN_DEVIATIONS[0] * core::f64::consts::TAU.sqrt());
        let all = sum(&scales) * density;
        let at_least = ln_log_normal(least, 1.0, SCALE_LN_DEVIATIONS[0]);
        let of_level = sum(&[least.ln()]) / at_least.exp();
        let odds = PRIOR_LEVEL_ALONE / (1.0 - PRIOR_LEVEL_ALONE) * of_level / all;
        let expected = odds / (1.0 + odds);
        assert!((found - expected).abs() < 0.05, "slope {slope}: {found}, {expected}");
        between += usize::from((0.1..0.9).contains(&expected));
    }
    assert!(between > 0, "no case is in doubt");
}
