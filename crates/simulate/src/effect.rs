//! The effects a truth may carry: every one of the library, in the truth's own form, and some that no library has.

use core::fmt;
use core::str::FromStr;

use flight::Timestamp;
use flight::effect::{EffectId, StepTarget, TypicalSize};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An effect that no library has: a diagnosis must report it as outside its library.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum OutsideEffect {
    /// A bump of drag at one Mach number.
    MachBump,
    /// Spoilers that float above one lift coefficient.
    SpoilerFloat,
    /// Fuel that does not burn completely where the pressure is low.
    CombustorLoss,
    /// Fuel flow that depends on the temperature of the fuel in the tanks.
    FuelTemperature,
}

/// An effect of the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TruthEffect {
    /// One of the library.
    Library(EffectId),
    /// One outside any library.
    Outside(OutsideEffect),
}

/// A name that no effect has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no effect is called {name:?}; those outside the library are {OUTSIDE_NAMES}")]
pub struct UnknownEffect {
    /// The name.
    pub name: String,
}

const OUTSIDE_NAMES: &str =
    "outside_mach_bump, outside_spoiler_float, outside_combustor_loss, outside_fuel_temperature";

impl OutsideEffect {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::MachBump, Self::SpoilerFloat, Self::CombustorLoss, Self::FuelTemperature];

    /// The name in plans.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::MachBump => "outside_mach_bump",
            Self::SpoilerFloat => "outside_spoiler_float",
            Self::CombustorLoss => "outside_combustor_loss",
            Self::FuelTemperature => "outside_fuel_temperature",
        }
    }

    /// Unit of its size.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::MachBump | Self::SpoilerFloat => "drag counts",
            Self::CombustorLoss => "%",
            Self::FuelTemperature => "% per 30 K",
        }
    }

    /// A size that is plainly visible, in that unit.
    #[must_use]
    pub const fn typical_size(self) -> f64 {
        match self {
            Self::MachBump | Self::SpoilerFloat => 10.0,
            Self::CombustorLoss => 3.0,
            Self::FuelTemperature => 2.0,
        }
    }
}

impl TruthEffect {
    /// Unit of its size.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Library(id) => id.entry().unit,
            Self::Outside(outside) => outside.unit(),
        }
    }

    /// Whether it only ever makes the aircraft worse, or its size has no sign.
    #[must_use]
    pub const fn is_one_sided(self) -> bool {
        match self {
            Self::Library(id) => id.is_one_sided(),
            Self::Outside(_) => true,
        }
    }

    /// Its typical size in that unit; a share of the mass needs the fleet's mean mass.
    #[must_use]
    pub fn typical_size(self, mean_mass_kg: f64) -> f64 {
        match self {
            Self::Library(id) => match id.entry().typical {
                TypicalSize::Absolute(size) => size,
                TypicalSize::ShareOfMass(share) => share * mean_mass_kg,
                TypicalSize::Known => 1.0,
            },
            Self::Outside(outside) => outside.typical_size(),
        }
    }
}

impl fmt::Display for TruthEffect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(id) => id.fmt(f),
            Self::Outside(outside) => f.write_str(outside.name()),
        }
    }
}

impl FromStr for TruthEffect {
    type Err = UnknownEffect;

    fn from_str(name: &str) -> Result<Self, UnknownEffect> {
        EffectId::from_name(name)
            // A table that is off belongs to a model; the truth has smooth errors for it.
            .filter(|id| *id != EffectId::DragTable)
            .map(Self::Library)
            .or_else(|| {
                OutsideEffect::ALL
                    .into_iter()
                    .find(|outside| outside.name() == name)
                    .map(Self::Outside)
            })
            .ok_or_else(|| UnknownEffect { name: name.to_owned() })
    }
}

impl Serialize for TruthEffect {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for TruthEffect {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

/// An effect as a plan asks for it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedEffect {
    /// Which.
    pub id: TruthEffect,
    /// Size in the effect's unit; the typical size when left out.
    #[serde(default)]
    pub size: Option<f64>,
    /// The instant from which it acts; always when left out. `step_change`, `engine_history`, `airframe_history`: the instant of
    /// the step or fall; the middle of the fleet's dates when left out.
    #[serde(default, with = "optional_timestamp")]
    pub from: Option<Timestamp>,
    /// The instant until which it acts; for ever when left out.
    #[serde(default, with = "optional_timestamp", skip_serializing_if = "Option::is_none")]
    pub until: Option<Timestamp>,
    /// `step_change`: what it multiplies; drag when left out.
    #[serde(default = "drag")]
    pub target: StepTarget,
    /// Its position: Mach number of the bump, lift coefficient of the spoilers, corrected thrust over its reference of
    /// `tsfc_throttle`'s pivot. Each has a default when left out.
    #[serde(default)]
    pub at: Option<f64>,
}

const fn drag() -> StepTarget {
    StepTarget::Drag
}

impl PlannedEffect {
    /// An effect of a given size, everything else by default.
    #[must_use]
    pub const fn sized(id: TruthEffect, size: f64) -> Self {
        Self { id, size: Some(size), from: None, until: None, target: StepTarget::Drag, at: None }
    }

    /// Whether it acts on a flight that begins at an instant. Steps and histories act always: their date is within their form.
    pub(crate) fn acts_at(&self, start: Timestamp) -> bool {
        let begun = self.has_dated_form() || self.from.is_none_or(|from| start >= from);
        begun && self.until.is_none_or(|until| start < until)
    }

    /// Whether its date is within its form.
    pub(crate) const fn has_dated_form(&self) -> bool {
        matches!(
            self.id,
            TruthEffect::Library(
                EffectId::StepChange | EffectId::EngineHistory | EffectId::AirframeHistory
            )
        )
    }

    /// An effect of its typical size.
    #[must_use]
    pub const fn typical(id: TruthEffect) -> Self {
        Self { id, size: None, from: None, until: None, target: StepTarget::Drag, at: None }
    }
}

/// An instant as RFC 3339 text.
pub(crate) mod timestamp {
    use flight::Timestamp;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(crate) fn serialize<S: Serializer>(value: &Timestamp, s: S) -> Result<S::Ok, S::Error> {
        s.collect_str(value)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<Timestamp, D::Error> {
        String::deserialize(d)?.parse().map_err(serde::de::Error::custom)
    }
}

/// An instant that may be left out.
pub(crate) mod optional_timestamp {
    use flight::Timestamp;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[expect(clippy::ref_option, reason = "the signature that serde's `with` asks for")]
    pub(crate) fn serialize<S: Serializer>(
        value: &Option<Timestamp>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        value.map(|instant| instant.to_string()).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<Timestamp>, D::Error> {
        Option::<String>::deserialize(deserializer)?
            .map(|text| text.parse().map_err(serde::de::Error::custom))
            .transpose()
    }
}

/// Two instants that may be left out.
pub(crate) mod optional_timestamps {
    use flight::Timestamp;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    type Instants = Option<(Timestamp, Timestamp)>;

    pub(crate) fn serialize<S: Serializer>(
        value: &Instants,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        value.map(|(from, to)| (from.to_string(), to.to_string())).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Instants, D::Error> {
        let instant = |text: String| text.parse().map_err(serde::de::Error::custom);
        Option::<(String, String)>::deserialize(deserializer)?
            .map(|(from, to)| Ok((instant(from)?, instant(to)?)))
            .transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_both_ways() {
        let library = EffectId::library(4).into_iter().map(TruthEffect::Library);
        let outside = OutsideEffect::ALL.into_iter().map(TruthEffect::Outside);
        for effect in library.chain(outside) {
            assert_eq!(effect.to_string().parse(), Ok(effect));
        }
        assert!("magic".parse::<TruthEffect>().is_err());
    }

    #[test]
    fn typical_mass_bias_is_a_share_of_the_mass() {
        // 1.5 % of 13 600 kg.
        let effect = TruthEffect::Library(EffectId::ZeroFuelMassBias);
        assert!((effect.typical_size(13_600.0) - 204.0).abs() < 1e-9);
    }
}
