//! The rows of a piece of a recording: numbers by column, and what is to be said of the rows that have none.
//!
//! A piece is read without knowing what comes before it, so that pieces can be read at the same time: instants are kept
//! as instants, and which flight a row belongs to is decided where the rows are put together.

mod times;

use std::sync::Arc;

use flight::Timestamp;

use super::instants::InstantCache;
use super::line_numbers::LineNumbers;
use super::{Layout, Text, line_of, means_nothing, reader, settle};
use crate::mapping::file::BadRows;
use crate::mapping::numbers::Block;
use crate::mapping::pieces::{Content, Piece};
use crate::mapping::plan::{Input, TimeForm};
use crate::number::{self, without_groups};
use crate::refusal::{Found, Refusal, RefusalKind};

/// The rows of a piece.
#[derive(Debug)]
pub struct Rows {
    pub(super) piece: Piece,
    pub(super) times: Times,
    /// `[input][row]`, while rows are read; NaN where there is no number.
    pub(super) numbers: Vec<Vec<f64>>,
    /// The same when all are read.
    pub(super) block: Block,
    /// Physical line of each row.
    pub(super) lines: LineNumbers,
    /// What comes before a row, in order.
    pub(super) events: Vec<(usize, Event)>,
    /// The last flight met, for its texts.
    pub(super) texts: Option<Arc<[String; 3]>>,
    pub(super) cache: InstantCache,
}

/// Something that is no row of numbers.
#[derive(Debug)]
pub(super) enum Event {
    /// The rows from here on have these texts: aircraft, tail, flight.
    Texts(Arc<[String; 3]>),
    /// A line without a time.
    WithoutTime(usize),
    /// A line that cannot be read.
    Bad(Box<Refusal>),
}

/// Times of rows, in the form in which they were sent.
#[derive(Debug)]
pub(super) enum Times {
    /// Seconds since the origin that the mapping gives.
    Seconds(Vec<f64>),
    /// Seconds of the day.
    OfDay(Vec<f64>),
    Instants(Vec<Timestamp>),
    /// Nanoseconds since 1970.
    Nanoseconds(Vec<i64>),
}

impl Times {
    fn new(form: &TimeForm) -> Self {
        match form {
            TimeForm::Seconds { .. } => Self::Seconds(Vec::new()),
            TimeForm::TimeOfDay { .. } => Self::OfDay(Vec::new()),
            TimeForm::Timestamp { .. } => Self::Instants(Vec::new()),
        }
    }

    pub(super) const fn len(&self) -> usize {
        match self {
            Self::Seconds(times) | Self::OfDay(times) => times.len(),
            Self::Instants(times) => times.len(),
            Self::Nanoseconds(times) => times.len(),
        }
    }
}

impl Layout {
    /// Reads the rows of a piece. With a mapping that refuses bad rows, it ends at the first one.
    pub(in crate::mapping) fn rows(&self, piece: Piece) -> Rows {
        let mut rows = self.read_rows(piece);
        let numbers = core::mem::take(&mut rows.numbers);
        if numbers.iter().any(|column| !column.is_empty()) {
            rows.block = Block::new(numbers);
        }
        rows
    }

    pub(super) fn read_rows(&self, mut piece: Piece) -> Rows {
        if let Some(batch) = piece.batch.take().and_then(Arc::into_inner) {
            // What is kept of a piece is counted, whatever its form.
            let bytes = batch.bytes();
            let mut rows = self.rows_of_batch(batch);
            rows.piece.bytes = bytes;
            return rows;
        }
        let text = match piece.content {
            Content::Rows(table) => return self.rows_of_table(*table, piece.first_line),
            Content::Lines { .. } => Arc::default(),
            Content::Text(ref text) => Arc::clone(text),
        };
        let mut rows = Rows::new(self, piece);
        if memchr::memchr(b'"', text.as_bytes()).is_some() || has_lone_carriage_return(&text) {
            rows.read_records(self, &text);
        } else {
            rows.read_lines(self, &text);
        }
        rows
    }
}

/// Whether a carriage return ends a line by itself.
fn has_lone_carriage_return(text: &str) -> bool {
    let bytes = text.as_bytes();
    memchr::memchr_iter(b'\r', bytes).any(|at| bytes.get(at + 1).is_some_and(|next| *next != b'\n'))
}

/// Where the fields of a record are in a text.
type Fields = Vec<core::ops::Range<usize>>;

/// Where the fields of a line are in its text, in which it begins at `start`.
///
/// Fields are a few bytes long, for which a search for each separator is slow: eight bytes are compared together as one
/// 64-bit word, in which a byte's highest bit is set where it is the separator.
fn split(line: &[u8], separator: u8, start: usize, fields: &mut Fields) {
    const EACH: u64 = 0x0101_0101_0101_0101;
    let pattern = EACH * u64::from(separator);
    let mut field = start;
    let mut push = |end: usize| {
        fields.push(field..end);
        field = end + 1;
    };
    let (words, rest) = line.as_chunks::<8>();
    for (index, word) in words.iter().enumerate() {
        let other = u64::from_le_bytes(*word) ^ pattern;
        let mut found = !(((other & (EACH * 0x7f)) + EACH * 0x7f) | other | (EACH * 0x7f));
        while found != 0 {
            push(start + 8 * index + (found.trailing_zeros() / 8) as usize);
            found &= found - 1;
        }
    }
    for (index, byte) in rest.iter().enumerate() {
        if *byte == separator {
            push(start + 8 * words.len() + index);
        }
    }
    push(start + line.len());
}

impl Rows {
    pub(super) fn new(layout: &Layout, piece: Piece) -> Self {
        Self {
            piece,
            times: Times::new(&layout.plan.time),
            numbers: vec![Vec::new(); layout.plan.inputs.len()],
            block: Block::default(),
            lines: LineNumbers::default(),
            events: Vec::new(),
            texts: None,
            cache: InstantCache::default(),
        }
    }

    /// Records without quotes: a line is a record.
    fn read_lines(&mut self, layout: &Layout, text: &str) {
        let form = layout.form();
        let mut fields = Fields::new();
        let (mut start, mut line) = (0, self.piece.first_line);
        while start < text.len() {
            let bytes = &text.as_bytes()[start..];
            let length = memchr::memchr(b'\n', bytes).unwrap_or(bytes.len());
            let end = start + length;
            let whole = text[start..end].trim_end_matches('\r');
            if !means_nothing(form, whole) {
                fields.clear();
                split(&bytes[..length], form.separator, start, &mut fields);
                let row = Row { layout, text, fields: &fields, line };
                if self.take(row).is_break() {
                    return;
                }
            }
            start = end + 1;
            line += 1;
        }
    }

    /// Records with quotes.
    fn read_records(&mut self, layout: &Layout, text: &str) {
        let mut reader = reader(layout.form(), text);
        let mut record = csv::StringRecord::new();
        // For text in memory that is UTF-8, and records of any length, no error is possible.
        while reader.read_record(&mut record).unwrap_or(false) {
            let line = settle(layout.form(), text, record.position().map_or(1, line_of));
            let fields: Fields =
                (0..record.len()).filter_map(|field| record.range(field)).collect();
            let line = line + self.piece.first_line - 1;
            let row = Row { layout, text: record.as_slice(), fields: &fields, line };
            if self.take(row).is_break() {
                return;
            }
        }
    }

    fn take(&mut self, row: Row<'_>) -> core::ops::ControlFlow<()> {
        let refusal = match self.add(row) {
            Ok(()) => return core::ops::ControlFlow::Continue(()),
            Err(refusal) => refusal,
        };
        self.events.push((self.times.len(), Event::Bad(Box::new(refusal))));
        match row.layout.plan.bad_rows {
            BadRows::Refuse => core::ops::ControlFlow::Break(()),
            BadRows::LeaveRowOut => core::ops::ControlFlow::Continue(()),
        }
    }

    fn add(&mut self, row: Row<'_>) -> Result<(), Refusal> {
        let layout = row.layout;
        if row.fields.len() != layout.columns {
            return Err(self.refuse_length(row));
        }
        if !row.is_wanted() {
            return Ok(());
        }
        let place = (row.line, &self.piece);
        let texts = [row.text(0, place)?, row.text(1, place)?, row.text(2, place)?];
        if self.texts.as_ref().is_none_or(|known| known.each_ref().map(String::as_str) != texts) {
            let texts = Arc::new(texts.map(str::to_owned));
            self.events.push((self.times.len(), Event::Texts(Arc::clone(&texts))));
            self.texts = Some(texts);
        }
        if row.is_not_available(row.field(layout.fields.time)) {
            self.events.push((self.times.len(), Event::WithoutTime(row.line)));
            return Ok(());
        }
        let before = self.times.len();
        let added = self.add_numbers(row).and_then(|()| self.add_time(row));
        if added.is_err() {
            for numbers in &mut self.numbers {
                numbers.truncate(before);
            }
        } else {
            self.lines.push(row.line);
        }
        added
    }

    fn add_numbers(&mut self, row: Row<'_>) -> Result<(), Refusal> {
        let inputs = row.layout.plan.inputs.iter().zip(&row.layout.fields.inputs);
        for (column, (input, field)) in self.numbers.iter_mut().zip(inputs) {
            column.push(row.number_of(*field, input, (row.line, &self.piece))?);
        }
        Ok(())
    }

    /// A row with too few or too many fields.
    fn refuse_length(&self, row: Row<'_>) -> Refusal {
        let (expected, found) = (row.layout.columns, row.fields.len());
        let line = self.piece.line(row.line);
        if found < expected {
            let kind = if self.piece.is_unfinished_at(row.line) {
                RefusalKind::LastRowUnfinished { expected }
            } else {
                RefusalKind::TooFewFields { expected }
            };
            let column = line.chars().count() + 1;
            return Refusal { line: row.line, column, found: Found::Fields(found), kind };
        }
        let kind = RefusalKind::TooManyFields { expected };
        row.layout.refuse_field((row.line, &line), expected, Found::Fields(found), kind)
    }
}

/// Where a row is: its line, in its piece.
type Place<'p> = (usize, &'p Piece);

#[derive(Clone, Copy)]
struct Row<'r> {
    layout: &'r Layout,
    text: &'r str,
    fields: &'r [core::ops::Range<usize>],
    line: usize,
}

impl<'r> Row<'r> {
    /// A field without the blanks around it.
    fn field(self, field: usize) -> &'r str {
        let text = &self.text[self.fields[field].clone()];
        let is_ink = |byte: Option<&u8>| byte.is_some_and(|byte| (0x21..0x80).contains(byte));
        let bytes = text.as_bytes();
        if is_ink(bytes.first()) && is_ink(bytes.last()) { text } else { text.trim() }
    }

    /// Whether every column that selects rows holds one of its texts.
    fn is_wanted(self) -> bool {
        let layout = self.layout;
        (layout.plan.only.iter().zip(&layout.fields.only))
            .all(|((_, texts), field)| texts.iter().any(|text| *text == self.field(*field)))
    }

    fn text(self, index: usize, place: Place<'_>) -> Result<&'r str, Refusal> {
        let (key, source) = &self.layout.fields.texts[index];
        let (value, field) = match source {
            Text::Constant(value) => (value.as_str(), 0),
            Text::Field(field) => (self.field(*field), *field),
        };
        if value.is_empty() {
            let kind = RefusalKind::SourceTextMissing { key };
            return Err(self.refuse(place, field, Found::text(""), kind));
        }
        Ok(value)
    }

    fn is_not_available(self, field: &str) -> bool {
        field.is_empty()
            || field.eq_ignore_ascii_case("nan")
            || self.layout.plan.not_available.iter().any(|text| text == field)
    }

    fn number_of(self, field: usize, input: &Input, place: Place<'_>) -> Result<f64, Refusal> {
        if !input.values.is_empty() {
            let text = self.field(field);
            if let Some((_, value)) = input.values.iter().find(|(known, _)| known == text) {
                return Ok(*value);
            }
        }
        let plan = &self.layout.plan;
        let is_plain =
            plan.decimal == '.' && plan.thousands.is_none() && plan.not_available.is_empty();
        let range = &self.fields[field];
        // Nearly every field; the bytes behind it are given too, of which eight are looked at together.
        if is_plain
            && let Some((value, rest)) = number::short(&self.text.as_bytes()[range.start..])
            && self.text.len() - rest.len() == range.end
        {
            return Ok(value);
        }
        self.number(field, &input.name, place)
    }

    fn number(self, field: usize, name: &str, place: Place<'_>) -> Result<f64, Refusal> {
        let sent = self.field(field);
        if self.is_not_available(sent) {
            return Ok(f64::NAN);
        }
        let plan = &self.layout.plan;
        let joined = plan.thousands.and_then(|mark| without_groups(sent, mark, plan.decimal));
        let text = joined.as_deref().unwrap_or(sent);
        // A point is then neither a decimal mark nor, where groups are not said to be, one between these.
        let with_point = (plan.decimal == ',')
            .then(|| if text.contains('.') { String::new() } else { text.replacen(',', ".", 1) });
        let text = with_point.as_deref().unwrap_or(text);
        // Other programs write the exponent's letter as a capital.
        number::whole(text.as_bytes())
            .or_else(|| {
                text.contains('E').then(|| number::whole(text.replacen('E', "e", 1).as_bytes()))?
            })
            .ok_or_else(|| {
                let kind = RefusalKind::SourceNotANumber { name: name.to_owned() };
                self.refuse(place, field, Found::text(sent), kind)
            })
    }

    fn refuse(
        self,
        (line, piece): Place<'_>,
        field: usize,
        found: Found,
        kind: RefusalKind,
    ) -> Refusal {
        self.layout.refuse_field((line, &piece.line(line)), field, found, kind)
    }
}

/// Seconds from an origin beyond which a number is in another unit than seconds.
pub(super) const FARTHEST_S: f64 = 2e11;
