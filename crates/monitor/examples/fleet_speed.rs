//! 500 tails of 1,000 flights, each read as a whole: how long that takes, and how much memory (on Linux).
//!
//! `cargo run --release -p cruisefit-monitor --example fleet_speed -- [TAILS [FLIGHTS]]`
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    clippy::expect_used,
    clippy::cast_possible_wrap,
    reason = "measures time and memory, shows them, and stops where it cannot"
)]

use std::time::Instant;

use flight::Timestamp;
use monitor::{ChangeBeliefs, Estimate, FlightDeviation, History, Series, fleet_mean, months};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|argument| argument.parse().ok());
    let tails: usize = numbers.next().unwrap_or(500);
    let flights: usize = numbers.next().unwrap_or(1000);
    let mut random = ChaCha8Rng::seed_from_u64(16);
    let fleet: Vec<Series> = (0..tails).map(|_| draw(flights, &mut random)).collect();
    let begun = Instant::now();
    // Two threads, as the command line would use on two processors; each takes every other tail.
    let read = |first: usize| -> Vec<(Estimate, usize, usize)> {
        let beliefs = ChangeBeliefs::of_2026();
        let own = fleet.iter().skip(first).step_by(2);
        own.map(|series| {
            let history = History::fit(series, &[], &beliefs).expect("there are flights");
            let level = history.levels.last_level_percent(series);
            let means = months(series).into_iter();
            let means = means.filter_map(|(_, flights)| history.mean_percent(series, flights));
            (level, history.changes.len(), means.count())
        })
        .collect()
    };
    let (mut found, more) = std::thread::scope(|scope| {
        let other = scope.spawn(|| read(1));
        (read(0), other.join().expect("the other half is read"))
    });
    found.extend(more);
    let levels: Vec<Estimate> = found.iter().map(|(level, ..)| *level).collect();
    let mean = fleet_mean(&levels).expect("there are tails");
    println!(
        "{tails} tails of {flights} flights: {:.2} s; {} changes, {} months, fleet mean {:+.3} ± {:.3} %; {}",
        begun.elapsed().as_secs_f64(),
        found.iter().map(|(_, changes, _)| changes).sum::<usize>(),
        found.iter().map(|(.., months)| months).sum::<usize>(),
        mean.mean.value,
        mean.mean.half_width95(),
        memory()
    );
    assert_eq!(found.len(), tails);
}

/// Two flights a day with 0.5 % of noise, 1 % a year, and a step of 1 % about twice a year.
fn draw(flights: usize, random: &mut ChaCha8Rng) -> Series {
    let mut level: f64 = StandardNormal.sample(random);
    let drawn = (0..flights).map(|flight| {
        if random.random_bool(1.0 / 365.0) {
            level += if random.random_bool(0.5) { 1.0 } else { -1.0 };
        }
        let noise: f64 = StandardNormal.sample(random);
        let trend = flight as f64 / 730.0;
        let time = Timestamp::from_second(43_200 * flight as i64).expect("a few years");
        FlightDeviation::of_segments(time, &[level + trend + 0.5 * noise]).expect("finite")
    });
    Series::new(drawn.collect()).expect("flights in order")
}

/// The largest memory that this process has used, as Linux has it.
fn memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM"));
    line.map_or_else(|| "memory not known".to_owned(), str::to_owned)
}
