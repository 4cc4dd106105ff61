//! Arguments of the commands that make models and let them learn.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{JsonFlag, ModelArgs, ReportsArgs};

/// `init`
#[derive(Debug, Args)]
pub(crate) struct InitArgs {
    /// Aircraft file (RON)
    #[arg(long, value_name = "AIRCRAFT.ron")]
    pub(crate) aircraft: PathBuf,
    /// Flight-planning guide (CSV)
    #[arg(long, value_name = "GUIDE.csv")]
    pub(crate) guide: PathBuf,
    /// Standard deviations of the recorded quantities (RON), in place of those in the aircraft file
    #[arg(long, value_name = "SENSORS.ron")]
    pub(crate) sensors: Option<PathBuf>,
    /// Model file to write
    #[arg(long, short, value_name = "MODEL.ron")]
    pub(crate) output: PathBuf,
    /// Write the model although the guide has serious findings
    #[arg(long)]
    pub(crate) accept: bool,
    /// Replace a file that this command did not make
    #[arg(long)]
    pub(crate) force: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// The adaptation laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LawName {
    /// The Gaussian law: a smooth correction with a standard deviation at every node
    Bayes,
    /// The local law of Ghazi et al. 2020 with its global refit
    Paper,
}

/// `adapt`
#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is an option of its own")]
pub(crate) struct AdaptArgs {
    /// Reports.
    #[command(flatten)]
    pub(crate) reports: ReportsArgs,
    /// Models.
    #[command(flatten)]
    pub(crate) models: ModelArgs,
    /// Folder to write to; an existing folder is continued
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Adaptation law
    #[arg(long, value_enum, default_value_t = LawName::Bayes)]
    pub(crate) law: LawName,
    /// Law `paper`: adapt where the error exceeds this, in per cent [default: the model's]
    #[arg(long, value_name = "PCT")]
    pub(crate) threshold: Option<f64>,
    /// Law `bayes`: do not learn what no table can hold (smooth remainder, N2 deck, noise levels); `diagnose` then
    /// counts it as gap
    #[arg(long)]
    pub(crate) no_remainder: bool,
    /// Learn a report in place of a known flight that it contradicts: other content under the same name and START, the
    /// same hours under another name. The tail is learnt anew from its first flight on
    #[arg(long)]
    pub(crate) relearn: bool,
    /// Start over: an existing folder is kept under another name
    #[arg(long)]
    pub(crate) restart: bool,
    /// Also learn tails that are more than 15 % off the book, and off what they are known to burn, on average
    #[arg(long)]
    pub(crate) accept: bool,
    /// Wait while another process writes the folder, instead of refusing
    #[arg(long)]
    pub(crate) wait: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `forget`
#[derive(Debug, Args)]
pub(crate) struct ForgetArgs {
    /// Folder that `adapt` wrote
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    /// Tail
    #[arg(long, value_name = "TAIL")]
    pub(crate) tail: String,
    /// Flight, as its report names it
    #[arg(long, value_name = "FLIGHT")]
    pub(crate) flight: String,
    /// START of the flight, where several have its name
    #[arg(long, value_name = "START")]
    pub(crate) start: Option<String>,
    /// Wait while another process writes the folder, instead of refusing
    #[arg(long)]
    pub(crate) wait: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `tune`
#[derive(Debug, Args)]
pub(crate) struct TuneArgs {
    /// Reports.
    #[command(flatten)]
    pub(crate) reports: ReportsArgs,
    /// Initial model
    #[arg(long, value_name = "MODEL.ron")]
    pub(crate) model: PathBuf,
    /// Initial model to write, with the settings found
    #[arg(long, short, value_name = "MODEL2.ron")]
    pub(crate) output: PathBuf,
    /// Half-life of what was learnt, in calendar days; none: it does not age; search: the half-life that best predicts
    /// each report from those before it. Without this option the model keeps its own. With a half-life, noise is not
    /// searched
    #[arg(long, value_name = "DAYS|none|search")]
    pub(crate) half_life: Option<HalfLifeChoice>,
    /// Replace a file that this command did not make
    #[arg(long)]
    pub(crate) force: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// What `tune` does about the half-life.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum HalfLifeChoice {
    /// Knowledge does not age.
    Never,
    /// This many calendar days.
    Days(f64),
    /// Searched for on the reports.
    Search,
}

impl std::str::FromStr for HalfLifeChoice {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "none" => Ok(Self::Never),
            "search" => Ok(Self::Search),
            days => days
                .parse()
                .map(Self::Days)
                .map_err(|_| "neither a number of days nor none nor search".to_owned()),
        }
    }
}

/// `merge`
#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// Models that learnt by law `bayes` from the same initial model with the same settings
    #[arg(required = true, num_args = 2.., value_name = "MODEL.ron")]
    pub(crate) models: Vec<PathBuf>,
    /// Model file to write
    #[arg(long, short, value_name = "MODEL.ron")]
    pub(crate) output: PathBuf,
    /// Replace a file that this command did not make
    #[arg(long)]
    pub(crate) force: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}
