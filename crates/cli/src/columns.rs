//! Tables of named columns, written as CSV or Parquet. An absent value is an empty field in CSV, a null in Parquet.

mod given;

use std::path::Path;
use std::sync::Arc;

use given::Given;
use parquet::basic::{Compression, LogicalType, Repetition, Type as PhysicalType, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{ColumnDescriptor, ColumnPath, Type};
use pipeline::columns::{Cells, Columns};

use crate::failure::Failure;
use crate::files::is_device_or_pipe;
use crate::files::outputs::{check_table, write_parquet, write_result};

/// Values that are encoded together.
const VALUES_AT_ONCE: usize = 1 << 16;

/// Writes to a file whose ending chooses the format, or as CSV to standard output, which `-` means too, and to a device or pipe of
/// another ending.
///
/// # Errors
/// An ending that is neither `.csv` nor `.parquet`, a file that would be lost, or one that cannot be written.
pub(crate) fn write(columns: &Columns, path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path.filter(|path| path.as_os_str() != "-") else {
        return match crate::terminal::print_data(&columns.to_csv()) {
            // Whoever reads has enough.
            Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
            Err(error) => Err(Failure::unwritable(Path::new("standard output"), error)),
            Ok(()) => Ok(()),
        };
    };
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => write_result(path, &columns.to_csv()),
        Some("parquet") => {
            let bytes =
                to_parquet(columns, None).map_err(|error| Failure::unwritable(path, error))?;
            write_parquet(path, &bytes, &names(columns))
        }
        _ if is_device_or_pipe(path) => write_result(path, &columns.to_csv()),
        _ => Err(Failure::BadArgument {
            argument: "--output",
            reason: format!("{} ends neither in .csv nor in .parquet", path.display()),
        }),
    }
}

/// Refuses what [`write`] would refuse to replace, before anything is written: of several results all or none.
///
/// # Errors
/// A file that would be lost.
pub(crate) fn check(columns: &Columns, path: &Path) -> Result<(), Failure> {
    check_table(path, &names(columns))
}

/// Whether a file of this name becomes one in Parquet.
pub(crate) fn is_parquet_name(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "parquet")
}

/// The same where the first columns of the table are all that a Parquet file has: in Parquet they go out as they came, with type and
/// value.
///
/// # Errors
/// As those of [`write`]; a file given that cannot be read.
pub(crate) fn write_beside(
    given: &Path,
    columns: &Columns,
    path: Option<&Path>,
) -> Result<(), Failure> {
    let Some(output) = path.filter(|path| is_parquet_name(path)) else {
        return write(columns, path);
    };
    let given = Given::open(given).map_err(|error| Failure::unreadable(given, error))?;
    let bytes =
        to_parquet(columns, Some(&given)).map_err(|error| Failure::unwritable(output, error))?;
    write_parquet(output, &bytes, &names(columns))
}

fn names(columns: &Columns) -> Vec<&str> {
    columns.iter().map(|(name, _)| name).collect()
}

/// The table as one Parquet file with one row group, Zstandard compressed; its first columns are those of the file given.
fn to_parquet(columns: &Columns, given: Option<&Given>) -> Result<Vec<u8>, ParquetError> {
    let mut fields = given.map_or_else(Vec::new, |given| given.fields().to_vec());
    let leaves: Vec<&ColumnDescriptor> = given.into_iter().flat_map(Given::leaves).collect();
    for (name, cells) in columns.iter().skip(leaves.len()) {
        let (physical, logical, repetition) = match cells {
            Cells::Text(_) => {
                (PhysicalType::BYTE_ARRAY, Some(LogicalType::String), Repetition::REQUIRED)
            }
            Cells::Count(_) => (PhysicalType::INT64, None, Repetition::REQUIRED),
            Cells::Number(_) | Cells::Dense(_) => {
                (PhysicalType::DOUBLE, None, Repetition::OPTIONAL)
            }
        };
        fields.push(Arc::new(
            Type::primitive_type_builder(name, physical)
                .with_logical_type(logical)
                .with_repetition(repetition)
                .build()?,
        ));
    }
    let schema = Type::group_type_builder("segments").with_fields(fields).build()?;
    // No creation time or program version goes in: same input, same bytes.
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(3)?))
        .set_created_by("cruisefit".to_owned());
    // Millions of measured or computed numbers repeat too seldom for a dictionary.
    let dense = columns.iter().skip(leaves.len());
    let dense = dense.filter(|(_, cells)| matches!(cells, Cells::Dense(_)));
    let given_numbers = leaves.iter().filter(|leaf| leaf.physical_type() == PhysicalType::DOUBLE);
    let paths = given_numbers.map(|leaf| leaf.path().clone());
    for path in paths.chain(dense.map(|(name, _)| ColumnPath::from(name))) {
        properties = properties.set_column_dictionary_enabled(path, false);
    }
    let properties = properties.build();
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    if let Some(given) = given {
        for leaf in 0..leaves.len() {
            let Some(mut column) = group.next_column()? else { break };
            given.copy(leaf, &mut column)?;
            column.close()?;
        }
    }
    for (_, cells) in columns.iter().skip(leaves.len()) {
        let Some(mut column) = group.next_column()? else { break };
        write_cells(cells, &mut column)?;
        column.close()?;
    }
    group.close()?;
    writer.close()?;
    Ok(bytes)
}

fn write_cells(cells: &Cells, column: &mut SerializedColumnWriter<'_>) -> Result<(), ParquetError> {
    match cells {
        Cells::Text(values) => {
            let values: Vec<ByteArray> = values.iter().map(ByteArray::from).collect();
            column.typed::<ByteArrayType>().write_batch(&values, None, None)?;
        }
        Cells::Count(values) => {
            let values: Vec<i64> =
                values.iter().map(|value| i64::try_from(*value).unwrap_or(i64::MAX)).collect();
            column.typed::<Int64Type>().write_batch(&values, None, None)?;
        }
        Cells::Number(values) => {
            let present: Vec<f64> = values.iter().flatten().copied().collect();
            let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
            column.typed::<DoubleType>().write_batch(&present, Some(&levels), None)?;
        }
        Cells::Dense(values) => {
            for values in values.chunks(VALUES_AT_ONCE) {
                let present: Vec<f64> =
                    values.iter().copied().filter(|value| !value.is_nan()).collect();
                let levels: Vec<i16> =
                    values.iter().map(|value| i16::from(!value.is_nan())).collect();
                column.typed::<DoubleType>().write_batch(&present, Some(&levels), None)?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    use super::*;

    fn table() -> Columns {
        let mut columns = Columns::default();
        columns.text("tail", ["T-001", "T, \"2\""].into_iter().map(str::to_owned));
        columns.count("samples", [9, 10].into_iter());
        columns.number("mach", [Some(0.1 + 0.2), None].into_iter());
        columns
    }

    #[test]
    fn parquet_reads_back() {
        let bytes = to_parquet(&table(), None).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.parquet");
        std::fs::write(&path, &bytes).unwrap();
        let reader = SerializedFileReader::new(std::fs::File::open(&path).unwrap()).unwrap();
        let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 2);
        assert_eq!(rows[0].get_string(0).unwrap(), "T-001");
        assert_eq!(rows[1].get_long(1).unwrap(), 10);
        assert_eq!(rows[0].get_double(2).unwrap().to_bits(), (0.1_f64 + 0.2).to_bits());
        assert!(rows[1].get_double(2).is_err());
        assert_eq!(to_parquet(&table(), None).unwrap(), bytes);
    }
}
