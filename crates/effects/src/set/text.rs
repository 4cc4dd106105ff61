//! A set of effects in the form of the files: names with sizes, then every hidden parameter, used or not.

use flight::effect::{EffectId, HiddenParameter, History, StepTarget, ThrottleArgument};
use serde::{Deserialize, Serialize};

use super::Effects;

#[derive(Serialize, Deserialize)]
#[serde(rename = "Effects")]
pub(super) struct EffectsText {
    sizes: Vec<(String, f64)>,
    hidden: HiddenText,
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "HiddenParameters")]
struct HiddenText {
    throttle_pivot: f64,
    /// Not written where it is corrected thrust, so that files without N2 stay what they were before there was a
    /// choice.
    #[serde(default, skip_serializing_if = "is_corrected_thrust")]
    throttle_argument: ThrottleArgument,
    drag_divergence_mach: f64,
    step_from_s: f64,
    step_target: StepTarget,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    engine_history: Option<History>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    airframe_history: Option<History>,
}

/// A name that no effect has.
#[derive(Debug, thiserror::Error)]
#[error("no effect is called {0:?}")]
pub(super) struct NoSuchEffect(String);

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
const fn is_corrected_thrust(argument: &ThrottleArgument) -> bool {
    matches!(argument, ThrottleArgument::CorrectedThrust)
}

impl HiddenText {
    fn put(&mut self, id: EffectId, hidden: HiddenParameter) {
        match hidden {
            HiddenParameter::None => {}
            HiddenParameter::DragDivergenceMach(mach) => self.drag_divergence_mach = mach,
            HiddenParameter::Throttle { pivot, argument } => {
                self.throttle_pivot = pivot;
                self.throttle_argument = argument;
            }
            HiddenParameter::Step { from_s, target } => {
                self.step_from_s = from_s;
                self.step_target = target;
            }
            HiddenParameter::History(history) if id == EffectId::AirframeHistory => {
                self.airframe_history = Some(history);
            }
            HiddenParameter::History(history) => self.engine_history = Some(history),
        }
    }

    /// The parameter of an effect.
    fn of_effect(&self, id: EffectId) -> HiddenParameter {
        match id.entry().hidden {
            HiddenParameter::None => HiddenParameter::None,
            HiddenParameter::DragDivergenceMach(_) => {
                HiddenParameter::DragDivergenceMach(self.drag_divergence_mach)
            }
            HiddenParameter::Throttle { .. } => HiddenParameter::Throttle {
                pivot: self.throttle_pivot,
                argument: self.throttle_argument,
            },
            HiddenParameter::Step { .. } => {
                HiddenParameter::Step { from_s: self.step_from_s, target: self.step_target }
            }
            HiddenParameter::History(none) => {
                let of_airframe = id == EffectId::AirframeHistory;
                let of = if of_airframe { self.airframe_history } else { self.engine_history };
                HiddenParameter::History(of.unwrap_or(none))
            }
        }
    }
}

impl From<Effects> for EffectsText {
    fn from(effects: Effects) -> Self {
        let mut hidden = HiddenText {
            throttle_pivot: 0.0,
            throttle_argument: ThrottleArgument::CorrectedThrust,
            drag_divergence_mach: 0.0,
            step_from_s: 0.0,
            step_target: StepTarget::FuelFlow,
            engine_history: None,
            airframe_history: None,
        };
        let has_history = |hidden| matches!(hidden, HiddenParameter::History(_));
        for id in EffectId::ALL.iter().filter(|id| !has_history(id.entry().hidden)) {
            hidden.put(*id, id.entry().hidden);
        }
        for on in &effects.effects {
            hidden.put(on.id, on.hidden);
        }
        let sizes = effects.iter().map(|(id, size)| (id.to_string(), size)).collect();
        Self { sizes, hidden }
    }
}

impl TryFrom<EffectsText> for Effects {
    type Error = NoSuchEffect;

    fn try_from(text: EffectsText) -> Result<Self, NoSuchEffect> {
        let mut effects = Self::none();
        for (name, size) in text.sizes {
            let Some(id) = EffectId::from_name(&name) else { return Err(NoSuchEffect(name)) };
            let hidden = text.hidden.of_effect(id);
            effects = effects.with(id, size).with_hidden(id, hidden);
        }
        Ok(effects)
    }
}
