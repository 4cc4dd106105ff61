//! Law `paper` with refits over whole fleets, against tables that an independent implementation made.
//!
//! The two runs in `tests/golden` always run; all twelve run where the reference folder is present.
#![expect(clippy::disallowed_methods, reason = "the reference folder is not in every checkout")]
#![expect(clippy::unwrap_used, clippy::panic, clippy::print_stderr, reason = "a test")]
#![expect(clippy::float_cmp, reason = "numbers read from the same text")]

use std::fs::read_to_string;
use std::sync::Arc;

use adapt::paper::{PaperLaw, State, Update, error_percent};
use flight::{Observation, ObservationVariance, Timestamp};
use lut::surface::Basis;
use lut::{Axis, Grid, Outside, Table};
use refit::{RefitRule, refit};
use test_support::outside_data;
use units::convert::TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR;
use units::{PressureAltitude, Temperature, TrueAirspeed};

const WING_AREA_M2: f64 = 94.94690688;
const TSFC_STATIC_LB_LBF_H: f64 = 0.657;
/// The files carry 13 significant digits and a run multiplies a few dozen gains.
const TOLERANCE: f64 = 1e-10;

/// A CSV file with its header, cells as text.
struct Csv<'a> {
    header: Vec<&'a str>,
    rows: Vec<Vec<&'a str>>,
}

impl<'a> Csv<'a> {
    fn parse(text: &'a str) -> Self {
        let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        Self { header: lines.next().unwrap(), rows: lines.collect() }
    }

    fn text(&self, row: usize, name: &str) -> &'a str {
        let column = self.header.iter().position(|cell| *cell == name).unwrap();
        self.rows[row][column]
    }

    fn number(&self, row: usize, name: &str) -> f64 {
        self.text(row, name).parse().unwrap()
    }
}

struct FlightSegment {
    flight: String,
    observation: Observation,
    /// Against the initial wide table.
    error_percent: f64,
}

fn segments(text: &str) -> Vec<FlightSegment> {
    let csv = Csv::parse(text);
    (0..csv.rows.len())
        .map(|row| {
            let number = |name| csv.number(row, name);
            let altitude = PressureAltitude::meters(number("pressure_altitude_m"));
            let sat = Temperature::kelvin(number("static_air_temperature_k"));
            let tas = TrueAirspeed::meters_per_second(number("true_airspeed_m_s"));
            let density = atmos::isa::density(atmos::isa::pressure(altitude).unwrap(), sat);
            let tsfc_kg_n_s = TSFC_STATIC_LB_LBF_H
                * TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR
                * atmos::isa::temperature_ratio(sat).sqrt();
            let dynamic_pressure_pa =
                0.5 * density.to_kilograms_per_cubic_meter() * tas.to_meters_per_second().powi(2);
            FlightSegment {
                flight: csv.text(row, "flight").to_owned(),
                observation: Observation {
                    time: Timestamp::UNIX_EPOCH,
                    lift_coefficient: number("lift_coefficient"),
                    mach: number("mach"),
                    drag_coefficient: number("drag_coefficient"),
                    fuel_flow_total_kg_s: number("fuel_flow_kg_s"),
                    fuel_flow_per_drag_coefficient_kg_s: dynamic_pressure_pa
                        * WING_AREA_M2
                        * tsfc_kg_n_s,
                    variance: ObservationVariance { segment: 1e-4, flight: 1e-4 },
                },
                error_percent: number("error_percent"),
            }
        })
        .collect()
}

/// Tables of drag coefficient and confidence, and the grid made from the coordinates in the file.
fn state(text: &str) -> State {
    let csv = Csv::parse(text);
    let column =
        |name: &str| -> Vec<f64> { (0..csv.rows.len()).map(|row| csv.number(row, name)).collect() };
    let axis = |name: &str| {
        let mut values = column(name);
        values.sort_by(f64::total_cmp);
        values.dedup();
        Axis::new(values).unwrap()
    };
    let grid = Arc::new(Grid::new(axis("lift_coefficient"), axis("mach")));
    let table = |name: &str| Table::new(Arc::clone(&grid), column(name)).unwrap();
    let order_in_file = column("lift_coefficient").into_iter().zip(column("mach"));
    for (node, coordinates) in order_in_file.enumerate() {
        assert_eq!(grid.coordinates(node), coordinates);
    }
    State::from_tables(table("drag_coefficient"), table("confidence")).unwrap()
}

#[derive(Default)]
struct Counts {
    outside: usize,
    adapted: usize,
    refits: usize,
}

/// Adapts to all flights in file order, refitting after each.
fn learn(law: PaperLaw, state: &mut State, segments: &[FlightSegment]) -> Counts {
    let mut counts = Counts::default();
    for flight in segments.chunk_by(|a, b| a.flight == b.flight) {
        for segment in flight {
            match law.adapt(state, &segment.observation) {
                Update::OutsideGrid(_) => counts.outside += 1,
                Update::Adapted { .. } => counts.adapted += 1,
                Update::WithinDeadBand { .. } => {}
                unusable @ Update::Unusable { .. } => panic!("{unusable:?}"),
            }
        }
        let (mut drag_coefficient, mut confidence) = state.clone().into_tables();
        let report = refit(
            RefitRule::ghazi_2020(),
            Basis::SeparableQuadratic,
            &mut drag_coefficient,
            &mut confidence,
        )
        .unwrap();
        *state = State::from_tables(drag_coefficient, confidence).unwrap();
        counts.refits += usize::from(report.fit.is_some());
    }
    counts
}

/// Mean, standard deviation (n − 1) and largest magnitude of the error over the segments inside the grid.
fn statistics(state: &State, segments: &[FlightSegment]) -> [f64; 3] {
    let errors: Vec<f64> = segments
        .iter()
        .filter_map(|segment| {
            let point = &segment.observation;
            let cell = state.grid().locate(point.lift_coefficient, point.mach, Outside::Error);
            Some(error_percent(state.drag_coefficient(), &cell.ok()?, point))
        })
        .collect();
    let count = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / count;
    let squares: f64 = errors.iter().map(|error| (error - mean).powi(2)).sum();
    let largest = errors.iter().fold(0.0, |largest: f64, error| largest.max(error.abs()));
    [mean, (squares / (count - 1.0)).sqrt(), largest]
}

struct Run<'a> {
    fleet: &'a str,
    grid: &'a str,
    threshold: &'a str,
    segments: &'a str,
    initial: &'a str,
    expected: &'a str,
    summary: &'a str,
}

fn check(run: &Run<'_>) {
    let name = format!("{} {} {} %", run.fleet, run.grid, run.threshold);
    let segments = segments(run.segments);
    let mut state = state(run.initial);
    let expected = self::state(run.expected);
    let before = statistics(&state, &segments);
    let law = PaperLaw::new(run.threshold.parse().unwrap()).unwrap();
    let counts = learn(law, &mut state, &segments);

    let mut largest = 0.0_f64;
    for (ours, theirs) in [
        (state.drag_coefficient(), expected.drag_coefficient()),
        (state.confidence(), expected.confidence()),
    ] {
        for (ours, theirs) in ours.values().iter().zip(theirs.values()) {
            largest = largest.max((ours - theirs).abs());
        }
    }
    eprintln!("{name}: largest difference {largest:.1e}");
    assert!(largest < TOLERANCE, "{name}: tables differ by {largest}");

    let summary = Csv::parse(run.summary);
    let row = (0..summary.rows.len())
        .find(|&row| {
            summary.text(row, "fleet") == run.fleet
                && summary.text(row, "grid") == run.grid
                && summary.number(row, "threshold_percent") == law.threshold_percent()
        })
        .unwrap();
    let ours = [segments.len(), counts.outside, counts.adapted, counts.refits];
    let names = ["segments", "outside_table", "adapted_segments", "refits"];
    for (ours, column) in ours.into_iter().zip(names) {
        assert_eq!(ours.to_string(), summary.text(row, column), "{name}: {column}");
    }
    let figures = before.into_iter().chain(statistics(&state, &segments));
    let names = ["mean_before", "std_before", "max_before", "mean_after", "std_after", "max_after"];
    for (ours, column) in figures.zip(names) {
        let theirs = summary.number(row, column);
        assert!((ours - theirs).abs() < 1e-8, "{name}: {column} {ours} for {theirs}");
    }
}

#[test]
fn wide_grid_at_five_percent() {
    check(&Run {
        fleet: "SIM-01",
        grid: "wide",
        threshold: "5",
        segments: include_str!("golden/SIM-01_segments.csv"),
        initial: include_str!("golden/initial_wide_table.csv"),
        expected: include_str!("golden/SIM-01_wide_paper_5_table.csv"),
        summary: include_str!("golden/summary.csv"),
    });
}

#[test]
fn compact_grid_at_one_percent_with_refits() {
    check(&Run {
        fleet: "SIM-01",
        grid: "compact",
        threshold: "1",
        segments: include_str!("golden/SIM-01_segments.csv"),
        initial: include_str!("golden/initial_compact_table.csv"),
        expected: include_str!("golden/SIM-01_compact_paper_1_table.csv"),
        summary: include_str!("golden/summary.csv"),
    });
}

#[test]
fn every_reference_run() {
    let Some(golden) = outside_data("golden") else { return };
    let read = |name: &str| read_to_string(golden.join(name)).unwrap();
    for fleet in ["SIM-01", "SIM-02", "SIM-05"] {
        for grid in ["wide", "compact"] {
            for threshold in ["5", "1"] {
                check(&Run {
                    fleet,
                    grid,
                    threshold,
                    segments: &read(&format!("{fleet}_segments.csv")),
                    initial: &read(&format!("initial_{grid}_table.csv")),
                    expected: &read(&format!("{fleet}_{grid}_paper_{threshold}_table.csv")),
                    summary: &read("summary.csv"),
                });
            }
        }
    }
}

#[test]
fn errors_against_the_initial_table() {
    let wide = state(include_str!("golden/initial_wide_table.csv"));
    let segments = segments(include_str!("golden/SIM-01_segments.csv"));
    assert!(segments.len() > 50, "{}", segments.len());
    for segment in segments {
        let point = &segment.observation;
        let cell = wide.grid().locate(point.lift_coefficient, point.mach, Outside::Error).unwrap();
        let ours = error_percent(wide.drag_coefficient(), &cell, point);
        assert!((ours - segment.error_percent).abs() < 1e-9, "{ours} {}", segment.error_percent);
    }
}
