//! The few factors by which noise and remainder are larger or smaller than stated.

use crate::priors::{NOISE_LIMITS, SCALE_LIMITS, SCALE_OF_NOTHING, USUAL_NOISE};

/// Groups of columns whose prior standard deviations flights scale.
pub(super) const SCALES: usize = 3;
/// Factors of the noise: within flights, and between them over that within.
pub(super) const NOISE_DIALS: usize = 2;
/// Most factors of a channel.
pub(super) const MOST_DIALS: usize = NOISE_DIALS + SCALES;

/// Factors on the sizes of noise and remainder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Dials {
    /// On the noise within flights.
    pub(super) within: f64,
    /// On what flights have in common.
    pub(super) between: f64,
    /// On the prior standard deviations of smooth functions, of products, and of the rest but the level.
    pub(super) scales: [f64; SCALES],
}

impl Dials {
    /// What is usual.
    pub(super) const fn usual() -> Self {
        let [within, between] = USUAL_NOISE;
        Self { within, between, scales: [1.0; SCALES] }
    }

    pub(super) fn ratio(&self) -> f64 {
        self.between / self.within
    }

    /// ln of within, between over within, and the scales: what the search moves.
    pub(super) fn coordinates(&self) -> [f64; MOST_DIALS] {
        let [smooth, products, straight] = self.scales;
        [self.within.ln(), self.ratio().ln(), smooth.ln(), products.ln(), straight.ln()]
    }

    /// From such coordinates.
    pub(super) fn at(coordinates: &[f64; MOST_DIALS]) -> Self {
        let [within, ratio, smooth, products, straight] = coordinates.map(f64::exp);
        Self { within, between: within * ratio, scales: [smooth, products, straight] }
    }

    /// The same noise where nothing but the level of a prediction is off.
    pub(super) const fn of_level_alone(mut self) -> Self {
        self.scales = [SCALE_OF_NOTHING; SCALES];
        self
    }

    /// Whether all are within their limits.
    pub(super) fn is_allowed(&self) -> bool {
        let within = |value: &f64, (low, high): (f64, f64)| *value >= low && *value <= high;
        [self.within, self.between].iter().all(|value| within(value, NOISE_LIMITS))
            && self.scales.iter().all(|value| within(value, SCALE_LIMITS))
    }
}
