//! Rows of a table whose cells are numbers and instants rather than text: Parquet, for example.
//!
//! Columns go into rows as they are where each is of the kind that the mapping asks for. Everything else (numbers as text,
//! dates in a column of their own, a value that has to be refused) is written as text first, batch by batch, and read by
//! the code that reads text, so that both mean the same.

use std::sync::Arc;

use flight::Timestamp;
use jiff::tz::TimeZone;

use super::columns::seconds_east;
use super::line_numbers::LineNumbers;
use super::rows::{Event, FARTHEST_S, Rows, Times};
use super::{Layout, Text};
use crate::mapping::numbers::Block;
use crate::mapping::pieces::{Content, Piece};
use crate::mapping::plan::TimeForm;

/// Rows that follow each other, column by column.
#[derive(Debug, Default)]
pub struct Batch {
    /// Rows of the table before it.
    pub first_row: usize,
    /// Rows in it.
    pub rows: usize,
    /// Columns by their place in the table, those that are needed.
    pub columns: Vec<(usize, BatchColumn)>,
}

/// The cells of a column.
#[derive(Debug)]
pub enum BatchColumn {
    /// Numbers, NaN where there is none.
    Numbers(Vec<f64>),
    /// Numbers of which it is known that each is there and finite.
    Finite(Vec<f64>),
    /// Nanoseconds since 1970 in UTC, [`NO_INSTANT`] where there is none.
    Instants(Vec<i64>),
    /// Nanoseconds since 1970 on a clock of which only the mapping says how far it is from UTC, [`NO_INSTANT`] where there is no
    /// time.
    LocalTimes(Vec<i64>),
    /// Texts, each with the number of rows that it holds for; empty where there is none.
    Texts(Vec<(String, usize)>),
}

/// Stands where there is no instant: the first of all, in the year 1677, which pandas and numpy take for the same.
pub const NO_INSTANT: i64 = i64::MIN;

const SECOND_NS: i64 = 1_000_000_000;

/// The line on which a table's first row would be in a text: below the names.
const FIRST_LINE: usize = 2;

impl Batch {
    /// The line of its first row, were the table a text.
    pub(in crate::mapping) const fn first_line(&self) -> usize {
        self.first_row + FIRST_LINE
    }

    /// About what its numbers take in memory, bytes.
    pub(in crate::mapping) const fn bytes(&self) -> usize {
        8 * self.rows * self.columns.len()
    }

    fn column(&self, place: usize) -> Option<&BatchColumn> {
        self.columns.iter().find(|(known, _)| *known == place).map(|(_, column)| column)
    }

    /// The same as comma-separated text, a line for each row, of a table with this many columns.
    #[must_use]
    pub fn to_text(&self, fields: usize) -> String {
        let mut cells: Vec<Cells<'_>> = (0..fields).map(|place| self.cells(place)).collect();
        let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
        for _ in 0..self.rows {
            // Writing to memory cannot fail.
            let _ =
                writer.write_record(cells.iter_mut().map(|cells| cells.next().unwrap_or_default()));
        }
        let bytes = writer.into_inner().unwrap_or_default();
        String::from_utf8(bytes).unwrap_or_default()
    }

    fn cells(&self, place: usize) -> Cells<'_> {
        match self.column(place) {
            None => Box::new(core::iter::repeat_n(String::new(), self.rows)),
            Some(BatchColumn::Numbers(numbers) | BatchColumn::Finite(numbers)) => Box::new(
                numbers
                    .iter()
                    .map(|number| if number.is_nan() { String::new() } else { number.to_string() }),
            ),
            Some(BatchColumn::Instants(instants)) => Box::new(instants.iter().map(|instant| {
                instant_of(*instant).map_or_else(String::new, |instant| instant.to_string())
            })),
            Some(BatchColumn::LocalTimes(times)) => Box::new(
                times.iter().map(|time| instant_of(*time).map_or_else(String::new, local_text)),
            ),
            Some(BatchColumn::Texts(texts)) => Box::new(
                texts.iter().flat_map(|(text, rows)| core::iter::repeat_n(text.clone(), *rows)),
            ),
        }
    }
}

/// The names of columns as the first line of a comma-separated text.
#[must_use]
pub fn line_of_names(names: &[String]) -> String {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    // Writing to memory cannot fail.
    let _ = writer.write_record(names);
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// The rows from which on texts are others.
type Changes = Vec<(usize, Event)>;

type Cells<'a> = Box<dyn Iterator<Item = String> + 'a>;

/// The instant that is so many nanoseconds after 1970: there is one for each, from 1677 to 2262, but for the first.
pub(super) fn instant_of(nanoseconds: i64) -> Option<Timestamp> {
    if nanoseconds == NO_INSTANT {
        return None;
    }
    Timestamp::from_nanosecond(i128::from(nanoseconds)).ok()
}

/// A local time that was read as if it were UTC, as text: without an offset, which the mapping has.
#[must_use]
pub fn local_text(time: Timestamp) -> String {
    time.to_zoned(TimeZone::UTC).datetime().to_string()
}

/// Whether each row has an instant.
fn are_there(instants: &[i64]) -> bool {
    instants.iter().map(|instant| u64::from(*instant == NO_INSTANT)).sum::<u64>() == 0
}

impl Layout {
    /// The places of the columns that are read.
    pub(in crate::mapping) fn needed(&self) -> Vec<usize> {
        let fields = &self.fields;
        let texts = fields.texts.iter().filter_map(|(_, text)| match text {
            Text::Field(field) => Some(*field),
            Text::Constant(_) => None,
        });
        let mut needed: Vec<usize> = core::iter::once(fields.time)
            .chain(fields.date)
            .chain(fields.offset)
            .chain(fields.inputs.iter().copied())
            .chain(texts)
            .chain(fields.only.iter().copied())
            .collect();
        needed.sort_unstable();
        needed.dedup();
        needed
    }

    /// Reads the rows of a batch.
    pub(super) fn rows_of_batch(&self, mut batch: Batch) -> Rows {
        if let Some((lacks, events, times)) = self.columns_of_rows(&mut batch) {
            let piece = Piece { first_line: batch.first_line(), ..Piece::default() };
            let mut rows = Rows::new(self, piece);
            rows.times = times;
            rows.block = Block::of(self.numbers(&mut batch), lacks);
            rows.lines = LineNumbers::from_line(batch.first_line(), batch.rows);
            rows.events = events;
            return rows;
        }
        let text = Arc::new(batch.to_text(self.columns));
        let content = Content::Text(text);
        self.read_rows(Piece { content, first_line: batch.first_line(), ..Piece::default() })
    }

    /// Which inputs lack a number, where the texts change, and the times, which it takes out of the batch. `None` where a column
    /// is of another kind than the mapping asks for, or holds what has to be refused.
    fn columns_of_rows(&self, batch: &mut Batch) -> Option<(Vec<bool>, Changes, Times)> {
        let mut lacks = Vec::with_capacity(self.plan.inputs.len());
        for (input, field) in self.plan.inputs.iter().zip(&self.fields.inputs) {
            let values = match batch.column(*field)? {
                BatchColumn::Numbers(values) => values.as_slice(),
                BatchColumn::Finite(_) => &[],
                _ => return None,
            };
            // Counted, without a way out of the loop: nearly always none is.
            let not_finite = values.iter().map(|value| u64::from(!value.is_finite())).sum::<u64>();
            if !input.values.is_empty()
                || (not_finite > 0 && values.iter().any(|x| x.is_infinite()))
            {
                return None;
            }
            lacks.push(not_finite > 0);
        }
        let events = self.texts_of_rows(batch)?;
        Some((lacks, events, self.times(batch)?))
    }

    /// The numbers of each input, taken out of the batch.
    fn numbers(&self, batch: &mut Batch) -> Vec<Vec<f64>> {
        let inputs = &self.fields.inputs;
        let mut numbers = Vec::with_capacity(inputs.len());
        for (index, field) in inputs.iter().enumerate() {
            let column = batch.columns.iter_mut().find(|(known, _)| known == field);
            numbers.push(match column {
                Some((_, BatchColumn::Numbers(values) | BatchColumn::Finite(values))) => {
                    if inputs[index + 1..].contains(field) {
                        values.clone()
                    } else {
                        core::mem::take(values)
                    }
                }
                // Every input was found to be one of numbers.
                _ => vec![f64::NAN; batch.rows],
            });
        }
        numbers
    }

    fn times(&self, batch: &mut Batch) -> Option<Times> {
        let place = self.fields.time;
        let found = batch.columns.iter_mut().find(|(known, _)| *known == place);
        match (&self.plan.time, &mut found?.1) {
            (
                TimeForm::Timestamp { date_column: None, format: None, .. },
                BatchColumn::Instants(instants),
            ) => are_there(instants).then(|| Times::Nanoseconds(core::mem::take(instants))),
            (
                TimeForm::Timestamp {
                    date_column: None,
                    format: None,
                    offset_column: None,
                    utc_offset,
                },
                BatchColumn::LocalTimes(times),
            ) => {
                let ahead = utc_offset.as_deref().and_then(seconds_east)?.checked_mul(SECOND_NS)?;
                // Of those that are too near to the ends of what can be counted the text is read.
                let can_be_shifted = |time: &i64| time.checked_sub(ahead).is_some();
                if !are_there(times) || !times.iter().all(can_be_shifted) {
                    return None;
                }
                for time in times.iter_mut() {
                    *time -= ahead;
                }
                Some(Times::Nanoseconds(core::mem::take(times)))
            }
            (
                TimeForm::Seconds { count, .. },
                BatchColumn::Numbers(numbers) | BatchColumn::Finite(numbers),
            ) => {
                let seconds: Vec<f64> =
                    numbers.iter().map(|number| count.seconds(*number)).collect();
                let is_near = |seconds: &f64| seconds.abs() <= FARTHEST_S;
                seconds.iter().all(is_near).then_some(Times::Seconds(seconds))
            }
            _ => None,
        }
    }

    /// Where the texts of the header change; `None` where rows are left out, or lack a text.
    fn texts_of_rows(&self, batch: &Batch) -> Option<Vec<(usize, Event)>> {
        for ((_, texts), field) in self.plan.only.iter().zip(&self.fields.only) {
            let BatchColumn::Texts(runs) = batch.column(*field)? else { return None };
            if !runs.iter().all(|(text, _)| texts.iter().any(|wanted| wanted == text.trim())) {
                return None;
            }
        }
        let mut changes = vec![0];
        let mut sources = Vec::with_capacity(3);
        for (_, text) in &self.fields.texts {
            let runs = match text {
                Text::Constant(text) => {
                    core::slice::from_ref(text).iter().map(|t| (t.as_str(), batch.rows)).collect()
                }
                Text::Field(field) => {
                    let BatchColumn::Texts(runs) = batch.column(*field)? else { return None };
                    runs.iter().map(|(text, rows)| (text.trim(), *rows)).collect::<Vec<_>>()
                }
            };
            if runs.iter().any(|(text, _)| text.is_empty()) {
                return None;
            }
            let mut end = 0;
            changes.extend(runs.iter().map(|(_, rows)| {
                end += rows;
                end
            }));
            sources.push(runs.into_iter());
        }
        changes.sort_unstable();
        changes.dedup();
        let mut ends = [0; 3];
        let events = changes.into_iter().filter(|row| *row < batch.rows).map(|row| {
            let mut texts: [String; 3] = Default::default();
            for ((text, runs), end) in texts.iter_mut().zip(&mut sources).zip(&mut ends) {
                text_at(runs, end, row).clone_into(text);
            }
            (row, Event::Texts(Arc::new(texts)))
        });
        Some(events.collect())
    }
}

/// The text that holds for a row; runs before it are passed, the last of which ends at `end`.
fn text_at<'t>(
    runs: &mut std::vec::IntoIter<(&'t str, usize)>,
    end: &mut usize,
    row: usize,
) -> &'t str {
    while let Some((text, rows)) = runs.as_slice().first() {
        if row < *end + rows {
            return text;
        }
        *end += rows;
        runs.next();
    }
    ""
}
