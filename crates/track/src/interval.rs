//! The time step of a recording, and where it has gaps.

use core::ops::Range;

use crate::TrackError;

/// Largest median time step at which neighbors still indicate steadiness, s.
pub const SAMPLE_INTERVAL_MAXIMUM_S: f64 = 90.0;
/// A step longer than this many median steps is a gap.
pub const GAP_INTERVALS: f64 = 1.5;
/// Decimal times in binary: what exceeds a limit by no more than this is on it, s.
pub(crate) const TIME_TOLERANCE_S: f64 = 1e-9;

/// Median of the time steps, s. With an even number of steps, the mean of the middle two. `[steadiness.1]`
///
/// `time_s` has at least two values (a [`flight::Report`] has three).
pub(crate) fn median_step_s(time_s: &[f64]) -> f64 {
    let mut steps_s: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps_s.len() / 2;
    let even = steps_s.len().is_multiple_of(2);
    let (below, &mut upper_s, _) = steps_s.select_nth_unstable_by(middle, f64::total_cmp);
    if even {
        let lower_s = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        0.5 * (lower_s + upper_s)
    } else {
        upper_s
    }
}

/// Refuses a recording whose neighbors are too far apart.
pub(crate) fn check_interval(sample_interval_s: f64) -> Result<(), TrackError> {
    if sample_interval_s > SAMPLE_INTERVAL_MAXIMUM_S + TIME_TOLERANCE_S {
        return Err(TrackError::SamplesTooFarApart { sample_interval_s });
    }
    Ok(())
}

/// Maximal series of samples without a step longer than `gap_s`. `[steadiness.2]`
pub(crate) fn split_at_gaps(time_s: &[f64], gap_s: f64) -> Vec<Range<usize>> {
    let mut pieces = Vec::new();
    let mut start = 0;
    for (index, pair) in time_s.windows(2).enumerate() {
        if pair[1] - pair[0] > gap_s + TIME_TOLERANCE_S {
            pieces.push(start..index + 1);
            start = index + 1;
        }
    }
    pieces.push(start..time_s.len());
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_odd_and_even_counts() {
        // By hand: steps 60, 61, 200 → 61; steps 60, 61, 59, 200 → (60 + 61)/2.
        assert!((median_step_s(&[0.0, 60.0, 121.0, 321.0]) - 61.0).abs() < 1e-12);
        assert!((median_step_s(&[0.0, 60.0, 121.0, 180.0, 380.0]) - 60.5).abs() < 1e-12);
        assert!((median_step_s(&[5.0, 35.0]) - 30.0).abs() < 1e-12);
    }

    #[test]
    fn a_step_of_exactly_the_limit_is_no_gap() {
        let time_s = [0.0, 60.0, 150.0, 240.1, 300.0];
        assert_eq!(split_at_gaps(&time_s, 90.0), [0..3, 3..5]);
        // 4.1 min and 5.6 min in seconds: 90.000 000 000 000 03 s apart in binary.
        let decimal_s = [60.0 * 4.1, 60.0 * 5.6];
        assert!(decimal_s[1] - decimal_s[0] > 90.0);
        assert_eq!(split_at_gaps(&decimal_s, 90.0).len(), 1);
    }

    #[test]
    fn ninety_seconds_pass_and_ninety_one_do_not() {
        assert_eq!(check_interval(90.0), Ok(()));
        let error = check_interval(91.0).unwrap_err();
        assert_eq!(
            error.to_string(),
            "median time step 91 s is above 90 s: samples too far apart to judge steadiness, \
             not segmented"
        );
    }
}
