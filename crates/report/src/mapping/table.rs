//! Delimited text into recordings: rows of numbers with their line numbers.

mod recording;

use flight::Timestamp;

use super::file::{BadRows, TextSource};
use super::plan::{Input, Plan, TimeForm};
pub(super) use recording::Recording;

use crate::cruise_text::parse_instant;
use crate::number;
use crate::refusal::{Found, Refusal, RefusalKind, nearest};

/// A file of delimited text.
#[derive(Debug)]
pub(super) struct Table<'a> {
    pub(super) recordings: Vec<Recording>,
    source: Source<'a>,
    input_fields: Vec<usize>,
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

/// The names of a recording's columns.
///
/// # Errors
/// A text without a line of names.
pub(super) fn names(form: Form, text: &str) -> Result<Vec<String>, Refusal> {
    let source = Source { text, form };
    let mut record = csv::StringRecord::new();
    if !source.next(&mut source.reader(false), &mut record)? {
        return Err(source.refuse_end(Found::EndOfText, RefusalKind::SourceNamesMissing));
    }
    Ok(record.iter().map(str::to_owned).collect())
}

/// Reads all rows of `text`; `file_name` is used for the texts that the mapping takes from the file's name.
pub(super) fn read<'a>(
    plan: &Plan,
    text: &'a str,
    file_name: Option<&str>,
) -> Result<Table<'a>, Refusal> {
    let leaves_out = plan.bad_rows == BadRows::LeaveRowOut;
    let source = Source { text, form: Form { separator: plan.separator, comment: plan.comment } };
    let mut reader = source.reader(leaves_out);
    let mut record = csv::StringRecord::new();
    if !source.next(&mut reader, &mut record)? {
        return Err(source.refuse_end(Found::EndOfText, RefusalKind::SourceNamesMissing));
    }
    let names = Names { record: record.clone(), source };
    let fields = Fields::find(plan, &names, file_name)?;
    if plan.units_row {
        let _ = source.next(&mut reader, &mut record)?;
    }
    let mut recordings: Vec<Recording> = Vec::new();
    while source.next(&mut reader, &mut record)? {
        let row = Row { plan, source, record: &record, fields: &fields, line: line_of(&record) };
        if record.len() == names.record.len() && !row.is_wanted() {
            continue;
        }
        match row.append_to(&mut recordings, names.record.len()) {
            Err(refusal) if leaves_out => {
                if recordings.is_empty() {
                    recordings.push(Recording::new(["", "", ""], plan.inputs.len()));
                }
                if let Some(recording) = recordings.last_mut() {
                    recording.bad += 1;
                    recording.first_bad.get_or_insert(refusal);
                }
            }
            result => result?,
        }
    }
    for recording in &mut recordings {
        recording.settle(plan);
    }
    let input_fields = fields.inputs;
    Ok(Table { recordings, source, input_fields })
}

/// Where the recording has what the mapping names.
struct Fields {
    time: usize,
    date: Option<usize>,
    inputs: Vec<usize>,
    texts: [(&'static str, Text); 3],
    only: Vec<usize>,
}

impl Fields {
    fn find(plan: &Plan, names: &Names<'_>, file_name: Option<&str>) -> Result<Self, Refusal> {
        let date = match &plan.time {
            TimeForm::Timestamp { date_column: Some(column), .. } => Some(names.find(column)?),
            _ => None,
        };
        Ok(Self {
            time: names.find(&plan.time_column)?,
            date,
            inputs: plan
                .inputs
                .iter()
                .map(|input| names.find(&input.name))
                .collect::<Result<Vec<_>, _>>()?,
            texts: [
                ("AIRCRAFT", names.find_text(&plan.aircraft, file_name)?),
                ("TAIL", names.find_text(&plan.tail, file_name)?),
                ("FLIGHT", names.find_text(&plan.flight, file_name)?),
            ],
            only: plan
                .only
                .iter()
                .map(|(column, _)| names.find(column))
                .collect::<Result<Vec<_>, _>>()?,
        })
    }
}

#[derive(Clone, Copy)]
struct Row<'r, 'a> {
    plan: &'r Plan,
    source: Source<'a>,
    record: &'r csv::StringRecord,
    fields: &'r Fields,
    line: usize,
}

impl<'r> Row<'r, '_> {
    /// Whether every column that selects rows holds one of its texts.
    fn is_wanted(self) -> bool {
        self.plan
            .only
            .iter()
            .zip(&self.fields.only)
            .all(|((_, texts), field)| texts.iter().any(|text| *text == self.record[*field]))
    }

    fn text(self, index: usize) -> Result<&'r str, Refusal> {
        let (key, place) = &self.fields.texts[index];
        let value = match place {
            Text::Constant(value) => value,
            Text::Field(field) => &self.record[*field],
        };
        if value.is_empty() {
            let field = if let Text::Field(field) = place { *field } else { 0 };
            let kind = RefusalKind::SourceTextMissing { key };
            return Err(self.source.refuse(self.line, field, Found::text(""), kind));
        }
        Ok(value)
    }

    /// Adds the row to the recording that it belongs to, which may be a new one.
    fn append_to(self, recordings: &mut Vec<Recording>, columns: usize) -> Result<(), Refusal> {
        if self.record.len() != columns {
            return Err(self.source.refuse_length(self.line, self.record.len(), columns));
        }
        let texts = [self.text(0)?, self.text(1)?, self.text(2)?];
        let inputs = self.plan.inputs.len();
        if recordings.last().is_none_or(|last| !last.is_of(texts)) {
            recordings.push(Recording::new(texts, inputs));
        }
        let Some(recording) = recordings.last_mut() else { return Ok(()) };
        if self.is_not_available(&self.record[self.fields.time]) {
            recording.left_out += 1;
            recording.first_left_out.get_or_insert(self.line);
            return Ok(());
        }
        let numbers = (self.plan.inputs.iter().zip(&self.fields.inputs))
            .map(|(input, field)| self.number_of(*field, input))
            .collect::<Result<Vec<f64>, _>>()?;
        let mut time_s = self.time_s(recording)?;
        let previous_s = recording.time_s.last().copied();
        let gap_s = previous_s.map_or(0.0, |previous| time_s - previous);
        if self.plan.new_flight_after_s.is_some_and(|longest_s| gap_s > longest_s) {
            let mut next = Recording::new(texts, inputs);
            time_s = self.time_s(&mut next)?;
            recordings.push(next);
        } else if let Some(previous) = previous_s
            && time_s <= previous
        {
            let kind = RefusalKind::TimeNotIncreasing { previous, unit: "s" };
            let found = Found::text(&self.record[self.fields.time]);
            return Err(self.source.refuse(self.line, self.fields.time, found, kind));
        }
        let Some(recording) = recordings.last_mut() else { return Ok(()) };
        recording.time_s.push(time_s);
        recording.lines.push(self.line);
        for (column, number) in recording.numbers.iter_mut().zip(numbers) {
            column.push(number);
        }
        Ok(())
    }

    fn is_not_available(self, field: &str) -> bool {
        field.is_empty() || self.plan.not_available.iter().any(|text| text == field)
    }

    fn number_of(self, field: usize, input: &Input) -> Result<f64, Refusal> {
        let text = &self.record[field];
        match input.values.iter().find(|(known, _)| known == text) {
            Some((_, value)) => Ok(*value),
            None => self.number(field, &input.name),
        }
    }

    fn number(self, field: usize, name: &str) -> Result<f64, Refusal> {
        let sent = &self.record[field];
        if self.is_not_available(sent) {
            return Ok(f64::NAN);
        }
        let with_point = (self.plan.decimal == ',').then(|| sent.replacen(',', ".", 1));
        let text = with_point.as_deref().unwrap_or(sent);
        // Other programs write the exponent's letter as a capital.
        number::whole(text.as_bytes())
            .or_else(|| {
                text.contains('E').then(|| number::whole(text.replacen('E', "e", 1).as_bytes()))?
            })
            .ok_or_else(|| {
                let kind = RefusalKind::SourceNotANumber { name: name.to_owned() };
                self.source.refuse(self.line, field, Found::text(sent), kind)
            })
    }

    /// Seconds since the recording's origin, which the first row of a recording with instants sets.
    fn time_s(self, recording: &mut Recording) -> Result<f64, Refusal> {
        let field = self.fields.time;
        let text = &self.record[field];
        let malformed = || {
            let kind = RefusalKind::SourceInstantMalformed;
            self.source.refuse(self.line, field, Found::text(text), kind)
        };
        match &self.plan.time {
            TimeForm::Seconds { start, per_second } => {
                recording.origin = *start;
                let seconds = self.number(field, &self.plan.time_column)? / per_second;
                if seconds.abs() > FARTHEST_S { Err(malformed()) } else { Ok(seconds) }
            }
            TimeForm::Timestamp { date_column: _, format, utc_offset } => {
                let date = self.fields.date.map(|field| &self.record[field]);
                let joined = date.map_or_else(|| text.to_owned(), |date| format!("{date} {text}"));
                let instant = match format {
                    Some(format) => formatted(&joined, format, utc_offset.as_deref()),
                    None => instant(&joined, utc_offset.as_deref()),
                }
                .ok_or_else(malformed)?;
                if recording.time_s.is_empty() {
                    recording.origin = instant;
                }
                let nanoseconds = instant.as_nanosecond() - recording.origin.as_nanosecond();
                Ok(nanoseconds as f64 / 1e9)
            }
            TimeForm::TimeOfDay { midnight } => {
                recording.origin = *midnight;
                let seconds = time_of_day_s(text).ok_or_else(malformed)?;
                // Later than noon and then earlier: midnight has passed.
                if seconds < recording.last_time_of_day_s - HALF_A_DAY_S {
                    recording.days += 1.0;
                }
                recording.last_time_of_day_s = seconds;
                Ok(seconds + recording.days * 2.0 * HALF_A_DAY_S)
            }
        }
    }
}

const HALF_A_DAY_S: f64 = 43_200.0;
/// Seconds from an origin beyond which a number is in another unit than seconds.
const FARTHEST_S: f64 = 2e11;

/// ISO text with `T` or a blank between date and time, with its own offset or with `utc_offset`.
fn instant(text: &str, utc_offset: Option<&str>) -> Option<Timestamp> {
    let with_t = text.replacen(' ', "T", 1);
    parse_instant(&with_t).or_else(|| parse_instant(&(with_t + utc_offset?)))
}

/// Text of a form as `strptime` names it; an offset in the text counts more than `utc_offset`.
fn formatted(text: &str, format: &str, utc_offset: Option<&str>) -> Option<Timestamp> {
    let broken = jiff::fmt::strtime::parse(format, text).ok()?;
    if broken.offset().is_some() {
        return broken.to_timestamp().ok();
    }
    parse_instant(&(broken.to_datetime().ok()?.to_string() + utc_offset?))
}

/// Hours, minutes and seconds, separated by colons; s.
fn time_of_day_s(text: &str) -> Option<f64> {
    let mut fields = text.split(':').map(|field| number::whole(field.as_bytes()));
    let (hours, minutes) = (fields.next()??, fields.next()??);
    let seconds = fields.next().unwrap_or(Some(0.0))?;
    let is_within = (0.0..24.0).contains(&hours)
        && (0.0..60.0).contains(&minutes)
        && (0.0..61.0).contains(&seconds)
        && fields.next().is_none();
    is_within.then_some(3600.0 * hours + 60.0 * minutes + seconds)
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
                let kind =
                    RefusalKind::SourceColumnMissing { name: owned(), hint: self.hint(name) };
                Err(self.source.refuse_line_end(line, kind))
            }
        }
    }

    /// What may have been meant by a name that is not there.
    fn hint(&self, name: &str) -> String {
        if let Some(near) = nearest(name, self.record.iter()) {
            return format!("; did you mean {near:?}?");
        }
        let line = self.record.iter().next().unwrap_or_default();
        let other = [';', ',', '\t', '|']
            .into_iter()
            .find(|separator| self.record.len() == 1 && line.matches(*separator).count() > 2);
        other.map_or_else(String::new, |separator| {
            format!("; the line holds many {separator:?}: separator: {separator:?} in the mapping?")
        })
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
    form: Form,
}

/// How fields are separated, and lines that mean nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub(super) separator: u8,
    pub(super) comment: Option<u8>,
}

impl<'a> Source<'a> {
    /// A reader of the text's records; with `flexible`, of records of any length.
    fn reader(self, flexible: bool) -> csv::Reader<&'a [u8]> {
        csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(flexible)
            .delimiter(self.form.separator)
            .comment(self.form.comment)
            .trim(csv::Trim::All)
            .from_reader(self.text.as_bytes())
    }

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
                self.refuse_length(line, found, expected)
            }
            // For text in memory that is UTF-8, no other error is possible.
            _ => self.refuse_end(Found::EndOfText, RefusalKind::InvalidUtf8),
        })
    }

    /// A row with too few or too many fields.
    fn refuse_length(self, line: usize, found: usize, expected: usize) -> Refusal {
        if found < expected {
            let mut refusal = self.refuse_line_end(line, RefusalKind::TooFewFields { expected });
            refusal.found = Found::Fields(found);
            refusal
        } else {
            self.refuse(
                line,
                expected,
                Found::Fields(found),
                RefusalKind::TooManyFields { expected },
            )
        }
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
            text.is_empty() || self.form.comment.is_some_and(|mark| text.as_bytes()[0] == mark)
        };
        let skipped =
            self.text.lines().skip(line - 1).take_while(|text| means_nothing(text)).count();
        line + skipped
    }

    /// Character from 1 where a field begins; separators between quotes do not count.
    fn column_of(self, line: usize, field: usize) -> usize {
        let separator = char::from(self.form.separator);
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
