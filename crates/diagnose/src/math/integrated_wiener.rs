//! The integrated Wiener process: what is not known of a smooth function beyond the last place where it was seen.

/// Covariance at two signed distances from where it begins, 1 at 1; none between its two sides.
///
/// ```text
/// cov(a, b) = a²·(3b − a)/2,  0 ≤ a ≤ b
/// ```
///
/// # Source
/// Rasmussen and Williams 2006, equation 6.28, three times.
pub(crate) fn covariance(one: f64, other: f64) -> f64 {
    if one * other <= 0.0 {
        return 0.0;
    }
    let (a, b) = (one.abs().min(other.abs()), one.abs().max(other.abs()));
    0.5 * a * a * (3.0 * b - a)
}

#[cfg(test)]
mod tests {
    use super::covariance;

    /// The oracle is the integral of which it is made, 3·∫(a − u)·(b − u) du from 0 to a, by Simpson's rule, exact for squares.
    #[test]
    fn covariance_of_integrals() {
        for (a, b) in [(1.0, 1.0), (0.3, 0.7), (2.0, 5.0)] {
            let inside = |u: f64| 3.0 * (a - u) * (b - u);
            let expected = a / 6.0 * (inside(0.0) + 4.0 * inside(0.5 * a) + inside(a));
            for (one, other) in [(a, b), (b, a), (-a, -b)] {
                let found: f64 = covariance(one, other);
                assert!((found - expected).abs() < 1e-12, "{one} {other}: {found} {expected}");
            }
            assert!(covariance(-a, b).abs() + covariance(0.0, b).abs() < 1e-300);
        }
    }
}
