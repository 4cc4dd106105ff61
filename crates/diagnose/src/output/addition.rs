//! What a verdict would add to the model: its effects with sizes, hidden parameters and references, ready to be applied.

use effects::{AppliedLayer, EffectReferences, Effects};
use flight::effect::{EffectId, HiddenParameter, StepTarget, ThrottleArgument};
use serde::{Deserialize, Serialize};

/// Effects of a verdict and what they are zero at.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Addition {
    /// The effects, as they act together.
    pub effects: Vec<AddedEffect>,
    /// What they are zero at.
    pub references: EffectReferences,
}

/// One effect with its size and hidden parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "AddedEffectText", into = "AddedEffectText")]
pub struct AddedEffect {
    /// Name.
    pub effect: String,
    /// Size in the effect's unit.
    pub size: f64,
    /// Its standard deviation.
    pub standard_deviation: f64,
    /// What it has beyond its size. Once applied, `tsfc_throttle` acts over corrected thrust, whatever found it.
    pub hidden: HiddenParameter,
}

/// As files say it: each hidden parameter by its name, those that the effect does not have left out.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "AddedEffect")]
struct AddedEffectText {
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
    #[serde(default, skip_serializing_if = "Option::is_none")]
    step_from_s: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    step_target: Option<StepTarget>,
}

impl From<AddedEffect> for AddedEffectText {
    fn from(added: AddedEffect) -> Self {
        let mut text = Self {
            effect: added.effect,
            size: added.size,
            standard_deviation: added.standard_deviation,
            throttle_pivot: None,
            throttle_argument: None,
            drag_divergence_mach: None,
            step_from_s: None,
            step_target: None,
        };
        match added.hidden {
            HiddenParameter::None => {}
            HiddenParameter::DragDivergenceMach(mach) => text.drag_divergence_mach = Some(mach),
            HiddenParameter::Throttle { pivot, argument } => {
                text.throttle_pivot = Some(pivot);
                text.throttle_argument =
                    (argument != ThrottleArgument::CorrectedThrust).then_some(argument);
            }
            HiddenParameter::Step { from_s, target } => {
                text.step_from_s = Some(from_s);
                text.step_target = Some(target);
            }
        }
        text
    }
}

impl From<AddedEffectText> for AddedEffect {
    fn from(text: AddedEffectText) -> Self {
        // A name that no effect has is refused where the layer is made.
        let usual =
            EffectId::from_name(&text.effect).map_or(HiddenParameter::None, |id| id.entry().hidden);
        let hidden = match usual {
            HiddenParameter::None => HiddenParameter::None,
            HiddenParameter::DragDivergenceMach(mach) => {
                HiddenParameter::DragDivergenceMach(text.drag_divergence_mach.unwrap_or(mach))
            }
            HiddenParameter::Throttle { pivot, argument } => HiddenParameter::Throttle {
                pivot: text.throttle_pivot.unwrap_or(pivot),
                argument: text.throttle_argument.unwrap_or(argument),
            },
            HiddenParameter::Step { from_s, target } => HiddenParameter::Step {
                from_s: text.step_from_s.unwrap_or(from_s),
                target: text.step_target.unwrap_or(target),
            },
        };
        Self {
            effect: text.effect,
            size: text.size,
            standard_deviation: text.standard_deviation,
            hidden,
        }
    }
}

/// A name that no effect has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no effect is called {name:?}")]
pub struct UnknownEffect {
    /// What was found.
    pub name: String,
}

impl Addition {
    /// The layer that a performance model takes.
    ///
    /// # Errors
    /// [`UnknownEffect`] for a name that the library does not have.
    pub fn layer(&self) -> Result<AppliedLayer, UnknownEffect> {
        let mut effects = Effects::none();
        for added in &self.effects {
            let id = EffectId::from_name(&added.effect)
                .ok_or_else(|| UnknownEffect { name: added.effect.clone() })?;
            effects = effects.with(id, added.size).with_hidden(id, added.hidden);
        }
        Ok(AppliedLayer { effects, references: self.references })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_has_every_size_and_the_hidden_parameters_of_their_owners() {
        let effect = |effect: &str, size: f64| AddedEffect {
            effect: effect.to_owned(),
            size,
            standard_deviation: 0.1,
            hidden: HiddenParameter::None,
        };
        let references = EffectReferences {
            date_s: 1.5e9,
            mach: 0.8,
            unit_reynolds_number_per_m: 6e6,
            temperature_ratio: 0.75,
            corrected_thrust_n: 5e4,
            fuel_flow_total_kg_s: 0.25,
            mass_kg: 13_000.0,
            center_of_gravity_percent_mac: None,
        };
        let step = HiddenParameter::Step { from_s: 1.6e9, target: StepTarget::Drag };
        let rise = HiddenParameter::DragDivergenceMach(0.86);
        let addition = Addition {
            effects: vec![
                AddedEffect { hidden: step, ..effect("step_change", 1.5) },
                AddedEffect { hidden: rise, ..effect("wave_drag", 0.006) },
            ],
            references,
        };
        let layer = addition.layer().unwrap();
        assert_eq!(
            layer.effects,
            Effects::one(EffectId::StepChange, 1.5)
                .with_hidden(EffectId::StepChange, step)
                .with(EffectId::WaveDrag, 0.006)
                .with_hidden(EffectId::WaveDrag, rise)
        );
        // As files said it before N2 could tell a throttle effect, and after.
        let before =
            r#"(effect:"tsfc_throttle",size:0.6,standard_deviation:0.1,throttle_pivot:Some(0.8))"#;
        let added: AddedEffect = ron::from_str(before).unwrap();
        let layer = Addition { effects: vec![added.clone()], references }.layer().unwrap();
        let over = |argument| HiddenParameter::Throttle { pivot: 0.8, argument };
        let over_thrust = over(ThrottleArgument::CorrectedThrust);
        assert_eq!(layer.effects.hidden(EffectId::TsfcThrottle), over_thrust);
        assert_eq!(ron::to_string(&added).unwrap(), before);
        let by_n2 = AddedEffect { hidden: over(ThrottleArgument::N2), ..added };
        let layer = Addition { effects: vec![by_n2], references }.layer().unwrap();
        let over_n2 = over(ThrottleArgument::N2);
        assert_eq!(layer.effects.hidden(EffectId::TsfcThrottle), over_n2);
        let unknown = Addition { effects: vec![effect("drag_faktor", 1.0)], references };
        assert_eq!(unknown.layer(), Err(UnknownEffect { name: "drag_faktor".to_owned() }));
    }
}
