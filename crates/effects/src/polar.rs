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
    let rises: Vec<_> = divergence_machs()
        .map(|divergence_mach| {
            move |lift_coefficient: f64, mach: f64| {
                drag_rise(mach, lift_coefficient, divergence_mach)
            }
        })
        .collect();
    Ok(fit_beside(Basis::SeparableQuadratic, &points, &rises)?.fit.surface)
}

/// Drag-divergence Mach numbers at which a rise is looked for.
pub(crate) fn divergence_machs() -> impl Iterator<Item = f64> {
    (0..DIVERGENCE_MACHS).map(|step| FIRST_DIVERGENCE_MACH + DIVERGENCE_MACH_STEP * f64::from(step))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use lut::{Axis, Grid};

    use super::*;

    fn table_of(drag_coefficient: impl Fn(f64, f64) -> f64) -> Table {
        let lift_coefficient = Axis::from_step(0.08, 0.75, 0.01).unwrap();
        let mach = Axis::from_step(0.50, 0.95, 0.01).unwrap();
        let grid = Arc::new(Grid::new(lift_coefficient, mach));
        let of = |node| {
            let (lift_coefficient, mach) = grid.coordinates(node);
            drag_coefficient(lift_coefficient, mach)
        };
        Table::new(Arc::clone(&grid), (0..grid.nodes()).map(of).collect()).unwrap()
    }

    fn induced_drag_factor(polar: &Surface, mach: f64) -> f64 {
        let [_, _, _, p3, p4, p5] = polar.coefficients;
        p3 + p4 * mach + p5 * mach * mach
    }

    /// Oracle: Lock's law in its textbook form (Mason, *Configuration Aerodynamics*, section 7), with another fall of the
    /// drag-divergence Mach number than the library's, on a CD0 and a K of OpenAP's A320.
    #[test]
    fn a_drag_rise_is_neither_friction_nor_lift() {
        let airliner = |lift_coefficient: f64, mach: f64| {
            let critical_mach = 0.815 - 0.10 * (lift_coefficient - 0.50) - 0.1077;
            0.0226
                + 0.039 * lift_coefficient.powi(2)
                + 20.0 * (mach - critical_mach).max(0.0).powi(4)
        };
        let table = table_of(airliner);
        let polar = fit_polar(&table).unwrap();
        for mach in [0.72, 0.76, 0.80] {
            let factor = induced_drag_factor(&polar, mach);
            assert!((factor / 0.039 - 1.0).abs() < 0.10, "K({mach}) = {factor}");
            let zero_lift = polar.value(0.0, mach);
            assert!((zero_lift / 0.0226 - 1.0).abs() < 0.02, "CD0({mach}) = {zero_lift}");
        }
    }

    /// By construction: a table that is a polynomial has its coefficients.
    #[test]
    fn a_polynomial_has_no_drag_rise() {
        let polynomial = Surface {
            basis: Basis::SeparableQuadratic,
            coefficients: [0.031, -0.035, 0.028, 0.31, -0.72, 0.51],
        };
        let polar = fit_polar(&table_of(|x, y| polynomial.value(x, y))).unwrap();
        for (found, made) in polar.coefficients.iter().zip(&polynomial.coefficients) {
            assert!((found - made).abs() < 1e-10, "{found} {made}");
        }
    }
}
