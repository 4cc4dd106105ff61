//! An Arrow table whose rows are the samples of a recording: its numbers, instants and texts as they are, its text where a
//! refusal or an unusual cell needs it.

use std::path::Path;

use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::DataType;
use pipeline::reading::recordings::{self, Mapped, Workers};
use pipeline::reading::{Checks, FileRead};
use report::mapping::{Cells, Lines, Mapping, Pieces, TableRows};
use segmenter::TrimCriteria;

use crate::failure::Failure;
use crate::tables::{Reader, Value, header, line};
use crate::work::Caller;

/// Rows that are read together: some megabytes. Our choice.
const ROWS_AT_ONCE: usize = 1 << 15;
/// Above this not every whole number is a double.
const LARGEST_EXACT: i128 = 1 << 53;

/// The flights in a table of plain columns.
///
/// # Errors
/// A column of a type that a recording cannot have; an interrupted caller.
pub(crate) fn read(
    name: &Path,
    batches: Vec<RecordBatch>,
    (mapping, criteria): (&Mapping, &TrimCriteria),
    caller: &Caller,
) -> Result<FileRead, Failure> {
    for batch in &batches {
        readers(batch)?;
    }
    let names = batches.first().map(header).unwrap_or_default();
    let mapping = mapping.comma_separated();
    let waiting = caller.clone();
    let rows = batches.into_iter().flat_map(stretches).take_while(move |_| {
        // What is read of an interrupted call is dropped.
        waiting.still_waits().is_ok()
    });
    let pieces = Pieces::of_table(names, rows.map(rows_of));
    let mapped = Mapped { path: name, mapping: &mapping, criteria, checks: Checks::Made };
    let read = recordings::read_pieces(&mapped, Ok(pieces), &in_parallel);
    caller.still_waits()?;
    Ok(read)
}

fn in_parallel(work: &(dyn Fn() + Sync), run: &mut dyn FnMut(&Workers<'_>)) {
    let count = rayon::current_num_threads();
    rayon::in_place_scope(|scope| run(&Workers { count, call: &|| scope.spawn(|_| work()) }));
}

fn stretches(batch: RecordBatch) -> impl Iterator<Item = RecordBatch> {
    (0..batch.num_rows())
        .step_by(ROWS_AT_ONCE)
        .map(move |from| batch.slice(from, ROWS_AT_ONCE.min(batch.num_rows() - from)))
}

fn readers(batch: &RecordBatch) -> Result<Vec<Reader<'_>>, Failure> {
    let schema = batch.schema();
    let columns = schema.fields().iter().zip(batch.columns());
    columns.map(|(field, array)| Reader::new(field.name(), array)).collect()
}

fn rows_of(batch: RecordBatch) -> TableRows {
    let columns = batch.columns().iter().map(cells).collect();
    let rows = batch.num_rows();
    let text = Lines::new(move |row| {
        // The types of all batches were looked at before.
        readers(&batch).map(|readers| line(&readers, row)).unwrap_or_default()
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
        Value::Number(value) => value.is_finite().then_some(value),
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
