//! Findings: what is worth knowing about data that is nevertheless used.

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// The result may suffer.
    Warning,
}

/// Something noticed about data that does not refuse it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// Stable name of the kind of finding, for counting ("last-row-without-line-end").
    pub code: &'static str,
    /// The sentence for a person, with values and units.
    pub message: String,
    /// Line of the file, from 1, where one line is meant.
    pub line: Option<usize>,
}
