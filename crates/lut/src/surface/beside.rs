//! A surface beside one function of another form, of which it is not known how much there is.

use nalgebra::DVector;

use super::{Basis, Fit, FitError, check, fit, weighted};

/// Part of a function's length that the surface's basis must leave, or its share would be a matter of rounding. Our choice.
const LEAST_LEFT: f64 = 1e-6;

/// A surface, and what lies beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitBeside {
    /// The surface, fitted to the points less the share of the function.
    pub fit: Fit,
    /// Which of the functions lies beside it, and its positive share; none where none makes the squares smaller.
    pub beside: Option<(usize, f64)>,
}

/// Fits a surface and a share of one of several functions to points `(x, y, z, weight)`.
///
/// ```text
/// minimise Σ weight·(z − surface(x, y) − a·f_j(x, y))²  over the coefficients, a ≥ 0 and j     [tables.12]
/// ```
///
/// With Q the orthonormal columns of the surface's weighted design, the share of a function is that of its part that Q leaves in
/// the part of z that Q leaves, a = f̃·z̃/f̃·f̃, and the squares fall by (f̃·z̃)²/f̃·f̃: one decomposition serves all functions.
///
/// # Errors
/// As [`fit`].
///
/// # Source
/// Frisch and Waugh 1933; Lovell 1963: partial regression.
pub fn fit_beside<F: Fn(f64, f64) -> f64>(
    basis: Basis,
    points: &[(f64, f64, f64, f64)],
    functions: &[F],
) -> Result<FitBeside, FitError> {
    check(basis, points)?;
    let (design, target) = weighted(basis, points);
    let orthonormal = design.qr().q();
    let left_of = |values: &DVector<f64>| values - &orthonormal * orthonormal.tr_mul(values);
    let target = left_of(&target);
    let mut best: Option<(usize, DVector<f64>)> = None;
    let mut most = 0.0;
    for (index, function) in functions.iter().enumerate() {
        let values = points.iter().map(|&(x, y, _, weight)| weight.sqrt() * function(x, y));
        let values = DVector::from_iterator(points.len(), values);
        let length = values.norm_squared();
        // ‖f̃‖² = ‖f‖² − ‖Q'f‖² to a ten thousandth where it is least, which is enough to choose; f̃·z̃ = f·z̃.
        let squares = length - orthonormal.tr_mul(&values).norm_squared();
        let along = values.dot(&target);
        if squares <= LEAST_LEFT * LEAST_LEFT * length || along <= 0.0 {
            continue;
        }
        let fall = along * along / squares;
        if fall > most {
            most = fall;
            best = Some((index, values));
        }
    }
    let Some((index, values)) = best else {
        return Ok(FitBeside { fit: fit(basis, points)?, beside: None });
    };
    let left = left_of(&values);
    let share = left.dot(&target) / left.norm_squared();
    let without: Vec<_> = points
        .iter()
        .map(|&(x, y, z, weight)| (x, y, z - share * functions[index](x, y), weight))
        .collect();
    Ok(FitBeside { fit: fit(basis, &without)?, beside: Some((index, share)) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(value: impl Fn(f64, f64) -> f64) -> Vec<(f64, f64, f64, f64)> {
        (0..40)
            .map(|i| (0.1 * f64::from(i % 8), 0.5 + 0.1 * f64::from(i / 8)))
            .map(|(x, y)| (x, y, value(x, y), 1.0 + x))
            .collect()
    }

    fn surface(x: f64, y: f64) -> f64 {
        0.02 + 0.01 * y + (0.05 + 0.03 * y * y) * x * x
    }

    /// By construction: what the points are made of comes back.
    #[test]
    fn what_lies_beside_a_surface_is_found_and_taken_away() {
        let steep = |x: f64, y: f64| (y + 0.1 * x - 0.75).max(0.0).powi(4);
        let late = |_: f64, y: f64| (y - 0.85).max(0.0);
        let none = |_: f64, _: f64| 0.0;
        let functions: [&dyn Fn(f64, f64) -> f64; 3] = [&none, &late, &steep];
        let found = fit_beside(
            Basis::SeparableQuadratic,
            &points(|x, y| surface(x, y) + 7.0 * steep(x, y)),
            &functions,
        )
        .unwrap();
        let (index, share) = found.beside.unwrap();
        assert_eq!(index, 2);
        assert!((share - 7.0).abs() < 1e-9, "{share}");
        assert!((found.fit.surface.value(0.33, 0.87) - surface(0.33, 0.87)).abs() < 1e-12);
    }

    /// Oracle: dense algebra, all seven columns in one normal equation.
    #[test]
    fn a_share_is_that_of_one_least_squares_fit() {
        let bend = |x: f64, y: f64| (y - 0.7 + 0.2 * x).max(0.0).powi(3);
        let all =
            points(|x, y| surface(x, y) + 2.0 * bend(x, y) + 0.003 * (37.0 * x + 11.0 * y).sin());
        let found = fit_beside(Basis::SeparableQuadratic, &all, &[bend]).unwrap();
        let (_, share) = found.beside.unwrap();
        let mut normal = nalgebra::DMatrix::<f64>::zeros(7, 7);
        let mut right = DVector::<f64>::zeros(7);
        for &(x, y, z, weight) in &all {
            let mut row = Basis::SeparableQuadratic.row(x, y).to_vec();
            row.push(bend(x, y));
            let row = DVector::from_vec(row);
            normal += weight * &row * row.transpose();
            right += weight * z * row;
        }
        let dense = normal.full_piv_lu().solve(&right).unwrap();
        assert!((share / dense[6] - 1.0).abs() < 1e-6, "{share} {}", dense[6]);
        for (ours, theirs) in found.fit.surface.coefficients.iter().zip(dense.iter()) {
            assert!((ours - theirs).abs() < 1e-6, "{ours} {theirs}");
        }
    }

    #[test]
    fn a_surface_alone_has_nothing_beside_it_but_rounding() {
        let bend = |_: f64, y: f64| (y - 0.7).max(0.0).powi(4);
        let negative = points(|x, y| surface(x, y) - bend(x, y));
        assert_eq!(fit_beside(Basis::SeparableQuadratic, &negative, &[bend]).unwrap().beside, None);
        let found = fit_beside(Basis::SeparableQuadratic, &points(surface), &[bend]).unwrap();
        assert!(found.beside.is_none_or(|(_, share)| share < 1e-10), "{:?}", found.beside);
        assert!((found.fit.surface.value(0.4, 0.8) - surface(0.4, 0.8)).abs() < 1e-13);
    }
}
