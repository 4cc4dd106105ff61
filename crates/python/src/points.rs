//! Predictions at the flight points of an Arrow table.

use std::sync::Arc;

use arrow_array::RecordBatch;
use arrow_schema::{Field, Schema};
use perf_model::{PointCell, PointTable};
use pipeline::columns::Columns;
use pipeline::prediction::{PointPrediction, Predictor};
use rayon::prelude::*;
use units::FuelFlowTotal;

use crate::failure::Failure;
use crate::tables::{Reader, Value, to_arrow};
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
    let schema = batch.schema();
    let readers = schema
        .fields()
        .iter()
        .zip(batch.columns())
        .map(|(field, array)| Reader::new(field.name(), array))
        .collect::<Result<Vec<_>, _>>()?;
    let mut predicted: Vec<Option<PointPrediction>> = Vec::with_capacity(batch.num_rows());
    let mut measured: Vec<Option<FuelFlowTotal>> = Vec::new();
    let mut refused = Vec::new();
    for row in 0..batch.num_rows() {
        let number = (before + row + 1) as u64;
        let point = points
            .point(number, |column| cell(readers[column].value(row)))
            .map_err(|error| Failure::table(&error))?;
        if any_measured {
            measured.push(point.measured_fuel_flow_total);
        }
        match predictor.at(&point) {
            Ok(prediction) => predicted.push(Some(prediction)),
            // The row stays, without values: a planner's table keeps its lines.
            Err(error) => {
                predicted.push(None);
                refused.push((number, error));
            }
        }
    }
    let mut columns = Columns::default();
    predictor.append_columns(&mut columns, any_measured.then_some(measured.as_slice()), &predicted);
    let (new_fields, new_arrays) = to_arrow(&columns)?;
    let mut fields: Vec<Arc<Field>> = schema.fields().iter().cloned().collect();
    let mut arrays = batch.columns().to_vec();
    for (field, array) in new_fields.into_iter().zip(new_arrays) {
        // Nulls or not, the column has one type in every part of the table.
        fields.push(Arc::new(field));
        arrays.push(array);
    }
    let batch =
        RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays).map_err(Failure::internal)?;
    Ok((batch, refused))
}

fn cell(value: Value<'_>) -> PointCell<'_> {
    match value {
        Value::Missing => PointCell::Missing,
        Value::Number(value) => PointCell::Number(value),
        // Beyond 2^53 no flight point has a meaning: its limits refuse it, exact or not.
        Value::Whole(value) => PointCell::Number(value as f64),
        Value::Text(text) => PointCell::Text(text),
        Value::Instant(instant) => PointCell::Instant(instant),
    }
}
