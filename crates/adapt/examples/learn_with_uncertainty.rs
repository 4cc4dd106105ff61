//! Law `bayes` learns three flights of an aircraft with 5 % more drag, and reports how sure it is where they never
//! went.
//!
//! `cargo run -p cruisefit-adapt --example learn_with_uncertainty`

#![expect(clippy::print_stdout, reason = "an example shows its result")]

use std::error::Error;
use std::sync::Arc;

use adapt::bayes::{BayesSettings, BayesState};
use flight::{Observation, ObservationVariance, Timestamp};
use lut::{Axis, Grid, Outside, Table};

fn main() -> Result<(), Box<dyn Error>> {
    let grid = Grid::new(Axis::from_step(0.10, 0.70, 0.05)?, Axis::from_step(0.50, 0.95, 0.05)?);
    let grid = Arc::new(grid);
    let drag = |lift_coefficient: f64| 0.021 + 0.055 * lift_coefficient * lift_coefficient;
    let values = (0..grid.nodes()).map(|node| drag(grid.coordinates(node).0)).collect();
    let initial = Table::new(Arc::clone(&grid), values)?;

    let mut state = BayesState::new(&initial, BayesSettings::physical_2026())?;
    for (day, mach) in [(1, 0.78), (2, 0.80), (3, 0.82)] {
        let segment = |k: i64| -> Result<Observation, Box<dyn Error>> {
            let lift_coefficient = 0.45 - 0.01 * k as f64;
            let cell = grid.locate(lift_coefficient, mach, Outside::Error)?;
            let drag_coefficient = 1.05 * initial.interpolate(&cell);
            Ok(Observation {
                time: Timestamp::from_second(86_400 * day + 900 * k)?,
                lift_coefficient,
                mach,
                drag_coefficient,
                fuel_flow_total_kg_s: 10.0 * drag_coefficient,
                fuel_flow_per_drag_coefficient_kg_s: 10.0,
                variance: ObservationVariance { segment: 2.5e-5, flight: 2e-5 },
            })
        };
        let _ = state.learn_flight(&(0..8).map(segment).collect::<Result<Vec<_>, _>>()?);
    }

    let posterior = state.solve()?;
    for (place, lift_coefficient, mach) in [("flown", 0.42, 0.80), ("far away", 0.15, 0.55)] {
        let cell = grid.locate(lift_coefficient, mach, Outside::Error)?;
        let percent = 100.0 * posterior.correction_at(&cell);
        let std_percent = 100.0 * posterior.relative_variance(&cell).sqrt();
        println!("{place}: drag {percent:+.1} % ± {std_percent:.1} %");
        assert!((percent - 5.0).abs() < 2.0 * std_percent);
    }
    Ok(())
}
