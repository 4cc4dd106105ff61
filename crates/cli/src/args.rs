//! The command line's grammar. What a command does is in `commands`.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use segmenter::TrimCriteria;

/// Aircraft performance monitoring from cruise reports.
///
/// Reads cruise reports, finds the stabilised segments, and corrects the drag table of the aircraft's performance model
/// so that the predicted fuel flow matches the recorded one. Errors are 100 (recorded − predicted)/recorded: a positive
/// error means that the aircraft burns more than the model predicts.
#[derive(Debug, Parser)]
#[command(name = "cruisefit", version, max_term_width = 100)]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Options of every command.
    #[command(flatten)]
    pub(crate) common: Common,
}

/// Options of every command.
#[derive(Clone, Debug, Args)]
pub(crate) struct Common {
    /// Worker threads; results are the same bytes for any number [default: one per processor]
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Show no progress on the terminal
    #[arg(long, global = true)]
    pub(crate) no_progress: bool,
    /// Log more to stderr (-v: what was done, -vv: why); `RUST_LOG` overrides
    #[arg(long, short, global = true, action = clap::ArgAction::Count)]
    pub(crate) verbose: u8,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Initial model of an aircraft from its flight-planning guide
    Init(InitArgs),
    /// Adapt models to cruise reports, one model per tail
    Adapt(AdaptArgs),
    /// Stabilised segments only, no model needed
    Segment(SegmentArgs),
    /// Fit the settings of law `bayes` to past reports, by marginal likelihood
    Tune(TuneArgs),
    /// Combine what models of the same initial model have learnt (law `bayes`)
    Merge(MergeArgs),
    /// Predict fuel flow and specific range at flight points
    Predict(PredictArgs),
    /// Fuel-flow error of a model over reports; nothing is adapted
    Evaluate(EvaluateArgs),
    /// Which effect a model lacks: compares it with reports that it has not learnt
    Diagnose(DiagnoseArgs),
    /// Show what a model file holds
    Show(ShowArgs),
    /// Export a model's table as CSV
    Export(ExportArgs),
    /// Compare a whole run with expected files, or accept it as expected
    #[command(subcommand)]
    Golden(GoldenCommand),
    /// Cruise reports of a virtual aircraft, with any effects switched on
    Simulate(SimulateArgs),
    /// Blind trials: simulate flights with an effect that the model does not have, diagnose, score
    Trial(TrialArgs),
    /// The whole chain on embedded data; needs no input
    Demo(DemoArgs),
}

/// Where reports come from.
#[derive(Clone, Debug, Args)]
pub(crate) struct ReportsArgs {
    /// Cruise reports: files, folders (searched recursively for .txt, .rpt, .gz) and globs
    #[arg(required = true, value_name = "REPORTS")]
    pub(crate) reports: Vec<PathBuf>,
    /// Mapping file (RON), or the name of a preset, for recordings of another layout
    #[arg(long, value_name = "MAPPING")]
    pub(crate) mapping: Option<String>,
    /// Trim criteria that decide which samples are steady
    #[arg(long, value_name = "NAME", default_value = TrimCriteria::PRESETS[0], value_parser = TrimCriteria::PRESETS)]
    pub(crate) criteria: String,
    /// Stop before anything is written if a report is refused
    #[arg(long)]
    pub(crate) strict: bool,
}

/// Models to choose from.
#[derive(Clone, Debug, Args)]
pub(crate) struct ModelArgs {
    /// Model file, or folder of them; may be given several times. A report uses the model of its tail, otherwise the
    /// one of its type
    #[arg(long = "model", required = true, value_name = "MODEL.ron")]
    pub(crate) models: Vec<PathBuf>,
}

/// `init`
#[derive(Debug, Args)]
pub(crate) struct InitArgs {
    /// Aircraft file (RON)
    #[arg(long, value_name = "AIRCRAFT.ron")]
    pub(crate) aircraft: PathBuf,
    /// Flight-planning guide (CSV)
    #[arg(long, value_name = "GUIDE.csv")]
    pub(crate) guide: PathBuf,
    /// Model file to write
    #[arg(long, short, value_name = "MODEL.ron")]
    pub(crate) output: PathBuf,
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
    /// Start over: an existing folder is kept under another name
    #[arg(long)]
    pub(crate) restart: bool,
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
}

/// `segment`
#[derive(Debug, Args)]
pub(crate) struct SegmentArgs {
    /// Reports.
    #[command(flatten)]
    pub(crate) reports: ReportsArgs,
    /// File to write, .csv or .parquet [default: CSV to standard output]
    #[arg(long, short, value_name = "SEGMENTS")]
    pub(crate) output: Option<PathBuf>,
    /// Print what each criterion cost, flight by flight
    #[arg(long)]
    pub(crate) explain: bool,
}

/// `predict`
#[derive(Debug, Args)]
pub(crate) struct PredictArgs {
    /// Model file
    #[arg(long, value_name = "MODEL.ron")]
    pub(crate) model: PathBuf,
    /// Flight points, .csv or .parquet
    #[arg(value_name = "POINTS")]
    pub(crate) points: PathBuf,
    /// File to write, .csv or .parquet [default: CSV to standard output]
    #[arg(long, short, value_name = "OUT")]
    pub(crate) output: Option<PathBuf>,
    /// Predict with the drag table alone, without what else the model has learnt
    #[arg(long)]
    pub(crate) table_only: bool,
}

/// `evaluate`
#[derive(Debug, Args)]
pub(crate) struct EvaluateArgs {
    /// Reports.
    #[command(flatten)]
    pub(crate) reports: ReportsArgs,
    /// Models.
    #[command(flatten)]
    pub(crate) models: ModelArgs,
    /// Also write the summary as JSON
    #[arg(long, value_name = "OUT.json")]
    pub(crate) json: Option<PathBuf>,
    /// Evaluate the drag table alone, without what else the model has learnt
    #[arg(long)]
    pub(crate) table_only: bool,
}

/// `diagnose`
#[derive(Debug, Args)]
pub(crate) struct DiagnoseArgs {
    /// Reports.
    #[command(flatten)]
    pub(crate) reports: ReportsArgs,
    /// Models.
    #[command(flatten)]
    pub(crate) models: ModelArgs,
    /// Folder to write to: diagnosis.json, diagnosis.html
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Look for these effects only
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
    #[arg(long)]
    pub(crate) pool: bool,
    /// Count what the model's remainder explains as gap
    #[arg(long)]
    pub(crate) table_only: bool,
    /// Also diagnose flights that the model has learnt
    #[arg(long)]
    pub(crate) allow_learnt: bool,
}

/// `show`
#[derive(Debug, Args)]
pub(crate) struct ShowArgs {
    /// Model file
    #[arg(value_name = "MODEL.ron")]
    pub(crate) model: PathBuf,
}

/// `export`
#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    /// Model file
    #[arg(value_name = "MODEL.ron")]
    pub(crate) model: PathBuf,
    /// CSV file to write [default: standard output]
    #[arg(long, short, value_name = "TABLE.csv")]
    pub(crate) output: Option<PathBuf>,
    /// Export the six-coefficient polynomial nearest to the table instead, with its covariance where the law provides
    /// one
    #[arg(long)]
    pub(crate) polynomial: bool,
}

/// `golden`
#[derive(Debug, Subcommand)]
pub(crate) enum GoldenCommand {
    /// Run what DIR/golden.ron describes and print each value out of tolerance
    Check {
        /// Folder with golden.ron and expected files
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
    },
    /// Run what DIR/golden.ron describes and write the result as the expected files
    Bless {
        /// Folder with golden.ron
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
    },
}

/// `simulate`
#[derive(Debug, Args)]
pub(crate) struct SimulateArgs {
    /// Plan file (RON): aircraft, fleet, dates, effects, sensors, seed; or `ghazi-2020` for the study of the paper,
    /// with aircraft file, guide and static points
    #[arg(value_name = "PLAN.ron")]
    pub(crate) plan: PathBuf,
    /// Folder to write to: TAIL/FLIGHT.txt and TRUTH.json
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Also write the true state of each sample: TAIL/FLIGHT-states.csv
    #[arg(long)]
    pub(crate) states: bool,
}

/// `trial`
#[derive(Debug, Args)]
pub(crate) struct TrialArgs {
    /// Plan of the trials (RON) [default: a short one built into the program]
    #[arg(value_name = "PLAN.ron")]
    pub(crate) plan: Option<PathBuf>,
    /// Folder to write to: trials.json, trials.md, truth/, cases/; a folder started with the same plan is continued
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
}

/// `demo`
#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Folder to write to
    #[arg(long, short, value_name = "DIR", default_value = "cruisefit-demo")]
    pub(crate) output: PathBuf,
}
