//! Rows of a Parquet file as comma-separated text.

use std::path::Path;

use flight::Timestamp;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use report::MAXIMUM_TEXT_BYTES;

/// What a Parquet file begins with.
const MAGIC: &[u8] = b"PAR1";

/// Whether these are the first bytes of a Parquet file.
pub(crate) fn is_parquet(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// The rows of a Parquet file (of any codec but Brotli and LZO), below a line of the column names. Instants are written in UTC, flags as 0 and
/// 1, nothing where there is no value.
///
/// # Errors
/// Why it is not read.
pub(crate) fn csv_of_file(path: &Path) -> Result<Vec<u8>, String> {
    let file = std::fs::File::open(path).map_err(|error| error.to_string())?;
    csv_of(file).map_err(|error| error.to_string())
}

fn csv_of(file: std::fs::File) -> Result<Vec<u8>, ParquetError> {
    let reader = SerializedFileReader::new(file)?;
    let schema = reader.metadata().file_metadata().schema_descr();
    let names = schema.root_schema().get_fields().iter().map(|field| field.name());
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    // Writing to memory cannot fail.
    let _ = writer.write_record(names);
    for row in reader.get_row_iter(None)? {
        let _ = writer.write_record(row?.get_column_iter().map(|(_, field)| cell(field)));
        // A small file can claim to hold billions of rows.
        if writer.get_ref().len() > MAXIMUM_TEXT_BYTES {
            let limit = MAXIMUM_TEXT_BYTES >> 20;
            let reason = format!("more than {limit} MiB as text, the most that is read");
            return Err(ParquetError::General(reason));
        }
    }
    writer.into_inner().map_err(|error| ParquetError::General(error.to_string()))
}

fn cell(field: &Field) -> String {
    let instant = |known: Option<Timestamp>| {
        known.map_or_else(|| field.to_string(), |instant| instant.to_string())
    };
    match field {
        Field::Null => String::new(),
        Field::Str(text) => text.clone(),
        Field::Bytes(bytes) => String::from_utf8_lossy(bytes.data()).into_owned(),
        Field::Double(value) => value.to_string(),
        Field::Float(value) => value.to_string(),
        Field::Bool(flag) => u8::from(*flag).to_string(),
        Field::TimestampMillis(count) => instant(Timestamp::from_millisecond(*count).ok()),
        Field::TimestampMicros(count) => instant(Timestamp::from_microsecond(*count).ok()),
        other => other.to_string(),
    }
}
