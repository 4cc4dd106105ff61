//! What follows from what was found.

use diagnose::Found;
use flight::effect::EffectGroup;

/// What follows from effects that were found, in a sentence; not before it is clear whether the recording errs or the aircraft.
pub fn follows(found: &Found) -> Option<String> {
    let first = found.effects.first()?;
    let mut ids = found.effects.iter().chain(&found.class);
    if ids.all(|id| id.is_of_recordings() == first.is_of_recordings()) {
        return Some(consequence(first.entry().group).to_owned());
    }
    Some(
        "Errors of the recording and changes of the aircraft are both possible: only the latter change predictions. Find \
         out which before you apply one."
            .to_owned(),
    )
}

/// What follows from an effect of this group for predictions.
const fn consequence(group: EffectGroup) -> &'static str {
    match group {
        EffectGroup::Airframe => "It belongs to the airframe: predictions change with it.",
        EffectGroup::Engine => {
            "It belongs to the engines: predictions change with it, the drag table does not."
        }
        EffectGroup::Mass => {
            "It is an error of the load sheet or the fuel count: recordings are corrected, predictions stay."
        }
        EffectGroup::Sensor => {
            "It is an error of the recording: recordings are corrected, predictions stay."
        }
        EffectGroup::Environment => {
            "It belongs to the air and the Earth: predictions change with it."
        }
        EffectGroup::Event => "Ask what was done to the aircraft on that date.",
    }
}
