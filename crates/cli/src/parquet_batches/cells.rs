//! The values of a column of a Parquet file as cells of a table.

use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType, DoubleType, Int96};
use parquet::errors::ParquetError;
use report::mapping::{BatchColumn, NO_INSTANT, date_text, text_runs, time_of_day_text};

use super::Kind;

const DAY_S: i64 = 86_400;

/// Goes past rows; gives how many there were.
pub(super) fn skip(reader: &mut ColumnReader, rows: usize) -> Result<usize, ParquetError> {
    match reader {
        ColumnReader::BoolColumnReader(reader) => reader.skip_records(rows),
        ColumnReader::Int32ColumnReader(reader) => reader.skip_records(rows),
        ColumnReader::Int64ColumnReader(reader) => reader.skip_records(rows),
        ColumnReader::Int96ColumnReader(reader) => reader.skip_records(rows),
        ColumnReader::FloatColumnReader(reader) => reader.skip_records(rows),
        ColumnReader::DoubleColumnReader(reader) => reader.skip_records(rows),
        ColumnReader::ByteArrayColumnReader(reader) => reader.skip_records(rows),
        ColumnReader::FixedLenByteArrayColumnReader(reader) => reader.skip_records(rows),
    }
}

/// The cells of the next rows, whatever their type; `levels` where some may be missing.
pub(super) fn cells_of(
    reader: &mut ColumnReader,
    rows: usize,
    levels: Option<&mut Vec<i16>>,
    kind: Kind,
) -> Result<BatchColumn, ParquetError> {
    match reader {
        ColumnReader::DoubleColumnReader(reader) => doubles(reader, rows, levels),
        ColumnReader::FloatColumnReader(reader) => {
            numbers(reader, rows, levels, |value| f64::from(*value))
        }
        ColumnReader::BoolColumnReader(reader) => {
            numbers(reader, rows, levels, |value| f64::from(u8::from(*value)))
        }
        ColumnReader::Int32ColumnReader(reader) => {
            counts(reader, rows, levels, kind, |value| i64::from(*value))
        }
        ColumnReader::Int64ColumnReader(reader) => {
            counts(reader, rows, levels, kind, |value| *value)
        }
        ColumnReader::Int96ColumnReader(reader) => {
            counts(reader, rows, levels, kind, Int96::to_nanos)
        }
        ColumnReader::ByteArrayColumnReader(reader) => texts(reader, rows, levels),
        ColumnReader::FixedLenByteArrayColumnReader(_) => {
            Err(ParquetError::General("bytes of a fixed length are not read".to_owned()))
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
        BatchColumn::Texts(text_runs(cells))
    };
    Ok(match kind {
        #[expect(clippy::cast_precision_loss, reason = "counts of recorders are below 2^53")]
        Kind::Number(factor) => BatchColumn::Numbers(
            cells.iter().map(|cell| cell.map_or(f64::NAN, |count| count as f64 * factor)).collect(),
        ),
        Kind::Instant(each) => BatchColumn::Instants(times(each, &cells)),
        Kind::LocalTime(each) => BatchColumn::LocalTimes(times(each, &cells)),
        Kind::Date => text(|days, day_s| date_text(days.saturating_mul(day_s)), DAY_S),
        Kind::Time(each) => text(time_of_day_text, each),
        Kind::Text => BatchColumn::Texts(Vec::new()),
    })
}

/// Counts of these many nanoseconds as nanoseconds; none where that is more than a number holds.
fn times(each: i64, cells: &[Option<i64>]) -> Vec<i64> {
    let time = |count: i64| count.checked_mul(each);
    cells.iter().map(|cell| cell.and_then(time).unwrap_or(NO_INSTANT)).collect()
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
    let mut runs: Vec<(String, usize)> = Vec::new();
    match levels {
        Some(levels) if present.len() < rows => {
            let mut present = present.iter();
            for level in levels.iter() {
                let cell = if *level > 0 { present.next() } else { None };
                add_run(&mut runs, cell.map_or(&[], ByteArray::data), 1);
            }
        }
        _ => present.iter().for_each(|cell| add_run(&mut runs, cell.data(), 1)),
    }
    Ok(BatchColumn::Texts(runs))
}

/// Adds rows that hold the same text.
pub(super) fn add_run(runs: &mut Vec<(String, usize)>, text: &[u8], rows: usize) {
    match runs.last_mut() {
        Some((last, count)) if last.as_bytes() == text => *count += rows,
        _ => runs.push((String::from_utf8_lossy(text).into_owned(), rows)),
    }
}
