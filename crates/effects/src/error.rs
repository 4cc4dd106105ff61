//! Why there is no model with effects, no prediction, no observation.

use flight::effect::EffectId;
use lut::surface::FitError;
use perf_model::ModelError;
use units::OutOfDomain;

/// Why there is no model with effects.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EffectModelError {
    /// A table on another grid than the aircraft's.
    #[error("the drag table is not on the grid of the aircraft file")]
    GridDiffers,
    /// The table does not determine CD0(M) and K(M).
    #[error("CD0(M) and K(M) cannot be fitted to the drag table: {0}")]
    Polar(#[from] FitError),
    /// A table that does not make a performance model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A reference that is not finite and positive.
    #[error("reference {quantity} is {value}, not finite and positive")]
    Reference {
        /// Which.
        quantity: &'static str,
        /// The value given.
        value: f64,
    },
    /// The size of an applied effect that is not finite.
    #[error("size of {effect} is {size}, not finite")]
    Size {
        /// The effect.
        effect: EffectId,
        /// The value given.
        size: f64,
    },
    /// A number of a form outside the library that makes no function.
    #[error("{quantity} of a form outside the library is {value}, expected {expected}")]
    Form {
        /// Which.
        quantity: &'static str,
        /// The value given.
        value: f64,
        /// What it has to be.
        expected: &'static str,
    },
    /// A form outside the library over something that is no property of the aircraft or its surroundings.
    #[error(
        "a function of {variable} says something of what was recorded, and is no part of a prediction"
    )]
    FormOver {
        /// Of what.
        variable: &'static str,
    },
    /// None of the segments can be predicted by the model, so there are no references.
    #[error("none of {segments} segments is inside the drag table")]
    NothingInside {
        /// Segments given.
        segments: usize,
    },
}

/// Why an effect has no prediction for a segment.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EffectError {
    /// An input that the effect needs was not recorded.
    #[error("{effect} needs {needs}, which is not recorded")]
    NotRecorded {
        /// The effect.
        effect: EffectId,
        /// Name of the column.
        needs: &'static str,
    },
    /// A quantity outside its domain, as recorded or as corrected by a sensor effect.
    #[error(transparent)]
    OutOfDomain(#[from] OutOfDomain),
    /// The table does not hold the *recorded* point.
    #[error("lift coefficient {lift_coefficient:.4}, Mach number {mach:.4} outside the drag table")]
    OutsideTable {
        /// Lift coefficient.
        lift_coefficient: f64,
        /// Mach number.
        mach: f64,
    },
    /// An applied form outside the library has no value: a power of what is not positive.
    #[error("the form outside the library that the model contains has no value at this point")]
    FormUndefined,
    /// No thrust is left with these effects.
    #[error("net thrust {net_thrust_n:.0} N is not positive")]
    ThrustNotPositive {
        /// Net thrust, N.
        net_thrust_n: f64,
    },
}

/// Why a segment does not give an observation for a model with effects.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObserveError {
    /// The model without effects gives none.
    #[error(transparent)]
    Model(#[from] perf_model::ObserveError),
    /// An applied effect has no prediction for the segment.
    #[error(transparent)]
    Effect(#[from] EffectError),
}

/// Why a model with effects has no prediction.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PredictError {
    /// The model without effects gives none.
    #[error(transparent)]
    Model(#[from] perf_model::PredictError),
    /// An applied effect has no prediction.
    #[error(transparent)]
    Effect(#[from] EffectError),
}

impl From<OutOfDomain> for PredictError {
    fn from(error: OutOfDomain) -> Self {
        Self::Model(error.into())
    }
}
