//! Places in a dictionary: runs of one place, and places packed bit by bit (the format's specification, "Dictionary Encoding" and
//! "Run Length Encoding / Bit-Packing Hybrid").
//!
//! Millions of values come this way. Packed places are taken 32 at a time, by a function for each of the widths that columns of
//! measured values have, and looked up in a table that has an entry for whatever 16 bits are, so that none is looked for in vain.

use crate::Damage;
use crate::compact::Compact;

/// Places that are unpacked together.
const BLOCK: usize = 32;
/// Blocks that are unpacked before any is looked up: few enough that they are still at hand. Our choice.
const BLOCKS_AT_ONCE: usize = 32;
/// Entries of the table of a dictionary: one for each number of 16 bits.
const ENTRIES: usize = 1 << 16;
/// Of a short one, which most columns have: one for each number of 12 bits.
const FEW: usize = 1 << 12;
const BITS_OF_FEW: u32 = FEW.ilog2();

/// How far the places of a page have been read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Places {
    /// Bits of a place.
    width: u32,
    /// The byte of the page at which the next run begins.
    at: usize,
    run: Run,
}

#[derive(Clone, Copy, Debug)]
enum Run {
    /// So many times the same place.
    Same { place: u32, left: usize },
    /// Places packed from this byte on, of which some were taken.
    Packed { from: usize, taken: usize, left: usize },
}

/// The values that places stand for.
#[derive(Clone, Debug)]
pub(crate) struct Dictionary<T> {
    /// One for each number of 12 bits at least, or of 16; those behind the dictionary's length are none.
    table: Vec<T>,
    length: usize,
}

impl<T: Copy + Default> Dictionary<T> {
    /// Of these values.
    pub(crate) fn new(mut values: Vec<T>) -> Self {
        let length = values.len();
        let entries = if length <= FEW { FEW } else { ENTRIES };
        values.resize(length.max(entries), T::default());
        Self { table: values, length }
    }

    /// Adds the values of the next places of a page.
    ///
    /// # Errors
    /// [`Damage`] for places that there are not.
    pub(crate) fn append(
        &self,
        places: &mut Places,
        page: &[u8],
        count: usize,
        values: &mut Vec<T>,
    ) -> Result<(), Damage> {
        let mut missing = count;
        while missing > 0 {
            let taken = match &mut places.run {
                Run::Same { left: 0, .. } | Run::Packed { left: 0, .. } => {
                    places.begin_run(page)?;
                    continue;
                }
                Run::Same { place, left } => {
                    let taken = missing.min(*left);
                    let value = self.value(*place)?;
                    values.resize(values.len() + taken, value);
                    *left -= taken;
                    taken
                }
                Run::Packed { from, taken: before, left } => {
                    let taken = missing.min(*left);
                    let packed = page.get(*from..).ok_or(Damage::EndsEarly)?;
                    self.append_packed(places.width, packed, *before..*before + taken, values)?;
                    (*before, *left) = (*before + taken, *left - taken);
                    taken
                }
            };
            missing -= taken;
        }
        Ok(())
    }

    fn value(&self, place: u32) -> Result<T, Damage> {
        let length = self.length;
        let known = usize::try_from(place).ok().filter(|place| *place < length);
        known
            .and_then(|place| self.table.get(place))
            .copied()
            .ok_or(Damage::PlaceUnknown { length })
    }

    fn append_packed(
        &self,
        width: u32,
        packed: &[u8],
        range: core::ops::Range<usize>,
        values: &mut Vec<T>,
    ) -> Result<(), Damage> {
        let mut place = range.start;
        // Eight places end with a byte.
        while place < range.end && !place.is_multiple_of(8) {
            values.push(self.value(one(width, packed, place)?)?);
            place += 1;
        }
        let blocks = (range.end - place) / BLOCK;
        let places = (packed, place, blocks);
        let looked_up = if width <= BITS_OF_FEW {
            self.append_blocks::<FEW>(width, places, values)?
        } else {
            self.append_blocks::<ENTRIES>(width, places, values)?
        };
        place += looked_up * BLOCK;
        for place in place..range.end {
            values.push(self.value(one(width, packed, place)?)?);
        }
        Ok(())
    }

    /// Adds the values of whole blocks of packed places from one of them on, which begins a byte; gives the number of blocks: none
    /// where the table is too short for a place of this width, or the width is not one of a table.
    fn append_blocks<const TABLE: usize>(
        &self,
        width: u32,
        (packed, place, blocks): (&[u8], usize, usize),
        values: &mut Vec<T>,
    ) -> Result<usize, Damage> {
        let (Some(unpack), Some(table)) = (unpacker(width), self.table.first_chunk::<TABLE>())
        else {
            return Ok(0);
        };
        let bytes = width as usize * BLOCK / 8;
        let from = width as usize * (place / 8);
        let packed = packed.get(from..from + blocks * bytes).ok_or(Damage::EndsEarly)?;
        let mut places = [[0; BLOCK]; BLOCKS_AT_ONCE];
        for several in packed.chunks((bytes * BLOCKS_AT_ONCE).max(1)) {
            let blocks = several.chunks_exact(bytes.max(1));
            let count = blocks.len();
            for (block, places) in blocks.zip(&mut places) {
                unpack(block, places);
            }
            // Only now, since a processor waits where it loads several together of what it has just stored one by one.
            let places = places[..count].as_flattened();
            let farthest = places.iter().fold(0, |most: u16, place| most.max(*place));
            self.value(farthest.into())?;
            // The mask changes nothing: it tells the compiler that the table has the entry.
            values.extend(places.iter().map(|place| table[usize::from(*place) & (TABLE - 1)]));
        }
        Ok(blocks)
    }
}

impl Places {
    /// From this byte of a page on, which is the width of a place.
    ///
    /// # Errors
    /// [`Damage`] for a page without that, or places of more than 32 bits.
    pub(crate) fn begin(page: &[u8], from: usize) -> Result<Self, Damage> {
        match page.get(from) {
            Some(width @ 0..=32) => {
                let run = Run::Same { place: 0, left: 0 };
                Ok(Self { width: u32::from(*width), at: from + 1, run })
            }
            _ => Err(Damage::EndsEarly),
        }
    }

    /// Adds the next places, each with the number of values that it holds for, of a dictionary of this `length`.
    pub(crate) fn append_runs(
        &mut self,
        page: &[u8],
        count: usize,
        length: usize,
        runs: &mut Vec<(u32, usize)>,
    ) -> Result<(), Damage> {
        let mut missing = count;
        while missing > 0 {
            let (place, taken) = match &mut self.run {
                Run::Same { left: 0, .. } | Run::Packed { left: 0, .. } => {
                    self.begin_run(page)?;
                    continue;
                }
                Run::Same { place, left } => {
                    let taken = missing.min(*left);
                    *left -= taken;
                    (*place, taken)
                }
                Run::Packed { from, taken, left } => {
                    let packed = page.get(*from..).ok_or(Damage::EndsEarly)?;
                    let place = one(self.width, packed, *taken)?;
                    (*taken, *left) = (*taken + 1, *left - 1);
                    (place, 1)
                }
            };
            if place as usize >= length {
                return Err(Damage::PlaceUnknown { length });
            }
            match runs.last_mut() {
                Some((last, count)) if *last == place => *count += taken,
                _ => runs.push((place, taken)),
            }
            missing -= taken;
        }
        Ok(())
    }

    fn begin_run(&mut self, page: &[u8]) -> Result<(), Damage> {
        let mut rest = Compact(page.get(self.at..).ok_or(Damage::EndsEarly)?);
        let head = rest.number().ok_or(Damage::EndsEarly)?;
        let rest = rest.0;
        let from = page.len() - rest.len();
        let count = usize::try_from(head >> 1).map_err(|_| Damage::EndsEarly)?;
        if head & 1 == 0 {
            let bytes = self.width.div_ceil(8) as usize;
            let place = rest.get(..bytes).ok_or(Damage::EndsEarly)?;
            let place = place.iter().rev().fold(0, |place, byte| place << 8 | u32::from(*byte));
            (self.at, self.run) = (from + bytes, Run::Same { place, left: count });
        } else {
            let left = count.checked_mul(8).ok_or(Damage::EndsEarly)?;
            let bytes = count.checked_mul(self.width as usize).ok_or(Damage::EndsEarly)?;
            // Some writers cut the last run behind its last place that counts.
            self.at = from.saturating_add(bytes).min(page.len());
            self.run = Run::Packed { from, taken: 0, left };
        }
        Ok(())
    }
}

/// A place by itself.
fn one(width: u32, packed: &[u8], place: usize) -> Result<u32, Damage> {
    let first_bit = place * width as usize;
    let end = (first_bit + width as usize).div_ceil(8);
    let bytes = packed.get(first_bit / 8..end).ok_or(Damage::EndsEarly)?;
    let word = bytes.iter().rev().fold(0_u64, |word, byte| word << 8 | u64::from(*byte));
    let mask = (1_u64 << width) - 1;
    Ok(u32::try_from((word >> (first_bit % 8)) & mask).unwrap_or(u32::MAX))
}

/// Unpacks a block of places.
type Unpack = fn(&[u8], &mut [u16; BLOCK]);

/// For places of up to 16 bits.
fn unpacker(width: u32) -> Option<Unpack> {
    Some(match width {
        1 => unpack::<1>,
        2 => unpack::<2>,
        3 => unpack::<3>,
        4 => unpack::<4>,
        5 => unpack::<5>,
        6 => unpack::<6>,
        7 => unpack::<7>,
        8 => unpack::<8>,
        9 => unpack::<9>,
        10 => unpack::<10>,
        11 => unpack::<11>,
        12 => unpack::<12>,
        13 => unpack::<13>,
        14 => unpack::<14>,
        15 => unpack::<15>,
        16 => unpack::<16>,
        _ => return None,
    })
}

#[expect(clippy::cast_possible_truncation, reason = "a place of a width up to 16 bits")]
fn unpack<const WIDTH: usize>(packed: &[u8], places: &mut [u16; BLOCK]) {
    let mut words = [0_u32; WIDTH];
    let (fours, _) = packed.as_chunks::<4>();
    for (word, four) in words.iter_mut().zip(fours) {
        *word = u32::from_le_bytes(*four);
    }
    let mask = u32::MAX >> (32 - WIDTH);
    for (index, place) in places.iter_mut().enumerate() {
        let bit = index * WIDTH;
        let (word, shift) = (bit / 32, bit % 32);
        let mut found = words[word] >> shift;
        if shift + WIDTH > 32 {
            found |= words[word + 1] << (32 - shift);
        }
        *place = (found & mask) as u16;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// By hand, of the format's example: 0 to 7 in three bits each are the bytes 0x88 0xc6 0xfa; before them 100 times 4.
    #[test]
    fn runs_by_hand() {
        let page = [3, 200, 1, 4, 3, 0x88, 0xc6, 0xfa];
        let dictionary = Dictionary::new((0..8).map(f64::from).collect());
        let mut values = Vec::new();
        let mut places = Places::begin(&page, 0).unwrap();
        dictionary.append(&mut places, &page, 99, &mut values).unwrap();
        dictionary.append(&mut places, &page, 9, &mut values).unwrap();
        let expected: Vec<f64> = [4; 100].into_iter().chain(0..8).map(f64::from).collect();
        assert_eq!(values, expected);
        assert_eq!(dictionary.append(&mut places, &page, 1, &mut values), Err(Damage::EndsEarly));
        let short = Dictionary::new(vec![0.5; 7]);
        let mut places = Places::begin(&page, 0).unwrap();
        let refused = short.append(&mut places, &page, 108, &mut Vec::new());
        assert_eq!(refused, Err(Damage::PlaceUnknown { length: 7 }));
    }

    /// Places bit by bit, as the format has them: the lowest bit first.
    fn packed(width: u32, places: &[u32]) -> Vec<u8> {
        let bits: Vec<bool> = places
            .iter()
            .flat_map(|place| (0..width).map(move |bit| place >> bit & 1 == 1))
            .collect();
        bits.chunks(8)
            .map(|byte| byte.iter().rev().fold(0, |byte, bit| byte << 1 | u8::from(*bit)))
            .collect()
    }

    proptest! {
        /// Oracle: the places that were written, bit by bit, taken in pieces of any length.
        #[test]
        fn packed_places_of_every_width(
            width in 1_u32..=20,
            groups in 1_usize..40,
            seed in any::<u32>(),
            pieces in prop::collection::vec(1_usize..90, 1..20),
        ) {
            let random = |n: u32| n.wrapping_add(seed).wrapping_mul(2_654_435_769) >> (32 - width);
            let count = u32::try_from(8 * groups).unwrap();
            let places: Vec<u32> = (0..count).map(random).collect();
            let mut page = vec![u8::try_from(width).unwrap(), u8::try_from(2 * groups + 1).unwrap()];
            page.extend(packed(width, &places));
            let entries = 1_u32 << width;
            let dictionary = Dictionary::new((0..entries).collect::<Vec<u32>>());
            let mut values = Vec::new();
            let mut read = Places::begin(&page, 0).unwrap();
            for piece in pieces {
                let piece = piece.min(places.len() - values.len());
                dictionary.append(&mut read, &page, piece, &mut values).unwrap();
            }
            prop_assert_eq!(&values, &places[..values.len()]);
            // Of a dictionary that ends before the farthest place it is refused.
            let farthest = places.iter().max().copied().unwrap_or(0);
            let short = Dictionary::new((0..farthest).collect::<Vec<u32>>());
            let mut read = Places::begin(&page, 0).unwrap();
            let refused = short.append(&mut read, &page, places.len(), &mut Vec::new());
            prop_assert!(refused.is_err());
        }

        /// Whatever the bytes are: values or a refusal, and never more than asked for.
        #[test]
        fn any_page(page in prop::collection::vec(any::<u8>(), 0..200), count in 0_usize..5000) {
            let dictionary = Dictionary::new(vec![1.0; 300]);
            let mut values = Vec::new();
            if let Ok(mut places) = Places::begin(&page, 0) {
                let read = dictionary.append(&mut places, &page, count, &mut values);
                prop_assert!(values.len() <= count);
                prop_assert!(read.is_err() || values.len() == count);
            }
        }
    }
}
