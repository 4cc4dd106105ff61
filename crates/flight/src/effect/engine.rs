//! Effects of the engines' consumption.

use super::{
    DrivingVariable, EffectEntry, EffectGroup, EffectSign, HiddenParameter, History, NeededInput,
    Phrase, ThrottleArgument, TypicalSize,
};

/// TSFC scaled, all engines.
pub(super) const TSFC_FACTOR: EffectEntry = EffectEntry {
    name: "tsfc_factor",
    group: EffectGroup::Engine,
    unit: "%",
    typical: TypicalSize::Absolute(2.0),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[],
    perturbation: "TSFC·(1 + θ)",
    phrase: Phrase { positive: "all engines burn more", negative: "all engines burn less" },
};

/// TSFC of one engine scaled.
pub(super) const TSFC_ENGINE: EffectEntry = EffectEntry {
    name: "tsfc_engine_{k}",
    group: EffectGroup::Engine,
    unit: "%",
    typical: TypicalSize::Absolute(3.0),
    sign: EffectSign::Either,
    needs: &[NeededInput::FuelFlowPerEngine],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::Engine],
    perturbation: "TSFC of engine k ·(1 + θ)",
    phrase: Phrase { positive: "engine {k} burns more", negative: "engine {k} burns less" },
};

/// Another exponent of Mach number in the TSFC law.
pub(super) const TSFC_MACH_EXPONENT: EffectEntry = EffectEntry {
    name: "tsfc_mach_exponent",
    group: EffectGroup::Engine,
    unit: "exponent",
    typical: TypicalSize::Absolute(0.15),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::Mach],
    perturbation: "TSFC·((1 + M)/(1 + M_ref))^θ",
    phrase: Phrase {
        positive: "TSFC rises more with Mach number than the model's",
        negative: "TSFC rises less with Mach number than the model's",
    },
};

/// Another exponent of temperature in the TSFC law.
pub(super) const TSFC_TEMPERATURE_EXPONENT: EffectEntry = EffectEntry {
    name: "tsfc_temperature_exponent",
    group: EffectGroup::Engine,
    unit: "exponent",
    typical: TypicalSize::Absolute(0.20),
    sign: EffectSign::Either,
    needs: &[NeededInput::StaticAirTemperature],
    hidden: HiddenParameter::None,
    driven_by: &[
        DrivingVariable::StaticAirTemperature,
        DrivingVariable::PressureAltitude,
        DrivingVariable::IsaDeviation,
    ],
    perturbation: "TSFC·(θ_T/θ_T,ref)^θ, θ_T = SAT/T0",
    phrase: Phrase {
        positive: "TSFC rises with temperature more than the model's",
        negative: "TSFC rises with temperature less than the model's",
    },
};

/// TSFC that depends on thrust.
pub(super) const TSFC_THROTTLE: EffectEntry = EffectEntry {
    name: "tsfc_throttle",
    group: EffectGroup::Engine,
    unit: "%",
    typical: TypicalSize::Absolute(0.6),
    sign: EffectSign::Positive,
    needs: &[],
    hidden: HiddenParameter::Throttle { pivot: 1.0, argument: ThrottleArgument::CorrectedThrust },
    driven_by: &[
        DrivingVariable::CorrectedThrust,
        DrivingVariable::N2,
        DrivingVariable::PressureAltitude,
        DrivingVariable::Mach,
    ],
    perturbation: "TSFC·(1 + θ ((x − x_p)/0.25)²), x corrected thrust over its reference, or N2",
    phrase: Phrase {
        positive: "TSFC is higher away from the engines' best thrust",
        negative: "TSFC is lower away from the pivot of thrust",
    },
};

/// Constant fuel flow for power and bleed.
pub(super) const POWER_OFFTAKE: EffectEntry = EffectEntry {
    name: "power_offtake",
    group: EffectGroup::Engine,
    unit: "%",
    typical: TypicalSize::Absolute(2.0),
    sign: EffectSign::Positive,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[
        DrivingVariable::PressureAltitude,
        DrivingVariable::Mach,
        DrivingVariable::Mass,
        DrivingVariable::StaticAirTemperature,
        DrivingVariable::LiftCoefficient,
        DrivingVariable::CorrectedThrust,
        DrivingVariable::N2,
    ],
    perturbation: "Wf + θ·(mean Wf)",
    phrase: Phrase {
        positive: "constant fuel flow for power and bleed",
        negative: "less constant fuel flow for power and bleed",
    },
};

/// Fuel for anti-ice bleed while it is on.
pub(super) const ANTI_ICE_BLEED: EffectEntry = EffectEntry {
    name: "anti_ice_bleed",
    group: EffectGroup::Engine,
    unit: "%",
    typical: TypicalSize::Absolute(2.0),
    sign: EffectSign::Positive,
    needs: &[NeededInput::AntiIce],
    hidden: HiddenParameter::None,
    driven_by: &[
        DrivingVariable::AntiIce,
        DrivingVariable::StaticAirTemperature,
        DrivingVariable::PressureAltitude,
    ],
    perturbation: "Wf·(1 + θ) while on",
    phrase: Phrase { positive: "anti-ice bleed costs more", negative: "anti-ice bleed costs less" },
};

/// TSFC that grows with age.
pub(super) const ENGINE_AGEING: EffectEntry = EffectEntry {
    name: "engine_ageing",
    group: EffectGroup::Engine,
    unit: "%/year",
    typical: TypicalSize::Absolute(0.8),
    sign: EffectSign::Positive,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::Date],
    perturbation: "TSFC·(1 + θ·years)",
    phrase: Phrase { positive: "TSFC grows with age", negative: "TSFC falls with age" },
};

/// TSFC that grows, and falls at dates.
pub(super) const ENGINE_HISTORY: EffectEntry = EffectEntry {
    name: "engine_history",
    group: EffectGroup::Engine,
    unit: "%/year",
    typical: TypicalSize::Absolute(0.8),
    sign: EffectSign::Positive,
    needs: &[],
    hidden: HiddenParameter::History(History::NONE),
    driven_by: &[DrivingVariable::Date],
    perturbation: "TSFC·(1 + θ·years), of which dates take back a share",
    phrase: Phrase {
        positive: "TSFC grows, and falls at dates (washes, engine changes)",
        negative: "TSFC falls, and rises at dates",
    },
};

/// Flight-to-flight scatter of the fuel's heating value.
pub(super) const FUEL_HEATING_VALUE: EffectEntry = EffectEntry {
    name: "fuel_heating_value",
    group: EffectGroup::Engine,
    unit: "% rms",
    typical: TypicalSize::Absolute(0.6),
    sign: EffectSign::Spread,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[],
    perturbation: "flight-to-flight scatter of Wf beyond noise",
    phrase: Phrase {
        positive: "fuel flow differs from flight to flight, as the heating value of the fuel does",
        negative: "fuel flow differs from flight to flight, as the heating value of the fuel does",
    },
};
