use super::*;

/// The oracle is the function by its terms, between the knots and far beyond them.
#[test]
fn curves_are_the_function_within_their_error() {
    let values: Vec<f64> = (0..50).map(|k| 0.70 + 0.003 * f64::from(k)).collect();
    let mut smooth = Smooth::over(Variable::Mach, 0.02, &values).unwrap();
    smooth.set_reach_of_guide((3.0, 7.0));
    let means: Vec<f64> =
        (0..smooth.len()).map(|k| 0.03 * (f64::from(u8::try_from(k).unwrap())).sin()).collect();
    let prepared = smooth.prepared(means.iter().copied());
    let (curve, left) = (prepared.curve().unwrap(), prepared.left_curve().unwrap());
    let mut terms = vec![0.0; smooth.len()];
    for step in 0..20_000_u32 {
        let value = 0.30 + 0.00005 * f64::from(step);
        let known_left = smooth.write(value, &mut terms);
        let known: f64 = terms.iter().zip(&means).map(|(term, mean)| term * mean).sum();
        let z = prepared.at(&[value; LANES]);
        let found = curve.at(&z)[step as usize % LANES];
        assert!((found - known).abs() < 1.1 * CURVE_ERROR, "{value}: {found}, {known}");
        let mut sums = [[0.0; LANES]; 2];
        prepared.add_left((&z, &left.at(&z)), 1.0, &mut sums);
        let tolerance = 1e-6 * known_left.total().max(1.0);
        let [found, rest] = sums.map(|sum| sum[step as usize % LANES]);
        let known = known_left.between_knots + known_left.within_guide;
        assert!((found - known).abs() < tolerance, "{value}: {found}, {known_left:?}");
        assert!((rest - known_left.beyond_guide).abs() < tolerance, "{value}: {rest}");
    }
}

/// The covariance of two values is the kernel's where there are knots, and the prior's variance is never exceeded.
#[test]
fn between_knots_the_terms_have_the_kernels_covariance() {
    let values: Vec<f64> = (0..50).map(|k| 0.70 + 0.003 * f64::from(k)).collect();
    let smooth = Smooth::over(Variable::Mach, 0.02, &values).unwrap();
    let mut one = vec![0.0; smooth.len()];
    let mut other = vec![0.0; smooth.len()];
    for a in [0.70, 0.7333, 0.78, 0.83] {
        let left = smooth.write(a, &mut one).total();
        assert!(left < 0.01, "{a}: {left}");
        for b in [0.71, 0.7450, 0.81] {
            smooth.write(b, &mut other);
            let found: f64 = one[1..].iter().zip(&other[1..]).map(|(p, q)| p * q).sum();
            let expected = (-0.5 * ((a - b) / 0.02_f64).powi(2)).exp();
            assert!((found - expected).abs() < 0.01, "{a} {b}: {found} {expected}");
        }
    }
    // Far away nothing is held, the slope goes on, and what is not known grows: by hand, 0.1 beyond 0.847 are 5.15 lengths,
    // ⅔·5.15³ = 91.06.
    assert!((smooth.write(0.95, &mut one).total() - 91.06).abs() < 0.01);
    assert!((one[0] - (0.95 - 0.7735) / 0.02).abs() < 1e-9);
    // Flown from 0.70 to 0.847, both ends included.
    let beyond = [0.6999, 0.70, 0.78, 0.847, 0.8471].map(|value| smooth.is_beyond(value));
    assert_eq!(beyond, [true, false, false, false, true]);
}

/// The oracle is the function asked term by term.
#[test]
fn prepared_it_is_the_same_function() {
    let values: Vec<f64> = (0..50).map(|k| 0.70 + 0.003 * f64::from(k)).collect();
    let smooth = Smooth::over(Variable::Mach, 0.02, &values).unwrap();
    let mean = |k: u32| 0.01 * f64::from(k * k % 7) - 0.02;
    let means: Vec<f64> = (0..20).map(mean).take(smooth.len()).collect();
    let prepared = smooth.prepared(means.iter().copied());
    let (mut terms, mut found) = (vec![0.0; smooth.len()], vec![[0.0]; smooth.len()]);
    for step in 0..=300 {
        let value = 0.4 + 0.002 * f64::from(step);
        let left = smooth.write(value, &mut terms).total();
        let z = prepared.at(&[value]);
        assert!((z[0] - prepared.text.knots.0).abs() <= REACH);
        let [left_found] = prepared.write(&z, &mut found);
        assert!((left - left_found).abs() < 1e-9 * left.max(1e-3), "{value}: {left_found}");
        for (term, [found]) in terms.iter().zip(&found) {
            assert!((term - found).abs() < 1e-12 * term.abs().max(1.0), "{value}: {found}");
        }
        let expected: f64 = terms.iter().zip(&means).map(|(term, mean)| term * mean).sum();
        assert!((prepared.mean(&z)[0] - expected).abs() < 1e-12, "{value}");
    }
}

/// Without a function of what did not vary, one flight at Mach 0.87 said as much of Mach 0.6 as of its own.
#[test]
fn what_does_not_vary_is_unknown_beyond_its_value() {
    assert!(Smooth::over(Variable::Mach, 0.02, &[]).is_none());
    let constant = Smooth::over(Variable::Mach, 0.02, &[0.8; 30]).unwrap();
    let mut terms = vec![0.0; constant.len()];
    assert!(!constant.is_beyond(0.8) && constant.is_beyond(0.81) && constant.is_beyond(0.79));
    let grown = |value: f64, terms: &mut [f64]| constant.write(value, terms).total();
    assert!(grown(0.8, &mut terms) < 0.01);
    assert!(grown(0.9, &mut terms) > 50.0 && grown(0.7, &mut terms) > 50.0);
}

#[test]
fn a_wide_range_has_few_knots() {
    let wide = Smooth::over(Variable::PressureAltitude, 600.0, &[0.0, 60_000.0]).unwrap();
    assert!(wide.len() <= 1 + SMOOTH_MOST_KNOTS);
    let mut terms = vec![0.0; wide.len()];
    assert!(wide.write(33_333.0, &mut terms).total() < 0.05);
}

/// By the formula: 2/3 of the cube of the distance in lengths up to the guide's end, and of the distance beyond it; above and below.
#[test]
fn what_lies_beyond_the_guide_grows_from_its_end() {
    let mut smooth = Smooth::over(Variable::Mach, 0.02, &[0.70, 0.76]).unwrap();
    smooth.set_reach_of_guide((1.5, 4.0));
    let (lowest, highest) = smooth.flown();
    let mut terms = vec![0.0; smooth.len()];
    for (value, known, rest) in [
        (highest + 3.0 * 0.02, 3.0, 0.0),
        (highest + 6.0 * 0.02, 4.0, 2.0),
        (lowest - 2.5 * 0.02, 1.5, 1.0_f64),
    ] {
        let left = smooth.write(value, &mut terms);
        let grown = |lengths: f64| 2.0 / 3.0 * lengths.powi(3);
        assert!((left.within_guide / grown(known) - 1.0).abs() < 1e-9, "{value}: {left:?}");
        assert!((left.beyond_guide - grown(rest)).abs() < 1e-9, "{value}: {left:?}");
        assert!(left.between_knots <= 0.0);
        let split = smooth.split_by_guide(smooth.beyond(value));
        assert!((split.0 - known).abs() + (split.1 - rest).abs() < 1e-9, "{value}: {split:?}");
    }
    let flown = smooth.write(0.73, &mut terms);
    assert!(flown.within_guide <= 0.0 && flown.beyond_guide <= 0.0, "{flown:?}");
}

/// By the formula: 2/3 of the cube of the distance in lengths, of the prior's variance for Mach number, else of the scaled one.
#[test]
fn what_grows_beyond_the_flown_mach_numbers_is_the_prior() {
    let scale = 0.1;
    for (variable, length, expected) in [
        (Variable::Mach, 0.02, 2.0 / 3.0 * 1.5_f64.powi(3)),
        (Variable::LiftCoefficient, 0.1, 2.0 / 3.0 * 1.5_f64.powi(3) * scale * scale),
    ] {
        let mut smooth = Smooth::over(variable, length, &[0.70, 0.70 + length]).unwrap();
        smooth.scale_by(scale);
        let mut terms = vec![0.0; smooth.len()];
        for beyond in [smooth.flown().0 - 1.5 * length, smooth.flown().1 + 1.5 * length] {
            let left = scale * scale * smooth.write(beyond, &mut terms).total();
            assert!((left / expected - 1.0).abs() < 1e-9, "{variable:?}: {left} {expected}");
        }
        // A scale above the prior's is what flights have shown.
        smooth.scale_by(2.0);
        let left = smooth.write(smooth.flown().1 + 1.5 * length, &mut terms).total();
        assert!((left / (2.0 / 3.0 * 1.5_f64.powi(3)) - 1.0).abs() < 1e-9, "{left}");
    }
}
