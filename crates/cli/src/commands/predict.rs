//! `cruisefit predict`: fuel flow and specific range at flight points.

use std::path::Path;
use std::sync::Arc;

use effects::AppliedEffects;
use flight::{Cruise, FlightIdentity, Segment, SegmentMeans, Timestamp};
use parquet::file::reader::{FileReader, SerializedFileReader};
use perf_model::{FlightPointRow, FlightPoints};
use units::{FuelFlowTotal, Temperature};

use crate::args::PredictArgs;
use crate::columns;
use crate::commands::Outcome;
use crate::failure::{Failure, RefusedReport, show};
use crate::models::read_model;
use pipeline::columns::Columns;
use pipeline::model_file::ModelFile;

mod remainder;

use remainder::Remainder;

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
    let remembered = Remainder::of(&model, arguments.table_only);
    let mut refused = Vec::new();
    let mut predicted = Vec::with_capacity(points.rows().len());
    let mut remainders = Vec::with_capacity(points.rows().len());
    for row in points.rows() {
        let found = current.predict(&row.point);
        let known = found.as_ref().ok().and_then(|_| remembered.as_ref()?.at(&current, &row.point));
        remainders.push(known);
        match found {
            Ok(prediction) => predicted.push(Some(match known {
                Some((mean, _)) => {
                    let total = prediction.fuel_flow_total.to_kilograms_per_second() * mean.exp();
                    prediction
                        .with_fuel_flow(FuelFlowTotal::kilograms_per_second(total), &row.point)
                }
                None => prediction,
            })),
            // The row stays, without values: a planner's table keeps its lines.
            Err(error) => {
                predicted.push(None);
                refused.push(RefusedReport {
                    path: arguments.points.clone(),
                    line: usize::try_from(row.line).ok(),
                    column: None,
                    reason: error.to_string(),
                });
            }
        }
    }
    let deviations = deviations(&model, points.rows(), &predicted, remembered, &remainders);
    let mut columns = table(points.header(), points.rows(), &predicted, &deviations);
    if remembered.is_some() {
        columns.number(
            "remainder_percent",
            remainders.iter().map(|known| known.map(|(mean, _)| 100.0 * mean.exp_m1())),
        );
    }
    columns::write(&columns, arguments.output.as_deref())?;
    tell_references(&model, points.rows());
    let text = arguments.output.as_ref().map_or_else(String::new, |path| {
        let known = remainders.iter().flatten().count();
        let remainder_note = if remembered.is_some() {
            format!("; {known} of them with a remainder informed by flown data")
        } else {
            String::new()
        };
        format!(
            "{} of {} points predicted{remainder_note}, written to {}\n",
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

/// The input's columns and the results.
fn table(
    header: &[String],
    rows: &[FlightPointRow],
    predicted: &[Option<perf_model::Prediction>],
    deviations: &[Option<f64>],
) -> Columns {
    let mut columns = Columns::default();
    for (column, name) in header.iter().enumerate() {
        columns.text(name.as_str(), rows.iter().map(move |row| row.fields[column].clone()));
    }
    let figure = |of: fn(&perf_model::Prediction) -> f64| {
        predicted.iter().map(move |prediction| prediction.as_ref().map(of))
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
                let prediction = prediction.as_ref()?;
                Some(perf_model::fuel_flow::fuel_flow_error_percent(
                    measured,
                    prediction.fuel_flow_total,
                ))
            }),
        );
    }
    columns
}

/// Standard deviation, in kg/s, of what a segment recorded there would show: the uncertainty of the table, the part
/// common to a flight, the segment's own noise by the aircraft's sensors, and any applied scatter between flights.
/// Where the remainder is known, its uncertainty is added, and the noise is as large as flights showed it to be.
fn deviations(
    model: &ModelFile,
    rows: &[FlightPointRow],
    predicted: &[Option<perf_model::Prediction>],
    remembered: Option<Remainder<'_>>,
    remainders: &[Option<(f64, f64)>],
) -> Vec<Option<f64>> {
    // The imagined segment is recorded by the aircraft's sensors without any error of theirs.
    let Ok(plain) = model.initial.with_effects(AppliedEffects::default()) else {
        return vec![None; rows.len()];
    };
    let scatter = model.initial.effects().map_or(0.0, AppliedEffects::fuel_heating_value_deviation);
    let of = |row: &FlightPointRow,
              prediction: &perf_model::Prediction,
              remainder: Option<(f64, f64)>| {
        let posterior = model.posterior()?;
        let segment = imagined_segment(&row.point, prediction, &plain);
        let sensors = plain.observe(&segment).ok()?.variance;
        let total_kg_s = prediction.fuel_flow_total.to_kilograms_per_second();
        let per_relative_drag_kg_s = posterior.initial().interpolate(&prediction.cell)
            * prediction.fuel_flow_per_drag_coefficient_kg_s;
        let kg_s = if let Some((remembered, (_, deviation))) = remembered.zip(remainder) {
            let [within, between] = remembered.variance_factors();
            let variance = posterior.relative_variance(&prediction.cell)
                + within * sensors.segment
                + between * sensors.flight;
            (variance.sqrt() * per_relative_drag_kg_s).hypot(deviation * total_kg_s)
        } else {
            let variance = posterior.segment_variance(&prediction.cell, &sensors);
            variance.sqrt() * per_relative_drag_kg_s
        };
        Some(if scatter > 0.0 { kg_s.hypot(scatter * total_kg_s) } else { kg_s })
    };
    rows.iter()
        .zip(predicted)
        .zip(remainders)
        .map(|((row, prediction), remainder)| {
            prediction.as_ref().and_then(|prediction| of(row, prediction, *remainder))
        })
        .collect()
}

/// The segment of ten samples that the aircraft would record at a flight point if it burnt what is predicted.
fn imagined_segment(
    point: &perf_model::FlightPoint,
    prediction: &perf_model::Prediction,
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
