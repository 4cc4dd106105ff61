//! What a six-coefficient polynomial loses of the drag rise of the guide that it was fitted to.

use lut::Grid;
use lut::surface::{Basis, FitError, fit};

use crate::drag::drag_rise;
use crate::polar::divergence_machs;

/// Points along each axis of the guide's range over which a polynomial is fitted to a rise. Our choice: several between two
/// divergence Mach numbers.
const POINTS: u32 = 24;
/// Drag coefficient, rms over the range, below which nothing of a rise is lost. Our choice: a tenth of a drag count.
const NOTHING_LOST: f64 = 1e-5;

/// A range of the flight states that a guide holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideRange {
    /// Smallest and largest lift coefficient.
    pub lift_coefficient: (f64, f64),
    /// Smallest and largest Mach number.
    pub mach: (f64, f64),
}

/// Shapes of what the polynomial loses, one for every drag-divergence Mach number whose rise the range holds: over the nodes of a
/// grid, in drag coefficient, 1 rms over the range.
///
/// ```text
/// r = w(M, CL; Mdd) − p(M, CL),   p the polynomial closest to w over the range                              [diagnosis.59]
/// ```
///
/// # Errors
/// [`FitError`] where a range does not determine the polynomial.
pub fn lost_rises(
    basis: Basis,
    range: &GuideRange,
    grid: &Grid,
) -> Result<Vec<Vec<f64>>, FitError> {
    let states: Vec<(f64, f64)> = steps(range.lift_coefficient)
        .flat_map(|lift| steps(range.mach).map(move |mach| (lift, mach)))
        .collect();
    let mut shapes = Vec::new();
    for divergence_mach in divergence_machs() {
        let rise = |lift: f64, mach: f64| drag_rise(mach, lift, divergence_mach);
        let points: Vec<_> =
            states.iter().map(|&(lift, mach)| (lift, mach, rise(lift, mach), 1.0)).collect();
        let found = fit(basis, &points)?;
        if found.residual_rms < NOTHING_LOST {
            continue;
        }
        let of_node = |node: usize| {
            let (lift, mach) = grid.coordinates(node);
            (rise(lift, mach) - found.surface.value(lift, mach)) / found.residual_rms
        };
        shapes.push((0..grid.nodes()).map(of_node).collect());
    }
    Ok(shapes)
}

/// Evenly from one end to the other.
fn steps((first, last): (f64, f64)) -> impl Iterator<Item = f64> + Clone {
    (0..POINTS).map(move |k| first + (last - first) * f64::from(k) / f64::from(POINTS - 1))
}

#[cfg(test)]
mod tests {
    use lut::Axis;

    use super::*;

    fn grid() -> Grid {
        Grid::new(
            Axis::from_step(0.30, 0.60, 0.05).unwrap(),
            Axis::from_step(0.70, 0.82, 0.01).unwrap(),
        )
    }

    const RANGE: GuideRange = GuideRange { lift_coefficient: (0.30, 0.60), mach: (0.70, 0.82) };

    /// Oracle: the normal equations. What least squares leaves has no part of any of the six functions: over the points of the fit
    /// its products with them vanish; there it is 1 rms.
    #[test]
    fn what_is_lost_has_no_part_of_the_polynomial() {
        let fine = Grid::new(
            Axis::new(steps(RANGE.lift_coefficient).collect()).unwrap(),
            Axis::new(steps(RANGE.mach).collect()).unwrap(),
        );
        let shapes = lost_rises(Basis::SeparableQuadratic, &RANGE, &fine).unwrap();
        assert!(shapes.len() > 3, "{}", shapes.len());
        for shape in shapes {
            let mean = |of: &dyn Fn(usize) -> f64| {
                (0..fine.nodes()).map(of).sum::<f64>() / fine.nodes() as f64
            };
            assert!((mean(&|node| shape[node] * shape[node]) - 1.0).abs() < 1e-9);
            for term in 0..6 {
                let with = |node: usize| {
                    let (lift, mach) = fine.coordinates(node);
                    shape[node] * Basis::SeparableQuadratic.row(lift, mach)[term]
                };
                assert!(mean(&with).abs() < 1e-9, "{}", mean(&with));
            }
        }
    }

    /// By hand: a rise that begins above Mach 0.82 at every lift coefficient of the range is zero there.
    #[test]
    fn rises_beyond_the_range_are_not_among_them() {
        let begins = |divergence_mach: f64| divergence_mach - 0.1077 - 0.085 * (0.60 - 0.35);
        let within = divergence_machs().filter(|&mach| begins(mach) < RANGE.mach.1).count();
        let shapes = lost_rises(Basis::SeparableQuadratic, &RANGE, &grid()).unwrap();
        assert!(!shapes.is_empty() && shapes.len() <= within, "{} {within}", shapes.len());
        assert!(within < divergence_machs().count());
    }
}
