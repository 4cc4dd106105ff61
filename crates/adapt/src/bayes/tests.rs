//! Law `bayes` against dense linear algebra of another crate, and against draws of its own prior.
use std::sync::Arc;

use lut::Axis;
use nalgebra::{Cholesky, DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use super::outlier_weights::FlightWeights;
use super::*;

mod parts;

type Field = fn(f64, f64) -> f64;

const SENSORS: ObservationVariance = ObservationVariance { segment: 2.5e-5, flight: 2e-5 };

fn even_grid() -> Arc<Grid> {
    let lift_coefficient = Axis::from_step(0.10, 0.80, 0.05).unwrap();
    Arc::new(Grid::new(lift_coefficient, Axis::from_step(0.50, 0.95, 0.05).unwrap()))
}

/// Uneven, and with more Mach numbers than lift coefficients.
fn uneven_grid() -> Arc<Grid> {
    let lift_coefficient = Axis::new(vec![0.2, 0.25, 0.35, 0.4, 0.6]).unwrap();
    let mach = vec![0.5, 0.6, 0.65, 0.7, 0.74, 0.76, 0.78, 0.8, 0.81, 0.82, 0.84, 0.86, 0.9];
    Arc::new(Grid::new(lift_coefficient, Axis::new(mach).unwrap()))
}

fn polar(grid: &Arc<Grid>) -> Table {
    let value = |node| {
        let (lift_coefficient, mach) = grid.coordinates(node);
        0.018 + (0.05 + 0.02 * mach) * lift_coefficient * lift_coefficient
    };
    Table::new(Arc::clone(grid), (0..grid.nodes()).map(value).collect()).unwrap()
}

struct Random(ChaCha8Rng);

impl Random {
    fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }
}

/// Flights of 1 to 9 segments anywhere inside; drag is the initial times 1 + `correction` + noise.
fn flights(
    random: &mut Random,
    initial: &Table,
    count: usize,
    (flight_std, segment_std): (f64, f64),
    correction: impl Fn(&Cell) -> f64,
) -> Vec<Vec<Observation>> {
    let days = (1..).map(|day| 86_400 * day);
    let mut flight = |second: i64| {
        let common = flight_std * random.normal();
        let (first, mach) = (random.uniform(0.30, 0.55), random.uniform(0.70, 0.86));
        let segments = 1 + random.0.next_u32() % 9;
        let segment = |k: u32| {
            let lift_coefficient = first - 0.006 * f64::from(k);
            let mach = mach + 0.01 * random.uniform(0.0, 1.0);
            let cell = initial.grid().locate(lift_coefficient, mach, Outside::Error).unwrap();
            let excess = correction(&cell) + common + segment_std * random.normal();
            let drag_coefficient = initial.interpolate(&cell) * (1.0 + excess);
            Observation {
                time: Timestamp::from_second(second + i64::from(k)).unwrap(),
                lift_coefficient,
                mach,
                drag_coefficient,
                fuel_flow_total_kg_s: 10.0 * drag_coefficient,
                fuel_flow_per_drag_coefficient_kg_s: 10.0,
                variance: SENSORS,
            }
        };
        (0..segments).map(segment).collect()
    };
    days.take(count).map(&mut flight).collect()
}

fn dense_prior(grid: &Grid, settings: &BayesSettings) -> DMatrix<f64> {
    let mut dense = DMatrix::zeros(grid.nodes(), grid.nodes());
    prior::visit(grid, settings, |node, other, value| {
        dense[(node, other)] += value;
        if node != other {
            dense[(other, node)] += value;
        }
    });
    dense
}

/// W, y and V of flights with given weights, straight from the definitions.
fn dense_observations(
    state: &BayesState,
    flights: &[Vec<Observation>],
    weights: &[FlightWeights],
) -> (DMatrix<f64>, DVector<f64>, DMatrix<f64>) {
    let read: Vec<Flight> = flights.iter().map(|flight| state.read(flight)).collect();
    let count = read.iter().map(|flight| flight.rows.len()).sum();
    let mut rows = DMatrix::zeros(count, state.grid().nodes());
    let mut residuals = DVector::zeros(count);
    let mut variance = DMatrix::zeros(count, count);
    let mut start = 0;
    for (flight, flight_weights) in read.iter().zip(weights) {
        let end = start + flight.rows.len();
        for (k, row) in flight.rows.iter().enumerate() {
            for (&node, coefficient) in row.nodes.iter().zip(row.coefficients) {
                rows[(start + k, node)] += coefficient;
            }
            residuals[start + k] = row.residual;
            variance[(start + k, start + k)] +=
                flight.residuals[k].variance / flight_weights.weights[k];
        }
        let common = flight.common_variance / flight_weights.flight_weight;
        variance.view_mut((start, start), (end - start, end - start)).add_scalar_mut(common);
        start = end;
    }
    (rows, residuals, variance)
}

fn weighted(state: &mut BayesState, flights: &[Vec<Observation>]) -> Vec<FlightWeights> {
    flights
        .iter()
        .map(|observations| {
            let flight = state.read(observations);
            let flight_weights = state.expected_residual.weigh(
                &state.weight_settings,
                &flight.residuals,
                flight.common_variance,
            );
            state.learn_weighted(&flight, &flight_weights);
            flight_weights
        })
        .collect()
}

fn some_correction(cell: &Cell) -> f64 {
    let (u, v) = cell.local();
    0.04 + 0.01 * u - 0.01 * v
}

/// Conditioning on covariances (Rasmussen and Williams 2006, equations 2.23 and 2.24) with nalgebra, against the
/// information form with blocks: corrections, standard deviations, variances in cells, covariances between cells.
#[test]
fn solve_agrees_with_dense_conditioning() {
    for (seed, grid) in [(1, even_grid()), (2, uneven_grid())] {
        let initial = polar(&grid);
        let mut random = Random(ChaCha8Rng::seed_from_u64(seed));
        let flights = flights(&mut random, &initial, 12, (0.01, 0.005), some_correction);
        let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
        let weights = weighted(&mut state, &flights);
        let posterior = state.solve().unwrap();

        let prior = dense_prior(&grid, state.settings()).try_inverse().unwrap();
        let (rows, residuals, variance) = dense_observations(&state, &flights, &weights);
        let of_residuals = (&rows * &prior * rows.transpose() + variance).try_inverse().unwrap();
        let gain = &prior * rows.transpose() * of_residuals;
        let mean = &gain * residuals;
        let covariance = &prior - &gain * &rows * &prior;
        for node in 0..grid.nodes() {
            let std = covariance[(node, node)].sqrt();
            assert!((posterior.correction()[node] - mean[node]).abs() < 1e-9);
            assert!((posterior.standard_deviation()[node] - std).abs() < 1e-9);
            for (other, found) in posterior.covariances_with(node).into_iter().enumerate() {
                assert!((found - covariance[(node, other)]).abs() < 1e-12);
            }
        }
        let cells: Vec<Cell> = [(0.31, 0.77), (0.33, 0.77), (0.55, 0.55), (0.25, 0.86)]
            .map(|(x, y)| grid.locate(x, y, Outside::Error).unwrap())
            .to_vec();
        let weights = DMatrix::from_fn(cells.len(), grid.nodes(), |row, node| {
            let corner = cells[row].nodes().iter().position(|corner| *corner == node);
            corner.map_or(0.0, |k| coefficients(&initial, &cells[row])[k])
        });
        let expected = &weights * covariance * weights.transpose();
        let found = posterior.relative_covariances(&cells);
        for (row, cell) in cells.iter().enumerate() {
            assert!((posterior.relative_variance(cell) - expected[(row, row)]).abs() < 1e-12);
            for column in 0..cells.len() {
                assert!((found[row][column] - expected[(row, column)]).abs() < 1e-12);
            }
        }
    }
}

/// The mean after every flight by conditioning on covariances (nalgebra, dense), though the tables are made ready for the last
/// state alone; and a state that the guard must mend is as it is solved.
#[test]
fn tables_on_the_way_agree_with_dense_conditioning() {
    for (seed, grid) in [(1, even_grid()), (2, uneven_grid())] {
        let initial = polar(&grid);
        let mut random = Random(ChaCha8Rng::seed_from_u64(seed));
        let flights = flights(&mut random, &initial, 12, (0.01, 0.005), some_correction);
        let empty = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
        let mut last = empty.clone();
        let weights = weighted(&mut last, &flights);
        let tables = DragTables::new(&last).unwrap();
        let prior = dense_prior(&grid, last.settings()).try_inverse().unwrap();
        let mut state = empty;
        assert_eq!(tables.drag(&state).unwrap().values(), initial.values());
        for count in 1..=flights.len() {
            let flight = state.read(&flights[count - 1]);
            state.learn_weighted(&flight, &weights[count - 1]);
            let (rows, residuals, variance) =
                dense_observations(&state, &flights[..count], &weights[..count]);
            let of_residuals = &rows * &prior * rows.transpose() + variance;
            let mean = &prior * rows.transpose() * of_residuals.try_inverse().unwrap() * residuals;
            let drag = tables.drag(&state).unwrap();
            for (node, value) in drag.values().iter().enumerate() {
                let expected = initial.value_at_node(node) * (1.0 + mean[node]);
                assert!((value - expected).abs() < 1e-11, "{node}: {value}, {expected}");
            }
        }
    }
}

/// The evidence is the density of a multivariate normal: nalgebra's dense Cholesky of W·Q⁻¹·Wᵀ + V.
#[test]
fn evidence_is_a_dense_normal_density() {
    let grid = uneven_grid();
    let initial = polar(&grid);
    let mut random = Random(ChaCha8Rng::seed_from_u64(3));
    let flights = flights(&mut random, &initial, 9, (0.01, 0.005), some_correction);
    let settings = BayesSettings::physical_2026();
    let mut state = BayesState::new(&initial, settings).unwrap();
    let weights = weighted(&mut state, &flights);

    let prior = dense_prior(&grid, &settings).try_inverse().unwrap();
    let (rows, residuals, variance) = dense_observations(&state, &flights, &weights);
    let covariance = Cholesky::new(&rows * prior * rows.transpose() + variance).unwrap();
    let log_determinant: f64 =
        2.0 * covariance.l_dirty().diagonal().iter().map(|value| value.ln()).sum::<f64>();
    let square = residuals.dot(&covariance.solve(&residuals));
    let constant = residuals.len() as f64 * std::f64::consts::TAU.ln();
    let expected = -0.5 * (log_determinant + square + constant);

    let found = log_evidence(&initial, settings, &flights).unwrap();
    assert!((found - expected).abs() < 1e-8, "{found} {expected}");
}

/// −2 ln p of simple fields, from the formula by hand: each term alone, the others' sizes at their largest.
#[test]
fn prior_energies_are_the_integrals() {
    let loose = SettingValues {
        correction_std: 1.0,
        slope_std_per_lift_coefficient: 100.0,
        slope_std_per_mach: 100.0,
        bend_std_per_lift_coefficient_squared: 1e3,
        bend_std_per_lift_coefficient_mach: 1e3,
        bend_std_per_mach_squared: 1e3,
        ..*BayesSettings::physical_2026().values()
    };
    // Integrals over the grid's area: a level of one standard deviation has energy 1 whatever the area; slopes and
    // bends of one standard deviation have the area in patches of 0.3 × 0.1, the mixed bend twice that.
    let cases: [(SettingValues, Field, f64); 6] = [
        (SettingValues { correction_std: 0.01, ..loose }, |_, _| 0.01, 0.0),
        (SettingValues { slope_std_per_lift_coefficient: 0.01, ..loose }, |c, _| 0.01 * c, 1.0),
        (SettingValues { slope_std_per_mach: 0.01, ..loose }, |_, m| 0.01 * (m - 0.7), 1.0),
        (
            SettingValues { bend_std_per_lift_coefficient_squared: 0.01, ..loose },
            |c, _| 0.005 * (c - 0.4).powi(2),
            1.0,
        ),
        (
            SettingValues { bend_std_per_lift_coefficient_mach: 0.01, ..loose },
            |c, m| 0.01 * (c - 0.4) * (m - 0.7),
            2.0,
        ),
        (
            SettingValues { bend_std_per_mach_squared: 0.01, ..loose },
            |_, m| 0.005 * (m - 0.7).powi(2),
            1.0,
        ),
    ];
    for grid in [even_grid(), uneven_grid()] {
        let (x, y) = (grid.x(), grid.y());
        let patches = (x.last() - x.first()) * (y.last() - y.first()) / 0.03;
        for (values, field, share) in cases {
            let precision = dense_prior(&grid, &BayesSettings::new(values).unwrap());
            let value = |node| field(grid.coordinates(node).0, grid.coordinates(node).1);
            let field = DVector::from_fn(grid.nodes(), |node, _| value(node));
            let energy = field.dot(&(precision * &field));
            let expected = if share == 0.0 { 1.0 } else { share * patches };
            assert!((energy / expected - 1.0).abs() < 2e-5, "{energy} {expected}");
        }
    }
}

/// Weights are the fixed point of their equations, with expectations from a dense inverse.
#[test]
fn outlier_weights_are_the_fixed_point() {
    let grid = even_grid();
    let initial = polar(&grid);
    let settings = BayesSettings::physical_2026();
    let mut random = Random(ChaCha8Rng::seed_from_u64(4));
    let mut flights = flights(&mut random, &initial, 8, (0.01, 0.005), some_correction);
    flights.sort_by_key(Vec::len);
    let last = flights.pop().unwrap();
    let mut state = BayesState::new(&initial, settings).unwrap();
    let _ = weighted(&mut state, &flights);

    let mut flight = state.read(&last);
    assert!(flight.residuals.len() > 3, "{}", flight.residuals.len());
    flight.residuals[1].residual += 0.10; // gross error
    let flight_weights = state.expected_residual.weigh(
        &state.weight_settings,
        &flight.residuals,
        flight.common_variance,
    );

    // Unknowns: six coefficients in patches of 0.3 × 0.1 from the grid's middle (0.45, 0.725), and the common error.
    let terms = |case: &SegmentResidual| {
        let (u, v) = ((case.lift_coefficient - 0.45) / 0.3, (case.mach - 0.725) / 0.1);
        DVector::from_vec(vec![1.0, u, v, u * u, u * v, v * v, 1.0])
    };
    let stds: [f64; 6] = [0.1, 0.045, 0.025, 0.0675, 0.045, 0.01];
    // What a quadratic misses of the bends: a quarter of the quadratic terms.
    let common = flight.common_variance + (0.0675 * 0.0675 + 0.01 * 0.01) / 16.0;
    let mut matrix = DMatrix::zeros(7, 7);
    let mut vector = DVector::zeros(7);
    let mut entries = state.expected_residual.matrix.iter();
    for i in 0..6 {
        for j in 0..=i {
            let entry = *entries.next().unwrap();
            matrix[(i, j)] += entry;
            if i != j {
                matrix[(j, i)] += entry;
            }
        }
        matrix[(i, i)] += 1.0 / (stds[i] * stds[i]);
        vector[i] = state.expected_residual.vector[i];
    }
    matrix[(6, 6)] = flight_weights.flight_weight / common;
    for (case, weight) in flight.residuals.iter().zip(&flight_weights.weights) {
        let row = terms(case);
        matrix += &row * row.transpose() * (weight / case.variance);
        vector += row * (case.residual * weight / case.variance);
    }
    let covariance = matrix.try_inverse().unwrap();
    let mean = &covariance * vector;
    for (case, weight) in flight.residuals.iter().zip(&flight_weights.weights) {
        let row = terms(case);
        let error = case.residual - row.dot(&mean);
        let square = (error * error + row.dot(&(&covariance * &row))) / case.variance;
        let expected = 5.0 / (4.0 + square);
        assert!((weight / expected - 1.0).abs() < 0.06, "{weight} {expected}");
    }
    let expected = 5.0 / (4.0 + (mean[6] * mean[6] + covariance[(6, 6)]) / common);
    assert!((flight_weights.flight_weight / expected - 1.0).abs() < 0.06);
    // The outlier has the least weight by far.
    assert!(flight_weights.weights[1] < 0.1, "{:?}", flight_weights.weights);
    let others = flight_weights.weights.iter().enumerate().filter(|(k, _)| *k != 1);
    assert!(others.into_iter().all(|(_, weight)| *weight > 3.0 * flight_weights.weights[1]));
}

/// Of many points as of one, on grids with more of either variable; and the share of informed nodes by counting.
#[test]
fn variances_of_many_points_are_those_of_each() {
    for grid in [even_grid(), uneven_grid()] {
        let initial = polar(&grid);
        let mut random = Random(ChaCha8Rng::seed_from_u64(6));
        let learnt = flights(&mut random, &initial, 8, (0.004, 0.004), |_| 0.02);
        let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
        let _ = weighted(&mut state, &learnt);
        let posterior = state.solve().unwrap();
        let many = VarianceByCell::new(&posterior);
        for observation in learnt.iter().flatten() {
            let (cell, _) = located(&initial, observation).unwrap();
            let one = posterior.segment_variance(&cell, &SENSORS);
            let of_many = many.segment_variance(&cell, &SENSORS);
            assert!((of_many / one - 1.0).abs() < 1e-10, "{of_many} {one}");
        }
        let counts = posterior.observations();
        let informed = (0..counts.len()).filter(|node| counts[*node] >= 1.0).count();
        assert!(0 < informed && informed < counts.len());
        let share = informed as f64 / counts.len() as f64;
        assert!((posterior.informed_share() - share).abs() < 1e-15);
    }
}

/// Truth drawn from the prior, noise as in the settings: 95 % intervals of nodes and of unseen segments cover 92 to 98
/// %.
#[test]
fn intervals_cover_what_they_say() {
    let grid = even_grid();
    let initial = polar(&grid);
    let settings = BayesSettings::physical_2026();
    let values = settings.values();
    let noise = (
        (SENSORS.flight + values.extra_flight_std.powi(2)).sqrt(),
        (SENSORS.segment + values.extra_segment_std.powi(2)).sqrt(),
    );
    let root = Cholesky::new(dense_prior(&grid, &settings).try_inverse().unwrap()).unwrap().l();
    let mut random = Random(ChaCha8Rng::seed_from_u64(5));
    let (mut nodes_inside, mut nodes) = (0, 0);
    let (mut segments_inside, mut segments) = (0, 0);
    for _ in 0..60 {
        let draw = DVector::from_fn(grid.nodes(), |_, _| random.normal());
        let truth = &root * draw;
        let correction = |cell: &Cell| -> f64 {
            let weights = coefficients(&initial, cell);
            cell.nodes().iter().zip(weights).map(|(&node, weight)| weight * truth[node]).sum()
        };
        let learnt = flights(&mut random, &initial, 20, noise, correction);
        let unseen = flights(&mut random, &initial, 20, noise, correction);
        let mut state = BayesState::new(&initial, settings).unwrap();
        let _ = weighted(&mut state, &learnt);
        let posterior = state.solve().unwrap();
        for node in 0..grid.nodes() {
            let miss = (truth[node] - posterior.correction()[node]).abs();
            nodes_inside += usize::from(miss <= 1.96 * posterior.standard_deviation()[node]);
            nodes += 1;
        }
        for observation in unseen.iter().flatten() {
            let (cell, residual) = located(&initial, observation).unwrap();
            let std = posterior.segment_variance(&cell, &SENSORS).sqrt();
            let miss = (residual - posterior.correction_at(&cell)).abs();
            segments_inside += usize::from(miss <= 1.96 * std);
            segments += 1;
        }
    }
    let of_nodes = f64::from(u32::try_from(nodes_inside).unwrap()) / f64::from(nodes);
    let of_segments = f64::from(u32::try_from(segments_inside).unwrap()) / f64::from(segments);
    eprintln!("inside 95 %: nodes {of_nodes:.3}, unseen segments {of_segments:.3}");
    assert!((0.92..=0.98).contains(&of_nodes), "{of_nodes}");
    assert!((0.92..=0.98).contains(&of_segments), "{of_segments}");
}

/// Drawn tables have the covariance of the solution: with unit vectors for the random numbers, their outer products sum to
/// the inverse of the precision, whose columns are solved for on their own.
#[test]
fn drawn_tables_have_the_covariance_that_is_stated() {
    // So small that drag stays physical whatever is drawn.
    const SCALE: f64 = 1e-3;
    let grid = even_grid();
    let initial = polar(&grid);
    let posterior =
        BayesState::new(&initial, BayesSettings::physical_2026()).unwrap().solve().unwrap();
    let nodes = grid.nodes();
    let drawn = |unit: Option<usize>| {
        let mut numbers = vec![0.0; nodes];
        if let Some(unit) = unit {
            numbers[unit] = SCALE;
        }
        posterior.drawn(&numbers)
    };
    let mean = drawn(None);
    assert_eq!(mean.values(), posterior.drag().values());
    let deviations: Vec<Vec<f64>> = (0..nodes)
        .map(|unit| {
            let table = drawn(Some(unit));
            let deviation = |node: usize| {
                (table.value_at_node(node) - mean.value_at_node(node))
                    / (SCALE * initial.value_at_node(node))
            };
            (0..nodes).map(deviation).collect()
        })
        .collect();
    for one in [0, nodes / 2, nodes - 1] {
        let stated = posterior.covariances_with(one);
        for other in 0..nodes {
            let found: f64 = deviations.iter().map(|of| of[one] * of[other]).sum();
            let scale = posterior.standard_deviation()[one] * posterior.standard_deviation()[other];
            assert!((found - stated[other]).abs() < 1e-9 * scale, "{one} {other}: {found}");
        }
    }
}
