//! From bytes to text: gzip, byte-order mark, UTF-8, NUL bytes.

use std::borrow::Cow;
use std::io::{self, BufRead, Read};

use flate2::bufread::MultiGzDecoder;

use crate::refusal::{Found, Refusal, RefusalKind};

/// Largest text that is read from a stream or out of gzip, bytes: several times a long flight with hundreds of
/// parameters each second. A small file can claim to hold terabytes.
pub const MAXIMUM_TEXT_BYTES: usize = 512 << 20;

const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];
pub(crate) const BYTE_ORDER_MARK: char = '\u{feff}';

/// The uncompressed content of `bytes`: unchanged, or unpacked when they begin as gzip does. For callers that need the
/// content in addition to the report, for example to hash it.
///
/// # Errors
/// [`Refusal`] for gzip that is truncated, corrupt, or holds more than [`MAXIMUM_TEXT_BYTES`].
pub fn unpack<'a>(bytes: &'a [u8], unpacked: &'a mut Vec<u8>) -> Result<&'a [u8], Refusal> {
    if !bytes.starts_with(&GZIP_MAGIC) {
        return Ok(bytes);
    }
    unpacked.clear();
    match read_to_limit(MultiGzDecoder::new(bytes), unpacked) {
        Ok(()) => Ok(unpacked),
        Err(error) => {
            let kind = match error {
                LimitedReadError::TooLarge => too_large(),
                LimitedReadError::Io(io::ErrorKind::UnexpectedEof) => RefusalKind::GzipTruncated,
                LimitedReadError::Io(_) => RefusalKind::GzipCorrupt,
            };
            Err(refuse_at(unpacked, unpacked.len(), Found::EndOfText, kind))
        }
    }
}

/// The text that `bytes` holds, plain or gzip; `unpacked` receives decompressed text.
pub(crate) fn text<'a>(bytes: &'a [u8], unpacked: &'a mut Vec<u8>) -> Result<&'a str, Refusal> {
    plain(unpack(bytes, unpacked)?)
}

/// The text of a recording's beginning: from UTF-8, UTF-16 or Windows-1252, which other programs export.
pub(crate) fn recording<'a>(
    bytes: &'a [u8],
    unpacked: &'a mut Vec<u8>,
) -> Result<Cow<'a, str>, Refusal> {
    let bytes = unpack(bytes, unpacked)?;
    match bytes {
        [0xff, 0xfe, rest @ ..] => Ok(Cow::Owned(utf_16(rest, u16::from_le_bytes))),
        [0xfe, 0xff, rest @ ..] => Ok(Cow::Owned(utf_16(rest, u16::from_be_bytes))),
        _ if core::str::from_utf8(bytes).is_ok() || memchr::memchr(0, bytes).is_some() => {
            plain(bytes).map(Cow::Borrowed)
        }
        _ => Ok(Cow::Owned(bytes.iter().map(|byte| windows_1252(*byte)).collect())),
    }
}

/// Whole lines of a recording, in UTF-8 or Windows-1252.
pub(crate) fn piece(bytes: Vec<u8>) -> Result<String, Refusal> {
    if let Some(at) = memchr::memchr(0, &bytes) {
        return Err(refuse_at(&bytes, at, Found::Byte(0), RefusalKind::NulByte));
    }
    Ok(String::from_utf8(bytes)
        .unwrap_or_else(|error| error.as_bytes().iter().map(|byte| windows_1252(*byte)).collect()))
}

/// Text of 16-bit units; what is no character becomes U+FFFD.
pub(crate) fn utf_16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units).map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

/// The character of a byte of Windows-1252; the five bytes that it leaves undefined stay control characters.
///
/// # Source
/// WHATWG, Encoding Standard, index windows-1252.
fn windows_1252(byte: u8) -> char {
    const FROM_0X80: [char; 32] = [
        '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž',
        '\u{8f}', '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}',
        'ž', 'Ÿ',
    ];
    match byte {
        0x80..=0x9f => FROM_0X80[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

/// All bytes of a stream.
pub(crate) fn bytes_of(stream: impl BufRead, bytes: &mut Vec<u8>) -> Result<(), Refusal> {
    bytes.clear();
    read_to_limit(stream, bytes).map_err(|error| {
        let kind = match error {
            LimitedReadError::TooLarge => too_large(),
            LimitedReadError::Io(error) => RefusalKind::Unreadable { error },
        };
        refuse_at(bytes, bytes.len(), Found::EndOfText, kind)
    })
}

/// The whole lines in the first bytes of a report, plain or gzip.
pub(crate) fn beginning<'a>(bytes: &'a [u8], unpacked: &'a mut Vec<u8>) -> Option<&'a str> {
    /// A header is a fraction of this; the first bytes of a small file can claim to hold terabytes.
    const MOST_BYTES: u64 = 64 << 10;
    let bytes = if bytes.starts_with(&GZIP_MAGIC) {
        unpacked.clear();
        // The packed text is cut off: what was unpacked before its end is what is asked for.
        let _ = MultiGzDecoder::new(bytes).take(MOST_BYTES).read_to_end(unpacked);
        unpacked
    } else {
        bytes
    };
    let end = memchr::memrchr(b'\n', bytes)? + 1;
    plain(&bytes[..end]).ok()
}

enum LimitedReadError {
    TooLarge,
    Io(io::ErrorKind),
}

const fn too_large() -> RefusalKind {
    RefusalKind::TooLarge { limit_bytes: MAXIMUM_TEXT_BYTES }
}

fn read_to_limit(stream: impl Read, bytes: &mut Vec<u8>) -> Result<(), LimitedReadError> {
    let limit = MAXIMUM_TEXT_BYTES as u64 + 1;
    stream.take(limit).read_to_end(bytes).map_err(|error| LimitedReadError::Io(error.kind()))?;
    if bytes.len() > MAXIMUM_TEXT_BYTES { Err(LimitedReadError::TooLarge) } else { Ok(()) }
}

fn plain(bytes: &[u8]) -> Result<&str, Refusal> {
    if let Some(at) = memchr::memchr(0, bytes) {
        return Err(refuse_at(bytes, at, Found::Byte(0), RefusalKind::NulByte));
    }
    let text = core::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        refuse_at(bytes, at, Found::Byte(bytes[at]), RefusalKind::InvalidUtf8)
    })?;
    Ok(text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text))
}

/// Refuses at a byte of a text that is perhaps not UTF-8.
pub(crate) fn refuse_at(bytes: &[u8], at: usize, found: Found, kind: RefusalKind) -> Refusal {
    let before = &bytes[..at];
    let line_start = memchr::memrchr(b'\n', before).map_or(0, |end| end + 1);
    let line = memchr::memchr_iter(b'\n', before).count() + 1;
    let line_text = String::from_utf8_lossy(&before[line_start..]);
    let marks = usize::from(line == 1 && line_text.starts_with(BYTE_ORDER_MARK));
    Refusal { line, column: line_text.chars().count() - marks + 1, found, kind }
}
