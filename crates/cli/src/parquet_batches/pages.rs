//! The pages of a column of a Parquet file, unpacked: of any codec but LZO.
//!
//! The decoder reads pages itself, but of Brotli only together with code that packs, which is larger than all that unpacks.

use parquet::basic::{Compression, Encoding};
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::ParquetError;
use parquet::file::metadata::ColumnChunkMetaData;
use parquet_pages::{Codec, Damage, Header, Kind, header, unpack};

use super::shared_file::SharedFile;

/// Bytes in which the header of a page is looked for first: it takes some dozens, and its texts of statistics more.
const HEADER_BYTES: u64 = 1 << 8;
/// And at last.
const MOST_HEADER_BYTES: u64 = 1 << 24;

/// Pages, one after the other.
pub(super) struct Pages {
    file: SharedFile,
    codec: Codec,
    /// Where the next header begins, and the column's bytes from there on.
    at: u64,
    left: u64,
    /// The header there, if it was looked at, and its length.
    met: Option<(Header, u64)>,
    /// Bytes of headers, and of packed pages: memory that is used again.
    head: Vec<u8>,
    packed: Vec<u8>,
}

impl Pages {
    pub(super) fn new(
        file: SharedFile,
        column: &ColumnChunkMetaData,
    ) -> Result<Self, ParquetError> {
        let codec = match column.compression() {
            Compression::UNCOMPRESSED => Codec::Unpacked,
            Compression::SNAPPY => Codec::Snappy,
            Compression::GZIP(_) => Codec::Gzip,
            Compression::BROTLI(_) => Codec::Brotli,
            Compression::LZ4 => Codec::Lz4,
            Compression::LZ4_RAW => Codec::Lz4Raw,
            Compression::ZSTD(_) => Codec::Zstandard,
            Compression::LZO => {
                return Err(ParquetError::General("packed by LZO, which is not read".to_owned()));
            }
        };
        let start = column.dictionary_page_offset().unwrap_or_else(|| column.data_page_offset());
        let place = |offset: i64| {
            u64::try_from(offset).map_err(|_| ParquetError::General(format!("a page at {offset}")))
        };
        let (at, left) = (place(start)?, place(column.compressed_size())?);
        Ok(Self { file, codec, at, left, met: None, head: Vec::new(), packed: Vec::new() })
    }

    /// Unpacks the next page, of which it gives what it holds.
    pub(super) fn next(&mut self, page: &mut Vec<u8>) -> Result<Option<Kind>, ParquetError> {
        let Some((header, length)) = self.header()? else { return Ok(None) };
        let place = self.at + length;
        self.go_past(header, length);
        self.packed.resize(header.packed_bytes, 0);
        self.file.read_whole(place, &mut self.packed)?;
        let (levels, codec) = match header.kind {
            Kind::DataV2 { definition_bytes, repetition_bytes, is_packed, .. } => {
                let bytes = u64::from(definition_bytes) + u64::from(repetition_bytes);
                let bytes = usize::try_from(bytes).unwrap_or(usize::MAX);
                (bytes, if is_packed { self.codec } else { Codec::Unpacked })
            }
            _ => (0, self.codec),
        };
        // Levels of the second version are not packed.
        let (Some((levels, values)), Some(stated)) =
            (self.packed.split_at_checked(levels), header.unpacked_bytes.checked_sub(levels))
        else {
            return Err(refused(&Damage::EndsEarly));
        };
        page.resize(page.len().max(levels.len()), 0);
        page[..levels.len()].copy_from_slice(levels);
        unpack(codec, values, stated, page, levels.len()).map_err(|damage| refused(&damage))?;
        Ok(Some(header.kind))
    }

    /// The next header and its length; `None` behind the last page.
    fn header(&mut self) -> Result<Option<(Header, u64)>, ParquetError> {
        if self.left == 0 || self.met.is_some() {
            return Ok(self.met);
        }
        let most = self.left.min(MOST_HEADER_BYTES);
        let mut wanted = HEADER_BYTES;
        loop {
            let bytes = usize::try_from(wanted.min(most)).unwrap_or(usize::MAX);
            self.head.resize(bytes, 0);
            self.file.read_whole(self.at, &mut self.head)?;
            if let Some((header, length)) = header(&self.head) {
                let length = length as u64;
                if length.saturating_add(header.packed_bytes as u64) > self.left {
                    return Err(refused(&Damage::EndsEarly));
                }
                self.met = Some((header, length));
                return Ok(self.met);
            }
            if wanted >= most {
                return Err(ParquetError::General("a damaged header of a page".to_owned()));
            }
            wanted *= 16;
        }
    }

    const fn go_past(&mut self, header: Header, length: u64) {
        let bytes = length + header.packed_bytes as u64;
        (self.at, self.left) = (self.at + bytes, self.left - bytes);
        self.met = None;
    }
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>, ParquetError> {
        loop {
            let mut page = Vec::new();
            let Some(kind) = self.next(&mut page)? else { return Ok(None) };
            if let Some(page) = page_of(kind, page)? {
                return Ok(Some(page));
            }
        }
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>, ParquetError> {
        loop {
            let Some((header, length)) = self.header()? else { return Ok(None) };
            let (num_rows, num_levels, is_dict) = match header.kind {
                Kind::Dictionary { .. } => (None, None, true),
                Kind::Data { values, .. } => (None, Some(values as usize), false),
                Kind::DataV2 { values, rows, .. } => {
                    (Some(rows as usize), Some(values as usize), false)
                }
                Kind::Other => {
                    self.go_past(header, length);
                    continue;
                }
            };
            return Ok(Some(PageMetadata { num_rows, num_levels, is_dict }));
        }
    }

    fn skip_next_page(&mut self) -> Result<(), ParquetError> {
        if let Some((header, length)) = self.header()? {
            self.go_past(header, length);
        }
        Ok(())
    }
}

impl Iterator for Pages {
    type Item = Result<Page, ParquetError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

/// What is wrong with a page, as an error of the decoder.
pub(super) fn refused(damage: &Damage) -> ParquetError {
    ParquetError::General(damage.to_string())
}

/// A page as the decoder takes it; `None` for one that holds no values.
fn page_of(kind: Kind, page: Vec<u8>) -> Result<Option<Page>, ParquetError> {
    let buf = page.into();
    Ok(Some(match kind {
        Kind::Dictionary { values: num_values, encoding, is_sorted } => {
            Page::DictionaryPage { buf, num_values, encoding: encoding_of(encoding)?, is_sorted }
        }
        Kind::Data { values, encoding, definition_encoding, repetition_encoding } => {
            Page::DataPage {
                buf,
                num_values: values,
                encoding: encoding_of(encoding)?,
                def_level_encoding: encoding_of(definition_encoding)?,
                rep_level_encoding: encoding_of(repetition_encoding)?,
                statistics: None,
            }
        }
        Kind::DataV2 {
            values, nulls, rows, encoding, definition_bytes, repetition_bytes, ..
        } => Page::DataPageV2 {
            buf,
            num_values: values,
            encoding: encoding_of(encoding)?,
            num_nulls: nulls,
            num_rows: rows,
            def_levels_byte_len: definition_bytes,
            rep_levels_byte_len: repetition_bytes,
            is_compressed: false,
            statistics: None,
        },
        Kind::Other => return Ok(None),
    }))
}

/// By its number in `parquet.thrift`.
fn encoding_of(number: u32) -> Result<Encoding, ParquetError> {
    Ok(match number {
        0 => Encoding::PLAIN,
        2 => Encoding::PLAIN_DICTIONARY,
        3 => Encoding::RLE,
        #[expect(deprecated, reason = "levels of old files are written so")]
        4 => Encoding::BIT_PACKED,
        5 => Encoding::DELTA_BINARY_PACKED,
        6 => Encoding::DELTA_LENGTH_BYTE_ARRAY,
        7 => Encoding::DELTA_BYTE_ARRAY,
        8 => Encoding::RLE_DICTIONARY,
        9 => Encoding::BYTE_STREAM_SPLIT,
        _ => return Err(ParquetError::General(format!("encoding {number}, which there is not"))),
    })
}
