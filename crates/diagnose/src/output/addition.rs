//! What a verdict would add to the model: its effects with sizes, hidden parameters and references, ready to be applied.

use effects::{
    AppliedLayer, EffectReferences, Effects, HiddenParameters, StepTarget, ThrottleArgument,
};
use flight::effect::EffectId;
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

/// One effect with its size and hidden parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AddedEffect {
    /// Name.
    pub effect: String,
    /// Size in the effect's unit.
    pub size: f64,
    /// Its standard deviation.
    pub standard_deviation: f64,
    /// `tsfc_throttle`: corrected thrust over its reference at which TSFC is unchanged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub throttle_pivot: Option<f64>,
    /// `tsfc_throttle`: what told pivot and size, where it was not corrected thrust. Once applied, the effect acts over
    /// corrected thrust all the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub throttle_argument: Option<ThrottleArgument>,
    /// `wave_drag`: drag-divergence Mach number at lift coefficient 0.35.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drag_divergence_mach: Option<f64>,
    /// `step_change`: instant from which it holds, s since 1970.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_from_s: Option<f64>,
    /// `step_change`: what it multiplies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_target: Option<StepTarget>,
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
        let mut hidden = HiddenParameters::default();
        for added in &self.effects {
            let id = EffectId::from_name(&added.effect)
                .ok_or_else(|| UnknownEffect { name: added.effect.clone() })?;
            effects = effects.with(id, added.size);
            hidden.throttle_pivot = added.throttle_pivot.unwrap_or(hidden.throttle_pivot);
            hidden.throttle_argument = added.throttle_argument.unwrap_or(hidden.throttle_argument);
            hidden.drag_divergence_mach =
                added.drag_divergence_mach.unwrap_or(hidden.drag_divergence_mach);
            hidden.step_from_s = added.step_from_s.unwrap_or(hidden.step_from_s);
            hidden.step_target = added.step_target.unwrap_or(hidden.step_target);
        }
        Ok(AppliedLayer { effects: effects.with_hidden(hidden), references: self.references })
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
            throttle_pivot: None,
            throttle_argument: None,
            drag_divergence_mach: None,
            step_from_s: None,
            step_target: None,
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
        let addition = Addition {
            effects: vec![
                AddedEffect {
                    step_from_s: Some(1.6e9),
                    step_target: Some(StepTarget::Drag),
                    ..effect("step_change", 1.5)
                },
                AddedEffect { drag_divergence_mach: Some(0.86), ..effect("wave_drag", 0.006) },
            ],
            references,
        };
        let layer = addition.layer().unwrap();
        assert_eq!(
            layer.effects,
            Effects::one(EffectId::StepChange, 1.5).with(EffectId::WaveDrag, 0.006).with_hidden(
                HiddenParameters {
                    drag_divergence_mach: 0.86,
                    step_from_s: 1.6e9,
                    step_target: StepTarget::Drag,
                    ..HiddenParameters::default()
                }
            )
        );
        // As files said it before N2 could tell a throttle effect, and after.
        let before =
            r#"(effect:"tsfc_throttle",size:0.6,standard_deviation:0.1,throttle_pivot:Some(0.8))"#;
        let added: AddedEffect = ron::from_str(before).unwrap();
        let layer = Addition { effects: vec![added.clone()], references }.layer().unwrap();
        let over_thrust = HiddenParameters { throttle_pivot: 0.8, ..HiddenParameters::default() };
        assert_eq!(*layer.effects.hidden(), over_thrust);
        assert_eq!(ron::to_string(&added).unwrap(), before);
        let by_n2 = AddedEffect { throttle_argument: Some(ThrottleArgument::N2), ..added };
        let layer = Addition { effects: vec![by_n2], references }.layer().unwrap();
        let over_n2 = HiddenParameters { throttle_argument: ThrottleArgument::N2, ..over_thrust };
        assert_eq!(*layer.effects.hidden(), over_n2);
        let unknown = Addition { effects: vec![effect("drag_faktor", 1.0)], references };
        assert_eq!(unknown.layer(), Err(UnknownEffect { name: "drag_faktor".to_owned() }));
    }
}
