//! Tables of named columns to Arrow, and Arrow tables to text.

use std::fmt::Write;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{
    Date32Type, Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type,
    TimestampMicrosecondType, TimestampMillisecondType, TimestampNanosecondType,
    TimestampSecondType, UInt8Type, UInt16Type, UInt32Type, UInt64Type,
};
use arrow_array::{Array, ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema, TimeUnit};
use flight::Timestamp;
use pipeline::columns::{Cells, Columns};
use report::mapping::local_text;

use crate::failure::Failure;

/// Columns as Arrow: text, whole numbers of 64 bits, numbers of 64 bits with nulls where absent.
///
/// # Errors
/// A whole number of more than 63 bits.
pub(crate) fn to_arrow(columns: &Columns) -> Result<(Vec<Field>, Vec<ArrayRef>), Failure> {
    let mut fields = Vec::new();
    let mut arrays: Vec<ArrayRef> = Vec::new();
    for (name, cells) in columns.iter() {
        let (kind, array): (DataType, ArrayRef) = match cells {
            Cells::Text(values) => {
                (DataType::Utf8, Arc::new(StringArray::from_iter_values(values.iter())))
            }
            Cells::Count(values) => {
                let values = values.iter().map(|value| i64::try_from(*value));
                let values: Vec<i64> =
                    values.collect::<Result<_, _>>().map_err(Failure::internal)?;
                (DataType::Int64, Arc::new(Int64Array::from(values)))
            }
            Cells::Number(values) => {
                (DataType::Float64, Arc::new(values.iter().copied().collect::<Float64Array>()))
            }
            Cells::Dense(values) => {
                let cells = values.iter().map(|value| (!value.is_nan()).then_some(*value));
                (DataType::Float64, Arc::new(cells.collect::<Float64Array>()))
            }
        };
        fields.push(Field::new(name, kind, matches!(cells, Cells::Number(_) | Cells::Dense(_))));
        arrays.push(array);
    }
    Ok((fields, arrays))
}

/// Columns as one batch.
///
/// # Errors
/// As for [`to_arrow`].
pub(crate) fn to_batch(columns: &Columns) -> Result<RecordBatch, Failure> {
    let (fields, arrays) = to_arrow(columns)?;
    RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays).map_err(Failure::internal)
}

/// The batches with encoded columns decoded: dictionaries (categories of pandas and polars) and decimal numbers.
///
/// # Errors
/// A value that cannot be decoded.
pub(crate) fn plain(batches: Vec<RecordBatch>) -> Result<Vec<RecordBatch>, Failure> {
    batches.into_iter().map(plain_batch).collect()
}

fn plain_batch(batch: RecordBatch) -> Result<RecordBatch, Failure> {
    let schema = batch.schema();
    let target = |kind: &DataType| match kind {
        DataType::Dictionary(_, value) => Some(value.as_ref().clone()),
        DataType::Decimal128(..) | DataType::Decimal256(..) | DataType::Float16 => {
            Some(DataType::Float64)
        }
        DataType::Date64 => Some(DataType::Timestamp(TimeUnit::Millisecond, None)),
        _ => None,
    };
    if schema.fields().iter().all(|field| target(field.data_type()).is_none()) {
        return Ok(batch);
    }
    let mut fields = Vec::new();
    let mut arrays = Vec::new();
    for (field, array) in schema.fields().iter().zip(batch.columns()) {
        match target(field.data_type()) {
            None => {
                fields.push(field.as_ref().clone());
                arrays.push(Arc::clone(array));
            }
            Some(kind) => {
                let cast = arrow_cast::cast(array, &kind)
                    .map_err(|error| Failure::input(format!("column {}: {error}", field.name())))?;
                fields.push(Field::new(field.name(), kind, true));
                arrays.push(cast);
            }
        }
    }
    RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays).map_err(Failure::internal)
}

/// One value of an Arrow array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value<'a> {
    /// Null.
    Missing,
    /// A number; 1 and 0 for true and false.
    Number(f64),
    /// A whole number, kept apart because not every one is an `f64`.
    Whole(i128),
    /// Text.
    Text(&'a str),
    /// An instant; a date is its first instant in UTC.
    Instant(Timestamp),
    /// A date and a time of day without a zone, as if they were UTC.
    Local(Timestamp),
}

/// How the values of an array are read.
#[derive(Debug)]
pub(crate) struct Reader<'a> {
    array: &'a dyn Array,
    numbers: Option<&'a [f64]>,
}

impl<'a> Reader<'a> {
    /// A reader of an array of numbers, text, truth values, dates or instants.
    ///
    /// # Errors
    /// Another type.
    pub(crate) fn new(name: &str, array: &'a dyn Array) -> Result<Self, Failure> {
        use DataType::{
            Boolean, Date32, Float32, Float64, Int8, Int16, Int32, Int64, LargeUtf8, Null,
            Timestamp as Instant, UInt8, UInt16, UInt32, UInt64, Utf8, Utf8View,
        };
        match array.data_type() {
            Null | Boolean | Int8 | Int16 | Int32 | Int64 | UInt8 | UInt16 | UInt32 | UInt64
            | Float32 | Float64 | Utf8 | LargeUtf8 | Utf8View | Date32 | Instant(..) => {
                let numbers = array.as_primitive_opt::<Float64Type>().map(|a| &a.values()[..]);
                Ok(Self { array, numbers })
            }
            other => Err(Failure::input(format!(
                "column {name}: found type {other}, expected numbers, text, truth values, dates or instants"
            ))),
        }
    }

    /// A reader of an array of any type: where it is none of those, no row has a value.
    pub(crate) fn of_any(array: &'a dyn Array) -> Self {
        Self::new("", array).unwrap_or(Self { array, numbers: None })
    }

    /// The value of a row.
    pub(crate) fn value(&self, row: usize) -> Value<'a> {
        if self.array.is_null(row) {
            return Value::Missing;
        }
        if let Some(numbers) = self.numbers {
            return Value::Number(numbers[row]);
        }
        macro_rules! whole {
            ($kind:ty) => {
                Value::Whole(i128::from(self.array.as_primitive::<$kind>().value(row)))
            };
        }
        match self.array.data_type() {
            DataType::Boolean => Value::Number(f64::from(self.array.as_boolean().value(row))),
            DataType::Int8 => whole!(Int8Type),
            DataType::Int16 => whole!(Int16Type),
            DataType::Int32 => whole!(Int32Type),
            DataType::Int64 => whole!(Int64Type),
            DataType::UInt8 => whole!(UInt8Type),
            DataType::UInt16 => whole!(UInt16Type),
            DataType::UInt32 => whole!(UInt32Type),
            DataType::UInt64 => whole!(UInt64Type),
            DataType::Float32 => {
                Value::Number(f64::from(self.array.as_primitive::<Float32Type>().value(row)))
            }
            DataType::Utf8 => Value::Text(self.array.as_string::<i32>().value(row)),
            DataType::LargeUtf8 => Value::Text(self.array.as_string::<i64>().value(row)),
            DataType::Utf8View => Value::Text(self.array.as_string_view().value(row)),
            DataType::Date32 => {
                let days = self.array.as_primitive::<Date32Type>().value(row);
                instant(Timestamp::from_second(i64::from(days) * 86_400).ok())
            }
            DataType::Timestamp(unit, zone) => match instant(self.timestamp(*unit, row)) {
                Value::Instant(time) if zone.is_none() => Value::Local(time),
                instant => instant,
            },
            // A column of nulls, or of a type that is not read.
            _ => Value::Missing,
        }
    }

    fn timestamp(&self, unit: TimeUnit, row: usize) -> Option<Timestamp> {
        match unit {
            TimeUnit::Second => {
                Timestamp::from_second(self.array.as_primitive::<TimestampSecondType>().value(row))
            }
            TimeUnit::Millisecond => Timestamp::from_millisecond(
                self.array.as_primitive::<TimestampMillisecondType>().value(row),
            ),
            TimeUnit::Microsecond => Timestamp::from_microsecond(
                self.array.as_primitive::<TimestampMicrosecondType>().value(row),
            ),
            TimeUnit::Nanosecond => Timestamp::from_nanosecond(i128::from(
                self.array.as_primitive::<TimestampNanosecondType>().value(row),
            )),
        }
        .ok()
    }
}

fn instant(found: Option<Timestamp>) -> Value<'static> {
    found.map_or(Value::Text("an instant outside the years -9999 to 9999"), Value::Instant)
}

/// Whose a table is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Whose {
    /// Our own: each column has a text, and a time stamp without a zone is an instant in UTC.
    Ours,
    /// A recorder's: a time stamp without a zone is a time on a clock that only the mapping knows, so that its text has no
    /// offset, and a column of a type that is not read is one that nobody asks for.
    Recorders,
}

/// A table as comma-separated text with a header. A number is its shortest decimals that read back to the same bits; a
/// null and NaN are empty fields.
///
/// # Errors
/// A column of a type that has no text.
pub(crate) fn to_csv(batches: &[RecordBatch], whose: Whose) -> Result<Vec<u8>, Failure> {
    let mut text = String::new();
    for (place, batch) in batches.iter().enumerate() {
        let schema = batch.schema();
        if place == 0 {
            text.push_str(&header(batch));
            text.push('\n');
        }
        let readers = schema
            .fields()
            .iter()
            .zip(batch.columns())
            .map(|(field, array)| match whose {
                Whose::Ours => Reader::new(field.name(), array),
                Whose::Recorders => Ok(Reader::of_any(array)),
            })
            .collect::<Result<Vec<_>, _>>()?;
        for row in 0..batch.num_rows() {
            append_line(&mut text, &readers, row, whose);
            text.push('\n');
        }
    }
    Ok(text.into_bytes())
}

/// The line of a table's names.
pub(crate) fn header(batch: &RecordBatch) -> String {
    let mut text = String::new();
    for (column, field) in batch.schema().fields().iter().enumerate() {
        if column > 0 {
            text.push(',');
        }
        append_text(&mut text, field.name());
    }
    text
}

/// The line of a row of a recording.
pub(crate) fn line(readers: &[Reader<'_>], row: usize) -> String {
    let mut text = String::new();
    append_line(&mut text, readers, row, Whose::Recorders);
    text
}

fn append_line(text: &mut String, readers: &[Reader<'_>], row: usize, whose: Whose) {
    for (column, reader) in readers.iter().enumerate() {
        if column > 0 {
            text.push(',');
        }
        append(
            text,
            match reader.value(row) {
                Value::Local(time) if whose == Whose::Ours => Value::Instant(time),
                value => value,
            },
        );
    }
}

fn append(text: &mut String, value: Value<'_>) {
    // Writing to a string cannot fail.
    let _ = match value {
        Value::Missing => Ok(()),
        // As a library without nulls writes "not available".
        Value::Number(value) if value.is_nan() => Ok(()),
        Value::Number(value) => write!(text, "{value}"),
        Value::Whole(value) => write!(text, "{value}"),
        Value::Instant(value) => write!(text, "{value}"),
        Value::Local(value) => write!(text, "{}", local_text(value)),
        Value::Text(value) => {
            append_text(text, value);
            Ok(())
        }
    };
}

fn append_text(text: &mut String, value: &str) {
    if value.contains([',', '"', '\n', '\r']) {
        text.push('"');
        text.push_str(&value.replace('"', "\"\""));
        text.push('"');
    } else {
        text.push_str(value);
    }
}
