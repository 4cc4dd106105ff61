//! How much an error of the fitted points grows in the fitted surface.

use lut::surface::{Basis, COEFFICIENTS};

/// The point where errors grow most.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worst {
    /// Standard deviation of the surface there, relative to that of a fitted point.
    pub(super) factor: f64,
    /// The point.
    pub(super) at: (f64, f64),
}

/// Where, among `judged`, independent errors of the fitted points grow most.
///
/// ```text
/// √(b'(X'X)⁻¹b) = |R'⁻¹b|,  X = QR the design, b the basis at the point
/// ```
pub(super) fn worst(
    basis: Basis,
    points: &[(f64, f64, f64, f64)],
    judged: impl Iterator<Item = (f64, f64)>,
) -> Worst {
    let triangle = triangle(points.iter().map(|&(x, y, _, _)| basis.row(x, y)).collect());
    let start = Worst { factor: 0.0, at: (f64::NAN, f64::NAN) };
    judged.fold(start, |worst, at| {
        let factor = factor(&triangle, &basis.row(at.0, at.1));
        // NaN, from a triangle with a zero on its diagonal, counts as the worst.
        if factor > worst.factor || factor.is_nan() { Worst { factor, at } } else { worst }
    })
}

/// R of the design, by modified Gram–Schmidt: R is as accurate as with Householder reflections.
fn triangle(mut rows: Vec<[f64; COEFFICIENTS]>) -> [[f64; COEFFICIENTS]; COEFFICIENTS] {
    let mut triangle = [[0.0; COEFFICIENTS]; COEFFICIENTS];
    for k in 0..COEFFICIENTS {
        let length = rows.iter().map(|row| row[k] * row[k]).sum::<f64>().sqrt();
        triangle[k][k] = length;
        for row in &mut rows {
            row[k] /= length;
        }
        for j in k + 1..COEFFICIENTS {
            let projection: f64 = rows.iter().map(|row| row[k] * row[j]).sum();
            triangle[k][j] = projection;
            for row in &mut rows {
                row[j] -= projection * row[k];
            }
        }
    }
    triangle
}

/// |R'⁻¹b| by forward substitution.
fn factor(triangle: &[[f64; COEFFICIENTS]; COEFFICIENTS], basis_row: &[f64; COEFFICIENTS]) -> f64 {
    let mut solution = [0.0; COEFFICIENTS];
    for k in 0..COEFFICIENTS {
        let known: f64 = (0..k).map(|j| triangle[j][k] * solution[j]).sum();
        solution[k] = (basis_row[k] - known) / triangle[k][k];
    }
    solution.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nine points of a full 3 × 3 factorial on {−1, 0, 1}².
    fn factorial() -> Vec<(f64, f64, f64, f64)> {
        (0..9).map(|i| (f64::from(i / 3) - 1.0, f64::from(i % 3) - 1.0, 0.0, 1.0)).collect()
    }

    #[test]
    fn the_textbook_factorial_design() {
        // Box & Draper, response surfaces: the variance function of the 3² factorial for the full quadratic is
        // σ²·5/9 at the center and σ²·(29/36) at a corner.
        let points = factorial();
        let at = |x, y| worst(Basis::FullQuadratic, &points, core::iter::once((x, y))).factor;
        assert!((at(0.0, 0.0).powi(2) - 5.0 / 9.0).abs() < 1e-12);
        assert!((at(1.0, 1.0).powi(2) - 29.0 / 36.0).abs() < 1e-12, "{}", at(1.0, 1.0).powi(2));
    }

    #[test]
    fn the_worst_is_found_where_it_is() {
        let judged = [(0.0, 0.0), (3.0, 3.0), (1.0, 0.0)];
        let worst = worst(Basis::FullQuadratic, &factorial(), judged.into_iter());
        assert_eq!(worst.at, (3.0, 3.0));
        // The same design's variance function 5/9 + r²/6 − 2r²/3 + (x⁴ + y⁴)/2 + x²y²/4 at (3, 3): 92.805 556.
        assert!((worst.factor.powi(2) - 92.805_555_555_6).abs() < 1e-9);
    }
}
