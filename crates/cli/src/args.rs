//! The command line's grammar. What a command does is in `commands`.

mod common;
mod deferred;
mod diagnose;
pub(crate) mod help;
mod monitor;
mod recordings;
mod simulated;

use std::path::PathBuf;

use crate::criteria::NamedCriteria;
use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use pipeline::prediction::PredictedColumn;

use deferred::Deferred;

pub(crate) use common::{Common, JsonFlag, JsonOutput, JsonWanted, When};
pub(crate) use diagnose::DiagnoseArgs;
pub(crate) use monitor::MonitorArgs;
pub(crate) use recordings::{ConvertArgs, MappingArgs};
pub(crate) use simulated::{DemoArgs, SimulateArgs, TrialArgs};

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

/// The commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Initial model of an aircraft from its flight-planning guide
    Init(Deferred<InitArgs>),
    /// Aircraft file and guide of a public model of the type, where the operator's own guide is not at hand
    Guide(Deferred<GuideArgs>),
    /// Adapt models to cruise reports, one model per tail
    Adapt(Deferred<AdaptArgs>),
    /// What is wrong with reports, before any modelling: units, signs, stuck channels, dates, flights given twice
    Check(Deferred<CheckArgs>),
    /// A first mapping file for a recording of another layout, from the names and values of its columns
    Mapping(Deferred<MappingArgs>),
    /// Recordings of another layout into cruise reports
    Convert(Deferred<ConvertArgs>),
    /// Remove a flight from what a tail has learnt (a wrong load sheet), as if it had never been learnt
    Forget(Deferred<ForgetArgs>),
    /// Stabilised segments only, no model needed
    Segment(Deferred<SegmentArgs>),
    /// Fit the settings of law `bayes` to past reports, by marginal likelihood
    Tune(Deferred<TuneArgs>),
    /// Combine what models of the same initial model have learnt (law `bayes`)
    Merge(Deferred<MergeArgs>),
    /// Predict fuel flow and specific range at flight points
    Predict(Deferred<PredictArgs>),
    /// Fuel-flow error of a model over reports; nothing is adapted
    Evaluate(Deferred<EvaluateArgs>),
    /// Which effect a model lacks: compares it with reports that it has not learnt
    Diagnose(Deferred<DiagnoseArgs>),
    /// What changed over months, when, on which tail: deviations, trends, changes, events, fuel factors
    Monitor(Deferred<MonitorArgs>),
    /// Show what a model file, a report, a diagnosis or a folder of results holds
    Show(Deferred<ShowArgs>),
    /// Export a model's drag: CSV, polynomial, OpenAP, JSBSim, JSON
    Export(Deferred<ExportArgs>),
    /// Maximum-range, long-range and cost-index Mach numbers and best levels by a model, compared with the book's
    Optimum(Deferred<OptimumArgs>),
    /// Draw a model, a tail of an adapted folder, a diagnosis, months or trials as SVG, PNG or PDF
    Plot(Deferred<PlotArgs>),
    /// The library of effects: name, unit, usual size, what has to be recorded
    Effects(Deferred<EffectsArgs>),
    /// What an effect, a column, a set of trim criteria or a verdict is
    Explain(Deferred<ExplainArgs>),
    /// Compare a whole run with expected files, or accept it as expected
    #[command(subcommand)]
    Golden(GoldenCommand),
    /// Cruise reports of a virtual aircraft, with any effects switched on
    Simulate(Deferred<SimulateArgs>),
    /// Blind trials: simulate flights with an effect that the model does not have, diagnose, score
    Trial(Deferred<TrialArgs>),
    /// What a shell completes, for standard output: `cruisefit completions bash > FILE`
    Completions(Deferred<CompletionsArgs>),
    /// Manual pages of the program and of each command
    Man(Deferred<ManArgs>),
    /// The whole chain on embedded data; needs no input
    Demo(Deferred<DemoArgs>),
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
    /// Trim criteria that decide which samples are steady: ghazi-2020-table-4, airbus-report-02, airbus-report-02-short,
    /// or a file (RON) of your own
    #[arg(long, value_name = "CRITERIA", default_value = NamedCriteria::name_of_default())]
    pub(crate) criteria: NamedCriteria,
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

/// `check`
#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Reports.
    #[command(flatten)]
    pub(crate) reports: ReportsArgs,
    /// Also compare with this model (the book), or folder of models: shows masses in the wrong unit. A report uses the
    /// model of its tail, otherwise the one of its type
    #[arg(long = "model", value_name = "MODEL.ron")]
    pub(crate) models: Vec<PathBuf>,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonOutput,
}

/// `guide`
#[derive(Debug, Args)]
pub(crate) struct GuideArgs {
    /// ICAO type designator (A320, B738, …)
    #[arg(long = "type", value_name = "TYPE", required_unless_present = "list")]
    pub(crate) type_code: Option<String>,
    /// List the types, and those that another one represents
    #[arg(long, conflicts_with = "type_code")]
    pub(crate) list: bool,
    /// Folder to write to: AIRCRAFT.ron, guide.csv
    #[arg(long, short, value_name = "DIR", required_unless_present = "list")]
    pub(crate) output: Option<PathBuf>,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
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
    /// Also learn tails that are more than 15 % off the book on average
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
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `predict`
#[derive(Debug, Args)]
pub(crate) struct PredictArgs {
    /// Model file
    #[arg(long, value_name = "MODEL.ron")]
    pub(crate) model: PathBuf,
    /// Flight points, .csv or .parquet; or a table of segments
    #[arg(value_name = "POINTS")]
    pub(crate) points: PathBuf,
    /// Mapping file (RON), or the name of a preset: POINTS is a recording of another layout, of which each averaged point
    /// (or segment) is predicted
    #[arg(long, value_name = "MAPPING")]
    pub(crate) mapping: Option<String>,
    /// File to write, .csv or .parquet [default: CSV to standard output]
    #[arg(long, short, value_name = "OUT")]
    pub(crate) output: Option<PathBuf>,
    /// Predict with the drag table alone, without what else the model has learnt
    #[arg(long)]
    pub(crate) table_only: bool,
    /// State no standard deviations, which take most of the time at very many points
    #[arg(long)]
    pub(crate) without_deviations: bool,
    /// Columns of the prediction that are wanted, separated by commas, in any order: what nobody wants is not computed
    /// [default: all]
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',', hide_possible_values = true)]
    #[arg(value_parser = PossibleValuesParser::new(PredictedColumn::ALL.map(PredictedColumn::name)))]
    pub(crate) columns: Option<Vec<String>>,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
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
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonOutput,
    /// Also write each segment's residual, .csv or .parquet. A flight that the model has learnt is predicted by the table
    /// as it was before, which needs the reports of all flights that were learnt until then; column `predicted_by`
    /// states it
    #[arg(long, short, value_name = "RESIDUALS")]
    pub(crate) output: Option<PathBuf>,
    /// Also write the fuel factor of each tail against the book (the initial table), in all and by condition, .csv or
    /// .parquet
    #[arg(long, value_name = "FACTORS")]
    pub(crate) fuel_factors: Option<PathBuf>,
    /// Evaluate the drag table alone, without what else the model has learnt
    #[arg(long)]
    pub(crate) table_only: bool,
}

/// `show`
#[derive(Debug, Args)]
pub(crate) struct ShowArgs {
    /// Model file, cruise report (plain or gzip), diagnosis.json, summary.json, or the folder of one
    #[arg(value_name = "MODEL.ron|REPORT|JSON|DIR")]
    pub(crate) file: PathBuf,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `export`
#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    /// Model file
    #[arg(value_name = "MODEL.ron")]
    pub(crate) model: PathBuf,
    /// File to write [default: standard output]
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// What to write [default: csv; json where --json prints it]
    #[arg(long, value_enum)]
    pub(crate) format: Option<ExportFormat>,
    /// Mach number of OpenAP's drag polar [default: the mean one of the learnt flights, or the guide's middle]
    #[arg(long, value_name = "MACH")]
    pub(crate) mach: Option<f64>,
    /// The same as --format polynomial
    #[arg(long, conflicts_with = "format")]
    pub(crate) polynomial: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// What `export` writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportFormat {
    /// The table, one row per node, as CSV
    Csv,
    /// The six-coefficient polynomial nearest to the table as CSV, with its covariance where the law provides one
    Polynomial,
    /// The drag polar of OpenAP, cd0 and k at one Mach number, as YAML
    Openap,
    /// A drag function of JSBSim with a table over lift coefficient squared and Mach number, as XML
    Jsbsim,
    /// Table, TSFC law and equations as JSON, for programs in other languages
    Json,
}

/// `optimum`
#[derive(Debug, Args)]
pub(crate) struct OptimumArgs {
    /// Model file
    #[arg(long, value_name = "MODEL.ron")]
    pub(crate) model: PathBuf,
    /// Cost index, in kilograms of fuel per minute (Airbus); one of Boeing's, 100 lb/h, is 0.756
    #[arg(long, value_name = "N", value_parser = cost_index)]
    pub(crate) cost_index: Option<f64>,
    /// Gross masses, kg [default: five about the mean of the learnt flights, or about the guide's middle]
    #[arg(long, value_name = "KG,…", value_delimiter = ',')]
    pub(crate) mass_kg: Vec<f64>,
    /// Deviations from the ISA, degrees Celsius
    #[arg(
        long,
        value_name = "C,…",
        value_delimiter = ',',
        default_value = "0",
        allow_negative_numbers = true
    )]
    pub(crate) isa_deviation: Vec<f64>,
    /// Tailwinds, kt; negative for headwinds
    #[arg(
        long,
        value_name = "KT,…",
        value_delimiter = ',',
        default_value = "0",
        allow_negative_numbers = true
    )]
    pub(crate) tailwind: Vec<f64>,
    /// Pressure altitudes to choose from, ft [default: 25000 to 43000, every 1000]; thrust,
    /// buffet and ceiling are not known to a model
    #[arg(long, value_name = "FT,…", value_delimiter = ',')]
    pub(crate) levels: Vec<f64>,
    /// File to write, .csv, .parquet or .json; may be given several times
    #[arg(long, short, value_name = "OUT")]
    pub(crate) output: Vec<PathBuf>,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

fn cost_index(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err("expected a number of kilograms per minute, 0 or more".to_owned()),
    }
}

/// `plot`
#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    /// Model file, folder that `adapt` or `diagnose` wrote, or `diagnosis.json`, `monitor.json`, `trials.json`
    #[arg(value_name = "MODEL.ron|DIR|FILE.json")]
    pub(crate) source: PathBuf,
    /// Tail of the folder or file [default: the only one of a folder, all of a file]
    #[arg(long, value_name = "TAIL")]
    pub(crate) tail: Option<String>,
    /// Charts of a model, tail or diagnosis [default: all]
    #[arg(long = "chart", value_name = "NAME", value_delimiter = ',', value_parser = chart_names())]
    pub(crate) charts: Vec<String>,
    /// Picture to write, .svg, .png or .pdf; `-` for standard output
    #[arg(long, short, value_name = "FIG.svg|png|pdf")]
    pub(crate) output: PathBuf,
    /// Format of the picture [default: by the name of the file; SVG to standard output]
    #[arg(long, value_name = "FORMAT", value_parser = picture_formats())]
    pub(crate) format: Option<String>,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

fn picture_formats() -> PossibleValuesParser {
    PossibleValuesParser::new(page::PictureFormat::ALL.map(page::PictureFormat::ending))
}

fn chart_names() -> PossibleValuesParser {
    PossibleValuesParser::new(page::TAIL_CHARTS.into_iter().chain(page::DIAGNOSIS_CHARTS))
}

/// `effects`
#[derive(Debug, Args)]
pub(crate) struct EffectsArgs {
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `explain`
#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    /// Effect, column, trim criteria or verdict [default: list them]
    #[arg(value_name = "TOPIC")]
    pub(crate) topic: Option<String>,
    /// Print all topics as the page of the book that holds them
    #[arg(long, conflicts_with = "topic")]
    pub(crate) book: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `completions`
#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// Shell
    #[arg(value_enum)]
    pub(crate) shell: clap_complete::Shell,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `man`
#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// Folder to write to; `-` prints the program's page
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `golden`
#[derive(Debug, Subcommand)]
pub(crate) enum GoldenCommand {
    /// Run what DIR/golden.ron describes and print each value out of tolerance
    Check {
        /// Folder with golden.ron and expected files
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
        /// Document.
        #[command(flatten)]
        json: JsonFlag,
    },
    /// Run what DIR/golden.ron describes and write the result as the expected files
    Bless {
        /// Folder with golden.ron
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
        /// Document.
        #[command(flatten)]
        json: JsonFlag,
    },
}
