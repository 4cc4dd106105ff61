//! Many trial effects at one point: what an effect leaves alone is computed once.

use flight::effect::EffectId;

use super::recorded::AsFlown;
use super::terms::{Layers, Terms};
use super::{EffectError, EffectModel, EffectPoint, Effects, Response};

/// Trial effects made ready for many points: [`EffectModel::trial`].
#[derive(Clone, Debug)]
pub struct Trial {
    terms: Terms,
    /// Effects with a size.
    acting: Vec<EffectId>,
}

/// A recorded point with what stays the same when effects that do not touch it are switched on:
/// [`EffectModel::known_point`].
#[derive(Clone, Copy, Debug)]
pub struct KnownPoint {
    point: EffectPoint,
    known: Known,
}

/// What is known of a point without trial effects.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub(super) flown: AsFlown,
    pub(super) gravity_m_s2: f64,
    pub(super) table: f64,
    pub(super) tsfc_kg_per_n_s: f64,
}

impl KnownPoint {
    /// The same point with the corrected thrust that its N2 stands for
    /// ([`EffectPoint::corrected_thrust_by_n2_n`]): of trial effects alone, so that what is known stays.
    #[must_use]
    pub const fn with_corrected_thrust_by_n2(mut self, newtons: Option<f64>) -> Self {
        self.point.corrected_thrust_by_n2_n = newtons;
        self
    }
}

impl EffectModel<'_> {
    /// Makes effects ready for many points.
    #[must_use]
    pub fn trial(&self, effects: &Effects) -> Trial {
        Trial {
            terms: Terms::of(effects, &self.references),
            acting: effects.iter().filter(|(_, size)| *size != 0.0).map(|(id, _)| id).collect(),
        }
    }

    /// A recorded point and its response without trial effects, for [`response_at`](Self::response_at).
    ///
    /// # Errors
    /// As for [`response`](Self::response) without effects.
    pub fn known_point(&self, point: &EffectPoint) -> Result<(KnownPoint, Response), EffectError> {
        let trial = Terms::of(&Effects::none(), &self.references);
        let layers = Layers { contained: self.contained, trial: &trial };
        let (response, known) = self.evaluate(point, layers, layers.moves_the_point(), None)?;
        Ok((KnownPoint { point: *point, known }, response))
    }

    /// The same numbers as [`response`](Self::response), to the last bit, in less time: what the effects leave alone is not
    /// computed again.
    ///
    /// # Errors
    /// As for [`response`](Self::response).
    pub fn response_at(&self, at: &KnownPoint, trial: &Trial) -> Result<Response, EffectError> {
        has_inputs(trial.acting.iter().copied(), &at.point)?;
        let layers = Layers { contained: self.contained, trial: &trial.terms };
        let may_leave = layers.moves_the_point();
        self.evaluate(&at.point, layers, may_leave, Some(&at.known)).map(|(response, _)| response)
    }
}

/// Whether every input of these effects was recorded at a point.
pub(super) fn has_inputs(
    effects: impl Iterator<Item = EffectId>,
    point: &EffectPoint,
) -> Result<(), EffectError> {
    for effect in effects {
        if let Some(needs) = EffectModel::lacks(effect, point) {
            return Err(EffectError::NotRecorded { effect, needs });
        }
    }
    Ok(())
}
