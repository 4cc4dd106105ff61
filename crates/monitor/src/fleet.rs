//! A mean over tails, whose own levels differ.

use crate::levels::Estimate;

/// The mean of a fleet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FleetMean {
    /// Mean over tails.
    pub mean: Estimate,
    /// Standard deviation between tails beyond the uncertainty of each.
    pub between_tails: f64,
    /// Number of tails.
    pub tails: usize,
}

/// Mean over tails by the method of moments of `DerSimonian` and Laird (1986, Controlled Clinical Trials 7, 177–188): each tail
/// has a level of its own, known to within its standard deviation. `None` without a tail.
///
/// ```text
/// w = 1/s²,  Q = Σ w(y − ȳ)²,  τ² = max(0, (Q − (k − 1))/(Σw − Σw²/Σw)),  mean with 1/(s² + τ²)  [monitoring.14]
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
    let (_, sum, mean) = weighted(between);
    Some(FleetMean {
        mean: Estimate { value: mean, deviation: sum.powf(-0.5) },
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
        let alone = fleet_mean(&[tail(1.0)]).unwrap();
        assert_eq!((alone.mean, alone.between_tails), (tail(1.0), 0.0));
        assert!(fleet_mean(&[]).is_none());
    }
}
