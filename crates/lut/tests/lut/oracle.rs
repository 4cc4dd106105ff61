//! Random tables against `interpn` (values and slopes), against a search by eye, and against functions that a
//! bilinear table reproduces.
#![expect(clippy::unwrap_used, reason = "a test")]
#![expect(clippy::float_cmp, reason = "what is exact is tested to be exact")]

use std::sync::Arc;

use interpn::MultilinearRectilinear;
use lut::{Axis, Grid, Outside, SNAP, Table};
use proptest::prelude::*;

/// Axes from even to so uneven that the search falls back to bisection.
fn axis() -> impl Strategy<Value = Axis> {
    (-2.0..2.0, prop::collection::vec(-6.0..0.0_f64, 1..40)).prop_map(|(first, steps)| {
        let mut breakpoints = vec![first];
        for step in steps {
            breakpoints.push(breakpoints[breakpoints.len() - 1] + 10_f64.powf(step));
        }
        Axis::new(breakpoints).unwrap()
    })
}

fn even_axis() -> impl Strategy<Value = Axis> {
    (-200..200_i32, 1..500_i32, 1..40_i32).prop_map(|(first, step, cells)| {
        let number = |thousandths: i32| f64::from(thousandths) / 1000.0;
        Axis::from_step(number(first), number(first + step * cells), number(step)).unwrap()
    })
}

fn any_axis() -> impl Strategy<Value = Axis> {
    prop_oneof![axis(), even_axis()]
}

prop_compose! {
    fn tables()(x in any_axis(), y in any_axis())(
        values in prop::collection::vec(-1.0..1.0, x.len() * y.len()),
        x in Just(x),
        y in Just(y),
    ) -> Table {
        Table::new(Arc::new(Grid::new(x, y)), values).unwrap()
    }
}

/// A coordinate of the axis: anywhere, or a breakpoint missed by 0 to 2 nanounits.
fn coordinate(axis: &Axis, share: f64, near_breakpoint: bool) -> f64 {
    let breakpoints = axis.breakpoints();
    if near_breakpoint {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let index = (share * breakpoints.len() as f64) as usize;
        let miss = 4e-9 * (share * 1e4).fract() - 2e-9;
        breakpoints[index.min(breakpoints.len() - 1)] + miss
    } else {
        axis.first() + share * (axis.last() - axis.first())
    }
}

/// The rule of the book's page on tables, word by word: snap, then the half-open cell, the last node in the last cell.
fn snapped_and_cell(axis: &Axis, coordinate: f64) -> Option<(f64, usize)> {
    let breakpoints = axis.breakpoints();
    let snapped = breakpoints
        .iter()
        .copied()
        .find(|breakpoint| (breakpoint - coordinate).abs() <= SNAP)
        .unwrap_or(coordinate);
    if snapped < axis.first() || snapped > axis.last() {
        return None;
    }
    let cell = breakpoints.iter().rposition(|&breakpoint| breakpoint <= snapped).unwrap();
    Some((snapped, cell.min(breakpoints.len() - 2)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn values_and_slopes_are_those_of_interpn(
        table in tables(),
        (share_x, share_y) in (0.0..1.0, 0.0..1.0),
    ) {
        let (x_axis, y_axis) = (table.grid().x(), table.grid().y());
        let (x, y) = (coordinate(x_axis, share_x, false), coordinate(y_axis, share_y, false));
        // Where we snap, interpn does not.
        let on_line = |axis: &Axis, at: f64| {
            axis.breakpoints().iter().any(|breakpoint| (breakpoint - at).abs() <= SNAP)
        };
        prop_assume!(!on_line(x_axis, x) && !on_line(y_axis, y));
        let axes = [x_axis.breakpoints(), y_axis.breakpoints()];
        let oracle = MultilinearRectilinear::new(&axes, table.values()).unwrap();

        let cell = table.grid().locate(x, y, Outside::Error).unwrap();
        let value = oracle.interp_one([x, y]).unwrap();
        prop_assert!((table.interpolate(&cell) - value).abs() < 1e-13);

        let (along_x, along_y) = table.gradient(&cell);
        let [oracle_x, oracle_y] = oracle.interp_one_grad([x, y]).unwrap();
        let (width_x, width_y) = cell.widths();
        prop_assert!(((along_x - oracle_x) * width_x).abs() < 1e-13);
        prop_assert!(((along_y - oracle_y) * width_y).abs() < 1e-13);
    }

    #[test]
    fn cells_weights_and_distances_follow_the_rule(
        table in tables(),
        (share_x, share_y) in (0.0..1.0, 0.0..1.0),
        (near_x, near_y) in (any::<bool>(), any::<bool>()),
    ) {
        let grid = table.grid();
        let (x, y) = (coordinate(grid.x(), share_x, near_x), coordinate(grid.y(), share_y, near_y));
        let expected = (snapped_and_cell(grid.x(), x), snapped_and_cell(grid.y(), y));
        let found = grid.locate(x, y, Outside::Error);
        let (Some((x, ix)), Some((y, iy))) = expected else {
            prop_assert!(found.is_err());
            return Ok(());
        };
        let cell = found.unwrap();
        let low = ix * grid.y().len() + iy;
        let high = low + grid.y().len();
        prop_assert_eq!(cell.nodes(), [low, low + 1, high, high + 1]);
        prop_assert!((cell.weights().iter().sum::<f64>() - 1.0).abs() < 1e-15);
        prop_assert!(cell.weights().iter().all(|weight| (0.0..=1.0).contains(weight)));

        let corner = |node| grid.coordinates(node);
        let ((x0, y0), (x1, y1)) = (corner(low), corner(high + 1));
        let diagonal = (x1 - x0).hypot(y1 - y0);
        for (node, distance) in cell.nodes().into_iter().zip(cell.normalized_distances()) {
            let (node_x, node_y) = corner(node);
            let expected = (x - node_x).hypot(y - node_y) / diagonal;
            prop_assert!((distance - expected).abs() < 1e-14);
            prop_assert!(distance <= 1.0);
        }
    }

    /// Check 8 of the reconstruction: a bilinear table reproduces any a + b x + c y + d x y.
    #[test]
    fn what_is_bilinear_is_reproduced(
        (x_axis, y_axis) in (any_axis(), any_axis()),
        [a, b, c, d] in prop::array::uniform4(-1.0..1.0),
        (share_x, share_y) in (0.0..1.0, 0.0..1.0),
    ) {
        let function = |x: f64, y: f64| a + b * x + c * y + d * x * y;
        let grid = Arc::new(Grid::new(x_axis, y_axis));
        let values = (0..grid.nodes())
            .map(|node| {
                let (x, y) = grid.coordinates(node);
                function(x, y)
            })
            .collect();
        let table = Table::new(Arc::clone(&grid), values).unwrap();
        let (x, y) = (coordinate(grid.x(), share_x, false), coordinate(grid.y(), share_y, false));
        let cell = grid.locate(x, y, Outside::Error).unwrap();
        // Snapping moves the point by up to a nanounit; numbers here are below a thousand.
        let tolerance = 1e-12 + 2.0 * SNAP * (2.0 + x.abs() + y.abs());
        let size = 1.0 + x.abs() + y.abs() + (x * y).abs();
        prop_assert!((table.interpolate(&cell) - function(x, y)).abs() < tolerance * size);
    }

    #[test]
    fn held_points_have_the_value_of_the_nearest_point_of_the_grid(
        table in tables(),
        (x, y) in (-50.0..50.0_f64, -50.0..50.0_f64),
    ) {
        let grid = table.grid();
        let nearest = (x.clamp(grid.x().first(), grid.x().last()), y.clamp(grid.y().first(), grid.y().last()));
        let held = grid.locate(x, y, Outside::Hold).unwrap();
        let inside = grid.locate(nearest.0, nearest.1, Outside::Error).unwrap();
        prop_assert_eq!(table.interpolate(&held), table.interpolate(&inside));
        prop_assert_eq!(held.held(), grid.locate(x, y, Outside::Error).is_err());
    }
}
