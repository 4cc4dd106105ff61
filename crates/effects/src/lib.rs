//! The physics of what a performance model may lack: what each effect of the library does to the recorded fuel flow of
//! a segment, and models that contain effects permanently.
//!
//! What it is: [`EffectModel`], in which effects are switched on and off, and [`ExtendedModel`], a performance model
//! with the effects of past diagnoses. The equations are small functions of a point, the state that was flown, and
//! layers of effects: drag and weight, engine and fuel flow, and recordings, one file each.
//! What it is not: id, unit, typical size, sign, inputs and words of an effect are in [`flight::effect`]. It finds no effect: that
//! is the diagnosis' business.
//!
//! The one design decision: what is predicted is always the *recorded* fuel flow, so that the residual
//! ln Wf recorded − ln Wf predicted is the gap. Nothing is linearised. An effect changes the drag coefficient, the TSFC or the
//! weight that lift carries, or it undoes an error of what was recorded.
//!
//! Difficult: a sensor effect describes how the *recording* errs, so its sign is opposite to that of a change of the
//! aircraft. All of it is in `recorded.rs`.
//!
//! Limits:
//! - Engines give equal thrust; they differ in what they burn.
//! - Beyond the drag table's edge the table is continued in a straight line where an effect moved the point there, and nowhere
//!   else.
//! - Anti-ice bleed that is not recorded is taken as on above −40 °C.
//!
//! # Adding an effect
//!
//! | edit | what | without it |
//! |---|---|---|
//! | `flight/src/effect.rs` | one line in the list: documentation, id, entry | there is no such id |
//! | `flight/src/effect/airframe.rs` or its neighbours | the entry: name, unit, typical size, sign, inputs, words | the list's line does not compile |
//! | `effects/src/drag.rs`, `engine.rs` or `recorded.rs` | the equation, which reads `terms.size(EffectId::…)` | the test of signatures finds no slope |
//! | `effects/src/model/tests.rs` | the slope by hand | the test of signatures names the effect without a row |
//! | `simulate/src/terms/resolve.rs` | the truth's own form: a function added to drag or fuel flow | a flown effect changes nothing, and the test of flown effects names it |
//!
//! `diagnose/examples/numbers_that_decide.rs` then writes the book's page of numbers again (its test finds the page different
//! until then), and the equation and the truth's own form want a line each in `docs/src/theory`, whose check names an
//! effect that they do not mention.
//!
//! A new kind of hidden parameter is a variant of [`flight::effect::HiddenParameter`]; the compiler names the places that match on
//! it.
//!
//! ```
//! use effects::{AppliedEffects, AppliedLayer, EffectReferences, Effects, ExtendedModel};
//! use flight::effect::EffectId;
//! use perf_model::{Aircraft, FlightPoint, Guide, initial_model};
//! use units::{Mach, Mass, PressureAltitude};
//!
//! let aircraft = Aircraft::from_ron(
//!     r#"(
//!         name: "JSBSim global5000", type_code: "GL5T", engines: 2, wing_area_m2: 94.94690688,
//!         tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0),
//!         table: (lift_coefficient: (0.30, 0.60, 0.05), mach: (0.76, 0.88, 0.02)),
//!     )"#,
//! )?;
//! let guide = Guide::from_csv(include_bytes!("../../perf-model/tests/golden/guide.csv"))?;
//! let base = ExtendedModel::from(initial_model(&aircraft, &guide)?.model);
//!
//! let references = EffectReferences {
//!     date_s: 1.5e9,
//!     mach: 0.8,
//!     unit_reynolds_number_per_m: 5e6,
//!     temperature_ratio: 0.75,
//!     corrected_thrust_n: 1e5,
//!     fuel_flow_total_kg_s: 0.45,
//!     mass_kg: 30_000.0,
//!     center_of_gravity_percent_mac: None,
//! };
//! let layer = AppliedLayer::new(Effects::one(EffectId::DragFactor, 2.0), references);
//! let extended = base.with_effects(AppliedEffects::new(vec![layer]))?;
//!
//! let cruise = FlightPoint::new(Mass::pounds(66_000.0), PressureAltitude::feet(41_000.0), Mach::new(0.80));
//! let more = extended.predict(&cruise)?.fuel_flow_total / base.predict(&cruise)?.fuel_flow_total;
//! assert!((more - 1.02).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod applied;
mod drag;
mod engine;
mod error;
mod extended;
mod form;
mod known;
mod lost_rises;
mod mean;
mod model;
mod point;
mod polar;
mod recorded;
mod references;
mod response;
mod set;
mod terms;
mod variable;

pub use applied::{AppliedEffects, AppliedLayer, AtReference, OUTSIDE};
pub use drag::{drag_rise, steep_drag_rise};
pub use engine::ANTI_ICE_PROXY_K;
pub use error::{EffectError, EffectModelError, ObserveError, PredictError};
pub use extended::ExtendedModel;
pub use form::{AppliedForm, DRAG_COEFFICIENT_PER_COUNT, Form, PERCENT};
pub use known::{KnownPoint, Trial};
pub use lost_rises::{GuideRange, lost_rises};
pub use mean::mean_references;
pub use model::EffectModel;
pub use point::EffectPoint;
pub use references::EffectReferences;
pub use response::{BetweenNodes, Response, value_continued};
pub use set::Effects;
pub use variable::{Aloft, Variable};
