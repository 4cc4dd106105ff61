//! A set of effects in the form of the files: names with sizes, then every hidden parameter, used or not.

use flight::effect::{
    DragRise, DragRiseLaw, EffectId, HiddenParameter, History, StepTarget, ThrottleArgument,
};
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
    /// Not written where it is Lock's, as the argument above.
    #[serde(default, skip_serializing_if = "is_by_lock")]
    drag_rise: DragRiseLaw,
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

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
const fn is_by_lock(law: &DragRiseLaw) -> bool {
    matches!(law, DragRiseLaw::Lock)
}

impl HiddenText {
    fn put(&mut self, id: EffectId, hidden: HiddenParameter) {
        match hidden {
            HiddenParameter::None => {}
            HiddenParameter::DragRise(rise) => {
                self.drag_divergence_mach = rise.divergence_mach;
                self.drag_rise = rise.law;
            }
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
            HiddenParameter::DragRise(_) => HiddenParameter::DragRise(DragRise {
                divergence_mach: self.drag_divergence_mach,
                law: self.drag_rise,
            }),
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
            drag_rise: DragRiseLaw::Lock,
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

#[cfg(test)]
mod tests {
    use super::*;

    /// As files stated it before there was a choice.
    #[test]
    fn hidden_parameters_without_an_argument_are_over_corrected_thrust() {
        let id = EffectId::TsfcThrottle;
        let before = r#"(sizes:[("tsfc_throttle",0.6)],hidden:(throttle_pivot:0.8,drag_divergence_mach:0.84,step_from_s:inf,step_target:fuel_flow))"#;
        let read: Effects = ron::from_str(before).unwrap();
        let argument = ThrottleArgument::CorrectedThrust;
        assert_eq!(read.hidden(id), HiddenParameter::Throttle { pivot: 0.8, argument });
        assert_eq!(ron::to_string(&read).unwrap(), before);
        // And it is written as before; N2 is written explicitly.
        let argument = ThrottleArgument::N2;
        let by_n2 = read.with_hidden(id, HiddenParameter::Throttle { pivot: 0.8, argument });
        let text = ron::to_string(&by_n2).unwrap();
        assert!(text.contains("throttle_argument:n2"), "{text}");
        assert_eq!(ron::from_str::<Effects>(&text).unwrap(), by_n2);
        // So with the law of a drag rise.
        let rise = DragRise { divergence_mach: 0.86, law: DragRiseLaw::Steep };
        let wave = EffectId::WaveDrag;
        let steep = Effects::one(wave, 0.008).with_hidden(wave, HiddenParameter::DragRise(rise));
        let text = ron::to_string(&steep).unwrap();
        assert!(text.contains("drag_rise:steep"), "{text}");
        assert_eq!(ron::from_str::<Effects>(&text).unwrap(), steep);
    }

    /// Engines and airframe have a history each; both come back from a file as they were.
    #[test]
    fn histories_are_read_back_as_they_were_written() {
        let history = |recovered: f64| {
            HiddenParameter::History(History::new(1.4e9, recovered, &[1.45e9]).unwrap())
        };
        let (engine, airframe) = (EffectId::EngineHistory, EffectId::AirframeHistory);
        let of_engine = Effects::one(engine, 1.5).with_hidden(engine, history(0.3));
        let both = of_engine.clone().with(airframe, 0.5).with_hidden(airframe, history(0.9));
        for effects in [of_engine, both] {
            let text = ron::to_string(&effects).unwrap();
            assert_eq!(ron::from_str::<Effects>(&text).unwrap(), effects, "{text}");
            assert_eq!(effects.hidden(engine), history(0.3));
        }
    }
}
