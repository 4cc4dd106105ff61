//! A third of a table was corrected upwards by 8 %; the polynomial carries part of that to the rest.
//!
//! `cargo run -p cruisefit-refit --example carry_over`

use std::error::Error;
use std::sync::Arc;

use lut::surface::Basis;
use lut::{Axis, Grid, Table};
use refit::{RefitRule, refit};

fn main() -> Result<(), Box<dyn Error>> {
    let lift_coefficient = Axis::from_step(0.10, 0.60, 0.05)?;
    let mach = Axis::from_step(0.50, 0.90, 0.05)?;
    let grid = Arc::new(Grid::new(lift_coefficient, mach));
    let drag = |lift_coefficient: f64, mach: f64| {
        0.02 + 0.01 * mach * mach + 0.06 * lift_coefficient * lift_coefficient
    };
    let (mut values, mut confidences) = (vec![], vec![]);
    for node in 0..grid.nodes() {
        let (lift_coefficient, mach) = grid.coordinates(node);
        let adapted = lift_coefficient >= 0.40 && mach >= 0.60;
        values.push(drag(lift_coefficient, mach) * if adapted { 1.08 } else { 1.0 });
        confidences.push(if adapted { 2.0 } else { 1.0 });
    }
    let mut drag_coefficient = Table::new(Arc::clone(&grid), values)?;
    let mut confidence = Table::new(grid, confidences)?;

    let rule = RefitRule::ghazi_2020();
    let report = refit(rule, Basis::SeparableQuadratic, &mut drag_coefficient, &mut confidence)?;

    assert_eq!((report.nodes_adapted, report.nodes), (35, 99));
    assert!(report.fit.is_some_and(|fit| fit.rank == 6));
    assert!(confidence.values().iter().all(|lambda| (lambda - 1.0).abs() < f64::EPSILON));
    Ok(())
}
