//! `cruisefit predict`: fuel flow and specific range at flight points.

use std::path::Path;
use std::sync::Arc;

use diagnose::{WholeModel, WholePrediction};
use effects::{AppliedEffects, ExtendedModel};
use flight::{Cruise, FlightIdentity, Segment, SegmentMeans, Timestamp};
use parquet::file::reader::{FileReader, SerializedFileReader};
use perf_model::{FlightPoint, FlightPointRow, FlightPoints, Prediction};
use units::{FuelFlowTotal, Temperature};

use crate::args::PredictArgs;
use crate::columns;
use crate::commands::{Outcome, predicts};
use crate::failure::{Failure, RefusedReport, show};
use crate::models::read_model;
use pipeline::columns::Columns;
use pipeline::model_file::ModelFile;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &PredictArgs) -> Result<Outcome, Failure> {
    let model = read_model(&arguments.model)?;
    let current = model.current().map_err(|error| Failure::bad_file(&arguments.model, error))?;
    let text = points_text(&arguments.points)?;
    let points = FlightPoints::from_csv(&text)
        .map_err(|error| Failure::bad_file(&arguments.points, error))?;
    let whole = model.whole(predicts(arguments.table_only));
    let mut refused = Vec::new();
    let mut predicted = Vec::with_capacity(points.rows().len());
    for row in points.rows() {
        match predict_row(&current, whole.as_ref(), &row.point) {
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
    let deviations = deviations(&model, points.rows(), &predicted);
    let mut columns = table(points.header(), points.rows(), &predicted, &deviations);
    if whole.is_some() {
        columns.number(
            "remainder_percent",
            predicted.iter().map(|found| Some(100.0 * found.as_ref()?.beyond_table()?.exp_m1())),
        );
    }
    columns::write(&columns, arguments.output.as_deref())?;
    tell_references(&model, points.rows());
    let text = arguments.output.as_ref().map_or_else(String::new, |path| {
        let by = if whole.is_some() { " by all that the model has learnt" } else { "" };
        format!(
            "{} of {} points predicted{by}, written to {}\n",
            points.rows().len() - refused.len(),
            points.rows().len(),
            show(path)
        )
    });
    Ok(Outcome { text, refused })
}

/// A prediction at a flight point.
struct Predicted {
    /// The one that is written.
    prediction: Prediction,
    /// By the whole model, and ln of its fuel flow over that of the learnt table; `None` where the table predicts.
    whole: Option<(WholePrediction, f64)>,
}

impl Predicted {
    /// ln of the fuel flow over that of the learnt table.
    fn beyond_table(&self) -> Option<f64> {
        self.whole.as_ref().map(|(_, beyond)| *beyond)
    }
}

fn predict_row(
    current: &ExtendedModel,
    whole: Option<&WholeModel<'_>>,
    point: &FlightPoint,
) -> Result<Predicted, String> {
    let by_table = current.predict(point).map_err(|error| error.to_string())?;
    let Some(whole) = whole else {
        return Ok(Predicted { prediction: by_table, whole: None });
    };
    let found = whole.of_point(point).map_err(|error| error.to_string())?;
    let beyond = found.ln_fuel_flow - by_table.fuel_flow_total.to_kilograms_per_second().ln();
    let total = FuelFlowTotal::kilograms_per_second(found.ln_fuel_flow.exp());
    let prediction = by_table.with_fuel_flow(total, point);
    Ok(Predicted { prediction, whole: Some((found, beyond)) })
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

/// The input's columns and the results.
fn table(
    header: &[String],
    rows: &[FlightPointRow],
    predicted: &[Option<Predicted>],
    deviations: &[Option<f64>],
) -> Columns {
    let mut columns = Columns::default();
    for (column, name) in header.iter().enumerate() {
        columns.text(name.as_str(), rows.iter().map(move |row| row.fields[column].clone()));
    }
    let figure = |of: fn(&Prediction) -> f64| {
        predicted.iter().map(move |found| found.as_ref().map(|found| of(&found.prediction)))
    };
    columns.number("fuel_flow_kg_s", figure(|p| p.fuel_flow_total.to_kilograms_per_second()));
    // Law `paper` has no standard deviation: the column exists and is empty.
    columns.number("fuel_flow_std_kg_s", deviations.iter().copied());
    columns.number("specific_range_m_kg", figure(|p| p.specific_range.to_meters_per_kilogram()));
    columns.number("lift_coefficient", figure(|p| p.lift_coefficient));
    columns.number("drag_coefficient", figure(|p| p.drag_coefficient));
    columns.number("extrapolated", figure(|p| if p.extrapolated { 1.0 } else { 0.0 }));
    if rows.iter().any(|row| row.point.measured_fuel_flow_total.is_some()) {
        columns.number(
            "error_percent",
            rows.iter().zip(predicted).map(|(row, prediction)| {
                let measured = row.point.measured_fuel_flow_total?;
                let predicted = prediction.as_ref()?.prediction.fuel_flow_total;
                Some(perf_model::fuel_flow::fuel_flow_error_percent(measured, predicted))
            }),
        );
    }
    columns
}

/// Standard deviation, in kg/s, of what a segment recorded there would show: the uncertainty of what was learnt, the part
/// common to a flight, the segment's own noise, and any applied scatter between flights. By the whole model the noise is as
/// large as flights showed it to be, by the table alone as the aircraft's sensors and the law's settings have it.
fn deviations(
    model: &ModelFile,
    rows: &[FlightPointRow],
    predicted: &[Option<Predicted>],
) -> Vec<Option<f64>> {
    // The imagined segment is recorded by the aircraft's sensors without any error of theirs.
    let Ok(plain) = model.initial.with_effects(AppliedEffects::default()) else {
        return vec![None; rows.len()];
    };
    let scatter = model.initial.effects().map_or(0.0, AppliedEffects::fuel_heating_value_deviation);
    let of = |row: &FlightPointRow, predicted: &Predicted| {
        let prediction = &predicted.prediction;
        let total_kg_s = prediction.fuel_flow_total.to_kilograms_per_second();
        let kg_s = if let Some((whole, _)) = &predicted.whole {
            whole.variance().sqrt() * total_kg_s
        } else {
            let posterior = model.posterior()?;
            let segment = imagined_segment(&row.point, prediction, &plain);
            let sensors = plain.observe(&segment).ok()?.variance;
            let per_relative_drag_kg_s = posterior.initial().interpolate(&prediction.cell)
                * prediction.fuel_flow_per_drag_coefficient_kg_s;
            posterior.segment_variance(&prediction.cell, &sensors).sqrt() * per_relative_drag_kg_s
        };
        Some(if scatter > 0.0 { kg_s.hypot(scatter * total_kg_s) } else { kg_s })
    };
    rows.iter()
        .zip(predicted)
        .map(|(row, predicted)| predicted.as_ref().and_then(|predicted| of(row, predicted)))
        .collect()
}

/// The segment of ten samples that the aircraft would record at a flight point if it burnt what is predicted.
fn imagined_segment(
    point: &FlightPoint,
    prediction: &Prediction,
    model: &effects::ExtendedModel,
) -> Segment {
    let engines = model.aircraft().engines();
    let cruise = SegmentMeans::cruise(&Cruise {
        pressure_altitude: point.pressure_altitude,
        static_air_temperature: point
            .static_air_temperature()
            .unwrap_or(Temperature::kelvin(f64::NAN)),
        mach: point.mach,
        true_airspeed: prediction.true_airspeed,
        mass: point.mass,
        fuel_flow_total: prediction.fuel_flow_total,
    });
    let means = SegmentMeans {
        fuel_flow_engine_kg_s: vec![cruise.fuel_flow_total_kg_s / engines as f64; engines],
        ..cruise
    };
    let identity = FlightIdentity {
        tail: String::new(),
        start: point.date.unwrap_or(Timestamp::UNIX_EPOCH),
        flight: String::new(),
    };
    Segment {
        identity: Arc::new(identity),
        rows: (0..10).collect(),
        means,
        temperature_assumed: false,
    }
}

/// Flight points as CSV text; a Parquet file's rows are written as such first.
fn points_text(path: &Path) -> Result<Vec<u8>, Failure> {
    let bytes = std::fs::read(path).map_err(|error| Failure::unreadable(path, error))?;
    if !bytes.starts_with(b"PAR1") {
        return Ok(bytes);
    }
    let file = std::fs::File::open(path).map_err(|error| Failure::unreadable(path, error))?;
    let wrong = |error: parquet::errors::ParquetError| Failure::bad_file(path, error);
    let reader = SerializedFileReader::new(file).map_err(wrong)?;
    let names: Vec<String> = reader
        .metadata()
        .file_metadata()
        .schema_descr()
        .columns()
        .iter()
        .map(|column| column.name().to_owned())
        .collect();
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    // Writing to memory cannot fail.
    let _ = writer.write_record(&names);
    for row in reader.get_row_iter(None).map_err(wrong)? {
        let row = row.map_err(wrong)?;
        let _ = writer.write_record(row.get_column_iter().map(|(_, field)| cell(field)));
    }
    writer.into_inner().map_err(|error| Failure::bad_file(path, error))
}

fn cell(field: &parquet::record::Field) -> String {
    use parquet::record::Field;
    match field {
        Field::Null => String::new(),
        Field::Str(text) => text.clone(),
        Field::Double(value) => value.to_string(),
        Field::Float(value) => value.to_string(),
        Field::Bool(flag) => u8::from(*flag).to_string(),
        other => other.to_string(),
    }
}
