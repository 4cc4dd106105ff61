//! What the laws of effects leave open.

use flight::effect::{EffectGroup, EffectId, HiddenParameter, StepTarget};

use crate::priors::FORM_ERROR;

/// Standard deviation, over the size, of what an effect's law leaves open about it: its form, and how strongly it acts where
/// the model stands (the share of the drag without lift, how TSFC depends on thrust). None where the size is a factor on what
/// burns or on what is recorded, or physics states it.
pub(crate) fn open_by_law(id: EffectId, hidden: HiddenParameter) -> f64 {
    let on_drag = matches!(hidden, HiddenParameter::Step { target: StepTarget::Drag, .. });
    match (id, id.entry().group) {
        (EffectId::TsfcFactor | EffectId::TsfcEngine(_), _) => 0.0,
        (EffectId::StepChange, _) if !on_drag => 0.0,
        (_, EffectGroup::Airframe | EffectGroup::Engine | EffectGroup::Event) => FORM_ERROR,
        (_, EffectGroup::Mass | EffectGroup::Sensor | EffectGroup::Environment) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_a_factor_has_no_law_of_its_own() {
        let step = |target| HiddenParameter::Step { from_s: 0.0, target };
        let none = HiddenParameter::None;
        for (id, hidden, expected) in [
            (EffectId::TsfcEngine(2), none, 0.0),
            (EffectId::FuelFlowGain, none, 0.0),
            (EffectId::StepChange, step(StepTarget::FuelFlow), 0.0),
            (EffectId::StepChange, step(StepTarget::Drag), FORM_ERROR),
            (EffectId::ReynoldsNumber, none, FORM_ERROR),
            (EffectId::AntiIceBleed, none, FORM_ERROR),
            (EffectId::LocalGravity, none, 0.0),
        ] {
            assert!((open_by_law(id, hidden) - expected).abs() < 1e-15, "{id}");
        }
    }
}
