//! Blind trials of the diagnosis: a virtual aircraft flies with an effect that its model lacks.
//!
//! What it is: a [`TrialPlan`] states what is planted, how large, how often; [`DiagnosedCase::run`] draws, flies and diagnoses
//! one case; [`DiagnosedCase::score`] holds the verdict against the truth; [`summarize`] makes [`SCORES`] of all cases.
//! What it is not: it opens no file and starts no thread. Cases are independent of each other; the caller who runs them writes them
//! down and may run them in any order.
//!
//! The one design decision: three worlds, kept apart by types. [`DrawnCase`] knows what was planted and flies it;
//! [`DiagnosisInputs`] is all that the diagnosis is given, and no effect is named in it; the truth is sealed by its hash
//! before the first diagnosis begins, and [`Seal::open`] is the only way back to it, for the scorer, after the verdict.
//! Everything of a case follows from the plan's seed and the case's label. That costs a second flight of every case without
//! what was planted, when it is scored.
//!
//! Limits:
//! - The truth flies in the equations of `simulate`: what neither those nor the library have is not tried.
//! - The aircraft file of a case states the virtual sensors as they are; an operator knows them less well.
//! - Scores are of one type of aircraft at a time.
//!
//! ```
//! use trials::{Seal, TrialPlan};
//!
//! let plan = TrialPlan::from_ron(
//!     "(seed: 1, parts: [(denied: exact, background: clean, kind: null, repeats: 2)])",
//! )?;
//! assert_eq!(plan.cases(2).len(), 2);
//! // What was sealed is known again by its bytes, and only by them.
//! let seal = Seal::of_texts(["{}"]);
//! assert!(seal.open(1, b"{ }").is_err());
//! # Ok::<(), trials::TrialPlanError>(())
//! ```

mod calibration;
mod case;
mod diagnosis_inputs;
mod draw;
mod failure;
mod fleets;
mod flown_case;
mod guide_model;
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

pub use calibration::CalibrationBin;
pub use case::{CaseResult, DiagnosedCase};
pub use diagnosis_inputs::DiagnosisInputs;
pub use draw::DrawnCase;
pub use failure::CaseFailure;
pub use fleets::{
    DrawnFleet, FleetGroup, FleetPart, FleetResult, FleetScore, FleetSpec, FleetTruth, FoundAs,
    FoundChange, FoundFleet, JudgedFinding, LevelFound, MonitoredTail, PlantedFound, StepFound,
};
pub use markdown::{fleet_words, group_words, markdown, terminal};
pub use plan::{
    Background, CaseSpec, Floor, Kind, Part, ReferenceModel, TrialPlan, TrialPlanError,
};
pub use scored_case::{Case, Located, Planted};
pub use scores::{Reached, SCORES, Score, ScoreName, Scores};
pub use seal::{CaseTruth, Seal, SealError};
pub use share::Share;
pub use summary::{FleetTrials, FloorMissed, Goal, Group, Trials, floors_missed, summarize};
