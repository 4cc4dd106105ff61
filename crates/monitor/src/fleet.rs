//! A mean over tails, whose own levels differ.

use crate::levels::Estimate;

/// The mean of a fleet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FleetMean {
    /// Mean over tails. Its standard deviation is that of few tails: its interval is Student's, with one degree of freedom less than
    /// there are tails ([`Self::freedom`]).
    pub mean: Estimate,
    /// Standard deviation between tails beyond the uncertainty of each.
    pub between_tails: f64,
    /// Number of tails.
    pub tails: usize,
}

impl FleetMean {
    /// Degrees of freedom of Student's distribution for the mean; none for a tail alone, whose own interval is normal.
    #[must_use]
    pub const fn freedom(&self) -> usize {
        self.tails.saturating_sub(1)
    }
}

/// Mean over tails by the method of moments of `DerSimonian` and Laird (1986, Controlled Clinical Trials 7, 177–188): each tail
/// has a level of its own, known to within its standard deviation. `None` without a tail.
///
/// The spread between few tails is itself hardly known, so that the mean's variance is that of the weighted residuals, but not below
/// that of the method: Hartung and Knapp (2001, Statistics in Medicine 20, 1771–1782), as modified by Röver, Knapp and Friede (2015,
/// BMC Medical Research Methodology 15, 99).
///
/// ```text
/// w = 1/s²,  Q = Σ w(y − ȳ)²,  τ² = max(0, (Q − (k − 1))/(Σw − Σw²/Σw)),  mean with 1/(s² + τ²)  [monitoring.14]
/// w' = 1/(s² + τ²),  variance = max(1, Σ w'(y − mean)²/(k − 1))/Σw',  interval by t(k − 1)          [monitoring.19]
/// ```
#[must_use]
pub fn fleet_mean(tails: &[Estimate]) -> Option<FleetMean> {
    if tails.is_empty() {
        return None;
    }
    let weighted = |extra: f64| {
        let weights = tails.iter().map(move |tail| 1.0 / (tail.deviation.powi(2) + extra));
        let sum: f64 = weights.clone().sum();
        let mean = weights.clone().zip(tails).map(|(w, tail)| w * tail.value).sum::<f64>() / sum;
        (weights, sum, mean)
    };
    let (weights, sum, mean) = weighted(0.0);
    let squares: f64 = weights.clone().map(|w| w * w).sum();
    let spread: f64 = weights.zip(tails).map(|(w, tail)| w * (tail.value - mean).powi(2)).sum();
    let room = sum - squares / sum;
    let excess = spread - (tails.len() as f64 - 1.0);
    let between = if room > 0.0 { (excess / room).max(0.0) } else { 0.0 };
    let (weights, sum, mean) = weighted(between);
    let residuals: f64 = weights.zip(tails).map(|(w, tail)| w * (tail.value - mean).powi(2)).sum();
    let freedom = tails.len().saturating_sub(1).max(1) as f64;
    let variance = (residuals / freedom).max(1.0) / sum;
    Some(FleetMean {
        mean: Estimate { value: mean, deviation: variance.sqrt() },
        between_tails: between.sqrt(),
        tails: tails.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 1 and 3, each ± 0.5: w = 4, mean 2, Q = 8, τ² = (8 − 1)/(8 − 4) = 1.75, variance (0.25 + 1.75)/2 = 1.
    #[test]
    fn two_tails_by_hand() {
        let tail = |value| Estimate { value, deviation: 0.5 };
        let fleet = fleet_mean(&[tail(1.0), tail(3.0)]).unwrap();
        assert!((fleet.mean.value - 2.0).abs() < 1e-12);
        assert!((fleet.mean.deviation - 1.0).abs() < 1e-12);
        assert!((fleet.between_tails - 1.75_f64.sqrt()).abs() < 1e-12);
        assert_eq!(fleet.freedom(), 1);
        let alone = fleet_mean(&[tail(1.0)]).unwrap();
        assert_eq!((alone.mean, alone.between_tails), (tail(1.0), 0.0));
        assert!(fleet_mean(&[]).is_none());
    }

    /// By hand: 0, 0 and 3, each ± 1: w = 1, mean 1, Q = 6, τ² = (6 − 2)/(3 − 1) = 2; w' = 1/3, residuals (1 + 1 + 4)/3 = 2, over
    /// 2 degrees of freedom 1: the variance is 1/Σw' = 1. With ± 0.1 they agree with the spread of the tails, √3/√3.
    #[test]
    fn few_tails_by_hand() {
        let with = |deviation| {
            fleet_mean(&[0.0, 0.0, 3.0].map(|value| Estimate { value, deviation })).unwrap().mean
        };
        assert!((with(1.0).value - 1.0).abs() < 1e-12 && (with(1.0).deviation - 1.0).abs() < 1e-12);
        assert!((with(0.1).deviation - 1.0).abs() < 1e-9);
    }
}
