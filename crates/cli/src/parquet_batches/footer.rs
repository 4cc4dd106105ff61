//! The footer of a Parquet file, walked before it is decoded.
//!
//! The footer is Thrift in its compact protocol, in which every element of a list takes a byte at least. The decoder believes
//! the length that a list states, and skips truth values without taking a byte: a few bytes of a damaged footer can keep it busy
//! for seconds each. What is walked here to its end holds no more elements than bytes.

use parquet::errors::ParquetError;
use parquet::file::reader::{ChunkReader, Length};

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
    match (Walk { rest: &footer }).structure(0) {
        Some(()) => Ok(()),
        None => Err(ParquetError::General("its footer is damaged".to_owned())),
    }
}

/// What is left of a footer; `None` where it does not go on as it has to.
struct Walk<'f> {
    rest: &'f [u8],
}

impl Walk<'_> {
    fn structure(&mut self, depth: usize) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        loop {
            let head = self.byte()?;
            if head == 0 {
                return Some(());
            }
            if head >> 4 == 0 {
                self.number()?;
            }
            // A truth value of a field is in its type.
            if !matches!(head & 0x0f, 1 | 2) {
                self.value(head & 0x0f, depth)?;
            }
        }
    }

    /// A value of a type, as an element of a list has it.
    fn value(&mut self, of_type: u8, depth: usize) -> Option<()> {
        match of_type {
            1..=3 => self.skip(1),
            4..=6 => self.number().map(|_| ()),
            7 => self.skip(8),
            8 => {
                let length = self.number()?;
                self.skip(usize::try_from(length).ok()?)
            }
            9 | 10 => self.list(depth),
            12 => self.structure(depth + 1),
            // No field of Parquet's metadata is a map.
            _ => None,
        }
    }

    fn list(&mut self, depth: usize) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        let head = self.byte()?;
        let count = match head >> 4 {
            15 => usize::try_from(self.number()?).ok()?,
            count => usize::from(count),
        };
        if count > self.rest.len() {
            return None;
        }
        (0..count).try_for_each(|_| self.value(head & 0x0f, depth + 1))
    }

    /// Seven bits a byte, the lowest first.
    fn number(&mut self) -> Option<u64> {
        let mut number = 0;
        for place in 0..10 {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f).checked_shl(7 * place)?;
            if byte < 0x80 {
                return Some(number);
            }
        }
        None
    }

    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*first)
    }

    fn skip(&mut self, count: usize) -> Option<()> {
        self.rest = self.rest.get(count..)?;
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walked(footer: &[u8]) -> bool {
        (Walk { rest: footer }).structure(0).is_some()
    }

    /// By the compact protocol: field 1 as a number (0x15), 3, and the end; a list of three numbers; a text; a structure within.
    #[test]
    fn structures_by_hand() {
        assert!(walked(&[0x15, 0x06, 0x00]));
        assert!(walked(&[0x19, 0x35, 0x02, 0x04, 0x06, 0x00]));
        assert!(walked(&[0x18, 0x02, b'a', b'b', 0x1c, 0x11, 0x00, 0x00]));
        // Cut off; a text longer than what is left; more elements than bytes; a type that there is not.
        assert!(!walked(&[0x15, 0x06]));
        assert!(!walked(&[0x18, 0x05, b'a', 0x00]));
        assert!(!walked(&[0x19, 0xf1, 0xff, 0xff, 0xff, 0xff, 0x0f, 0x00]));
        assert!(!walked(&[0x1f, 0x00]));
        assert!(!walked(&[[0x1c; 100].as_slice(), &[0; 101]].concat()));
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
