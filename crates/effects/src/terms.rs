//! A set of effects with their sizes, and the same in the kernels' units.

use flight::MAXIMUM_ENGINES;
use flight::effect::EffectId;
use serde::{Deserialize, Serialize};

use super::EffectReferences;

const PERCENT: f64 = 0.01;
/// A drag count.
const COUNT: f64 = 1e-4;
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
    /// ([`EffectPoint::corrected_thrust_by_n2_n`](super::EffectPoint::corrected_thrust_by_n2_n)).
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

/// Everything that acts at once: effects that the model contains, in the order in which they were applied, and the trial
/// effects on top of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layers<'t> {
    pub(super) contained: &'t [Terms],
    pub(super) trial: &'t Terms,
}

impl<'t> Layers<'t> {
    pub(super) fn iter(self) -> impl Iterator<Item = &'t Terms> {
        self.contained.iter().chain(core::iter::once(self.trial))
    }

    pub(super) fn sum(self, of: impl Fn(&Terms) -> f64) -> f64 {
        self.iter().map(of).sum()
    }

    /// Whether an effect moves lift coefficient or Mach number away from what was recorded.
    pub(super) fn moves_the_point(self) -> bool {
        self.iter().any(Terms::moves_the_point)
    }
}

/// Sizes as the kernels use them: shares instead of per cent, coefficients instead of counts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Terms {
    pub(super) references: EffectReferences,
    pub(super) hidden: HiddenParameters,
    pub(super) zero_lift_drag: f64,
    pub(super) drag_factor: f64,
    pub(super) induced_drag: f64,
    pub(super) wave_drag_mach: f64,
    pub(super) reynolds_exponent: f64,
    pub(super) trim_drag_per_10_percent_mac: f64,
    pub(super) asymmetry_drag_per_deg2: f64,
    pub(super) load_factor: f64,
    pub(super) airframe_ageing_per_year: f64,
    pub(super) tsfc_factor: f64,
    pub(super) tsfc_engine: [f64; MAXIMUM_ENGINES],
    pub(super) tsfc_mach_exponent: f64,
    pub(super) tsfc_temperature_exponent: f64,
    pub(super) tsfc_throttle: f64,
    pub(super) power_offtake: f64,
    pub(super) anti_ice_bleed: f64,
    pub(super) engine_ageing_per_year: f64,
    pub(super) zero_fuel_mass_kg: f64,
    pub(super) fuel_quantity_gain: f64,
    pub(super) mach_bias: f64,
    pub(super) static_pressure_bias: f64,
    pub(super) temperature_bias_k: f64,
    pub(super) fuel_flow_gain: [f64; MAXIMUM_ENGINES],
    pub(super) local_gravity: f64,
    pub(super) rotating_earth: f64,
    pub(super) isobaric_slope: f64,
    pub(super) step_fuel_flow: f64,
    pub(super) step_drag: f64,
}

impl Terms {
    pub(super) fn of(effects: &Effects, references: &EffectReferences) -> Self {
        let mut terms = Self::none(*references, *effects.hidden());
        for (effect, size) in effects.iter() {
            terms.add(effect, size);
        }
        terms
    }

    /// Whether an effect moves lift coefficient or Mach number away from what was recorded.
    pub(super) fn moves_the_point(&self) -> bool {
        self.load_factor != 0.0
            || self.zero_fuel_mass_kg != 0.0
            || self.fuel_quantity_gain != 0.0
            || self.mach_bias != 0.0
            || self.static_pressure_bias != 0.0
            || self.local_gravity != 0.0
            || self.rotating_earth != 0.0
            || self.fuel_flow_gain.iter().any(|gain| *gain != 0.0)
    }

    /// Whether an effect says that the state flown is not the one recorded.
    pub(super) fn corrects_recordings(&self) -> bool {
        self.zero_fuel_mass_kg != 0.0
            || self.fuel_quantity_gain != 0.0
            || self.mach_bias != 0.0
            || self.static_pressure_bias != 0.0
            || self.temperature_bias_k != 0.0
            || self.fuel_flow_gain.iter().any(|gain| *gain != 0.0)
    }

    /// Whether an effect changes what a mass weighs.
    pub(super) const fn changes_weight(&self) -> bool {
        self.load_factor != 0.0 || self.local_gravity != 0.0 || self.rotating_earth != 0.0
    }

    fn none(references: EffectReferences, hidden: HiddenParameters) -> Self {
        Self {
            references,
            hidden,
            zero_lift_drag: 0.0,
            drag_factor: 0.0,
            induced_drag: 0.0,
            wave_drag_mach: 0.0,
            reynolds_exponent: 0.0,
            trim_drag_per_10_percent_mac: 0.0,
            asymmetry_drag_per_deg2: 0.0,
            load_factor: 0.0,
            airframe_ageing_per_year: 0.0,
            tsfc_factor: 0.0,
            tsfc_engine: [0.0; MAXIMUM_ENGINES],
            tsfc_mach_exponent: 0.0,
            tsfc_temperature_exponent: 0.0,
            tsfc_throttle: 0.0,
            power_offtake: 0.0,
            anti_ice_bleed: 0.0,
            engine_ageing_per_year: 0.0,
            zero_fuel_mass_kg: 0.0,
            fuel_quantity_gain: 0.0,
            mach_bias: 0.0,
            static_pressure_bias: 0.0,
            temperature_bias_k: 0.0,
            fuel_flow_gain: [0.0; MAXIMUM_ENGINES],
            local_gravity: 0.0,
            rotating_earth: 0.0,
            isobaric_slope: 0.0,
            step_fuel_flow: 0.0,
            step_drag: 0.0,
        }
    }

    fn add(&mut self, effect: EffectId, size: f64) {
        match effect {
            EffectId::ZeroLiftDrag => self.zero_lift_drag += size * COUNT,
            EffectId::DragFactor => self.drag_factor += size * PERCENT,
            EffectId::InducedDrag => self.induced_drag += size * PERCENT,
            EffectId::WaveDrag => self.wave_drag_mach += size,
            EffectId::ReynoldsNumber => self.reynolds_exponent += size,
            EffectId::TrimDragCg => self.trim_drag_per_10_percent_mac += size * COUNT,
            EffectId::AsymmetryDrag => self.asymmetry_drag_per_deg2 += size * COUNT,
            EffectId::LoadFactor => self.load_factor += size,
            EffectId::AirframeAgeing => self.airframe_ageing_per_year += size * PERCENT,
            EffectId::TsfcFactor => self.tsfc_factor += size * PERCENT,
            EffectId::TsfcEngine(engine) => add_engine(&mut self.tsfc_engine, engine, size),
            EffectId::TsfcMachExponent => self.tsfc_mach_exponent += size,
            EffectId::TsfcTemperatureExponent => self.tsfc_temperature_exponent += size,
            EffectId::TsfcThrottle => self.tsfc_throttle += size * PERCENT,
            EffectId::PowerOfftake => self.power_offtake += size * PERCENT,
            EffectId::AntiIceBleed => self.anti_ice_bleed += size * PERCENT,
            EffectId::EngineAgeing => self.engine_ageing_per_year += size * PERCENT,
            // A scatter moves no mean: it is a variance, and the business of whoever knows variances.
            EffectId::FuelHeatingValue => {}
            EffectId::ZeroFuelMassBias => self.zero_fuel_mass_kg += size,
            EffectId::FuelQuantityGain => self.fuel_quantity_gain += size * PERCENT,
            EffectId::MachBias => self.mach_bias += size,
            EffectId::StaticPressureBias => self.static_pressure_bias += size * PERCENT,
            EffectId::TemperatureBias => self.temperature_bias_k += size,
            EffectId::FuelFlowGain => {
                for gain in &mut self.fuel_flow_gain {
                    *gain += size * PERCENT;
                }
            }
            EffectId::FuelFlowGainEngine(engine) => {
                add_engine(&mut self.fuel_flow_gain, engine, size);
            }
            EffectId::LocalGravity => self.local_gravity += size,
            EffectId::RotatingEarth => self.rotating_earth += size,
            EffectId::IsobaricSlope => self.isobaric_slope += size,
            EffectId::StepChange => match self.hidden.step_target {
                StepTarget::FuelFlow => self.step_fuel_flow += size * PERCENT,
                StepTarget::Drag => self.step_drag += size * PERCENT,
            },
        }
    }
}

/// Adds a percentage to engine k, counted from 1. An engine that the aircraft does not have carries no fuel.
fn add_engine(of: &mut [f64; MAXIMUM_ENGINES], engine: u8, percent: f64) {
    if let Some(value) = of.get_mut(usize::from(engine).wrapping_sub(1)) {
        *value += percent * PERCENT;
    }
}
