//! Parquet files of nothing but numbers, column by column.

use std::path::Path;

use parquet::basic::Type as PhysicalType;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};

use crate::parquet_batches::{checked, column_reader};

/// Most values that are read: a small file can claim to hold billions. Our choice: 4 GiB in memory.
const MOST_VALUES: usize = 1 << 29;
/// Values that are decoded together.
const VALUES_AT_ONCE: usize = 1 << 16;

/// Names of columns and their values, NaN where there is none.
pub(crate) type NumberColumns = Vec<(String, Vec<f64>)>;

/// The columns of a Parquet file whose columns are all of double-precision numbers; `None` for any other.
///
/// # Errors
/// Why it is not read.
pub(crate) fn columns_of_file(path: &Path) -> Result<Option<NumberColumns>, String> {
    let file = std::fs::File::open(path).map_err(|error| error.to_string())?;
    columns_of(file).map_err(|error| error.to_string())
}

fn columns_of(file: std::fs::File) -> Result<Option<NumberColumns>, ParquetError> {
    let file = checked(file)?;
    let reader = SerializedFileReader::new(file.clone())?;
    let schema = reader.metadata().file_metadata().schema_descr();
    let is_plain = schema.columns().iter().all(|column| {
        column.physical_type() == PhysicalType::DOUBLE
            && column.path().parts().len() == 1
            && column.max_rep_level() == 0
            && column.max_def_level() <= 1
    });
    let rows = usize::try_from(reader.metadata().file_metadata().num_rows()).unwrap_or(usize::MAX);
    if !is_plain || schema.num_columns() == 0 {
        return Ok(None);
    }
    let most_rows = MOST_VALUES / schema.num_columns();
    if rows > most_rows {
        let reason =
            format!("{rows} rows, more than the {most_rows} that are read of such columns");
        return Err(ParquetError::General(reason));
    }
    let mut columns: NumberColumns =
        schema.columns().iter().map(|column| (column.name().to_owned(), Vec::new())).collect();
    for group in 0..reader.num_row_groups() {
        let group = reader.metadata().row_group(group);
        for (place, (_, values)) in columns.iter_mut().enumerate() {
            if let ColumnReader::DoubleColumnReader(column) =
                column_reader(&file, group.column(place))?
            {
                let is_optional = schema.column(place).max_def_level() > 0;
                append(column, is_optional, most_rows, values)?;
            }
        }
    }
    Ok(Some(columns))
}

fn append(
    mut column: ColumnReaderImpl<DoubleType>,
    is_optional: bool,
    most: usize,
    values: &mut Vec<f64>,
) -> Result<(), ParquetError> {
    let (mut present, mut levels) = (Vec::new(), Vec::new());
    loop {
        present.clear();
        levels.clear();
        let wanted_levels = is_optional.then_some(&mut levels);
        let (rows, _, _) =
            column.read_records(VALUES_AT_ONCE, wanted_levels, None, &mut present)?;
        if rows == 0 {
            return Ok(());
        }
        if values.len() + rows > most {
            return Err(ParquetError::General("more rows than the file states".to_owned()));
        }
        if present.len() == rows {
            values.extend_from_slice(&present);
        } else {
            let mut present = present.iter();
            let value = |level: &i16| {
                if *level > 0 { present.next().copied().unwrap_or(f64::NAN) } else { f64::NAN }
            };
            values.extend(levels.iter().map(value));
        }
    }
}
