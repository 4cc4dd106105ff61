//! Blind trials of the diagnosis: the virtual aircraft flies with an effect that the model is denied.
//!
//! Three worlds, kept apart by types. [`Withheld`] knows what was planted and flies it; [`Evidence`] is all that the
//! diagnosis is given, and nothing in it names an effect; the truth lies on disk, sealed by its hash before the first
//! diagnosis begins, and [`Seal::open`] is the only way back to it, for the scorer, after the verdict.
//!
//! Everything of a case follows from the plan's seed and the case's label: cases can be run in any order, on any number of
//! threads, today or after an interruption.

mod case;
mod draw;
mod evidence;
mod plan;
mod planted;
mod seal;
mod summary;
mod text;

pub use case::{CaseFailure, CaseResult, run_case};
pub use draw::Withheld;
pub use evidence::Evidence;
pub use plan::{Background, CaseSpec, Denied, Floor, Kind, Part, ScoreName, TrialPlan};
pub use seal::{CaseTruth, Seal};
pub use summary::{FloorMissed, Goal, Group, Trials, floors_missed, summarize};
pub use text::{markdown, terminal};
