//! The few factors by which noise and remainder are larger or smaller than stated.

use crate::priors::{DIAL_LIMITS, USUAL_NOISE};

/// Most factors of a channel.
pub(super) const MOST_DIALS: usize = 4;

/// Factors on the sizes of noise and remainder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Dials {
    /// On the noise within flights.
    pub(super) within: f64,
    /// On what flights have in common.
    pub(super) between: f64,
    /// On the prior standard deviations of smooth functions and products.
    pub(super) scales: [f64; 2],
}

impl Dials {
    /// What is usual.
    pub(super) const fn usual() -> Self {
        let [within, between] = USUAL_NOISE;
        Self { within, between, scales: [1.0; 2] }
    }

    pub(super) fn ratio(&self) -> f64 {
        self.between / self.within
    }

    /// ln of within, between over within, and the scales: what the search moves.
    pub(super) fn coordinates(&self) -> [f64; MOST_DIALS] {
        let [smooth, products] = self.scales;
        [self.within.ln(), self.ratio().ln(), smooth.ln(), products.ln()]
    }

    /// From such coordinates.
    pub(super) fn at(coordinates: &[f64; MOST_DIALS]) -> Self {
        let [within, ratio, smooth, products] = coordinates.map(f64::exp);
        Self { within, between: within * ratio, scales: [smooth, products] }
    }

    /// Whether all are within their limits.
    pub(super) fn is_allowed(&self) -> bool {
        let (low, high) = DIAL_LIMITS;
        let all = [self.within, self.between, self.scales[0], self.scales[1]];
        all.iter().all(|value| *value >= low && *value <= high)
    }
}
