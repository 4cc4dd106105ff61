//! The hot kernels of the chain, each once, for `.ci/counts.py`, which counts their instructions: `counts [KERNEL]`.
//!
//! What [`counted`] runs is counted; what prepares it is not.
#![expect(clippy::print_stdout, reason = "names what it has run")]

use std::error::Error;
use std::hint::black_box;

use adapt::bayes::{BayesSettings, BayesState};
use diagnose::{FlightRecord, Input, Options, diagnose};
use flight::Observation;
use flight::effect::EffectId;
use lut::Table;
use perf_model::{Aircraft, Guide, LevelFlights, PerformanceModel, initial_model};
use pipeline::reduction::ReducedFlight;
use segmenter::TrimCriteria;
use test_support::fleet::{Background, Setup, exact_model, fly, plant};
use test_support::{Random, looked_up};

type Outcome = Result<(), Box<dyn Error>>;
type Kernel = fn() -> Outcome;

const AIRCRAFT: &str = include_str!("../../../fixtures/global5000/AIRCRAFT.ron");
const GUIDE: &[u8] = include_bytes!("../../../fixtures/global5000/guide.csv");
/// In the order of flying.
const REPORTS: [&[u8]; 5] = [
    include_bytes!("../../../fixtures/global5000/reports/0001.txt"),
    include_bytes!("../../../fixtures/global5000/reports/0002.txt"),
    include_bytes!("../../../fixtures/global5000/reports/0003.txt"),
    include_bytes!("../../../fixtures/global5000/reports/0004.txt"),
    include_bytes!("../../../fixtures/global5000/reports/0005.txt"),
];

const KERNELS: [(&str, Kernel); 7] = [
    ("table_lookup", table_lookup),
    ("read_report", read_report),
    ("segment_statistics", segment_statistics),
    ("learn_flight", learn_flight),
    ("solve_table", solve_table),
    ("predict_points", predict_points),
    ("diagnose_fleet", diagnose_fleet),
];

fn main() -> Outcome {
    let asked = std::env::args().nth(1);
    let mut ran = 0;
    for (name, kernel) in KERNELS {
        if asked.as_deref().is_none_or(|asked| asked == name) {
            kernel()?;
            println!("{name}");
            ran += 1;
        }
    }
    assert_eq!(ran, if asked.is_some() { 1 } else { KERNELS.len() }, "{asked:?}");
    Ok(())
}

/// The function whose instructions, with all that it calls, are counted.
#[inline(never)]
fn counted(work: &mut dyn FnMut()) {
    black_box(work)();
}

/// Ten thousand points, most of them inside.
fn table_lookup() -> Outcome {
    let model = global5000()?;
    let table: &Table = model.drag_table();
    let mut random = Random::new(1, 1);
    let points: Vec<(f64, f64)> =
        (0..10_000).map(|_| (random.uniform(0.1, 0.8), random.uniform(0.5, 0.96))).collect();
    let (mut sum, mut inside) = (0.0, 0);
    counted(&mut || (sum, inside) = looked_up(table, &points));
    assert!(inside > 9_000 && sum / inside as f64 > 0.01);
    Ok(())
}

/// A report of 121 samples.
fn read_report() -> Outcome {
    let mut read = None;
    counted(&mut || read = Some(report::Reader::new().read(REPORTS[0])));
    assert!(read.ok_or("not run")??.report.len() > 100);
    Ok(())
}

/// The steady pieces of that report and their means.
fn segment_statistics() -> Outcome {
    let track = track::derive(report::Reader::new().read(REPORTS[0])?.report)?;
    let criteria = TrimCriteria::ghazi_2020_table_4();
    let mut segments = 0;
    counted(&mut || segments = segmenter::segment(&track, &criteria).segments.len());
    assert!(segments > 3);
    Ok(())
}

/// The fifth flight of a tail.
fn learn_flight() -> Outcome {
    let (mut state, flight) = learnt()?;
    counted(&mut || {
        let _ = black_box(state.learn_flight(&flight));
    });
    assert!(state.touched_nodes() > 3);
    Ok(())
}

/// The table after it.
fn solve_table() -> Outcome {
    let (mut state, flight) = learnt()?;
    let _ = state.learn_flight(&flight);
    let mut solved = None;
    counted(&mut || solved = Some(state.solve()));
    assert!(solved.ok_or("not run")??.informed_share() > 0.0);
    Ok(())
}

/// Fuel flow at 1,000 points.
fn predict_points() -> Outcome {
    let model = global5000()?;
    let mut random = Random::new(1, 2);
    let mut column =
        |from: f64, to: f64| -> Vec<f64> { (0..1_000).map(|_| random.uniform(from, to)).collect() };
    let mass_kg = column(28_000.0, 38_000.0);
    let pressure_altitude_m = column(11_000.0, 12_500.0);
    let (mach, isa_deviation_k) = (column(0.75, 0.85), column(-10.0, 10.0));
    let points = LevelFlights {
        mass_kg: &mass_kg,
        pressure_altitude_m: &pressure_altitude_m,
        mach: &mach,
        isa_deviation_k: &isa_deviation_k,
    };
    let mut flows = Vec::new();
    counted(&mut || flows = model.fuel_flows_kg_s(points));
    assert!(flows.iter().filter(|flow| flow.is_finite()).count() > 900);
    Ok(())
}

/// The search for a wave drag of typical size in ten flights of six segments: no closure, no regions.
fn diagnose_fleet() -> Outcome {
    let planted = [plant(EffectId::WaveDrag, 1.0, &mut Random::new(1, 9))];
    let setup = Setup { flights: 10, segments: 6, ..Setup::default() };
    let flights = fly(1, &setup, &planted, &Background::default()).flights;
    let model = exact_model();
    let records: Vec<_> =
        flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    let input = Input::against(&model, &records);
    let options = Options { skip_closure: true, skip_where: true, ..Options::default() };
    let mut found = None;
    counted(&mut || found = Some(diagnose(&input, &options)));
    assert_eq!(found.ok_or("not run")??.segments, 60);
    Ok(())
}

fn global5000() -> Result<PerformanceModel, Box<dyn Error>> {
    Ok(initial_model(&Aircraft::from_ron(AIRCRAFT)?, &Guide::from_csv(GUIDE)?)?.model)
}

/// What four flights taught, and a fifth.
fn learnt() -> Result<(BayesState, Vec<Observation>), Box<dyn Error>> {
    let model = global5000()?;
    let criteria = TrimCriteria::ghazi_2020_table_4();
    let mut flights = Vec::new();
    for bytes in REPORTS {
        let report = report::Reader::new().read(bytes)?.report;
        let flight = ReducedFlight::from_report(report, &criteria, Vec::new())?;
        let observed: Result<Vec<_>, _> =
            flight.segments.iter().map(|segment| model.observe(segment)).collect();
        flights.push(observed?);
    }
    let last = flights.pop().ok_or("five flights")?;
    let mut state = BayesState::new(model.drag_table(), BayesSettings::physical_2026())?;
    for flight in &flights {
        let _ = state.learn_flight(flight);
    }
    Ok((state, last))
}
