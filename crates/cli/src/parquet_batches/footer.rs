//! The footer of a Parquet file, walked before it is decoded.
//!
//! The footer is Thrift in its compact protocol, in which every element of a list takes a byte at least. The decoder believes
//! the length that a list states, and skips truth values without taking a byte: a few bytes of a damaged footer can keep it busy
//! for seconds each. A field that it knows it reads as what the field has to be, whatever the footer says that it is, and is then
//! at another byte. What is walked here to its end holds no more elements than bytes, and every known field is what it has to be.

mod fields;

use parquet::errors::ParquetError;
use parquet::file::reader::{ChunkReader, Length};
use parquet_pages::Compact;

use self::fields::{FILE, Kind, Structure};
use super::shared_file::SharedFile;

/// What ends a file: the footer's length in four bytes, and a name of four.
const ENDING_BYTES: u64 = 8;
/// Structures within structures: Parquet's metadata have fewer than ten.
const DEEPEST: usize = 64;

/// Refuses a file whose footer is no Thrift structure. What is no Parquet file at all is left to the decoder.
pub(super) fn check(file: &SharedFile) -> Result<(), ParquetError> {
    let Some(end) = file.len().checked_sub(ENDING_BYTES) else { return Ok(()) };
    let ending = file.get_bytes(end, 8)?;
    let Some(([a, b, c, d], b"PAR1")) = ending.split_first_chunk() else { return Ok(()) };
    let length = u64::from(u32::from_le_bytes([*a, *b, *c, *d]));
    let Some(start) = end.checked_sub(length) else { return Ok(()) };
    let Ok(count) = usize::try_from(length) else { return Ok(()) };
    let footer = file.get_bytes(start, count)?;
    match (Walk { rest: Compact(&footer) }).structure(FILE, 0) {
        Some(()) => Ok(()),
        None => Err(ParquetError::General("its footer is damaged".to_owned())),
    }
}

/// What is left of a footer; `None` where it does not go on as it has to.
struct Walk<'f> {
    rest: Compact<'f>,
}

impl Walk<'_> {
    fn structure(&mut self, known: Structure, depth: usize) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        let mut field = 0;
        loop {
            let Some((next, of_type)) = self.rest.field(field)? else { return Some(()) };
            field = next;
            let kind = known.iter().find(|(id, _)| *id == field).map(|(_, kind)| kind);
            self.field(of_type, kind, depth)?;
        }
    }

    /// The value of a field; a truth value is in its type.
    fn field(&mut self, of_type: u8, kind: Option<&Kind>, depth: usize) -> Option<()> {
        match (of_type, kind) {
            (1 | 2, None | Some(Kind::Truth)) => Some(()),
            (1 | 2, Some(_)) | (_, Some(Kind::Truth)) => None,
            (of_type, kind) => self.value(of_type, kind, depth),
        }
    }

    /// A value of a type, as an element of a list has it.
    fn value(&mut self, of_type: u8, kind: Option<&Kind>, depth: usize) -> Option<()> {
        match (of_type, kind) {
            (3, None | Some(Kind::Byte)) => self.rest.skip(1),
            (4..=6, None | Some(Kind::Number)) => self.rest.number().map(|_| ()),
            (7, None | Some(Kind::Double)) => self.rest.skip(8),
            (8, None | Some(Kind::Bytes)) => {
                let length = self.rest.number()?;
                self.rest.skip(usize::try_from(length).ok()?)
            }
            (9 | 10, None) => self.list(None, depth),
            (9, Some(Kind::List(of))) => self.list(Some(of), depth),
            (12, None) => self.structure(&[], depth + 1),
            (12, Some(Kind::Fields(known))) => self.structure(known, depth + 1),
            // No field of Parquet's metadata is a map or a list of truth values, of which each takes a byte, and none where the
            // decoder skips them.
            _ => None,
        }
    }

    fn list(&mut self, kind: Option<&Kind>, depth: usize) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        let head = self.rest.byte()?;
        let count = match head >> 4 {
            15 => usize::try_from(self.rest.number()?).ok()?,
            count => usize::from(count),
        };
        if count > self.rest.0.len() {
            return None;
        }
        (0..count).try_for_each(|_| self.value(head & 0x0f, kind, depth + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walked(footer: &[u8]) -> bool {
        (Walk { rest: Compact(footer) }).structure(FILE, 0).is_some()
    }

    /// By the compact protocol: field 1 as a number (0x15), 3, and the end; a list of three numbers; a text; a structure within.
    #[test]
    fn structures_by_hand() {
        assert!(walked(&[0x15, 0x06, 0x00]));
        // Behind the fields that are known: field 14 and on.
        assert!(walked(&[0xe9, 0x35, 0x02, 0x04, 0x06, 0x00]));
        assert!(walked(&[0xe8, 0x02, b'a', b'b', 0x1c, 0x11, 0x00, 0x00]));
        // Field 2 is a list of structures, here of one with a name; field 6 a text.
        assert!(walked(&[0x29, 0x1c, 0x48, 0x01, b'x', 0x00, 0x48, 0x01, b'c', 0x00]));
        // Cut off; a text longer than what is left; more elements than bytes; a type that there is not.
        assert!(!walked(&[0x15, 0x06]));
        assert!(!walked(&[0xe8, 0x05, b'a', 0x00]));
        assert!(!walked(&[0xe9, 0xf1, 0xff, 0xff, 0xff, 0xff, 0x0f, 0x00]));
        // A known field of another type, by its step or by its number: the version a truth value, the schema a list of texts.
        assert!(!walked(&[0x11, 0x00]));
        assert!(!walked(&[0x01, 0x02, 0x00]));
        assert!(!walked(&[0x29, 0x18, 0x01, b'x', 0x00]));
        assert!(!walked(&[0x1f, 0x00]));
        assert!(!walked(&[[0x1c; 100].as_slice(), &[0; 101]].concat()));
    }

    /// What fuzzing found: a version that says that it is a truth value and is read as a number, so that what follows is something
    /// else for the decoder than for who believes the footer.
    #[test]
    fn a_footer_that_is_read_in_two_ways_is_refused() {
        let found = [
            0x02, 0xfe, 0xce, 0x3c, 0x02, 0x02, 0x02, 0x02, 0x02, 0xff, 0xff, 0xff, 0xf1, 0x02,
            0x22, 0x02, 0x33, 0x00, 0x2a, 0x8c, 0x02, 0xfe, 0xce, 0x3c, 0x02, 0x02, 0x02, 0x02,
            0x5b, 0xff, 0xff, 0xff, 0xf1, 0x02, 0x22, 0x02, 0x02, 0x02, 0xfb, 0xff, 0xbf, 0xff,
            0x15, 0xff, 0xff, 0xff, 0x02, 0x02, 0x41, 0x52,
        ];
        assert!(!walked(&found));
        // A list of truth values, which the decoder skips without taking their bytes; a number of a field that is 1 in sixteen bits.
        assert!(!walked(&[0xe9, 0x21, 0x01, 0x01, 0x00]));
        assert!(!walked(&[0x05, 0x82, 0x80, 0x08, 0x06, 0x00]));
    }

    /// What fuzzing found: the decoder counted two thousand million truth values that take no byte.
    #[test]
    #[expect(clippy::disallowed_methods, reason = "tests write files")]
    fn a_list_longer_than_its_file_is_refused_at_once() {
        let mut file = b"PAR1".to_vec();
        let footer = [0x19, 0xf1, 0xff, 0xff, 0xff, 0xff, 0x07, 0x00];
        file.extend(footer);
        file.extend(8_u32.to_le_bytes());
        file.extend(b"PAR1");
        let on_disk = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(on_disk.path(), file).unwrap();
        let shared = SharedFile::new(std::fs::File::open(on_disk.path()).unwrap()).unwrap();
        assert_eq!(check(&shared).unwrap_err().to_string(), "Parquet error: its footer is damaged");
    }
}
