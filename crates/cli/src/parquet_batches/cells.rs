//! The values of a column of a Parquet file as cells of a table.

use parquet::basic::Type as PhysicalType;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{AsBytes, ByteArray, DataType, DoubleType, Int96};
use parquet::errors::ParquetError;
use report::mapping::{BatchColumn, NO_INSTANT, date_text, text_runs, time_of_day_text};

use super::{Kind, Whole, power_of_ten};

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
        ColumnReader::ByteArrayColumnReader(reader) => match kind {
            Kind::Whole(whole) => decimals_in_bytes(reader, rows, levels, whole.decimals),
            _ => texts(reader, rows, levels),
        },
        ColumnReader::FixedLenByteArrayColumnReader(reader) => match kind {
            Kind::Whole(whole) => decimals_in_bytes(reader, rows, levels, whole.decimals),
            _ => Err(ParquetError::General("bytes of a fixed length are not read".to_owned())),
        },
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
        Kind::Whole(whole) => {
            let physical = T::get_physical_type();
            let value = |count| signed_or_not(count, whole, physical);
            let cells: Vec<Option<i128>> = cells.iter().map(|cell| cell.map(value)).collect();
            whole_numbers(whole.decimals, &cells)
        }
        Kind::Instant(each) => BatchColumn::Instants(times(each, &cells)),
        Kind::LocalTime(each) => BatchColumn::LocalTimes(times(each, &cells)),
        Kind::Date => text(|days, day_s| date_text(days.saturating_mul(day_s)), DAY_S),
        Kind::Time(each) => text(time_of_day_text, each),
        Kind::Number | Kind::Text => BatchColumn::Texts(Vec::new()),
    })
}

/// A count as it is written in a column.
fn signed_or_not(count: i64, whole: Whole, physical: PhysicalType) -> i128 {
    match physical {
        _ if !whole.is_unsigned => i128::from(count),
        PhysicalType::INT32 => i128::from(count & i64::from(u32::MAX)),
        _ => i128::from(count.cast_unsigned()),
    }
}

/// Whole numbers, or decimals; as texts where double precision does not hold each to the last digit, as those of some identifiers.
fn whole_numbers(decimals: u8, cells: &[Option<i128>]) -> BatchColumn {
    let is_long = |value: &i128| value.unsigned_abs() > 1 << f64::MANTISSA_DIGITS;
    if cells.iter().flatten().any(is_long) {
        let text = |value: i128| decimal_text(value, usize::from(decimals));
        return BatchColumn::Texts(text_runs(
            cells.iter().map(|cell| cell.map_or_else(String::new, text)),
        ));
    }
    let by = power_of_ten(decimals);
    #[expect(clippy::cast_precision_loss, reason = "none is above 2^53")]
    let number = |value: i128| value as f64 / by;
    BatchColumn::Numbers(cells.iter().map(|cell| cell.map_or(f64::NAN, number)).collect())
}

/// Decimals in bytes: a whole number in two's complement, its largest byte first.
fn decimals_in_bytes<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    levels: Option<&mut Vec<i16>>,
    decimals: u8,
) -> Result<BatchColumn, ParquetError>
where
    T::T: AsBytes,
{
    let cells = cells(reader, rows, levels, None, |value| Some(from_bytes(value.as_bytes())))?;
    let is_whole = |cell: &Option<Option<i128>>| !matches!(cell, Some(None));
    if !cells.iter().all(is_whole) {
        return Err(ParquetError::General("a decimal of more digits than are read".to_owned()));
    }
    let cells: Vec<Option<i128>> = cells.into_iter().map(Option::flatten).collect();
    Ok(whole_numbers(decimals, &cells))
}

/// `None` for what has more than sixteen bytes.
fn from_bytes(bytes: &[u8]) -> Option<i128> {
    let mut word = [if bytes.first()? & 0x80 == 0 { 0 } else { 0xff }; 16];
    let from = word.len().checked_sub(bytes.len())?;
    word[from..].copy_from_slice(bytes);
    Some(i128::from_be_bytes(word))
}

/// A whole number with so many digits behind the decimal point.
fn decimal_text(value: i128, decimals: usize) -> String {
    let sign = if value < 0 { "-" } else { "" };
    let digits = format!("{:01$}", value.unsigned_abs(), decimals + 1);
    let (whole, behind) = digits.split_at(digits.len() - decimals);
    let point = if behind.is_empty() { "" } else { "." };
    format!("{sign}{whole}{point}{behind}")
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

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 2^53 + 1 is the first whole number that double precision has not; −1 without its sign is 2^64 − 1 or 2^32 − 1.
    #[test]
    fn whole_numbers_keep_every_digit() {
        let texts = |column| match column {
            BatchColumn::Texts(runs) => runs.into_iter().map(|(text, _)| text).collect::<Vec<_>>(),
            other => panic!("{other:?}"),
        };
        let numbers = |column| match column {
            BatchColumn::Numbers(numbers) => numbers,
            other => panic!("{other:?}"),
        };
        let long = (1_i128 << 53) + 1;
        let found = whole_numbers(0, &[Some(long), None, Some(-3)]);
        assert_eq!(texts(found), ["9007199254740993", "", "-3"]);
        let found = whole_numbers(16, &[Some(-long), Some(5)]);
        assert_eq!(texts(found), ["-0.9007199254740993", "0.0000000000000005"]);
        // Multiplied by 0.01 it is 123.45000000000002.
        assert_eq!(numbers(whole_numbers(2, &[Some(12_345), Some(7)])), [123.45, 0.07]);
        let unsigned = Whole { decimals: 0, is_unsigned: true };
        assert_eq!(signed_or_not(-1, unsigned, PhysicalType::INT64), i128::from(u64::MAX));
        assert_eq!(signed_or_not(-1, unsigned, PhysicalType::INT32), i128::from(u32::MAX));
        let signed = Whole { is_unsigned: false, ..unsigned };
        assert_eq!(signed_or_not(-1, signed, PhysicalType::INT64), -1);
        assert_eq!(from_bytes(&[0xff, 0x85]), Some(-123));
        assert_eq!(from_bytes(&[0x00, 0xff, 0x85]), Some(65_413));
        assert_eq!(from_bytes(&[0; 17]), None);
    }
}
