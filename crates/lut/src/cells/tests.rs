use std::sync::Arc;

use super::*;
use crate::{Axis, SmoothTable, Table};

/// The oracle is the search point by point, and what tables give there: inside cells, on breakpoints, at ends, outside, no numbers.
#[test]
fn side_by_side_as_one_by_one() {
    let x = Axis::new(vec![0.1, 0.15, 0.3, 0.35, 0.6]).unwrap();
    let grid = Arc::new(Grid::new(x, Axis::new(vec![0.5, 0.7, 0.75, 0.9]).unwrap()));
    let values = |of: fn(f64, f64) -> f64| {
        let at = |node| grid.coordinates(node);
        (0..grid.nodes()).map(|node| of(at(node).0, at(node).1)).collect()
    };
    let table = Table::new(Arc::clone(&grid), values(|x, y| (5.0 * x).sin() + x * y)).unwrap();
    let smooth = SmoothTable::new(&table);
    let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, 0.1, 0.6, 0.3, 0.3 + 1e-10];
    let (mut cells, mut inside, mut outside) = (Cells::<8>::default(), 0, 0);
    for step in 0..2000_u32 {
        let (mut x, mut y) = ([0.0; 8], [0.0; 8]);
        for ((x, y), k) in x.iter_mut().zip(&mut y).zip(0_u32..) {
            *x = 0.05 + 0.0007 * f64::from((step * 37 + 113 * k) % 900);
            *y = 0.45 + 0.0005 * f64::from((step * 53 + 7 * k) % 1000);
        }
        if step % 5 == 0 {
            x[(step / 5 % 8) as usize] = odd[(step / 40 % 8) as usize];
            y[(step / 7 % 8) as usize] = [0.5, 0.7, 0.75, 0.9][(step / 35 % 4) as usize];
        }
        cells.locate(&grid, &x, &y);
        let (bilinear, cubic) = (table.interpolate_all(&cells), smooth.values(&cells));
        let (with_slopes, slopes) = table.values_and_slopes_along_x(&cells);
        for place in 0..8 {
            let single = grid.locate(x[place], y[place], Outside::Error);
            assert_eq!(cells.is_inside(place), single.is_ok(), "{} {}", x[place], y[place]);
            let Ok(cell) = single else {
                outside += 1;
                continue;
            };
            inside += 1;
            assert_eq!(cells.nodes(place), cell.nodes());
            let bits = |values: [f64; 4]| values.map(f64::to_bits);
            assert_eq!(bits(cells.weights(place)), bits(cell.weights()));
            assert_eq!(bilinear[place].to_bits(), table.interpolate(&cell).to_bits());
            assert_eq!(cubic[place].to_bits(), smooth.value(&cell).to_bits());
            assert_eq!(with_slopes[place].to_bits(), bilinear[place].to_bits());
            assert!((slopes[place] - table.gradient(&cell).0).abs() < 1e-12);
        }
    }
    assert!(inside > 8000 && outside > 1000, "{inside} {outside}");
}
