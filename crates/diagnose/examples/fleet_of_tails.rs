//! 500 tails of 1,000 flights compared with each other: how long it takes to reduce a tail, how long the comparison of all
//! takes then, and how much memory (on Linux).
//!
//! `cargo run --release -p cruisefit-diagnose --example fleet_of_tails -- [TAILS [FLIGHTS]]`
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "measures time and memory, and shows them"
)]

use std::error::Error;
use std::time::{Duration, Instant};

use diagnose::{FleetFrame, FleetTail, FlightRecord, Input, ModelOf, Options, diagnose_fleet};
use flight::Segment;
use flight::effect::EffectId;
use test_support::Random;
use test_support::fleet::{Background, Setup, exact_model, fly, plant};

/// Tails from whose first flights the frame is made.
const FRAME_TAILS: u64 = 8;

fn main() -> Result<(), Box<dyn Error>> {
    let mut numbers = std::env::args().skip(1).filter_map(|argument| argument.parse().ok());
    let (tails, flights) = (numbers.next().unwrap_or(40), numbers.next().unwrap_or(12));
    let model = exact_model();
    let first: Vec<Vec<Segment>> = (0..FRAME_TAILS).flat_map(|tail| flown(tail, 12)).collect();
    let records = records(&first);
    let options = Options::default();
    let frame = FleetFrame::new(Input::against(&model, &records), &options, ModelOf::Type)?;

    let (mut reduced, mut reducing) = (Vec::new(), Duration::ZERO);
    for tail in 0..tails {
        let own = flown(tail, usize::try_from(flights)?);
        let begun = Instant::now();
        reduced.extend(frame.tail(&self::records(&own)));
        reducing += begun.elapsed();
    }
    let before = memory();
    let begun = Instant::now();
    let mut grams: Vec<&mut FleetTail> = reduced.iter_mut().collect();
    let found = diagnose_fleet(&mut grams)?;
    println!(
        "{tails} tails of {flights} flights: {:.3} s a tail to reduce it ({before}), {:.1} s to compare all ({}); {} findings",
        reducing.as_secs_f64() / reduced.len() as f64,
        begun.elapsed().as_secs_f64(),
        memory(),
        found.findings.len(),
    );
    assert_eq!(reduced.len() as u64, tails);
    Ok(())
}

/// A tail's flights of six segments; more drag on all, a probe that is off on every tenth.
fn flown(tail: u64, flights: usize) -> Vec<Vec<Segment>> {
    let mut random = Random::new(tail, 7);
    let mut planted = vec![plant(EffectId::WaveDrag, 1.0, &mut Random::new(7, 7))];
    if tail.is_multiple_of(10) {
        planted.push(plant(EffectId::MachBias, 1.0, &mut random));
    }
    let setup = Setup { flights, segments: 6, ..Setup::default() };
    fly(tail, &setup, &planted, &Background::default()).flights
}

fn records(flights: &[Vec<Segment>]) -> Vec<FlightRecord<'_>> {
    flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect()
}

/// The most memory held so far; empty where the system does not tell.
fn memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM"));
    line.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).unwrap_or_default()
}
