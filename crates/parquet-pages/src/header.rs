//! The header of a page.

use crate::compact::Compact;

/// What a page is, and how long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// Bytes behind the header.
    pub packed_bytes: usize,
    /// Bytes that they unpack to.
    pub unpacked_bytes: usize,
    /// What it holds.
    pub kind: Kind,
}

/// What a page holds; encodings by their number in `parquet.thrift`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The values of a dictionary.
    Dictionary {
        /// How many.
        values: u32,
        /// How they are written.
        encoding: u32,
        /// Whether they increase.
        is_sorted: bool,
    },
    /// Levels and values, packed together.
    Data {
        /// How many, those that are missing among them.
        values: u32,
        /// How they are written.
        encoding: u32,
        /// How the definition levels are written.
        definition_encoding: u32,
        /// How the repetition levels are written.
        repetition_encoding: u32,
    },
    /// Levels, not packed, then values.
    DataV2 {
        /// How many, those that are missing among them.
        values: u32,
        /// Those that are missing.
        nulls: u32,
        /// Rows.
        rows: u32,
        /// How the values are written.
        encoding: u32,
        /// Bytes of the definition levels.
        definition_bytes: u32,
        /// Bytes of the repetition levels.
        repetition_bytes: u32,
        /// Whether the values are packed.
        is_packed: bool,
    },
    /// Nothing that a reader of all values needs.
    Other,
}

/// Structures within structures: the statistics of a page are one in one.
const DEEPEST: usize = 16;

/// The header at the beginning of these bytes, and its length; `None` where there is none, or none that ends within them.
#[must_use]
pub fn header(bytes: &[u8]) -> Option<(Header, usize)> {
    let mut rest = Compact(bytes);
    let (mut kind, mut unpacked, mut packed) = (None, None, None);
    let (mut data, mut dictionary, mut data_v2) = (None, None, None);
    rest.structure(0, &mut |rest, field, of_type| {
        match field {
            1 => kind = Some(rest.count(of_type)?),
            2 => unpacked = Some(rest.count(of_type)?),
            3 => packed = Some(rest.count(of_type)?),
            5 => data = Some(rest.counts(of_type)?),
            7 => dictionary = Some(rest.counts(of_type)?),
            8 => data_v2 = Some(rest.counts(of_type)?),
            _ => rest.skip_value(of_type, 0)?,
        }
        Some(())
    })?;
    let kind = match kind? {
        0 => {
            let Fields { numbers, .. } = data?;
            let [values, encoding, definition_encoding, repetition_encoding, ..] = numbers;
            Kind::Data {
                values: values?,
                encoding: encoding?,
                definition_encoding: definition_encoding?,
                repetition_encoding: repetition_encoding?,
            }
        }
        2 => {
            let Fields { numbers: [values, encoding, ..], truth } = dictionary?;
            Kind::Dictionary {
                values: values?,
                encoding: encoding?,
                is_sorted: truth.unwrap_or(false),
            }
        }
        3 => {
            let Fields { numbers, truth } = data_v2?;
            let [values, nulls, rows, encoding, definition_bytes, repetition_bytes] = numbers;
            Kind::DataV2 {
                values: values?,
                nulls: nulls?,
                rows: rows?,
                encoding: encoding?,
                definition_bytes: definition_bytes?,
                repetition_bytes: repetition_bytes?,
                is_packed: truth.unwrap_or(true),
            }
        }
        _ => Kind::Other,
    };
    let length = |count: Option<u32>| usize::try_from(count?).ok();
    let header = Header { packed_bytes: length(packed)?, unpacked_bytes: length(unpacked)?, kind };
    Some((header, bytes.len() - rest.0.len()))
}

/// What a structure within the header has of numbers, fields 1 to 6, and its truth value: each has one at most.
#[derive(Default)]
struct Fields {
    numbers: [Option<u32>; 6],
    truth: Option<bool>,
}

/// Takes the value of a field: its number, and its type.
type Each<'a, 'b> = dyn FnMut(&mut Compact<'b>, i64, u8) -> Option<()> + 'a;

impl<'b> Compact<'b> {
    fn structure(&mut self, depth: usize, each: &mut Each<'_, 'b>) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        let mut field = 0;
        loop {
            let Some((next, of_type)) = self.field(field)? else { return Some(()) };
            field = next;
            each(self, field, of_type)?;
        }
    }

    /// A structure of numbers and a truth value.
    fn counts(&mut self, of_type: u8) -> Option<Fields> {
        let mut fields = Fields::default();
        if of_type != STRUCTURE {
            return None;
        }
        self.structure(1, &mut |rest, field, of_type| {
            let number = usize::try_from(field - 1).ok().and_then(|n| fields.numbers.get_mut(n));
            match (of_type, number) {
                (TRUE | FALSE, _) => fields.truth = Some(of_type == TRUE),
                (NUMBER, Some(number)) => *number = Some(rest.count(of_type)?),
                _ => rest.skip_value(of_type, 1)?,
            }
            Some(())
        })?;
        Some(fields)
    }

    /// A number of 32 bits that is not negative.
    fn count(&mut self, of_type: u8) -> Option<u32> {
        if of_type != NUMBER {
            return None;
        }
        u32::try_from(self.signed()?).ok().filter(|count| i32::try_from(*count).is_ok())
    }

    fn skip_value(&mut self, of_type: u8, depth: usize) -> Option<()> {
        match of_type {
            TRUE | FALSE => Some(()),
            3 => self.skip(1),
            4..=6 => self.number().map(drop),
            7 => self.skip(8),
            8 => {
                let length = self.number()?;
                self.skip(usize::try_from(length).ok()?)
            }
            STRUCTURE => self
                .structure(depth + 1, &mut |rest, _, of_type| rest.skip_value(of_type, depth + 1)),
            // No field of a page's header is a list or a map.
            _ => None,
        }
    }
}

/// Types of the compact protocol.
const TRUE: u8 = 1;
const FALSE: u8 = 2;
const NUMBER: u8 = 5;
const STRUCTURE: u8 = 12;

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand, of the compact protocol: a dictionary of three values in 12 bytes, packed into 10.
    const DICTIONARY: [u8; 13] =
        [0x15, 0x04, 0x15, 0x18, 0x15, 0x14, 0x4c, 0x15, 0x06, 0x15, 0x00, 0x00, 0x00];

    #[test]
    fn a_header_by_hand() {
        let kind = Kind::Dictionary { values: 3, encoding: 0, is_sorted: false };
        let expected = Header { packed_bytes: 10, unpacked_bytes: 12, kind };
        assert_eq!(header(&DICTIONARY), Some((expected, 13)));
        let longer = [DICTIONARY.as_slice(), &[7, 7]].concat();
        assert_eq!(header(&longer), Some((expected, 13)));
        // Cut anywhere it is none.
        for length in 0..DICTIONARY.len() {
            assert_eq!(header(&DICTIONARY[..length]), None, "{length}");
        }
    }

    #[test]
    fn a_data_page_with_statistics() {
        // 300 values of encoding 8, levels of encoding 3 both; statistics: fields 5 and 6 as texts.
        let page = [
            0x15, 0x00, 0x15, 0x02, 0x15, 0x02, 0x2c, 0x15, 0xd8, 0x04, 0x15, 0x10, 0x15, 0x06,
            0x15, 0x06, 0x1c, 0x58, 0x01, b'z', 0x18, 0x01, b'a', 0x00, 0x00, 0x00,
        ];
        let kind =
            Kind::Data { values: 300, encoding: 8, definition_encoding: 3, repetition_encoding: 3 };
        let expected = Header { packed_bytes: 1, unpacked_bytes: 1, kind };
        assert_eq!(header(&page), Some((expected, page.len())));
    }

    #[test]
    fn what_is_no_header() {
        let with = |at: usize, byte: u8| {
            let mut bytes = DICTIONARY;
            bytes[at] = byte;
            header(&bytes)
        };
        // A field of the type that ends a structure; a length below zero; one that is a truth value; a page without its own structure; a kind that there is not.
        assert_eq!(with(2, 0x10), None);
        assert_eq!(with(5, 0x13), None);
        assert_eq!(with(4, 0x11), None);
        assert_eq!(with(1, 0x00), None);
        assert_eq!(with(1, 0x0a).map(|(header, _)| header.kind), Some(Kind::Other));
        assert_eq!(header(&[[0x1c; 100].as_slice(), &[0; 101]].concat()), None);
    }
}
