//! `summary.json` and the table that a person reads.

use core::fmt::{Display, Write as _};

use serde::{Deserialize, Serialize};

use crate::fuel_factor::FuelFactor;
use crate::not_evaluated::{self, NotEvaluated};
use crate::statistics::ErrorStatistics;

/// Schema of [`Summary`].
pub const SCHEMA: &str = "cruisefit.summary/1";

/// What a run over reports came to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name and version of this layout.
    #[serde(skip_deserializing, default = "schema")]
    pub schema: &'static str,
    /// What became of the files.
    pub reports: ReportsSummary,
    /// Tail by tail, in order.
    pub tails: Vec<TailSummary>,
}

const fn schema() -> &'static str {
    SCHEMA
}

/// What became of the files.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReportsSummary {
    /// Reports used.
    pub read: usize,
    /// Reports of flights that the folder, or the run before, has learnt.
    pub already_known: usize,
    /// Copies of this run's own reports, which are used once; absent where there are none.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub copies: usize,
    /// Other files of the folders that were named, which were not read; absent where there are none.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub other_files: usize,
    /// Reports refused, with reasons.
    pub refused: Vec<RefusedSummary>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
const fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl ReportsSummary {
    /// "14 reports read, 0 already known, 2 copies, 1 refused, 3 other files skipped"; copies and other files where there are any.
    pub fn to_words(&self) -> String {
        let mut words =
            format!("{} read, {} already known", counted(self.read, "report"), self.already_known);
        match self.copies {
            0 => {}
            1 => words.push_str(", 1 copy"),
            n => {
                let _ = write!(words, ", {n} copies");
            }
        }
        let _ = write!(words, ", {} refused", self.refused.len());
        words + &other_files_words(self.other_files)
    }
}

/// ", 3 other files skipped", or empty.
pub fn other_files_words(other_files: usize) -> String {
    match other_files {
        0 => String::new(),
        n => format!(", {} skipped", counted(n, "other file")),
    }
}

/// A refused report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RefusedSummary {
    /// File.
    pub path: String,
    /// Line, where the refusal has one.
    pub line: Option<usize>,
    /// Column, where the refusal has one.
    pub column: Option<usize>,
    /// Found and expected.
    pub reason: String,
}

/// One tail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TailSummary {
    /// Tail.
    pub tail: String,
    /// All flights, earlier runs included.
    pub flights: usize,
    /// Flights that this run added; in `evaluate` those that did not teach the model.
    pub flights_new: usize,
    /// Samples of all flights.
    pub samples: u64,
    /// Stabilised segments of all flights.
    pub segments: usize,
    /// Segments that the grid refused.
    pub outside_table: usize,
    /// Trim criteria that were not evaluated, because what they judge was not recorded; absent where all were. `adapt`: of flights
    /// with segments.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_evaluated: Vec<NotEvaluated>,
    /// Share of nodes ever adapted; absent where nothing is adapted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub informed_nodes: Option<f64>,
    /// Global refits; absent where nothing is adapted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refits: Option<u32>,
    /// The error, in per cent.
    pub fuel_flow_error_percent: ErrorsSummary,
    /// Half width of the 95 % interval of the mean error before, %: flights count, not segments; absent for fewer than two flights
    /// with errors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_error_half_width95_percent: Option<f64>,
    /// The same of the mean error of the guide's own rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub book_half_width95_percent: Option<f64>,
    /// The fuel factor over all flights, as `evaluate --fuel-factors` has it; absent where nothing is adapted, and of older programs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fuel_factor_percent: Option<FactorSummary>,
    /// Share of errors within the stated 95 % interval of a segment; absent where the law states none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval95_coverage: Option<f64>,
    /// Half the width of the 95 % interval that the model states for the mean error of these flights, %; absent where it states
    /// none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_error_within_percent: Option<f64>,
    /// Segments beyond all that the learnt flights flew in Mach number, lift coefficient, pressure altitude, thrust, deviation from
    /// the ISA or mass; absent where nothing beyond a table was learnt.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beyond_flights: Option<usize>,
}

/// A fuel factor, in per cent of what the guide's own rows predict.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FactorSummary {
    /// Mean over flights.
    pub value: f64,
    /// Its 95 % interval; null with one flight.
    pub ci95: Option<[f64; 2]>,
}

impl From<&FuelFactor> for FactorSummary {
    fn from(factor: &FuelFactor) -> Self {
        Self { value: factor.percent_of_predicted(), ci95: factor.interval95() }
    }
}

impl TailSummary {
    /// Whether some of its flights taught the model that is evaluated.
    const fn is_of_a_fit(&self) -> bool {
        self.fuel_flow_error_percent.after.is_none() && self.flights_new < self.flights
    }

    /// Whether the mean error of its flights lies beyond what the model states of it.
    fn is_beyond_its_interval(&self) -> bool {
        let mean = self.fuel_flow_error_percent.before.mean;
        self.mean_error_within_percent.zip(mean).is_some_and(|(within, mean)| mean.abs() > within)
    }
}

/// The error of the initial table, and of the final one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorsSummary {
    /// Of the initial model, or of the model as it was given (`evaluate`).
    pub before: ErrorStatistics,
    /// Of the final table; absent where nothing is adapted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<ErrorStatistics>,
    /// Of the guide's own rows, smooth between the nodes, in place of the polynomial through them; absent where nothing is adapted,
    /// and where the model does not keep those rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub book: Option<ErrorStatistics>,
}

impl ErrorsSummary {
    /// Against what a planner has: the guide's own rows, or the initial model where they are not kept.
    #[must_use]
    pub fn against_book(&self) -> &ErrorStatistics {
        self.book.as_ref().unwrap_or(&self.before)
    }
}

impl Summary {
    /// Reads a summary back.
    ///
    /// # Errors
    /// What is not a summary's, with line and column.
    pub fn from_json(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }

    /// As JSON, with a final line end.
    pub fn to_json(&self) -> Vec<u8> {
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text.into_bytes()
    }

    /// Why no segment was used: what was refused, or else what finds segments.
    fn why_nothing(&self) -> String {
        let refused = &self.reports.refused;
        refused.first().map_or_else(
            || NO_SEGMENT.to_owned(),
            |first| {
                format!(
                    "No segment was used: {} refused, the first: {}\n",
                    counted(refused.len(), "report"),
                    first.reason
                )
            },
        )
    }

    /// As tables for a person, 80 columns wide but for long tails.
    pub fn to_text(&self) -> String {
        let mut text = aligned(&self.counts());
        text.push_str("\nError of predicted fuel flow, %\n");
        text.push_str(&aligned(&self.errors()));
        if self.tails.iter().all(|tail| tail.segments == 0) {
            text.push_str(&self.why_nothing());
        }
        text.push_str(
            "Error = 100 (recorded − predicted)/recorded fuel flow, %: positive, the aircraft burns more than the model \
             says.\n",
        );
        if self.tails.iter().any(|tail| tail.interval95_coverage.is_some()) {
            text.push_str(
                "Inside 95 %: share of the segments within the stated 95 % interval; mean within: half the 95 % interval \
                 of the mean error of such flights.\n",
            );
        }
        for tail in self.tails.iter().filter(|tail| tail.is_of_a_fit()) {
            let _ = writeln!(
                text,
                "{}: {} of {} taught this model: that it fits them is no forecast. Where all are given, the rows of `evaluate -o` are \
                 by the model before it learnt each flight (`predicted_by`).",
                tail.tail,
                tail.flights - tail.flights_new,
                counted(tail.flights, "flight")
            );
        }
        for tail in &self.tails {
            if let Some(beyond) = tail.beyond_flights.filter(|beyond| *beyond > 0) {
                let _ = writeln!(
                    text,
                    "{}: {beyond} of {} lie beyond what the learnt flights flew: predictions continue what those showed.",
                    tail.tail,
                    counted(tail.segments, "segment")
                );
            }
        }
        for tail in self.tails.iter().filter(|tail| tail.is_beyond_its_interval()) {
            let _ = writeln!(
                text,
                "{}: its mean error lies beyond that interval: it does not burn what the learnt flights burnt (diagnose, monitor).",
                tail.tail
            );
        }
        let lists = self.tails.iter().map(|tail| tail.not_evaluated.as_slice());
        let flights = self.tails.iter().map(|tail| tail.flights).sum();
        text.push_str(&not_evaluated::line(&not_evaluated::together(lists), flights));
        let _ = writeln!(text, "{}.", self.reports.to_words());
        text
    }

    /// What was there to learn from, or to compare with.
    fn counts(&self) -> Vec<Vec<String>> {
        let adapted = self.tails.iter().any(|tail| tail.informed_nodes.is_some());
        let refitted = self.tails.iter().any(|tail| tail.refits.is_some());
        let mut head = vec!["tail", "flights", "samples", "segments", "outside"];
        head.extend(adapted.then_some("nodes informed"));
        head.extend(refitted.then_some("refits"));
        let mut rows = vec![texts(&head)];
        for tail in &self.tails {
            let flights = if tail.flights_new == tail.flights {
                tail.flights.to_string()
            } else {
                format!("{} ({} new)", tail.flights, tail.flights_new)
            };
            let mut row = vec![
                tail.tail.clone(),
                flights,
                tail.samples.to_string(),
                tail.segments.to_string(),
                tail.outside_table.to_string(),
            ];
            if adapted {
                let share = tail.informed_nodes.map(|share| format!("{:.0} %", 100.0 * share));
                row.push(share.unwrap_or_default());
            }
            if refitted {
                row.push(tail.refits.map_or_else(String::new, |refits| refits.to_string()));
            }
            rows.push(row);
        }
        rows
    }

    fn errors(&self) -> Vec<Vec<String>> {
        let adapted = self.tails.iter().any(|tail| tail.fuel_flow_error_percent.after.is_some());
        let covered = self.tails.iter().any(|tail| tail.interval95_coverage.is_some());
        let bounded = self.tails.iter().any(|tail| tail.mean_error_within_percent.is_some());
        let mut head = if adapted {
            vec!["tail", "before: mean", "std", "max", "after: mean", "std", "max"]
        } else {
            vec!["tail", "mean", "std", "max"]
        };
        head.extend(covered.then_some("inside 95 %"));
        head.extend(bounded.then_some("mean within"));
        let mut rows = vec![texts(&head)];
        for tail in &self.tails {
            let errors = &tail.fuel_flow_error_percent;
            let mut row = vec![tail.tail.clone()];
            push_statistics(&mut row, Some(&errors.before));
            if adapted {
                push_statistics(&mut row, errors.after.as_ref());
            }
            if covered {
                let share = tail.interval95_coverage.map(|share| format!("{:.1} %", 100.0 * share));
                row.push(share.unwrap_or_else(|| "–".to_owned()));
            }
            if bounded {
                let within = tail.mean_error_within_percent.map(|within| format!("±{within:.2}"));
                row.push(within.unwrap_or_else(|| "–".to_owned()));
            }
            rows.push(row);
        }
        rows
    }
}

fn texts(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn push_statistics(row: &mut Vec<String>, statistics: Option<&ErrorStatistics>) {
    let signed = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:+.2}"));
    let plain = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.2}"));
    row.push(signed(statistics.and_then(|s| s.mean)));
    row.push(plain(statistics.and_then(|s| s.std)));
    row.push(plain(statistics.and_then(|s| s.max_abs)));
}

/// What to do about flights without a segment.
pub const NO_SEGMENT: &str = "No stabilised segment was found: `cruisefit segment REPORTS -o FILE --explain` tells what each \
     criterion cost, --criteria names other criteria.\n";

/// A number and its noun.
pub fn counted<N: Copy + Display + PartialEq + From<u8>>(number: N, noun: &str) -> String {
    let ending = if noun.ends_with('s') { "es" } else { "s" };
    if number == N::from(1) { format!("1 {noun}") } else { format!("{number} {noun}{ending}") }
}

/// What rounds to zero with so many decimals has no sign of its own.
pub fn not_minus_zero(value: f64, decimals: i32) -> f64 {
    if value.abs() < 0.5 * 10_f64.powi(-decimals) { 0.0 } else { value }
}

/// Columns of a terminal: no table is wider, but for a first column that is.
const WIDTH: usize = 80;

/// Columns aligned: the first to the left, numbers to the right. What does not fit a terminal's 80 columns follows below, with
/// the first column again.
pub fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter()
            .filter_map(|row| row.get(column))
            .map(|cell| cell.chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    let mut next = 1;
    loop {
        let first = next;
        let mut used = widths.first().copied().unwrap_or(0);
        while next < columns && (next == first || used + 2 + widths[next] <= WIDTH) {
            used += 2 + widths[next];
            next += 1;
        }
        for row in rows {
            push_row(row, &widths, first..next, &mut text);
        }
        if next >= columns {
            return text;
        }
        text.push('\n');
    }
}

/// The first cell and some of the others.
fn push_row(row: &[String], widths: &[usize], columns: core::ops::Range<usize>, text: &mut String) {
    let mut line = String::new();
    for column in core::iter::once(0).chain(columns) {
        let Some(cell) = row.get(column) else { continue };
        let pad = " ".repeat(widths[column].saturating_sub(cell.chars().count()));
        if column == 0 {
            line.push_str(cell);
            line.push_str(&pad);
        } else {
            line.push_str("  ");
            line.push_str(&pad);
            line.push_str(cell);
        }
    }
    text.push_str(line.trim_end());
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_no_plural() {
        assert_eq!(counted(1, "segment"), "1 segment");
        assert_eq!(counted(0_u64, "flight"), "0 flights");
        assert_eq!(counted(2_usize, "class"), "2 classes");
    }

    #[test]
    fn copies_and_other_files_are_said_where_there_are_any() {
        let none = ReportsSummary { read: 30, ..ReportsSummary::default() };
        assert_eq!(none.to_words(), "30 reports read, 0 already known, 0 refused");
        let json = serde_json::to_value(&none).unwrap();
        assert!(json.get("copies").is_none() && json.get("other_files").is_none(), "{json}");
        let all = ReportsSummary { read: 1, copies: 2, other_files: 3, ..none };
        assert_eq!(
            all.to_words(),
            "1 report read, 0 already known, 2 copies, 0 refused, 3 other files skipped"
        );
        assert_eq!(serde_json::to_value(&all).unwrap()["copies"], 2);
    }

    #[test]
    fn a_wide_table_is_continued_below() {
        let row = |first: &str, cell: &str| {
            core::iter::once(first.to_owned()).chain((0..9).map(|_| cell.to_owned())).collect()
        };
        let text = aligned(&[row("CL", "0.1"), row("0.150", "123.4±12.3*")]);
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
        assert_eq!(text.lines().filter(|line| line.starts_with("CL")).count(), 2, "{text}");
        assert_eq!(text.matches("123.4").count(), 9, "{text}");
        assert_eq!(aligned(&[vec!["a".to_owned(), "1".to_owned()]]), "a  1\n");
        assert_eq!(aligned(&[]), "");
    }
}
