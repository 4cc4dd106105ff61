//! What a performance model may lack.

mod applied;
mod drag;
mod engine;
mod error;
mod extended;
mod known;
mod mean;
mod model;
mod point;
mod recorded;
mod references;
mod response;
mod set;
mod terms;

pub use applied::{AppliedEffects, AppliedLayer};
pub use engine::ANTI_ICE_PROXY_K;
pub use error::{EffectError, EffectModelError, ObserveError, PredictError};
pub use extended::ExtendedModel;
pub use known::{KnownPoint, Trial};
pub use mean::mean_references;
pub use model::EffectModel;
pub use point::EffectPoint;
pub use references::EffectReferences;
pub use response::Response;
pub use set::Effects;
