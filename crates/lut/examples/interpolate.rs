//! A table on uneven axes: reading it, and changing the nodes of one cell.
//!
//! `cargo run -p cruisefit-lut --example interpolate`

use std::error::Error;
use std::sync::Arc;

use lut::{Axis, Grid, Outside, Table};

fn main() -> Result<(), Box<dyn Error>> {
    let x = Axis::from_step(0.10, 0.70, 0.05)?;
    let y = Axis::new(vec![0.50, 0.60, 0.70, 0.75, 0.80, 0.84, 0.88])?;
    let grid = Arc::new(Grid::new(x, y));
    let values = (0..grid.nodes()).map(|node| {
        let (x, y) = grid.coordinates(node);
        0.02 + 0.05 * x * x + 0.01 * y
    });
    let mut table = Table::new(Arc::clone(&grid), values.collect())?;

    // One search serves reading and changing.
    let cell = grid.locate(0.42, 0.81, Outside::Error)?;
    let before = table.interpolate(&cell);
    let wanted = 0.040;
    let squares: f64 = cell.weights().iter().map(|weight| weight * weight).sum();
    for (node, weight) in cell.nodes().into_iter().zip(cell.weights()) {
        table.values_mut()[node] += (wanted - before) * weight / squares;
    }
    let after = table.interpolate(&cell);

    // Outside there is no value, unless the edge value is asked for.
    assert!(grid.locate(0.42, 0.90, Outside::Error).is_err());
    assert!(grid.locate(0.42, 0.90, Outside::Hold)?.held());
    assert!((before - 0.0369).abs() < 1e-4 && (after - wanted).abs() < 1e-15);
    Ok(())
}
