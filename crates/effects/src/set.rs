//! A set of effects, each with its size and its hidden parameter.

use flight::effect::{EffectId, HiddenParameter};
use serde::{Deserialize, Serialize};

mod text;

/// Effects that are switched on, each with its size in the library's unit and its hidden parameter.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(into = "text::EffectsText", try_from = "text::EffectsText")]
pub struct Effects {
    effects: Vec<SizedEffect>,
}

/// One effect of a set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SizedEffect {
    pub(crate) id: EffectId,
    pub(crate) size: f64,
    /// Its hidden parameter, of the effect's kind.
    pub(crate) hidden: HiddenParameter,
}

impl Effects {
    /// No effect.
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// One effect.
    #[must_use]
    pub fn one(effect: EffectId, size: f64) -> Self {
        Self::none().with(effect, size)
    }

    /// The same set with an effect at this size, in its unit; an earlier size is replaced. Its hidden parameter stays,
    /// or is the library's where there was none.
    #[must_use]
    pub fn with(mut self, effect: EffectId, size: f64) -> Self {
        match self.effects.iter_mut().find(|on| on.id == effect) {
            Some(on) => on.size = size,
            None => {
                self.effects.push(SizedEffect { id: effect, size, hidden: effect.entry().hidden });
            }
        }
        self
    }

    /// The same set with another hidden parameter of an effect. Unchanged where the effect is off, or the parameter is
    /// of another kind.
    #[must_use]
    pub fn with_hidden(mut self, effect: EffectId, hidden: HiddenParameter) -> Self {
        if let Some(on) = self.effects.iter_mut().find(|on| on.id == effect)
            && on.hidden.is_like(hidden)
        {
            on.hidden = hidden;
        }
        self
    }

    /// Hidden parameter of an effect; the library's where it is off.
    #[must_use]
    pub fn hidden(&self, effect: EffectId) -> HiddenParameter {
        let on = self.effects.iter().find(|on| on.id == effect);
        on.map_or(effect.entry().hidden, |on| on.hidden)
    }

    /// Size of an effect, 0 where it is off.
    #[must_use]
    pub fn size(&self, effect: EffectId) -> f64 {
        self.effects.iter().find(|on| on.id == effect).map_or(0.0, |on| on.size)
    }

    /// Effects and sizes in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = (EffectId, f64)> + '_ {
        self.effects.iter().map(|on| (on.id, on.size))
    }

    /// Whether nothing is switched on.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.effects.is_empty()
    }

    pub(crate) fn as_slice(&self) -> &[SizedEffect] {
        &self.effects
    }
}

impl FromIterator<SizedEffect> for Effects {
    fn from_iter<I: IntoIterator<Item = SizedEffect>>(effects: I) -> Self {
        Self { effects: effects.into_iter().collect() }
    }
}
