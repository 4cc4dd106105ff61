//! Delimited text into recordings: where a recording has what its mapping names, and positions for refusals.

mod ahead;
mod batch;
mod clock;
mod columns;
mod flights;
mod growing;
mod instants;
mod line_numbers;
mod open;
mod recording;
mod rows;

use super::MappingError;
use super::file::{MappingFile, TextSource};
use super::plan::{Plan, TimeForm};
pub use batch::{Batch, BatchColumn, NO_INSTANT, line_of_names, local_text};
pub(super) use flights::Assembly;
pub(super) use instants::EARLIEST_S;
#[cfg(test)]
pub(super) use open::Limits;
pub(super) use recording::{Recording, interpolate};
pub use rows::Rows;

use crate::refusal::{Found, Refusal, RefusalKind, nearest};

/// How fields are separated, and lines that mean nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub(super) separator: u8,
    pub(super) comment: Option<u8>,
    /// Line of the names, from 1.
    pub(super) names_line: usize,
}

impl Form {
    /// Lines above the names.
    const fn titles(self) -> usize {
        self.names_line.saturating_sub(1)
    }
}

/// A recording's layout: the plan for the columns that it has, and where they are.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) plan: Plan,
    fields: Fields,
    /// Fields of a row.
    columns: usize,
    names_line: usize,
}

/// What is below the line of names: the byte at which it begins, and its line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Below {
    pub(super) byte: usize,
    pub(super) line: usize,
}

/// The names of a recording's columns.
///
/// # Errors
/// A text without a line of names.
pub(super) fn names(form: Form, text: &str) -> Result<Vec<String>, Refusal> {
    let text = below_titles(form, text);
    let names = Names::read(form, text, &mut reader(form, text))?;
    Ok(names.record.iter().map(str::to_owned).collect())
}

impl Layout {
    /// The layout of a recording that begins with these lines; `file_name` is used for the texts that the mapping takes
    /// from the file's name.
    pub(super) fn of_text(
        file: &MappingFile,
        first: &str,
        file_name: Option<&str>,
    ) -> Result<(Self, Below), Refusal> {
        let form = form_of(file);
        let text = below_titles(form, first);
        let titles = first.len() - text.len();
        let mut reader = reader(form, text);
        let names = Names::read(form, text, &mut reader)?;
        let layout = Self::of_names(file, &names, file_name)?;
        if layout.plan.units_row {
            let _ = reader.read_record(&mut csv::StringRecord::new());
        }
        let position = reader.position();
        let byte = usize::try_from(position.byte()).unwrap_or(usize::MAX).min(text.len());
        let line = line_of(position) + form.titles();
        Ok((layout, Below { byte: titles + byte, line }))
    }

    /// The layout of a table with these names of columns.
    pub(super) fn of_table(
        file: &MappingFile,
        names: &[String],
        file_name: Option<&str>,
    ) -> Result<Self, Refusal> {
        let record = csv::StringRecord::from_iter(names);
        let text = names.join(",");
        Self::of_names(
            file,
            &Names { record, line: 1, text: &text, form: form_of(file) },
            file_name,
        )
    }

    fn of_names(
        file: &MappingFile,
        names: &Names<'_>,
        file_name: Option<&str>,
    ) -> Result<Self, Refusal> {
        let sent: Vec<&str> = names.record.iter().collect();
        let plan = Plan::new(file.resolved(&sent)).map_err(|error: MappingError| Refusal {
            line: names.sent_line(),
            column: 1,
            found: Found::text(&sent.join(" ")),
            kind: RefusalKind::SourceColumnsUnfit { reason: error.to_string() },
        })?;
        let fields = Fields::find(&plan, names, file_name)?;
        Ok(Self { plan, fields, columns: names.record.len(), names_line: names.sent_line() })
    }

    /// The line of names.
    pub(super) const fn names_line(&self) -> usize {
        self.names_line
    }

    fn form(&self) -> Form {
        Form { separator: self.plan.separator, comment: self.plan.comment, names_line: 1 }
    }

    /// Refuses the number of an input in a row.
    pub(super) fn refuse(
        &self,
        recording: &Recording,
        (row, input): (usize, usize),
        found: Found,
        kind: RefusalKind,
    ) -> Refusal {
        let line = recording.lines.at(row);
        let text = recording.line(line);
        let column = column_of(self.form(), &text, self.fields.inputs[input]);
        Refusal { line, column, found, kind }
    }

    /// Refuses at a field's place in a line.
    fn refuse_field(
        &self,
        (line, text): (usize, &str),
        field: usize,
        found: Found,
        kind: RefusalKind,
    ) -> Refusal {
        Refusal { line, column: column_of(self.form(), text, field), found, kind }
    }
}

fn form_of(file: &MappingFile) -> Form {
    // What is no separator is refused with the mapping itself.
    let byte = |character: char| u8::try_from(character).ok();
    Form {
        separator: byte(file.separator).unwrap_or(b','),
        comment: file.comment.and_then(byte),
        names_line: file.names_line,
    }
}

/// Where the recording has what the mapping names.
#[derive(Clone, Debug)]
struct Fields {
    time: usize,
    date: Option<usize>,
    /// Of the offset from UTC.
    offset: Option<usize>,
    inputs: Vec<usize>,
    texts: [(&'static str, Text); 3],
    only: Vec<usize>,
}

impl Fields {
    fn find(plan: &Plan, names: &Names<'_>, file_name: Option<&str>) -> Result<Self, Refusal> {
        let (date, offset) = match &plan.time {
            TimeForm::Timestamp { date_column, offset_column, .. } => (
                date_column.as_ref().map(|column| names.find(column)).transpose()?,
                offset_column.as_ref().map(|column| names.find(column)).transpose()?,
            ),
            _ => (None, None),
        };
        Ok(Self {
            time: names.find(&plan.time_column)?,
            date,
            offset,
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

#[derive(Clone, Debug)]
enum Text {
    Constant(String),
    Field(usize),
}

/// The line of names.
struct Names<'a> {
    record: csv::StringRecord,
    /// Its physical line below the titles.
    line: usize,
    /// The text below the titles.
    text: &'a str,
    form: Form,
}

impl<'a> Names<'a> {
    fn read(form: Form, text: &'a str, reader: &mut csv::Reader<&[u8]>) -> Result<Self, Refusal> {
        let mut record = csv::StringRecord::new();
        // For text in memory that is UTF-8, and records of any length, no error is possible.
        if !reader.read_record(&mut record).unwrap_or(false) {
            let line = text.lines().count().max(1);
            let last = text.lines().nth(line - 1).unwrap_or_default();
            let (column, kind) = (last.chars().count() + 1, RefusalKind::SourceNamesMissing);
            let line = line + form.titles();
            return Err(Refusal { line, column, found: Found::EndOfText, kind });
        }
        let line = settle(form, text, record.position().map_or(1, line_of));
        Ok(Self { record, line, text, form })
    }

    /// Its line in the recording.
    const fn sent_line(&self) -> usize {
        self.line + self.form.titles()
    }

    fn find(&self, name: &str) -> Result<usize, Refusal> {
        let mut places = (0..self.record.len()).filter(|field| self.record[*field] == *name);
        let owned = || name.to_owned();
        let text = self.text.lines().nth(self.line - 1).unwrap_or_default();
        match (places.next(), places.next()) {
            (Some(place), None) => Ok(place),
            (Some(_), Some(second)) => Err(Refusal {
                line: self.sent_line(),
                column: column_of(self.form, text, second),
                found: Found::text(name),
                kind: RefusalKind::SourceColumnDoubled { name: owned() },
            }),
            (None, _) => Err(Refusal {
                line: self.sent_line(),
                column: text.chars().count() + 1,
                found: Found::EndOfLine,
                kind: RefusalKind::SourceColumnMissing { name: owned(), hint: self.hint(name) },
            }),
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

/// What is below the titles.
pub(super) fn below_titles(form: Form, text: &str) -> &str {
    let Some(last) = form.titles().checked_sub(1) else { return text };
    let end = memchr::memchr_iter(b'\n', text.as_bytes()).nth(last);
    end.map_or("", |end| &text[end + 1..])
}

/// A reader of a text's records, of any length.
fn reader(form: Form, text: &str) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(form.separator)
        .comment(form.comment)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes())
}

/// Whether a line means nothing.
fn means_nothing(form: Form, line: &str) -> bool {
    line.is_empty() || form.comment.is_some_and(|mark| line.as_bytes()[0] == mark)
}

/// The line itself: the reader of delimited text counts a record from the blank and comment lines before it.
fn settle(form: Form, text: &str, line: usize) -> usize {
    line + text.lines().skip(line - 1).take_while(|text| means_nothing(form, text)).count()
}

/// Character from 1 where a field begins in a line; separators between quotes do not count.
fn column_of(form: Form, line: &str, field: usize) -> usize {
    let separator = char::from(form.separator);
    let mut is_quoted = false;
    let mut separators = 0;
    for (index, character) in line.chars().enumerate() {
        if separators == field {
            return index + 1;
        }
        match character {
            '"' => is_quoted = !is_quoted,
            _ if character == separator && !is_quoted => separators += 1,
            _ => {}
        }
    }
    line.chars().count() + 1
}

/// Line of a position, from 1.
fn line_of(position: &csv::Position) -> usize {
    usize::try_from(position.line()).unwrap_or(usize::MAX)
}
