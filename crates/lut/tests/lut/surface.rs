//! Surfaces: the bases term by term, fits against known coefficients, and points that do not determine one.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test")]
#![expect(clippy::float_cmp, reason = "what is exact is tested to be exact")]

use lut::surface::{Basis, FitError, Surface, Undetermined, fit};

const BASES: [Basis; 2] = [Basis::SeparableQuadratic, Basis::FullQuadratic];

fn grid_points(value: impl Fn(f64, f64) -> f64) -> Vec<(f64, f64, f64, f64)> {
    let mut points = vec![];
    for i in 0..7 {
        for j in 0..6 {
            let (x, y) = (0.1 + 0.1 * f64::from(i), 0.5 + 0.08 * f64::from(j));
            points.push((x, y, value(x, y), 1.0));
        }
    }
    points
}

/// By hand at x = 2, y = 3.
#[test]
fn basis_functions_in_their_order() {
    assert_eq!(Basis::SeparableQuadratic.row(2.0, 3.0), [1.0, 3.0, 9.0, 4.0, 12.0, 36.0]);
    assert_eq!(Basis::FullQuadratic.row(2.0, 3.0), [1.0, 3.0, 2.0, 9.0, 6.0, 4.0]);
    let surface =
        Surface { basis: Basis::SeparableQuadratic, coefficients: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0] };
    // 1 + 2·3 + 3·9 + (4 + 5·3 + 6·9)·4 = 34 + 292
    assert_eq!(surface.value(2.0, 3.0), 326.0);
}

/// Check 9 of the reconstruction: equal weights on a polynomial surface give its coefficients.
#[test]
fn a_polynomial_gives_its_own_coefficients() {
    for basis in BASES {
        let truth = Surface { basis, coefficients: [0.25, -0.59, 0.38, 0.12, -0.22, 0.2] };
        let fit = fit(basis, &grid_points(|x, y| truth.value(x, y))).unwrap();
        for (ours, expected) in fit.surface.coefficients.iter().zip(truth.coefficients) {
            assert!((ours - expected).abs() < 1e-11, "{basis:?}: {ours} for {expected}");
        }
        assert_eq!(fit.rank, 6);
        assert!(fit.residual_rms < 1e-15);
    }
}

/// An independent implementation's coefficients and the values that it put on a grid (13 digits).
#[test]
fn an_independent_polynomial_comes_back_from_its_table() {
    let numbers = |text: &'static str| {
        text.lines()
            .skip(1)
            .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>())
            .collect::<Vec<_>>()
    };
    let points: Vec<_> = numbers(include_str!("../golden/initial_wide_table.csv"))
        .iter()
        .map(|row| (row[0], row[1], row[2], 1.0))
        .collect();
    let fit = fit(Basis::SeparableQuadratic, &points).unwrap();
    for row in numbers(include_str!("../golden/initial_polynomial.csv")) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let ours = fit.surface.coefficients[row[0] as usize];
        assert!((ours - row[1]).abs() < 1e-10, "p{} {ours} for {}", row[0], row[1]);
    }
    for (x, y, z, _) in points {
        assert!((fit.surface.value(x, y) - z).abs() < 1e-14);
    }
}

/// The mean is the simplest weighted fit. Six points with two values each, 3 with weight 1 and 7 with weight 3: the
/// surface goes through (1·3 + 3·7)/4 = 6 everywhere, and every residual is 3 or 1: rms² = (1·9 + 3·1)/4 = 3.
#[test]
fn weights_multiply_squared_residuals() {
    let places = [(0.1, 0.5), (0.4, 0.5), (0.2, 0.7), (0.5, 0.7), (0.3, 0.9), (0.6, 0.9)];
    let mut points = vec![];
    for (x, y) in places {
        points.push((x, y, 3.0, 1.0));
        points.push((x, y, 7.0, 3.0));
    }
    let fit = fit(Basis::SeparableQuadratic, &points).unwrap();
    for (x, y) in places {
        assert!((fit.surface.value(x, y) - 6.0).abs() < 1e-11);
    }
    assert!((fit.residual_rms - 3.0_f64.sqrt()).abs() < 1e-11);
}

/// A weight of 2 is the point given twice; a weight of 0 is the point left out.
#[test]
fn weights_are_repetitions() {
    for basis in BASES {
        let rough = |x: f64, y: f64| (5.0 * x).sin() + (7.0 * y).cos();
        let mut weighted = grid_points(rough);
        let mut repeated = weighted.clone();
        weighted[3].3 = 2.0;
        repeated.push(repeated[3]);
        weighted[11].3 = 0.0;
        repeated.remove(11);
        let (weighted, repeated) = (fit(basis, &weighted).unwrap(), fit(basis, &repeated).unwrap());
        let pairs = weighted.surface.coefficients.iter().zip(repeated.surface.coefficients);
        for (ours, expected) in pairs {
            assert!((ours - expected).abs() < 1e-10);
        }
        assert!((weighted.residual_rms - repeated.residual_rms).abs() < 1e-12);
        assert!((weighted.condition_number / repeated.condition_number - 1.0).abs() < 1e-9);
    }
}

/// At the minimum the residuals are orthogonal to every weighted basis function.
#[test]
fn residuals_are_orthogonal_to_the_basis() {
    for basis in BASES {
        let mut points = grid_points(|x, y| (5.0 * x).sin() + (7.0 * y).cos());
        for (i, point) in points.iter_mut().enumerate() {
            point.3 = 1.0 + (i % 5) as f64;
        }
        let fit = fit(basis, &points).unwrap();
        for k in 0..6 {
            let product: f64 = points
                .iter()
                .map(|&(x, y, z, weight)| {
                    weight * basis.row(x, y)[k] * (z - fit.surface.value(x, y))
                })
                .sum();
            assert!(product.abs() < 1e-12, "{basis:?} {k}: {product}");
        }
    }
}

/// With x = 0 and 1, y = −1, 0 and 1 the design is the Kronecker product of `[1 0; 1 1]` and A, the rows (1, y, y²); its
/// condition number is the product of theirs. The first's is the golden ratio squared. `AᵀA = [3 0 2; 0 2 0; 2 0 2]` has
/// the eigenvalues (5 ± √17)/2 and 2.
#[test]
fn condition_number_by_hand() {
    let mut points = vec![];
    for x in [0.0, 1.0] {
        for y in [-1.0, 0.0, 1.0] {
            points.push((x, y, x + y, 1.0));
        }
    }
    let fit = fit(Basis::SeparableQuadratic, &points).unwrap();
    let golden_squared = 1.0 + f64::midpoint(1.0, 5.0_f64.sqrt());
    let root = 17.0_f64.sqrt();
    let expected = golden_squared * ((5.0 + root) / (5.0 - root)).sqrt();
    assert!((fit.condition_number / expected - 1.0).abs() < 1e-13, "{}", fit.condition_number);
}

fn undetermined(basis: Basis, points: &[(f64, f64, f64, f64)]) -> (usize, Undetermined) {
    match fit(basis, points).unwrap_err() {
        FitError::RankDeficient { rank, condition_number, undetermined } => {
            assert!(condition_number > 1e9);
            (rank, undetermined)
        }
        other => panic!("{other}"),
    }
}

#[test]
fn what_points_do_not_say_is_named() {
    let with = |change: fn(&mut (f64, f64, f64, f64))| {
        let mut points = grid_points(|x, y| x + y);
        points.iter_mut().for_each(change);
        points
    };
    for basis in BASES {
        let same_y = with(|point| point.1 = 0.8);
        assert!(
            matches!(undetermined(basis, &same_y), (_, Undetermined::SameY { value }) if value == 0.8)
        );
        let same_x = with(|point| point.0 = 0.3);
        assert!(
            matches!(undetermined(basis, &same_x), (3, Undetermined::SameX { value }) if value == 0.3)
        );
        let two_y = with(|point| point.1 = if point.1 < 0.7 { 0.6 } else { 0.8 });
        assert_eq!(undetermined(basis, &two_y).1, Undetermined::FewY { distinct: 2, needed: 3 });
        // A difference below the width of a breakpoint does not count.
        let nearly = with(|point| point.1 = 0.8 + 1e-11 * point.1);
        assert!(matches!(undetermined(basis, &nearly).1, Undetermined::SameY { .. }));
    }
    assert_eq!(undetermined(Basis::SeparableQuadratic, &with(|point| point.1 = 0.8)).0, 2);
    assert_eq!(undetermined(Basis::FullQuadratic, &with(|point| point.1 = 0.8)).0, 3);
    let two_x = with(|point| point.0 = if point.0 < 0.4 { 0.3 } else { 0.5 });
    assert_eq!(
        undetermined(Basis::FullQuadratic, &two_x).1,
        Undetermined::FewX { distinct: 2, needed: 3 }
    );
    assert!(fit(Basis::SeparableQuadratic, &two_x).is_ok(), "x enters by its square alone");
    // x = ±0.3 are one |x| for the first basis.
    let mirrored = with(|point| point.0 = if point.0 < 0.4 { -0.3 } else { 0.3 });
    assert!(matches!(
        undetermined(Basis::SeparableQuadratic, &mirrored).1,
        Undetermined::SameX { .. }
    ));
}

/// On the line y = x every multiple of y − x vanishes, and so do those of y² − x y and x y − x².
#[test]
fn points_on_one_line_leave_a_combination() {
    let points: Vec<_> = (0..20).map(|i| f64::from(i) / 20.0).map(|t| (t, t, t, 1.0)).collect();
    let (rank, undetermined) = undetermined(Basis::FullQuadratic, &points);
    assert_eq!(rank, 3);
    let Undetermined::Combination { coefficients } = undetermined else { panic!("{undetermined}") };
    let vanishing = Surface { basis: Basis::FullQuadratic, coefficients };
    assert!(points.iter().all(|point| vanishing.value(point.0, point.1).abs() < 1e-9));
    assert!(coefficients.contains(&1.0));
    assert!(coefficients.iter().all(|coefficient| coefficient.abs() <= 1.0));
}

/// By hand: on the parabola y = 2x², which is no line, 2x² − y is the only sum that vanishes; divided by its largest
/// coefficient it is x² − y/2. The columns of y and of x² differ in length by a factor of 2.
#[test]
fn points_on_a_parabola_leave_the_parabola() {
    let points: Vec<_> =
        (1..=20).map(|i| 0.1 * f64::from(i)).map(|x| (x, 2.0 * x * x, x, 1.0)).collect();
    let (rank, undetermined) = undetermined(Basis::FullQuadratic, &points);
    assert_eq!(rank, 5);
    let Undetermined::Combination { coefficients } = undetermined else { panic!("{undetermined}") };
    for (found, expected) in coefficients.into_iter().zip([0.0, -0.5, 0.0, 0.0, 0.0, 1.0]) {
        assert!((found - expected).abs() < 1e-9, "{coefficients:?}");
    }
}

/// A point of weight 0 is a point left out: it neither makes up the number nor adds a y that differs.
#[test]
fn points_without_weight_determine_nothing() {
    let basis = Basis::SeparableQuadratic;
    let mut points = grid_points(|x, y| x + y);
    points[2].3 = 0.0;
    assert_eq!(fit(basis, &points[..6]), Err(FitError::TooFewPoints { points: 5 }));
    for point in &mut points {
        point.1 = 0.8;
    }
    points[2].1 = 0.5;
    assert_eq!(undetermined(basis, &points).1, Undetermined::SameY { value: 0.8 });
}

#[test]
fn other_refusals_and_their_words() {
    let mut points = grid_points(|x, y| x + y);
    let basis = Basis::SeparableQuadratic;
    assert_eq!(fit(basis, &points[..5]), Err(FitError::TooFewPoints { points: 5 }));
    points[4].3 = -1.0;
    assert_eq!(fit(basis, &points), Err(FitError::WeightInvalid { index: 4, weight: -1.0 }));
    points[4].3 = f64::NAN;
    assert!(matches!(fit(basis, &points), Err(FitError::WeightInvalid { index: 4, .. })));
    points[4] = (0.3, 0.7, f64::NAN, 1.0);
    assert!(matches!(fit(basis, &points), Err(FitError::NotFinite { index: 4, .. })));
    points[4] = (1e200, 0.7, 0.0, 1.0);
    assert!(matches!(fit(basis, &points), Err(FitError::NotFinite { index: 4, .. })));

    let same_y: Vec<_> =
        grid_points(|x, y| x + y).into_iter().map(|p| (p.0, 0.8, p.2, 1.0)).collect();
    let text = fit(basis, &same_y).unwrap_err().to_string();
    assert!(text.starts_with("rank 2 of 6, condition number "), "{text}");
    assert!(text.ends_with(": all points have the same y 0.8"), "{text}");
}

/// The units of x and y do not affect what is determined: x in thousands is as good as x in units.
#[test]
fn rank_does_not_depend_on_units() {
    let points: Vec<_> =
        grid_points(|x, y| x + y).into_iter().map(|p| (1e5 * p.0, p.1, p.2, 1.0)).collect();
    let fit = fit(Basis::FullQuadratic, &points).unwrap();
    assert!(fit.condition_number > 1e9);
    assert!((fit.surface.value(3e4, 0.7) - 1.0).abs() < 1e-9);
}
