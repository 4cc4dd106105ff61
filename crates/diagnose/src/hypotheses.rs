//! What may be the cause: columns of the linear model, backgrounds, and the evidence of one or two effects.

pub(crate) mod backgrounds;
pub(crate) mod design;
pub(crate) mod evidence;
