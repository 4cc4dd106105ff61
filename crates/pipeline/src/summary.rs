//! `summary.json` and the table that a person reads.

use std::fmt::Write;

use serde::{Deserialize, Serialize};

use crate::statistics::ErrorStatistics;

/// Schema of [`Summary`].
pub const SCHEMA: &str = "cruisefit.summary/1";

/// What a run over reports came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Name and version of this layout.
    pub schema: &'static str,
    /// What became of the files.
    pub reports: ReportsSummary,
    /// Tail by tail, in order.
    pub tails: Vec<TailSummary>,
}

/// What became of the files.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReportsSummary {
    /// Reports used.
    pub read: usize,
    /// Reports of flights that were learnt before.
    pub already_known: usize,
    /// Reports refused, with reasons.
    pub refused: Vec<RefusedSummary>,
}

/// A refused report.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
    /// Flights that this run added.
    pub flights_new: usize,
    /// Samples of all flights.
    pub samples: u64,
    /// Stabilised segments of all flights.
    pub segments: usize,
    /// Segments that the grid refused.
    pub outside_table: usize,
    /// Share of nodes ever adapted; absent where nothing is adapted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub informed_nodes: Option<f64>,
    /// Global refits; absent where nothing is adapted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refits: Option<u32>,
    /// The error, in per cent.
    pub fuel_flow_error_percent: ErrorsSummary,
    /// Share of errors within the stated 95 % interval of a segment; absent where the law states none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval95_coverage: Option<f64>,
    /// Half the width of the 95 % interval that the model states for the mean error of these flights, %; absent where it states
    /// none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_error_within_percent: Option<f64>,
}

/// The error of the initial table, and of the final one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorsSummary {
    /// Of the initial model, or of the model as it was given (`evaluate`).
    pub before: ErrorStatistics,
    /// Of the final table; absent where nothing is adapted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<ErrorStatistics>,
}

impl Summary {
    /// As JSON, with a final line end.
    pub fn to_json(&self) -> Vec<u8> {
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text.into_bytes()
    }

    /// As a table for a person.
    pub fn to_text(&self) -> String {
        let adapted = self.tails.iter().any(|tail| tail.fuel_flow_error_percent.after.is_some());
        let mut rows: Vec<Vec<String>> = Vec::new();
        let mut head = vec!["tail", "flights", "samples", "segments", "outside"];
        if adapted {
            head.extend(["nodes", "refits"]);
        }
        if adapted {
            head.extend(["before: mean", "std", "max", "after: mean", "std", "max"]);
        } else {
            head.extend(["error: mean", "std", "max"]);
        }
        rows.push(head.into_iter().map(str::to_owned).collect());
        for tail in &self.tails {
            rows.push(row_of(tail, adapted));
        }
        let mut text = String::new();
        text.push_str("Error of predicted fuel flow, %\n");
        text.push_str(&aligned(&rows));
        for tail in &self.tails {
            if let Some(coverage) = tail.interval95_coverage {
                let _ = writeln!(
                    text,
                    "{}: {:.1} % of the segments lie within the stated 95 % interval.",
                    tail.tail,
                    100.0 * coverage
                );
            }
            if let Some(within) = tail.mean_error_within_percent {
                let _ = writeln!(
                    text,
                    "{}: the 95 % interval of the mean error of such flights is ±{within:.2} %.",
                    tail.tail
                );
            }
        }
        if self.tails.iter().all(|tail| tail.segments == 0) {
            text.push_str(NO_SEGMENT);
        }
        let _ = write!(
            text,
            "Error = 100 (recorded − predicted)/recorded fuel flow, %: positive, the aircraft burns more than the model \
             says.\n\
             {} read, {} already known, {} refused.\n",
            counted(self.reports.read, "report"),
            self.reports.already_known,
            self.reports.refused.len()
        );
        text
    }
}

fn row_of(tail: &TailSummary, adapted: bool) -> Vec<String> {
    let mut row = vec![
        tail.tail.clone(),
        if tail.flights_new == tail.flights {
            tail.flights.to_string()
        } else {
            format!("{} ({} new)", tail.flights, tail.flights_new)
        },
        tail.samples.to_string(),
        tail.segments.to_string(),
        tail.outside_table.to_string(),
    ];
    if adapted {
        row.push(
            tail.informed_nodes.map_or_else(String::new, |share| format!("{:.0} %", 100.0 * share)),
        );
        row.push(tail.refits.map_or_else(String::new, |refits| refits.to_string()));
    }
    let errors = &tail.fuel_flow_error_percent;
    push_statistics(&mut row, Some(&errors.before));
    if adapted {
        push_statistics(&mut row, errors.after.as_ref());
    }
    row
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
pub fn counted(number: usize, noun: &str) -> String {
    if number == 1 { format!("1 {noun}") } else { format!("{number} {noun}s") }
}

/// Columns aligned: the first to the left, numbers to the right.
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
    for row in rows {
        let mut line = String::new();
        for (column, cell) in row.iter().enumerate() {
            if column > 0 {
                line.push_str("  ");
            }
            let pad = " ".repeat(widths[column].saturating_sub(cell.chars().count()));
            if column == 0 {
                line.push_str(cell);
                line.push_str(&pad);
            } else {
                line.push_str(&pad);
                line.push_str(cell);
            }
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}
