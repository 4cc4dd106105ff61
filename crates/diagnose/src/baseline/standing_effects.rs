//! Effects that a fleet shows at all times.

use effects::EffectPoint;
use flight::effect::{DragRise, EffectId, HiddenParameter, NeededInput};

use crate::priors::{CARRIED_DEVIATION, CARRIED_DRAG_RISE_MACHS, CARRIED_SLOPE_DEVIATION};

/// An effect that a baseline carries.
pub(crate) struct StandingEffect {
    pub(crate) id: EffectId,
    pub(crate) hidden: HiddenParameter,
    /// Prior standard deviation of its size over the typical size; 1 is all that physics says where the size is known.
    pub(crate) deviation: f64,
}

impl StandingEffect {
    /// Whether a point lacks what the effect needs: not even a substitute counts.
    pub(crate) fn lacks_input(&self, point: &EffectPoint) -> bool {
        point.lacks(self.id).is_some()
            || (self.id.entry().needs.contains(&NeededInput::Roll)
                && point.roll_squared_deg2.is_none())
    }
}

/// What a fleet shows at all times and no table over lift coefficient and Mach number, and no smooth remainder, can hold: the
/// Earth and its air, and effects of signals that the remainder does not look at, or that bend faster than a table's cells.
/// Whatever of it a baseline was taught is no change. The first three are what older model files hold.
pub(crate) const STANDING_EFFECTS: [StandingEffect; 10] = [
    standing_effect(EffectId::LocalGravity, CARRIED_DEVIATION),
    standing_effect(EffectId::RotatingEarth, CARRIED_DEVIATION),
    standing_effect(EffectId::IsobaricSlope, CARRIED_SLOPE_DEVIATION),
    standing_effect(EffectId::LoadFactor, CARRIED_DEVIATION),
    standing_effect(EffectId::TrimDragCg, CARRIED_DEVIATION),
    standing_effect(EffectId::AsymmetryDrag, CARRIED_DEVIATION),
    standing_effect(EffectId::AntiIceBleed, CARRIED_DEVIATION),
    drag_rise(CARRIED_DRAG_RISE_MACHS[0]),
    drag_rise(CARRIED_DRAG_RISE_MACHS[1]),
    drag_rise(CARRIED_DRAG_RISE_MACHS[2]),
];

pub(crate) const fn standing_effect(id: EffectId, deviation: f64) -> StandingEffect {
    StandingEffect { id, hidden: id.entry().hidden, deviation }
}

const fn drag_rise(drag_divergence_mach: f64) -> StandingEffect {
    let hidden = HiddenParameter::DragRise(DragRise::by_lock(drag_divergence_mach));
    StandingEffect { id: EffectId::WaveDrag, hidden, deviation: CARRIED_DEVIATION }
}
