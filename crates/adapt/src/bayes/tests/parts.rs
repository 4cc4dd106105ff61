//! What a state sums up, what a draw keeps physical and where a search ends: part by part.

use super::super::information::Row;
use super::*;

/// How far a flight couples nodes, counted by hand: cells of rows 2 and 5 and of columns 4 and 8 have the rows 2 to 6 and the
/// columns 4 to 9, which its common error couples. Two flights, one in each cell, couple neighbours only.
#[test]
fn a_flight_reaches_from_its_first_row_to_its_last() {
    let grid = even_grid();
    let (x, y) = (grid.x().breakpoints(), grid.y().breakpoints());
    let row = |row: usize, column: usize| {
        let place = (x[row] + 0.02, y[column] + 0.03);
        let cell = grid.locate(place.0, place.1, Outside::Error).unwrap();
        Row {
            nodes: cell.nodes(),
            coefficients: cell.weights(),
            bilinear: cell.weights(),
            residual: 0.01,
            precision: 1e4,
            count: 1.0,
        }
    };
    let (low, high) = (row(2, 4), row(5, 8));
    let mut together = Information::new(grid.nodes());
    together.add_flight(&[low, high], 1e-4, 1.0);
    assert_eq!(together.reach(&grid), (4, 5));
    let mut apart = Information::new(grid.nodes());
    apart.add_flight(&[low], 1e-4, 1.0);
    apart.add_flight(&[high], 1e-4, 1.0);
    assert_eq!(apart.reach(&grid), (1, 1));
}

/// What the outlier weights learn of a flight is share·Φᵀ·V⁻¹·Φ and share·Φᵀ·V⁻¹·y, with V = D + s²·1·1ᵀ inverted by nalgebra.
#[test]
fn the_expected_residual_learns_as_dense_least_squares() {
    let settings = WeightSettings::new(&BayesSettings::physical_2026(), (0.45, 0.725));
    let segments = [(0.30, 0.75, 0.02, 2e-5), (0.35, 0.77, 0.05, 3e-5), (0.40, 0.86, -0.01, 5e-5)]
        .map(|(lift_coefficient, mach, residual, variance)| SegmentResidual {
            lift_coefficient,
            mach,
            residual,
            variance,
        });
    let weights =
        FlightWeights { weights: vec![1.1, 0.2, 0.9], flight_weight: 0.5, surprises: vec![] };
    let (flight_variance, share) = (1e-4, 0.25);
    let mut found = ExpectedResidual::new();
    found.learn(&settings, &segments, &weights, flight_variance, share);

    let terms = DMatrix::from_fn(3, 6, |row, term| {
        let (u, v) =
            ((segments[row].lift_coefficient - 0.45) / 0.3, (segments[row].mach - 0.725) / 0.1);
        [1.0, u, v, u * u, u * v, v * v][term]
    });
    // A quarter of the quadratic terms, which a quadratic misses, is common to the flight.
    let common = (flight_variance + (0.0675 * 0.0675 + 0.01 * 0.01) / 16.0) / 0.5;
    let variance = DMatrix::from_fn(3, 3, |row, column| {
        let own = if row == column { segments[row].variance / weights.weights[row] } else { 0.0 };
        own + common
    });
    let precision = share * variance.try_inverse().unwrap();
    let residuals = DVector::from_fn(3, |row, _| segments[row].residual);
    let matrix = terms.transpose() * &precision * &terms;
    let vector = terms.transpose() * precision * residuals;
    let mut entries = found.matrix.iter();
    for i in 0..6 {
        for j in 0..=i {
            let entry = entries.next().unwrap();
            let scale = (matrix[(i, i)] * matrix[(j, j)]).sqrt();
            assert!((entry - matrix[(i, j)]).abs() < 1e-9 * scale, "{i} {j}: {entry}");
        }
        assert!((found.vector[i] - vector[i]).abs() < 1e-9 * vector.norm(), "{i}");
    }
}

/// By definition of the half-life: after it, everything that was learnt counts half, that of the outlier weights too.
#[test]
fn after_a_half_life_all_that_was_learnt_counts_half() {
    let grid = even_grid();
    let initial = polar(&grid);
    let values =
        SettingValues { half_life_days: Some(100.0), ..*BayesSettings::physical_2026().values() };
    let settings = BayesSettings::new(values).unwrap();
    let mut random = Random(ChaCha8Rng::seed_from_u64(7));
    let learnt = flights(&mut random, &initial, 5, (0.01, 0.005), some_correction);
    let mut state = BayesState::new(&initial, settings).unwrap();
    let _ = weighted(&mut state, &learnt);
    let before = state.to_data();
    let newest = state.newest().unwrap().as_second();
    state.decay_to(Timestamp::from_second(newest + 100 * 86_400).unwrap());
    let after = state.to_data();
    let half = |after: &[f64], before: &[f64]| {
        for (after, before) in after.iter().zip(before) {
            assert!((after - 0.5 * before).abs() <= 1e-12 * before.abs(), "{after} {before}");
        }
        assert!(before.iter().any(|value| *value != 0.0));
    };
    half(&after.judge, &before.judge);
    half(&after.vector, &before.vector);
    half(&after.observations, &before.observations);
    for (after, before) in after.information.iter().zip(&before.information) {
        half(after, before);
    }
}

/// By definition: a segment counts as its outlier weight, 1 at most, spread over the corners of its cell.
#[test]
fn an_outlier_is_less_than_an_observation() {
    let grid = even_grid();
    let initial = polar(&grid);
    let mut random = Random(ChaCha8Rng::seed_from_u64(8));
    let mut learnt = flights(&mut random, &initial, 6, (0.004, 0.004), |_| 0.02);
    for observation in learnt.iter_mut().flatten().step_by(7) {
        observation.drag_coefficient *= 1.10;
    }
    let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
    let weights = weighted(&mut state, &learnt);
    let mut expected = vec![0.0; grid.nodes()];
    let mut least: f64 = 1.0;
    for (flight, of_flight) in learnt.iter().zip(&weights) {
        for (observation, weight) in flight.iter().zip(&of_flight.weights) {
            let (cell, _) = located(&initial, observation).unwrap();
            for (node, bilinear) in cell.nodes().into_iter().zip(cell.weights()) {
                expected[node] += bilinear * weight.min(1.0);
            }
            least = least.min(*weight);
        }
    }
    assert!(least < 0.2, "{least}");
    let posterior = state.solve().unwrap();
    for (found, expected) in posterior.observations().iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

/// Wanted is a draw of which one column falls with lift coefficient. By hand, the nearest drag that does not fall is the mean
/// of both nodes, each weighted by one over the square of its drag's standard deviation; every other node is as drawn. The
/// numbers that draw it are solved for by nalgebra, from draws so small that nothing is kept physical.
#[test]
fn what_falls_in_a_draw_is_pooled_by_what_is_known() {
    const SCALE: f64 = 1e-4;
    let lift_coefficient = Axis::new(vec![0.2, 0.6]).unwrap();
    let mach = Axis::new(vec![0.5, 0.7, 0.9]).unwrap();
    let grid = Arc::new(Grid::new(lift_coefficient, mach));
    let initial = polar(&grid);
    let mut random = Random(ChaCha8Rng::seed_from_u64(9));
    let learnt = flights(&mut random, &initial, 4, (0.01, 0.005), some_correction);
    let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
    let _ = weighted(&mut state, &learnt);
    let posterior = state.solve().unwrap();
    let nodes = grid.nodes();
    let mean = posterior.drawn(&vec![0.0; nodes]);
    let units = DMatrix::from_fn(nodes, nodes, |node, unit| {
        let mut numbers = vec![0.0; nodes];
        numbers[unit] = SCALE;
        let deviation = posterior.drawn(&numbers).value_at_node(node) - mean.value_at_node(node);
        deviation / (SCALE * initial.value_at_node(node))
    });
    // Nodes 1 and 4 are the lower and the upper lift coefficient at the middle Mach number.
    let (low, high) = (1, 4);
    let wanted = DVector::from_vec(vec![0.0, 0.4, 0.0, 0.0, -0.5, 0.0]);
    let numbers = units.try_inverse().unwrap() * &wanted;
    let drawn = posterior.drawn(numbers.as_slice());

    let unguarded =
        |node: usize| mean.value_at_node(node) + wanted[node] * initial.value_at_node(node);
    assert!(unguarded(high) < 0.9 * unguarded(low));
    let weight = |node: usize| {
        1.0 / (initial.value_at_node(node) * posterior.standard_deviation()[node]).powi(2)
    };
    let pooled = (weight(low) * unguarded(low) + weight(high) * unguarded(high))
        / (weight(low) + weight(high));
    for node in 0..nodes {
        let expected = if node == low || node == high { pooled } else { unguarded(node) };
        let found = drawn.value_at_node(node);
        assert!((found / expected - 1.0).abs() < 1e-6, "{node}: {found} {expected}");
    }
}

/// Flights scatter by 4 %, four times what is stated beyond the sensors, or by a thousandth of that: a search that may go to
/// twice or half as much ends at its limit and reports it; one that may go to six standard deviations of its prior does not.
#[test]
fn a_search_that_ends_at_its_limit_reports_it() {
    let grid = even_grid();
    let initial = polar(&grid);
    let at_limit = |flight_std: f64, largest_factor: f64| {
        let mut random = Random(ChaCha8Rng::seed_from_u64(10));
        let flown = flights(&mut random, &initial, 30, (flight_std, 0.005), |_| 0.0);
        let search = Search { largest_factor, ..Search::standard() };
        tune(&initial, BayesSettings::physical_2026(), &flown, &search).unwrap().at_limit
    };
    assert!(at_limit(0.04, 2.0).contains(&"extra_flight_std"));
    assert!(at_limit(4e-5, 2.0).contains(&"extra_flight_std"));
    assert_eq!(at_limit(0.04, 64.0), Vec::<&str>::new());
    assert_eq!(at_limit(4e-5, 64.0), Vec::<&str>::new());
}
