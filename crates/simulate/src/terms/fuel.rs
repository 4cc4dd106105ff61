//! Fuel flow for thrust, assembled.

use super::{MAXIMUM_ENGINES, Terms};
use crate::aircraft::{AircraftTruth, Engine, TruthPhysics, part_load_factor, tsfc_kg_n_s};

/// Static pressures between which combustion loses efficiency: no loss above the first, full loss below the second, Pa
/// (FL340, FL475).
const COMBUSTOR_PRESSURES_PA: (f64, f64) = (25_000.0, 13_000.0);
/// Temperature of the fuel at which the fuel-temperature effect is zero, and the range of its size, K.
const FUEL_TEMPERATURE: (f64, f64) = (268.0, 30.0);
/// Curvature of the throttle effect below and above its pivot, over that of the library's parabola.
const THROTTLE_HALVES: (f64, f64) = (1.15, 0.70);

/// The variables of fuel flow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FuelInputs {
    pub(crate) mach: f64,
    pub(crate) temperature_ratio: f64,
    pub(crate) static_pressure_pa: f64,
    pub(crate) pressure_ratio: f64,
    /// All engines together, N.
    pub(crate) thrust_n: f64,
    /// Maximum of all engines together, N.
    pub(crate) maximum_thrust_n: f64,
    pub(crate) anti_ice: bool,
    pub(crate) fuel_temperature_k: f64,
}

/// Each engine's share of the thrust.
pub(crate) type FuelShares = [f64; MAXIMUM_ENGINES];

/// A throttle curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ThrottleTerm {
    pub(crate) size: f64,
    pub(crate) pivot: f64,
    pub(crate) reference_corrected_thrust_n: f64,
}

/// Share of an effect's size at a point.
pub(crate) type FuelForm = fn(&FuelInputs) -> f64;

/// Terms of the fuel flow.
#[derive(Clone, Debug)]
pub(crate) struct FuelTerms {
    /// Factor of the TSFC of each engine: deterioration, ageing, factors.
    pub(crate) engine_factor: [f64; MAXIMUM_ENGINES],
    /// Power of M/Mref, and Mref.
    pub(crate) mach_power: Option<(f64, f64)>,
    /// Power of θ beyond one half.
    pub(crate) temperature_power: f64,
    /// Relative growth per relative growth of θ, and θref.
    pub(crate) temperature_line: Option<(f64, f64)>,
    /// Whether the engine's own part-load curve is used.
    pub(crate) part_load: bool,
    pub(crate) throttle: Vec<ThrottleTerm>,
    /// Constant fuel flow, kg/s.
    pub(crate) offtake_kg_s: f64,
    /// Fuel flow that grows with √θ, and θref, kg/s.
    pub(crate) power_offtake: Option<(f64, f64)>,
    /// Relative fuel flow while anti-ice is on, at a reference corrected thrust, N.
    pub(crate) anti_ice: Option<(f64, f64)>,
    /// Growth of all fuel flow by forms of their own: relative size, and the share of it at a point.
    pub(crate) added: Vec<(f64, FuelForm)>,
    /// Reference over actual heating value: factor of all fuel.
    pub(crate) heating_value_factor: f64,
}

impl FuelTerms {
    pub(super) fn new(aircraft: &AircraftTruth, physics: TruthPhysics) -> Self {
        let engine = &aircraft.engine;
        Self {
            engine_factor: [1.0; MAXIMUM_ENGINES],
            mach_power: None,
            temperature_power: physics.temperature_exponent.factor()
                * engine.extra_temperature_exponent,
            temperature_line: None,
            part_load: physics.part_load.is_on(),
            throttle: Vec::new(),
            offtake_kg_s: physics.offtake.factor() * engine.offtake_fuel_flow_kg_s,
            power_offtake: None,
            anti_ice: None,
            added: Vec::new(),
            heating_value_factor: 1.0,
        }
    }
}

impl Terms {
    /// Fuel flow of each engine, kg/s; engines beyond the aircraft's stay 0.
    pub(crate) fn fuel_flow_kg_s(
        &self,
        engine: &Engine,
        at: &FuelInputs,
        shares: &FuelShares,
    ) -> [f64; MAXIMUM_ENGINES] {
        let terms = &self.fuel;
        let count = usize::from(engine.count);
        let corrected_thrust_n = at.thrust_n / at.pressure_ratio;

        let mut tsfc = tsfc_kg_n_s(&engine.tsfc, at.mach, at.temperature_ratio);
        if terms.temperature_power != 0.0 {
            tsfc *= at.temperature_ratio.powf(terms.temperature_power);
        }
        if terms.part_load {
            tsfc *= part_load_factor(&engine.part_load, at.thrust_n / at.maximum_thrust_n);
        }
        if let Some((power, reference)) = terms.mach_power {
            tsfc *= (at.mach / reference).powf(power);
        }
        if let Some((slope, reference)) = terms.temperature_line {
            tsfc *= 1.0 + slope * (at.temperature_ratio / reference - 1.0);
        }
        for throttle in &terms.throttle {
            tsfc *= 1.0 + throttle_growth(throttle, corrected_thrust_n);
        }

        // Fuel that makes no thrust.
        let mut aside_kg_s = terms.offtake_kg_s;
        if let Some((at_reference_kg_s, reference)) = terms.power_offtake {
            aside_kg_s += at_reference_kg_s * (at.temperature_ratio / reference).sqrt();
        }

        let mut all = terms.heating_value_factor;
        if at.anti_ice
            && let Some((size, reference_n)) = terms.anti_ice
        {
            all *= 1.0 + size * (reference_n / corrected_thrust_n.max(0.1 * reference_n)).sqrt();
        }
        for (size, share) in &terms.added {
            all *= 1.0 + size * share(at);
        }

        let mut flows = [0.0; MAXIMUM_ENGINES];
        let aside_each_kg_s = aside_kg_s / f64::from(engine.count);
        for k in 0..count {
            flows[k] =
                (at.thrust_n * shares[k] * tsfc * terms.engine_factor[k] + aside_each_kg_s) * all;
        }
        flows
    }
}

/// Combustion that loses efficiency at low static pressure.
pub(crate) fn combustor_loss(at: &FuelInputs) -> f64 {
    let (none, whole) = COMBUSTOR_PRESSURES_PA;
    let deep = ((none - at.static_pressure_pa) / (none - whole)).clamp(0.0, 1.0);
    deep * deep
}

/// Fuel warmer than the reference.
pub(crate) fn warm_fuel(at: &FuelInputs) -> f64 {
    (at.fuel_temperature_k - FUEL_TEMPERATURE.0) / FUEL_TEMPERATURE.1
}

/// Relative growth of TSFC off the pivot: steeper below than above.
///
/// ```text
/// θ·h·((x − xp)/0.25)²,  h = 1.15 below, 0.70 above                 [virtual.13]
/// ```
fn throttle_growth(term: &ThrottleTerm, corrected_thrust_n: f64) -> f64 {
    let distance = (corrected_thrust_n / term.reference_corrected_thrust_n - term.pivot) / 0.25;
    let half = if distance < 0.0 { THROTTLE_HALVES.0 } else { THROTTLE_HALVES.1 };
    term.size * half * distance * distance
}
