//! Effects of the Earth and its air, and dated events.

use super::{
    DrivingVariable, EffectEntry, EffectGroup, EffectSign, HiddenParameter, NeededInput, Phrase,
    StepTarget, TypicalSize,
};

/// Gravity by latitude and height.
pub(super) const LOCAL_GRAVITY: EffectEntry = EffectEntry {
    name: "local_gravity",
    group: EffectGroup::Environment,
    unit: "known, 1",
    typical: TypicalSize::Known,
    sign: EffectSign::Either,
    needs: &[NeededInput::Latitude],
    hidden: HiddenParameter::None,
    driven_by: &[
        DrivingVariable::Latitude,
        DrivingVariable::EastwardSpeed,
        DrivingVariable::LiftCoefficient,
    ],
    perturbation: "g(latitude, height) for g0",
    phrase: Phrase {
        positive: "gravity by latitude and height, which the model takes as standard",
        negative: "gravity by latitude and height, which the model takes as standard",
    },
};

/// Lift saved or needed because of the Earth's rotation and curvature.
pub(super) const ROTATING_EARTH: EffectEntry = EffectEntry {
    name: "rotating_earth",
    group: EffectGroup::Environment,
    unit: "known, 1",
    typical: TypicalSize::Known,
    sign: EffectSign::Either,
    needs: &[NeededInput::Latitude, NeededInput::TrueHeading],
    hidden: HiddenParameter::None,
    driven_by: &[
        DrivingVariable::Latitude,
        DrivingVariable::EastwardSpeed,
        DrivingVariable::LiftCoefficient,
    ],
    perturbation: "g − (2Ω V_east cos φ + V²/R)",
    phrase: Phrase {
        positive: "lift saved by the Earth's rotation and curvature",
        negative: "lift saved by the Earth's rotation and curvature",
    },
};

/// Climb along a sloping pressure surface.
pub(super) const ISOBARIC_SLOPE: EffectEntry = EffectEntry {
    name: "isobaric_slope",
    group: EffectGroup::Environment,
    unit: "1",
    typical: TypicalSize::Absolute(0.5),
    sign: EffectSign::Either,
    needs: &[NeededInput::Latitude, NeededInput::Drift],
    hidden: HiddenParameter::None,
    driven_by: &[DrivingVariable::CrossWind, DrivingVariable::Latitude],
    perturbation: "thrust + θ m f V_cross, f = 2Ω sin φ, V_cross from drift",
    phrase: Phrase {
        positive: "climb along sloping pressure surfaces without the force that balances it",
        negative: "climb along sloping pressure surfaces without the force that balances it",
    },
};

/// A step on an estimated date.
pub(super) const STEP_CHANGE: EffectEntry = EffectEntry {
    name: "step_change",
    group: EffectGroup::Event,
    unit: "%",
    typical: TypicalSize::Absolute(1.5),
    sign: EffectSign::Either,
    needs: &[],
    hidden: HiddenParameter::Step { from_s: f64::INFINITY, target: StepTarget::FuelFlow },
    driven_by: &[DrivingVariable::Date],
    perturbation: "Wf or CD ·(1 + θ) from an estimated date on",
    phrase: Phrase {
        positive: "a step up from one date on",
        negative: "a step down from one date on",
    },
};
