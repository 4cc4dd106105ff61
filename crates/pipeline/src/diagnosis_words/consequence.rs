//! What follows from what was found.

use diagnose::Found;
use flight::effect::{EffectGroup, EffectId};

/// What follows from effects that were found, in a sentence or one for each; not before it is clear whether the recording errs or
/// the aircraft.
pub fn follows(found: &Found) -> Option<String> {
    let first = found.effects.first()?;
    // What acts together is what it is; only what could be meant in its place is open.
    let is_other = |id: &&EffectId| !found.effects.contains(id);
    let is_mixed = |id: EffectId, class: &[EffectId]| {
        class.iter().filter(is_other).any(|other| other.is_of_recordings() != id.is_of_recordings())
    };
    let mut beside = found.beside.iter();
    if is_mixed(*first, &found.class) || beside.any(|of| is_mixed(of.effect, &of.class)) {
        return Some(
            "Errors of the recording and changes of the aircraft are both possible: only the latter change predictions. \
             Find out which before you apply one."
                .to_owned(),
        );
    }
    if found.effects.iter().all(|id| consequence(*id) == consequence(*first)) {
        return Some(sentence(consequence(*first), "it"));
    }
    let told = found.effects.iter().map(|id| sentence(consequence(*id), &id.to_string()));
    Some(told.collect::<Vec<_>>().join(" "))
}

/// A consequence of an effect of this name.
fn sentence(consequence: &str, name: &str) -> String {
    let mut words = consequence.replace("{}", name);
    if name == "it" {
        words.replace_range(..1, &words[..1].to_uppercase());
    }
    words
}

/// What follows from an effect for predictions; `{}` is its name.
fn consequence(id: EffectId) -> &'static str {
    if id == EffectId::FuelHeatingValue {
        return "{} belongs to the fuel, which is another on every flight: only the interval of predictions changes with it.";
    }
    match id.entry().group {
        EffectGroup::Airframe => "{} belongs to the airframe: predictions change with it.",
        EffectGroup::Engine => {
            "{} belongs to the engines: predictions change with it, the drag table does not."
        }
        EffectGroup::Mass => {
            "{} is an error of the load sheet or the fuel count: recordings are corrected, predictions stay."
        }
        EffectGroup::Sensor => {
            "{} is an error of the recording: recordings are corrected, predictions stay."
        }
        EffectGroup::Environment => {
            "{} belongs to the air and the Earth: predictions change with it."
        }
        EffectGroup::Event => "{} is an event: ask what was done to the aircraft on that date.",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(effects: &[EffectId], class: &[EffectId]) -> Found {
        Found {
            effects: effects.to_vec(),
            class: class.to_vec(),
            credible: vec![],
            probability: 0.95,
            beside: vec![],
            closure: None,
            rest: None,
            separations: vec![],
        }
    }

    #[test]
    fn each_effect_has_its_own_consequence() {
        use EffectId::{DragFactor, FuelHeatingValue, TemperatureBias, TsfcFactor, WaveDrag};
        let told =
            |effects: &[EffectId], class: &[EffectId]| follows(&found(effects, class)).unwrap();
        assert_eq!(
            told(&[WaveDrag], &[WaveDrag, DragFactor]),
            "It belongs to the airframe: predictions change with it."
        );
        assert!(told(&[FuelHeatingValue], &[]).contains("belongs to the fuel"));
        let two = told(&[TsfcFactor, WaveDrag], &[TsfcFactor]);
        assert!(two.starts_with("tsfc_factor belongs to the engines:"), "{two}");
        assert!(two.contains(" wave_drag belongs to the airframe:"), "{two}");
        // Both act; a class in which one of them is meant is another matter.
        let both = told(&[DragFactor, TemperatureBias], &[DragFactor]);
        assert!(both.contains("temperature_bias is an error of the recording"), "{both}");
        assert!(told(&[DragFactor], &[DragFactor, TemperatureBias]).contains("Find out which"));
        // What acts together with the first may be the meter or the engine.
        let gain = EffectId::FuelFlowGainEngine(2);
        let class = vec![gain, EffectId::TsfcEngine(2)];
        let mut pair = found(&[DragFactor, gain], &[DragFactor]);
        assert!(follows(&pair).unwrap().contains("is an error of the recording"));
        pair.beside = vec![diagnose::Beside { effect: gain, class, probability: 0.6 }];
        assert!(follows(&pair).unwrap().contains("Find out which"));
    }
}
