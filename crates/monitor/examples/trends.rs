//! Wear, washes and steps in two years, and how often the stated 95 % interval of the trend holds the wear. Prints a table.
//!
//! `cargo run --release -p cruisefit-monitor --example trends -- [SEED [CASES]]`
#![expect(
    clippy::print_stdout,
    clippy::expect_used,
    clippy::cast_possible_truncation,
    reason = "an example shows its result and stops where it has none; its numbers are small"
)]

use flight::Timestamp;
use monitor::{Bearing, ChangeBeliefs, FlightDeviation, History, KnownSteps, Series};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

const DAYS: f64 = 730.0;
const DAYS_PER_YEAR: f64 = 365.25;
/// Standard deviation from flight to flight, and of a segment within its flight, %.
const NOISE: [f64; 2] = [0.6, 0.4];
const SEGMENTS: usize = 8;

/// What happened to a tail.
struct Life {
    name: &'static str,
    wear_percent_per_year: f64,
    /// Day and size, %.
    steps: Vec<(f64, f64)>,
    listed: Listed,
    /// Between these days no flight was flown.
    gap: Option<(f64, f64)>,
}

/// Which days the list of events has.
enum Listed {
    None,
    /// Those of the steps, as washes.
    Washes,
    /// So many others, evenly, on which nothing happened.
    Nothing(usize),
}

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|argument| argument.parse::<u64>().ok());
    let (seed, cases) = (numbers.next().unwrap_or(1), numbers.next().unwrap_or(100));
    println!("{:42} {:>18} {:>18}", "", "60 flights", "300 flights");
    println!("{:42} {:>9} {:>8} {:>9} {:>8}", "", "held", "± mean", "held", "± mean");
    for (place, life) in lives().iter().enumerate() {
        let [few, many] = [60, 300].map(|flights| life.measure(flights, (seed, cases)));
        println!("{:42} {:9.3} {:8.2} {:9.3} {:8.2}", life.name, few.0, few.1, many.0, many.1);
        // The first two lives have no step: a trend that is not held then is none of the method's limits.
        assert!(place > 1 || few.0.min(many.0) > 0.85, "{}", life.name);
    }
}

fn lives() -> Vec<Life> {
    let evenly = |count: usize, size: f64| -> Vec<(f64, f64)> {
        (1..=count).map(|k| (DAYS * k as f64 / (count as f64 + 1.0), size)).collect()
    };
    let life = |name, wear_percent_per_year, steps, listed| Life {
        name,
        wear_percent_per_year,
        steps,
        listed,
        gap: None,
    };
    vec![
        life("nothing", 0.0, vec![], Listed::None),
        life("1.2 %/year", 1.2, vec![], Listed::None),
        life("2 %/year, 3 washes of -0.8 %, listed", 2.0, evenly(3, -0.8), Listed::Washes),
        life("2 %/year, 7 washes of -0.45 %, listed", 2.0, evenly(7, -0.45), Listed::Washes),
        life("1.2 %/year, 2 washes of -0.7 %, listed", 1.2, evenly(2, -0.7), Listed::Washes),
        life("1.2 %/year, 1 wash of -1 %, listed", 1.2, evenly(1, -1.0), Listed::Washes),
        life("1.2 %/year, 3 other events, no effect", 1.2, vec![], Listed::Nothing(3)),
        life("1.2 %/year, 24 other events, no effect", 1.2, vec![], Listed::Nothing(24)),
        life("step of 0.6 %, not listed", 0.0, vec![(402.0, 0.6)], Listed::None),
        life("step of 1 %, not listed", 0.0, vec![(402.0, 1.0)], Listed::None),
        life("step of 2 %, not listed", 0.0, vec![(402.0, 2.0)], Listed::None),
        Life {
            gap: Some((330.0, 470.0)),
            ..life("step of 1.5 % in a gap of 140 days", 0.0, vec![(402.0, 1.5)], Listed::None)
        },
        life("1.2 %/year, 1 wash of -1 %, not listed", 1.2, vec![(365.0, -1.0)], Listed::None),
        life("1.2 %/year, 2 washes of -0.6 %, not listed", 1.2, evenly(2, -0.6), Listed::None),
    ]
}

impl Life {
    /// Share of stated trends whose interval holds the wear, and mean of the intervals' half widths, % a year.
    fn measure(&self, flights: usize, (seed, cases): (u64, u64)) -> (f64, f64) {
        let (mut stated, mut held, mut widths) = (0.0, 0.0, 0.0);
        for case in 0..cases {
            let random = ChaCha8Rng::seed_from_u64(seed * 1_000_003 + case);
            let series = self.fly(flights, random);
            let found = self.read(&series);
            if let Some(trend) = found.levels.measured_trend_percent_per_year() {
                let error = (trend.value - self.wear_percent_per_year).abs();
                stated += 1.0;
                held += f64::from(u8::from(error <= trend.half_width95()));
                widths += trend.half_width95();
            }
        }
        (held / f64::max(stated, 1.0), widths / f64::max(stated, 1.0))
    }

    fn fly(&self, flights: usize, mut random: ChaCha8Rng) -> Series {
        let mut normal = move || -> f64 { StandardNormal.sample(&mut random) };
        let (from, until) = self.gap.unwrap_or((DAYS, DAYS));
        let flown = (0..flights).map(|k| {
            let day = (DAYS - (until - from)) * (k as f64 + 0.5) / flights as f64;
            let day = if day < from { day } else { day + until - from };
            let stepped = self.steps.iter().filter(|(at, _)| *at <= day);
            let level = self.wear_percent_per_year * day / DAYS_PER_YEAR
                + stepped.map(|(_, size)| size).sum::<f64>()
                + NOISE[0] * normal();
            let segments: Vec<f64> = (0..SEGMENTS).map(|_| level + NOISE[1] * normal()).collect();
            FlightDeviation::of_segments(instant(day), &segments).expect("finite numbers")
        });
        Series::new(flown.collect()).expect("in order")
    }

    fn read(&self, series: &Series) -> History {
        let days: Vec<f64> = match self.listed {
            Listed::None => vec![],
            Listed::Washes => self.steps.iter().map(|(day, _)| *day).collect(),
            Listed::Nothing(count) => {
                (1..=count).map(|k| DAYS * k as f64 / (count as f64 + 1.0)).collect()
            }
        };
        let events: Vec<(Timestamp, Bearing)> =
            days.iter().map(|day| (instant(*day), Bearing::Possible)).collect();
        let to_burn_less = match self.listed {
            Listed::Washes => events.iter().map(|(time, _)| *time).collect(),
            _ => vec![],
        };
        let steps = KnownSteps { to_burn_less, ..KnownSteps::default() };
        History::fit_with_steps(series, &events, &steps, &ChangeBeliefs::of_2026())
            .expect("a series with flights")
    }
}

fn instant(day: f64) -> Timestamp {
    Timestamp::from_second((86_400.0 * day) as i64).expect("within two years")
}
