//! CD0(M) and K(M) of a drag table, of which some effects are a share.

use lut::Table;
use lut::surface::{Basis, FitError, Surface, fit_beside};

use crate::drag::drag_rise;

/// Drag-divergence Mach numbers, at the lift coefficient of [`drag_rise`], at which a rise is looked for: transport and business
/// aircraft, about as far apart as their rises can be told apart. Our choice.
const FIRST_DIVERGENCE_MACH: f64 = 0.70;
const DIVERGENCE_MACH_STEP: f64 = 0.02;
const DIVERGENCE_MACHS: u8 = 14;

/// CD0(M) and K(M) of a table: the six-coefficient polynomial of what it has beside a drag rise.
///
/// ```text
/// CD ≈ p0 + p1 M + p2 M² + (p3 + p4 M + p5 M²) CL² + a·w(M, CL; Mdd),   a ≥ 0     [diagnosis.57]
/// ```
///
/// A polynomial alone takes the rise for friction and lift: on an airliner's drag up to Mach 0.95, K would grow by 59 % between
/// Mach 0.72 and 0.82 where it truly grows by 2 %, and a table that is a polynomial stays one.
///
/// # Errors
/// [`FitError`] where the nodes do not determine six coefficients.
pub(crate) fn fit_polar(drag_table: &Table) -> Result<Surface, FitError> {
    let grid = drag_table.grid();
    let points: Vec<_> = drag_table
        .values()
        .iter()
        .enumerate()
        .map(|(node, &drag_coefficient)| {
            let (lift_coefficient, mach) = grid.coordinates(node);
            (lift_coefficient, mach, drag_coefficient, 1.0)
        })
        .collect();
    let rises: Vec<_> = (0..DIVERGENCE_MACHS)
        .map(|step| FIRST_DIVERGENCE_MACH + DIVERGENCE_MACH_STEP * f64::from(step))
        .map(|divergence_mach| {
            move |lift_coefficient: f64, mach: f64| {
                drag_rise(mach, lift_coefficient, divergence_mach)
            }
        })
        .collect();
    let rises: Vec<&dyn Fn(f64, f64) -> f64> = rises.iter().map(|rise| rise as _).collect();
    Ok(fit_beside(Basis::SeparableQuadratic, &points, &rises)?.fit.surface)
}
