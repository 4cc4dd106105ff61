//! Effects of the airframe's drag.

use super::{
    DragRise, DrivingVariable, EffectEntry, EffectGroup, EffectSign, HiddenParameter, History,
    NeededInput, Phrase, TypicalSize,
};

/// Drag-divergence Mach number at lift coefficient 0.35 where neither aircraft file nor search gives one: our choice,
/// the middle of the range 0.74 to 0.94 of transport and business aircraft that a search covers.
const DRAG_DIVERGENCE_MACH: f64 = 0.84;

/// More (or less) drag at zero lift.
pub(super) const ZERO_LIFT_DRAG: EffectEntry = EffectEntry {
    name: "zero_lift_drag",
    group: EffectGroup::Airframe,
    unit: "drag counts",
    typical: TypicalSize::Absolute(5.0),
    sign: EffectSign::Positive,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[
        DrivingVariable::LiftCoefficient,
        DrivingVariable::Mach,
        DrivingVariable::PressureAltitude,
        DrivingVariable::Mass,
    ],
    perturbation: "CD + θ·1e-4",
    phrase: Phrase { positive: "more drag at zero lift", negative: "less drag at zero lift" },
};

/// All drag scaled.
pub(super) const DRAG_FACTOR: EffectEntry = EffectEntry {
    name: "drag_factor",
    group: EffectGroup::Airframe,
    unit: "%",
    typical: TypicalSize::Absolute(2.0),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[],
    perturbation: "CD·(1 + θ)",
    phrase: Phrase { positive: "more drag everywhere", negative: "less drag everywhere" },
};

/// Lift-dependent drag scaled.
pub(super) const INDUCED_DRAG: EffectEntry = EffectEntry {
    name: "induced_drag",
    group: EffectGroup::Airframe,
    unit: "% of K",
    typical: TypicalSize::Absolute(6.0),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[
        DrivingVariable::LiftCoefficient,
        DrivingVariable::Mass,
        DrivingVariable::PressureAltitude,
        DrivingVariable::Mach,
    ],
    perturbation: "CD + θ K(M) CL²",
    phrase: Phrase { positive: "more lift-dependent drag", negative: "less lift-dependent drag" },
};

/// Earlier or later drag rise with Mach number.
pub(super) const WAVE_DRAG: EffectEntry = EffectEntry {
    name: "wave_drag",
    group: EffectGroup::Airframe,
    unit: "Mach",
    typical: TypicalSize::Absolute(0.006),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::DragRise(DragRise::by_lock(DRAG_DIVERGENCE_MACH)),
    driven_by: &[DrivingVariable::Mach],
    perturbation: "CD + w(M, Mdd − θ) − w(M, Mdd), w = 20 max(0, M − Mdd + 0.1077)⁴",
    phrase: Phrase {
        positive: "earlier drag rise with Mach number",
        negative: "later drag rise with Mach number",
    },
};

/// Friction that depends on the Reynolds number.
pub(super) const REYNOLDS_NUMBER: EffectEntry = EffectEntry {
    name: "reynolds_number",
    group: EffectGroup::Airframe,
    unit: "exponent",
    typical: TypicalSize::Absolute(0.12),
    sign: EffectSign::Positive,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[
        DrivingVariable::PressureAltitude,
        DrivingVariable::CorrectedThrust,
        DrivingVariable::StaticAirTemperature,
        DrivingVariable::Mach,
    ],
    perturbation: "zero-lift drag share × (Re/Re_ref)^−θ",
    phrase: Phrase {
        positive: "friction falls with Reynolds number, which the model does not have",
        negative: "friction rises with Reynolds number, which the model does not have",
    },
};

/// Trim drag with the center of gravity.
pub(super) const TRIM_DRAG_CG: EffectEntry = EffectEntry {
    name: "trim_drag_cg",
    group: EffectGroup::Airframe,
    unit: "counts per 10 %MAC forward",
    typical: TypicalSize::Absolute(3.0),
    sign: EffectSign::Positive,
    needs: &[NeededInput::CenterOfGravity],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::CenterOfGravity, DrivingVariable::LiftCoefficient],
    perturbation: "CD + θ·1e-4·(CG_ref − CG)/10 %MAC · CL/0.4",
    phrase: Phrase {
        positive: "trim drag with a forward center of gravity",
        negative: "less drag with a forward center of gravity",
    },
};

/// Drag of flying with a wing low.
pub(super) const ASYMMETRY_DRAG: EffectEntry = EffectEntry {
    name: "asymmetry_drag",
    group: EffectGroup::Airframe,
    unit: "counts/deg²",
    typical: TypicalSize::Absolute(1.0),
    sign: EffectSign::Positive,
    needs: &[NeededInput::Roll],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::Roll],
    perturbation: "CD + θ·1e-4·roll² (wings-level segments)",
    phrase: Phrase {
        positive: "drag of flying with a wing low",
        negative: "less drag with a wing low",
    },
};

/// Lift needed in a turn.
pub(super) const LOAD_FACTOR: EffectEntry = EffectEntry {
    name: "load_factor",
    group: EffectGroup::Airframe,
    unit: "known, 1",
    typical: TypicalSize::Known,
    sign: EffectSign::Either,
    needs: &[NeededInput::Roll],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::Roll],
    perturbation: "lift × 1/cos(roll)",
    phrase: Phrase {
        positive: "lift that turns ask for, which the model leaves out",
        negative: "lift that turns ask for, which the model leaves out",
    },
};

/// Zero-lift drag that grows with age.
pub(super) const AIRFRAME_AGEING: EffectEntry = EffectEntry {
    name: "airframe_ageing",
    group: EffectGroup::Airframe,
    unit: "%/year",
    typical: TypicalSize::Absolute(1.2),
    sign: EffectSign::Positive,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::Date],
    perturbation: "zero-lift drag share × (1 + θ·years since reference)",
    phrase: Phrase {
        positive: "zero-lift drag that grows with age",
        negative: "zero-lift drag that falls with age",
    },
};

/// Zero-lift drag that grows, and falls at dates.
pub(super) const AIRFRAME_HISTORY: EffectEntry = EffectEntry {
    name: "airframe_history",
    group: EffectGroup::Airframe,
    unit: "%/year",
    typical: TypicalSize::Absolute(1.2),
    sign: EffectSign::Positive,
    needs: &[],
    hidden: HiddenParameter::History(History::NONE),
    driven_by: &[DrivingVariable::Date],
    perturbation: "zero-lift drag share × (1 + θ·years), of which dates take back a share",
    phrase: Phrase {
        positive: "zero-lift drag grows, and falls at dates (washes, repairs)",
        negative: "zero-lift drag falls, and rises at dates",
    },
};

/// The whole drag table off: a smooth function of lift coefficient and Mach number. A table over these two variables can hold it.
pub(super) const DRAG_TABLE: EffectEntry = EffectEntry {
    name: "drag_table",
    group: EffectGroup::Airframe,
    unit: "% rms",
    typical: TypicalSize::Absolute(4.0),
    sign: EffectSign::Spread,
    needs: &[],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::LiftCoefficient, DrivingVariable::Mach],
    perturbation: "CD·(1 + f(CL, M)), f smooth as law bayes has it",
    phrase: Phrase {
        positive: "the drag table is off by a smooth function of lift coefficient and Mach number",
        negative: "the drag table is off by a smooth function of lift coefficient and Mach number",
    },
};
