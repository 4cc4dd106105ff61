//! What a verdict adds to a model, as `diagnosis.json` and model files have it.

use diagnose::{AddedEffect, Addition};
use effects::{AppliedForm, EffectReferences};
use flight::effect::{
    DragRise, DragRiseLaw, EffectId, HiddenParameter, History, StepTarget, ThrottleArgument,
};
use serde::{Deserialize, Serialize};

/// Effects of a verdict and what they are zero at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Addition")]
pub struct AdditionRecord {
    effects: Vec<AddedEffectRecord>,
    /// What is no effect of the library.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    form: Option<AppliedForm>,
    references: EffectReferences,
}

/// One effect: each hidden parameter by its name, those that the effect does not have left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "AddedEffect")]
struct AddedEffectRecord {
    effect: String,
    size: f64,
    standard_deviation: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    throttle_pivot: Option<f64>,
    /// Left out where it is corrected thrust.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    throttle_argument: Option<ThrottleArgument>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    drag_divergence_mach: Option<f64>,
    /// Left out where it is Lock's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    drag_rise: Option<DragRiseLaw>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    step_from_s: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    step_target: Option<StepTarget>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    history: Option<History>,
}

/// A name that no effect has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no effect is called {name:?}")]
pub struct UnknownEffect {
    /// What was found.
    pub name: String,
}

impl From<&Addition> for AdditionRecord {
    fn from(addition: &Addition) -> Self {
        Self {
            effects: addition.effects.iter().map(AddedEffectRecord::from).collect(),
            form: addition.form,
            references: addition.references,
        }
    }
}

impl TryFrom<AdditionRecord> for Addition {
    type Error = UnknownEffect;

    fn try_from(record: AdditionRecord) -> Result<Self, UnknownEffect> {
        let AdditionRecord { effects, form, references } = record;
        let effects = effects.into_iter().map(AddedEffect::try_from).collect::<Result<_, _>>()?;
        Ok(Self { effects, form, references })
    }
}

impl From<&AddedEffect> for AddedEffectRecord {
    fn from(added: &AddedEffect) -> Self {
        let mut record = Self {
            effect: added.effect.to_string(),
            size: added.size,
            standard_deviation: added.standard_deviation,
            throttle_pivot: None,
            throttle_argument: None,
            drag_divergence_mach: None,
            drag_rise: None,
            step_from_s: None,
            step_target: None,
            history: None,
        };
        match added.hidden {
            HiddenParameter::None => {}
            HiddenParameter::DragRise(DragRise { divergence_mach, law }) => {
                record.drag_divergence_mach = Some(divergence_mach);
                record.drag_rise = (law != DragRiseLaw::Lock).then_some(law);
            }
            HiddenParameter::Throttle { pivot, argument } => {
                record.throttle_pivot = Some(pivot);
                record.throttle_argument =
                    (argument != ThrottleArgument::CorrectedThrust).then_some(argument);
            }
            HiddenParameter::Step { from_s, target } => {
                record.step_from_s = Some(from_s);
                record.step_target = Some(target);
            }
            HiddenParameter::History(history) => record.history = Some(history),
        }
        record
    }
}

impl TryFrom<AddedEffectRecord> for AddedEffect {
    type Error = UnknownEffect;

    fn try_from(record: AddedEffectRecord) -> Result<Self, UnknownEffect> {
        let effect = effect_of(&record.effect)?;
        let hidden = match effect.entry().hidden {
            HiddenParameter::None => HiddenParameter::None,
            HiddenParameter::DragRise(usual) => HiddenParameter::DragRise(DragRise {
                divergence_mach: record.drag_divergence_mach.unwrap_or(usual.divergence_mach),
                law: record.drag_rise.unwrap_or(usual.law),
            }),
            HiddenParameter::Throttle { pivot, argument } => HiddenParameter::Throttle {
                pivot: record.throttle_pivot.unwrap_or(pivot),
                argument: record.throttle_argument.unwrap_or(argument),
            },
            HiddenParameter::Step { from_s, target } => HiddenParameter::Step {
                from_s: record.step_from_s.unwrap_or(from_s),
                target: record.step_target.unwrap_or(target),
            },
            HiddenParameter::History(none) => {
                HiddenParameter::History(record.history.unwrap_or(none))
            }
        };
        let AddedEffectRecord { size, standard_deviation, .. } = record;
        Ok(Self { effect, size, standard_deviation, hidden })
    }
}

/// The effect of a name in a file.
pub(crate) fn effect_of(name: &str) -> Result<EffectId, UnknownEffect> {
    EffectId::from_name(name).ok_or_else(|| UnknownEffect { name: name.to_owned() })
}

#[cfg(test)]
mod tests {
    use effects::{Form, Variable};

    use super::*;

    #[test]
    fn what_told_a_throttle_effect_is_kept() {
        // As in files from before N2 could determine a throttle effect, and after.
        let before =
            r#"(effect:"tsfc_throttle",size:0.6,standard_deviation:0.1,throttle_pivot:Some(0.8))"#;
        let record: AddedEffectRecord = ron::from_str(before).unwrap();
        let added = AddedEffect::try_from(record).unwrap();
        let over = |argument| HiddenParameter::Throttle { pivot: 0.8, argument };
        assert_eq!(added.effect, EffectId::TsfcThrottle);
        assert_eq!(added.hidden, over(ThrottleArgument::CorrectedThrust));
        assert_eq!(ron::to_string(&AddedEffectRecord::from(&added)).unwrap(), before);
        let by_n2 = AddedEffect { hidden: over(ThrottleArgument::N2), ..added };
        let text = ron::to_string(&AddedEffectRecord::from(&by_n2)).unwrap();
        let record: AddedEffectRecord = ron::from_str(&text).unwrap();
        assert_eq!(AddedEffect::try_from(record).unwrap(), by_n2);
    }

    #[test]
    fn every_form_reads_back_as_it_was_written() {
        for form in [
            Form::Offset,
            Form::Linear,
            Form::Square,
            Form::Power { exponent: -0.75 },
            Form::HingeAbove { from: 0.1 },
            Form::HingeBelow { to: 1.0 / 3.0 },
            Form::Step { from: 1_557_446_400.0 },
            Form::Logistic { middle: 0.78, width: 0.01 },
            Form::Bump { middle: 0.74, width: 0.012_5 },
            Form::Product { with: Variable::CenterOfGravity, scale: [24.5, 2.1] },
        ] {
            let applied = AppliedForm {
                form,
                variable: Variable::Mach,
                scale: [0.76, 0.03],
                acts_on: StepTarget::Drag,
                size: 15.7,
                standard_deviation: 0.2,
            };
            let text = ron::to_string(&applied).unwrap();
            assert_eq!(ron::from_str::<AppliedForm>(&text).unwrap(), applied, "{text}");
        }
    }

    #[test]
    fn a_name_that_no_effect_has_is_refused() {
        let text = r#"(effect:"drag_faktor",size:1.0,standard_deviation:0.1)"#;
        let record: AddedEffectRecord = ron::from_str(text).unwrap();
        let unknown = UnknownEffect { name: "drag_faktor".to_owned() };
        assert_eq!(AddedEffect::try_from(record), Err(unknown));
    }
}
