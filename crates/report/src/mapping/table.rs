//! Delimited text into recordings: rows of numbers with their line numbers.

use flight::Timestamp;

use super::file::TextSource;
use super::plan::{Plan, TimeForm};
use crate::cruise_text::parse_instant;
use crate::number;
use crate::refusal::{Found, Refusal, RefusalKind};

/// A file of delimited text.
#[derive(Debug)]
pub(super) struct Table<'a> {
    pub(super) recordings: Vec<Recording>,
    source: Source<'a>,
    input_fields: Vec<usize>,
}

/// The rows of one flight that have every number the report needs.
#[derive(Debug)]
pub(super) struct Recording {
    pub(super) aircraft: String,
    pub(super) tail: String,
    pub(super) flight: String,
    /// The instant from which `time_s` counts.
    pub(super) origin: Timestamp,
    /// Strictly increasing.
    pub(super) time_s: Vec<f64>,
    /// `[input][row]`; NaN where an optional number is not available.
    pub(super) numbers: Vec<Vec<f64>>,
    /// Line of each row, as the reader of delimited text counts.
    lines: Vec<usize>,
    /// Rows that lack a number that the report needs.
    pub(super) left_out: usize,
    first_left_out: Option<usize>,
}

impl Table<'_> {
    /// Refuses the number of an input in a row.
    pub(super) fn refuse(
        &self,
        recording: &Recording,
        row: usize,
        input: usize,
        found: Found,
        kind: RefusalKind,
    ) -> Refusal {
        self.source.refuse(recording.lines[row], self.input_fields[input], found, kind)
    }

    /// Physical line of a row.
    pub(super) fn line(&self, recording: &Recording, row: usize) -> usize {
        self.source.settle(recording.lines[row])
    }

    /// Physical line of the first row that was left out.
    pub(super) fn first_left_out(&self, recording: &Recording) -> Option<usize> {
        recording.first_left_out.map(|line| self.source.settle(line))
    }

    /// Refuses at the end of the text.
    pub(super) fn refuse_end(&self, found: Found, kind: RefusalKind) -> Refusal {
        self.source.refuse_end(found, kind)
    }
}

/// Reads all rows of `text`; `file_name` is used for the texts that the mapping takes from the file's name.
pub(super) fn read<'a>(
    plan: &Plan,
    text: &'a str,
    file_name: Option<&str>,
) -> Result<Table<'a>, Refusal> {
    let source = Source { text, separator: plan.separator, comment: plan.comment };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .delimiter(plan.separator)
        .comment(plan.comment)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut record = csv::StringRecord::new();
    if !source.next(&mut reader, &mut record)? {
        return Err(source.refuse_end(Found::EndOfText, RefusalKind::SourceNamesMissing));
    }
    let names = Names { record: record.clone(), source };
    let time_field = names.find(&plan.time_column)?;
    let input_fields =
        plan.inputs.iter().map(|input| names.find(&input.name)).collect::<Result<Vec<_>, _>>()?;
    let texts = [
        ("AIRCRAFT", names.find_text(&plan.aircraft, file_name)?),
        ("TAIL", names.find_text(&plan.tail, file_name)?),
        ("FLIGHT", names.find_text(&plan.flight, file_name)?),
    ];

    let mut recordings: Vec<Recording> = Vec::new();
    while source.next(&mut reader, &mut record)? {
        let line = line_of(&record);
        let text = |index: usize| -> Result<&str, Refusal> {
            let (key, place) = &texts[index];
            let value = match place {
                Text::Constant(value) => value,
                Text::Field(field) => &record[*field],
            };
            if value.is_empty() {
                let field = if let Text::Field(field) = place { *field } else { 0 };
                let kind = RefusalKind::SourceTextMissing { key };
                return Err(source.refuse(line, field, Found::text(""), kind));
            }
            Ok(value)
        };
        let (aircraft, tail, flight) = (text(0)?, text(1)?, text(2)?);
        if recordings.last().is_none_or(|last| {
            last.aircraft != aircraft || last.tail != tail || last.flight != flight
        }) {
            recordings.push(Recording {
                aircraft: aircraft.to_owned(),
                tail: tail.to_owned(),
                flight: flight.to_owned(),
                origin: Timestamp::UNIX_EPOCH,
                time_s: Vec::new(),
                numbers: vec![Vec::new(); plan.inputs.len()],
                lines: Vec::new(),
                left_out: 0,
                first_left_out: None,
            });
        }
        let row = Row { plan, source, record: &record, line };
        if let Some(recording) = recordings.last_mut() {
            row.append(recording, time_field, &input_fields)?;
        }
    }
    Ok(Table { recordings, source, input_fields })
}

#[derive(Clone, Copy)]
struct Row<'r, 'a> {
    plan: &'r Plan,
    source: Source<'a>,
    record: &'r csv::StringRecord,
    line: usize,
}

impl Row<'_, '_> {
    fn append(
        self,
        recording: &mut Recording,
        time_field: usize,
        input_fields: &[usize],
    ) -> Result<(), Refusal> {
        let mut is_complete = !self.is_not_available(&self.record[time_field]);
        for ((input, field), numbers) in
            self.plan.inputs.iter().zip(input_fields).zip(&mut recording.numbers)
        {
            let number = self.number(*field, &input.name)?;
            is_complete &= !(input.is_required && number.is_nan());
            numbers.push(number);
        }
        if !is_complete {
            for numbers in &mut recording.numbers {
                numbers.pop();
            }
            recording.left_out += 1;
            recording.first_left_out.get_or_insert(self.line);
            return Ok(());
        }
        let time_s = self.time_s(recording, time_field)?;
        if let Some(previous) = recording.time_s.last()
            && time_s <= *previous
        {
            let kind = RefusalKind::TimeNotIncreasing { previous: *previous, unit: "s" };
            let found = Found::text(&self.record[time_field]);
            return Err(self.source.refuse(self.line, time_field, found, kind));
        }
        recording.time_s.push(time_s);
        recording.lines.push(self.line);
        Ok(())
    }

    fn is_not_available(self, field: &str) -> bool {
        field.is_empty() || self.plan.not_available.iter().any(|text| text == field)
    }

    fn number(self, field: usize, name: &str) -> Result<f64, Refusal> {
        let text = &self.record[field];
        if self.is_not_available(text) {
            return Ok(f64::NAN);
        }
        // Other programs write the exponent's letter as a capital.
        number::whole(text.as_bytes())
            .or_else(|| {
                text.contains('E').then(|| number::whole(text.replacen('E', "e", 1).as_bytes()))?
            })
            .ok_or_else(|| {
                let kind = RefusalKind::SourceNotANumber { name: name.to_owned() };
                self.source.refuse(self.line, field, Found::text(text), kind)
            })
    }

    /// Seconds since the recording's origin, which the first complete row of a recording with instants sets.
    fn time_s(self, recording: &mut Recording, field: usize) -> Result<f64, Refusal> {
        match &self.plan.time {
            TimeForm::Seconds { start } => {
                recording.origin = *start;
                self.number(field, &self.plan.time_column)
            }
            TimeForm::Timestamp { utc_offset } => {
                let text = &self.record[field];
                let instant = instant(text, utc_offset.as_deref()).ok_or_else(|| {
                    let kind = RefusalKind::SourceInstantMalformed;
                    self.source.refuse(self.line, field, Found::text(text), kind)
                })?;
                if recording.time_s.is_empty() {
                    recording.origin = instant;
                }
                let nanoseconds = instant.as_nanosecond() - recording.origin.as_nanosecond();
                Ok(nanoseconds as f64 / 1e9)
            }
        }
    }
}

/// ISO text with `T` or a blank between date and time, with its own offset or with `utc_offset`.
fn instant(text: &str, utc_offset: Option<&str>) -> Option<Timestamp> {
    let with_t = text.replacen(' ', "T", 1);
    parse_instant(&with_t).or_else(|| parse_instant(&(with_t + utc_offset?)))
}

enum Text {
    Constant(String),
    Field(usize),
}

struct Names<'a> {
    record: csv::StringRecord,
    source: Source<'a>,
}

impl Names<'_> {
    fn find(&self, name: &str) -> Result<usize, Refusal> {
        let mut places = (0..self.record.len()).filter(|field| self.record[*field] == *name);
        let line = line_of(&self.record);
        let owned = || name.to_owned();
        match (places.next(), places.next()) {
            (Some(place), None) => Ok(place),
            (Some(_), Some(second)) => {
                let kind = RefusalKind::SourceColumnDoubled { name: owned() };
                Err(self.source.refuse(line, second, Found::text(name), kind))
            }
            (None, _) => {
                let kind = RefusalKind::SourceColumnMissing { name: owned() };
                Err(self.source.refuse_line_end(line, kind))
            }
        }
    }

    fn find_text(&self, source: &TextSource, file_name: Option<&str>) -> Result<Text, Refusal> {
        Ok(match source {
            TextSource::Text(text) => Text::Constant(text.clone()),
            TextSource::Column(name) => Text::Field(self.find(name)?),
            TextSource::FileName => Text::Constant(file_name.unwrap_or_default().to_owned()),
        })
    }
}

/// The text with what is needed to state a position in it.
#[derive(Clone, Copy, Debug)]
struct Source<'a> {
    text: &'a str,
    separator: u8,
    comment: Option<u8>,
}

impl<'a> Source<'a> {
    fn next(
        self,
        reader: &mut csv::Reader<&[u8]>,
        record: &mut csv::StringRecord,
    ) -> Result<bool, Refusal> {
        reader.read_record(record).map_err(|error| match error.kind() {
            csv::ErrorKind::UnequalLengths { pos: Some(position), expected_len, len } => {
                let line = usize::try_from(position.line()).unwrap_or(usize::MAX);
                let expected = usize::try_from(*expected_len).unwrap_or(usize::MAX);
                let found = usize::try_from(*len).unwrap_or(usize::MAX);
                if found < expected {
                    let mut refusal =
                        self.refuse_line_end(line, RefusalKind::TooFewFields { expected });
                    refusal.found = Found::Fields(found);
                    refusal
                } else {
                    let kind = RefusalKind::TooManyFields { expected };
                    self.refuse(line, expected, Found::Fields(found), kind)
                }
            }
            // For text in memory that is UTF-8, no other error is possible.
            _ => self.refuse_end(Found::EndOfText, RefusalKind::InvalidUtf8),
        })
    }

    fn refuse(self, line: usize, field: usize, found: Found, kind: RefusalKind) -> Refusal {
        let line = self.settle(line);
        Refusal { line, column: self.column_of(line, field), found, kind }
    }

    fn refuse_line_end(self, line: usize, kind: RefusalKind) -> Refusal {
        let line = self.settle(line);
        let column = self.line(line).chars().count() + 1;
        Refusal { line, column, found: Found::EndOfLine, kind }
    }

    fn refuse_end(self, found: Found, kind: RefusalKind) -> Refusal {
        let line = self.text.lines().count().max(1);
        Refusal { line, column: self.line(line).chars().count() + 1, found, kind }
    }

    fn line(self, line: usize) -> &'a str {
        self.text.lines().nth(line - 1).unwrap_or_default()
    }

    /// The line itself: the reader of delimited text counts a record from the blank and comment lines before it.
    fn settle(self, line: usize) -> usize {
        let means_nothing = |text: &str| {
            text.is_empty() || self.comment.is_some_and(|mark| text.as_bytes()[0] == mark)
        };
        let skipped =
            self.text.lines().skip(line - 1).take_while(|text| means_nothing(text)).count();
        line + skipped
    }

    /// Character from 1 where a field begins; separators between quotes do not count.
    fn column_of(self, line: usize, field: usize) -> usize {
        let separator = char::from(self.separator);
        let mut is_quoted = false;
        let mut separators = 0;
        for (index, character) in self.line(line).chars().enumerate() {
            if separators == field {
                return index + 1;
            }
            match character {
                '"' => is_quoted = !is_quoted,
                _ if character == separator && !is_quoted => separators += 1,
                _ => {}
            }
        }
        self.line(line).chars().count() + 1
    }
}

/// Physical line of a record.
fn line_of(record: &csv::StringRecord) -> usize {
    let line = record.position().map_or(1, csv::Position::line);
    usize::try_from(line).unwrap_or(usize::MAX)
}
