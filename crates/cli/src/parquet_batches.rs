//! Rows of a Parquet file, some thousands at a time and only the columns that are wanted: memory is that of a page of each.

mod footer;
mod shared_file;

use std::fs::File;
use std::path::Path;

use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type as PhysicalType};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType, DoubleType, Int96};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;
use rayon::prelude::*;
use report::mapping::{Batch, BatchColumn, Source};
use shared_file::SharedFile;

use crate::cells::{date, runs, time_of_day};

const DAY_S: i64 = 86_400;
/// Rows of a batch: enough that the work on its ends does not count, few enough that several fit into little memory.
const ROWS_AT_ONCE: usize = 1 << 14;

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

/// The rows of a Parquet file (of any codec but Brotli and LZO) as comma-separated text, below a line of the column names.
/// Instants are written in UTC, flags as 0 and 1, nothing where there is no value.
///
/// # Errors
/// Why it is not read; a text longer than `most_bytes`.
pub(crate) fn csv_of_file(path: &Path, most_bytes: usize) -> Result<Vec<u8>, String> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    csv_of(file, most_bytes).map_err(|error| error.to_string())
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

/// A file, and how far it has been read.
struct Table {
    reader: SerializedFileReader<SharedFile>,
    /// The next group of rows.
    group: usize,
    /// Columns of the group that is being read, and the rows that are left in it.
    columns: Vec<(usize, Column)>,
    left: usize,
}

/// What a column's cells become.
#[derive(Clone, Copy)]
enum Kind {
    /// Times this.
    Number(f64),
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

/// A column of the group that is being read.
struct Column {
    reader: ColumnReader,
    kind: Kind,
    is_optional: bool,
    levels: Vec<i16>,
}

impl Table {
    fn open(file: File) -> Result<Self, ParquetError> {
        let file = SharedFile::new(file)?;
        footer::check(&file)?;
        let reader = SerializedFileReader::new(file)?;
        Ok(Self { reader, group: 0, columns: Vec::new(), left: 0 })
    }

    fn names(&self) -> Vec<String> {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        schema.columns().iter().map(|column| column.path().string()).collect()
    }

    /// Places of columns that are not read.
    fn unread(&self) -> Vec<usize> {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        let is_unread = |place: &usize| kind_of(&schema.column(*place)).is_none();
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
        let columns = self
            .columns
            .par_iter_mut()
            .map(|(place, column)| Ok((*place, column.read(rows)?)))
            .collect::<Result<Vec<_>, ParquetError>>()?;
        Ok(Some(Batch { first_row: 0, rows, columns }))
    }

    fn begin_group(&mut self, wanted: &[usize]) -> Result<(), ParquetError> {
        // Pages of the group before are given back before those of this one are taken.
        self.columns.clear();
        let group = self.reader.get_row_group(self.group)?;
        let schema = self.reader.metadata().file_metadata().schema_descr();
        for place in wanted {
            let column = schema.column(*place);
            let kind = kind_of(&column).ok_or_else(|| {
                let reason = format!("column {} is of a type that is not read", column.path());
                ParquetError::General(reason)
            })?;
            let is_optional = column.max_def_level() > 0;
            let reader = group.get_column_reader(*place)?;
            let levels = Vec::new();
            self.columns.push((*place, Column { reader, kind, is_optional, levels }));
        }
        self.left = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        self.group += 1;
        Ok(())
    }
}

/// What the cells of a column become; `None` for what is not read: lists, maps, structures, decimals of more than 18 digits.
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
        _ if converted == ConvertedType::DECIMAL && is_integer => {
            Some(Kind::Number(0.1_f64.powi(column.type_scale())))
        }
        (_, PhysicalType::BOOLEAN | PhysicalType::FLOAT | PhysicalType::DOUBLE) => {
            Some(Kind::Number(1.0))
        }
        _ if is_integer => Some(Kind::Number(1.0)),
        (_, PhysicalType::BYTE_ARRAY) if converted != ConvertedType::DECIMAL => Some(Kind::Text),
        _ => None,
    }
}

const fn nanoseconds(unit: TimeUnit) -> i64 {
    match unit {
        TimeUnit::MILLIS => 1_000_000,
        TimeUnit::MICROS => 1_000,
        TimeUnit::NANOS => 1,
    }
}

impl Column {
    fn read(&mut self, rows: usize) -> Result<BatchColumn, ParquetError> {
        let Self { reader, kind, is_optional, levels } = self;
        let levels = is_optional.then_some(levels);
        match reader {
            ColumnReader::DoubleColumnReader(reader) => doubles(reader, rows, levels),
            ColumnReader::FloatColumnReader(reader) => {
                numbers(reader, rows, levels, |value| f64::from(*value))
            }
            ColumnReader::BoolColumnReader(reader) => {
                numbers(reader, rows, levels, |value| f64::from(u8::from(*value)))
            }
            ColumnReader::Int32ColumnReader(reader) => {
                counts(reader, rows, levels, *kind, |value| i64::from(*value))
            }
            ColumnReader::Int64ColumnReader(reader) => {
                counts(reader, rows, levels, *kind, |value| *value)
            }
            ColumnReader::Int96ColumnReader(reader) => {
                counts(reader, rows, levels, *kind, Int96::to_nanos)
            }
            ColumnReader::ByteArrayColumnReader(reader) => texts(reader, rows, levels),
            ColumnReader::FixedLenByteArrayColumnReader(_) => {
                Err(ParquetError::General("bytes of a fixed length are not read".to_owned()))
            }
        }
    }
}

/// Cells of a column of whole numbers.
fn counts<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    levels: Option<&mut Vec<i16>>,
    kind: Kind,
    count: impl Fn(&T::T) -> i64,
) -> Result<BatchColumn, ParquetError> {
    let cells = cells(reader, rows, levels, None, |value| Some(count(value)))?;
    let text = |text: fn(i64, i64) -> String, each: i64| {
        let cells =
            cells.iter().map(|cell| cell.map_or_else(String::new, |count| text(count, each)));
        BatchColumn::Texts(runs(cells))
    };
    Ok(match kind {
        #[expect(clippy::cast_precision_loss, reason = "counts of recorders are below 2^53")]
        Kind::Number(factor) => BatchColumn::Numbers(
            cells.iter().map(|cell| cell.map_or(f64::NAN, |count| count as f64 * factor)).collect(),
        ),
        Kind::Instant(each) => BatchColumn::Instants(
            cells.iter().map(|cell| cell.and_then(|count| count.checked_mul(each))).collect(),
        ),
        Kind::LocalTime(each) => BatchColumn::LocalTimes(
            cells.iter().map(|cell| cell.and_then(|count| count.checked_mul(each))).collect(),
        ),
        Kind::Date => text(|days, day_s| date(days.saturating_mul(day_s)), DAY_S),
        Kind::Time(each) => text(time_of_day, each),
        Kind::Text => BatchColumn::Texts(Vec::new()),
    })
}

fn numbers<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    levels: Option<&mut Vec<i16>>,
    number: impl Fn(&T::T) -> f64,
) -> Result<BatchColumn, ParquetError> {
    Ok(BatchColumn::Numbers(cells(reader, rows, levels, f64::NAN, number)?))
}

/// Numbers of double precision; nearly always there are as many as rows.
fn doubles(
    reader: &mut ColumnReaderImpl<DoubleType>,
    rows: usize,
    mut levels: Option<&mut Vec<i16>>,
) -> Result<BatchColumn, ParquetError> {
    let present = records(reader, rows, levels.as_deref_mut())?;
    Ok(BatchColumn::Numbers(match levels {
        Some(levels) if present.len() < rows => {
            spaced(present.iter(), levels, &f64::NAN, |value| *value)
        }
        _ => present,
    }))
}

/// Cells of a column, `missing` where there is none.
fn cells<T: DataType, C: Clone>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    mut levels: Option<&mut Vec<i16>>,
    missing: C,
    cell: impl Fn(&T::T) -> C,
) -> Result<Vec<C>, ParquetError> {
    let present = records(reader, rows, levels.as_deref_mut())?;
    match levels {
        Some(levels) if present.len() < rows => Ok(spaced(present.iter(), levels, &missing, cell)),
        _ => Ok(present.iter().map(cell).collect()),
    }
}

/// Values where a level says that there is one, `missing` elsewhere.
fn spaced<'v, V: 'v, C: Clone>(
    mut present: impl Iterator<Item = &'v V>,
    levels: &[i16],
    missing: &C,
    cell: impl Fn(&V) -> C,
) -> Vec<C> {
    let of_level = |level: &i16| {
        let value = if *level > 0 { present.next() } else { None };
        value.map_or_else(|| missing.clone(), &cell)
    };
    levels.iter().map(of_level).collect()
}

/// The values of the next rows: those that there are.
fn records<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    mut levels: Option<&mut Vec<i16>>,
) -> Result<Vec<T::T>, ParquetError> {
    let mut present = Vec::with_capacity(rows);
    if let Some(levels) = levels.as_deref_mut() {
        levels.clear();
    }
    let mut read = 0;
    while read < rows {
        let (some, _, _) =
            reader.read_records(rows - read, levels.as_deref_mut(), None, &mut present)?;
        if some == 0 {
            return Err(ParquetError::General("fewer rows than the file states".to_owned()));
        }
        read += some;
    }
    Ok(present)
}

/// Texts, each with the number of rows that it holds for.
fn texts(
    reader: &mut ColumnReaderImpl<parquet::data_type::ByteArrayType>,
    rows: usize,
    levels: Option<&mut Vec<i16>>,
) -> Result<BatchColumn, ParquetError> {
    let mut levels = levels;
    let present = records(reader, rows, levels.as_deref_mut())?;
    let nothing = ByteArray::from("");
    let mut runs: Vec<(String, usize)> = Vec::new();
    let mut add = |cell: &ByteArray| match runs.last_mut() {
        Some((text, count)) if text.as_bytes() == cell.data() => *count += 1,
        _ => runs.push((String::from_utf8_lossy(cell.data()).into_owned(), 1)),
    };
    match levels {
        Some(levels) if present.len() < rows => {
            let mut present = present.iter();
            for level in levels.iter() {
                let cell = if *level > 0 { present.next() } else { None };
                add(cell.unwrap_or(&nothing));
            }
        }
        _ => present.iter().for_each(add),
    }
    Ok(BatchColumn::Texts(runs))
}
