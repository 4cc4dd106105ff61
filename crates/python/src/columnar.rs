//! The rows of a Parquet or Arrow file as the command line takes them: only the columns that are wanted, batch after batch, as
//! numbers, instants and texts. The Python half decodes the file (`cruisefit/_columnar.py`).

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::{DataType, TimeUnit};
use pyo3::prelude::*;
use pyo3::types::PyIterator;
use pyo3_arrow::{PyRecordBatch, PySchema};
use report::mapping::{
    Batch, BatchColumn, NO_INSTANT, Source, date_text, text_runs, time_of_day_text,
};

use crate::recording::Place;
use crate::tables::{Reader, Value};
use crate::work::Caller;

/// What a Parquet file begins with, an Arrow file, and a message of an Arrow stream.
const MAGICS: [&[u8]; 3] = [b"PAR1", b"ARROW1", &[0xff; 4]];
/// Rows that are given at a time: of a file they may be any number.
const ROWS_AT_ONCE: usize = 1 << 14;
const DAY_S: i64 = 86_400;
const SECOND_MS: i64 = 1000;

/// Whether these are the first bytes of a Parquet or Arrow file, or of an Arrow stream.
pub(crate) fn is_columnar(bytes: &[u8]) -> bool {
    MAGICS.iter().any(|magic| bytes.starts_with(magic))
}

/// A Parquet or Arrow file as a recording.
///
/// # Errors
/// Why it is not read.
pub(crate) fn source(
    opened: &Py<PyAny>,
    place: Place<'_>,
    caller: &Caller,
) -> Result<Source<'static>, String> {
    Python::attach(|py| {
        let file = match place {
            Place::File(path) => opened.bind(py).call1((path,))?,
            Place::Bytes(bytes) => opened.bind(py).call1((bytes,))?,
        };
        let schema = file.getattr("schema")?.extract::<PySchema>()?.into_inner();
        let names: Vec<String> = schema.fields().iter().map(|field| field.name().clone()).collect();
        let is_unread = |place: &usize| !is_read(schema.field(*place).data_type());
        let unread = (0..names.len()).filter(is_unread).collect();
        let mut rows = Rows {
            file: file.unbind(),
            batches: None,
            batch: None,
            given: 0,
            names: names.clone(),
            caller: caller.clone(),
        };
        let batches = move |wanted: &[usize]| rows.next(wanted);
        Ok(Source::table(names, unread, Box::new(batches)))
    })
    .map_err(reason)
}

/// What Python reports, in one line.
fn reason(error: PyErr) -> String {
    Python::attach(|py| error.value(py).to_string().replace('\n', " "))
}

/// A file, and how far it has been read.
struct Rows {
    file: Py<PyAny>,
    batches: Option<Py<PyIterator>>,
    batch: Option<RecordBatch>,
    /// Rows of the batch that were given.
    given: usize,
    names: Vec<String>,
    caller: Caller,
}

impl Rows {
    fn next(&mut self, wanted: &[usize]) -> Result<Option<Batch>, String> {
        self.caller.still_waits().map_err(|_| "interrupted".to_owned())?;
        let batch = loop {
            match &self.batch {
                Some(batch) if self.given < batch.num_rows() => break batch,
                _ => {}
            }
            // The batch before is given back before the next is read.
            self.batch = None;
            let Some(batch) = self.read(wanted).map_err(reason)? else { return Ok(None) };
            (self.batch, self.given) = (Some(batch), 0);
        };
        let rows = ROWS_AT_ONCE.min(batch.num_rows() - self.given);
        let stretch = batch.slice(self.given, rows);
        self.given += rows;
        let columns = wanted.iter().zip(stretch.columns()).map(|(place, array)| {
            let unread =
                || format!("column {:?} is of a type that is not read", self.names[*place]);
            column(array).map(|column| (*place, column)).ok_or_else(unread)
        });
        Ok(Some(Batch { first_row: 0, rows, columns: columns.collect::<Result<_, _>>()? }))
    }

    fn read(&mut self, wanted: &[usize]) -> PyResult<Option<RecordBatch>> {
        Python::attach(|py| {
            let batches = match &self.batches {
                Some(batches) => batches.bind(py).clone(),
                None => {
                    self.file.bind(py).call_method1("batches", (wanted.to_vec(),))?.try_iter()?
                }
            };
            let next = batches.clone().next().transpose()?;
            self.batches = Some(batches.unbind());
            next.map(|batch| batch.extract::<PyRecordBatch>().map(PyRecordBatch::into_inner))
                .transpose()
        })
    }
}

/// Whether [`column`] reads a type.
fn is_read(kind: &DataType) -> bool {
    match kind {
        DataType::Dictionary(_, values) => is_read(values),
        DataType::Null
        | DataType::Boolean
        | DataType::Timestamp(..)
        | DataType::Date32
        | DataType::Date64
        | DataType::Time32(_)
        | DataType::Time64(_)
        | DataType::Utf8
        | DataType::LargeUtf8
        | DataType::Utf8View
        | DataType::Binary
        | DataType::LargeBinary
        | DataType::BinaryView
        | DataType::Decimal128(..)
        | DataType::Decimal256(..) => true,
        other => other.is_integer() || other.is_floating(),
    }
}

/// The cells of a column; `None` for one of a type that is not read.
fn column(array: &ArrayRef) -> Option<BatchColumn> {
    Some(match array.data_type() {
        DataType::Dictionary(_, values) => return column(&arrow_cast::cast(array, values).ok()?),
        DataType::Timestamp(unit, zone) => {
            let each = nanoseconds(*unit);
            let time = |count: Option<i64>| count.and_then(|count| count.checked_mul(each));
            let times = counts(array)?.into_iter().map(|count| time(count).unwrap_or(NO_INSTANT));
            // With the name of a zone, whichever it is, counts are of UTC.
            if zone.as_ref().is_some_and(|zone| !zone.is_empty()) {
                BatchColumn::Instants(times.collect())
            } else {
                BatchColumn::LocalTimes(times.collect())
            }
        }
        DataType::Date32 => texts(counts(array)?, |days| date_text(days.saturating_mul(DAY_S))),
        DataType::Date64 => texts(counts(array)?, |count| date_text(count / SECOND_MS)),
        DataType::Time32(unit) | DataType::Time64(unit) => {
            let each = nanoseconds(*unit);
            texts(counts(array)?, |count| time_of_day_text(count, each))
        }
        DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View => {
            let reader = Reader::new("", array).ok()?;
            BatchColumn::Texts(text_runs((0..array.len()).map(|row| match reader.value(row) {
                Value::Text(text) => text,
                _ => "",
            })))
        }
        // Not every writer of Parquet marks its texts as such.
        DataType::Binary | DataType::LargeBinary | DataType::BinaryView => {
            let bytes = arrow_cast::cast(array, &DataType::LargeBinary).ok()?;
            let bytes = bytes.as_binary::<i64>().iter();
            BatchColumn::Texts(text_runs(
                bytes.map(|cell| String::from_utf8_lossy(cell.unwrap_or_default())),
            ))
        }
        kind if is_read(kind) => BatchColumn::Numbers(numbers(array)?),
        _ => return None,
    })
}

const fn nanoseconds(unit: TimeUnit) -> i64 {
    match unit {
        TimeUnit::Second => 1_000_000_000,
        TimeUnit::Millisecond => 1_000_000,
        TimeUnit::Microsecond => 1_000,
        TimeUnit::Nanosecond => 1,
    }
}

/// What is counted since 1970, or since midnight.
fn counts(array: &ArrayRef) -> Option<Vec<Option<i64>>> {
    let counts = arrow_cast::cast(array, &DataType::Int64).ok()?;
    Some(counts.as_primitive_opt::<Int64Type>()?.iter().collect())
}

fn texts(counts: Vec<Option<i64>>, text: impl Fn(i64) -> String) -> BatchColumn {
    let texts = counts.into_iter().map(|count| count.map_or_else(String::new, &text));
    BatchColumn::Texts(text_runs(texts))
}

/// Numbers, NaN where there is none; 1 and 0 for true and false.
fn numbers(array: &ArrayRef) -> Option<Vec<f64>> {
    let numbers = arrow_cast::cast(array, &DataType::Float64).ok()?;
    let numbers = numbers.as_primitive_opt::<Float64Type>()?;
    Some(if numbers.null_count() == 0 {
        numbers.values().to_vec()
    } else {
        numbers.iter().map(|number| number.unwrap_or(f64::NAN)).collect()
    })
}
