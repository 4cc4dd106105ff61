//! The engines: maximum thrust, fuel for thrust, rotor speeds and exhaust temperature.

use serde::{Deserialize, Serialize};

/// One of the aircraft's engines; all are alike unless a plan states differences.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Engine {
    /// How many, 1 to 4.
    pub count: u8,
    /// Maximum thrust of one at sea level, at rest, N.
    pub rated_thrust_n: f64,
    /// How the maximum falls with flight condition.
    pub lapse: ThrustLapse,
    /// Fuel for thrust at the best part load.
    pub tsfc: TsfcLaw,
    /// The penalty of other part loads.
    pub part_load: PartLoad,
    /// Fuel for bleed and shaft power, all engines together, whatever the thrust, kg/s.
    pub offtake_fuel_flow_kg_s: f64,
    /// Excess of the exponent of temperature in the fuel law over one half.
    pub extra_temperature_exponent: f64,
    /// Rotor speeds and exhaust temperature.
    pub rotors: RotorDeck,
    /// Lower heating value for which the fuel law holds, MJ/kg.
    pub reference_lower_heating_value_mj_kg: f64,
}

/// Thrust lapse over total pressure and temperature ratio and Mach number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThrustLapse {
    /// Loss per square root of Mach number.
    pub per_sqrt_mach: f64,
    /// Exponent of the falling total temperature ratio.
    pub temperature_exponent: f64,
}

/// TSFC at the best part load, of one engine without offtake.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TsfcLaw {
    /// At rest at θ = 1, kg/(N s).
    pub static_kg_n_s: f64,
    /// Exponent of 1 + M.
    pub mach_exponent: f64,
}

/// Relative TSFC over thrust, as two parabolas about the best load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartLoad {
    /// Thrust over maximum thrust where TSFC is lowest.
    pub best: f64,
    /// Curvature below: relative TSFC per squared distance.
    pub below: f64,
    /// Curvature above.
    pub above: f64,
}

/// Rotor speeds and exhaust temperature from thrust and fuel flow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotorDeck {
    /// High-pressure rotor, % at θt = 1, F/δ = rated thrust, M 0.8.
    pub n2_percent: f64,
    /// d ln N2/d ln(F/δ).
    pub n2_slope: f64,
    /// Second-order coefficient of the same.
    pub n2_curvature: f64,
    /// d ln N2/dM at constant F/δ.
    pub n2_per_mach: f64,
    /// d ln N2/d ln δ: Reynolds number of the compressor.
    pub n2_per_ln_delta: f64,
    /// Low-pressure rotor, % at the same point.
    pub n1_percent: f64,
    /// d ln N1/d ln(F/δ).
    pub n1_slope: f64,
    /// Exhaust gas over inlet total temperature without fuel.
    pub egt_ratio_at_no_fuel: f64,
    /// Growth of that ratio per corrected fuel flow over rated fuel flow.
    pub egt_ratio_per_fuel: f64,
}

/// Maximum net thrust of one engine.
///
/// ```text
/// Fmax = Frated·δt·(1 − b·√M)·θt^−c                                 [virtual.6]
/// ```
///
/// with total pressure and temperature ratios δt, θt.
///
/// # Source
/// Shape after Mattingly, Heiser and Pratt, *Aircraft Engine Design*, 2nd edition, section 2.3.2; b and c are fitted to
/// the type's published ceiling and maximum cruise Mach number, as stated in its preset.
pub(crate) fn maximum_thrust_n(
    of: &Engine,
    mach: f64,
    total_temperature_ratio: f64,
    total_pressure_ratio: f64,
) -> f64 {
    of.rated_thrust_n
        * total_pressure_ratio
        * (1.0 - of.lapse.per_sqrt_mach * mach.sqrt())
        * total_temperature_ratio.powf(-of.lapse.temperature_exponent)
}

/// TSFC at the best part load and without offtake, kg/(N s).
///
/// ```text
/// c = c0·√θ·(1 + M)^n                                               [virtual.7]
/// ```
///
/// # Source
/// Ghazi et al. (2020), equation (5).
pub(crate) fn tsfc_kg_n_s(of: &TsfcLaw, mach: f64, temperature_ratio: f64) -> f64 {
    of.static_kg_n_s * temperature_ratio.sqrt() * (1.0 + mach).powf(of.mach_exponent)
}

/// Relative TSFC at a part load, 1 at the best.
///
/// ```text
/// φ = 1 + k·(r − rbest)²,  r = F/Fmax,  k below or above the best    [virtual.8]
/// ```
pub(crate) fn part_load_factor(of: &PartLoad, load: f64) -> f64 {
    let distance = load - of.best;
    let curvature = if distance < 0.0 { of.below } else { of.above };
    1.0 + curvature * distance * distance
}

/// Speed of the high-pressure rotor, %.
///
/// ```text
/// N2 = N2ref·√θt·exp(a·ln x + b·ln²x + c·(M − 0.8) + d·ln δ),  x = F/(δ·Frated)   [virtual.9]
/// ```
pub(crate) fn n2_percent(
    of: &Engine,
    mach: f64,
    total_temperature_ratio: f64,
    pressure_ratio: f64,
    thrust_n: f64,
) -> f64 {
    let deck = &of.rotors;
    let ln_x = (thrust_n / (pressure_ratio * of.rated_thrust_n)).ln();
    let exponent = deck.n2_slope * ln_x
        + deck.n2_curvature * ln_x * ln_x
        + deck.n2_per_mach * (mach - 0.8)
        + deck.n2_per_ln_delta * pressure_ratio.ln();
    deck.n2_percent * total_temperature_ratio.sqrt() * exponent.exp()
}

/// Speed of the low-pressure rotor, %: N1 = N1ref·√θt·x^a. `[virtual.10]`
pub(crate) fn n1_percent(
    of: &Engine,
    total_temperature_ratio: f64,
    pressure_ratio: f64,
    thrust_n: f64,
) -> f64 {
    let x = thrust_n / (pressure_ratio * of.rated_thrust_n);
    of.rotors.n1_percent * total_temperature_ratio.sqrt() * x.powf(of.rotors.n1_slope)
}

/// Exhaust gas temperature: TAT times a ratio that grows with corrected fuel flow.
///
/// ```text
/// EGT = TAT·(r0 + r1·φ),  φ = Wf/(δt·√θt·Wf,rated)                  [virtual.11]
/// ```
///
/// It depends on the fuel and not on the thrust: an engine that needs more fuel runs hotter at the same thrust.
pub(crate) fn exhaust_gas_temperature_k(
    of: &Engine,
    total_temperature_k: f64,
    total_temperature_ratio: f64,
    total_pressure_ratio: f64,
    fuel_flow_kg_s: f64,
) -> f64 {
    let rated_fuel_flow_kg_s = of.rated_thrust_n * of.tsfc.static_kg_n_s;
    let corrected = fuel_flow_kg_s
        / (total_pressure_ratio * total_temperature_ratio.sqrt() * rated_fuel_flow_kg_s);
    total_temperature_k
        * (of.rotors.egt_ratio_at_no_fuel + of.rotors.egt_ratio_per_fuel * corrected)
}
