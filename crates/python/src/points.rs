//! Predictions at the flight points of an Arrow table.

use std::borrow::Cow;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch};
use arrow_schema::{DataType, Field, Schema};
use perf_model::{FlightPoint, PointCell, PointTable};
use pipeline::prediction::{PredictedPoints, Predictor, measured_kg_s};
use rayon::prelude::*;

use crate::failure::Failure;
use crate::tables::{Reader, Value};
use crate::work::Caller;

/// Rows that a thread predicts before it asks whether the caller still waits. Our choice: some 50 ms of work.
const ROWS_AT_ONCE: usize = 1 << 16;

/// A row (from 1) without a prediction, and the reason.
pub(crate) type Unpredicted = (u64, String);

/// The table with the columns of the prediction, and the rows (from 1) that have none, with reasons.
///
/// # Errors
/// A table whose columns or cells are not those of flight points.
pub(crate) fn predict(
    predictor: &Predictor<'_>,
    batches: &[RecordBatch],
    caller: &Caller,
) -> Result<(Vec<RecordBatch>, Vec<Unpredicted>), Failure> {
    let Some(first) = batches.first() else {
        return Err(Failure::input("a table without rows"));
    };
    let names = first.schema().fields().iter().map(|field| field.name().clone()).collect();
    let points = PointTable::new(names).map_err(|error| Failure::table(&error))?;
    // Whether the error of the prediction is a column must not depend on where a table is cut.
    let measured = points.measured_fuel_flow().is_some_and(|column| {
        batches.iter().any(|batch| batch.column(column).null_count() < batch.num_rows())
    });
    let mut cuts = Vec::new();
    let mut rows = 0;
    for batch in batches {
        for from in (0..batch.num_rows()).step_by(ROWS_AT_ONCE) {
            let length = ROWS_AT_ONCE.min(batch.num_rows() - from);
            cuts.push((rows + from, batch.slice(from, length)));
        }
        rows += batch.num_rows();
    }
    let predicted = cuts
        .into_par_iter()
        .map(|(before, batch)| {
            caller.still_waits()?;
            predict_batch(predictor, &points, before, batch, measured)
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let (batches, refused): (Vec<_>, Vec<_>) = predicted.into_iter().unzip();
    Ok((batches, refused.into_iter().flatten().collect()))
}

type Predicted = (RecordBatch, Vec<Unpredicted>);

fn predict_batch(
    predictor: &Predictor<'_>,
    points: &PointTable,
    before: usize,
    batch: RecordBatch,
    any_measured: bool,
) -> Result<Predicted, Failure> {
    let at_once = points.level_columns(|column| numbers(batch.column(column)));
    let predicted = match at_once.filter(|_| predictor.predicts_columns()) {
        Some(columns) => {
            let measured = columns.measured_fuel_flow_kg_s().filter(|_| any_measured);
            predictor.at_level_flights(columns.flights(), measured)
        }
        None => predict_rows(predictor, points, before, &batch, any_measured)?,
    };
    let PredictedPoints { columns, refused } = predicted;
    let mut fields: Vec<Arc<Field>> = batch.schema().fields().iter().cloned().collect();
    let mut arrays = batch.columns().to_vec();
    for (name, values) in columns {
        // Nulls or not, the column has one type in every part of the table.
        fields.push(Arc::new(Field::new(name, DataType::Float64, true)));
        arrays.push(Arc::new(with_nulls(values)));
    }
    let batch =
        RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays).map_err(Failure::internal)?;
    let numbered = |(place, reason)| ((before + place + 1) as u64, reason);
    Ok((batch, refused.into_iter().map(numbered).collect()))
}

/// Predictions at rows that are looked at cell by cell.
fn predict_rows(
    predictor: &Predictor<'_>,
    points: &PointTable,
    before: usize,
    batch: &RecordBatch,
    any_measured: bool,
) -> Result<PredictedPoints, Failure> {
    let schema = batch.schema();
    let readers = schema
        .fields()
        .iter()
        .zip(batch.columns())
        .map(|(field, array)| Reader::new(field.name(), array))
        .collect::<Result<Vec<_>, _>>()?;
    let rows = (0..batch.num_rows()).map(|row| {
        let number = (before + row + 1) as u64;
        points
            .point(number, |column| cell(readers[column].value(row)))
            .map_err(|error| Failure::table(&error))
    });
    let rows = rows.collect::<Result<Vec<FlightPoint>, Failure>>()?;
    let measured = any_measured.then(|| measured_kg_s(&rows));
    Ok(predictor.at_points(&rows, measured.as_deref()))
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
