//! Where a model differs from flight, which effect it lacks, how far the gap shrinks.

mod analysis;
mod baseline;
mod classes;
mod closure;
mod data;
mod design;
mod diagnosis;
mod evidence;
mod gram;
mod library;
mod linear;
mod noise;
mod outside;
mod output;
mod record;
mod refine;
mod robust;
pub mod trial;
mod uncertainty;
mod variables;

pub use baseline::{Baseline, BaselineLengthError};
pub use diagnosis::{DiagnoseError, Input, Options, diagnose, references_of};
pub use noise::NoiseFactors;
pub use output::{
    Cause, Detectable, Diagnosis, Gap, Magnitude, NotTestable, OutsideLibrary, Separation, Slice,
    Verdict, VerdictKind,
};
pub use record::{FlightRecord, GaugeBurn};
pub use uncertainty::{TableUncertainty, TableUncertaintyError};
pub use variables::Variable;
