//! What a verdict would add to the model: its effects with sizes, hidden parameters and references, ready to be applied.

use effects::{AppliedForm, AppliedLayer, EffectReferences, Effects};
use flight::effect::{EffectId, HiddenParameter};

/// Effects of a verdict and what they are zero at.
#[derive(Clone, Debug, PartialEq)]
pub struct Addition {
    /// The effects, as they act together.
    pub effects: Vec<AddedEffect>,
    /// What acts without being an effect of the library.
    pub form: Option<AppliedForm>,
    /// What they are zero at.
    pub references: EffectReferences,
}

/// One effect with its size and hidden parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AddedEffect {
    /// The effect.
    pub effect: EffectId,
    /// Size in the effect's unit.
    pub size: f64,
    /// Its standard deviation.
    pub standard_deviation: f64,
    /// What it has beyond its size. Once applied, `tsfc_throttle` acts over corrected thrust, whatever found it.
    pub hidden: HiddenParameter,
}

impl Addition {
    /// The layer that a performance model takes.
    #[must_use]
    pub fn layer(&self) -> AppliedLayer {
        let mut effects = Effects::none();
        for added in &self.effects {
            effects =
                effects.with(added.effect, added.size).with_hidden(added.effect, added.hidden);
        }
        let forms = self.form.into_iter().collect();
        AppliedLayer { effects, forms, references: self.references }
    }
}

#[cfg(test)]
mod tests {
    use flight::effect::{DragRise, StepTarget};

    use super::*;

    #[test]
    fn a_layer_has_every_size_and_the_hidden_parameters_of_their_owners() {
        let effect = |effect: EffectId, size: f64, hidden: HiddenParameter| AddedEffect {
            effect,
            size,
            standard_deviation: 0.1,
            hidden,
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
        let rise = HiddenParameter::DragRise(DragRise::by_lock(0.86));
        let addition = Addition {
            effects: vec![
                effect(EffectId::StepChange, 1.5, step),
                effect(EffectId::WaveDrag, 0.006, rise),
            ],
            form: None,
            references,
        };
        assert_eq!(
            addition.layer().effects,
            Effects::one(EffectId::StepChange, 1.5)
                .with_hidden(EffectId::StepChange, step)
                .with(EffectId::WaveDrag, 0.006)
                .with_hidden(EffectId::WaveDrag, rise)
        );
    }
}
