//! The options of `diagnose`.

use std::path::PathBuf;

use clap::Args;

use super::{JsonFlag, ModelArgs, ReportsArgs};

/// `diagnose`
#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub(crate) struct DiagnoseArgs {
    /// Reports.
    #[command(flatten)]
    pub(crate) reports: ReportsArgs,
    /// Models.
    #[command(flatten)]
    pub(crate) models: ModelArgs,
    /// Folder to write to: diagnosis.json, diagnosis.html, gaps.csv
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Look for these effects only. `outside` is none of them: with --apply it has the form applied that describes a gap
    /// which no effect explains
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    pub(crate) effects: Vec<String>,
    /// Leave these effects out
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    pub(crate) without: Vec<String>,
    /// Write each tail's model, extended by the effects found, to this folder as TAIL.ron; where the flights cannot
    /// distinguish several effects, name the right one with --effects
    #[arg(long, value_name = "DIR")]
    pub(crate) apply: Option<PathBuf>,
    /// One diagnosis for all tails together
    #[arg(long, conflicts_with = "fleet")]
    pub(crate) pool: bool,
    /// Also compare all tails of a type with each other: what all share is the model's, what one has is the aircraft's or its
    /// sensors'. Adds fleet.html and fleet.csv; with --apply writes TYPE.ron with what all share, and TAIL.ron with each tail's own
    #[arg(long)]
    pub(crate) fleet: bool,
    /// Count what the model's remainder explains as gap
    #[arg(long)]
    pub(crate) table_only: bool,
    /// Also diagnose flights that the model has learnt
    #[arg(long)]
    pub(crate) allow_learnt: bool,
    /// Also diagnose tails that are more than 15 % off the book on average
    #[arg(long)]
    pub(crate) accept: bool,
    /// What was done to which tail and when: date,tail,kind,note (wash, `engine_change`, …). Steps and histories try these
    /// dates too
    #[arg(long, value_name = "EVENTS.csv")]
    pub(crate) events: Option<PathBuf>,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}
