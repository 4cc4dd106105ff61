//! Arguments of the commands that use a model.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use pipeline::prediction::PredictedColumn;

use super::{JsonFlag, JsonOutput, ModelArgs, ReportsArgs};

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
    #[arg(value_parser = prediction_columns())]
    pub(crate) columns: Option<Vec<PredictedColumn>>,
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
    /// Also write the fuel factor of each tail against the book (the rows of its guide), in all and by condition, .csv or
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
    #[arg(long, value_name = "N", value_parser = cost_index, allow_negative_numbers = true)]
    pub(crate) cost_index: Option<f64>,
    /// Gross masses, kg [default: five about the mean of the learnt flights, or across those of
    /// the guide]
    #[arg(long, value_name = "KG,…", value_delimiter = ',')]
    pub(crate) mass_kg: Vec<f64>,
    /// Deviations from the ISA, degrees Celsius
    #[arg(
        long,
        value_name = "C,…",
        value_delimiter = ',',
        default_value = "0",
        allow_hyphen_values = true
    )]
    pub(crate) isa_deviation: Vec<f64>,
    /// Tailwinds, kt; negative for headwinds
    #[arg(
        long,
        value_name = "KT,…",
        value_delimiter = ',',
        default_value = "0",
        allow_hyphen_values = true
    )]
    pub(crate) tailwind: Vec<f64>,
    /// Pressure altitudes to choose from, ft [default: every 1000 up to the highest of guide and
    /// flights]; thrust, buffet and ceiling are not known to a model
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

fn prediction_columns() -> impl TypedValueParser<Value = PredictedColumn> {
    PossibleValuesParser::new(PredictedColumn::ALL.map(PredictedColumn::name)).try_map(|name| {
        PredictedColumn::of_name(&name).ok_or("a name that no column of predictions has")
    })
}
