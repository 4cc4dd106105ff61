//! The effects that act at a point, in the units of the equations, layer by layer.

use flight::MAXIMUM_ENGINES;
use flight::effect::{EffectId, HiddenParameter, StepTarget, ThrottleArgument};

use crate::references::EffectReferences;
use crate::set::{Effects, SizedEffect};

const PERCENT: f64 = 0.01;
/// A drag count.
const COUNT: f64 = 1e-4;

/// Everything that acts at once: the effects that the model contains, in the order in which they were applied, and the
/// trial effects on top of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layers<'t> {
    pub(crate) contained: &'t [Terms],
    pub(crate) trial: &'t Terms,
}

impl<'t> Layers<'t> {
    pub(crate) fn iter(self) -> impl Iterator<Item = &'t Terms> {
        self.contained.iter().chain(core::iter::once(self.trial))
    }

    pub(crate) fn sum(self, of: impl Fn(&Terms) -> f64) -> f64 {
        self.iter().map(of).sum()
    }

    /// Whether an effect moves lift coefficient or Mach number away from what was recorded.
    pub(crate) fn moves_the_point(self) -> bool {
        self.iter().any(Terms::moves_the_point)
    }
}

/// Sizes in the form that the equations need: shares instead of per cent, coefficients instead of counts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Terms {
    pub(crate) references: EffectReferences,
    pub(crate) zero_lift_drag: f64,
    pub(crate) drag_factor: f64,
    pub(crate) induced_drag: f64,
    pub(crate) wave_drag_mach: f64,
    /// Drag-divergence Mach number at lift coefficient 0.35 that the rise is shifted from.
    pub(crate) drag_divergence_mach: f64,
    pub(crate) reynolds_exponent: f64,
    pub(crate) trim_drag_per_10_percent_mac: f64,
    pub(crate) asymmetry_drag_per_deg2: f64,
    pub(crate) load_factor: f64,
    pub(crate) airframe_ageing_per_year: f64,
    pub(crate) tsfc_factor: f64,
    pub(crate) tsfc_engine: [f64; MAXIMUM_ENGINES],
    pub(crate) tsfc_mach_exponent: f64,
    pub(crate) tsfc_temperature_exponent: f64,
    pub(crate) tsfc_throttle: f64,
    /// Corrected thrust over its reference at which TSFC is unchanged.
    pub(crate) throttle_pivot: f64,
    pub(crate) throttle_argument: ThrottleArgument,
    pub(crate) power_offtake: f64,
    pub(crate) anti_ice_bleed: f64,
    pub(crate) engine_ageing_per_year: f64,
    pub(crate) zero_fuel_mass_kg: f64,
    pub(crate) fuel_quantity_gain: f64,
    pub(crate) mach_bias: f64,
    pub(crate) static_pressure_bias: f64,
    pub(crate) temperature_bias_k: f64,
    pub(crate) fuel_flow_gain: [f64; MAXIMUM_ENGINES],
    pub(crate) local_gravity: f64,
    pub(crate) rotating_earth: f64,
    pub(crate) isobaric_slope: f64,
    pub(crate) step_fuel_flow: f64,
    pub(crate) step_drag: f64,
    /// Instant from which the step holds, s since 1970.
    pub(crate) step_from_s: f64,
}

impl Terms {
    pub(crate) fn new(effects: &Effects, references: &EffectReferences) -> Self {
        let mut terms = Self::none(*references);
        for effect in effects.as_slice() {
            terms.add(effect);
        }
        terms
    }

    /// Whether an effect moves lift coefficient or Mach number away from what was recorded.
    pub(crate) fn moves_the_point(&self) -> bool {
        self.load_factor != 0.0
            || self.zero_fuel_mass_kg != 0.0
            || self.fuel_quantity_gain != 0.0
            || self.mach_bias != 0.0
            || self.static_pressure_bias != 0.0
            || self.local_gravity != 0.0
            || self.rotating_earth != 0.0
            || self.fuel_flow_gain.iter().any(|gain| *gain != 0.0)
    }

    /// Whether an effect means that the flown state differs from the recorded one.
    pub(crate) fn corrects_recordings(&self) -> bool {
        self.zero_fuel_mass_kg != 0.0
            || self.fuel_quantity_gain != 0.0
            || self.mach_bias != 0.0
            || self.static_pressure_bias != 0.0
            || self.temperature_bias_k != 0.0
            || self.fuel_flow_gain.iter().any(|gain| *gain != 0.0)
    }

    /// Whether an effect changes the weight of a mass.
    pub(crate) const fn changes_weight(&self) -> bool {
        self.load_factor != 0.0 || self.local_gravity != 0.0 || self.rotating_earth != 0.0
    }

    fn none(references: EffectReferences) -> Self {
        Self {
            references,
            zero_lift_drag: 0.0,
            drag_factor: 0.0,
            induced_drag: 0.0,
            wave_drag_mach: 0.0,
            drag_divergence_mach: 0.0,
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
            throttle_pivot: 0.0,
            throttle_argument: ThrottleArgument::CorrectedThrust,
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
            step_from_s: f64::INFINITY,
        }
    }

    fn add(&mut self, effect: &SizedEffect) {
        let size = effect.size;
        self.set_hidden(effect.hidden);
        match effect.id {
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
            // A scatter moves no mean: it is a variance, and is handled where variances are.
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
            EffectId::StepChange => match effect.hidden {
                HiddenParameter::Step { target: StepTarget::Drag, .. } => {
                    self.step_drag += size * PERCENT;
                }
                _ => self.step_fuel_flow += size * PERCENT,
            },
        }
    }

    const fn set_hidden(&mut self, hidden: HiddenParameter) {
        match hidden {
            HiddenParameter::None => {}
            HiddenParameter::DragDivergenceMach(mach) => self.drag_divergence_mach = mach,
            HiddenParameter::Throttle { pivot, argument } => {
                self.throttle_pivot = pivot;
                self.throttle_argument = argument;
            }
            HiddenParameter::Step { from_s, .. } => self.step_from_s = from_s,
        }
    }
}

/// Adds a percentage to engine k, counted from 1. An engine that the aircraft does not have carries no fuel.
fn add_engine(of: &mut [f64; MAXIMUM_ENGINES], engine: u8, percent: f64) {
    if let Some(value) = of.get_mut(usize::from(engine).wrapping_sub(1)) {
        *value += percent * PERCENT;
    }
}
