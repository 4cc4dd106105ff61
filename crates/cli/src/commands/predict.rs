//! `cruisefit predict`: fuel flow and specific range at flight points.

use std::path::Path;

use perf_model::{FlightPointRow, FlightPoints};
use units::FuelFlowTotal;

use crate::args::PredictArgs;
use crate::columns;
use crate::commands::Outcome;
use crate::failure::{Failure, RefusedReport, show};
use crate::models::read_model;
use crate::parquet_text;
use pipeline::columns::Columns;
use pipeline::model_file::ModelFile;
use pipeline::prediction::Predictor;
use pipeline::whole_model::Predicts;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &PredictArgs) -> Result<Outcome, Failure> {
    let model = read_model(&arguments.model)?;
    let predictor = Predictor::new(&model, Predicts::table_only(arguments.table_only))
        .map_err(|error| Failure::bad_file(&arguments.model, error))?;
    let text = points_text(&arguments.points)?;
    let points = FlightPoints::from_csv(&text)
        .map_err(|error| Failure::bad_file(&arguments.points, error))?;
    let mut refused = Vec::new();
    let mut predicted = Vec::with_capacity(points.rows().len());
    for row in points.rows() {
        match predictor.at(&row.point) {
            Ok(found) => predicted.push(Some(found)),
            // The row stays, without values: a planner's table keeps its lines.
            Err(reason) => {
                predicted.push(None);
                refused.push(RefusedReport {
                    path: arguments.points.clone(),
                    line: usize::try_from(row.line).ok(),
                    column: None,
                    reason,
                });
            }
        }
    }
    let mut columns = Columns::default();
    for (column, name) in points.header().iter().enumerate() {
        let fields = points.rows().iter().map(|row| row.fields[column].clone());
        columns.text(name.as_str(), fields);
    }
    let measured: Vec<Option<FuelFlowTotal>> =
        points.rows().iter().map(|row| row.point.measured_fuel_flow_total).collect();
    let any_measured = measured.iter().any(Option::is_some);
    predictor.append_columns(&mut columns, any_measured.then_some(&measured), &predicted);
    columns::write(&columns, arguments.output.as_deref())?;
    tell_references(&model, points.rows());
    let text = arguments.output.as_ref().map_or_else(String::new, |path| {
        let by = if predictor.is_whole() { " by all that the model has learnt" } else { "" };
        format!(
            "{} of {} points predicted{by}, written to {}\n",
            points.rows().len() - refused.len(),
            points.rows().len(),
            show(path)
        )
    });
    Ok(Outcome { text, refused })
}

/// Warns once about each applied effect that is held at its reference because an input is missing.
fn tell_references(model: &ModelFile, rows: &[FlightPointRow]) {
    let Some(effects) = model.initial.effects() else { return };
    let mut warned = Vec::new();
    for (effect, missing) in rows.iter().flat_map(|row| effects.at_reference(&row.point)) {
        if !warned.contains(&(effect, missing)) {
            warned.push((effect, missing));
            tracing::warn!("points without {missing}: {effect} is at its reference there");
        }
    }
}

/// Flight points as CSV text; a Parquet file's rows are written as such first.
fn points_text(path: &Path) -> Result<Vec<u8>, Failure> {
    let bytes = std::fs::read(path).map_err(|error| Failure::unreadable(path, error))?;
    if !parquet_text::is_parquet(&bytes) {
        return Ok(bytes);
    }
    parquet_text::csv_of_file(path).map_err(|error| Failure::bad_file(path, error))
}
