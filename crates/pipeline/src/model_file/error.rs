//! Why a text is not a model.

use adapt::bayes::StateDataError;
use adapt::paper::StateError;
use diagnose::BaselineError;
use effects::EffectModelError;
use lut::TableError;
use perf_model::{AircraftError, GuideLevelError, ModelError};

use super::FORMAT;
use crate::addition_record::UnknownEffect;
use crate::whole_model::BeliefError;

/// Why a text is not a model.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ModelTextError {
    /// Some other file.
    #[error("not a model file: it has no `format:` field")]
    NoModel,
    /// Written by a newer program.
    #[error("model format {found}, this program reads up to {FORMAT}")]
    Newer {
        /// Its format.
        found: u32,
    },
    /// No checksum at the end.
    #[error("the file has no checksum: it is cut off")]
    CutOff,
    /// The bytes are not those that were written.
    #[error(
        "checksum {found} does not match the content ({computed}): the file was changed or damaged"
    )]
    Damaged {
        /// As written in the file.
        found: String,
        /// Of the bytes before it.
        computed: String,
    },
    /// Not what a model file holds.
    #[error("{0}")]
    Syntax(#[from] ron::error::SpannedError),
    /// A value that makes no model.
    #[error("{field}: {reason}")]
    Value {
        /// The field.
        field: &'static str,
        /// What is wrong.
        #[source]
        reason: ModelValueError,
    },
}

impl ModelTextError {
    /// What may be done about it.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Newer { .. } => Some("use a newer cruisefit".to_owned()),
            Self::CutOff | Self::Damaged { .. } => {
                Some("take the file from a backup, or adapt again from the reports".to_owned())
            }
            _ => None,
        }
    }
}

/// What is wrong with a value of a model file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ModelValueError {
    /// Breakpoints other than those of the aircraft.
    #[error("not the breakpoints of the aircraft's table")]
    Breakpoints,
    /// One flag a node is wanted.
    #[error("{flags} flags for {nodes} nodes")]
    FlagCount {
        /// Flags found.
        flags: usize,
        /// Nodes of the table.
        nodes: usize,
    },
    /// Not a flag.
    #[error("found {found}, expected 0 or 1")]
    Flag {
        /// What stands there.
        found: u8,
    },
    /// A node beyond the table's last.
    #[error("node {node} of a table of {nodes} nodes")]
    NoSuchNode {
        /// Index found.
        node: usize,
        /// Nodes of the table.
        nodes: usize,
    },
    /// The aircraft.
    #[error(transparent)]
    Aircraft(#[from] AircraftError),
    /// A level of the guide.
    #[error(transparent)]
    GuideLevel(#[from] GuideLevelError),
    /// A table.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The initial model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The name of an applied effect.
    #[error(transparent)]
    UnknownEffect(#[from] UnknownEffect),
    /// An applied effect that this model cannot take.
    #[error(transparent)]
    Effects(#[from] EffectModelError),
    /// The state of law `paper`.
    #[error(transparent)]
    Paper(#[from] StateError),
    /// The state of law `bayes`.
    #[error(transparent)]
    Bayes(#[from] StateDataError),
    /// The solution of law `bayes`.
    #[error(transparent)]
    Solve(#[from] adapt::bayes::SolveError),
    /// What is believed of the table before any flight.
    #[error(transparent)]
    Belief(#[from] BeliefError),
    /// Parts of what was learnt that do not belong together.
    #[error(transparent)]
    Baseline(#[from] BaselineError),
}
