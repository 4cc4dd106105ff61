//! The rows of a table in memory as the rows of a piece, where their text would say nothing else.

use std::sync::Arc;

use flight::Timestamp;

use super::line_numbers::LineNumbers;
use super::rows::{Event, FARTHEST_S, Rows, Times};
use super::{Layout, Text};
use crate::cruise_text::parse_instant;
use crate::mapping::in_memory::{Cells, TableRows};
use crate::mapping::pieces::{Content, Piece};
use crate::mapping::plan::TimeForm;
use crate::number;

impl Layout {
    /// Reads the rows of a stretch of a table: as columns, or as text where the mapping asks for what only text has (texts
    /// that stand for numbers, rows selected by text), or a row has anything that could be refused.
    pub(super) fn rows_of_table(&self, mut table: TableRows, first_line: usize) -> Rows {
        if let Some(rows) = self.rows_of_columns(&mut table, first_line) {
            return rows;
        }
        let text = Arc::new(table.text.text(0..table.rows));
        self.read_rows(Piece { content: Content::Text(text), first_line, ..Piece::default() })
    }

    fn rows_of_columns(&self, table: &mut TableRows, first_line: usize) -> Option<Rows> {
        let plan = &self.plan;
        let plain = plan.only.is_empty()
            && plan.inputs.iter().all(|input| input.values.is_empty())
            && table.columns.len() == self.columns;
        if !plain || !table.columns.iter().all(|cells| cells.len().is_none_or(|n| n == table.rows))
        {
            return None;
        }
        let sentinels = self.numbers_not_available()?;
        let times = self.times_of(table, &sentinels)?;
        let events = self.texts_of(table)?;
        for field in &self.fields.inputs {
            let Cells::Numbers(values) = &table.columns[*field] else { return None };
            if values.iter().any(|value| sentinels.contains(value)) {
                return None;
            }
        }
        // A column may be the source of several inputs.
        let numbers = self.fields.inputs.iter().map(|field| match &table.columns[*field] {
            Cells::Numbers(values) => values.clone(),
            _ => Vec::new(),
        });
        let piece = Piece {
            content: Content::Lines { lines: table.text.clone(), count: table.rows },
            first_line,
            ..Piece::default()
        };
        Some(Rows {
            numbers: numbers.collect(),
            times,
            lines: LineNumbers::from_line(first_line, table.rows),
            events,
            ..Rows::new(self, piece)
        })
    }

    /// The numbers that stand for "not available"; `None` where a text that does could be another cell's.
    fn numbers_not_available(&self) -> Option<Vec<f64>> {
        let mut numbers = Vec::new();
        for text in &self.plan.not_available {
            // Of an instant's or a text's column it is looked for in the text.
            let number = number::whole(text.as_bytes());
            if number.is_none() && text.starts_with(|first: char| first.is_ascii_digit()) {
                return None;
            }
            numbers.extend(number);
        }
        Some(numbers)
    }

    fn times_of(&self, table: &TableRows, sentinels: &[f64]) -> Option<Times> {
        match (&table.columns[self.fields.time], &self.plan.time) {
            (Cells::Instants(instants), TimeForm::Timestamp { format: None, .. })
                if self.fields.date.is_none() && instants.iter().all(can_be_text) =>
            {
                Some(Times::Instants(instants.clone()))
            }
            (Cells::LocalTimes(times), TimeForm::Timestamp { format: None, utc_offset, .. })
                if self.fields.date.is_none()
                    && self.fields.offset.is_none()
                    && times.iter().all(can_be_text) =>
            {
                let offset = utc_offset.as_deref().and_then(seconds_east)?;
                let instants = times.iter().map(|time| at_offset(*time, offset));
                Some(Times::Instants(instants.collect::<Option<_>>()?))
            }
            (Cells::Numbers(seconds), TimeForm::Seconds { count, .. }) => {
                let times: Vec<f64> = seconds.iter().map(|time| count.seconds(*time)).collect();
                let usual = |time: &f64| time.abs() <= FARTHEST_S;
                let known = !seconds.iter().any(|time| sentinels.contains(time));
                (known && times.iter().all(usual)).then_some(Times::Seconds(times))
            }
            _ => None,
        }
    }

    /// The rows from which on aircraft, tail and flight are others.
    fn texts_of(&self, table: &TableRows) -> Option<Vec<(usize, Event)>> {
        let mut runs: [&[(usize, String)]; 3] = [&[]; 3];
        let mut now = ["", "", ""];
        for ((_, source), (runs, now)) in
            self.fields.texts.iter().zip(runs.iter_mut().zip(&mut now))
        {
            match source {
                Text::Constant(text) => *now = text,
                Text::Field(field) => {
                    let Cells::Texts(found) = &table.columns[*field] else { return None };
                    *runs = found;
                }
            }
        }
        let mut starts: Vec<usize> = runs.iter().copied().flatten().map(|(row, _)| *row).collect();
        starts.push(0);
        starts.sort_unstable();
        starts.dedup();
        let mut events = Vec::new();
        let mut last: Option<Arc<[String; 3]>> = None;
        for row in starts.into_iter().filter(|row| *row < table.rows) {
            for (runs, now) in runs.iter_mut().zip(&mut now) {
                while let Some(((from, text), rest)) = runs.split_first()
                    && *from <= row
                {
                    (*now, *runs) = (text, rest);
                }
            }
            if now.iter().any(|text| text.is_empty()) {
                return None;
            }
            if last.as_ref().is_none_or(|last| last.each_ref().map(String::as_str) != now) {
                let texts = Arc::new(now.map(str::to_owned));
                events.push((row, Event::Texts(Arc::clone(&texts))));
                last = Some(texts);
            }
        }
        Some(events)
    }
}

/// The seconds that local time is ahead of UTC.
pub(super) fn seconds_east(utc_offset: &str) -> Option<i64> {
    // What is midnight there is earlier in UTC where the sun rises earlier.
    parse_instant(&format!("1970-01-01T00:00:00{utc_offset}")).map(|instant| -instant.as_second())
}

/// The instant of a local time that was read as if it were UTC.
pub(super) fn at_offset(local: Timestamp, seconds_east: i64) -> Option<Timestamp> {
    Timestamp::new(local.as_second() - seconds_east, local.subsec_nanosecond()).ok()
}

/// Whether an instant's text is read back as that instant: with years of four digits.
fn can_be_text(instant: &Timestamp) -> bool {
    // 1 January of year 0 and of year 10000.
    (-62_167_219_200..253_402_300_800).contains(&instant.as_second())
}
