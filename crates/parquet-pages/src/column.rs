//! Columns in which no value is missing: numbers and instants as they are computed with, texts by their places in a dictionary.
//!
//! Recorders' columns nearly always are of that kind. What is otherwise is an error here, upon which a column can be read by a
//! decoder of columns of any kind.

use crate::places::{Dictionary, Places};
use crate::{Damage, Kind, all_are_there, without_levels};

/// How a value is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A number of double precision.
    Double,
    /// A number of single precision.
    Float,
    /// A whole number of 32 bits, divided by this.
    Int32(f64),
    /// A whole number of 64 bits, divided by this. One that double precision does not hold to the last digit is an error.
    Int64(f64),
    /// A whole number of 64 bits, of so many nanoseconds each.
    Nanoseconds(i64),
    /// A text, by its place in the dictionary.
    Text,
}

/// Values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers.
    Numbers(Vec<f64>),
    /// Nanoseconds.
    Nanoseconds(Vec<i64>),
    /// Places in the dictionary, each with the number of values that it holds for.
    Texts(Vec<(u32, usize)>),
}

/// A column that is being read. Its pages are given to it one after the other: each is written into [`Column::page`], then begun.
#[derive(Debug)]
pub struct Column {
    form: Form,
    has_levels: bool,
    page: Vec<u8>,
    /// Values of the page that were not taken.
    left: usize,
    /// Whether every number of the dictionary is finite.
    is_finite: bool,
    way: Way,
    dictionary: Entries,
}

/// How the values of a page are written.
#[derive(Clone, Copy, Debug)]
enum Way {
    /// As they are, from this byte on.
    Plain(usize),
    Places(Places),
}

#[derive(Debug)]
enum Entries {
    None,
    Numbers(Dictionary<f64>),
    Nanoseconds(Dictionary<i64>),
    /// The page, and where the texts are in it.
    Texts(Vec<u8>, Vec<core::ops::Range<usize>>),
}

/// Encodings by their number in `parquet.thrift`.
const PLAIN: u32 = 0;
const PLAIN_DICTIONARY: u32 = 2;
const RUNS: u32 = 3;
const RUNS_DICTIONARY: u32 = 8;

/// Up to here every whole number is one of double precision: 2^53.
const LARGEST_EXACT: i64 = 1 << f64::MANTISSA_DIGITS;

impl Column {
    /// Of values of this form; with `has_levels`, of a column that could lack some.
    #[must_use]
    pub const fn new(form: Form, has_levels: bool) -> Self {
        let way = Way::Plain(0);
        Self {
            form,
            has_levels,
            page: Vec::new(),
            left: 0,
            is_finite: false,
            way,
            dictionary: Entries::None,
        }
    }

    /// The next page, unpacked, is written here before it is begun.
    pub const fn page(&mut self) -> &mut Vec<u8> {
        &mut self.page
    }

    /// Begins the page that was written.
    ///
    /// # Errors
    /// [`Damage`] for one that is damaged, lacks a value, or is of an encoding that is not read here.
    pub fn begin(&mut self, kind: Kind) -> Result<(), Damage> {
        let (values, encoding, from) = match kind {
            Kind::Other => return Ok(()),
            Kind::Dictionary { values, encoding, .. } => {
                return self.begin_dictionary(values, encoding);
            }
            Kind::Data { values, encoding, definition_encoding, .. } => {
                let from = match (self.has_levels, definition_encoding) {
                    (false, _) => Some(0),
                    (true, RUNS) => without_levels(&self.page, values),
                    (true, _) => None,
                };
                (values, encoding, from.ok_or(Damage::Otherwise("levels"))?)
            }
            Kind::DataV2 {
                values,
                nulls: 0,
                encoding,
                definition_bytes,
                repetition_bytes: 0,
                ..
            } => {
                let from = definition_bytes as usize;
                let levels = self.page.get(..from).ok_or(Damage::EndsEarly)?;
                // That no value is missing the header states; what the levels say decides.
                let is_whole =
                    if self.has_levels { all_are_there(levels, values) } else { from == 0 };
                if !is_whole {
                    return Err(Damage::Otherwise("levels"));
                }
                (values, encoding, from)
            }
            Kind::DataV2 { .. } => return Err(Damage::Otherwise("levels")),
        };
        self.way = match encoding {
            PLAIN if self.form != Form::Text => Way::Plain(from),
            PLAIN_DICTIONARY | RUNS_DICTIONARY => Way::Places(Places::begin(&self.page, from)?),
            _ => return Err(Damage::Otherwise("encoding")),
        };
        self.left = values as usize;
        Ok(())
    }

    /// Whether every number of the page is known to be finite: each of its dictionary is.
    #[must_use]
    pub const fn is_finite(&self) -> bool {
        self.is_finite && matches!(self.way, Way::Places(_))
    }

    fn begin_dictionary(&mut self, values: u32, encoding: u32) -> Result<(), Damage> {
        if !matches!(self.dictionary, Entries::None)
            || !matches!(encoding, PLAIN | PLAIN_DICTIONARY)
        {
            return Err(Damage::Otherwise("dictionary"));
        }
        let count = values as usize;
        self.dictionary = match self.form {
            Form::Text => {
                let texts = texts_of(&self.page, values).ok_or(Damage::EndsEarly)?;
                Entries::Texts(core::mem::take(&mut self.page), texts)
            }
            Form::Nanoseconds(each) => {
                let mut entries = Vec::new();
                let bytes = first(&self.page, count * self.form.bytes())?;
                append_nanoseconds(bytes, each, &mut entries)?;
                Entries::Nanoseconds(Dictionary::new(entries))
            }
            form => {
                let mut entries = Vec::new();
                append_numbers(form, first(&self.page, count * form.bytes())?, &mut entries)?;
                self.is_finite = entries.iter().all(|value| value.is_finite());
                Entries::Numbers(Dictionary::new(entries))
            }
        };
        Ok(())
    }

    /// Room for so many values of its kind.
    #[must_use]
    pub fn values(&self, count: usize) -> Values {
        match self.form {
            Form::Text => Values::Texts(Vec::new()),
            Form::Nanoseconds(_) => Values::Nanoseconds(Vec::with_capacity(count)),
            _ => Values::Numbers(Vec::with_capacity(count)),
        }
    }

    /// A text of the dictionary.
    #[must_use]
    pub fn text(&self, place: u32) -> Option<&[u8]> {
        match &self.dictionary {
            Entries::Texts(page, texts) => page.get(texts.get(place as usize)?.clone()),
            _ => None,
        }
    }

    /// Adds the next values of the page, so many at most; gives how many there were: none at the end of the page.
    ///
    /// # Errors
    /// [`Damage`] for a page that is damaged.
    // Inlined into a caller that is compiled for size, it would be compiled so too: 2 % more instructions of a whole run.
    #[inline(never)]
    pub fn append(&mut self, most: usize, values: &mut Values) -> Result<usize, Damage> {
        let count = most.min(self.left);
        let page = self.page.as_slice();
        match (&mut self.way, values, &self.dictionary) {
            _ if count == 0 => {}
            (Way::Plain(at), Values::Numbers(values), _) => {
                let bytes = plain(page, at, count * self.form.bytes())?;
                append_numbers(self.form, bytes, values)?;
            }
            (Way::Plain(at), Values::Nanoseconds(values), _) => {
                let Form::Nanoseconds(each) = self.form else { return Err(Damage::EndsEarly) };
                let bytes = plain(page, at, count * self.form.bytes())?;
                append_nanoseconds(bytes, each, values)?;
            }
            (Way::Places(places), Values::Numbers(values), Entries::Numbers(dictionary)) => {
                dictionary.append(places, page, count, values)?;
            }
            (Way::Places(places), Values::Nanoseconds(values), Entries::Nanoseconds(entries)) => {
                entries.append(places, page, count, values)?;
            }
            (Way::Places(places), Values::Texts(runs), Entries::Texts(_, texts)) => {
                places.append_runs(page, count, texts.len(), runs)?;
            }
            _ => return Err(Damage::Otherwise("dictionary")),
        }
        self.left -= count;
        Ok(count)
    }
}

impl Form {
    /// Bytes of a value.
    const fn bytes(self) -> usize {
        match self {
            Self::Float | Self::Int32(_) => 4,
            Self::Double | Self::Int64(_) | Self::Nanoseconds(_) | Self::Text => 8,
        }
    }
}

fn first(page: &[u8], bytes: usize) -> Result<&[u8], Damage> {
    page.get(..bytes).ok_or(Damage::EndsEarly)
}

/// So many bytes of a page, and on behind them.
fn plain<'p>(page: &'p [u8], at: &mut usize, bytes: usize) -> Result<&'p [u8], Damage> {
    let found = first(page.get(*at..).ok_or(Damage::EndsEarly)?, bytes)?;
    *at += bytes;
    Ok(found)
}

fn append_numbers(form: Form, bytes: &[u8], values: &mut Vec<f64>) -> Result<(), Damage> {
    let (eights, _) = bytes.as_chunks::<8>();
    let (fours, _) = bytes.as_chunks::<4>();
    match form {
        Form::Double => values.extend(eights.iter().map(|eight| f64::from_le_bytes(*eight))),
        Form::Float => {
            values.extend(fours.iter().map(|four| f64::from(f32::from_le_bytes(*four))));
        }
        Form::Int32(by) => {
            values.extend(fours.iter().map(|four| f64::from(i32::from_le_bytes(*four)) / by));
        }
        #[expect(clippy::cast_precision_loss, reason = "those above 2^53 are refused")]
        Form::Int64(by) => {
            refuse_beyond(LARGEST_EXACT, eights, "whole numbers")?;
            values.extend(eights.iter().map(|eight| i64::from_le_bytes(*eight) as f64 / by));
        }
        Form::Nanoseconds(_) | Form::Text => {}
    }
    Ok(())
}

/// Refuses whole numbers of which one is farther from zero than this.
fn refuse_beyond(farthest: i64, eights: &[[u8; 8]], what: &'static str) -> Result<(), Damage> {
    // Counted, without a way out of the loop: nearly always there is none.
    let far = |count: i64| u64::from(!(-farthest..=farthest).contains(&count));
    if eights.iter().map(|eight| far(i64::from_le_bytes(*eight))).sum::<u64>() > 0 {
        return Err(Damage::Otherwise(what));
    }
    Ok(())
}

fn append_nanoseconds(bytes: &[u8], each: i64, values: &mut Vec<i64>) -> Result<(), Damage> {
    let (eights, _) = bytes.as_chunks::<8>();
    refuse_beyond(i64::MAX / each.max(1), eights, "instants")?;
    values.extend(eights.iter().map(|eight| i64::from_le_bytes(*eight).wrapping_mul(each)));
    Ok(())
}

/// The texts of a dictionary's page, each behind its length in four bytes: where they are in it.
fn texts_of(page: &[u8], count: u32) -> Option<Vec<core::ops::Range<usize>>> {
    let mut texts = Vec::new();
    let mut at = 0;
    for _ in 0..count {
        let (length, _) = page.get(at..)?.split_first_chunk::<4>()?;
        let start = at + 4;
        at = start.checked_add(usize::try_from(u32::from_le_bytes(*length)).ok()?)?;
        if at > page.len() {
            return None;
        }
        texts.push(start..at);
    }
    Some(texts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dictionaries_of_texts() {
        let page = [1, 0, 0, 0, b'a', 0, 0, 0, 0, 2, 0, 0, 0, b'b', b'c'];
        assert_eq!(texts_of(&page, 3).unwrap(), [4..5, 9..9, 13..15]);
        // More than there are; one that is longer than the page.
        assert!(texts_of(&page, 4).is_none());
        assert!(texts_of(&[9, 0, 0, 0, b'a'], 1).is_none());
    }

    fn data(values: u32, encoding: u32) -> Kind {
        Kind::Data { values, encoding, definition_encoding: RUNS, repetition_encoding: RUNS }
    }

    fn read(column: &mut Column, page: &[u8], kind: Kind) -> Result<Values, Damage> {
        page.clone_into(column.page());
        column.begin(kind)?;
        let mut values = column.values(9);
        while column.append(2, &mut values)? > 0 {}
        Ok(values)
    }

    /// Oracle: what was written.
    #[test]
    fn values_of_every_form() {
        let plain = |form, page: &[u8], count| {
            read(&mut Column::new(form, false), page, data(count, PLAIN)).unwrap()
        };
        let bytes = |values: [f64; 3]| values.map(f64::to_le_bytes).concat();
        let numbers = [0.5, -1e300, 3.0];
        assert_eq!(plain(Form::Double, &bytes(numbers), 3), Values::Numbers(numbers.to_vec()));
        let singles = [0.5_f32, -2.25].map(f32::to_le_bytes).concat();
        assert_eq!(plain(Form::Float, &singles, 2), Values::Numbers(vec![0.5, -2.25]));
        let counts = [7_i32, -4].map(i32::to_le_bytes).concat();
        assert_eq!(plain(Form::Int32(2.0), &counts, 2), Values::Numbers(vec![3.5, -2.0]));
        let counts = [7_i64, -4].map(i64::to_le_bytes).concat();
        assert_eq!(plain(Form::Int64(1.0), &counts, 2), Values::Numbers(vec![7.0, -4.0]));
        // 123.45 by two digits: multiplied by 0.01 it is 123.45000000000002.
        let decimal = plain(Form::Int64(100.0), &12_345_i64.to_le_bytes(), 1);
        assert_eq!(decimal, Values::Numbers(vec![123.45]));
        let long = ((1_i64 << 53) + 1).to_le_bytes();
        let refused = read(&mut Column::new(Form::Int64(1.0), false), &long, data(1, PLAIN));
        assert!(matches!(refused, Err(Damage::Otherwise(_))));
        let instants = plain(Form::Nanoseconds(1000), &counts, 2);
        assert_eq!(instants, Values::Nanoseconds(vec![7000, -4000]));
    }

    #[test]
    fn texts_by_places_behind_levels() {
        let mut column = Column::new(Form::Text, true);
        let dictionary = [1, 0, 0, 0, b'a', 1, 0, 0, 0, b'b'];
        let kind = Kind::Dictionary { values: 2, encoding: PLAIN, is_sorted: false };
        read(&mut column, &dictionary, kind).unwrap();
        // Levels: five times 1. Places of one bit: three times 1, then bits 0 1.
        let page = [2, 0, 0, 0, 10, 1, 1, 6, 1, 3, 0b10];
        let texts = read(&mut column, &page, data(5, RUNS_DICTIONARY)).unwrap();
        assert_eq!(texts, Values::Texts(vec![(1, 3), (0, 1), (1, 1)]));
        assert_eq!((column.text(1), column.text(2)), (Some(&b"b"[..]), None));
        // The same with the levels of the second version, which are behind no length.
        let page = [10, 1, 1, 6, 1, 3, 0b10];
        let v2 = |nulls| Kind::DataV2 {
            values: 5,
            nulls,
            rows: 5,
            encoding: RUNS_DICTIONARY,
            definition_bytes: 2,
            repetition_bytes: 0,
            is_packed: true,
        };
        assert_eq!(read(&mut column, &page, v2(0)).unwrap(), texts);
        assert_eq!(read(&mut column, &page, v2(1)), Err(Damage::Otherwise("levels")));
    }

    /// The header of a page of the second version states that no value is missing, and its levels say otherwise: a value that is not
    /// there, one level too few, packed bits; levels of a column that has none, and levels longer than the page.
    #[test]
    fn levels_that_contradict_their_header_are_refused() {
        let v2 = |definition_bytes| Kind::DataV2 {
            values: 2,
            nulls: 0,
            rows: 2,
            encoding: PLAIN,
            definition_bytes,
            repetition_bytes: 0,
            is_packed: true,
        };
        let read = |levels: &[u8], has_levels, bytes| {
            let page = [levels, &[0.5_f64, 3.0].map(f64::to_le_bytes).concat()].concat();
            read(&mut Column::new(Form::Double, has_levels), &page, v2(bytes))
        };
        let both = Values::Numbers(vec![0.5, 3.0]);
        assert_eq!(read(&[4, 1], true, 2), Ok(both.clone()));
        assert_eq!(read(&[], false, 0), Ok(both));
        for levels in [[4, 0], [2, 1], [3, 0b11]] {
            assert_eq!(read(&levels, true, 2), Err(Damage::Otherwise("levels")), "{levels:?}");
        }
        assert_eq!(read(&[], true, 0), Err(Damage::Otherwise("levels")));
        assert_eq!(read(&[4, 1], false, 2), Err(Damage::Otherwise("levels")));
        assert_eq!(read(&[4, 1], true, 99), Err(Damage::EndsEarly));
    }

    #[test]
    fn what_is_read_in_another_way() {
        let refused =
            |form, page: &[u8], kind| read(&mut Column::new(form, true), page, kind).unwrap_err();
        // Two levels of three; levels of packed bits; texts without a dictionary; a place in none; another encoding.
        let two = [2, 0, 0, 0, 4, 1, 0, 0, 0, 0, 0, 0, 0, 0];
        assert_eq!(refused(Form::Double, &two, data(3, PLAIN)), Damage::Otherwise("levels"));
        assert_eq!(refused(Form::Text, &two, data(2, PLAIN)), Damage::Otherwise("encoding"));
        assert_eq!(refused(Form::Double, &two, data(2, 9)), Damage::Otherwise("encoding"));
        let places = refused(Form::Double, &two, data(2, RUNS_DICTIONARY));
        assert_eq!(places, Damage::Otherwise("dictionary"));
        // One value where the header states two; an instant that no nanoseconds reach.
        assert_eq!(refused(Form::Double, &two, data(2, PLAIN)), Damage::EndsEarly);
        let far = [[2, 0, 0, 0, 2, 1].as_slice(), &i64::MAX.to_le_bytes()].concat();
        let far = refused(Form::Nanoseconds(1000), &far, data(1, PLAIN));
        assert_eq!(far, Damage::Otherwise("instants"));
    }
}
