//! A recording read flight by flight: what is held at a time is a few pieces of text and the flights that they belong to.

use std::io::BufRead;
use std::sync::Arc;

use flight::column::Column;
use flight::{Finding, Severity};

use super::Mapping;
use super::converter::Converter;
use super::file::BadRows;
use super::pieces::{Content, Piece, Pieces};
use super::table::{Assembly, Layout, Recording, Rows};
use crate::Parsed;
use crate::refusal::{Found, Refusal, RefusalKind};

/// A recording that is being read: pieces are taken one after the other, read into rows (in any order, also at the same
/// time), and added in their order, which gives the flights that have ended.
#[derive(Debug)]
pub struct Stream {
    layout: Arc<Layout>,
    /// What follows the line of names in the first piece.
    first: Option<Piece>,
    assembly: Assembly,
    tally: Tally,
}

/// The rows of a flight.
#[derive(Debug)]
pub struct MappedFlight(pub(super) Recording);

/// Rows of a flight that are means over stable frames.
#[derive(Debug)]
pub struct MappedPoints {
    /// The points as rows of a report, one or more ([`flight::Report::of_points`]).
    pub parsed: Parsed,
    /// Length of a frame as the mapping states it, s.
    pub averaged_over_s: f64,
    /// Standard deviations within each point's frame, in the stored unit of their quantity; NaN where there is none.
    pub scatter: Vec<(Column, Vec<f64>)>,
}

/// What the rows of a flight came to.
#[derive(Debug)]
pub enum MappedReport {
    /// A report.
    Report(Box<Parsed>),
    /// Averaged points.
    Points(Box<MappedPoints>),
    /// No level part is long enough.
    WithoutCruise {
        /// Its name.
        flight: String,
        /// Its rows.
        rows: usize,
        /// Duration of its longest level part, s.
        longest_s: f64,
        /// Where most of its rows lack a number, the first of them.
        lacking: Option<Box<Refusal>>,
    },
    /// The flight cannot be used.
    Refused {
        /// Its name.
        flight: String,
        /// Why.
        refusal: Box<Refusal>,
    },
}

/// What is said of a recording as a whole.
#[derive(Debug, Default)]
struct Tally {
    reports: usize,
    without_cruise: Vec<String>,
    refused: Vec<String>,
    first_refusal: Option<Refusal>,
    longest_s: f64,
    lacking: Option<Refusal>,
}

impl Stream {
    /// Begins to read a recording; `file_name` is used for texts that the mapping takes from it.
    ///
    /// # Errors
    /// [`Refusal`] for a text without the columns that the mapping needs.
    pub fn begin<R: BufRead>(
        mapping: &Mapping,
        pieces: &mut Pieces<R>,
        file_name: Option<&str>,
    ) -> Result<Self, Refusal> {
        let first = pieces.next_piece()?.unwrap_or(Piece::default());
        let text = match &first.content {
            Content::Text(text) => text.as_str(),
            Content::Rows(_) | Content::Lines { .. } => "",
        };
        let (layout, below) = Layout::of_text(&mapping.file, text, file_name)?;
        let assembly = Assembly::new(&first);
        let text = Arc::new(text[below.byte..].to_owned());
        let content = Content::Text(text);
        let first = Some(Piece { content, first_line: below.line, ..Piece::default() });
        Ok(Self { layout: Arc::new(layout), first, assembly, tally: Tally::default() })
    }

    /// Begins to read a table whose columns have these names; its rows come as [`Batch`](super::Batch)es, made into
    /// pieces. Separators and units rows of the mapping do not apply.
    ///
    /// # Errors
    /// [`Refusal`] for a table without the columns that the mapping needs.
    pub fn begin_table(
        mapping: &Mapping,
        names: &[String],
        file_name: Option<&str>,
    ) -> Result<Self, Refusal> {
        let layout = Layout::of_table(&mapping.comma_separated().file, names, file_name)?;
        let assembly = Assembly::new(&Piece::default());
        Ok(Self { layout: Arc::new(layout), first: None, assembly, tally: Tally::default() })
    }

    /// The places of the columns that are read, in increasing order.
    #[must_use]
    pub fn needed(&self) -> Vec<usize> {
        self.layout.needed()
    }

    /// The next piece of rows; `None` after the last.
    ///
    /// # Errors
    /// As [`Pieces::next_piece`].
    pub fn next_piece<R: BufRead>(
        &mut self,
        pieces: &mut Pieces<R>,
    ) -> Result<Option<Piece>, Refusal> {
        match self.first.take() {
            Some(piece) => Ok(Some(piece)),
            None => pieces.next_piece(),
        }
    }

    /// What reads its pieces and makes the reports of its flights.
    #[must_use]
    pub fn converter(&self) -> Converter {
        Converter { layout: Arc::clone(&self.layout) }
    }

    /// Adds the rows of the next piece; gives the flights that have ended and, where the mapping refuses bad rows, the
    /// first bad one.
    pub fn add(&mut self, rows: Rows) -> (Vec<MappedFlight>, Result<(), Refusal>) {
        let added = self.assembly.add(&self.layout, rows);
        (self.ended(), added)
    }

    /// The flights that are over where reading stops before the recording's end.
    pub fn stop(&mut self) -> Vec<MappedFlight> {
        self.assembly.stop(&self.layout);
        self.ended()
    }

    /// The flights that end with the recording.
    pub fn finish(&mut self) -> Vec<MappedFlight> {
        self.assembly.finish(&self.layout);
        self.ended()
    }

    fn ended(&mut self) -> Vec<MappedFlight> {
        self.assembly.take_ended().into_iter().map(MappedFlight).collect()
    }

    /// Of a flight that gave no report: its name, and why, as the recording would be refused for it had it no other flight.
    #[must_use]
    pub fn dropped(&self, report: &MappedReport) -> Option<(String, Refusal)> {
        match report {
            MappedReport::Report(_) | MappedReport::Points(_) => None,
            MappedReport::WithoutCruise { flight, rows, longest_s, lacking } => {
                let refusal = lacking.as_deref().cloned();
                let without = || self.refuse_without_level_part(*rows, *longest_s);
                Some((flight.clone(), refusal.unwrap_or_else(without)))
            }
            MappedReport::Refused { flight, refusal } => {
                Some((flight.clone(), refusal.as_ref().clone()))
            }
        }
    }

    /// Counts a flight that gave a report.
    pub const fn count_report(&mut self) {
        self.tally.reports += 1;
    }

    /// Counts what a flight came to, in the order of the recording.
    ///
    /// # Errors
    /// A flight that cannot be used, where that refuses the recording.
    pub fn count(&mut self, report: MappedReport) -> Result<Option<Parsed>, Refusal> {
        match report {
            MappedReport::Report(parsed) => {
                self.count_report();
                return Ok(Some(*parsed));
            }
            MappedReport::Points(points) => {
                let line = self.layout.names_line();
                let found = Found::Rows(points.parsed.report.len());
                let kind = RefusalKind::PointsForSamples;
                return Err(Refusal { line, column: 1, found, kind });
            }
            MappedReport::WithoutCruise { flight, longest_s, lacking, .. } => {
                self.tally.longest_s = self.tally.longest_s.max(longest_s);
                self.tally.lacking = self.tally.lacking.take().or(lacking.map(|lacking| *lacking));
                self.tally.without_cruise.push(flight);
            }
            // One flight that cannot be used costs itself.
            MappedReport::Refused { flight, refusal }
                if self.layout.plan.bad_rows == BadRows::LeaveRowOut =>
            {
                self.tally.refused.push(format!("{flight}: {refusal}"));
                self.tally.first_refusal.get_or_insert(*refusal);
            }
            MappedReport::Refused { refusal, .. } => return Err(*refusal),
        }
        Ok(None)
    }

    /// What is to be said of the recording at its end.
    ///
    /// # Errors
    /// [`Refusal`] for a recording that gave no report.
    pub fn end(self) -> Result<Vec<Finding>, Refusal> {
        if self.tally.reports == 0 {
            let Tally { first_refusal, lacking, longest_s, .. } = &self.tally;
            let known = self.assembly.most_are_bad().or_else(|| first_refusal.clone());
            let without = || self.refuse_without_level_part(self.assembly.longest, *longest_s);
            return Err(known.or_else(|| lacking.clone()).unwrap_or_else(without));
        }
        let finding =
            |code, message| Finding { severity: Severity::Warning, code, message, line: None };
        let refused = self.tally.refused.iter();
        let mut findings: Vec<Finding> = refused
            .map(|refused| finding("mapped-flight-refused", format!("flight {refused}")))
            .collect();
        if !self.tally.without_cruise.is_empty() {
            let flights = self.tally.without_cruise.join(", ");
            let message =
                format!("no level part long enough in flights of the same file: {flights}");
            findings.push(finding("mapped-flight-without-cruise", message));
        }
        Ok(findings)
    }

    fn refuse_without_level_part(&self, rows: usize, longest_s: f64) -> Refusal {
        match &self.layout.plan.cruise {
            None => self.assembly.refuse_end(Found::Rows(rows), RefusalKind::TooFewRows),
            Some(criteria) => self.assembly.refuse_end(
                Found::Number { value: longest_s, unit: "s of level flight" },
                RefusalKind::NoLevelPart {
                    needed_s: criteria.minimum_duration_s + 2.0 * criteria.trim_s,
                },
            ),
        }
    }
}

#[cfg(test)]
mod tests;
