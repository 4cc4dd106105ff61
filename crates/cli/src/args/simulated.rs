//! Commands on simulated flights.

use std::path::PathBuf;

use clap::Args;

use super::JsonFlag;

/// `simulate`
#[derive(Debug, Args)]
pub(crate) struct SimulateArgs {
    /// Plan file (RON): aircraft, fleet, dates, effects, sensors, seed; or `ghazi-2020` for the study of the paper,
    /// with aircraft file, guide and static points
    #[arg(value_name = "PLAN.ron")]
    pub(crate) plan: PathBuf,
    /// Folder to write to: TAIL/FLIGHT.txt and TRUTH.json; of a fleet also EVENTS.csv
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Also write the true state of each sample: TAIL/FLIGHT-states.csv
    #[arg(long)]
    pub(crate) states: bool,
    /// Write into a folder that holds something else; reports of another plan are removed from it
    #[arg(long)]
    pub(crate) force: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `trial`
#[derive(Debug, Args)]
pub(crate) struct TrialArgs {
    /// Plan of the trials (RON) [default: a short one built into the program]
    #[arg(value_name = "PLAN.ron")]
    pub(crate) plan: Option<PathBuf>,
    /// Folder to write to: trials.html, trials.json, trials.md, truth/, cases/; a folder started with the same plan is continued
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// The long plan built into the program; takes hours
    #[arg(long, conflicts_with = "plan")]
    pub(crate) long: bool,
    /// Seed to use instead of the plan's
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Exit with status 2 if a score is below the plan's floor
    #[arg(long)]
    pub(crate) check: bool,
    /// Start over: an existing folder is kept under another name
    #[arg(long)]
    pub(crate) restart: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `demo`
#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Folder to write to
    #[arg(long, short, value_name = "DIR", default_value = "cruisefit-demo")]
    pub(crate) output: PathBuf,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}
