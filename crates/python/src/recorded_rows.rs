//! An Arrow table whose rows are the samples of a recording: its numbers, instants and texts as they are, its text where a
//! refusal or an unusual cell needs it.

use std::path::Path;

use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::DataType;
use pipeline::reading::recordings::{self, Mapped};
use pipeline::reading::{Checks, FileRead};
use report::mapping::{Cells, Lines, Mapping, Pieces, Stream, TableRows};
use segmenter::TrimCriteria;

use crate::failure::Failure;
use crate::recording::in_parallel;
use crate::tables::{Reader, Value, header, line};
use crate::work::Caller;

/// Rows that are read together: some megabytes. Our choice.
const ROWS_AT_ONCE: usize = 1 << 15;
/// Above this not every whole number is a double.
const LARGEST_EXACT: i128 = 1 << 53;

/// The flights in a table of plain columns, of which those that the mapping does not name may be of any type.
///
/// # Errors
/// A column that the mapping names, of a type that a recording cannot have; an interrupted caller.
pub(crate) fn read(
    name: &Path,
    batches: Vec<RecordBatch>,
    (mapping, criteria): (&Mapping, &TrimCriteria),
    caller: &Caller,
) -> Result<FileRead, Failure> {
    let mapping = mapping.comma_separated();
    let needed = batches.first().map(|batch| needed(batch, &mapping)).unwrap_or_default();
    for batch in &batches {
        for place in &needed {
            Reader::new(batch.schema().field(*place).name(), batch.column(*place))?;
        }
    }
    let names = batches.first().map(header).unwrap_or_default();
    let waiting = caller.clone();
    let rows = batches.into_iter().flat_map(stretches).take_while(move |_| {
        // What is read of an interrupted call is dropped.
        waiting.still_waits().is_ok()
    });
    let pieces = Pieces::of_table(names, rows.map(move |batch| rows_of(batch, &needed)));
    let mapped = Mapped { path: name, mapping: &mapping, criteria, checks: Checks::Made };
    let read = recordings::read_pieces(&mapped, Ok(pieces), &in_parallel);
    caller.still_waits()?;
    Ok(read)
}

/// The places of the columns that a mapping names; none where it names one that is not there, which is refused when the table is
/// read.
fn needed(batch: &RecordBatch, mapping: &Mapping) -> Vec<usize> {
    let names: Vec<String> =
        batch.schema().fields().iter().map(|field| field.name().clone()).collect();
    Stream::begin_table(mapping, &names, None).map(|stream| stream.needed()).unwrap_or_default()
}

fn stretches(batch: RecordBatch) -> impl Iterator<Item = RecordBatch> {
    (0..batch.num_rows())
        .step_by(ROWS_AT_ONCE)
        .map(move |from| batch.slice(from, ROWS_AT_ONCE.min(batch.num_rows() - from)))
}

fn rows_of(batch: RecordBatch, needed: &[usize]) -> TableRows {
    let cells_of = |(place, array)| {
        if needed.contains(&place) { cells(array) } else { Cells::AsText }
    };
    let columns = batch.columns().iter().enumerate().map(cells_of).collect();
    let rows = batch.num_rows();
    let text = Lines::new(move |row| {
        let readers: Vec<Reader<'_>> =
            batch.columns().iter().map(|array| Reader::of_any(array)).collect();
        line(&readers, row)
    });
    TableRows { columns, rows, text }
}

fn cells(array: &ArrayRef) -> Cells {
    let Ok(reader) = Reader::new("", array) else { return Cells::AsText };
    let values = (0..array.len()).map(|row| reader.value(row));
    let found = match array.data_type() {
        DataType::Timestamp(_, None) => {
            values.map(local_time).collect::<Option<_>>().map(Cells::LocalTimes)
        }
        DataType::Timestamp(..) => values.map(instant).collect::<Option<_>>().map(Cells::Instants),
        DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View => texts(values),
        _ => values.map(number).collect::<Option<_>>().map(Cells::Numbers),
    };
    found.unwrap_or(Cells::AsText)
}

fn instant(value: Value<'_>) -> Option<flight::Timestamp> {
    match value {
        Value::Instant(instant) => Some(instant),
        _ => None,
    }
}

fn local_time(value: Value<'_>) -> Option<flight::Timestamp> {
    match value {
        Value::Local(time) => Some(time),
        _ => None,
    }
}

fn number(value: Value<'_>) -> Option<f64> {
    match value {
        Value::Missing => Some(f64::NAN),
        // NaN is a number that is not there.
        Value::Number(value) => (!value.is_infinite()).then_some(value),
        Value::Whole(value) => (value.abs() <= LARGEST_EXACT).then_some(value as f64),
        Value::Text(_) | Value::Instant(_) | Value::Local(_) => None,
    }
}

fn texts<'a>(values: impl Iterator<Item = Value<'a>>) -> Option<Cells> {
    let mut runs: Vec<(usize, String)> = Vec::new();
    let mut last = None;
    for (row, value) in values.enumerate() {
        let Value::Text(text) = value else { return None };
        if last != Some(text) {
            runs.push((row, text.trim().to_owned()));
            last = Some(text);
        }
    }
    Some(Cells::Texts(runs))
}
