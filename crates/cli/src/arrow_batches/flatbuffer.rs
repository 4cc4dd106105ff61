//! As much of `FlatBuffers` as the messages of Arrow need: tables, whose fields are found through their table of offsets,
//! vectors, texts and structures.
//!
//! Every access is within the bytes or gives `None`: a damaged file costs itself.
//!
//! # Source
//! `FlatBuffers`, page "Internals" (flatbuffers.dev): offsets are unsigned 32-bit and relative to where they are stored;
//! a table begins with the signed distance back to its table of offsets, which holds its own length, that of the table, and the
//! offset of each field in it, 0 where the field has its default.

/// A table in a buffer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Table<'b> {
    bytes: &'b [u8],
    place: usize,
}

/// A vector of a table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vector<'b> {
    bytes: &'b [u8],
    /// Of its first element.
    place: usize,
    pub(super) length: usize,
}

fn at<const N: usize>(bytes: &[u8], place: usize) -> Option<[u8; N]> {
    bytes.get(place..place.checked_add(N)?)?.try_into().ok()
}

fn index(value: u32) -> Option<usize> {
    usize::try_from(value).ok()
}

/// Where the offset that is stored at a place leads.
fn followed(bytes: &[u8], place: usize) -> Option<usize> {
    place.checked_add(index(u32::from_le_bytes(at(bytes, place)?))?)
}

impl<'b> Table<'b> {
    /// The root of a buffer.
    pub(super) fn root(bytes: &'b [u8]) -> Option<Self> {
        Some(Self { bytes, place: followed(bytes, 0)? })
    }

    /// Where a field is, `None` where it has its default.
    fn field(self, number: usize) -> Option<usize> {
        let back = i32::from_le_bytes(at(self.bytes, self.place)?);
        let offsets = usize::try_from(i64::try_from(self.place).ok()? - i64::from(back)).ok()?;
        let length = usize::from(u16::from_le_bytes(at(self.bytes, offsets)?));
        let entry = 4 + 2 * number;
        if entry + 2 > length {
            return None;
        }
        match u16::from_le_bytes(at(self.bytes, offsets + entry)?) {
            0 => None,
            offset => self.place.checked_add(usize::from(offset)),
        }
    }

    pub(super) fn byte(self, number: usize) -> Option<u8> {
        self.field(number).and_then(|place| self.bytes.get(place).copied())
    }

    pub(super) fn short(self, number: usize) -> Option<i16> {
        self.field(number).and_then(|place| at(self.bytes, place)).map(i16::from_le_bytes)
    }

    pub(super) fn int(self, number: usize) -> Option<i32> {
        self.field(number).and_then(|place| at(self.bytes, place)).map(i32::from_le_bytes)
    }

    pub(super) fn long(self, number: usize) -> Option<i64> {
        self.field(number).and_then(|place| at(self.bytes, place)).map(i64::from_le_bytes)
    }

    pub(super) fn table(self, number: usize) -> Option<Self> {
        let place = followed(self.bytes, self.field(number)?)?;
        Some(Self { bytes: self.bytes, place })
    }

    pub(super) fn vector(self, number: usize) -> Option<Vector<'b>> {
        let place = followed(self.bytes, self.field(number)?)?;
        let length = index(u32::from_le_bytes(at(self.bytes, place)?))?;
        Some(Vector { bytes: self.bytes, place: place + 4, length })
    }

    pub(super) fn text(self, number: usize) -> Option<&'b str> {
        let Vector { bytes, place, length } = self.vector(number)?;
        core::str::from_utf8(bytes.get(place..place.checked_add(length)?)?).ok()
    }
}

impl<'b> Vector<'b> {
    /// An element that is a table.
    pub(super) fn table(self, element: usize) -> Option<Table<'b>> {
        let place = followed(self.bytes, self.place.checked_add(4 * element)?)?;
        (element < self.length).then_some(Table { bytes: self.bytes, place })
    }

    /// An element that is a structure of two 64-bit numbers.
    pub(super) fn pair(self, element: usize) -> Option<(i64, i64)> {
        let place = self.place.checked_add(16 * element)?;
        let pair = (at(self.bytes, place)?, at(self.bytes, place + 8)?);
        (element < self.length).then_some((i64::from_le_bytes(pair.0), i64::from_le_bytes(pair.1)))
    }

    /// The first number of an element that is a structure of 24 bytes.
    pub(super) fn block(self, element: usize) -> Option<i64> {
        let value = at(self.bytes, self.place.checked_add(24 * element)?)?;
        (element < self.length).then_some(i64::from_le_bytes(value))
    }

    /// An element that is a 64-bit number.
    pub(super) fn long(self, element: usize) -> Option<i64> {
        let value = at(self.bytes, self.place.checked_add(8 * element)?)?;
        (element < self.length).then_some(i64::from_le_bytes(value))
    }
}
