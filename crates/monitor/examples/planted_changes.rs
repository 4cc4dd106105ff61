//! Planted steps, ramps with washes and series in which nothing changes: what is found of them, and how often something is
//! found that is not there. Prints a table; with `--series` the series themselves, for another program to read.
//!
//! `cargo run --release -p cruisefit-monitor --example planted_changes -- [SEED [CASES]] [--series]`
#![expect(
    clippy::print_stdout,
    clippy::expect_used,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "an example shows its result and stops where it has none; its numbers are small"
)]

use flight::Timestamp;
use monitor::{ChangeBeliefs, FlightDeviation, History, Series};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal, StudentT};

/// Standard deviations of a flight's mean, %.
const NOISES: [f64; 3] = [0.3, 0.5, 0.7];
const FLIGHTS: usize = 300;
/// A step counts as found where a change is reported at most this many flights from it.
const NEAR: usize = 3;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Nothing,
    HeavyTails,
    Correlated,
    Step,
    StepHeavyTails,
    Ramp,
}

const KINDS: [(Kind, &str); 6] = [
    (Kind::Nothing, "nothing"),
    (Kind::HeavyTails, "nothing, Student t4"),
    (Kind::Correlated, "nothing, correlation 0.3"),
    (Kind::Step, "step of 1 %"),
    (Kind::StepHeavyTails, "step of 1 %, Student t4"),
    (Kind::Ramp, "1.2 %/year, washes -0.9 %"),
];

struct Case {
    deviations: Vec<f64>,
    truth: Vec<f64>,
    steps: Vec<usize>,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut numbers = arguments.iter().filter_map(|argument| argument.parse::<u64>().ok());
    let seed = numbers.next().unwrap_or(1);
    let cases = numbers.next().unwrap_or(20);
    let print_series = arguments.iter().any(|argument| argument == "--series");
    let mut steps_found = 0.0;
    if print_series {
        println!("kind,noise_percent,case,steps,found,deviations_percent");
    } else {
        println!("{:26} noise  found within {NEAR}  false per 300  level rms  95th", "planted");
    }
    for (place, (kind, name)) in KINDS.into_iter().enumerate() {
        for noise in NOISES {
            let mut score = Score::default();
            for case in 0..cases {
                let stream = 1000 * (place as u64 + 10 * (noise * 10.0) as u64) + case;
                let mut random = ChaCha8Rng::seed_from_u64(seed);
                random.set_stream(stream);
                let drawn = draw(kind, noise, &mut random);
                let found = score.add(&drawn);
                if print_series {
                    println!(
                        "{name:?},{noise},{case},{},{},{}",
                        join(&drawn.steps),
                        join(&found),
                        join(&drawn.deviations)
                    );
                }
            }
            if !print_series {
                println!("{name:26} {noise:4.1}   {}", score.row());
            }
            if kind == Kind::Step && noise < 0.4 {
                steps_found = score.found / score.planted;
            }
        }
    }
    assert!(steps_found > 0.8, "{steps_found} of the clearest steps were found");
}

fn draw(kind: Kind, noise: f64, random: &mut ChaCha8Rng) -> Case {
    let heavy = StudentT::new(4.0).expect("four degrees of freedom are valid");
    let flights = if kind == Kind::Ramp { 3 * FLIGHTS } else { FLIGHTS };
    let mut steps = Vec::new();
    match kind {
        Kind::Step | Kind::StepHeavyTails => steps.push(random.random_range(30..flights - 30)),
        // A wash every half year, give or take a month.
        Kind::Ramp => {
            let mut next = random.random_range(60..180);
            while next + 10 < flights {
                steps.push(next);
                next += random.random_range(120..180);
            }
        }
        _ => {}
    }
    let size = match kind {
        Kind::Ramp => -0.9,
        _ if random.random_bool(0.5) => 1.0,
        _ => -1.0,
    };
    let (mut before, mut deviations, mut truth) = (0.0, Vec::new(), Vec::new());
    for flight in 0..flights {
        let slope = if kind == Kind::Ramp { 1.2 * flight as f64 / 300.0 } else { 0.0 };
        let passed = steps.iter().filter(|step| **step <= flight).count() as f64;
        let normal: f64 = StandardNormal.sample(random);
        let error = match kind {
            // Scaled to a standard deviation of 1.
            Kind::HeavyTails | Kind::StepHeavyTails => heavy.sample(random) / 2.0_f64.sqrt(),
            Kind::Correlated => {
                before = 0.3 * before + (1.0_f64 - 0.09).sqrt() * normal;
                before
            }
            _ => normal,
        };
        truth.push(2.0 + slope + size * passed);
        deviations.push(truth[flight] + noise * error);
    }
    Case { deviations, truth, steps }
}

#[derive(Default)]
struct Score {
    flights: f64,
    planted: f64,
    found: f64,
    wrong: f64,
    errors: Vec<f64>,
}

impl Score {
    /// Scores a case; returns the first flights after each change that was reported.
    fn add(&mut self, case: &Case) -> Vec<usize> {
        // Flights a year: 300. A flight has one segment here: all its noise is the flight's.
        let flights = case.deviations.iter().enumerate().map(|(flight, deviation)| {
            let second = (flight as f64 * 365.25 * 86_400.0 / 300.0) as i64;
            let time = Timestamp::from_second(second).expect("within three years of 1970");
            FlightDeviation::of_segments(time, &[*deviation]).expect("a finite deviation")
        });
        let series = Series::new(flights.collect()).expect("flights in order");
        let history =
            History::fit(&series, &[], &ChangeBeliefs::of_2026()).expect("there are flights");
        let found: Vec<usize> = history.changes.iter().map(|change| change.first_flight).collect();
        let near = |one: &usize, others: &[usize], reach: usize| {
            others.iter().any(|other| one.abs_diff(*other) <= reach)
        };
        self.flights += case.deviations.len() as f64;
        self.planted += case.steps.len() as f64;
        self.found += case.steps.iter().filter(|step| near(step, &found, NEAR)).count() as f64;
        // A change far from any step is false; one that is only off by a few more flights is not counted twice.
        self.wrong += found.iter().filter(|flight| !near(flight, &case.steps, 30)).count() as f64;
        for (flight, truth) in case.truth.iter().enumerate() {
            let years = series.years(series.flights()[flight].time());
            self.errors.push(history.levels.level_percent(flight, years).value - truth);
        }
        found
    }

    fn row(&mut self) -> String {
        let rms =
            (self.errors.iter().map(|e| e * e).sum::<f64>() / self.errors.len() as f64).sqrt();
        self.errors.sort_by(|one, other| one.abs().total_cmp(&other.abs()));
        let worst = self.errors[self.errors.len() * 95 / 100].abs();
        let share = if self.planted > 0.0 {
            format!("{:10.3}", self.found / self.planted)
        } else {
            format!("{:>10}", "-")
        };
        let false_ones = self.wrong / self.flights * 300.0;
        format!("{share}      {false_ones:10.3}  {rms:9.3}  {worst:5.3}")
    }
}

fn join<T: ToString>(values: &[T]) -> String {
    values.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}
