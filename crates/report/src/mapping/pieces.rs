//! The text of a recording, piece by piece: whole lines, so that each can be read by itself.

use std::borrow::Cow;
use std::fmt::{self, Debug, Formatter};
use std::io::{self, BufRead, Read};
use std::sync::Arc;

use flate2::bufread::MultiGzDecoder;

use super::in_memory::{Lines, TableRows};
use super::table::Batch;
use crate::decode::{self, MAXIMUM_TEXT_BYTES};
use crate::refusal::{Found, Refusal, RefusalKind};

/// About how long a piece is, bytes: long enough that the work on its ends does not count, short enough that several
/// fit into little memory.
const PIECE_BYTES: usize = 1 << 19;
const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Whole lines of a recording, or rows of a table.
#[derive(Clone, Debug, Default)]
pub struct Piece {
    pub(super) content: Content,
    /// Physical line from 1 of its first line.
    pub(super) first_line: usize,
    /// Its rows where they are no text; only until they are read.
    pub(super) batch: Option<Arc<Batch>>,
    /// What its rows take in memory, where they are no text, bytes.
    pub(super) bytes: usize,
}

/// What a piece holds.
#[derive(Clone, Debug)]
pub(super) enum Content {
    /// Text.
    Text(Arc<String>),
    /// Rows of a table.
    Rows(Box<TableRows>),
    /// Rows of a table that were read: their text, should a refusal need it.
    Lines {
        lines: Lines,
        /// How many.
        count: usize,
    },
}

impl Default for Content {
    fn default() -> Self {
        Self::Text(Arc::default())
    }
}

/// Reads a recording, plain or gzip, piece by piece.
#[derive(Debug)]
pub struct Pieces<R> {
    source: Source<R>,
    encoding: Option<Encoding>,
    /// Bytes that were read and not yet given.
    waiting: Vec<u8>,
    next_line: usize,
    has_ended: bool,
}

enum Source<R> {
    Plain(R),
    Gzip(Box<MultiGzDecoder<R>>),
    /// The line of names is waiting as text.
    Table(Box<dyn Iterator<Item = TableRows>>),
}

impl<R> Debug for Source<R> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Plain(_) => "Plain",
            Self::Gzip(_) => "Gzip",
            Self::Table(_) => "Table",
        })
    }
}

impl Pieces<Box<dyn BufRead>> {
    /// Of a table: the line of its columns' names as comma-separated text, then its rows.
    pub fn of_table(mut names: String, rows: impl Iterator<Item = TableRows> + 'static) -> Self {
        names.push('\n');
        Self {
            source: Source::Table(Box::new(rows)),
            encoding: None,
            waiting: names.into_bytes(),
            next_line: 1,
            has_ended: false,
        }
    }
}

/// How characters are written. Windows-1252 is told from UTF-8 piece by piece.
#[derive(Clone, Copy, Debug)]
enum Encoding {
    Bytes,
    Utf16(fn([u8; 2]) -> u16),
}

impl<R: BufRead> Pieces<R> {
    /// From the first byte of a recording on.
    ///
    /// # Errors
    /// [`Refusal`] for a source that cannot be read.
    pub fn new(mut source: R) -> Result<Self, Refusal> {
        let source = match source.fill_buf() {
            Ok(bytes) if bytes.starts_with(&GZIP_MAGIC) => {
                Source::Gzip(Box::new(MultiGzDecoder::new(source)))
            }
            Ok(_) => Source::Plain(source),
            Err(error) => return Err(unreadable(&[], error.kind())),
        };
        let waiting = Vec::new();
        Ok(Self { source, encoding: None, waiting, next_line: 1, has_ended: false })
    }

    /// The next whole lines; `None` after the last.
    ///
    /// # Errors
    /// [`Refusal`] for what is no text, or cannot be read or unpacked.
    pub fn next_piece(&mut self) -> Result<Option<Piece>, Refusal> {
        if let Source::Table(rows) = &mut self.source {
            if !self.waiting.is_empty() {
                let names = core::mem::take(&mut self.waiting);
                return self.piece(names, Encoding::Bytes).map(Some);
            }
            let first_line = self.next_line;
            return Ok(rows.next().map(|rows| {
                self.next_line += rows.rows;
                Piece { content: Content::Rows(Box::new(rows)), first_line, ..Piece::default() }
            }));
        }
        let mut wanted = PIECE_BYTES;
        loop {
            self.fill(wanted)?;
            let encoding = *self.encoding.get_or_insert_with(|| encoding_of(&self.waiting));
            let end = if self.has_ended {
                self.waiting.len()
            } else {
                last_line_end(&self.waiting, encoding)
            };
            if end == 0 && self.has_ended {
                return Ok(None);
            }
            if end > 0 {
                let rest = self.waiting.split_off(end);
                let bytes = core::mem::replace(&mut self.waiting, rest);
                return self.piece(bytes, encoding).map(Some);
            }
            if self.waiting.len() > MAXIMUM_TEXT_BYTES {
                let limit_bytes = MAXIMUM_TEXT_BYTES;
                return Err(self.refuse(RefusalKind::TooLarge { limit_bytes }));
            }
            wanted = self.waiting.len() + PIECE_BYTES;
        }
    }

    /// The first whole lines, unpacked, about this many bytes of them.
    pub(super) fn beginning(mut self, most_bytes: usize) -> Result<Vec<u8>, Refusal> {
        self.fill(most_bytes)?;
        if !self.has_ended {
            let end = last_line_end(&self.waiting, encoding_of(&self.waiting));
            self.waiting.truncate(end);
        }
        Ok(self.waiting)
    }

    fn fill(&mut self, wanted: usize) -> Result<(), Refusal> {
        let missing = wanted.saturating_sub(self.waiting.len());
        if self.has_ended || missing == 0 {
            return Ok(());
        }
        self.waiting.reserve(missing);
        let most = missing as u64;
        let read = match &mut self.source {
            Source::Plain(source) => source.take(most).read_to_end(&mut self.waiting),
            Source::Gzip(source) => source.take(most).read_to_end(&mut self.waiting),
            Source::Table(_) => Ok(0),
        };
        match (read, &self.source) {
            (Ok(read), _) => {
                self.has_ended = read < missing;
                Ok(())
            }
            (Err(error), Source::Plain(_) | Source::Table(_)) => {
                Err(unreadable(&self.waiting, error.kind()))
            }
            (Err(error), Source::Gzip(_)) if error.kind() == io::ErrorKind::UnexpectedEof => {
                Err(self.refuse(RefusalKind::GzipTruncated))
            }
            (Err(_), Source::Gzip(_)) => Err(self.refuse(RefusalKind::GzipCorrupt)),
        }
    }

    /// Refuses behind all that was read.
    fn refuse(&self, kind: RefusalKind) -> Refusal {
        let refusal = decode::refuse_at(&self.waiting, self.waiting.len(), Found::EndOfText, kind);
        Refusal { line: refusal.line + self.next_line - 1, ..refusal }
    }

    fn piece(&mut self, bytes: Vec<u8>, encoding: Encoding) -> Result<Piece, Refusal> {
        let text = match encoding {
            Encoding::Utf16(unit) => decode::utf_16(&bytes, unit),
            Encoding::Bytes => decode::piece(bytes).map_err(|refusal| Refusal {
                line: refusal.line + self.next_line - 1,
                ..refusal
            })?,
        };
        let first_line = self.next_line;
        let text = Arc::new(match text.strip_prefix(decode::BYTE_ORDER_MARK) {
            Some(rest) if first_line == 1 => rest.to_owned(),
            _ => text,
        });
        self.next_line += memchr::memchr_iter(b'\n', text.as_bytes()).count();
        Ok(Piece { content: Content::Text(text), first_line, ..Piece::default() })
    }
}

fn unreadable(bytes: &[u8], error: io::ErrorKind) -> Refusal {
    decode::refuse_at(bytes, bytes.len(), Found::EndOfText, RefusalKind::Unreadable { error })
}

fn encoding_of(bytes: &[u8]) -> Encoding {
    match bytes {
        [0xff, 0xfe, ..] => Encoding::Utf16(u16::from_le_bytes),
        [0xfe, 0xff, ..] => Encoding::Utf16(u16::from_be_bytes),
        _ => Encoding::Bytes,
    }
}

/// The end of the last whole line; 0 where there is none. A line end between quotes is part of a field.
fn last_line_end(bytes: &[u8], encoding: Encoding) -> usize {
    if let Encoding::Utf16(unit) = encoding {
        let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
        return units
            .rev()
            .position(|unit| unit == 0x0a)
            .map_or(0, |behind| bytes.len() / 2 * 2 - 2 * behind);
    }
    if memchr::memchr(b'"', bytes).is_none() {
        return memchr::memrchr(b'\n', bytes).map_or(0, |at| at + 1);
    }
    let (mut is_quoted, mut end) = (false, 0);
    for at in memchr::memchr2_iter(b'"', b'\n', bytes) {
        match bytes[at] {
            b'"' => is_quoted = !is_quoted,
            _ if is_quoted => {}
            _ => end = at + 1,
        }
    }
    end
}

impl From<Batch> for Piece {
    fn from(batch: Batch) -> Self {
        Self { first_line: batch.first_line(), batch: Some(Arc::new(batch)), ..Self::default() }
    }
}

impl Piece {
    /// A line of it, by its number in the recording.
    pub(super) fn line(&self, line: usize) -> Cow<'_, str> {
        let row = line - self.first_line;
        match &self.content {
            Content::Text(text) => text.lines().nth(row).unwrap_or_default().into(),
            Content::Rows(rows) => rows.text.line(row).into(),
            Content::Lines { lines, .. } => lines.line(row).into(),
        }
    }

    /// Whether the recording breaks off in a line: only its last piece may have no line end.
    pub(super) fn is_unfinished_at(&self, line: usize) -> bool {
        matches!(&self.content, Content::Text(text) if !text.ends_with('\n'))
            && line == self.end().0
    }

    /// Bytes of its text.
    pub(super) fn text_bytes(&self) -> usize {
        match &self.content {
            Content::Text(text) => text.len(),
            Content::Rows(_) | Content::Lines { .. } => 0,
        }
    }

    /// Bytes that it keeps.
    pub(super) fn kept_bytes(&self) -> usize {
        self.text_bytes() + self.bytes
    }

    /// Whether it has no line.
    pub(super) fn is_empty(&self) -> bool {
        match &self.content {
            Content::Text(text) => text.is_empty(),
            Content::Rows(rows) => rows.rows == 0,
            Content::Lines { count, .. } => *count == 0,
        }
    }

    /// The number of its last line, and that line's length in characters.
    pub(super) fn end(&self) -> (usize, usize) {
        let text = match &self.content {
            Content::Text(text) => text,
            Content::Rows(rows) => return self.end_of_rows(rows.rows),
            Content::Lines { count, .. } => return self.end_of_rows(*count),
        };
        let text = text.strip_suffix('\n').unwrap_or(text);
        let before = memchr::memchr_iter(b'\n', text.as_bytes()).count();
        let last = text.rsplit('\n').next().unwrap_or_default().trim_end_matches('\r');
        (self.first_line + before, last.chars().count())
    }

    fn end_of_rows(&self, count: usize) -> (usize, usize) {
        let last = self.first_line + count.saturating_sub(1);
        (last, self.line(last).chars().count())
    }
}
