//! How far the chords of a drag table may be off.

use effects::{EffectModel, Response};

/// How far a chord of the drag table may be off, relative to drag: ½·u(1 − u)·Δ², Δ² the mean of the second differences
/// at the cell's ends, along each axis. `[diagnosis.15]`
/// The curve of a table that is smooth between its nodes is as uncertain: what an aircraft does within a cell, no node says.
pub(crate) fn chord_errors(model: &EffectModel<'_>, response: &Response) -> [f64; 2] {
    let table = model.drag_table();
    let grid = table.grid();
    let Ok(cell) = grid.locate(response.lift_coefficient, response.mach, lut::Outside::Hold) else {
        return [0.0; 2];
    };
    let drag = table.interpolate(&cell);
    let [low, _, _, _] = cell.nodes();
    let (columns, rows) = (grid.y().len(), grid.x().len());
    let (i, j) = (low / columns, low % columns);
    let value = |i: usize, j: usize| table.value_at_node(i * columns + j);
    let second = |at: usize, of: usize, get: &dyn Fn(usize) -> f64| {
        if at == 0 || at + 1 >= of { None } else { Some(get(at - 1) - 2.0 * get(at) + get(at + 1)) }
    };
    let mean = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => 0.0,
    };
    let (u, v) = cell.local();
    let along_lift = mean(
        second(i, rows, &|k| value(k, j) * (1.0 - v) + value(k, j + 1) * v),
        second(i + 1, rows, &|k| value(k, j) * (1.0 - v) + value(k, j + 1) * v),
    );
    let along_mach = mean(
        second(j, columns, &|k| value(i, k) * (1.0 - u) + value(i + 1, k) * u),
        second(j + 1, columns, &|k| value(i, k) * (1.0 - u) + value(i + 1, k) * u),
    );
    [-0.5 * u * (1.0 - u) * along_lift / drag, -0.5 * v * (1.0 - v) * along_mach / drag]
}
