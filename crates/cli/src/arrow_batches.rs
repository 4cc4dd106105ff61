//! Arrow IPC files and streams (Feather version 2): the rows of one record batch after the other, some thousands at a time.
//! Memory is that of a record batch as it is stored.
//!
//! A file says in its footer where batches are; a stream has one after the other.
//!
//! # Source
//! Apache Arrow, "Arrow Columnar Format", and `Message.fbs` and `Schema.fbs`, whose field numbers are those used here.

mod columns;
mod fields;
mod flatbuffer;

use std::collections::{BTreeMap, VecDeque};
use std::io::{Read, Seek, SeekFrom};

use report::mapping::{Batch, Source};

use columns::{Buffers, Column};
use fields::Field;
pub(crate) use fields::durations;
use flatbuffer::Table;

/// What a file begins with; a stream begins with a message.
const MAGIC: &[u8] = b"ARROW1";
/// What a file ends with: the length of its footer, and what it begins with.
const END_BYTES: i64 = 10;
/// What a message begins with.
const CONTINUATION: [u8; 4] = [0xff; 4];
/// Rows that are given at a time.
const ROWS_AT_ONCE: usize = 1 << 14;
/// Largest message, bytes: a small file can claim any length.
const MOST_BYTES: i64 = 1 << 31;

const SCHEMA: u8 = 1;
const DICTIONARY_BATCH: u8 = 2;
const RECORD_BATCH: u8 = 3;

/// Whether these are the first bytes of an Arrow file or stream.
pub(crate) fn is_arrow(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC) || bytes.starts_with(&CONTINUATION)
}

/// An Arrow file or stream as a recording.
///
/// # Errors
/// Why it is not read.
pub(crate) fn source(file: impl Read + Seek + 'static) -> Result<Source<'static>, String> {
    let mut stream = Stream::begin(file)?;
    let fields = &stream.fields;
    let names = fields.iter().map(|field| field.name.clone()).collect();
    let is_unread = |place: &usize| !fields[*place].is_read();
    let unread = (0..fields.len()).filter(is_unread).collect();
    let batches = move |wanted: &[usize]| stream.next_batch(wanted);
    Ok(Source::table(names, unread, Box::new(batches)))
}

/// A stream of messages, and the record batch that is being given.
struct Stream<R> {
    source: R,
    /// Of a file, where the messages are that have not been read.
    blocks: Option<VecDeque<u64>>,
    fields: Vec<Field>,
    /// Texts of dictionaries by their number.
    dictionaries: BTreeMap<i64, Vec<String>>,
    columns: Vec<(usize, Column)>,
    rows: usize,
    given: usize,
}

/// The metadata and the body of a message.
struct Message {
    metadata: Vec<u8>,
    body: Vec<u8>,
}

impl<R: Read + Seek> Stream<R> {
    fn begin(mut source: R) -> Result<Self, String> {
        let mut beginning = [0; MAGIC.len()];
        source.read_exact(&mut beginning).map_err(|error| error.to_string())?;
        if beginning == MAGIC {
            return Self::of_file(source);
        }
        source.rewind().map_err(|error| error.to_string())?;
        let mut beginning = [0; 4];
        source.read_exact(&mut beginning).map_err(|error| error.to_string())?;
        let message = rest_of_message(&mut source, beginning)?.ok_or("no schema")?;
        let schema = Table::root(&message.metadata)
            .filter(|message| message.byte(1) == Some(SCHEMA))
            .and_then(|message| message.table(2))
            .ok_or("the first message is no schema")?;
        Self::new(source, None, schema)
    }

    /// Not every program writes a file as a stream between its ends: what counts is the footer.
    fn of_file(mut source: R) -> Result<Self, String> {
        let failed = |error: std::io::Error| error.to_string();
        source.seek(SeekFrom::End(-END_BYTES)).map_err(failed)?;
        let end = read(&mut source, END_BYTES)?;
        let (length, magic) = end.split_first_chunk::<4>().ok_or("no end")?;
        if magic != MAGIC {
            return Err("it breaks off: its end is not that of an Arrow file".to_owned());
        }
        let length = i64::from(i32::from_le_bytes(*length));
        source.seek(SeekFrom::End(-END_BYTES - length.max(0))).map_err(failed)?;
        let footer = read(&mut source, length)?;
        let footer = Table::root(&footer).ok_or("the footer cannot be read")?;
        let schema = footer.table(1).ok_or("no schema")?;
        // Dictionaries before the batches that need them.
        let mut blocks = VecDeque::new();
        for vector in [footer.vector(2), footer.vector(3)].into_iter().flatten() {
            for element in 0..vector.length {
                let place = vector.block(element).and_then(|place| u64::try_from(place).ok());
                blocks.push_back(place.ok_or("the footer is damaged")?);
            }
        }
        Self::new(source, Some(blocks), schema)
    }

    fn new(source: R, blocks: Option<VecDeque<u64>>, schema: Table<'_>) -> Result<Self, String> {
        // Big-endian files exist in the format's description only.
        if schema.short(0).unwrap_or(0) != 0 {
            return Err("big-endian numbers are not read".to_owned());
        }
        let fields = fields::of_schema(schema).ok_or("the schema cannot be read")?;
        let dictionaries = BTreeMap::new();
        Ok(Self { source, blocks, fields, dictionaries, columns: Vec::new(), rows: 0, given: 0 })
    }

    fn next_batch(&mut self, wanted: &[usize]) -> Result<Option<Batch>, String> {
        while self.given == self.rows {
            // The batch before is given back before the next is read.
            self.columns.clear();
            if !self.read_message(wanted)? {
                return Ok(None);
            }
        }
        let rows = self.given..(self.given + ROWS_AT_ONCE).min(self.rows);
        self.given = rows.end;
        let cells = self.columns.iter().map(|(place, column)| {
            let cells = column.cells(rows.clone(), &self.dictionaries);
            let damaged = || format!("column {:?} is damaged", self.fields[*place].name);
            Ok((*place, cells.ok_or_else(damaged)?))
        });
        let columns = cells.collect::<Result<Vec<_>, String>>()?;
        Ok(Some(Batch { first_row: 0, rows: rows.len(), columns }))
    }

    /// Reads a message; false at the end.
    fn read_message(&mut self, wanted: &[usize]) -> Result<bool, String> {
        if let Some(blocks) = &mut self.blocks {
            let Some(place) = blocks.pop_front() else { return Ok(false) };
            self.source.seek(SeekFrom::Start(place)).map_err(|error| error.to_string())?;
        }
        let mut beginning = [0; 4];
        // A stream may end without saying so.
        if self.source.read(&mut beginning[..1]).map_err(|error| error.to_string())? == 0 {
            return Ok(false);
        }
        self.source.read_exact(&mut beginning[1..]).map_err(|error| error.to_string())?;
        let Some(message) = rest_of_message(&mut self.source, beginning)? else {
            return Ok(false);
        };
        let Message { metadata, body } = &message;
        let table = Table::root(metadata).ok_or("a message cannot be read")?;
        let header = table.table(2);
        match (table.byte(1), header) {
            (Some(RECORD_BATCH), Some(batch)) => {
                let mut buffers = Buffers::new(batch, body).ok_or("a batch cannot be read")?;
                self.rows = buffers.rows;
                self.given = 0;
                for (place, field) in self.fields.iter().enumerate() {
                    if wanted.contains(&place) {
                        self.columns.push((place, buffers.take(field)?));
                    } else {
                        buffers.skip(field)?;
                    }
                }
            }
            (Some(DICTIONARY_BATCH), Some(batch)) => self.add_dictionary(batch, body)?,
            _ => {}
        }
        Ok(true)
    }

    fn add_dictionary(&mut self, batch: Table<'_>, body: &[u8]) -> Result<(), String> {
        let number = batch.long(0).unwrap_or(0);
        let is_addition = batch.byte(2).unwrap_or(0) != 0;
        let of_dictionary = self.fields.iter().find_map(|field| field.dictionary_values(number));
        // One of another type than text: whoever wants its column is told.
        let Some(values) = of_dictionary else { return Ok(()) };
        let mut buffers = batch
            .table(1)
            .and_then(|batch| Buffers::new(batch, body))
            .ok_or("a dictionary cannot be read")?;
        let rows = buffers.rows;
        let texts = buffers.take(&values)?.texts(0..rows).ok_or("a dictionary is damaged")?;
        let known = self.dictionaries.entry(number).or_default();
        if !is_addition {
            known.clear();
        }
        known.extend(texts);
        Ok(())
    }
}

/// A message behind its first four bytes; `None` at the end of the stream.
fn rest_of_message(source: &mut impl Read, beginning: [u8; 4]) -> Result<Option<Message>, String> {
    let mut length = beginning;
    // Before version 0.15 messages began with their length.
    if beginning == CONTINUATION {
        source.read_exact(&mut length).map_err(|error| error.to_string())?;
    }
    let length = i64::from(i32::from_le_bytes(length));
    if length == 0 {
        return Ok(None);
    }
    let metadata = read(source, length)?;
    let body_length = Table::root(&metadata).and_then(|table| table.long(3)).unwrap_or(0);
    let body = read(source, body_length)?;
    Ok(Some(Message { metadata, body }))
}

fn read(source: &mut impl Read, length: i64) -> Result<Vec<u8>, String> {
    let wanted = u64::try_from(length)
        .ok()
        .filter(|_| length <= MOST_BYTES)
        .ok_or_else(|| format!("a message of {length} bytes"))?;
    let mut bytes = Vec::new();
    let read = source.take(wanted).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    if read as u64 == wanted { Ok(bytes) } else { Err("it ends within a message".to_owned()) }
}
