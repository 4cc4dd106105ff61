//! Blind trials of the diagnosis: the virtual aircraft flies with an effect that its model lacks.
//!
//! Three worlds, kept apart by types. [`DrawnCase`] knows what was planted and flies it; [`DiagnosisInputs`] is all that the
//! diagnosis is given, and nothing in it names an effect; the truth lies on disk, sealed by its hash before the first
//! diagnosis begins, and [`Seal::open`] is the only way back to it, for the scorer, after the verdict.
//!
//! Everything of a case follows from the plan's seed and the case's label: cases can be run in any order, on any number of
//! threads, today or after an interruption.

mod case;
mod diagnosis_inputs;
mod draw;
mod failure;
mod flown_case;
mod markdown;
pub mod places;
mod plan;
mod planted;
mod reference_model;
mod scored_case;
mod scores;
mod seal;
mod share;
mod stated_sensors;
mod summary;

pub use case::{CaseResult, DiagnosedCase};
pub use diagnosis_inputs::DiagnosisInputs;
pub use draw::DrawnCase;
pub use failure::CaseFailure;
pub use markdown::{markdown, terminal};
pub use plan::{
    Background, CaseSpec, Floor, Kind, Part, ReferenceModel, TrialPlan, TrialPlanError,
};
pub use scored_case::{Case, Located, Planted};
pub use scores::{Reached, SCORES, Score, ScoreName, Scores};
pub use seal::{CaseTruth, Seal, SealError};
pub use share::Share;
pub use summary::{FloorMissed, Goal, Group, Trials, floors_missed, summarize};
