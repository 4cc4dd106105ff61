//! Recordings of other layouts.

use std::path::PathBuf;

use clap::Args;

use super::JsonFlag;

/// `mapping`
#[derive(Debug, Args)]
pub(crate) struct MappingArgs {
    /// Recording: delimited text, plain, gzip or Zstandard, Parquet, or Arrow
    #[arg(value_name = "RECORDING", required_unless_present = "presets")]
    pub(crate) recording: Option<PathBuf>,
    /// List the mappings that are built in, with what they are for; of one, its text, to be copied and changed
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "", conflicts_with = "recording")]
    pub(crate) presets: Option<String>,
    /// Mapping file to write [default: standard output]
    #[arg(long, short, value_name = "MAPPING.ron")]
    pub(crate) output: Option<PathBuf>,
    /// Replace a file that holds something else
    #[arg(long)]
    pub(crate) force: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}

/// `convert`
#[derive(Debug, Args)]
pub(crate) struct ConvertArgs {
    /// Recordings: files, folders (searched recursively for .csv, .gz, .zst, .parquet, .arrow, …) and globs
    #[arg(required = true, value_name = "RECORDINGS")]
    pub(crate) recordings: Vec<PathBuf>,
    /// Mapping file (RON), or the name of a preset
    #[arg(long, value_name = "MAPPING")]
    pub(crate) mapping: String,
    /// Folder to write to, one report a flight, values as they were read
    #[arg(long, short, value_name = "DIR", required_unless_present = "dry_run")]
    pub(crate) output: Option<PathBuf>,
    /// Write nothing; show what each column became in the first ten samples of each flight
    #[arg(long, conflicts_with = "output")]
    pub(crate) dry_run: bool,
    /// Replace reports that hold something else
    #[arg(long)]
    pub(crate) force: bool,
    /// Stop before anything is written if a recording is refused
    #[arg(long)]
    pub(crate) strict: bool,
    /// Document.
    #[command(flatten)]
    pub(crate) json: JsonFlag,
}
