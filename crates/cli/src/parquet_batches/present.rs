//! Columns in which no value is missing, read faster than columns of any kind.
//!
//! The decoder writes down a level for each value of a column that may lack some, and counts them, although recorders' columns
//! nearly always lack none: of such pages the levels are cut off here, so that the column is one that has to have its values. Texts
//! are read as their places in the dictionary of their column: tail and flight hold one of a few texts for thousands of rows.
//! Whatever is otherwise is an error here, upon which the column is read anew by the decoder alone.

use std::sync::{Arc, OnceLock};

use bytes::Bytes;
use parquet::basic::{Encoding, Type as PhysicalType};
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::column::reader::{ColumnReader, get_column_reader};
use parquet::errors::ParquetError;
use parquet::schema::types::{ColumnDescriptor, Type};

/// The texts of a dictionary, once its page has been met.
pub(super) type Texts = Arc<OnceLock<Vec<Bytes>>>;

/// A reader of a column's pages as of one whose values are all there, and the texts that its numbers stand for where it is one
/// of texts.
pub(super) fn reader(
    column: &ColumnDescriptor,
    pages: Box<dyn PageReader>,
) -> Result<(ColumnReader, Option<Texts>), ParquetError> {
    let is_of_texts = column.physical_type() == PhysicalType::BYTE_ARRAY;
    let texts = is_of_texts.then(Texts::default);
    let of_type = if is_of_texts {
        Arc::new(Type::primitive_type_builder(column.name(), PhysicalType::INT32).build()?)
    } else {
        column.self_type_ptr()
    };
    let present = Arc::new(ColumnDescriptor::new(of_type, 0, 0, column.path().clone()));
    let has_levels = column.max_def_level() > 0;
    let pages = Present { pages, has_levels, texts: texts.clone() };
    Ok((get_column_reader(present, Box::new(pages)), texts))
}

/// Pages of a column, as if it were one whose values are all there.
struct Present {
    pages: Box<dyn PageReader>,
    has_levels: bool,
    texts: Option<Texts>,
}

impl Present {
    fn page(&self, page: Page) -> Result<Page, ParquetError> {
        let is_of_places = |encoding: Encoding| {
            matches!(encoding, Encoding::RLE_DICTIONARY | Encoding::PLAIN_DICTIONARY)
        };
        match page {
            Page::DictionaryPage { buf, num_values, encoding, is_sorted } => {
                let Some(texts) = &self.texts else {
                    return Ok(Page::DictionaryPage { buf, num_values, encoding, is_sorted });
                };
                let found = texts_of(&buf, num_values).ok_or_else(|| otherwise("dictionary"))?;
                texts.set(found).map_err(|_| otherwise("dictionary"))?;
                let places = (0..num_values).flat_map(u32::to_le_bytes).collect::<Vec<u8>>();
                Ok(Page::DictionaryPage { buf: places.into(), num_values, encoding, is_sorted })
            }
            Page::DataPage { encoding, .. } | Page::DataPageV2 { encoding, .. }
                if self.texts.is_some() && !is_of_places(encoding) =>
            {
                Err(otherwise("encoding"))
            }
            Page::DataPage {
                buf,
                num_values,
                encoding,
                def_level_encoding,
                rep_level_encoding,
                statistics,
            } if self.has_levels => Ok(Page::DataPage {
                buf: without_levels(&buf, num_values, def_level_encoding)
                    .ok_or_else(|| otherwise("missing value"))?,
                num_values,
                encoding,
                def_level_encoding,
                rep_level_encoding,
                statistics,
            }),
            // Of the second version few files are: they are read as they always were.
            Page::DataPageV2 { .. } if self.has_levels => Err(otherwise("version")),
            page => Ok(page),
        }
    }
}

impl PageReader for Present {
    fn get_next_page(&mut self) -> Result<Option<Page>, ParquetError> {
        let page = self.pages.get_next_page()?;
        page.map(|page| self.page(page)).transpose()
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>, ParquetError> {
        self.pages.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Result<(), ParquetError> {
        self.pages.skip_next_page()
    }
}

impl Iterator for Present {
    type Item = Result<Page, ParquetError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

fn otherwise(what: &str) -> ParquetError {
    ParquetError::General(format!("a column that is read in another way, for its {what}"))
}

/// What follows the levels of a page, if these say that each of its values is there.
///
/// Levels of one bit are written as a length of four bytes and runs, which begin with a number of seven bits a byte, the lowest
/// first: twice the length of a run of one value, which follows in a byte. (The other kind of run, of packed bits, is for levels
/// that change.) Source: the format's specification, `Encodings.md`, "Run Length Encoding / Bit-Packing Hybrid".
fn without_levels(page: &Bytes, values: u32, encoding: Encoding) -> Option<Bytes> {
    if encoding != Encoding::RLE {
        return None;
    }
    let (length, behind) = page.split_first_chunk::<4>()?;
    let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
    let mut levels = behind.get(..length)?;
    let mut left = u64::from(values);
    while left > 0 {
        let header = number(&mut levels)?;
        let (level, behind) = levels.split_first()?;
        if header % 2 == 1 || header == 0 || *level != 1 {
            return None;
        }
        levels = behind;
        left = left.saturating_sub(header / 2);
    }
    Some(page.slice(4 + length..))
}

/// A number of seven bits a byte, the lowest first; of at most 32 bits.
fn number(bytes: &mut &[u8]) -> Option<u64> {
    let mut number = 0;
    for place in 0..5 {
        let (byte, rest) = bytes.split_first()?;
        *bytes = rest;
        number |= u64::from(byte & 0x7f) << (7 * place);
        if *byte < 0x80 {
            return Some(number);
        }
    }
    None
}

/// The texts of a dictionary's page: each behind its length in four bytes.
fn texts_of(page: &Bytes, count: u32) -> Option<Vec<Bytes>> {
    let mut texts = Vec::new();
    let mut at = 0;
    for _ in 0..count {
        let (length, _) = page.get(at..)?.split_first_chunk::<4>()?;
        let start = at + 4;
        at = start.checked_add(usize::try_from(u32::from_le_bytes(*length)).ok()?)?;
        if at > page.len() {
            return None;
        }
        texts.push(page.slice(start..at));
    }
    Some(texts)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(page: &[u8], values: u32) -> Option<Vec<u8>> {
        let page = Bytes::copy_from_slice(page);
        without_levels(&page, values, Encoding::RLE).map(|rest| rest.to_vec())
    }

    /// By hand, of the format's specification: 300 times level 1 is the run 600, as 0xd8 0x04, and the level.
    #[test]
    fn levels_are_cut_off_where_all_values_are_there() {
        assert_eq!(cut(&[3, 0, 0, 0, 0xd8, 0x04, 1, 7, 8], 300), Some(vec![7, 8]));
        // Two runs, of which the second is longer than the page.
        assert_eq!(cut(&[4, 0, 0, 0, 6, 1, 16, 1, 9], 5), Some(vec![9]));
        // One value too few, a missing one, packed bits, a run of nothing, levels longer than the page.
        assert_eq!(cut(&[3, 0, 0, 0, 0xd8, 0x04, 1, 7, 8], 301), None);
        assert_eq!(cut(&[4, 0, 0, 0, 6, 1, 2, 0, 9], 4), None);
        assert_eq!(cut(&[2, 0, 0, 0, 3, 0xff, 9], 8), None);
        assert_eq!(cut(&[2, 0, 0, 0, 0, 1, 9], 1), None);
        assert_eq!(cut(&[9, 0, 0, 0, 2, 1, 9], 1), None);
        assert_eq!(cut(&[2, 0], 1), None);
    }

    #[test]
    fn dictionaries_of_texts() {
        let page = Bytes::from_static(&[1, 0, 0, 0, b'a', 0, 0, 0, 0, 2, 0, 0, 0, b'b', b'c']);
        let texts = texts_of(&page, 3).unwrap();
        assert_eq!(texts, [&b"a"[..], b"", b"bc"]);
        // More than there are; one that is longer than the page.
        assert!(texts_of(&page, 4).is_none());
        assert!(texts_of(&Bytes::from_static(&[9, 0, 0, 0, b'a']), 1).is_none());
    }
}
