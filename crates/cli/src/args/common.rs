//! Options that several commands share.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::{Command, GoldenCommand};

/// Options of every command.
#[derive(Clone, Debug, Args)]
pub(crate) struct Common {
    /// Worker threads; results are the same bytes for any number [default: one per processor]
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Show no progress on the terminal
    #[arg(long, global = true)]
    pub(crate) no_progress: bool,
    /// Print errors, refusals and results that were asked for; no progress, warnings or account of what was written
    #[arg(long, short, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// When to use colours; `NO_COLOR` in the environment turns them off as well
    #[arg(long, global = true, value_name = "WHEN", value_enum, default_value_t = When::Auto)]
    pub(crate) color: When,
    /// Project file with options of every command [default: cruisefit.toml of the working folder, if there is one]; what the
    /// command line gives wins
    #[arg(long, global = true, value_name = "FILE.toml")]
    pub(crate) project: Option<PathBuf>,
    /// Log more to stderr (-v: what was done, -vv: why); `RUST_LOG` overrides
    #[arg(long, short, global = true, action = clap::ArgAction::Count)]
    pub(crate) verbose: u8,
}

/// When something is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum When {
    /// On a terminal
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// A document in place of the text.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct JsonFlag {
    /// Print JSON in place of text
    #[arg(long)]
    pub(crate) json: bool,
}

/// A document in a file or in place of the text.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct JsonOutput {
    /// Also write the result as JSON; without a name, or to `-`: print it in place of the text
    #[arg(long, value_name = "OUT.json", num_args = 0..=1, default_missing_value = "-")]
    pub(crate) json: Option<PathBuf>,
}

/// Where the JSON document of a run is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum JsonWanted<'a> {
    /// Nowhere.
    No,
    /// On standard output, in place of the text.
    Printed,
    /// In a file; the text is printed as well.
    File(&'a Path),
}

impl From<JsonFlag> for JsonWanted<'_> {
    fn from(flag: JsonFlag) -> Self {
        if flag.json { Self::Printed } else { Self::No }
    }
}

impl<'a> From<&'a JsonOutput> for JsonWanted<'a> {
    fn from(output: &'a JsonOutput) -> Self {
        match output.json.as_deref() {
            None => Self::No,
            Some(path) if path.as_os_str() == "-" => Self::Printed,
            Some(path) => Self::File(path),
        }
    }
}

impl Command {
    /// Whether the text of a command is its result, which `--quiet` leaves, and not an account of what it wrote.
    pub(crate) fn prints_results(&self) -> bool {
        if self.json_wanted() == JsonWanted::Printed {
            return true;
        }
        match self {
            Self::Check(_)
            | Self::Show(_)
            | Self::Effects(_)
            | Self::Explain(_)
            | Self::Completions(_)
            | Self::Golden(_) => true,
            Self::Evaluate(arguments) => {
                arguments.json.json.is_none() && arguments.output.is_none()
            }
            Self::Monitor(arguments) => arguments.output.is_none(),
            Self::Optimum(arguments) => arguments.output.is_empty(),
            Self::Mapping(arguments) => arguments.output.is_none(),
            Self::Export(arguments) => arguments.output.is_none(),
            Self::Predict(arguments) => arguments.output.is_none(),
            Self::Guide(arguments) => arguments.list,
            Self::Convert(arguments) => arguments.dry_run,
            _ => false,
        }
    }

    /// Where the JSON document of the run is wanted.
    pub(crate) fn json_wanted(&self) -> JsonWanted<'_> {
        match self {
            Self::Check(arguments) => (&arguments.json).into(),
            Self::Evaluate(arguments) => (&arguments.json).into(),
            Self::Init(arguments) => arguments.json.into(),
            Self::Guide(arguments) => arguments.json.into(),
            Self::Adapt(arguments) => arguments.json.into(),
            Self::Mapping(arguments) => arguments.json.into(),
            Self::Convert(arguments) => arguments.json.into(),
            Self::Forget(arguments) => arguments.json.into(),
            Self::Segment(arguments) => arguments.json.into(),
            Self::Tune(arguments) => arguments.json.into(),
            Self::Merge(arguments) => arguments.json.into(),
            Self::Predict(arguments) => arguments.json.into(),
            Self::Diagnose(arguments) => arguments.json.into(),
            Self::Monitor(arguments) => arguments.json.into(),
            Self::Show(arguments) => arguments.json.into(),
            Self::Optimum(arguments) => arguments.json.into(),
            Self::Effects(arguments) => arguments.json.into(),
            Self::Explain(arguments) => arguments.json.into(),
            Self::Simulate(arguments) => arguments.json.into(),
            Self::Trial(arguments) => arguments.json.into(),
            Self::Plot(arguments) => arguments.json.into(),
            Self::Demo(arguments) => arguments.json.into(),
            Self::Export(arguments) => arguments.json.into(),
            Self::Completions(arguments) => arguments.json.into(),
            Self::Man(arguments) => arguments.json.into(),
            Self::Golden(GoldenCommand::Check { json, .. } | GoldenCommand::Bless { json, .. }) => {
                (*json).into()
            }
        }
    }
}
