//! Rows of a Parquet file, some thousands at a time and only the columns that are wanted: memory is that of a page of each.

mod cells;
mod footer;
mod pages;
mod present;
mod shared_file;

use std::fs::File;
use std::path::Path;

use crate::arrow_batches::durations;

use cells::{cells_of, skip};
use pages::Pages;
use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type as PhysicalType};
use parquet::column::reader::{ColumnReader, get_column_reader};
use parquet::errors::ParquetError;
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;
use present::Present;
use rayon::prelude::*;
use report::mapping::{Batch, BatchColumn, Source};
pub(crate) use shared_file::SharedFile;

/// Rows of a batch: enough that the work on its ends does not count, few enough that several fit into little memory.
const ROWS_AT_ONCE: usize = 1 << 14;
/// Most digits behind a decimal point: as many as a power of ten can have that double precision holds.
const MOST_DECIMALS: u8 = 22;

/// A Parquet file as a recording.
///
/// # Errors
/// Why it is not read.
pub(crate) fn source(file: File) -> Result<Source<'static>, String> {
    let mut table = Table::open(file).map_err(|error| error.to_string())?;
    let (names, unread) = (table.names(), table.unread());
    let batches =
        move |wanted: &[usize]| table.next_batch(wanted).map_err(|error| error.to_string());
    Ok(Source::table(names, unread, Box::new(batches)))
}

/// The rows of a Parquet file (of any codec but LZO) as comma-separated text, below a line of the column names.
/// Instants are written in UTC, flags as 0 and 1, nothing where there is no value.
///
/// # Errors
/// Why it is not read; a text longer than `most_bytes`.
pub(crate) fn csv_of_file(path: &Path, most_bytes: usize) -> Result<Vec<u8>, String> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    csv_of(file, most_bytes).map_err(|error| error.to_string())
}

/// The names of the columns of a Parquet file.
///
/// # Errors
/// Why it is not read.
pub(crate) fn names_of_file(path: &Path) -> Result<Vec<String>, String> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    Table::open(file).map(|table| table.names()).map_err(|error| error.to_string())
}

/// Columns of a Parquet file that are of a type which is not read.
///
/// # Errors
/// Why it is not read.
pub(crate) fn unread_of_file(path: &Path) -> Result<Vec<String>, String> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    let table = Table::open(file).map_err(|error| error.to_string())?;
    let mut names = table.names();
    Ok(table.unread().into_iter().map(|place| std::mem::take(&mut names[place])).collect())
}

fn csv_of(file: File, most_bytes: usize) -> Result<Vec<u8>, ParquetError> {
    let mut table = Table::open(file)?;
    let names = table.names();
    let mut text = report::mapping::line_of_names(&names);
    let unread = table.unread();
    let wanted: Vec<usize> = (0..names.len()).filter(|place| !unread.contains(place)).collect();
    while let Some(batch) = table.next_batch(&wanted)? {
        text.push_str(&batch.to_text(names.len()));
        // A small file can claim to hold billions of rows.
        if text.len() > most_bytes {
            let limit = most_bytes >> 20;
            let reason = format!("more than {limit} MiB as text, the most that is read");
            return Err(ParquetError::General(reason));
        }
    }
    Ok(text.into_bytes())
}

/// A file whose footer can be decoded.
pub(crate) fn checked(file: File) -> Result<SharedFile, ParquetError> {
    let file = SharedFile::new(file)?;
    footer::check(&file)?;
    Ok(file)
}

/// A reader of a column's values, whatever these are.
pub(crate) fn column_reader(
    file: &SharedFile,
    column: &ColumnChunkMetaData,
) -> Result<ColumnReader, ParquetError> {
    let pages = Pages::new(file.clone(), column)?;
    Ok(get_column_reader(column.column_descr_ptr(), Box::new(pages)))
}

/// A file, and how far it has been read.
struct Table {
    file: SharedFile,
    reader: SerializedFileReader<SharedFile>,
    /// The next group of rows.
    group: usize,
    /// Columns of the group that is being read, and the rows that are left in it.
    columns: Vec<(usize, Column)>,
    left: usize,
    /// Places of columns that lack values, or are otherwise not read as those in which all are there.
    of_any_kind: Vec<usize>,
}

/// What a column's cells become.
#[derive(Clone, Copy)]
enum Kind {
    Number,
    Whole(Whole),
    /// With nanoseconds for each count.
    Instant(i64),
    /// Likewise, on a clock of which the file does not say where it is.
    LocalTime(i64),
    /// Days since 1970.
    Date,
    /// Time of day, with nanoseconds for each count.
    Time(i64),
    Text,
}

/// How whole numbers are written.
#[derive(Clone, Copy)]
struct Whole {
    /// Digits behind the decimal point.
    decimals: u8,
    /// Whether the largest bit counts, and is no sign.
    is_unsigned: bool,
}

/// A column of the group that is being read.
struct Column {
    reading: Reading,
    /// Rows that were read.
    rows: usize,
    kind: Kind,
    is_optional: bool,
    levels: Vec<i16>,
}

/// How a column is read.
enum Reading {
    /// With values missing, or none.
    Any(ColumnReader),
    /// All values are there.
    Present(Present),
}

impl Table {
    fn open(file: File) -> Result<Self, ParquetError> {
        let file = checked(file)?;
        let reader = SerializedFileReader::new(file.clone())?;
        Ok(Self { file, reader, group: 0, columns: Vec::new(), left: 0, of_any_kind: Vec::new() })
    }

    fn names(&self) -> Vec<String> {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        schema.columns().iter().map(|column| column.path().string()).collect()
    }

    /// Places of columns that are not read. Durations are whole numbers, of which only Arrow's own schema states the unit.
    fn unread(&self) -> Vec<usize> {
        let metadata = self.reader.metadata().file_metadata();
        let schema = metadata.schema_descr();
        let of_arrow = metadata.key_value_metadata().into_iter().flatten();
        let of_arrow = of_arrow.filter(|pair| pair.key == "ARROW:schema");
        let durations: Vec<String> =
            of_arrow.filter_map(|pair| pair.value.as_deref()).flat_map(durations).collect();
        let is_unread = |place: &usize| {
            let column = schema.column(*place);
            kind_of(&column).is_none() || durations.contains(&column.path().string())
        };
        (0..schema.num_columns()).filter(is_unread).collect()
    }

    fn next_batch(&mut self, wanted: &[usize]) -> Result<Option<Batch>, ParquetError> {
        while self.left == 0 {
            if self.group == self.reader.num_row_groups() {
                return Ok(None);
            }
            self.begin_group(wanted)?;
        }
        let rows = self.left.min(ROWS_AT_ONCE);
        self.left -= rows;
        let (file, group) = (&self.file, self.reader.metadata().row_group(self.group - 1));
        let columns = self
            .columns
            .par_iter_mut()
            .map(|(place, column)| {
                let anew = || column_reader(file, group.column(*place));
                Ok((*place, column.read_present_or_any(rows, anew)?))
            })
            .collect::<Result<Vec<_>, ParquetError>>()?;
        Ok(Some(Batch { first_row: 0, rows, columns }))
    }

    fn begin_group(&mut self, wanted: &[usize]) -> Result<(), ParquetError> {
        // Pages of the group before are given back before those of this one are taken.
        for (place, column) in self.columns.drain(..) {
            if matches!(column.reading, Reading::Any(_)) && !self.of_any_kind.contains(&place) {
                self.of_any_kind.push(place);
            }
        }
        let unread = self.unread();
        let group = self.reader.metadata().row_group(self.group);
        let schema = self.reader.metadata().file_metadata().schema_descr();
        for place in wanted {
            let column = schema.column(*place);
            let kind = kind_of(&column).filter(|_| !unread.contains(place)).ok_or_else(|| {
                let reason = format!("column {} is of a type that is not read", column.path());
                ParquetError::General(reason)
            })?;
            let is_optional = column.max_def_level() > 0;
            let chunk = group.column(*place);
            let present = if self.of_any_kind.contains(place) {
                None
            } else {
                Present::new(&column, kind, Pages::new(self.file.clone(), chunk)?)
            };
            let reading = match present {
                Some(present) => Reading::Present(present),
                None => Reading::Any(column_reader(&self.file, chunk)?),
            };
            let levels = Vec::new();
            self.columns.push((*place, Column { reading, rows: 0, kind, is_optional, levels }));
        }
        self.left = usize::try_from(group.num_rows()).unwrap_or(0);
        self.group += 1;
        Ok(())
    }
}

/// What the cells of a column become; `None` for what is not read: lists, maps, structures, bytes of a fixed length.
fn kind_of(column: &ColumnDescriptor) -> Option<Kind> {
    if column.path().parts().len() != 1 || column.max_rep_level() > 0 || column.max_def_level() > 1
    {
        return None;
    }
    let is_integer = matches!(column.physical_type(), PhysicalType::INT32 | PhysicalType::INT64);
    let converted = column.converted_type();
    match (column.logical_type_ref(), column.physical_type()) {
        (_, PhysicalType::INT96) => Some(Kind::Instant(1)),
        (Some(LogicalType::Timestamp(form)), PhysicalType::INT64) => {
            let kind = if form.is_adjusted_to_u_t_c { Kind::Instant } else { Kind::LocalTime };
            Some(kind(nanoseconds(form.unit)))
        }
        (Some(LogicalType::Time(form)), _) if is_integer => {
            Some(Kind::Time(nanoseconds(form.unit)))
        }
        (Some(LogicalType::Date), PhysicalType::INT32) => Some(Kind::Date),
        _ if converted == ConvertedType::TIMESTAMP_MILLIS => Some(Kind::Instant(1_000_000)),
        _ if converted == ConvertedType::TIMESTAMP_MICROS => Some(Kind::Instant(1_000)),
        _ if converted == ConvertedType::TIME_MILLIS => Some(Kind::Time(1_000_000)),
        _ if converted == ConvertedType::TIME_MICROS => Some(Kind::Time(1_000)),
        _ if converted == ConvertedType::DATE => Some(Kind::Date),
        _ if converted == ConvertedType::DECIMAL => {
            let decimals = u8::try_from(column.type_scale()).ok();
            let decimals = decimals.filter(|decimals| *decimals <= MOST_DECIMALS)?;
            Some(Kind::Whole(Whole { decimals, is_unsigned: false }))
        }
        (_, PhysicalType::BOOLEAN | PhysicalType::FLOAT | PhysicalType::DOUBLE) => {
            Some(Kind::Number)
        }
        _ if is_integer => {
            // Narrower ones never have the bit of the sign.
            let is_unsigned = matches!(converted, ConvertedType::UINT_32 | ConvertedType::UINT_64);
            Some(Kind::Whole(Whole { decimals: 0, is_unsigned }))
        }
        (_, PhysicalType::BYTE_ARRAY) => Some(Kind::Text),
        _ => None,
    }
}

/// A power of ten: up to 10^22 double precision holds it exactly.
fn power_of_ten(decimals: u8) -> f64 {
    10_f64.powi(i32::from(decimals))
}

const fn nanoseconds(unit: TimeUnit) -> i64 {
    match unit {
        TimeUnit::MILLIS => 1_000_000,
        TimeUnit::MICROS => 1_000,
        TimeUnit::NANOS => 1,
    }
}

impl Column {
    /// Where the column turns out to be one that lacks values, it is read `anew` from the first of these rows on.
    fn read_present_or_any(
        &mut self,
        rows: usize,
        anew: impl FnOnce() -> Result<ColumnReader, ParquetError>,
    ) -> Result<BatchColumn, ParquetError> {
        let before = self.rows;
        self.rows += rows;
        if let Reading::Present(present) = &mut self.reading {
            let read = present.rows(rows);
            if read.is_ok() {
                return read;
            }
            let mut reader = anew()?;
            if skip(&mut reader, before)? != before {
                return Err(ParquetError::General("fewer rows than the file states".to_owned()));
            }
            self.reading = Reading::Any(reader);
        }
        let levels = self.is_optional.then_some(&mut self.levels);
        match &mut self.reading {
            Reading::Any(reader) => cells_of(reader, rows, levels, self.kind),
            Reading::Present(present) => present.rows(rows),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;

    use super::*;

    const ROWS: usize = 3 * ROWS_AT_ONCE + 7;

    fn number(row: usize) -> f64 {
        if row == 2 * ROWS_AT_ONCE + 1000 { f64::NAN } else { (row % 40) as f64 }
    }

    /// So many texts, from half of the rows on, that their dictionary is given up.
    fn text(row: usize) -> String {
        if row < ROWS / 2 { (row / 900).to_string() } else { format!("{row:050}") }
    }

    /// Two groups of a column that lacks one number, far from its beginning, and of texts whose dictionary does not last.
    fn file() -> File {
        let schema = Arc::new(
            parse_message_type("message m { optional double x; optional binary t (UTF8); }")
                .unwrap(),
        );
        let properties = WriterProperties::builder()
            .set_data_page_row_count_limit(5000)
            .set_dictionary_page_size_limit(4096)
            .set_write_batch_size(500)
            .build();
        let file = tempfile::tempfile().unwrap();
        let mut writer =
            SerializedFileWriter::new(file.try_clone().unwrap(), schema, properties.into())
                .unwrap();
        for _ in 0..2 {
            let mut group = writer.next_row_group().unwrap();
            let mut column = group.next_column().unwrap().unwrap();
            let levels: Vec<i16> = (0..ROWS).map(|row| i16::from(!number(row).is_nan())).collect();
            let present: Vec<f64> = (0..ROWS).map(number).filter(|x| !x.is_nan()).collect();
            column.typed::<DoubleType>().write_batch(&present, Some(&levels), None).unwrap();
            column.close().unwrap();
            let mut column = group.next_column().unwrap().unwrap();
            let texts: Vec<ByteArray> =
                (0..ROWS).map(|row| ByteArray::from(text(row).into_bytes())).collect();
            column
                .typed::<ByteArrayType>()
                .write_batch(&texts, Some(&vec![1; ROWS]), None)
                .unwrap();
            column.close().unwrap();
            group.close().unwrap();
        }
        writer.close().unwrap();
        file
    }

    /// Oracle: what was written.
    #[test]
    fn a_column_that_first_lacks_a_value_later_is_read_on_from_there() {
        let mut table = Table::open(file()).unwrap();
        let (mut numbers, mut texts) = (Vec::new(), Vec::new());
        let mut began_present = false;
        while let Some(batch) = table.next_batch(&[0, 1]).unwrap() {
            began_present |= matches!(table.columns[0].1.reading, Reading::Present(..));
            for (_, column) in batch.columns {
                match column {
                    BatchColumn::Numbers(values) | BatchColumn::Finite(values) => {
                        numbers.extend(values);
                    }
                    BatchColumn::Texts(runs) => {
                        texts.extend(runs.into_iter().flat_map(|(text, rows)| vec![text; rows]));
                    }
                    BatchColumn::Instants(_) | BatchColumn::LocalTimes(_) => {
                        unreachable!("columns of numbers and texts")
                    }
                }
            }
        }
        assert!(began_present);
        assert_eq!(table.of_any_kind, [0, 1]);
        let rows: Vec<usize> = (0..ROWS).chain(0..ROWS).collect();
        assert_eq!(texts, rows.iter().map(|row| text(*row)).collect::<Vec<_>>());
        let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(numbers), bits(rows.iter().map(|row| number(*row)).collect()));
    }
}
