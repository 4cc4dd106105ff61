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

    /// Seven bits a byte, the lowest first.
    pub fn number(&mut self) -> Option<u64> {
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
