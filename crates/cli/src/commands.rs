//! The commands: each turns its arguments into an [`Outcome`], or reports why nothing was done.

pub(crate) mod adapt;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod convert;
pub(crate) mod demo;
pub(crate) mod diagnose;
pub(crate) mod effects;
pub(crate) mod evaluate;
pub(crate) mod explain;
pub(crate) mod export;
pub(crate) mod forget;
pub(crate) mod golden;
pub(crate) mod guide;
pub(crate) mod init;
pub(crate) mod man;
pub(crate) mod mapping;
pub(crate) mod merge;
pub(crate) mod monitor;
pub(crate) mod optimum;
pub(crate) mod plot;
pub(crate) mod predict;
pub(crate) mod segment;
pub(crate) mod show;
pub(crate) mod simulate;
pub(crate) mod trial;
pub(crate) mod tune;

use std::path::Path;

use pipeline::distinct::distinct;
use pipeline::monitoring::{Event, read_events};
use pipeline::reading::Checks;
use report::mapping::Mapping;

use crate::args::ReportsArgs;
use crate::failure::{Failure, RefusedReport};
use crate::files::read_text;
use crate::inputs;
use crate::progress::Progress;
use crate::reading::{Reading, Source};
use crate::terminal;

/// The result of a command that did something.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    /// For standard output.
    pub(crate) text: String,
    /// What was refused while the rest continued.
    pub(crate) refused: Vec<RefusedReport>,
    /// The result as a document, where the command has one.
    pub(crate) json: Option<Vec<u8>>,
    /// The figures of the text by name and unit, for the document of a command that has no other.
    pub(crate) figures: serde_json::Value,
    /// What the exit status tells beside refusals.
    pub(crate) ending: Ending,
}

/// How a command ended that did what it was asked to.
#[derive(Debug, Default)]
pub(crate) enum Ending {
    /// Nothing more to tell.
    #[default]
    Done,
    /// A rule of `monitor --alert` fired.
    Alerts,
    /// What was checked did not pass.
    NotPassed(Failure),
}

impl Outcome {
    /// Done, with this text for standard output.
    pub(crate) fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// Done, with this text, and its figures by name and unit.
    pub(crate) fn with_figures(text: impl Into<String>, figures: serde_json::Value) -> Self {
        Self { figures, ..Self::text(text) }
    }

    /// Done, with this text, and this document for `--json`.
    pub(crate) fn with_json(text: impl Into<String>, json: impl Into<Vec<u8>>) -> Self {
        Self { json: Some(json.into()), ..Self::text(text) }
    }
}

/// Prints serious findings on standard error.
fn tell_serious(findings: &str) {
    if !findings.is_empty() {
        terminal::tell(findings);
        terminal::tell("`cruisefit check` with the same arguments tells all that was found.\n");
    }
}

/// How a command reads its reports.
fn source_of(arguments: &ReportsArgs, checks: Checks) -> Result<Source, Failure> {
    let mapping = arguments.mapping.as_deref().map(read_mapping).transpose()?;
    Ok(Source { mapping, criteria: arguments.criteria.limits, checks })
}

/// Collects, reads and segments the reports of a command that tells nothing of what is wrong with them; each flight once.
fn prepare(arguments: &ReportsArgs, progress: Progress) -> Result<Reading, Failure> {
    read_reports(arguments, Checks::LeftOut, progress).map(distinct)
}

/// Collects, reads and segments the reports of a command, whatever they are to each other.
fn read_reports(
    arguments: &ReportsArgs,
    checks: Checks,
    progress: Progress,
) -> Result<Reading, Failure> {
    let source = source_of(arguments, checks)?;
    let inputs = inputs::collect(&arguments.reports, arguments.mapping.as_deref())?;
    let bar = progress.bar(inputs.files.len(), "reading reports");
    let mut reading = source.read_all(&inputs.files, &bar);
    bar.finish();
    reading.refused.extend(inputs.refused);
    reading.other_files = inputs.skipped;
    Ok(reading)
}

fn read_mapping(name: &str) -> Result<Mapping, Failure> {
    if let Some(preset) = Mapping::preset(name) {
        return Ok(preset);
    }
    let path = std::path::Path::new(name);
    if !path.exists() {
        return Err(no_such_mapping("--mapping", name));
    }
    let text = read_text(path)?;
    Mapping::from_ron(&text).map_err(|error| Failure::bad_file(path, error))
}

fn no_such_mapping(argument: &'static str, name: &str) -> Failure {
    let presets: Vec<&str> = report::mapping::PRESETS.iter().map(|(preset, _)| *preset).collect();
    let presets = presets.join(", ");
    let reason = format!("{name}: no such file, and no preset (presets: {presets})");
    Failure::BadArgument { argument, reason }
}

/// Ends a command before anything is written: where a report was refused under `--strict`, or where none is left.
fn check_refused(
    refused: &[RefusedReport],
    files: usize,
    strict: bool,
    nothing_left: bool,
) -> Result<(), Failure> {
    let ends = nothing_left || (strict && !refused.is_empty());
    if !ends {
        return Ok(());
    }
    terminal::tell_refused(refused);
    Err(if nothing_left {
        Failure::AllRefused { files }
    } else {
        Failure::Strict { refused: refused.len(), files }
    })
}

/// What was done to which tail, from a file.
fn events_of(path: &Path) -> Result<Vec<Event>, Failure> {
    let bytes = std::fs::read(path).map_err(|error| Failure::unreadable(path, error))?;
    read_events(&bytes).map_err(|error| Failure::bad_file(path, error))
}
