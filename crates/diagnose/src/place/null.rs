//! The largest deviation that noise alone makes of any region.

use crate::place::regions::{Search, Sums};

/// Standard deviation of every region's sum, and in each draw the largest statistic of any region.
pub(crate) struct Null {
    deviations: Vec<f64>,
    largest: Vec<f64>,
    /// Statistic of everywhere, which is not a region and takes no part in the search.
    everywhere: Vec<f64>,
}

impl Null {
    /// From sums of squares over draws.
    pub(crate) fn new(squares: &[f64], draws: usize) -> Self {
        let deviations = squares.iter().map(|square| (square / draws as f64).sqrt()).collect();
        Self { deviations, largest: vec![], everywhere: vec![] }
    }

    /// Statistic of a region: its sum over the standard deviation that noise gives it, weighed by its conditions.
    pub(crate) fn statistic(&self, search: &Search<'_>, index: usize, sum: f64) -> f64 {
        let deviation = self.deviations[index];
        if deviation > 0.0 { sum.abs() / deviation * search.regions[index].weight() } else { 0.0 }
    }

    /// Adds draws that took no part in the standard deviations.
    pub(crate) fn add(&mut self, search: &Search<'_>, sums: &Sums) {
        let mut largest = vec![0.0_f64; sums.width];
        let mut everywhere = Vec::with_capacity(sums.width);
        search.for_each(sums, |index, sums| {
            let deviation = self.deviations[index];
            if search.regions[index].is_everywhere() {
                let of = |sum: &f64| self.statistic(search, index, *sum);
                everywhere.extend(sums.iter().map(of));
            } else if deviation > 0.0 {
                let by = search.regions[index].weight() / deviation;
                for (slot, sum) in largest.iter_mut().zip(sums) {
                    *slot = slot.max(by * sum.abs());
                }
            }
        });
        self.largest.extend(largest);
        self.everywhere.extend(everywhere);
    }

    /// Probability that noise alone makes as large a statistic somewhere.
    ///
    /// ```text
    /// p = (1 + number of draws with max T ≥ T)/(1 + number of draws)                              [diagnosis.26]
    /// ```
    pub(crate) fn p_value(&self, statistic: f64) -> f64 {
        p_value(&self.largest, statistic)
    }

    /// Probability that noise alone makes as large a level.
    pub(crate) fn p_value_everywhere(&self, statistic: f64) -> f64 {
        p_value(&self.everywhere, statistic)
    }
}

fn p_value(of_noise: &[f64], statistic: f64) -> f64 {
    let above = of_noise.iter().filter(|value| **value >= statistic).count();
    (1.0 + above as f64) / (1.0 + of_noise.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: of 99 draws four are as large or larger, so that five of a hundred are, the gap itself among them.
    #[test]
    fn p_values_by_counting() {
        let of_noise: Vec<f64> = (1..=99).map(f64::from).collect();
        for (statistic, expected) in [(96.0, 0.05), (96.5, 0.04), (1000.0, 0.01), (0.0, 1.0)] {
            assert!((p_value(&of_noise, statistic) - expected).abs() < 1e-15, "{statistic}");
        }
    }
}
