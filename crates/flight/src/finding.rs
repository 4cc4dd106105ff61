//! Findings: noteworthy facts about data that is used nevertheless.

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// The result may suffer.
    Warning,
    /// Results from it are worthless unless it is explained.
    Serious,
}

/// Something noticed about data that is not a reason to refuse it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// Stable name of the kind of finding, for counting ("last-row-without-line-end").
    pub code: &'static str,
    /// The sentence for a person, with values and units.
    pub message: String,
    /// Line of the file, from 1, where it concerns one line.
    pub line: Option<usize>,
}
