//! Codecs: packed bytes into those of a page.

use std::fmt::{self, Display, Formatter};
use std::io::Read;

use crate::Damage;

/// How the bytes of a page are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Codec {
    /// Not at all.
    Unpacked,
    /// Snappy.
    Snappy,
    /// gzip.
    Gzip,
    /// Brotli.
    Brotli,
    /// LZ4 in Hadoop's frames; older writers: in its own frames, or in one block.
    Lz4,
    /// LZ4 in one block.
    Lz4Raw,
    /// Zstandard.
    Zstandard,
}

/// Most bytes of a page, unpacked: writers make pages of a megabyte, some of a whole column of a group of rows. Our choice.
pub const MOST_PAGE_BYTES: usize = 1 << 30;

/// Bytes that one packed byte becomes at most: of Snappy, a copy of 64 bytes takes three; of LZ4, each byte of a length adds 255.
const MOST_PER_SNAPPY_BYTE: usize = 22;
const MOST_PER_LZ4_BYTE: usize = 255;

impl Display for Codec {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unpacked => "plain",
            Self::Snappy => "Snappy",
            Self::Gzip => "gzip",
            Self::Brotli => "Brotli",
            Self::Lz4 | Self::Lz4Raw => "LZ4",
            Self::Zstandard => "Zstandard",
        })
    }
}

/// Unpacks bytes to as many as were `stated` in their header, and puts them into `page` in place of what is there from `start` on:
/// of the page before, over which memory need not be cleared.
///
/// # Errors
/// [`Damage`] where they are others; before memory is taken for what they cannot become.
// Inlined into a caller that is compiled for size, the codec would be compiled so too.
#[inline(never)]
pub fn unpack(
    codec: Codec,
    packed: &[u8],
    stated: usize,
    page: &mut Vec<u8>,
    start: usize,
) -> Result<(), Damage> {
    if stated > MOST_PAGE_BYTES {
        return Err(Damage::TooLarge { stated });
    }
    if !matches!(codec, Codec::Snappy | Codec::Lz4Raw) || stated == 0 {
        page.truncate(start);
    }
    let found = match codec {
        Codec::Unpacked => {
            page.extend_from_slice(packed);
            packed.len()
        }
        // A page of nothing but missing values may have no bytes at all.
        _ if stated == 0 => 0,
        Codec::Snappy => {
            let length = snap::raw::decompress_len(packed).map_err(|e| codec.damage(e))?;
            if length != stated {
                return Err(Damage::OtherLength { found: length, stated });
            }
            in_place((page, start), packed, (stated, MOST_PER_SNAPPY_BYTE), |packed, page| {
                snap::raw::Decoder::new().decompress(packed, page).map_err(|e| codec.damage(e))
            })?
        }
        Codec::Lz4Raw => in_place((page, start), packed, (stated, MOST_PER_LZ4_BYTE), lz4_block)?,
        Codec::Lz4 => lz4_of_any_kind(packed, stated, page)?,
        Codec::Gzip => codec.read(flate2::bufread::MultiGzDecoder::new(packed), stated, page)?,
        Codec::Brotli => {
            const BUFFER_BYTES: usize = 1 << 12;
            codec.read(
                brotli_decompressor::Decompressor::new(packed, BUFFER_BYTES),
                stated,
                page,
            )?
        }
        Codec::Zstandard => {
            let decoder = zstd::stream::read::Decoder::with_buffer(packed);
            codec.read(decoder.map_err(|e| codec.damage(e))?, stated, page)?
        }
    };
    if found == stated && page.len() == start + stated {
        return Ok(());
    }
    Err(Damage::OtherLength { found, stated })
}

impl Codec {
    fn damage(self, reason: impl Display) -> Damage {
        Damage::NotPacked { codec: self, reason: reason.to_string() }
    }

    /// Reads to the end, or to a byte more than there has to be.
    fn read(self, source: impl Read, stated: usize, page: &mut Vec<u8>) -> Result<usize, Damage> {
        let most = stated as u64 + 1;
        source.take(most).read_to_end(page).map_err(|error| self.damage(error))
    }
}

/// Unpacks into memory that is taken beforehand, if that is no more than so many bytes for each packed one.
fn in_place(
    (page, start): (&mut Vec<u8>, usize),
    packed: &[u8],
    (stated, most_per_byte): (usize, usize),
    unpack: impl Fn(&[u8], &mut [u8]) -> Result<usize, Damage>,
) -> Result<usize, Damage> {
    let most = packed.len().saturating_mul(most_per_byte);
    if stated > most {
        return Err(Damage::OtherLength { found: most, stated });
    }
    page.resize(start + stated, 0);
    unpack(packed, &mut page[start..])
}

fn lz4_block(packed: &[u8], page: &mut [u8]) -> Result<usize, Damage> {
    lz4_flex::block::decompress_into(packed, page).map_err(|error| Codec::Lz4Raw.damage(error))
}

/// As it was written under the name LZ4: Hadoop's frames, else LZ4's, else one block.
fn lz4_of_any_kind(packed: &[u8], stated: usize, page: &mut Vec<u8>) -> Result<usize, Damage> {
    let start = page.len();
    let bounds = (stated, MOST_PER_LZ4_BYTE);
    if let Ok(found) = in_place((page, start), packed, bounds, hadoop_frames)
        && found == stated
    {
        return Ok(found);
    }
    page.truncate(start);
    let frames = lz4_flex::frame::FrameDecoder::new(packed);
    if let Ok(found) = Codec::Lz4.read(frames, stated, page)
        && found == stated
    {
        return Ok(found);
    }
    page.truncate(start);
    in_place((page, start), packed, bounds, lz4_block)
}

/// Each frame has the lengths of its bytes, unpacked and packed, in four bytes, the highest first.
fn hadoop_frames(mut packed: &[u8], page: &mut [u8]) -> Result<usize, Damage> {
    let length = |bytes: &[u8; 4]| usize::try_from(u32::from_be_bytes(*bytes)).ok();
    let mut found = 0;
    while !packed.is_empty() {
        let lengths = packed.split_first_chunk::<4>().and_then(|(unpacked, rest)| {
            let (packed, rest) = rest.split_first_chunk::<4>()?;
            Some((length(unpacked)?, rest.split_at_checked(length(packed)?)?))
        });
        let (unpacked, (frame, rest)) = lengths.ok_or(Damage::EndsEarly)?;
        let place = page.get_mut(found..).and_then(|page| page.get_mut(..unpacked));
        if lz4_block(frame, place.ok_or(Damage::EndsEarly)?)? != unpacked {
            return Err(Damage::EndsEarly);
        }
        found += unpacked;
        packed = rest;
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    /// Words that occur once and some that occur again: every codec has places to refer to, and much to write out.
    const TEXT: &[u8] = b"Fuel flow of each engine, pressure altitude, Mach number and static air temperature are \
        recorded once a second in level flight; gross mass is that of the load sheet less the fuel burnt since. A segment \
        of cruise is steady where Mach number, pressure altitude and fuel flow of each engine hardly vary.";

    /// Packed by other code than what unpacks, where there is such; Brotli: by hand, as a block that is not packed (RFC 7932,
    /// section 9.2: window of 16 bits, length less one, not the last, then an empty last block).
    fn packed() -> Vec<(Codec, Vec<u8>)> {
        let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
        gzip.write_all(TEXT).unwrap();
        let block = lz4_flex::block::compress(TEXT);
        let lengths = |length: usize| u32::try_from(length).unwrap().to_be_bytes();
        let hadoop = [&lengths(TEXT.len())[..], &lengths(block.len()), &block].concat();
        let mut frame = lz4_flex::frame::FrameEncoder::new(Vec::new());
        frame.write_all(TEXT).unwrap();
        vec![
            (Codec::Unpacked, TEXT.to_vec()),
            (Codec::Snappy, snap::raw::Encoder::new().compress_vec(TEXT).unwrap()),
            (Codec::Gzip, gzip.finish().unwrap()),
            (Codec::Brotli, brotli()),
            (Codec::Lz4, hadoop),
            (Codec::Lz4, frame.finish().unwrap()),
            (Codec::Lz4, block.clone()),
            (Codec::Lz4Raw, block),
            (Codec::Zstandard, zstd::encode_all(TEXT, 3).unwrap()),
        ]
    }

    fn brotli() -> Vec<u8> {
        // Bits, the lowest first: window 0; not last 0; four nibbles 00; length less one in 16 bits; not packed 1; to the byte's end.
        let head: u32 = ((u32::try_from(TEXT.len()).unwrap() - 1) << 4) | (1 << 20);
        let mut bytes = head.to_le_bytes()[..3].to_vec();
        bytes.extend(TEXT);
        bytes.push(0x03);
        bytes
    }

    #[test]
    fn every_codec_gives_back_what_was_packed() {
        for (codec, packed) in packed() {
            for before in [&b"before"[..], &[7; 3], &[7; 300]] {
                let mut page = before.to_vec();
                unpack(codec, &packed, TEXT.len(), &mut page, 3).unwrap();
                assert_eq!(page, [&before[..3], TEXT].concat(), "{codec:?}");
            }
        }
    }

    #[test]
    fn lengths_that_lie_are_refused() {
        for (codec, packed) in packed() {
            for stated in [1, TEXT.len() - 1, TEXT.len() + 1, 1 << 20, MOST_PAGE_BYTES, 1 << 31] {
                let refused = unpack(codec, &packed, stated, &mut Vec::new(), 0);
                assert!(refused.is_err(), "{codec:?} {stated}");
            }
        }
    }

    /// A million zeros in a few bytes are read as far as the header states, and a byte more.
    #[test]
    fn bombs_are_read_no_farther_than_stated() {
        let zeros = vec![0; 1 << 20];
        let bomb = zstd::encode_all(zeros.as_slice(), 3).unwrap();
        let mut page = Vec::new();
        assert_eq!(
            unpack(Codec::Zstandard, &bomb, 1000, &mut page, 0),
            Err(Damage::OtherLength { found: 1001, stated: 1000 })
        );
        assert!(page.capacity() < 1 << 16, "{}", page.capacity());
    }

    #[test]
    fn damaged_bytes_are_refused() {
        for (codec, packed) in packed() {
            assert!(packed.len() > 150, "{codec:?}: cuts of {} bytes test little", packed.len());
            // All content is there in a frame of LZ4 that lacks no more than its end mark, four zeros; every other cut loses some.
            let is_frame = packed.starts_with(&[0x04, 0x22, 0x4d, 0x18]);
            let ending = if is_frame { 4 } else { 0 };
            for length in 0..packed.len() {
                let mut page = Vec::new();
                let cut = unpack(codec, &packed[..length], TEXT.len(), &mut page, 0);
                let is_whole = length + ending >= packed.len();
                assert_eq!(cut.is_ok(), is_whole, "{codec:?} {length} of {}", packed.len());
                assert!(cut.is_err() || page == TEXT, "{codec:?} {length}");
            }
        }
    }
}
