//! Fleets for the tests: segments of golden files, and virtual flights with known truth.

use std::sync::Arc;

use adapt::bayes::{BayesSettings, BayesState, Posterior};
use flight::{Observation, ObservationVariance, Timestamp};
use lut::{Axis, Grid, Outside, Table};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

/// The propagated errors of sensors as in the aircraft files: fuel flow of two engines 0.5 %/√2, Mach number 0.001,
/// acceleration; loading 0.3 % and heating value 0.3 %.
pub(crate) const SENSORS: ObservationVariance =
    ObservationVariance { segment: 0.005 * 0.005, flight: 0.0045 * 0.0045 };

pub(crate) type Flights = Vec<Vec<Observation>>;

/// Mean and standard deviation (n − 1).
pub(crate) fn mean_and_std(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / (n - 1.0)).sqrt())
}

pub(crate) fn learnt(
    initial: &Table,
    settings: BayesSettings,
    flights: &[Vec<Observation>],
) -> BayesState {
    let mut state = BayesState::new(initial, settings).unwrap();
    for flight in flights {
        let _ = state.learn_flight(flight);
    }
    state
}

pub(crate) fn solved(initial: &Table, flights: &[Vec<Observation>]) -> Posterior {
    learnt(initial, BayesSettings::physical_2026(), flights).solve().unwrap()
}

/// Fuel-flow errors of a table over flights, %.
pub(crate) fn errors_percent(drag: &Table, flights: &[Vec<Observation>]) -> Vec<f64> {
    flights
        .iter()
        .flatten()
        .filter_map(|observation| {
            let at = (observation.lift_coefficient, observation.mach);
            let cell = drag.grid().locate(at.0, at.1, Outside::Error).ok()?;
            Some(adapt::paper::error_percent(drag, &cell, observation))
        })
        .collect()
}

pub(crate) fn grid(step: f64, mach_end: f64) -> Arc<Grid> {
    let lift_coefficient = Axis::from_step(0.10, 0.80, step).unwrap();
    Arc::new(Grid::new(lift_coefficient, Axis::from_step(0.50, mach_end, step).unwrap()))
}

pub(crate) fn table(grid: &Arc<Grid>, value: impl Fn(f64, f64) -> f64) -> Table {
    let at = |node| {
        let (lift_coefficient, mach) = grid.coordinates(node);
        value(lift_coefficient, mach)
    };
    Table::new(Arc::clone(grid), (0..grid.nodes()).map(at).collect()).unwrap()
}

/// A jet's drag: parabola and drag rise, as the model has it.
pub(crate) fn believed_drag(lift_coefficient: f64, mach: f64) -> f64 {
    drag(lift_coefficient, mach, BELIEVED)
}

const BELIEVED: [f64; 3] = [0.0180, 0.0500, 0.860];

/// Zero-lift drag, induced factor, drag-divergence Mach number at CL 0.35; drag rise after Lock, as a fourth power.
fn drag(lift_coefficient: f64, mach: f64, [zero_lift, induced, divergence]: [f64; 3]) -> f64 {
    let divergence = divergence - 0.085 * (lift_coefficient - 0.35);
    let rise = 20.0 * (mach - divergence + 0.1077).max(0.0).powi(4);
    zero_lift + induced * lift_coefficient * lift_coefficient + rise
}

/// A truth whose parameters differ from the table's. It has the table's own chords (up to 2 % of drag at 0.05 Mach
/// number and the drag-divergence Mach number), so that they are not part of what a test measures.
pub(crate) fn off_by(
    table: &Table,
    parameters: [f64; 3],
    factor: f64,
) -> impl Fn(f64, f64) -> f64 + '_ {
    move |lift_coefficient, mach| {
        let cell = table.grid().locate(lift_coefficient, mach, Outside::Error).unwrap();
        let ratio =
            drag(lift_coefficient, mach, parameters) / believed_drag(lift_coefficient, mach);
        table.interpolate(&cell) * factor * ratio
    }
}

/// A truth that is the table times a factor.
pub(crate) fn times(table: &Table, factor: f64) -> impl Fn(f64, f64) -> f64 + '_ {
    off_by(table, BELIEVED, factor)
}

/// Errors of virtual flights, as standard deviations relative to drag.
#[derive(Clone, Copy)]
pub(crate) struct Noise {
    pub(crate) segment: f64,
    pub(crate) flight: f64,
}

/// Noise as stated for the sensors, and nothing else.
pub(crate) const SENSOR_NOISE: Noise = Noise { segment: 0.005, flight: 0.0045 };

/// A virtual fleet: flights of 2 to 11 segments at one or two Mach numbers, burning fuel as they go.
pub(crate) struct Fleet {
    random: ChaCha8Rng,
    day: i64,
}

impl Fleet {
    pub(crate) fn new(seed: u64) -> Self {
        Self { random: ChaCha8Rng::seed_from_u64(seed), day: 0 }
    }

    pub(crate) fn flights(
        &mut self,
        count: usize,
        noise: Noise,
        truth: impl Fn(f64, f64) -> f64,
    ) -> Flights {
        (0..count).map(|_| self.flight(noise, &truth)).collect()
    }

    fn flight(&mut self, noise: Noise, truth: impl Fn(f64, f64) -> f64) -> Vec<Observation> {
        self.day += 1;
        let segments = 2 + self.whole(10);
        let first = 0.27 + 0.19 * self.uniform();
        let mut mach = 0.78 + 0.01 * f64::from(self.whole(9));
        let step = if self.uniform() < 0.3 { 0.02 } else { 0.0 };
        let common = noise.flight * self.normal();
        (0..segments)
            .map(|k| {
                if k == segments / 2 {
                    mach += step;
                }
                let lift_coefficient = first - 0.004 * f64::from(k) + 0.002 * self.normal();
                let mach = mach + 0.0007 * self.normal();
                let error = common + noise.segment * self.normal();
                let drag_coefficient = truth(lift_coefficient, mach) * (1.0 + error);
                Observation {
                    time: Timestamp::from_second(self.day * 86_400 + 900 * i64::from(k)).unwrap(),
                    lift_coefficient,
                    mach,
                    drag_coefficient,
                    // Unaccelerated: fuel flow is proportional to drag.
                    fuel_flow_total_kg_s: 12.0 * drag_coefficient,
                    fuel_flow_per_drag_coefficient_kg_s: 12.0,
                    variance: SENSORS,
                }
            })
            .collect()
    }

    pub(crate) fn uniform(&mut self) -> f64 {
        (self.random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.random)
    }

    fn whole(&mut self, below: u32) -> u32 {
        self.random.next_u32() % below
    }
}
