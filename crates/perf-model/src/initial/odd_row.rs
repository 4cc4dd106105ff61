//! The row of a guide that is probably mistyped.
//!
//! A row far off the polynomial is either mistyped or where the polynomial cannot follow the guide: at the highest Mach
//! numbers drag rises faster than any quadratic, and the last row there is the farthest off. The rows about it show which:
//! they rise with it, or they do not. So a second polynomial goes through those alone, and says what they expect of the row.

use lut::surface::{self, Basis};

use super::GuideObservation;

/// Rows about a row that say what is expected of it, at least: four for each coefficient of a polynomial through them. Our choice.
const NEIGHBOURS: usize = 24;
/// Share of a row's residual that its neighbours must leave unexplained. Of a row that is mistyped they explain next to
/// none, of a drag rise most. Our choice.
const UNEXPLAINED: f64 = 0.5;

/// The row farthest off the polynomial, by more than `least_percent`, that the rows about it do not explain: its index.
pub(super) fn odd_row(
    basis: Basis,
    rows: &[GuideObservation],
    residuals_percent: &[f64],
    least_percent: f64,
) -> Option<usize> {
    let mut far: Vec<(usize, f64)> = residuals_percent
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, percent)| percent.abs() > least_percent)
        .collect();
    far.sort_by(|one, other| other.1.abs().total_cmp(&one.1.abs()));
    far.into_iter()
        .find(|&(index, percent)| {
            // Where too few rows are about it to say, it is as far off as it is.
            let left = percent_off_neighbours(basis, rows, index).unwrap_or(percent);
            left / percent > UNEXPLAINED
        })
        .map(|(index, _)| index)
}

/// How far a row's drag lies above the polynomial through the rows about it, without itself, %; `None` where these do not
/// determine one.
fn percent_off_neighbours(basis: Basis, rows: &[GuideObservation], index: usize) -> Option<f64> {
    let row = rows.get(index)?;
    let lift = super::range(rows.iter().map(|row| row.lift_coefficient));
    let mach = super::range(rows.iter().map(|row| row.mach));
    let distance = |other: &GuideObservation| {
        let across = (other.lift_coefficient - row.lift_coefficient) / (lift.1 - lift.0);
        let along = (other.mach - row.mach) / (mach.1 - mach.0);
        across.hypot(along)
    };
    let mut others: Vec<&GuideObservation> =
        rows.iter().enumerate().filter(|(at, _)| *at != index).map(|(_, other)| other).collect();
    others.sort_by(|one, other| distance(one).total_cmp(&distance(other)));
    let points: Vec<(f64, f64, f64, f64)> = others
        .iter()
        .map(|other| (other.lift_coefficient, other.mach, other.drag_coefficient, 1.0))
        .collect();
    // The nearest of a guide of few Mach numbers may be of one or two of them, which determine no polynomial: then more are asked.
    let local = (NEIGHBOURS..=points.len())
        .step_by(NEIGHBOURS / 2)
        .find_map(|nearest| surface::fit(basis, &points[..nearest]).ok())?
        .surface;
    Some(100.0 * (1.0 - local.value(row.lift_coefficient, row.mach) / row.drag_coefficient))
}
