//! The four figures by which errors are reported, and the order in which they are summed.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// As monitoring has it.
pub use monitor::NORMAL_95;

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
    pub fn from_errors(errors_percent: &[f64]) -> Self {
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

/// Half width of the 95 % interval of the mean of all errors, for errors that a flight has in common (load sheet, heating
/// value, sensors); `None` for fewer than two flights with errors.
///
/// ```text
/// s² = K/(K − 1) · Σ_k [Σ_i (e_ki − ē)]² / N²,   half width = t(0.975, K − 1) · s
/// ```
///
/// The cluster-robust variance of a mean over K flights with N errors in all (Liang and Zeger 1986, with their correction for
/// few clusters), with Student's quantile because K is often small.
pub fn mean_half_width95_by_flight(flights: &[ErrorStatistics]) -> Option<f64> {
    let sums: Vec<(f64, f64)> = flights
        .iter()
        .filter_map(|flight| Some((flight.mean? * flight.n as f64, flight.n as f64)))
        .collect();
    let count = sums.len() as f64;
    let errors: f64 = sums.iter().map(|(_, n)| n).sum();
    let mean = sums.iter().map(|(sum, _)| sum).sum::<f64>() / errors;
    let squares: f64 = sums.iter().map(|(sum, n)| (sum - n * mean).powi(2)).sum();
    let quantile = students_quantile975(count - 1.0)?;
    Some(quantile * (count / (count - 1.0) * squares).sqrt() / errors)
}

/// Student's 0.975 quantile of so many degrees of freedom: half a 95 % interval in standard deviations; `None` below one.
pub(crate) fn students_quantile975(freedom: f64) -> Option<f64> {
    let student = StudentsT::new(0.0, 1.0, freedom).ok().filter(|_| freedom >= 1.0)?;
    Some(student.inverse_cdf(0.975))
}

/// Fuel factor − 1 in per cent, of a mean error in per cent *of recorded* fuel flow: what predicted fuel flow must be
/// multiplied by to be the recorded one.
///
/// ```text
/// e = 100 (recorded − predicted)/recorded   →   factor = recorded/predicted = 1/(1 − e/100)
/// ```
pub fn fuel_factor_percent(error_percent: f64) -> f64 {
    100.0 * (1.0 / (1.0 - error_percent / 100.0) - 1.0)
}

/// The error in per cent of recorded fuel flow that a fuel factor stands for: [`fuel_factor_percent`] turned round.
pub fn error_percent(fuel_factor_percent: f64) -> f64 {
    100.0 * fuel_factor_percent / (100.0 + fuel_factor_percent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hand_computed() {
        // Mean of 1, 2, 6 is 3; squares 4 + 1 + 9 = 14; 14 / 2 = 7.
        let statistics = ErrorStatistics::from_errors(&[1.0, 2.0, 6.0]);
        assert_eq!(statistics.mean, Some(3.0));
        assert!((statistics.std.unwrap() - 7.0_f64.sqrt()).abs() < 1e-15);
        assert_eq!(statistics.max_abs, Some(6.0));
    }

    #[test]
    fn too_few_say_nothing() {
        assert_eq!(ErrorStatistics::from_errors(&[]).mean, None);
        let one = ErrorStatistics::from_errors(&[-2.0]);
        assert_eq!((one.mean, one.std, one.max_abs), (Some(-2.0), None, Some(2.0)));
    }

    #[test]
    fn an_interval_by_flight() {
        // Flights of equal length: the t interval of their means. Means 1, 2, 6: s = √7, t(0.975, 2) = 4.302653 (table).
        let flights = [[0.5, 1.5], [2.0, 2.0], [5.0, 7.0]]
            .map(|errors| ErrorStatistics::from_errors(&errors));
        let half = mean_half_width95_by_flight(&flights).unwrap();
        assert!((half - 4.302_653 * (7.0_f64 / 3.0).sqrt()).abs() < 1e-5, "{half}");
        assert_eq!(mean_half_width95_by_flight(&flights[..1]), None);
        assert_eq!(mean_half_width95_by_flight(&[]), None);
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "rounded by the same rule: exact")]
    fn a_fuel_factor_is_of_predicted_fuel() {
        // Recorded 109, predicted 100: 8.2569 % of the recorded flow, 9 % of the predicted one.
        assert!((fuel_factor_percent(100.0 * 9.0 / 109.0) - 9.0).abs() < 1e-12);
        assert_eq!(fuel_factor_percent(0.0), 0.0);
        assert!((error_percent(9.0) - 100.0 * 9.0 / 109.0).abs() < 1e-12);
    }
}
