//! Time of predictions by all that a model has learnt, at points drawn where the Global 5000 of `fixtures/global5000` flies.
//!
//! `cargo run --release -p cruisefit-pipeline --example whole_speed -- MODEL.ron [POINTS] [means|flows|deviations]`; without a model one that has
//! learnt no more than its table.
#![expect(clippy::print_stdout, reason = "an example shows its result")]
#![expect(clippy::disallowed_methods, reason = "the file of a measurement, not of the library")]

use std::hint::black_box;
use std::time::Instant;

use perf_model::LevelFlights;
use pipeline::model_file::ModelFile;
use pipeline::prediction::{PredictedColumn, Predictor};
use pipeline::whole_model::Predicts;
use test_support::Random;

const TABLE_ALONE: &str = include_str!("../../../fixtures/global5000/bayes/expected/SIM-01.ron");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let text = match arguments.first() {
        Some(path) => std::fs::read_to_string(path)?,
        None => TABLE_ALONE.to_owned(),
    };
    let count: usize = arguments.get(1).map_or(Ok(10_000), |text| text.parse())?;
    let asked = arguments.get(2).map(String::as_str);
    let file = ModelFile::from_text(&text)?;
    let begun = Instant::now();
    let mut predictor = Predictor::new(&file, Predicts::WholeModel)?;
    println!("prepared in {:.2} ms", 1e3 * begun.elapsed().as_secs_f64());
    match asked {
        Some("means") => predictor = predictor.without_deviations(),
        Some("flows") => predictor = predictor.with_columns(&[PredictedColumn::FuelFlow]),
        Some("deviations") => {
            let columns = [PredictedColumn::FuelFlow, PredictedColumn::FuelFlowDeviation];
            predictor = predictor.with_columns(&columns);
        }
        _ => {}
    }
    let mut random = Random::new(1, 1);
    let mut column =
        |from: f64, to: f64| -> Vec<f64> { (0..count).map(|_| random.uniform(from, to)).collect() };
    let (mass_kg, feet) = (column(27_000.0, 36_000.0), column(38_000.0, 45_000.0));
    let (mach, isa_deviation_k) = (column(0.74, 0.84), column(-10.0, 10.0));
    let pressure_altitude_m: Vec<f64> = feet.iter().map(|feet| 0.3048 * feet).collect();
    let flights = LevelFlights {
        mass_kg: &mass_kg,
        pressure_altitude_m: &pressure_altitude_m,
        mach: &mach,
        isa_deviation_k: &isa_deviation_k,
    };
    let (mut best_s, mut last) = (f64::INFINITY, None);
    let runs = if count <= 20_000 { 1 } else { 7 };
    for _ in 0..runs {
        let begun = Instant::now();
        last = Some(black_box(predictor.at_level_flights(black_box(flights), None)));
        best_s = best_s.min(begun.elapsed().as_secs_f64());
    }
    println!("{:.1} ns a point, best of {runs}", 1e9 * best_s / count as f64);
    let found = last.ok_or("nothing was predicted")?;
    for (name, values) in &found.columns {
        let known: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
        let mean = known.iter().sum::<f64>() / known.len() as f64;
        println!("{name}: {} known, mean {mean}", known.len());
    }
    assert!(found.refused.len() < count, "no point is inside the table");
    Ok(())
}
