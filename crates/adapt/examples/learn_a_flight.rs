//! A table learns from three segments of an aircraft with 7 % more drag, one of them outside the table.
//!
//! `cargo run -p cruisefit-adapt --example learn_a_flight`

use std::error::Error;
use std::sync::Arc;

use adapt::paper::{PaperLaw, State, Update};
use flight::{Observation, ObservationVariance, Timestamp};
use lut::{Axis, Grid, Table};

fn main() -> Result<(), Box<dyn Error>> {
    let lift_coefficient = Axis::from_step(0.10, 0.70, 0.05)?;
    let mach = Axis::from_step(0.50, 0.95, 0.05)?;
    let grid = Arc::new(Grid::new(lift_coefficient, mach));
    let drag = |lift_coefficient: f64| 0.021 + 0.055 * lift_coefficient * lift_coefficient;
    let values = (0..grid.nodes()).map(|node| drag(grid.coordinates(node).0)).collect();
    let mut state = State::new(Table::new(grid, values)?);

    let law = PaperLaw::ghazi_2020();
    let (mut adapted, mut outside) = (0, 0);
    for (lift_coefficient, mach) in [(0.42, 0.78), (0.41, 0.79), (0.75, 0.78)] {
        let drag_coefficient = 1.07 * drag(lift_coefficient);
        let observation = Observation {
            time: Timestamp::UNIX_EPOCH,
            lift_coefficient,
            mach,
            drag_coefficient,
            fuel_flow_total_kg_s: 10.0 * drag_coefficient,
            fuel_flow_per_drag_coefficient_kg_s: 10.0,
            variance: ObservationVariance { segment: 1e-4, flight: 1e-4 },
        };
        match law.adapt(&mut state, &observation) {
            Update::Adapted { .. } => adapted += 1,
            Update::OutsideGrid(_) => outside += 1,
            Update::WithinDeadBand { .. } | Update::Unusable { .. } => {}
        }
    }
    // The second segment found its cell already corrected by the first.
    assert_eq!((adapted, outside), (1, 1));
    Ok(())
}
