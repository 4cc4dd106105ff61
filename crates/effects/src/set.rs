//! A set of effects, each with its size, and their hidden parameters.

use flight::effect::EffectId;
use serde::{Deserialize, Serialize};

/// Drag-divergence Mach number at lift coefficient 0.35 where neither aircraft file nor search says one: the middle of
/// the contract's range 0.74 to 0.94.
const DEFAULT_DRAG_DIVERGENCE_MACH: f64 = 0.84;

/// What a dated step multiplies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StepTarget {
    /// Fuel flow.
    #[default]
    FuelFlow,
    /// Drag coefficient.
    Drag,
}

/// What the parabola of `tsfc_throttle` runs over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThrottleArgument {
    /// Corrected thrust as the model has it.
    #[default]
    CorrectedThrust,
    /// The corrected thrust that the recorded N2 stands for; the model's where a point does not say it
    /// ([`EffectPoint::corrected_thrust_by_n2_n`](crate::EffectPoint::corrected_thrust_by_n2_n)).
    N2,
}

impl ThrottleArgument {
    /// Whether it is corrected thrust: not written to files, so that files without N2 are what they were before.
    #[must_use]
    pub const fn is_corrected_thrust(&self) -> bool {
        matches!(self, Self::CorrectedThrust)
    }

    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::CorrectedThrust => "corrected thrust",
            Self::N2 => "N2",
        }
    }
}

/// Parameters of effects that are no sizes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HiddenParameters {
    /// `tsfc_throttle`: corrected thrust over its reference at which TSFC is unchanged.
    pub throttle_pivot: f64,
    /// `tsfc_throttle`: where that corrected thrust comes from.
    #[serde(default, skip_serializing_if = "ThrottleArgument::is_corrected_thrust")]
    pub throttle_argument: ThrottleArgument,
    /// `wave_drag`: drag-divergence Mach number at lift coefficient 0.35.
    pub drag_divergence_mach: f64,
    /// `step_change`: instant from which it holds, s since 1970.
    pub step_from_s: f64,
    /// `step_change`: what it multiplies.
    pub step_target: StepTarget,
}

impl HiddenParameters {
    /// What holds where nothing is said: pivot at the reference, over corrected thrust, drag rise in the middle of the contract's range, no step.
    pub const DEFAULT: Self = Self {
        throttle_pivot: 1.0,
        throttle_argument: ThrottleArgument::CorrectedThrust,
        drag_divergence_mach: DEFAULT_DRAG_DIVERGENCE_MACH,
        step_from_s: f64::INFINITY,
        step_target: StepTarget::FuelFlow,
    };
}

impl Default for HiddenParameters {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Effects that are switched on, each with its size in the library's unit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Effects {
    #[serde(with = "by_name")]
    sizes: Vec<(EffectId, f64)>,
    hidden: HiddenParameters,
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

    /// The same with an effect at this size, in its unit; a size it had before is replaced.
    #[must_use]
    pub fn with(mut self, effect: EffectId, size: f64) -> Self {
        match self.sizes.iter_mut().find(|(id, _)| *id == effect) {
            Some(entry) => entry.1 = size,
            None => self.sizes.push((effect, size)),
        }
        self
    }

    /// The same with other hidden parameters.
    #[must_use]
    pub const fn with_hidden(mut self, hidden: HiddenParameters) -> Self {
        self.hidden = hidden;
        self
    }

    /// Hidden parameters.
    #[must_use]
    pub const fn hidden(&self) -> &HiddenParameters {
        &self.hidden
    }

    /// Size of an effect, 0 where it is off.
    #[must_use]
    pub fn size(&self, effect: EffectId) -> f64 {
        self.sizes.iter().find(|(id, _)| *id == effect).map_or(0.0, |entry| entry.1)
    }

    /// Effects and sizes in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = (EffectId, f64)> + '_ {
        self.sizes.iter().copied()
    }

    /// Whether nothing is switched on.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sizes.is_empty()
    }
}

/// Effect ids as their names.
mod by_name {
    use flight::effect::EffectId;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(
        sizes: &[(EffectId, f64)],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let named: Vec<(String, f64)> =
            sizes.iter().map(|(id, size)| (id.to_string(), *size)).collect();
        named.serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<(EffectId, f64)>, D::Error> {
        Vec::<(String, f64)>::deserialize(deserializer)?
            .into_iter()
            .map(|(name, size)| {
                let id = EffectId::from_name(&name).ok_or_else(|| {
                    D::Error::custom(format_args!("no effect is called {name:?}"))
                })?;
                Ok((id, size))
            })
            .collect()
    }
}
