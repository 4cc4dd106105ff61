//! Points a second of one core, for `benches/predict.py`: fuel flow at the flight points of a file, twenty times.
//!
//! `cargo run --release -p cruisefit-perf-model --example predict_speed [AIRCRAFT.ron GUIDE.csv POINTS.csv]`
#![expect(clippy::print_stdout, reason = "an example shows its result")]
#![expect(clippy::disallowed_methods, reason = "the files of a measurement, not of the library")]

use std::hint::black_box;
use std::time::Instant;

use perf_model::{Aircraft, FlightPoint, FlightPoints, Guide, LevelFlights, initial_model};

const RUNS: usize = 20;
const AIRCRAFT: &str = r#"(
    name: "JSBSim global5000", type_code: "GL5T", engines: 2, wing_area_m2: 94.94690688,
    tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0.6),
    table: (lift_coefficient: (0.10, 0.80, 0.05), mach: (0.50, 0.95, 0.05)),
)"#;
const GUIDE: &[u8] = include_bytes!("../tests/golden/guide.csv");
const POINTS: &[u8] = b"mass_kg,pressure_altitude_ft,mach\n30000,41000,0.8\n31000,41000,0.8\n";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    let (aircraft, guide, points) = match &paths[..] {
        [] => (AIRCRAFT.to_owned(), GUIDE.to_vec(), POINTS.to_vec()),
        [aircraft, guide, points] => {
            (std::fs::read_to_string(aircraft)?, std::fs::read(guide)?, std::fs::read(points)?)
        }
        _ => return Err("three files are needed, or none".into()),
    };
    let model = initial_model(&Aircraft::from_ron(&aircraft)?, &Guide::from_csv(&guide)?)?.model;
    let points = FlightPoints::from_csv(&points)?;
    let points: Vec<FlightPoint> =
        points.rows().iter().filter_map(|row| row.point.clone().ok()).collect();
    let column = |of: fn(&FlightPoint) -> f64| points.iter().map(of).collect::<Vec<_>>();
    let mass_kg = column(|point| point.mass.to_kilograms());
    let pressure_altitude_m = column(|point| point.pressure_altitude.to_meters());
    let mach = column(|point| point.mach.value());
    let isa_deviation_k = column(|point| point.isa_deviation.to_kelvin());
    let columns = LevelFlights {
        mass_kg: &mass_kg,
        pressure_altitude_m: &pressure_altitude_m,
        mach: &mach,
        isa_deviation_k: &isa_deviation_k,
    };
    let mut flows = Vec::new();
    let (mut best_s, mut best_single_s) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..RUNS {
        let begun = Instant::now();
        flows = black_box(model.fuel_flows_kg_s(black_box(columns)));
        best_s = best_s.min(begun.elapsed().as_secs_f64());
        let begun = Instant::now();
        for point in &points {
            let _ = black_box(model.predict(black_box(point)));
        }
        best_single_s = best_single_s.min(begun.elapsed().as_secs_f64());
    }
    let inside: Vec<f64> = flows.into_iter().filter(|flow| !flow.is_nan()).collect();
    let mean = inside.iter().sum::<f64>() / inside.len() as f64;
    println!(
        "{{\"points\": {}, \"inside\": {}, \"mean_kg_s\": {mean}, \"best_s\": {best_s}, \"best_single_s\": {best_single_s}}}",
        points.len(),
        inside.len()
    );
    assert!(!inside.is_empty(), "no point is inside the table");
    Ok(())
}
