//! From an effect's name and size to terms.

use flight::effect::{EffectId, StepTarget};
use serde::{Deserialize, Serialize};

use super::Terms;
use super::drag::{AddedDrag, FrictionTerm, floating_spoilers, mach_bump};
use super::fuel::{ThrottleTerm, combustor_loss, warm_fuel};
use crate::aircraft::DRAG_COEFFICIENT_PER_COUNT;
use crate::effect::{OutsideEffect, PlannedEffect, TruthEffect};

const PERCENT: f64 = 0.01;
/// Share of a gathered deterioration that a fall takes back. Our choice: most of it, as washes are said to.
const TAKEN_BACK: f64 = 0.7;
/// Mach number of the drag bump and lift coefficient of the floating spoilers, where a plan gives none.
const DEFAULT_BUMP_MACH: f64 = 0.80;
const DEFAULT_SPOILER_LIFT_COEFFICIENT: f64 = 0.40;

/// The conditions at which an effect is zero: means over what a tail is planned to fly, so that a size has the same
/// meaning as the library's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct References {
    /// Mach number.
    pub mach: f64,
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Reynolds number over the mean aerodynamic chord.
    pub reynolds_number: f64,
    /// SAT over that of the ISA at sea level.
    pub temperature_ratio: f64,
    /// Thrust of all engines over the pressure ratio, N.
    pub corrected_thrust_n: f64,
    /// Fuel flow of all engines, kg/s.
    pub fuel_flow_kg_s: f64,
    /// Gross mass, kg.
    pub mass_kg: f64,
    /// Center of gravity, %MAC.
    pub center_of_gravity_percent_mac: f64,
    /// Mean date, seconds since 1970.
    pub date_s: f64,
    /// First date, seconds since 1970.
    pub first_date_s: f64,
    /// Last date, seconds since 1970.
    pub last_date_s: f64,
}

/// The inputs of an effect from the flight and its tail.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EffectContext<'a> {
    pub(crate) references: &'a References,
    /// Start of the flight, seconds since 1970.
    pub(crate) date_s: f64,
    pub(crate) engines: usize,
}

impl Terms {
    /// Adds one effect of a size in its own unit.
    pub(crate) fn add(&mut self, effect: &PlannedEffect, size: f64, context: &EffectContext<'_>) {
        match effect.id {
            TruthEffect::Library(id) => {
                self.add_drag(id, effect, size, context);
                self.add_fuel(id, effect, size, context);
                self.add_recorded(id, size, context);
                self.add_earth(id, size);
                if id == EffectId::StepChange
                    && context.date_s >= step_date_s(effect, context.references)
                {
                    match effect.target {
                        StepTarget::Drag => self.drag.factor *= 1.0 + size * PERCENT,
                        StepTarget::FuelFlow => self.scale_engines(1.0 + size * PERCENT),
                        engine => self.scale_engine(engine, 1.0 + size * PERCENT),
                    }
                }
            }
            TruthEffect::Outside(outside) => match outside {
                OutsideEffect::MachBump => self.drag.added.push(AddedDrag {
                    drag_coefficient: size * DRAG_COEFFICIENT_PER_COUNT,
                    at: effect.at.unwrap_or(DEFAULT_BUMP_MACH),
                    share: mach_bump,
                }),
                OutsideEffect::SpoilerFloat => self.drag.added.push(AddedDrag {
                    drag_coefficient: size * DRAG_COEFFICIENT_PER_COUNT,
                    at: effect.at.unwrap_or(DEFAULT_SPOILER_LIFT_COEFFICIENT),
                    share: floating_spoilers,
                }),
                OutsideEffect::CombustorLoss => {
                    self.fuel.added.push((size * PERCENT, combustor_loss));
                }
                OutsideEffect::FuelTemperature => self.fuel.added.push((size * PERCENT, warm_fuel)),
            },
        }
    }

    fn add_drag(
        &mut self,
        id: EffectId,
        effect: &PlannedEffect,
        size: f64,
        context: &EffectContext<'_>,
    ) {
        let references = context.references;
        let terms = &mut self.drag;
        match id {
            EffectId::ZeroLiftDrag => {
                terms.zero_lift += size * DRAG_COEFFICIENT_PER_COUNT;
                terms.zero_lift_mach = references.mach;
            }
            EffectId::DragFactor => terms.factor *= 1.0 + size * PERCENT,
            EffectId::InducedDrag => terms.induced += size * PERCENT,
            EffectId::WaveDrag => terms.earlier_by_mach += size,
            EffectId::ReynoldsNumber => {
                terms.friction.push(FrictionTerm::exponent(size, references.reynolds_number));
            }
            EffectId::TrimDragCg => terms.trim.push((
                size * DRAG_COEFFICIENT_PER_COUNT,
                references.center_of_gravity_percent_mac,
            )),
            EffectId::AsymmetryDrag => terms.asymmetry_effect += size * DRAG_COEFFICIENT_PER_COUNT,
            EffectId::AirframeAgeing => {
                terms.zero_lift_factor *= 1.0 + size * PERCENT * aged_years(context);
            }
            EffectId::AirframeHistory => {
                terms.zero_lift_factor *= 1.0 + size * PERCENT * gathered_years(effect, context);
            }
            _ => {}
        }
    }

    fn add_fuel(
        &mut self,
        id: EffectId,
        effect: &PlannedEffect,
        size: f64,
        context: &EffectContext<'_>,
    ) {
        let references = context.references;
        match id {
            EffectId::TsfcFactor => self.scale_engines(1.0 + size * PERCENT),
            EffectId::TsfcEngine(k) => {
                if let Some(factor) =
                    self.fuel.engine_factor.get_mut(usize::from(k).wrapping_sub(1))
                {
                    *factor *= 1.0 + size * PERCENT;
                }
            }
            // (M/Mref)^p with the slope of ((1 + M)/(1 + Mref))^θ at the reference: p = θ·Mref/(1 + Mref).
            EffectId::TsfcMachExponent => {
                self.fuel.mach_power =
                    Some((size * references.mach / (1.0 + references.mach), references.mach));
            }
            EffectId::TsfcTemperatureExponent => {
                self.fuel.temperature_line = Some((size, references.temperature_ratio));
            }
            EffectId::TsfcThrottle => self.fuel.throttle.push(ThrottleTerm {
                size: size * PERCENT,
                pivot: effect.at.unwrap_or(1.0),
                reference_corrected_thrust_n: references.corrected_thrust_n,
            }),
            EffectId::PowerOfftake => {
                self.fuel.power_offtake = Some((
                    size * PERCENT * references.fuel_flow_kg_s,
                    references.temperature_ratio,
                ));
            }
            EffectId::AntiIceBleed => {
                self.fuel.anti_ice = Some((size * PERCENT, references.corrected_thrust_n));
            }
            EffectId::EngineAgeing => {
                self.scale_engines(1.0 + size * PERCENT * aged_years(context));
            }
            EffectId::EngineHistory => {
                self.scale_engines(1.0 + size * PERCENT * gathered_years(effect, context));
            }
            _ => {}
        }
    }

    fn add_recorded(&mut self, id: EffectId, size: f64, context: &EffectContext<'_>) {
        let terms = &mut self.recorded;
        match id {
            EffectId::FuelHeatingValue => terms.heating_value_scatter = size * PERCENT,
            EffectId::ZeroFuelMassBias => terms.zero_fuel_mass_kg += size,
            // True fuel used is θ less than recorded: recorded = true/(1 − θ).
            EffectId::FuelQuantityGain => terms.fuel_used_factor /= 1.0 - size * PERCENT,
            EffectId::MachBias => terms.mach_bias += size,
            EffectId::StaticPressureBias => terms.static_pressure_relative += size * PERCENT,
            EffectId::TemperatureBias => {
                terms.temperature_bias_k += size;
                terms.temperature_bias_mach = context.references.mach;
            }
            EffectId::FuelFlowGain => {
                for factor in &mut terms.fuel_flow_factor[..context.engines] {
                    *factor *= 1.0 + size * PERCENT;
                }
            }
            EffectId::FuelFlowGainEngine(k) => {
                if let Some(factor) = terms.fuel_flow_factor.get_mut(usize::from(k).wrapping_sub(1))
                {
                    *factor *= 1.0 + size * PERCENT;
                }
            }
            _ => {}
        }
    }

    const fn add_earth(&mut self, id: EffectId, size: f64) {
        match id {
            EffectId::LoadFactor => self.earth.load_factor = true,
            EffectId::LocalGravity => self.earth.local_gravity = true,
            EffectId::RotatingEarth => self.earth.rotating_earth = true,
            EffectId::IsobaricSlope => self.earth.extra_slope += size,
            _ => {}
        }
    }

    /// Multiplies the TSFC of one engine.
    fn scale_engine(&mut self, target: StepTarget, factor: f64) {
        let number = target.engine().and_then(|engine| usize::from(engine).checked_sub(1));
        if let Some(engine) = number.and_then(|engine| self.fuel.engine_factor.get_mut(engine)) {
            *engine *= factor;
        }
    }

    /// Multiplies the TSFC of every engine.
    pub(crate) fn scale_engines(&mut self, factor: f64) {
        for engine in &mut self.fuel.engine_factor {
            *engine *= factor;
        }
    }
}

/// The instant from which a step holds, seconds since 1970.
pub(crate) fn step_date_s(effect: &PlannedEffect, references: &References) -> f64 {
    let middle_s = 0.5 * (references.first_date_s + references.last_date_s);
    effect.from.map_or(middle_s, flight::seconds_since_1970)
}

/// Years of ageing since the reference date, saturating: fast at first; on average over the fleet's dates one per year.
///
/// ```text
/// a(t) = T·(1 − e^(−(t − t1)/T))/(1 − e^−1),  T = t2 − t1,  x = a(t) − a(tref)     [virtual.14]
/// ```
fn aged_years(context: &EffectContext<'_>) -> f64 {
    let references = context.references;
    let year_s = units::convert::DAYS_PER_YEAR * units::convert::SECONDS_PER_DAY;
    let span = (references.last_date_s - references.first_date_s) / year_s;
    // Fleets of one day do not age.
    if span < 1e-6 {
        return 0.0;
    }
    let aged = |date_s: f64| {
        let since = (date_s - references.first_date_s) / year_s;
        span * (1.0 - (-since / span).exp()) / (1.0 - (-1.0_f64).exp())
    };
    aged(context.date_s) - aged(references.date_s)
}

/// Years of a deterioration that gathers from the first date on, fast at first, and of which a fall takes back a share.
///
/// ```text
/// g(t) = a(t) before the fall at tf, a(t) − 0.7·a(tf) from it on;  a(t) = T·(1 − e^(−(t − t1)/T))/(1 − e^−1)   [virtual.18]
/// ```
fn gathered_years(effect: &PlannedEffect, context: &EffectContext<'_>) -> f64 {
    let references = context.references;
    let first = EffectContext {
        references: &References { date_s: references.first_date_s, ..*references },
        ..*context
    };
    let fall_s = step_date_s(effect, references);
    let gathered = aged_years(&first);
    if context.date_s < fall_s {
        return gathered;
    }
    gathered - TAKEN_BACK * aged_years(&EffectContext { date_s: fall_s, ..first })
}
