//! The command line's grammar. What a command does is in `commands`.

mod common;
mod deferred;
mod diagnose;
pub(crate) mod help;
mod learning;
mod monitor;
mod recordings;
mod simulated;
mod using;

use std::path::PathBuf;

use crate::criteria::NamedCriteria;
use clap::{Args, Parser, Subcommand};

use deferred::Deferred;

pub(crate) use common::{Common, JsonFlag, JsonOutput, JsonWanted, When};
pub(crate) use diagnose::DiagnoseArgs;
pub(crate) use learning::{
    AdaptArgs, ForgetArgs, HalfLifeChoice, InitArgs, LawName, MergeArgs, TuneArgs,
};
pub(crate) use monitor::MonitorArgs;
pub(crate) use recordings::{ConvertArgs, MappingArgs};
pub(crate) use simulated::{DemoArgs, SimulateArgs, TrialArgs};
pub(crate) use using::{
    EvaluateArgs, ExportArgs, ExportFormat, OptimumArgs, PlotArgs, PredictArgs, ShowArgs,
};

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
    /// Number of engines of the aircraft: a public model of another number is refused. It knows no engine options, so that no
    /// name of an engine is taken
    #[arg(long, value_name = "NUMBER", conflicts_with = "list")]
    pub(crate) engines: Option<String>,
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
