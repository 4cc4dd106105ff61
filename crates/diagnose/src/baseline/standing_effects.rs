//! Effects that a fleet shows at all times.

use flight::effect::{EffectId, HiddenParameter};

/// An effect whose size a baseline learns.
pub(crate) struct StandingEffect {
    pub(crate) id: EffectId,
    pub(crate) hidden: HiddenParameter,
    /// Prior standard deviation of its size over the typical size; 1 is all that physics says where the size is known.
    pub(crate) deviation: f64,
}

/// Effects that a fleet shows at all times and that neither a table over lift coefficient and Mach number nor the smooth
/// remainder can represent: gravity and wind on a rotating Earth, effects of signals that are no variable of the remainder,
/// and drag rises steeper than the cells of a table. A baseline learns their sizes, so that a diagnosis reports only what has
/// changed since. Older model files hold the first three only.
pub(crate) const STANDING_EFFECTS: [StandingEffect; 10] = [
    standing_effect(EffectId::LocalGravity, 1.0),
    standing_effect(EffectId::RotatingEarth, 1.0),
    standing_effect(EffectId::IsobaricSlope, 2.0),
    standing_effect(EffectId::LoadFactor, 1.0),
    standing_effect(EffectId::TrimDragCg, 1.0),
    standing_effect(EffectId::AsymmetryDrag, 1.0),
    standing_effect(EffectId::AntiIceBleed, 1.0),
    drag_rise(0.82),
    drag_rise(0.88),
    drag_rise(0.94),
];

pub(crate) const fn standing_effect(id: EffectId, deviation: f64) -> StandingEffect {
    StandingEffect { id, hidden: id.entry().hidden, deviation }
}

const fn drag_rise(drag_divergence_mach: f64) -> StandingEffect {
    let hidden = HiddenParameter::DragDivergenceMach(drag_divergence_mach);
    StandingEffect { id: EffectId::WaveDrag, hidden, deviation: 1.0 }
}
