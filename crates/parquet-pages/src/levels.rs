//! Levels, of which those of columns without lists say where a value is missing.

use crate::compact::Compact;

/// Bytes of the levels at the beginning of a page, behind their length in four bytes, if these say that each of its values is there.
pub(crate) fn without_levels(page: &[u8], values: u32) -> Option<usize> {
    let (length, behind) = page.split_first_chunk::<4>()?;
    let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
    all_are_there(behind.get(..length)?, values).then_some(4 + length)
}

/// Whether levels say that each of so many values is there.
///
/// Levels of one bit are written as runs, which begin with a number of seven bits a byte, the lowest first: twice the length of a run
/// of one value, which follows in a byte. (The other kind of run, of packed bits, is for levels that change.) Source:
/// `Encodings.md`, "Run Length Encoding / Bit-Packing Hybrid".
pub(crate) fn all_are_there(levels: &[u8], values: u32) -> bool {
    let mut rest = Compact(levels);
    let mut left = u64::from(values);
    while left > 0 {
        let (Some(header), Some(level)) = (rest.number(), rest.byte()) else { return false };
        if header % 2 == 1 || header == 0 || level != 1 {
            return false;
        }
        left = left.saturating_sub(header / 2);
    }
    true
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
