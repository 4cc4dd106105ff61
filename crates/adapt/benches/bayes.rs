//! Law `bayes`: learning 2,000 flights (and law `paper` on the same segments, for comparison), and one solve.
//!
//! | group | measures |
//! |---|---|
//! | `learn` | a fleet of 2,000 flights of 6 segments, time per segment; grid 15 × 10 |
//! | `solve` | correction, standard deviations and guard for 150, 600 and 2,400 nodes, after 200 flights |
//!
//! Compare figures within one run only.
#![expect(clippy::unwrap_used, reason = "a benchmark")]

use std::hint::black_box;
use std::sync::Arc;

use adapt::bayes::{BayesSettings, BayesState};
use adapt::paper::{PaperLaw, State};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use flight::{Observation, ObservationVariance, Timestamp};
use lut::{Axis, Grid, Table};

const FLIGHTS: usize = 2000;
const SEGMENTS: usize = 6;

/// A reproducible sequence in 0 … 1 (the generator of Knuth's MMIX, upper 53 bits).
struct Sequence(u64);

impl Sequence {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// CL 0.10…0.80 × M 0.50…0.95 with so many nodes.
fn initial(lift_coefficients: u32, machs: u32) -> Table {
    let axis = |from: f64, to: f64, count: u32| {
        let place = |i| from + (to - from) * f64::from(i) / f64::from(count - 1);
        Axis::new((0..count).map(place).collect()).unwrap()
    };
    let grid = Grid::new(axis(0.10, 0.80, lift_coefficients), axis(0.50, 0.95, machs));
    let drag = |node| 0.02 + 0.05 * grid.coordinates(node).0.powi(2);
    let values = (0..grid.nodes()).map(drag).collect();
    Table::new(Arc::new(grid), values).unwrap()
}

/// Flights in the usual cruise region, 7 % ± 1 % above the table, so that law `paper` always acts.
fn fleet(flights: usize) -> Vec<Vec<Observation>> {
    let mut random = Sequence(1);
    let mut flight = |day: i64| {
        let (first, mach) = (0.30 + 0.18 * random.next(), 0.78 + 0.08 * random.next());
        let segment = |k: usize| {
            let lift_coefficient = first - 0.005 * k as f64;
            let drag = (0.02 + 0.05 * lift_coefficient.powi(2)) * (1.06 + 0.02 * random.next());
            Observation {
                time: Timestamp::from_second(86_400 * day).unwrap(),
                lift_coefficient,
                mach: mach + 0.002 * random.next(),
                drag_coefficient: drag,
                fuel_flow_total_kg_s: 10.0 * drag,
                fuel_flow_per_drag_coefficient_kg_s: 10.0,
                variance: ObservationVariance { segment: 2.5e-5, flight: 2e-5 },
            }
        };
        (0..SEGMENTS).map(segment).collect()
    };
    (0..).take(flights).map(&mut flight).collect()
}

fn learn(criterion: &mut Criterion) {
    let initial = initial(15, 10);
    let flights = fleet(FLIGHTS);
    let mut group = criterion.benchmark_group("learn");
    group.throughput(Throughput::Elements((FLIGHTS * SEGMENTS) as u64));
    group.bench_function("bayes", |bencher| {
        bencher.iter(|| {
            let settings = BayesSettings::physical_2026();
            let mut state = BayesState::new(&initial, settings).unwrap();
            for flight in &flights {
                let _ = black_box(state.learn_flight(flight));
            }
            state
        });
    });
    group.bench_function("paper", |bencher| {
        let law = PaperLaw::new(1.0).unwrap();
        bencher.iter(|| {
            let mut state = State::new(initial.clone());
            for observation in flights.iter().flatten() {
                let _ = black_box(law.adapt(&mut state, observation));
            }
            state
        });
    });
    group.finish();
}

fn solve(criterion: &mut Criterion) {
    let flights = fleet(200);
    let mut group = criterion.benchmark_group("solve");
    for (lift_coefficients, machs) in [(15, 10), (30, 20), (60, 40)] {
        let initial = initial(lift_coefficients, machs);
        let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
        for flight in &flights {
            let _ = state.learn_flight(flight);
        }
        let id = BenchmarkId::from_parameter(lift_coefficients * machs);
        group.bench_function(id, |bencher| bencher.iter(|| state.solve().unwrap()));
    }
    group.finish();
}

criterion_group!(benches, learn, solve);
criterion_main!(benches);
