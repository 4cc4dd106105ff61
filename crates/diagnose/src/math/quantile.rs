//! Quantiles of sorted numbers, each caller with the definition that it was measured with.
//!
//! # Source
//! Hyndman, R. J., and Fan, Y.: Sample quantiles in statistical packages. The American Statistician 50 (1996), 361–365.

/// Which number a quantile is where it falls between two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum QuantileType {
    /// Type 7 of Hyndman and Fan: linear between the numbers about position (n − 1)·p, counted from 0.
    Type7,
    /// The number nearest to the position of type 7, of two equally near ones the upper: always one that was observed.
    NearestToType7,
    /// The number at position ⌊n·p⌋, counted from 0: type 1 of Hyndman and Fan but for whole n·p, where it is the next one.
    UpperType1,
}

/// The quantile of sorted numbers at a share from 0 to 1; NaN of none.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a length")]
pub(crate) fn quantile(sorted: &[f64], share: f64, kind: QuantileType) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = share * last as f64;
    match kind {
        QuantileType::Type7 => {
            let low = at.floor() as usize;
            let high = (low + 1).min(last);
            sorted[low] + (at - low as f64) * (sorted[high] - sorted[low])
        }
        QuantileType::NearestToType7 => sorted[(at.round() as usize).min(last)],
        QuantileType::UpperType1 => sorted[((share * sorted.len() as f64) as usize).min(last)],
    }
}

/// Standard deviation over the median distance from the median, of a normal distribution: 1/Φ⁻¹(¾).
pub(crate) const MEDIAN_TO_DEVIATION: f64 = 1.482_602_218_505_602;

/// The median by type 7, 0 of none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    if values.is_empty() { 0.0 } else { quantile(&values, 0.5, QuantileType::Type7) }
}

/// The interval that holds 95 % of some numbers, its ends among them: positions of type 7 rounded outwards. Their order changes.
pub(crate) fn central_95(values: &mut [f64]) -> [f64; 2] {
    let Some(last) = values.len().checked_sub(1) else { return [f64::NAN; 2] };
    let left_out = last / 40;
    // In this order: the second choice moves only what lies above the first.
    let (_, low, above) = values.select_nth_unstable_by(left_out, f64::total_cmp);
    let low = *low;
    let Some(highest) = above.len().checked_sub(1) else { return [low; 2] };
    let (_, high, _) = above.select_nth_unstable_by(highest - left_out, f64::total_cmp);
    [low, *high]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_by_hand() {
        let sorted = [1.0, 2.0, 3.0, 4.0, 5.0];
        for (share, value) in [(0.0, 1.0), (0.1, 1.0), (0.5, 3.0), (0.9, 5.0), (1.0, 5.0)] {
            let found = quantile(&sorted, share, QuantileType::NearestToType7);
            assert!((found - value).abs() < f64::EPSILON, "{share}");
        }
        // 4·0.1 = 0.4 of the way from 1 to 2; of 1, 2, 3, 4 the upper median is 3, the linear one 2.5.
        assert!((quantile(&sorted, 0.1, QuantileType::Type7) - 1.4).abs() < 1e-15);
        assert!((quantile(&sorted[..4], 0.5, QuantileType::UpperType1) - 3.0).abs() < 1e-15);
        assert!((quantile(&sorted[..4], 0.5, QuantileType::Type7) - 2.5).abs() < 1e-15);
        assert!(quantile(&[], 0.5, QuantileType::Type7).is_nan());
    }

    #[test]
    fn an_interval_leaves_out_a_fortieth_at_each_end() {
        // 0 to 999: 999/40 = 24 numbers are left out below, and as many above.
        // 7 and 1000 have no divisor in common: all of them, shuffled.
        let mut shuffled: Vec<f64> = (0..1000).map(|k| f64::from(7 * k % 1000)).collect();
        let [low, high] = central_95(&mut shuffled);
        assert!((low - 24.0).abs() < 1e-12 && (high - 975.0).abs() < 1e-12, "{low} {high}");
        let [low, high] = central_95(&mut [3.0, 1.0, 2.0]);
        assert!((low - 1.0).abs() < 1e-12 && (high - 3.0).abs() < 1e-12, "{low} {high}");
        let [low, high] = central_95(&mut [5.0]);
        assert!((low - 5.0).abs() < 1e-12 && (high - 5.0).abs() < 1e-12, "{low} {high}");
    }
}
