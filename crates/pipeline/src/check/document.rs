//! What `cruisefit check` hands out: JSON and a table.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use flight::Severity;
use serde::Serialize;

use super::{DataFinding, air, book, word};
use crate::summary::{ReportsSummary, counted, other_files_words};

/// Schema of [`CheckDocument`].
pub const SCHEMA: &str = "cruisefit.check/1";

/// Findings about a batch of reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckDocument {
    /// Name and version of this layout.
    pub schema: &'static str,
    /// What became of the files.
    pub reports: ReportsSummary,
    /// How many findings of each severity.
    pub counts: Counts,
    /// The findings, the serious ones first, then by tail, those that need no model before those against a book.
    pub findings: Vec<DataFinding>,
}

/// Findings by severity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Results are worthless unless explained.
    pub serious: usize,
    /// Results may suffer.
    pub warning: usize,
    /// Worth knowing.
    pub note: usize,
}

impl CheckDocument {
    /// Puts findings in order.
    #[must_use]
    pub fn new(reports: ReportsSummary, mut findings: Vec<DataFinding>) -> Self {
        book::decide_by_fuel_used(&mut findings);
        tell_consequences(&mut findings);
        let key = |one: &DataFinding| {
            let of_book = book::is_of_book(one);
            (one.tail.clone(), of_book, one.code, one.start.clone(), one.flight.clone())
        };
        findings.sort_by(|one, other| {
            other.severity.cmp(&one.severity).then(key(one).cmp(&key(other)))
        });
        let mut counts = Counts::default();
        for finding in &findings {
            match finding.severity {
                Severity::Serious => counts.serious += 1,
                Severity::Warning => counts.warning += 1,
                Severity::Note => counts.note += 1,
            }
        }
        Self { schema: SCHEMA, reports, counts, findings }
    }

    /// As JSON, with a final line end.
    #[must_use]
    pub fn to_json(&self) -> Vec<u8> {
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text.into_bytes()
    }

    /// For a person: one entry for each kind of finding of a tail.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = to_text(&self.findings);
        let _ = writeln!(
            text,
            "{} read, {} refused{}: {} serious, {}, {}.",
            counted(self.reports.read, "report"),
            self.reports.refused.len(),
            other_files_words(self.reports.other_files),
            self.counts.serious,
            counted(self.counts.warning, "warning"),
            counted(self.counts.note, "note"),
        );
        text
    }
}

/// A true airspeed that is wrong makes the lift coefficient wrong, and with it all that is held against a book: that is no sign of
/// another unit of the mass.
fn tell_consequences(findings: &mut [DataFinding]) {
    let is_wrong =
        |one: &&DataFinding| one.code == air::TRUE_AIRSPEED && one.severity == Severity::Serious;
    let tails: BTreeSet<String> =
        findings.iter().filter(is_wrong).map(|one| one.tail.clone()).collect();
    for finding in findings {
        let is_of_book = [book::DEVIATION, book::OUTSIDE].contains(&finding.code);
        if is_of_book && tails.contains(&finding.tail) {
            "a consequence of the true airspeed, which is wrong"
                .clone_into(&mut finding.likely_cause);
            "mend VTAS (true-airspeed-against-mach), then check again"
                .clone_into(&mut finding.remedy);
        }
    }
}

/// Findings for a person: those of one kind, tail and cause together, the size of the first as an example.
#[must_use]
pub fn to_text(findings: &[DataFinding]) -> String {
    let mut groups: BTreeMap<_, Vec<&DataFinding>> = BTreeMap::new();
    for finding in findings {
        let order = std::cmp::Reverse(finding.severity);
        let of_book = book::is_of_book(finding);
        let key = (order, &finding.tail, of_book, finding.code, &finding.likely_cause);
        groups.entry(key).or_default().push(finding);
    }
    let mut text = String::new();
    for ((severity, tail, _, code, cause), group) in groups {
        let flights: BTreeSet<_> =
            group.iter().map(|finding| (&finding.start, &finding.flight)).collect();
        let first = group[0];
        let place = if first.flight.is_empty() {
            String::new()
        } else if flights.len() == 1 {
            format!("  flight {} of {}", first.flight, first.start)
        } else {
            format!("  {}", counted(flights.len(), "flight"))
        };
        let example =
            if flights.len() > 1 { format!("flight {}: ", first.flight) } else { String::new() };
        let _ = writeln!(text, "{}  {tail}  {code}{place}", word(severity.0).to_uppercase());
        let _ = writeln!(text, "    {example}{}", first.message);
        let _ = writeln!(text, "    likely: {cause}");
        let _ = writeln!(text, "    mend:   {}", first.remedy);
    }
    text
}
