//! Effects of what is recorded: load sheet, fuel quantity, sensors.

use super::{
    DrivingVariable, EffectEntry, EffectGroup, EffectSign, HiddenParameter, NeededInput, Phrase,
    TypicalSize,
};

/// Zero-fuel mass recorded wrongly.
pub(super) const ZERO_FUEL_MASS_BIAS: EffectEntry = EffectEntry {
    name: "zero_fuel_mass_bias",
    group: EffectGroup::Mass,
    unit: "kg",
    typical: TypicalSize::ShareOfMass(0.015),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::LiftCoefficient, DrivingVariable::Mass],
    perturbation: "mass + θ (true minus recorded)",
    phrase: Phrase {
        positive: "the aircraft is heavier than recorded",
        negative: "the aircraft is lighter than recorded",
    },
};

/// Fuel used recorded wrongly.
pub(super) const FUEL_QUANTITY_GAIN: EffectEntry = EffectEntry {
    name: "fuel_quantity_gain",
    group: EffectGroup::Mass,
    unit: "%",
    typical: TypicalSize::Absolute(3.0),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::FuelUsed, DrivingVariable::Mass],
    perturbation: "fuel used is θ less than recorded",
    phrase: Phrase {
        positive: "less fuel was used than recorded",
        negative: "more fuel was used than recorded",
    },
};

/// Mach number reads high.
pub(super) const MACH_BIAS: EffectEntry = EffectEntry {
    name: "mach_bias",
    group: EffectGroup::Sensor,
    unit: "Mach",
    typical: TypicalSize::Absolute(0.004),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::Mach, DrivingVariable::LiftCoefficient],
    perturbation: "recorded Mach number reads θ high, and TAS with it",
    phrase: Phrase { positive: "Mach number reads high", negative: "Mach number reads low" },
};

/// Static pressure reads high.
pub(super) const STATIC_PRESSURE_BIAS: EffectEntry = EffectEntry {
    name: "static_pressure_bias",
    group: EffectGroup::Sensor,
    unit: "% of p",
    typical: TypicalSize::Absolute(0.3),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::Mach, DrivingVariable::LiftCoefficient],
    perturbation: "static pressure reads θ high (ALT, M, TAS follow)",
    phrase: Phrase {
        positive: "static pressure reads high",
        negative: "static pressure reads low",
    },
};

/// Static air temperature reads high.
pub(super) const TEMPERATURE_BIAS: EffectEntry = EffectEntry {
    name: "temperature_bias",
    group: EffectGroup::Sensor,
    unit: "K",
    typical: TypicalSize::Absolute(2.0),
    sign: EffectSign::Either,
    needs: &[NeededInput::StaticAirTemperature],
    hidden: HiddenParameter::None,
    driven_by: &[],
    perturbation: "SAT reads θ high, and TAS with it",
    phrase: Phrase { positive: "SAT reads high", negative: "SAT reads low" },
};

/// Fuel flow of all engines reads high.
pub(super) const FUEL_FLOW_GAIN: EffectEntry = EffectEntry {
    name: "fuel_flow_gain",
    group: EffectGroup::Sensor,
    unit: "%",
    typical: TypicalSize::Absolute(2.0),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[],
    perturbation: "recorded Wf reads θ high; FU with it unless gauges say otherwise",
    phrase: Phrase {
        positive: "the fuel-flow meters read high",
        negative: "the fuel-flow meters read low",
    },
};

/// Fuel flow of one engine reads high.
pub(super) const FUEL_FLOW_GAIN_ENGINE: EffectEntry = EffectEntry {
    name: "fuel_flow_gain_{k}",
    group: EffectGroup::Sensor,
    unit: "%",
    typical: TypicalSize::Absolute(3.0),
    sign: EffectSign::Either,
    needs: &[NeededInput::FuelFlowPerEngine],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::Engine],
    perturbation: "recorded Wf of engine k reads θ high; FU with it unless gauges say otherwise",
    phrase: Phrase {
        positive: "the fuel-flow meter of engine {k} reads high",
        negative: "the fuel-flow meter of engine {k} reads low",
    },
};
