//! Why a command ended without doing anything, worded so that a person can put it right, and the exit statuses.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::Path;

use pipeline::summary::counted;

pub(crate) use pipeline::reading::RefusedReport;

/// Exit status 0: everything asked for was done.
pub(crate) const DONE: u8 = 0;
/// Exit status 1: done, but some input was refused.
pub(crate) const SOME_REFUSED: u8 = 1;
/// Exit status 2: nothing was done.
pub(crate) const NOTHING_DONE: u8 = 2;
/// Exit status 3: done, and a rule of `monitor --alert` fired.
pub(crate) const ALERTS_RAISED: u8 = 3;

/// A reason for which nothing was done.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[non_exhaustive]
pub(crate) enum Failure {
    /// A file or folder that cannot be read.
    #[error("{path}: {reason}")]
    Unreadable {
        /// The path as given.
        path: String,
        /// What the operating system, or the reader, reports.
        reason: String,
    },
    /// A file or folder that cannot be written.
    #[error("{path} cannot be written: {reason}")]
    #[diagnostic(help("nothing was changed there; choose another place or make it writable"))]
    Unwritable {
        /// The path as given.
        path: String,
        /// What the operating system reports.
        reason: String,
    },
    /// A file whose content is wrong.
    #[error("{path}: {reason}")]
    BadFile {
        /// The path as given.
        path: String,
        /// What is wrong, with position.
        reason: String,
        /// How to put it right.
        #[help]
        help: Option<String>,
    },
    /// No report among the inputs.
    #[error("no cruise report in {inputs}{skipped}")]
    #[diagnostic(help(
        "reports end in .txt, .rpt or .gz; with --mapping, recordings in .csv, .gz, .zst, .parquet, .arrow, .feather too"
    ))]
    NoReports {
        /// The value given.
        inputs: String,
        /// ", 3 other files skipped", or empty.
        skipped: String,
    },
    /// No recording among the inputs, where a mapping is in force.
    #[error("no recording in {inputs}{skipped}; the mapping {mapping} is in force")]
    #[diagnostic(help(
        "with a mapping (option --mapping, or `mapping` in the project file) recordings end in .csv, .gz, .zst, .parquet, .arrow, \
         .feather; cruise reports of a folder without recordings, in .txt, .rpt or .gz, are read as they are"
    ))]
    NoRecordings {
        /// The value given.
        inputs: String,
        /// ", 3 other files skipped", or empty.
        skipped: String,
        /// The mapping, as it is named.
        mapping: String,
    },
    /// Every report was refused.
    #[error("no report could be used, {files} refused")]
    AllRefused {
        /// How many files there were.
        files: usize,
    },
    /// A report was refused under `--strict`.
    #[error(
        "{refused} of {files} reports refused, and --strict was asked for; nothing was written"
    )]
    Strict {
        /// Refused files.
        refused: usize,
        /// All files.
        files: usize,
    },
    /// A folder that was started with something else.
    #[error("{folder} was started with another {what}: {difference}")]
    #[diagnostic(help(
        "use another folder, or --restart to start over (the old folder is kept under another name)"
    ))]
    BegunOtherwise {
        /// The folder.
        folder: String,
        /// Initial model, law or setting.
        what: &'static str,
        /// Both values.
        difference: String,
    },
    /// A folder that another process is writing.
    #[error("{folder} is being written by {holder}")]
    #[diagnostic(help("--wait waits until it is done"))]
    Busy {
        /// The folder.
        folder: String,
        /// Process, host and time, as its lock has them.
        holder: String,
    },
    /// Two tails that would share their files.
    #[error(
        "{folder}: tails {one:?} and {other:?} would have the same files, whose names differ only in case"
    )]
    #[diagnostic(help(
        "adapt one of them in another folder, or use a file system on which case counts"
    ))]
    SameFile {
        /// The folder.
        folder: String,
        /// A tail.
        one: String,
        /// The other.
        other: String,
    },
    /// A file that would be lost.
    #[error("{path} exists and was not made by this command")]
    #[diagnostic(help("choose another name, or --force to replace it"))]
    WouldReplace {
        /// The file or folder.
        path: String,
    },
    /// A file that would be lost, of a command that replaces results of its own kind alone.
    #[error("{path} is {what}, which would be lost")]
    #[diagnostic(help("choose another name"))]
    WouldLose {
        /// The file.
        path: String,
        /// What it is.
        what: String,
    },
    /// An argument that is invalid.
    #[error("{argument}: {reason}")]
    BadArgument {
        /// The argument as it is called.
        argument: &'static str,
        /// The reason.
        reason: String,
    },
    /// Scores below their floors in `trial --check`.
    #[error("{missed} scores below their floor, {failed} cases failed")]
    TrialFloors {
        /// Floors missed.
        missed: usize,
        /// Cases that failed.
        failed: usize,
    },
    /// Values out of tolerance in `golden check`.
    #[error("{} out of tolerance", counted(*count, "value"))]
    GoldenDiffers {
        /// How many.
        count: usize,
    },
}

/// A file that cannot be used and costs itself alone: what is not done without it, and why.
pub(crate) fn refused_of(failure: Failure, what: &str) -> RefusedReport {
    let (path, reason) = match failure {
        Failure::BadFile { path, reason, .. } | Failure::Unreadable { path, reason } => {
            (path, reason)
        }
        other => (String::new(), other.to_string()),
    };
    RefusedReport::whole(path.into(), format!("{what}: {reason}"))
}

impl Failure {
    /// An unreadable path; of one that does not exist, with the name beside it that was probably meant.
    pub(crate) fn unreadable(path: &Path, reason: impl Display) -> Self {
        let mut reason = plain(&reason.to_string());
        if let (false, Some(name)) = (path.exists(), name_beside(path)) {
            reason = format!("{reason}; did you mean {name}?");
        }
        Self::Unreadable { path: show(path), reason }
    }

    /// An unwritable path.
    pub(crate) fn unwritable(path: &Path, reason: impl Display) -> Self {
        Self::Unwritable { path: show(path), reason: plain(&reason.to_string()) }
    }

    /// A file with wrong content.
    pub(crate) fn bad_file(path: &Path, reason: impl Display) -> Self {
        Self::BadFile { path: show(path), reason: reason.to_string(), help: None }
    }
}

/// What the operating system reports without its number: "No such file or directory", not "(os error 2)".
fn plain(reason: &str) -> String {
    let end = reason.rfind(" (os error ").filter(|_| reason.ends_with(')'));
    reason[..end.unwrap_or(reason.len())].to_owned()
}

/// The nearest name in the deepest folder of a path that exists.
fn name_beside(path: &Path) -> Option<String> {
    let part = path.ancestors().find(|part| {
        !part.exists()
            && part.parent().is_some_and(|above| above.as_os_str().is_empty() || above.is_dir())
    })?;
    let above = part.parent()?;
    let searched = if above.as_os_str().is_empty() { Path::new(".") } else { above };
    let mut names: Vec<String> = std::fs::read_dir(searched)
        .ok()?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    // The system lists names in any order: of two equally near the first by name.
    names.sort();
    let wanted = Path::new(part.file_name()?);
    // A shared ending is no likeness: names with the same one are compared without it.
    let (alike, others): (Vec<&String>, Vec<&String>) =
        names.iter().partition(|name| Path::new(name).extension() == wanted.extension());
    let stem = |name: &Path| Some(name.file_stem()?.to_str()?.to_owned());
    let stems: BTreeMap<String, &str> = alike
        .into_iter()
        .filter_map(|name| Some((stem(Path::new(name))?, name.as_str())))
        .collect();
    let near = report::nearest(&stem(wanted)?, stems.keys().map(String::as_str));
    let name = match near {
        Some(near) => stems[near],
        None => report::nearest(wanted.to_str()?, others.into_iter().map(String::as_str))?,
    };
    Some(show(&above.join(name)))
}

/// A path for a message: as given, with forward slashes unchanged.
pub(crate) fn show(path: &Path) -> String {
    path.display().to_string()
}
