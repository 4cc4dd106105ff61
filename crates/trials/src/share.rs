//! Shares with their intervals.

use pipeline::statistics::NORMAL_95;
use serde::{Deserialize, Serialize};

use crate::scored_case::Case;

/// A share with its 95 % interval (Wilson).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// Successes.
    pub count: usize,
    /// Trials.
    pub of: usize,
    /// Their ratio; 0 for no trial.
    pub share: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

impl Share {
    /// Successes among trials, with Wilson's interval.
    ///
    /// # Source
    /// Wilson, J. Am. Stat. Assoc. 22 (1927).
    #[must_use]
    pub fn new(count: usize, of: usize) -> Self {
        if of == 0 {
            return Self { count, of, share: 0.0, ci95: [0.0, 1.0] };
        }
        let z2 = NORMAL_95 * NORMAL_95;
        let (n, p) = (of as f64, count as f64 / of as f64);
        let center = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
        let half = NORMAL_95 / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
        Self { count, of, share: p, ci95: [(center - half).max(0.0), (center + half).min(1.0)] }
    }

    pub(crate) fn among(cases: &[&Case], yes: impl Fn(&Case) -> bool) -> Self {
        Self::new(cases.iter().filter(|case| yes(case)).count(), cases.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilson_by_published_values() {
        // Newcombe, Statistics in Medicine 17 (1998), table I, method 3: 81 of 263, and 0 of 20.
        let share = Share::new(81, 263);
        assert!((share.ci95[0] - 0.2553).abs() < 1e-4, "{share:?}");
        assert!((share.ci95[1] - 0.3662).abs() < 1e-4, "{share:?}");
        let none = Share::new(0, 20);
        assert!(none.ci95[0].abs() < 1e-12 && (none.ci95[1] - 0.1611).abs() < 1e-4, "{none:?}");
    }
}
