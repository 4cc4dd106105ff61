//! Why a command ended without doing anything, worded so that a person can put it right, and the exit statuses.

use std::fmt::Display;
use std::path::Path;

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
        "reports end in .txt, .rpt or .gz; recordings of another layout need --mapping"
    ))]
    NoReports {
        /// The value given.
        inputs: String,
        /// ", 3 other files skipped", or empty.
        skipped: String,
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
    /// A file that would be lost.
    #[error("{path} exists and was not made by this command")]
    #[diagnostic(help("choose another name, or --force to replace it"))]
    WouldReplace {
        /// The file or folder.
        path: String,
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
    #[error("{count} values out of tolerance")]
    GoldenDiffers {
        /// How many.
        count: usize,
    },
}

impl Failure {
    /// An unreadable path.
    pub(crate) fn unreadable(path: &Path, reason: impl Display) -> Self {
        Self::Unreadable { path: show(path), reason: reason.to_string() }
    }

    /// An unwritable path.
    pub(crate) fn unwritable(path: &Path, reason: impl Display) -> Self {
        Self::Unwritable { path: show(path), reason: reason.to_string() }
    }

    /// A file with wrong content.
    pub(crate) fn bad_file(path: &Path, reason: impl Display) -> Self {
        Self::BadFile { path: show(path), reason: reason.to_string(), help: None }
    }
}

/// A path for a message: as given, with forward slashes unchanged.
pub(crate) fn show(path: &Path) -> String {
    path.display().to_string()
}
