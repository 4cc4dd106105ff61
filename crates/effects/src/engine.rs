//! Effects on TSFC and fuel flow, and on the readings of the flow meters.

use flight::MAXIMUM_ENGINES;
use flight::effect::{EffectId, ThrottleArgument};

use crate::drag::years_since_reference;
use crate::point::EffectPoint;
use crate::recorded::AsFlown;
use crate::terms::{Layers, Terms};

/// Static air temperature above which anti-ice bleed counts as on where it is not recorded, K: −40 °C. Our choice: colder air
/// holds hardly any supercooled water.
pub const ANTI_ICE_PROXY_K: f64 = 233.15;
/// Width of the throttle effect's parabola, of corrected thrust over its reference. Our choice.
const THROTTLE_WIDTH: f64 = 0.25;

/// Thrust, and the fuel flow that it costs without effects.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Thrust {
    /// Net thrust of all engines, N.
    pub(crate) net_thrust_n: f64,
    /// The same over pressure ratio, N.
    pub(crate) corrected_thrust_n: f64,
    /// TSFC by the aircraft's law, kg/(N s).
    pub(crate) tsfc_kg_per_n_s: f64,
    /// Number of engines.
    pub(crate) engines: usize,
}

/// Fuel flow that would be recorded: of all engines, and of each.
///
/// ```text
/// e = (1 + θf)·((1 + M)/(1 + M_ref))^θM·(θT/θT,ref)^θt·(1 + θx((x − xp)/0.25)²)·(1 + θa t)·(1 + θh h(t))    [diagnosis.9]
/// Wf_k = (F/n·TSFC·e·(1 + θ_k) + θo·W̄f/n)·(1 + θb·on)·(1 + θs from the date on)               [diagnosis.10]
/// recorded Wf_k = Wf_k·(1 + θWF,k)                                                             [diagnosis.11]
/// ```
///
/// x is corrected thrust over its reference, or the one that N2 indicates ([`ThrottleArgument`]); TSFC is the
/// aircraft's law.
/// Engines give equal thrust. Factors of all layers multiply, offtakes add.
pub(crate) fn recorded_fuel_flow(
    thrust: &Thrust,
    point: &EffectPoint,
    flown: &AsFlown,
    layers: Layers<'_>,
) -> (f64, [f64; MAXIMUM_ENGINES]) {
    let Thrust { net_thrust_n, corrected_thrust_n, tsfc_kg_per_n_s, engines } = *thrust;
    let (mut factor, mut all) = (1.0, 1.0);
    for terms in layers.iter() {
        factor *= tsfc_factor(corrected_thrust_n, point, flown, terms);
        if terms.size(EffectId::AntiIceBleed) != 0.0 {
            all *= 1.0 + terms.size(EffectId::AntiIceBleed) * anti_ice_on(point, flown);
        }
        if terms.step_fuel_flow != 0.0 && terms.date_s(point.date_s) >= terms.step_from_s {
            all *= 1.0 + terms.step_fuel_flow;
        }
    }
    let share = 1.0 / engines as f64;
    let thrust_flow_kg_s = net_thrust_n * tsfc_kg_per_n_s * factor * share;
    let aside_kg_s = layers
        .sum(|terms| terms.size(EffectId::PowerOfftake) * terms.references.fuel_flow_total_kg_s)
        * share;
    let mut each = [0.0; MAXIMUM_ENGINES];
    let mut total = 0.0;
    for (engine, flow) in each.iter_mut().enumerate().take(engines) {
        let factor_of = |terms: &Terms| {
            let is_after = terms.date_s(point.date_s) >= terms.step_from_s;
            let step = if is_after { terms.step_engine[engine] } else { 0.0 };
            (1.0 + terms.tsfc_engine[engine]) * (1.0 + step)
        };
        let own = layers.contained.iter().map(factor_of).product::<f64>() * factor_of(layers.trial);
        // Meters belong to the trial layer alone: the meter errors that the model contains were corrected in the
        // recordings before.
        let meter = 1.0 + layers.trial.fuel_flow_gain[engine];
        *flow = (thrust_flow_kg_s * own + aside_kg_s) * all * meter;
        total += *flow;
    }
    (total, each)
}

/// Factor of one layer on the TSFC of all engines, `[diagnosis.9]`.
fn tsfc_factor(
    corrected_thrust_n: f64,
    point: &EffectPoint,
    flown: &AsFlown,
    terms: &Terms,
) -> f64 {
    let references = &terms.references;
    let mut factor = 1.0 + terms.size(EffectId::TsfcFactor);
    if terms.size(EffectId::TsfcMachExponent) != 0.0 {
        factor *= ((1.0 + flown.mach) / (1.0 + references.mach))
            .powf(terms.size(EffectId::TsfcMachExponent));
    }
    if terms.size(EffectId::TsfcTemperatureExponent) != 0.0 {
        factor *= (flown.temperature_ratio / references.temperature_ratio)
            .powf(terms.size(EffectId::TsfcTemperatureExponent));
    }
    if terms.size(EffectId::TsfcThrottle) != 0.0 {
        let by_n2_n = match terms.throttle_argument {
            ThrottleArgument::CorrectedThrust => None,
            ThrottleArgument::N2 => point.corrected_thrust_by_n2_n,
        };
        let x = by_n2_n.unwrap_or(corrected_thrust_n) / references.corrected_thrust_n;
        let distance = (x - terms.throttle_pivot) / THROTTLE_WIDTH;
        factor *= 1.0 + terms.size(EffectId::TsfcThrottle) * distance * distance;
    }
    if terms.size(EffectId::EngineAgeing) != 0.0 {
        factor *= 1.0 + terms.size(EffectId::EngineAgeing) * years_since_reference(point, terms);
    }
    if terms.size(EffectId::EngineHistory) != 0.0 {
        let years = terms.engine_history.years(terms.date_s(point.date_s));
        factor *= 1.0 + terms.size(EffectId::EngineHistory) * years;
    }
    factor
}

/// Share of a segment with anti-ice bleed on: as recorded, otherwise all of it above −40 °C.
fn anti_ice_on(point: &EffectPoint, flown: &AsFlown) -> f64 {
    point.anti_ice.unwrap_or(if flown.static_air_temperature_k > ANTI_ICE_PROXY_K {
        1.0
    } else {
        0.0
    })
}
