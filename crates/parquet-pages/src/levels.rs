//! Levels, of which those of columns without lists say where a value is missing.

/// Bytes of the levels at the beginning of a page, if these say that each of its values is there.
///
/// Levels of one bit are written as a length of four bytes and runs, which begin with a number of seven bits a byte, the lowest
/// first: twice the length of a run of one value, which follows in a byte. (The other kind of run, of packed bits, is for levels
/// that change.) Source: `Encodings.md`, "Run Length Encoding / Bit-Packing Hybrid".
pub(crate) fn without_levels(page: &[u8], values: u32) -> Option<usize> {
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
    Some(4 + length)
}

/// A number of seven bits a byte, the lowest first; of at most 35 bits.
pub(crate) fn number(bytes: &mut &[u8]) -> Option<u64> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand, of the format's specification: 300 times level 1 is the run 600, as 0xd8 0x04, and the level.
    #[test]
    fn levels_are_cut_off_where_all_values_are_there() {
        assert_eq!(without_levels(&[3, 0, 0, 0, 0xd8, 0x04, 1, 7, 8], 300), Some(7));
        // Two runs, of which the second is longer than the page.
        assert_eq!(without_levels(&[4, 0, 0, 0, 6, 1, 16, 1, 9], 5), Some(8));
        // One value too few, a missing one, packed bits, a run of nothing, levels longer than the page.
        assert_eq!(without_levels(&[3, 0, 0, 0, 0xd8, 0x04, 1, 7, 8], 301), None);
        assert_eq!(without_levels(&[4, 0, 0, 0, 6, 1, 2, 0, 9], 4), None);
        assert_eq!(without_levels(&[2, 0, 0, 0, 3, 0xff, 9], 8), None);
        assert_eq!(without_levels(&[2, 0, 0, 0, 0, 1, 9], 1), None);
        assert_eq!(without_levels(&[9, 0, 0, 0, 2, 1, 9], 1), None);
        assert_eq!(without_levels(&[2, 0], 1), None);
    }
}
