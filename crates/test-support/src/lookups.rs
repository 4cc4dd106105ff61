//! Lookups in a table, one after the other, for their instructions to be counted.

use lut::{Outside, Table};

/// Looks points up, and returns the sum of the values inside the table and how many they are.
///
/// Here, because the crate that counts is compiled without optimisation for tests, and lookups into it.
#[inline(never)]
#[must_use]
pub fn looked_up(table: &Table, points: &[(f64, f64)]) -> (f64, usize) {
    let (mut sum, mut inside) = (0.0, 0);
    for &(x, y) in points {
        if let Ok(cell) = table.grid().locate(x, y, Outside::Error) {
            sum += table.interpolate(&cell);
            inside += 1;
        }
    }
    (sum, inside)
}
