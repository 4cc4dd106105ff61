//! The buffers of a record batch, and the cells in them.

use core::ops::Range;
use std::collections::BTreeMap;
use std::io::Read;

use report::mapping::{BatchColumn, NO_INSTANT, date_text, text_runs, time_of_day_text};

use super::fields::{Field, Kind, Number};
use super::flatbuffer::{Table, Vector};

/// Largest buffer that is unpacked, bytes.
const MOST_BYTES: u64 = 1 << 31;
const LZ4_FRAME: u8 = 0;
const ZSTANDARD: u8 = 1;

/// The buffers of a record batch, taken field by field.
pub(super) struct Buffers<'b> {
    pub(super) rows: usize,
    body: &'b [u8],
    places: Vector<'b>,
    /// Numbers of buffers of the columns of views.
    of_views: Option<Vector<'b>>,
    codec: Option<u8>,
    next: usize,
    next_view: usize,
}

/// A column of a record batch.
pub(super) struct Column {
    kind: Kind,
    /// A bit for each row, 1 where there is a value; empty where all have one.
    validity: Vec<u8>,
    data: Vec<u8>,
    /// Of texts: the bytes that offsets or views lead to.
    texts: Vec<Vec<u8>>,
}

impl<'b> Buffers<'b> {
    pub(super) fn new(batch: Table<'b>, body: &'b [u8]) -> Option<Self> {
        let rows = usize::try_from(batch.long(0).unwrap_or(0)).ok()?;
        // Without columns there are no buffers.
        let places = batch.vector(2)?;
        let codec = batch.table(3).map(|form| form.byte(0).unwrap_or(LZ4_FRAME));
        let of_views = batch.vector(4);
        Some(Self { rows, body, places, of_views, codec, next: 0, next_view: 0 })
    }

    /// The column of a field.
    pub(super) fn take(&mut self, field: &Field) -> Result<Column, String> {
        let damaged = || format!("the buffers of column {:?} cannot be read", field.name);
        let kind = field.kind;
        if !field.is_read() {
            return Err(format!("column {:?} is of a type that is not read", field.name));
        }
        let empty = Column { kind, validity: Vec::new(), data: Vec::new(), texts: Vec::new() };
        if kind == Kind::Null {
            return Ok(empty);
        }
        let validity = self.buffer().ok_or_else(damaged)?;
        let data = self.buffer().ok_or_else(damaged)?;
        let texts = match kind {
            Kind::Text(_) => 1,
            Kind::View => self.views().ok_or_else(damaged)?,
            _ => 0,
        };
        let texts = (0..texts).map(|_| self.buffer().ok_or_else(damaged));
        let texts = texts.collect::<Result<_, _>>()?;
        Ok(Column { validity, data, texts, ..empty })
    }

    /// Passes over a field.
    pub(super) fn skip(&mut self, field: &Field) -> Result<(), String> {
        self.next += field.extent.buffers;
        for _ in 0..field.extent.views {
            let views = self.views().ok_or_else(|| "a batch of views is damaged".to_owned())?;
            self.next += views;
        }
        Ok(())
    }

    fn views(&mut self) -> Option<usize> {
        let count = self.of_views?.long(self.next_view)?;
        self.next_view += 1;
        usize::try_from(count).ok()
    }

    /// The next buffer, unpacked.
    fn buffer(&mut self) -> Option<Vec<u8>> {
        let (offset, length) = self.places.pair(self.next)?;
        self.next += 1;
        let offset = usize::try_from(offset).ok()?;
        let bytes = self.body.get(offset..offset.checked_add(usize::try_from(length).ok()?)?)?;
        let Some(codec) = self.codec else { return Some(bytes.to_vec()) };
        if bytes.is_empty() {
            return Some(Vec::new());
        }
        let (length, packed) = bytes.split_first_chunk::<8>()?;
        let length = i64::from_le_bytes(*length);
        // -1: not packed, because it would not become shorter.
        if length == -1 {
            return Some(packed.to_vec());
        }
        let length = u64::try_from(length).ok().filter(|length| *length <= MOST_BYTES)?;
        let mut unpacked = Vec::new();
        let read = match codec {
            LZ4_FRAME => {
                lz4_flex::frame::FrameDecoder::new(packed).take(length).read_to_end(&mut unpacked)
            }
            ZSTANDARD => zstd::stream::read::Decoder::new(packed)
                .ok()?
                .take(length)
                .read_to_end(&mut unpacked),
            _ => return None,
        };
        (read.ok()? as u64 == length).then_some(unpacked)
    }
}

impl Column {
    /// Cells of these rows; `None` where the column is damaged.
    pub(super) fn cells(
        &self,
        rows: Range<usize>,
        dictionaries: &BTreeMap<i64, Vec<String>>,
    ) -> Option<BatchColumn> {
        let count = rows.len();
        Some(match self.kind {
            Kind::Null => BatchColumn::Numbers(vec![f64::NAN; count]),
            Kind::Number(form) => BatchColumn::Numbers(self.numbers(rows, form)?),
            Kind::Flag => {
                let flag = |row: usize| Some(f64::from(u8::from(bit(&self.data, row)?)));
                let values = rows.map(|row| if self.has(row) { flag(row) } else { Some(f64::NAN) });
                BatchColumn::Numbers(values.collect::<Option<_>>()?)
            }
            Kind::Instant(each) => BatchColumn::Instants(self.nanoseconds(rows, each)?),
            Kind::LocalTime(each) => BatchColumn::LocalTimes(self.nanoseconds(rows, each)?),
            Kind::TimeOfDay(each, width) => {
                texts_of(self.counts(rows, width)?, |count| time_of_day_text(count, each))
            }
            Kind::Date(4) => texts_of(self.counts(rows, 4)?, |days| date_text(days * 86_400)),
            Kind::Date(_) => texts_of(self.counts(rows, 8)?, |count| date_text(count / 1000)),
            Kind::Text(_) | Kind::View => BatchColumn::Texts(text_runs(self.texts(rows)?)),
            Kind::Dictionary { index, number, .. } => {
                let texts = dictionaries.get(&number)?;
                let is_signed = matches!(index, Number::Signed(_));
                let text = |row: usize| {
                    if !self.has(row) {
                        return Some(String::new());
                    }
                    let place = integer(&self.data, row, index.width(), is_signed)?;
                    texts.get(usize::try_from(place).ok()?).cloned()
                };
                let texts: Option<Vec<String>> = rows.map(text).collect();
                BatchColumn::Texts(text_runs(texts?))
            }
            Kind::Other => return None,
        })
    }

    /// Texts of these rows, empty where there is none.
    pub(super) fn texts(&self, rows: Range<usize>) -> Option<Vec<String>> {
        let text = |row: usize| {
            if !self.has(row) {
                return Some(String::new());
            }
            let bytes = match self.kind {
                Kind::View => self.view(row)?,
                Kind::Text(width) => {
                    let offset =
                        |row: usize| usize::try_from(integer(&self.data, row, width, true)?).ok();
                    self.texts.first()?.get(offset(row)?..offset(row + 1)?)?
                }
                _ => return None,
            };
            Some(String::from_utf8_lossy(bytes).into_owned())
        };
        rows.map(text).collect()
    }

    /// A text of up to twelve bytes is in its view; a longer one is where the view says.
    fn view(&self, row: usize) -> Option<&[u8]> {
        const INLINE: usize = 12;
        let view = self.data.get(16 * row..16 * row + 16)?;
        let length = usize::try_from(integer(view, 0, 4, true)?).ok()?;
        if length <= INLINE {
            return view.get(4..4 + length);
        }
        let buffer = usize::try_from(integer(view, 2, 4, true)?).ok()?;
        let start = usize::try_from(integer(view, 3, 4, true)?).ok()?;
        self.texts.get(buffer)?.get(start..start.checked_add(length)?)
    }

    fn has(&self, row: usize) -> bool {
        self.validity.is_empty() || bit(&self.validity, row).unwrap_or(false)
    }

    fn numbers(&self, rows: Range<usize>, form: Number) -> Option<Vec<f64>> {
        let width = form.width();
        let bytes = self.data.get(width * rows.start..width * rows.end)?;
        #[expect(clippy::cast_precision_loss, reason = "counts of recorders are below 2^53")]
        let mut values: Vec<f64> = match form {
            Number::Double => {
                bytes.as_chunks::<8>().0.iter().map(|word| f64::from_le_bytes(*word)).collect()
            }
            Number::Single => {
                let words = bytes.as_chunks::<4>().0.iter();
                words.map(|word| f64::from(f32::from_le_bytes(*word))).collect()
            }
            Number::Unsigned(8) => bytes
                .as_chunks::<8>()
                .0
                .iter()
                .map(|word| u64::from_le_bytes(*word) as f64)
                .collect(),
            Number::Signed(_) | Number::Unsigned(_) => {
                let is_signed = matches!(form, Number::Signed(_));
                let value = |row| integer(bytes, row, width, is_signed).map(|value| value as f64);
                (0..rows.len()).map(value).collect::<Option<_>>()?
            }
        };
        if !self.validity.is_empty() {
            for (value, row) in values.iter_mut().zip(rows) {
                if !self.has(row) {
                    *value = f64::NAN;
                }
            }
        }
        Some(values)
    }

    fn nanoseconds(&self, rows: Range<usize>, each: i64) -> Option<Vec<i64>> {
        let nanoseconds = |count: i64| count.checked_mul(each);
        let nanoseconds = |count: Option<i64>| count.and_then(nanoseconds).unwrap_or(NO_INSTANT);
        Some(self.counts(rows, 8)?.into_iter().map(nanoseconds).collect())
    }

    fn counts(&self, rows: Range<usize>, width: usize) -> Option<Vec<Option<i64>>> {
        let count = |row: usize| {
            let count = integer(&self.data, row, width, true)?;
            Some(self.has(row).then_some(count))
        };
        rows.map(count).collect()
    }
}

fn bit(bytes: &[u8], row: usize) -> Option<bool> {
    Some(bytes.get(row / 8)? >> (row % 8) & 1 == 1)
}

/// A whole number of a row.
fn integer(bytes: &[u8], row: usize, width: usize, is_signed: bool) -> Option<i64> {
    let sent = bytes.get(width * row..width * row + width)?;
    let is_negative = is_signed && sent.last()? & 0x80 != 0;
    let mut word = [if is_negative { 0xff } else { 0 }; 8];
    word[..width].copy_from_slice(sent);
    Some(i64::from_le_bytes(word))
}

fn texts_of(counts: Vec<Option<i64>>, text: impl Fn(i64) -> String) -> BatchColumn {
    let texts = counts.into_iter().map(|count| count.map_or_else(String::new, &text));
    BatchColumn::Texts(text_runs(texts))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: all bits set are 2^64 − 1, next to 2^64 in double precision.
    #[test]
    fn the_largest_bit_of_an_unsigned_number_is_no_sign() {
        let data = [u64::MAX, 7].map(u64::to_le_bytes).concat();
        let kind = Kind::Number(Number::Unsigned(8));
        let column = Column { kind, validity: Vec::new(), data, texts: Vec::new() };
        let found = column.numbers(0..2, Number::Unsigned(8)).unwrap();
        assert_eq!(found, [2_f64.powi(64), 7.0]);
    }
}
