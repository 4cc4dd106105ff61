//! The four figures by which errors are reported, and the order in which they are summed.

use serde::{Deserialize, Serialize};

/// Half width of a two-sided 95 % interval of a normal distribution, in standard deviations; two decimals, as tables and
/// text books have it, so that intervals can be checked by hand.
pub const NORMAL_95: f64 = 1.96;

/// Mean, standard deviation (n − 1), largest absolute value and number of errors, all in per cent.
///
/// An empty set has no mean, a single error no standard deviation: `None`, `null` in JSON.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorStatistics {
    /// Arithmetic mean.
    pub mean: Option<f64>,
    /// Standard deviation with n − 1.
    pub std: Option<f64>,
    /// Largest absolute value.
    pub max_abs: Option<f64>,
    /// Number of errors.
    pub n: usize,
}

impl ErrorStatistics {
    /// Statistics of errors, summed in the order given.
    pub fn of(errors_percent: &[f64]) -> Self {
        let n = errors_percent.len();
        if n == 0 {
            return Self { mean: None, std: None, max_abs: None, n };
        }
        let mean = errors_percent.iter().sum::<f64>() / n as f64;
        let squares: f64 = errors_percent.iter().map(|error| (error - mean).powi(2)).sum();
        let max_abs = errors_percent.iter().fold(0.0_f64, |max, error| max.max(error.abs()));
        Self {
            mean: Some(mean),
            std: (n > 1).then(|| (squares / (n as f64 - 1.0)).sqrt()),
            max_abs: Some(max_abs),
            n,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hand_computed() {
        // Mean of 1, 2, 6 is 3; squares 4 + 1 + 9 = 14; 14 / 2 = 7.
        let statistics = ErrorStatistics::of(&[1.0, 2.0, 6.0]);
        assert_eq!(statistics.mean, Some(3.0));
        assert!((statistics.std.unwrap() - 7.0_f64.sqrt()).abs() < 1e-15);
        assert_eq!(statistics.max_abs, Some(6.0));
    }

    #[test]
    fn too_few_say_nothing() {
        assert_eq!(ErrorStatistics::of(&[]).mean, None);
        let one = ErrorStatistics::of(&[-2.0]);
        assert_eq!((one.mean, one.std, one.max_abs), (Some(-2.0), None, Some(2.0)));
    }
}
