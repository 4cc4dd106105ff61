//! The variance of what a model has learnt, as one quadratic form.

use crate::baseline::Baseline;

/// Covariance of remainder terms, drag rises and loadings of the drag table: the rows of its lower triangle, those beside the
/// diagonal twice.
#[derive(Clone, Debug)]
pub(super) struct Covariance {
    width: usize,
    rows: Vec<f64>,
}

impl Covariance {
    /// `rises` are places among the standing effects.
    pub(super) fn new(baseline: &Baseline, rises: &[usize]) -> Self {
        let layout = baseline.layout();
        let standing = layout.standing_effects.start;
        let columns: Vec<usize> = layout
            .remainder
            .clone()
            .chain(rises.iter().map(|place| standing + place))
            .chain(layout.drag)
            .collect();
        let factor = baseline.factor();
        let mut rows = Vec::with_capacity(columns.len() * (columns.len() + 1) / 2);
        for (place, a) in columns.iter().enumerate() {
            for b in &columns[..=place] {
                let covariance: f64 =
                    (0..=*a.min(b)).map(|k| factor[(*a, k)] * factor[(*b, k)]).sum();
                rows.push(if a == b { covariance } else { 2.0 * covariance });
            }
        }
        Self { width: columns.len(), rows }
    }

    pub(super) const fn width(&self) -> usize {
        self.width
    }

    /// The variance of what leans on its columns so.
    pub(super) fn variance(&self, loadings: &[f64]) -> f64 {
        let mut rest = self.rows.as_slice();
        let mut variance = 0.0;
        for (place, loading) in loadings.iter().enumerate().take(self.width) {
            let (row, behind) = rest.split_at(place + 1);
            variance += loading * dot(row, &loadings[..=place]);
            rest = behind;
        }
        variance.max(0.0)
    }
}

/// Four sums at a time: one sum after the other waits for each addition.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (fours, rest) = a.as_chunks::<4>();
    let (others, other_rest) = b.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (a, b) in fours.iter().zip(others) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let tail: f64 = rest.iter().zip(other_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + tail
}
