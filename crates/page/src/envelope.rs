//! Where the aircraft flew: segments and mean error in each cell of lift coefficient and Mach number.

use maud::{Markup, html};

use crate::shade;
use crate::text::{breakpoint, signed_tenths};
use crate::view::{Point, TailView};
use pipeline::summary::counted;

/// Columns and rows that fit on a page; cells of a finer grid are merged.
const MOST_COLUMNS: usize = 12;
const MOST_ROWS: usize = 24;
/// A coordinate this near below a breakpoint is on it, as for the table itself.
const SNAP: f64 = lut::SNAP;
/// Mean error of full color, %.
const FULL_COLOR_PERCENT: f64 = 5.0;

/// The content of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Cell {
    segments: usize,
    sum_percent: f64,
}

/// Cells between breakpoints of lift coefficient and around those of Mach number, and the segments in them.
struct Envelope {
    lift_coefficient: Vec<f64>,
    mach: Vec<f64>,
    /// Lift coefficient outer, Mach number inner.
    cells: Vec<Cell>,
    /// Number of table cells in each of these, along lift coefficient and Mach number.
    merged: (usize, usize),
}

/// The table of cells, lift coefficient upwards and Mach number to the right.
pub(crate) fn envelope(view: &TailView) -> Markup {
    let Some(envelope) = Envelope::from_flights(view) else {
        return html! { p.note { "No segment inside the table: no map of where it flew." } };
    };
    let which = if view.adapted { "after" } else { view.before_label() };
    let columns = envelope.mach.len() - 1;
    html! {
        figure {
            figcaption {
                b { "Where it flew." }
                " Mean error " (which)
                ", %, and number n of segments in each cell of lift coefficient CL and Mach number. Blue burns less than \
                 the model predicts, orange more; full color from "
                (FULL_COLOR_PERCENT) " %."
            }
            div.scroll {
                table.heat {
                    thead {
                        tr {
                            td {}
                            th scope="colgroup" colspan=(columns) { "Mach number" }
                        }
                        tr {
                            th scope="col" { "CL" }
                            @for pair in envelope.mach.windows(2) {
                                th scope="col" { (breakpoint(pair[0])) "–" (breakpoint(pair[1])) }
                            }
                        }
                    }
                    tbody {
                        @for (row, pair) in envelope.lift_coefficient.windows(2).enumerate().rev() {
                            tr {
                                th scope="row" { (breakpoint(pair[0])) "–" (breakpoint(pair[1])) }
                                @for column in 0..columns {
                                    (cell(&envelope.cells[row * columns + column]))
                                }
                            }
                        }
                    }
                }
            }
            p.note {
                "Empty cells: no segment. The table continues beyond the outer cells, where nobody flew."
                @if envelope.merged != (1, 1) {
                    " A cell here holds " (envelope.merged.0) " by " (envelope.merged.1) " cells of the table."
                }
            }
        }
    }
}

fn cell(cell: &Cell) -> Markup {
    if cell.segments == 0 {
        return html! { td {} };
    }
    let mean = cell.sum_percent / cell.segments as f64;
    html! {
        td class=(shade::class(mean, FULL_COLOR_PERCENT)) {
            b { (signed_tenths(mean)) } " " span { "n\u{a0}" (cell.segments) }
        }
    }
}

impl Envelope {
    fn from_flights(view: &TailView) -> Option<Self> {
        let error = |point: &Point| {
            if view.adapted { point.after } else { point.before }
        };
        let rows = &view.polars.lift_coefficient;
        let columns = &around(&view.polars.mach);
        let mut cells = vec![Cell::default(); (rows.len() - 1) * (columns.len() - 1)];
        let mut bounds: Option<[usize; 4]> = None;
        for point in &view.points {
            let Some(error) = error(point) else { continue };
            let (row, column) =
                (between(rows, point.lift_coefficient), between(columns, point.mach));
            let cell = &mut cells[row * (columns.len() - 1) + column];
            cell.segments += 1;
            cell.sum_percent += error;
            let [top, bottom, left, right] = bounds.unwrap_or([row, row, column, column]);
            bounds = Some([top.min(row), bottom.max(row), left.min(column), right.max(column)]);
        }
        let [top, bottom, left, right] = bounds?;
        let along_rows = (bottom - top + 1).div_ceil(MOST_ROWS);
        let along_columns = (right - left + 1).div_ceil(MOST_COLUMNS);
        let row_edges = edges(top, bottom, along_rows);
        let column_edges = edges(left, right, along_columns);
        let mut merged = Vec::new();
        for row in row_edges.windows(2) {
            for column in column_edges.windows(2) {
                let mut sum = Cell::default();
                for one in (row[0]..row[1])
                    .flat_map(|r| (column[0]..column[1]).map(move |c| (r, c)))
                    .map(|(r, c)| &cells[r * (columns.len() - 1) + c])
                {
                    sum.segments += one.segments;
                    sum.sum_percent += one.sum_percent;
                }
                merged.push(sum);
            }
        }
        Some(Self {
            lift_coefficient: row_edges.iter().map(|k| rows[*k]).collect(),
            mach: column_edges.iter().map(|k| columns[*k]).collect(),
            cells: merged,
            merged: (along_rows, along_columns),
        })
    }

    #[cfg(test)]
    fn segments(&self) -> usize {
        self.cells.iter().map(|cell| cell.segments).sum()
    }
}

/// Edges half way between the breakpoints, and the outer ones: Mach numbers are flown in hundredths, which breakpoints are too, and a
/// steady cruise would fall on both sides of one.
fn around(breakpoints: &[f64]) -> Vec<f64> {
    let between = breakpoints.windows(2).map(|pair| f64::midpoint(pair[0], pair[1]));
    let (first, last) = (breakpoints.first(), breakpoints.last());
    first.copied().into_iter().chain(between).chain(last.copied()).collect()
}

/// Index of the cell that holds a value; the last breakpoint belongs to the last cell.
fn between(breakpoints: &[f64], value: f64) -> usize {
    let above = breakpoints.partition_point(|breakpoint| *breakpoint - SNAP <= value);
    above.saturating_sub(1).min(breakpoints.len() - 2)
}

/// Breakpoints from the cell `first` to the end of the cell `last`, every `step`.
fn edges(first: usize, last: usize, step: usize) -> Vec<usize> {
    let mut edges: Vec<usize> = (first..=last).step_by(step.max(1)).collect();
    edges.push(last + 1);
    edges
}

/// What lies outside the table, in words.
pub(crate) fn outside(view: &TailView) -> Option<String> {
    if view.outside.is_empty() {
        return None;
    }
    let range = |of: fn(&(f64, f64)) -> f64| {
        let low = view.outside.iter().map(of).fold(f64::INFINITY, f64::min);
        let high = view.outside.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        format!("{low:.3} to {high:.3}")
    };
    let ends =
        |axis: &[f64]| format!("{} to {}", breakpoint(axis[0]), breakpoint(axis[axis.len() - 1]));
    Some(format!(
        "{} outside the table, so without an error and in no figure: lift coefficient {}, Mach number {}. The table \
         holds lift coefficient {} and Mach number {}.",
        counted(view.outside.len(), "segment"),
        range(|(lift_coefficient, _)| *lift_coefficient),
        range(|(_, mach)| *mach),
        ends(&view.polars.lift_coefficient),
        ends(&view.polars.mach)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    #[test]
    fn every_segment_inside_is_in_one_cell() {
        for view in samples::views() {
            let inside = view.points.iter().filter(|point| {
                if view.adapted { point.after.is_some() } else { point.before.is_some() }
            });
            let counted = Envelope::from_flights(&view).map_or(0, |envelope| envelope.segments());
            assert_eq!(counted, inside.count());
        }
    }

    #[test]
    fn cells_are_half_open() {
        let breakpoints = [0.3, 0.4, 0.5];
        let cells = [0.3, 0.35, 0.4 - 1e-10, 0.4, 0.5].map(|value| between(&breakpoints, value));
        assert_eq!(cells, [0, 0, 1, 1, 1]);
    }

    /// A steady Mach 0.78 is in one column whatever its last digit.
    #[test]
    fn a_steady_mach_number_is_in_one_column() {
        let edges = around(&[0.74, 0.76, 0.78, 0.80]);
        let columns = [0.7796, 0.78, 0.7804].map(|mach| between(&edges, mach));
        assert_eq!(columns, [2; 3]);
        assert_eq!([0.74, 0.80].map(|mach| between(&edges, mach)), [0, 3]);
    }

    #[test]
    fn a_fine_grid_is_put_together() {
        assert_eq!(edges(2, 8, 3), [2, 5, 8, 9]);
    }
}
