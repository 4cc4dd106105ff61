//! The library of physical effects: id, group, unit of the size, typical size and needed inputs, defined once.
//!
//! The physics of an effect is where its quantity lives; library table, help, docs and report are made from here.

use core::fmt;

use crate::MAXIMUM_ENGINES;

/// A physical effect that a performance model may lack.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EffectId {
    /// More (or less) drag at zero lift.
    ZeroLiftDrag,
    /// All drag scaled.
    DragFactor,
    /// Lift-dependent drag scaled.
    InducedDrag,
    /// Earlier or later drag rise with Mach number.
    WaveDrag,
    /// Friction that follows the Reynolds number.
    ReynoldsNumber,
    /// Trim drag with the center of gravity.
    TrimDragCg,
    /// Drag of flying with a wing low.
    AsymmetryDrag,
    /// Lift that a turn asks for.
    LoadFactor,
    /// Zero-lift drag that grows with age.
    AirframeAgeing,
    /// TSFC scaled, all engines.
    TsfcFactor,
    /// TSFC of one engine scaled.
    TsfcEngine(u8),
    /// Another exponent of Mach number in the TSFC law.
    TsfcMachExponent,
    /// Another exponent of temperature in the TSFC law.
    TsfcTemperatureExponent,
    /// TSFC that depends on thrust.
    TsfcThrottle,
    /// Constant fuel flow for power and bleed.
    PowerOfftake,
    /// Fuel for anti-ice bleed while it is on.
    AntiIceBleed,
    /// TSFC that grows with age.
    EngineAgeing,
    /// Flight-to-flight scatter of the fuel's heating value.
    FuelHeatingValue,
    /// Zero-fuel mass recorded wrongly.
    ZeroFuelMassBias,
    /// Fuel used recorded wrongly.
    FuelQuantityGain,
    /// Mach number reads high.
    MachBias,
    /// Static pressure reads high.
    StaticPressureBias,
    /// Static air temperature reads high.
    TemperatureBias,
    /// Fuel flow of all engines reads high.
    FuelFlowGain,
    /// Fuel flow of one engine reads high.
    FuelFlowGainEngine(u8),
    /// Gravity by latitude and height.
    LocalGravity,
    /// Lift saved or asked for by the Earth's rotation and curvature.
    RotatingEarth,
    /// Climb along a sloping pressure surface.
    IsobaricSlope,
    /// A step on an estimated date.
    StepChange,
}

/// What an effect belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EffectGroup {
    /// The airframe's drag.
    Airframe,
    /// The engines' consumption.
    Engine,
    /// What the aircraft weighs.
    Mass,
    /// What the sensors say.
    Sensor,
    /// The Earth and its air.
    Environment,
    /// A dated event.
    Event,
}

/// The size that is usual for an effect, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TypicalSize {
    /// A number in the effect's unit.
    Absolute(f64),
    /// This share of the aircraft's mass, in kg.
    ShareOfMass(f64),
    /// The coefficient is known from physics and is 1.
    Known,
}

/// An input beyond the required columns that an effect needs to be testable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NeededInput {
    /// `CG`.
    CenterOfGravity,
    /// `ROLL`.
    Roll,
    /// `WF(k)`: fuel flow engine by engine.
    FuelFlowPerEngine,
    /// `A/I`; static air temperature above −40 °C stands in where it is not recorded.
    AntiIce,
    /// `LAT`.
    Latitude,
    /// `HDG`.
    TrueHeading,
    /// `DRIFT`.
    Drift,
}

impl NeededInput {
    /// Whether something stands in for the input where it is not recorded, so that effects that act through it can be
    /// predicted and tested all the same: static air temperature above −40 °C for anti-ice bleed (our choice: bleed is
    /// used in visible moisture, of which there is little below).
    #[must_use]
    pub const fn has_substitute(self) -> bool {
        matches!(self, Self::AntiIce)
    }

    /// The column's name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::CenterOfGravity => "CG",
            Self::Roll => "ROLL",
            Self::FuelFlowPerEngine => "WF(k)",
            Self::AntiIce => "A/I",
            Self::Latitude => "LAT",
            Self::TrueHeading => "HDG",
            Self::Drift => "DRIFT",
        }
    }
}

/// What the library says about an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectEntry {
    /// What it belongs to.
    pub group: EffectGroup,
    /// Unit of its size θ.
    pub unit: &'static str,
    /// Usual size in that unit.
    pub typical: TypicalSize,
    /// Inputs beyond the required columns that it acts through. Without one of them it can neither be predicted nor tested,
    /// unless something stands in ([`NeededInput::has_substitute`]).
    pub needs: &'static [NeededInput],
    /// What θ does to the model, in one line.
    pub perturbation: &'static str,
}

const STEM_TSFC_ENGINE: &str = "tsfc_engine_";
const STEM_FUEL_FLOW_GAIN: &str = "fuel_flow_gain_";

impl EffectId {
    /// Every effect for an aircraft with this many engines, in the library's order. Effects of single engines are
    /// there for two engines and more.
    #[must_use]
    pub fn library(engines: usize) -> Vec<Self> {
        let single = |of: fn(u8) -> Self| {
            let count = if engines < 2 { 0 } else { engines.min(MAXIMUM_ENGINES) };
            (1_u8..).take(count).map(of)
        };
        let mut all = vec![
            Self::ZeroLiftDrag,
            Self::DragFactor,
            Self::InducedDrag,
            Self::WaveDrag,
            Self::ReynoldsNumber,
            Self::TrimDragCg,
            Self::AsymmetryDrag,
            Self::LoadFactor,
            Self::AirframeAgeing,
            Self::TsfcFactor,
        ];
        all.extend(single(Self::TsfcEngine));
        all.extend([
            Self::TsfcMachExponent,
            Self::TsfcTemperatureExponent,
            Self::TsfcThrottle,
            Self::PowerOfftake,
            Self::AntiIceBleed,
            Self::EngineAgeing,
            Self::FuelHeatingValue,
            Self::ZeroFuelMassBias,
            Self::FuelQuantityGain,
            Self::MachBias,
            Self::StaticPressureBias,
            Self::TemperatureBias,
            Self::FuelFlowGain,
        ]);
        all.extend(single(Self::FuelFlowGainEngine));
        all.extend([
            Self::LocalGravity,
            Self::RotatingEarth,
            Self::IsobaricSlope,
            Self::StepChange,
        ]);
        all
    }

    /// The effect of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::library(MAXIMUM_ENGINES).into_iter().find(|id| id.to_string() == name)
    }

    /// Whether it is about what was recorded (sensors, load sheet, fuel quantity) and not about what flies: it then corrects
    /// recordings, and never a prediction.
    #[must_use]
    pub const fn is_of_recordings(self) -> bool {
        matches!(self.entry().group, EffectGroup::Mass | EffectGroup::Sensor)
    }

    /// The library's entry.
    #[must_use]
    #[expect(clippy::too_many_lines, reason = "one table: splitting it would hide it")]
    pub const fn entry(self) -> EffectEntry {
        use EffectGroup::{Airframe, Engine, Environment, Event, Mass, Sensor};
        use NeededInput as N;
        use TypicalSize::{Absolute, Known, ShareOfMass};
        const fn entry(
            group: EffectGroup,
            unit: &'static str,
            typical: TypicalSize,
            needs: &'static [NeededInput],
            perturbation: &'static str,
        ) -> EffectEntry {
            EffectEntry { group, unit, typical, needs, perturbation }
        }
        match self {
            Self::ZeroLiftDrag => entry(Airframe, "drag counts", Absolute(5.0), &[], "CD + θ·1e-4"),
            Self::DragFactor => entry(Airframe, "%", Absolute(2.0), &[], "CD·(1 + θ)"),
            Self::InducedDrag => entry(Airframe, "% of K", Absolute(6.0), &[], "CD + θ K(M) CL²"),
            Self::WaveDrag => entry(
                Airframe,
                "Mach",
                Absolute(0.006),
                &[],
                "CD + w(M, Mdd − θ) − w(M, Mdd), w = 20 max(0, M − Mdd + 0.1077)⁴",
            ),
            Self::ReynoldsNumber => entry(
                Airframe,
                "exponent",
                Absolute(0.12),
                &[],
                "zero-lift drag share × (Re/Re_ref)^−θ",
            ),
            Self::TrimDragCg => entry(
                Airframe,
                "counts per 10 %MAC forward",
                Absolute(3.0),
                &[N::CenterOfGravity],
                "CD + θ·1e-4·(CG_ref − CG)/10 %MAC · CL/0.4",
            ),
            Self::AsymmetryDrag => entry(
                Airframe,
                "counts/deg²",
                Absolute(1.0),
                &[N::Roll],
                "CD + θ·1e-4·roll² (wings-level segments)",
            ),
            Self::LoadFactor => {
                entry(Airframe, "known, 1", Known, &[N::Roll], "lift × 1/cos(roll)")
            }
            Self::AirframeAgeing => entry(
                Airframe,
                "%/year",
                Absolute(1.2),
                &[],
                "zero-lift drag share × (1 + θ·years since reference)",
            ),
            Self::TsfcFactor => entry(Engine, "%", Absolute(2.0), &[], "TSFC·(1 + θ)"),
            Self::TsfcEngine(_) => entry(
                Engine,
                "%",
                Absolute(3.0),
                &[N::FuelFlowPerEngine],
                "TSFC of engine k ·(1 + θ)",
            ),
            Self::TsfcMachExponent => {
                entry(Engine, "exponent", Absolute(0.15), &[], "TSFC·((1 + M)/(1 + M_ref))^θ")
            }
            Self::TsfcTemperatureExponent => {
                entry(Engine, "exponent", Absolute(0.20), &[], "TSFC·(θ_T/θ_T,ref)^θ, θ_T = SAT/T0")
            }
            Self::TsfcThrottle => entry(
                Engine,
                "%",
                Absolute(0.6),
                &[],
                "TSFC·(1 + θ ((x − x_p)/0.25)²), x corrected thrust over its reference, or N2",
            ),
            Self::PowerOfftake => entry(Engine, "%", Absolute(2.0), &[], "Wf + θ·(mean Wf)"),
            Self::AntiIceBleed => {
                entry(Engine, "%", Absolute(2.0), &[N::AntiIce], "Wf·(1 + θ) while on")
            }
            Self::EngineAgeing => entry(Engine, "%/year", Absolute(0.8), &[], "TSFC·(1 + θ·years)"),
            Self::FuelHeatingValue => entry(
                Engine,
                "% rms",
                Absolute(0.6),
                &[],
                "flight-to-flight scatter of Wf beyond noise",
            ),
            Self::ZeroFuelMassBias => {
                entry(Mass, "kg", ShareOfMass(0.015), &[], "mass + θ (true minus recorded)")
            }
            Self::FuelQuantityGain => {
                entry(Mass, "%", Absolute(3.0), &[], "fuel used is θ less than recorded")
            }
            Self::MachBias => entry(
                Sensor,
                "Mach",
                Absolute(0.004),
                &[],
                "recorded Mach number reads θ high, and TAS with it",
            ),
            Self::StaticPressureBias => entry(
                Sensor,
                "% of p",
                Absolute(0.3),
                &[],
                "static pressure reads θ high (ALT, M, TAS follow)",
            ),
            Self::TemperatureBias => {
                entry(Sensor, "K", Absolute(2.0), &[], "SAT reads θ high, and TAS with it")
            }
            Self::FuelFlowGain => entry(
                Sensor,
                "%",
                Absolute(2.0),
                &[],
                "recorded Wf reads θ high; FU with it unless gauges say otherwise",
            ),
            Self::FuelFlowGainEngine(_) => entry(
                Sensor,
                "%",
                Absolute(3.0),
                &[N::FuelFlowPerEngine],
                "recorded Wf of engine k reads θ high; FU with it unless gauges say otherwise",
            ),
            Self::LocalGravity => {
                entry(Environment, "known, 1", Known, &[N::Latitude], "g(latitude, height) for g0")
            }
            Self::RotatingEarth => entry(
                Environment,
                "known, 1",
                Known,
                &[N::Latitude, N::TrueHeading],
                "g − (2Ω V_east cos φ + V²/R)",
            ),
            Self::IsobaricSlope => entry(
                Environment,
                "1",
                Absolute(0.5),
                &[N::Latitude, N::Drift],
                "thrust + θ m f V_cross, f = 2Ω sin φ, V_cross from drift",
            ),
            Self::StepChange => {
                entry(Event, "%", Absolute(1.5), &[], "Wf or CD ·(1 + θ) from an estimated date on")
            }
        }
    }
}

impl fmt::Display for EffectId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ZeroLiftDrag => "zero_lift_drag",
            Self::DragFactor => "drag_factor",
            Self::InducedDrag => "induced_drag",
            Self::WaveDrag => "wave_drag",
            Self::ReynoldsNumber => "reynolds_number",
            Self::TrimDragCg => "trim_drag_cg",
            Self::AsymmetryDrag => "asymmetry_drag",
            Self::LoadFactor => "load_factor",
            Self::AirframeAgeing => "airframe_ageing",
            Self::TsfcFactor => "tsfc_factor",
            Self::TsfcEngine(k) => return write!(f, "{STEM_TSFC_ENGINE}{k}"),
            Self::TsfcMachExponent => "tsfc_mach_exponent",
            Self::TsfcTemperatureExponent => "tsfc_temperature_exponent",
            Self::TsfcThrottle => "tsfc_throttle",
            Self::PowerOfftake => "power_offtake",
            Self::AntiIceBleed => "anti_ice_bleed",
            Self::EngineAgeing => "engine_ageing",
            Self::FuelHeatingValue => "fuel_heating_value",
            Self::ZeroFuelMassBias => "zero_fuel_mass_bias",
            Self::FuelQuantityGain => "fuel_quantity_gain",
            Self::MachBias => "mach_bias",
            Self::StaticPressureBias => "static_pressure_bias",
            Self::TemperatureBias => "temperature_bias",
            Self::FuelFlowGain => "fuel_flow_gain",
            Self::FuelFlowGainEngine(k) => return write!(f, "{STEM_FUEL_FLOW_GAIN}{k}"),
            Self::LocalGravity => "local_gravity",
            Self::RotatingEarth => "rotating_earth",
            Self::IsobaricSlope => "isobaric_slope",
            Self::StepChange => "step_change",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_both_ways_and_are_unique() {
        let library = EffectId::library(4);
        let names: std::collections::BTreeSet<String> =
            library.iter().map(ToString::to_string).collect();
        assert_eq!(names.len(), library.len());
        for id in library {
            assert_eq!(EffectId::from_name(&id.to_string()), Some(id));
        }
        assert_eq!(EffectId::from_name("tsfc_engine_5"), None);
        assert_eq!(EffectId::from_name("magic"), None);
    }

    #[test]
    fn effects_of_single_engines_follow_the_number_of_engines() {
        // The contract's table has 29 rows, two of which stand for one effect an engine (a single engine is 'all').
        assert_eq!(EffectId::library(1).len(), 27);
        assert_eq!(EffectId::library(2).len(), 31);
        assert!(EffectId::library(2).contains(&EffectId::TsfcEngine(2)));
        assert!(!EffectId::library(2).contains(&EffectId::TsfcEngine(3)));
    }
}
