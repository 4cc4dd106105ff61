//! Means of directions, where 359° and 1° are close to each other.

use crate::convert::RADIANS_PER_DEGREE;

/// Length of the mean unit vector below which directions cancel and have no mean.
const RESULTANT_MINIMUM: f64 = 1e-9;

/// Mean direction (circular mean) of angles in degrees, from 0 to below 360.
///
/// ```text
/// mean = atan2(Σ sin φ, Σ cos φ)
/// ```
///
/// `None` without a direction, and where they cancel (mean unit vector shorter than 1e-9): 0° and 180° have no mean.
/// The sums run in the order given.
///
/// # Source
/// K. V. Mardia, P. E. Jupp, *Directional Statistics*, Wiley 2000, section 2.2.
#[must_use]
pub fn mean_direction_deg(directions_deg: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (mut sine_sum, mut cosine_sum, mut count) = (0.0, 0.0, 0_u32);
    for direction_deg in directions_deg {
        let (sine, cosine) = (direction_deg * RADIANS_PER_DEGREE).sin_cos();
        sine_sum += sine;
        cosine_sum += cosine;
        count += 1;
    }
    if count == 0 || sine_sum.hypot(cosine_sum) < RESULTANT_MINIMUM * f64::from(count) {
        return None;
    }
    let mean_deg = sine_sum.atan2(cosine_sum) / RADIANS_PER_DEGREE;
    let positive_deg = if mean_deg < 0.0 { mean_deg + 360.0 } else { mean_deg };
    // A tiny negative mean plus 360 rounds to 360 itself.
    Some(if positive_deg < 360.0 { positive_deg } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(directions_deg: &[f64], expected_deg: f64) {
        let mean = mean_direction_deg(directions_deg.iter().copied()).unwrap();
        assert!((mean - expected_deg).abs() < 1e-12, "{directions_deg:?}: {mean}");
    }

    #[test]
    fn means_across_north_and_the_date_line() {
        check(&[350.0, 20.0], 5.0);
        check(&[-10.0, 20.0], 5.0);
        check(&[179.0, -177.0], 181.0);
        check(&[42.5], 42.5);
        // Three unit vectors by hand: Σ sin = 1, Σ cos = 2, atan2(1, 2) = 26.565 051 177 077 99°.
        check(&[0.0, 0.0, 90.0], 26.565_051_177_077_99);
    }

    #[test]
    fn never_360_and_nothing_where_directions_cancel() {
        assert_eq!(mean_direction_deg([-1e-20]), Some(0.0));
        assert_eq!(mean_direction_deg([0.0, 180.0]), None);
        assert_eq!(mean_direction_deg([]), None);
    }
}
