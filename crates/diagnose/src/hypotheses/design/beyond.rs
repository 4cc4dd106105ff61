//! What a taught model does not know beyond what its flights flew, as columns of the nuisance.

use crate::baseline::Baseline;
use crate::math::integrated_wiener::covariance;
use crate::residuals::rows::SegmentRow;

/// Columns of one variable on one side of what was flown.
const COLUMNS: usize = 3;

/// The smooth functions of a baseline beyond what was flown, as far as the segments at hand go: there each is an integrated Wiener
/// process, of which three places, evenly up to the farthest segment, are columns.
///
/// ```text
/// cov(a, b) = σ²·g·a²·(3b − a)/2,  a ≤ b lengths beyond,  g the growth of [baseline.1];  φ(b) = L⁻¹·cov(Z, b),  LLᵀ = cov(Z, Z)  [diagnosis.63]
/// ```
///
/// Of a segment's columns the root of the share counts that the guide leaves of the variance there `[baseline.12]`.
///
/// Without them a healthy aircraft that flies faster than it was taught is told by whatever effect bends most there.
#[derive(Clone, Debug, Default)]
pub(crate) struct Beyond {
    sides: Vec<Side>,
    root: Root,
}

/// One smooth function on one side.
#[derive(Clone, Copy, Debug)]
struct Side {
    smooth: usize,
    is_above: bool,
    /// Lengths to the farthest segment.
    farthest: f64,
    /// Standard deviation there.
    deviation: f64,
}

impl Beyond {
    /// Of the segments at hand.
    pub(crate) fn of(baseline: Option<&Baseline>, segments: &[SegmentRow]) -> Self {
        let Some(baseline) = baseline else { return Self::default() };
        let mut farthest = vec![[0.0_f64; 2]; baseline.smooth_functions()];
        for row in segments {
            for (far, distance) in farthest.iter_mut().zip(baseline.beyond(&row.response)) {
                let side = usize::from(distance > 0.0);
                far[side] = far[side].max(distance.abs());
            }
        }
        let sides = farthest.iter().enumerate().flat_map(|(smooth, far)| {
            far.iter().zip([false, true]).filter(|(far, _)| **far > 0.0).map(
                move |(&farthest, is_above)| Side {
                    smooth,
                    is_above,
                    farthest,
                    deviation: (baseline.growth_beyond(smooth) * farthest.powi(3)).sqrt(),
                },
            )
        });
        Self { sides: sides.collect(), root: Root::new() }
    }

    /// Number of columns.
    pub(crate) const fn len(&self) -> usize {
        COLUMNS * self.sides.len()
    }

    /// Writes the columns of a segment, on fuel flow, each of unit prior variance.
    pub(crate) fn write(&self, baseline: &Baseline, row: &SegmentRow, into: &mut [f64]) {
        let distances: Vec<f64> = baseline.beyond(&row.response).collect();
        let left = baseline.left_by_guide(&distances).sqrt();
        for (side, terms) in self.sides.iter().zip(into.chunks_exact_mut(COLUMNS)) {
            let distance = distances[side.smooth];
            let is_there = distance != 0.0 && (distance > 0.0) == side.is_above;
            let share = if is_there { distance.abs() / side.farthest } else { 0.0 };
            for (term, value) in terms.iter_mut().zip(self.root.terms_at(share)) {
                *term = left * side.deviation * value;
            }
        }
    }
}

/// Root of the process' covariance at its three places.
#[derive(Clone, Copy, Debug, Default)]
struct Root([[f64; COLUMNS]; COLUMNS]);

impl Root {
    fn new() -> Self {
        let mut root = Self::default();
        for k in 0..COLUMNS {
            let row = root.terms_at(place(k));
            root.0[k] = row;
            // Its own row is not there yet: what the places before it leave of its variance.
            let held: f64 = row[..k].iter().map(|term| term * term).sum();
            root.0[k][k] = (covariance(place(k), place(k)) - held).sqrt();
        }
        root
    }

    /// The process at a share of the way, by independent variables, as many as there are rows.
    fn terms_at(&self, share: f64) -> [f64; COLUMNS] {
        let mut terms = [0.0; COLUMNS];
        for (k, row) in self.0.iter().enumerate().take_while(|(k, row)| row[*k] > 0.0) {
            let held: f64 = row[..k].iter().zip(&terms).map(|(one, other)| one * other).sum();
            terms[k] = (covariance(place(k), share) - held) / row[k];
        }
        terms
    }
}

/// Share of the way of each place.
const fn place(k: usize) -> f64 {
    (k + 1) as f64 / COLUMNS as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The oracle is the process itself: its variance is the cube of the way at the three places, and between them what three places
    /// cannot hold is small; before the first segment beyond there is nothing.
    #[test]
    fn three_places_hold_the_process() {
        let root = Root::new();
        for step in 0..=100 {
            let share = f64::from(step) / 100.0;
            let held: f64 = root.terms_at(share).iter().map(|term| term * term).sum();
            assert!(held <= share.powi(3) + 1e-12, "{share}: {held}");
            assert!(share.powi(3) - held < 0.003, "{share}: {held}");
        }
        for (one, other) in [(1.0 / 3.0, 1.0), (2.0 / 3.0, 0.5), (1.0, 0.8)] {
            let product: f64 =
                root.terms_at(one).iter().zip(root.terms_at(other)).map(|(a, b)| a * b).sum();
            assert!((product - covariance(one, other)).abs() < 1e-9, "{one} {other}: {product}");
        }
        assert!(root.terms_at(0.0).iter().all(|term| *term == 0.0));
    }
}
