//! Cells, weights, distances, values and slopes at points where it matters: on nodes, lines and edges, near them,
//! outside.
#![expect(clippy::unwrap_used, reason = "a test")]
#![expect(clippy::float_cmp, reason = "what is exact is tested to be exact")]

use std::sync::Arc;

use lut::{Axis, Grid, Outside, Table, TableError};

/// 3 × 4 nodes with cells of different shapes.
fn grid() -> Arc<Grid> {
    let x = Axis::new(vec![0.1, 0.2, 0.5]).unwrap();
    let y = Axis::new(vec![0.5, 0.6, 0.8, 0.9]).unwrap();
    Arc::new(Grid::new(x, y))
}

fn table() -> Table {
    let values = vec![1.0, 2.0, 4.0, 8.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0];
    Table::new(grid(), values).unwrap()
}

fn close(ours: f64, expected: f64) {
    assert!((ours - expected).abs() < 1e-14, "{ours} for {expected}");
}

#[test]
fn nodes_are_numbered_x_outer_y_inner() {
    let grid = grid();
    assert_eq!(grid.nodes(), 12);
    assert_eq!(grid.coordinates(0), (0.1, 0.5));
    assert_eq!(grid.coordinates(3), (0.1, 0.9));
    assert_eq!(grid.coordinates(4), (0.2, 0.5));
    assert_eq!(grid.coordinates(11), (0.5, 0.9));
    assert_eq!(table().value_at_node(4), 3.0);
}

/// Written out by hand: the point (0.275, 0.75) lies in the cell 0.2..0.5 × 0.6..0.8 at u = 0.25, v = 0.75.
///
/// Weights (0.75·0.25, 0.75·0.75, 0.25·0.25, 0.25·0.75) = (0.1875, 0.5625, 0.0625, 0.1875);
/// value 0.1875·5 + 0.5625·7 + 0.0625·17 + 0.1875·19 = 9.5;
/// slope along x (0.25·(17 − 5) + 0.75·(19 − 7))/0.3 = 40, along y (0.75·(7 − 5) + 0.25·(19 − 17))/0.2 = 10;
/// distances √(0.075² + 0.15²), √(0.075² + 0.05²), √(0.225² + 0.15²), √(0.225² + 0.05²) over √(0.3² + 0.2²).
#[test]
fn a_point_inside_a_cell_by_hand() {
    let table = table();
    let cell = table.grid().locate(0.275, 0.75, Outside::Error).unwrap();
    assert_eq!(cell.nodes(), [5, 6, 9, 10]);
    for (ours, expected) in cell.weights().into_iter().zip([0.1875, 0.5625, 0.0625, 0.1875]) {
        close(ours, expected);
    }
    let diagonal = 0.13_f64.sqrt();
    let squares = [0.028_125, 0.008_125, 0.073_125, 0.053_125_f64];
    for (ours, square) in cell.normalized_distances().into_iter().zip(squares) {
        close(ours, square.sqrt() / diagonal);
    }
    close(table.interpolate(&cell), 9.5);
    let (along_x, along_y) = table.gradient(&cell);
    assert!((along_x - 40.0).abs() < 1e-12 && (along_y - 10.0).abs() < 1e-12);
    assert!(!cell.held());
    let (u, v) = cell.local();
    close(u, 0.25);
    close(v, 0.75);
}

#[test]
fn every_node_has_exactly_its_value_and_weight_1() {
    let table = table();
    for node in 0..table.grid().nodes() {
        let (x, y) = table.grid().coordinates(node);
        for (dx, dy) in [(0.0, 0.0), (0.9e-9, -0.9e-9), (-0.9e-9, 0.9e-9)] {
            let cell = table.grid().locate(x + dx, y + dy, Outside::Error).unwrap();
            assert_eq!(table.interpolate(&cell), table.value_at_node(node));
            let at = cell.nodes().iter().position(|&other| other == node).unwrap();
            let mut weights = [0.0; 4];
            weights[at] = 1.0;
            assert_eq!(cell.weights(), weights);
            assert_eq!(cell.normalized_distances()[at], 0.0);
            assert_eq!(cell.normalized_distances()[3 - at], 1.0);
            assert!(!cell.held());
        }
    }
}

#[test]
fn cells_are_half_open_and_the_last_node_belongs_to_the_last_cell() {
    let grid = grid();
    let lowest_node = |x, y| grid.locate(x, y, Outside::Error).unwrap().nodes()[0];
    assert_eq!(lowest_node(0.1, 0.5), 0);
    assert_eq!(lowest_node(0.2, 0.5), 4);
    assert_eq!(lowest_node(0.5, 0.5), 4);
    assert_eq!(lowest_node(0.15, 0.6), 1);
    assert_eq!(lowest_node(0.15, 0.9), 2);
    // Half a nanounit below a line is on it, and so in the cell above; two are not.
    assert_eq!(lowest_node(0.2 - 0.5e-9, 0.55), 4);
    assert_eq!(lowest_node(0.2 - 2e-9, 0.55), 0);
}

#[test]
fn on_a_line_two_nodes_take_no_part() {
    let table = table();
    let cell = table.grid().locate(0.2 - 1e-10, 0.7, Outside::Error).unwrap();
    assert_eq!(cell.nodes(), [5, 6, 9, 10]);
    assert_eq!(cell.weights()[2..], [0.0, 0.0]);
    close(table.interpolate(&cell), 6.0);
    // The last line belongs to the last cell, whose far nodes then have a part.
    let cell = table.grid().locate(0.5, 0.7, Outside::Error).unwrap();
    assert_eq!(cell.weights()[..2], [0.0, 0.0]);
    close(table.interpolate(&cell), 18.0);
}

#[test]
fn outside_is_refused_or_held_and_said() {
    let table = table();
    let grid = table.grid();
    for (x, y, value) in [
        (0.0, 0.5, 1.0),
        (0.6, 0.9, 23.0),
        (0.6, 0.4, 13.0),
        (0.15, 1.0, 9.5),
        (0.1 - 2e-9, 0.55, 1.5),
    ] {
        let error = grid.locate(x, y, Outside::Error).unwrap_err();
        assert_eq!((error.x, error.y), (x, y));
        let cell = grid.locate(x, y, Outside::Hold).unwrap();
        assert!(cell.held());
        close(table.interpolate(&cell), value);
    }
    let inside = grid.locate(0.1 - 0.9e-9, 0.9 + 0.9e-9, Outside::Error).unwrap();
    assert!(!inside.held());
    assert!(!grid.locate(0.3, 0.7, Outside::Hold).unwrap().held());
}

#[test]
fn what_is_not_finite_is_never_held() {
    for (x, y) in [(f64::NAN, 0.7), (0.3, f64::NAN), (f64::INFINITY, 0.7), (0.3, -f64::INFINITY)] {
        assert!(grid().locate(x, y, Outside::Error).is_err());
        assert!(grid().locate(x, y, Outside::Hold).is_err());
    }
}

#[test]
fn slope_across_the_edge_is_0_where_held() {
    let table = table();
    let cell = table.grid().locate(0.9, 0.7, Outside::Hold).unwrap();
    let (along_x, along_y) = table.gradient(&cell);
    assert_eq!(along_x, 0.0);
    assert!((along_y - 10.0).abs() < 1e-12); // (19 − 17)/0.2 along the edge
    let on_edge = table.grid().locate(0.5, 0.7, Outside::Error).unwrap();
    assert!((table.gradient(&on_edge).0 - 40.0).abs() < 1e-12); // ((17 − 5)/2 + (19 − 7)/2)/0.3
}

#[test]
fn refusal_says_point_and_limits() {
    let error = grid().locate(0.6, 0.7, Outside::Error).unwrap_err();
    assert_eq!(error.to_string(), "point (0.6, 0.7) outside the grid 0.1 to 0.5 by 0.5 to 0.9");
}

#[test]
fn tables_need_one_finite_value_a_node() {
    assert_eq!(
        Table::new(grid(), vec![0.0; 11]),
        Err(TableError::Length { values: 11, nodes: 12 })
    );
    let mut values = vec![0.0; 12];
    values[7] = f64::NAN;
    assert!(matches!(Table::new(grid(), values), Err(TableError::NotFinite { node: 7, .. })));
    assert_eq!(TableError::Length { values: 11, nodes: 12 }.to_string(), "11 values for 12 nodes");
}

#[test]
fn tables_share_one_grid() {
    let grid = grid();
    let one = Table::new(Arc::clone(&grid), vec![1.0; 12]).unwrap();
    let mut two = one.clone();
    two.values_mut()[3] = 2.0;
    assert!(Arc::ptr_eq(one.grid(), two.grid()));
    assert_eq!((one.values()[3], two.values()[3]), (1.0, 2.0));
}
