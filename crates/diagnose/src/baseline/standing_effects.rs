//! Effects that a fleet shows at all times.

use flight::effect::{EffectId, HiddenParameter};

/// An effect that a baseline carries.
pub(crate) struct Carried {
    pub(crate) id: EffectId,
    pub(crate) hidden: HiddenParameter,
    /// Prior standard deviation of its size over the typical size; 1 is all that physics says where the size is known.
    pub(crate) deviation: f64,
}

/// What a fleet shows at all times and no table over lift coefficient and Mach number, and no smooth remainder, can hold: the
/// Earth and its air, and effects of signals that the remainder does not look at, or that bend faster than a table's cells.
/// Whatever of it a baseline was taught is no change. The first three are what older model files hold.
pub(crate) const ENVIRONMENT: [Carried; 10] = [
    carried(EffectId::LocalGravity, 1.0),
    carried(EffectId::RotatingEarth, 1.0),
    carried(EffectId::IsobaricSlope, 2.0),
    carried(EffectId::LoadFactor, 1.0),
    carried(EffectId::TrimDragCg, 1.0),
    carried(EffectId::AsymmetryDrag, 1.0),
    carried(EffectId::AntiIceBleed, 1.0),
    drag_rise(0.82),
    drag_rise(0.88),
    drag_rise(0.94),
];

pub(crate) const fn carried(id: EffectId, deviation: f64) -> Carried {
    Carried { id, hidden: id.entry().hidden, deviation }
}

const fn drag_rise(drag_divergence_mach: f64) -> Carried {
    let hidden = HiddenParameter::DragDivergenceMach(drag_divergence_mach);
    Carried { id: EffectId::WaveDrag, hidden, deviation: 1.0 }
}
