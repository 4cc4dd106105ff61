//! Predictions at the flight points of an Arrow table.

use std::borrow::Cow;
use std::cell::Cell;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch, RecordBatchOptions};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use perf_model::{PointCell, PointTable};
use pipeline::prediction::{
    PredictedColumn, PredictedPoints, Predictor, measured_kg_s, reason_of_row,
};
use rayon::prelude::*;

use crate::failure::Failure;
use crate::tables::{Reader, Value, plain};
use crate::work::Caller;

/// Rows that a thread predicts before it asks whether the caller still waits. Our choice: some 50 ms of work.
const ROWS_AT_ONCE: usize = 1 << 16;

/// Rows without a prediction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Unpredicted {
    /// How many.
    pub(crate) rows: usize,
    /// The first of them (from 1), and the reason.
    pub(crate) first: Option<(u64, String)>,
}

/// Flight points.
#[derive(Clone, Debug)]
pub(crate) struct Points {
    pub(crate) schema: SchemaRef,
    pub(crate) batches: Vec<RecordBatch>,
}

/// Which columns a table of predictions has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Returned {
    /// Those that were given, as they were given, then those of the prediction.
    WithGiven,
    /// Those of the prediction alone, for a library that adds them to its own table.
    PredictionAlone,
}

/// The columns of the prediction, and the rows that have none. A table without rows has the same columns, without rows; the
/// error of the prediction is one of them where the table has measured fuel flows, whether or not there is a value, or where it
/// is asked for by its name (`asks_error`).
///
/// # Errors
/// A table whose columns or cells are not those of flight points.
pub(crate) fn predict(
    predictor: &Predictor<'_>,
    given: Points,
    (returned, asks_error): (Returned, bool),
    caller: &Caller,
) -> Result<(Points, Unpredicted), Failure> {
    let names = given.schema.fields().iter().map(|field| field.name().clone()).collect();
    let points = PointTable::new(names).map_err(|error| Failure::names(&error))?;
    let read = plain(given.batches.clone())?;
    let mut cuts = Vec::new();
    let mut rows = 0;
    for (batch, read) in given.batches.iter().zip(&read) {
        for from in (0..batch.num_rows()).step_by(ROWS_AT_ONCE) {
            let length = ROWS_AT_ONCE.min(batch.num_rows() - from);
            let (given, read) = (batch.slice(from, length), read.slice(from, length));
            cuts.push(Cut { before: rows + from, given, read });
        }
        rows += batch.num_rows();
    }
    if cuts.is_empty() {
        let empty = given.batches.iter().cloned().zip(read).take(1);
        cuts.extend(empty.map(|(given, read)| Cut { before: 0, given, read }));
    }
    // Which columns there are must depend neither on the values in a table nor on where it is cut.
    let states_error = asks_error || points.measured_fuel_flow().is_some();
    let at = At { predictor, points: &points, states_error };
    let predicted = cuts
        .into_par_iter()
        .map(|cut| {
            caller.still_waits()?;
            at.cut(cut, returned)
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let mut unpredicted = Unpredicted::default();
    let mut batches = Vec::with_capacity(predicted.len());
    for (batch, found) in predicted {
        batches.push(batch);
        unpredicted.rows += found.rows;
        unpredicted.first = unpredicted.first.or(found.first);
    }
    let schema = batches.first().map_or(given.schema, RecordBatch::schema);
    Ok((Points { schema, batches }, unpredicted))
}

/// Rows that follow each other.
struct Cut {
    /// Rows of the table before it.
    before: usize,
    /// As they were given.
    given: RecordBatch,
    /// The same with encoded columns decoded.
    read: RecordBatch,
}

/// How rows are predicted.
struct At<'a> {
    predictor: &'a Predictor<'a>,
    points: &'a PointTable,
    states_error: bool,
}

impl At<'_> {
    fn cut(&self, cut: Cut, returned: Returned) -> Result<(RecordBatch, Unpredicted), Failure> {
        let Cut { before, given, read } = cut;
        let at_once = self.points.level_columns(|column| numbers(read.column(column)));
        let predicted = match at_once.filter(|_| self.predictor.predicts_columns()) {
            Some(columns) => {
                let none;
                let measured = match columns.measured_fuel_flow_kg_s() {
                    None if self.states_error => {
                        none = vec![f64::NAN; read.num_rows()];
                        Some(&none[..])
                    }
                    measured => measured,
                };
                self.predictor.at_level_flights(columns.flights(), measured)
            }
            None => self.rows(before, &read)?,
        };
        let PredictedPoints { columns, refused } = predicted;
        let (mut fields, mut arrays) = (Vec::new(), Vec::new());
        let mut metadata = given.schema().metadata().clone();
        match returned {
            Returned::WithGiven => {
                // Those of another prediction are found anew.
                let kept = given.schema_ref().fields().iter().zip(given.columns());
                let kept = kept
                    .filter(|(field, _)| PredictedColumn::of_name(field.name().trim()).is_none());
                for (field, array) in kept {
                    fields.push(Arc::clone(field));
                    arrays.push(Arc::clone(array));
                }
            }
            // Such as how pandas finds the index among its columns.
            Returned::PredictionAlone => metadata.clear(),
        }
        for (name, values) in columns {
            // Nulls or not, the column has one type in every part of the table.
            fields.push(Arc::new(Field::new(name, DataType::Float64, true)));
            arrays.push(Arc::new(with_nulls(values)));
        }
        let schema = Schema::new_with_metadata(fields, metadata);
        // Where no column is wanted, the number of rows is not theirs.
        let rows = RecordBatchOptions::new().with_row_count(Some(given.num_rows()));
        let batch = RecordBatch::try_new_with_options(Arc::new(schema), arrays, &rows)
            .map_err(Failure::internal)?;
        let numbered = |(place, reason)| ((before + place + 1) as u64, reason);
        let rows = refused.len();
        Ok((batch, Unpredicted { rows, first: refused.into_iter().next().map(numbered) }))
    }

    /// Predictions at rows that are looked at cell by cell.
    fn rows(&self, before: usize, batch: &RecordBatch) -> Result<PredictedPoints, Failure> {
        let schema = batch.schema();
        let columns = schema.fields().iter().zip(batch.columns());
        // Of a column without a meaning no cell is asked for, whatever its type.
        let readers: Vec<_> =
            columns.map(|(field, array)| Reader::new(field.name(), array)).collect();
        let (mut points, mut places, mut without) = (Vec::new(), Vec::new(), Vec::new());
        for row in 0..batch.num_rows() {
            let asked = Cell::new(None);
            let point = self.points.point((before + row + 1) as u64, |column| {
                asked.set(Some(column));
                readers[column]
                    .as_ref()
                    .map_or(PointCell::Missing, |reader| cell(reader.value(row)))
            });
            // The cell that was asked for last is the one that is wrong.
            let last = asked.get().map(|column| &readers[column]);
            match (point, last) {
                (_, Some(Err(failure))) => return Err(failure.clone()),
                (Ok(point), _) => {
                    points.push(point);
                    places.push(row);
                }
                (Err(error), Some(Ok(reader))) if is_missing(reader.value(row)) => {
                    without.push((row, reason_of_row(&error)));
                }
                (Err(error), _) => return Err(Failure::table(&error)),
            }
        }
        let measured = self.states_error.then(|| measured_kg_s(&points));
        let found = self.predictor.at_points(&points, measured.as_deref());
        Ok(found.among_rows(&places, without))
    }
}

const fn is_missing(value: Value<'_>) -> bool {
    match value {
        Value::Missing => true,
        Value::Number(value) => value.is_nan(),
        _ => false,
    }
}

/// The values of an array of numbers, NaN for nulls; `None` for other arrays.
fn numbers(array: &ArrayRef) -> Option<Cow<'_, [f64]>> {
    let array = array.as_primitive_opt::<Float64Type>()?;
    Some(match array.nulls().filter(|nulls| nulls.null_count() > 0) {
        None => Cow::Borrowed(&array.values()[..]),
        Some(_) => array.iter().map(|value| value.unwrap_or(f64::NAN)).collect(),
    })
}

/// An array with a null for each NaN.
fn with_nulls(values: Vec<f64>) -> Float64Array {
    let missing = values.iter().any(|value| value.is_nan());
    if missing && values.iter().all(|value| value.is_nan()) {
        return Float64Array::new_null(values.len());
    }
    let nulls = missing.then(|| values.iter().map(|value| !value.is_nan()).collect());
    Float64Array::new(values.into(), nulls)
}

fn cell(value: Value<'_>) -> PointCell<'_> {
    match value {
        Value::Missing => PointCell::Missing,
        Value::Number(value) => PointCell::Number(value),
        // Beyond 2^53 no flight point has a meaning: its limits refuse it, exact or not.
        Value::Whole(value) => PointCell::Number(value as f64),
        Value::Text(text) => PointCell::Text(text),
        Value::Instant(instant) | Value::Local(instant) => PointCell::Instant(instant),
    }
}
