//! Thrift's compact protocol, in which Parquet's metadata are written.

/// Bytes that are read from the first on; every method gives `None` where they do not go on as they have to.
#[derive(Clone, Copy, Debug)]
pub struct Compact<'b>(pub &'b [u8]);

impl Compact<'_> {
    /// Number and type of the next field of a structure behind the field `before` (0 at its beginning); `Some(None)` at its end.
    pub fn field(&mut self, before: i64) -> Option<Option<(i64, u8)>> {
        let head = self.byte()?;
        if head == 0 {
            return Some(None);
        }
        let field = match head >> 4 {
            0 => self.signed()?,
            more => before + i64::from(more),
        };
        // Decoders cut a number to sixteen bits.
        (1..=i64::from(i16::MAX)).contains(&field).then_some(Some((field, head & 0x0f)))
    }

    /// Zigzag: 0, −1, 1, −2, 2 …
    pub fn signed(&mut self) -> Option<i64> {
        let number = self.number()?;
        i64::try_from(number >> 1).ok().map(|half| half ^ -i64::from(number & 1 == 1))
    }

    /// Seven bits a byte, the lowest first; `None` for one of more than 64 bits.
    pub fn number(&mut self) -> Option<u64> {
        let mut number = 0;
        for place in (0..u64::BITS).step_by(7) {
            let byte = self.byte()?;
            let bits = u64::from(byte & 0x7f);
            let placed = bits << place;
            // The tenth byte has room for one bit only.
            if placed >> place != bits {
                return None;
            }
            number |= placed;
            if byte < 0x80 {
                return Some(number);
            }
        }
        None
    }

    /// A byte.
    pub fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    /// Passes over so many bytes.
    pub fn skip(&mut self, bytes: usize) -> Option<()> {
        self.0 = self.0.get(bytes..)?;
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand, of the protocol's specification (ULEB128): 300 is 0xac 0x02; the largest number of 64 bits is nine bytes of seven bits
    /// and one more bit. A bit beyond it, or an eleventh byte, is no number.
    #[test]
    fn numbers_of_at_most_64_bits() {
        let number = |bytes: &[u8]| Compact(bytes).number();
        assert_eq!(number(&[0xac, 0x02]), Some(300));
        assert_eq!(number(&[0xac]), None);
        let ten = |last: u8| [[0xff; 9].as_slice(), &[last]].concat();
        assert_eq!(number(&ten(0x01)), Some(u64::MAX));
        for beyond in [0x02, 0x03, 0x7f] {
            assert_eq!(number(&ten(beyond)), None, "{beyond}");
        }
        assert_eq!(number(&[[0x80; 10].as_slice(), &[0x00]].concat()), None);
        // Zigzag: −1 is 1, −2 is 3, the least number of 64 bits the largest without a sign.
        assert_eq!(Compact(&[0x01]).signed(), Some(-1));
        assert_eq!(Compact(&[0x03]).signed(), Some(-2));
        assert_eq!(Compact(&ten(0x01)).signed(), Some(i64::MIN));
    }
}
