//! Many trial effects at one point: what an effect does not change is computed once.

use flight::effect::EffectId;

use crate::point::EffectPoint;
use crate::response::Known;
use crate::terms::Terms;

/// Trial effects prepared for many points: [`EffectModel::trial`](crate::EffectModel::trial).
#[derive(Clone, Debug)]
pub struct Trial {
    pub(crate) terms: Terms,
    /// Effects with a size.
    pub(crate) acting: Vec<EffectId>,
}

/// A recorded point with the quantities that stay the same when effects that do not touch them are switched on:
/// [`EffectModel::known_point`](crate::EffectModel::known_point).
#[derive(Clone, Copy, Debug)]
pub struct KnownPoint {
    pub(crate) point: EffectPoint,
    pub(crate) known: Known,
}

impl KnownPoint {
    /// The point.
    #[must_use]
    pub const fn point(&self) -> &EffectPoint {
        &self.point
    }

    /// The same point with the corrected thrust that its N2 indicates ([`EffectPoint::corrected_thrust_by_n2_n`]): only
    /// trial effects use it, so the cached quantities stay.
    #[must_use]
    pub const fn with_corrected_thrust_by_n2(mut self, newtons: Option<f64>) -> Self {
        self.point.corrected_thrust_by_n2_n = newtons;
        self
    }
}
