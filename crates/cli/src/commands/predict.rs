//! `cruisefit predict`: fuel flow and specific range at flight points.

use std::borrow::Cow;
use std::io::Read;
use std::path::Path;

use flight::Segment;
use perf_model::{CsvError, FlightPoint, FlightPoints, PointCell, PointTable};

use crate::args::PredictArgs;
use crate::columns;
use crate::commands::{Outcome, check_refused, read_mapping};
use crate::criteria::NamedCriteria;
use crate::failure::{Failure, RefusedReport, show};
use crate::files::outputs::check_not_read;
use crate::files::standard_input;
use crate::models::read_model;
use crate::reading::{Buffers, FlightRead, Source, is_parquet};
use crate::{parquet_batches, parquet_numbers};
use pipeline::columns::Columns;
use pipeline::model_file::ModelFile;
use pipeline::prediction::{
    PredictedColumn, Predictor, columns_of_segments, measured_kg_s, point_of_segment, reason_of_row,
};
use pipeline::reading::Checks;
use pipeline::segments_table;
use pipeline::whole_model::Predicts;
use report::MAXIMUM_TEXT_BYTES;
use report::mapping::line_of_names;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &PredictArgs) -> Result<Outcome, Failure> {
    for input in [&arguments.points, &arguments.model] {
        check_not_read(arguments.output.as_deref(), input)?;
    }
    let model = read_model(&arguments.model)?;
    let predictor = Predictor::new(&model, Predicts::table_only(arguments.table_only))
        .map_err(|error| Failure::bad_file(&arguments.model, error))?;
    let predictor =
        if arguments.without_deviations { predictor.without_deviations() } else { predictor };
    let predictor = match &arguments.columns {
        Some(columns) => predictor.with_columns(columns),
        None => predictor,
    };
    if arguments.mapping.is_some() || is_segments(&arguments.points) {
        return predict_segments(arguments, &predictor);
    }
    if let Some(outcome) = predict_numbers(arguments, &model, &predictor)? {
        return Ok(outcome);
    }
    predict_rows(arguments, &model, &predictor)
}

/// The command for points that are looked at row by row.
fn predict_rows(
    arguments: &PredictArgs,
    model: &ModelFile,
    predictor: &Predictor<'_>,
) -> Result<Outcome, Failure> {
    let bad = |error: CsvError| Failure::bad_file(&arguments.points, error);
    let (text, given) = points_text(arguments)?;
    let points = FlightPoints::from_csv(&text).map_err(bad)?;
    let has_predicted = warn_of_predicted(points.header());
    if has_predicted && matches!(given, Given::Parquet) && is_parquet_output(arguments) {
        return Err(Failure::bad_file(
            &arguments.points,
            "columns of another prediction, which cannot be replaced in Parquet where a row lacks a value or a column holds more \
             than numbers: leave them out",
        ));
    }
    let mut columns = Columns::default();
    for (column, name) in points.header().iter().enumerate() {
        if is_predicted(name) {
            continue;
        }
        let fields = points.rows().iter().map(|row| row.fields[column].as_str());
        columns.text(name.as_str(), fields);
    }
    let (mut flights, mut places, mut without) = (Vec::new(), Vec::new(), Vec::new());
    for (place, row) in points.rows().iter().enumerate() {
        match &row.point {
            Ok(point) => {
                flights.push(*point);
                places.push(place);
            }
            Err(error) => without.push((place, reason_of_row(error))),
        }
    }
    let table = PointTable::new(points.header().to_vec()).map_err(bad)?;
    let measured = states_error(arguments, &table).then(|| measured_kg_s(&flights));
    let mut predicted =
        predictor.at_points(&flights, measured.as_deref()).among_rows(&places, without);
    let refused = std::mem::take(&mut predicted.refused);
    predicted.append_to(&mut columns);
    let json = deliver(arguments, &columns, given)?;
    tell_references(model, &flights);
    let lines = refused.into_iter().map(|(place, reason)| (points.rows()[place].line, reason));
    let outcome = outcome(arguments, predictor, points.rows().len(), lines);
    Ok(Outcome { json, ..outcome })
}

/// Whether a column is one of those that a prediction adds.
fn is_predicted(name: &str) -> bool {
    PredictedColumn::of_name(name.trim()).is_some()
}

/// Whether there are columns of another prediction, of which a warning says that they are not read.
fn warn_of_predicted(names: &[String]) -> bool {
    let found: Vec<&str> =
        names.iter().map(|name| name.trim()).filter(|name| is_predicted(name)).collect();
    if !found.is_empty() {
        tracing::warn!("columns of a prediction are not read, and replaced: {}", found.join(", "));
    }
    !found.is_empty()
}

fn is_parquet_output(arguments: &PredictArgs) -> bool {
    arguments.output.as_deref().is_some_and(columns::is_parquet_name)
}

/// Whether the error of the prediction is a column: that must not depend on the values in a table.
fn states_error(arguments: &PredictArgs, table: &PointTable) -> bool {
    let is_asked = |columns: &Vec<_>| columns.contains(&PredictedColumn::ErrorPercent);
    table.measured_fuel_flow().is_some() || arguments.columns.as_ref().is_some_and(is_asked)
}

/// Writes the table, or makes the document that is asked for in its place.
fn deliver(
    arguments: &PredictArgs,
    columns: &Columns,
    given: Given,
) -> Result<Option<Vec<u8>>, Failure> {
    let output = arguments.output.as_deref();
    match (arguments.json.json, output, given) {
        (true, None, _) => return Ok(Some(columns.to_json())),
        (_, _, Given::Text) => columns::write(columns, output)?,
        (_, _, Given::Parquet) => {
            columns::write_beside(&kept(&arguments.points)?, columns, output)?;
        }
    }
    Ok(arguments.json.json.then(|| columns.to_json()))
}

/// What the command says; `refused`: lines and reasons. The rows stay, without values: a planner's table keeps its lines.
fn outcome(
    arguments: &PredictArgs,
    predictor: &Predictor<'_>,
    points: usize,
    refused: impl Iterator<Item = (u64, String)>,
) -> Outcome {
    let refused: Vec<RefusedReport> = refused
        .map(|(line, reason)| RefusedReport {
            path: arguments.points.clone(),
            line: usize::try_from(line).ok(),
            column: None,
            reason,
        })
        .collect();
    let text = arguments.output.as_ref().map_or_else(String::new, |path| {
        let by = if predictor.is_whole() { " by all that the model has learnt" } else { "" };
        format!(
            "{} of {points} points predicted{by}, written to {}\n",
            points - refused.len(),
            show(path)
        )
    });
    Outcome { refused, ..Outcome::text(text) }
}

/// The command for a Parquet file of plain numbers, of which there may be millions: column by column. `None` for a file that
/// has to be read row by row.
fn predict_numbers(
    arguments: &PredictArgs,
    model: &ModelFile,
    predictor: &Predictor<'_>,
) -> Result<Option<Outcome>, Failure> {
    let bad =
        |error: &dyn std::fmt::Display| Failure::bad_file(&arguments.points, error.to_string());
    let mut beginning = [0; 4];
    let is_parquet =
        opened(&arguments.points).and_then(|mut file| file.read_exact(&mut beginning)).is_ok()
            && is_parquet(&beginning);
    // What applied effects lack at a point is said of points one by one.
    if !is_parquet || model.initial.effects().is_some() {
        return Ok(None);
    }
    let Some(input) =
        parquet_numbers::columns_of_file(&kept(&arguments.points)?).map_err(|error| bad(&error))?
    else {
        return Ok(None);
    };
    let names: Vec<String> = input.iter().map(|(name, _)| name.clone()).collect();
    let table = PointTable::new(names.clone()).map_err(|error| bad(&error))?;
    let Some(points) = table.level_columns(|column| Some(Cow::Borrowed(&input[column].1[..])))
    else {
        for row in 0..input[0].1.len() {
            let cell = |column: usize| match input[column].1[row] {
                value if value.is_nan() => PointCell::Missing,
                value => PointCell::Number(value),
            };
            match table.point(row as u64 + 2, cell) {
                Err(error) if !error.costs_its_row() => return Err(bad(&error)),
                _ => {}
            }
        }
        return Ok(None);
    };
    let flights = points.flights();
    let none;
    let measured = match points.measured_fuel_flow_kg_s() {
        None if states_error(arguments, &table) => {
            none = vec![f64::NAN; flights.count()];
            Some(&none[..])
        }
        measured => measured,
    };
    let mut predicted = predictor.at_level_flights(flights, measured);
    let refused = std::mem::take(&mut predicted.refused);
    let mut columns = Columns::default();
    for (name, values) in input.into_iter().filter(|(name, _)| !is_predicted(name)) {
        columns.dense(name, values);
    }
    predicted.append_to(&mut columns);
    // What is replaced cannot go out as it came.
    let given = if warn_of_predicted(&names) { Given::Text } else { Given::Parquet };
    let json = deliver(arguments, &columns, given)?;
    // As in a text, line 1 has the names.
    let lines = refused.into_iter().map(|(place, reason)| (place as u64 + 2, reason));
    Ok(Some(Outcome { json, ..outcome(arguments, predictor, flights.count(), lines) }))
}

/// The file behind a path, which may be `-`.
fn kept(path: &Path) -> Result<Cow<'_, Path>, Failure> {
    standard_input::file(path).map_err(|error| Failure::unreadable(path, error))
}

fn opened(path: &Path) -> std::io::Result<std::fs::File> {
    standard_input::file(path).and_then(std::fs::File::open)
}

/// Whether a file is a table of segments.
fn is_segments(path: &Path) -> bool {
    let mut beginning = Vec::new();
    let read = opened(path).and_then(|file| file.take(64).read_to_end(&mut beginning));
    if read.is_ok() && is_parquet(&beginning) {
        let names = kept(path).ok().and_then(|file| parquet_batches::names_of_file(&file).ok());
        beginning = names.map(|names| line_of_names(&names).into_bytes()).unwrap_or_default();
    }
    read.is_ok() && segments_table::is_table(&beginning)
}

/// The command for averaged points of another layout, or for segments.
fn predict_segments(
    arguments: &PredictArgs,
    predictor: &Predictor<'_>,
) -> Result<Outcome, Failure> {
    let mapping = arguments.mapping.as_deref().map(read_mapping).transpose()?;
    let source =
        Source { mapping, criteria: NamedCriteria::default().limits, checks: Checks::LeftOut };
    let (mut flights, mut refused) = source.read_file(&arguments.points, &mut Buffers::default());
    check_refused(&refused, 1, false, flights.is_empty())?;
    flights.sort_by(FlightRead::order);
    let segments: Vec<Segment> =
        flights.into_iter().flat_map(|flight| flight.reduced.segments).collect();
    let points = segments
        .iter()
        .map(point_of_segment)
        .collect::<Result<Vec<FlightPoint>, _>>()
        .map_err(|error| Failure::bad_file(&arguments.points, error))?;
    let mut columns = columns_of_segments(&segments, &points);
    let measured = measured_kg_s(&points);
    let mut predicted = predictor.at_points(&points, Some(&measured));
    let unpredicted = std::mem::take(&mut predicted.refused);
    predicted.append_to(&mut columns);
    let json = deliver(arguments, &columns, Given::Text)?;
    let place = |place: usize| {
        let means = &segments[place];
        format!(
            "{} {}, TIME {:.0} s",
            means.identity.tail, means.identity.flight, means.means.time_s
        )
    };
    let unpredicted =
        unpredicted.into_iter().map(|(point, reason)| (0, format!("{}: {reason}", place(point))));
    let mut outcome = outcome(arguments, predictor, points.len(), unpredicted);
    for one in &mut outcome.refused {
        one.line = None;
    }
    refused.append(&mut outcome.refused);
    Ok(Outcome { refused, json, ..outcome })
}

/// Warns once about each applied effect that is held at its reference because an input is missing.
fn tell_references(model: &ModelFile, points: &[FlightPoint]) {
    let Some(effects) = model.initial.effects() else { return };
    let mut warned = Vec::new();
    for (effect, missing) in points.iter().flat_map(|point| effects.at_reference(point)) {
        if !warned.contains(&(effect, missing)) {
            warned.push((effect, missing));
            tracing::warn!("points without {missing}: {effect} is at its reference there");
        }
    }
}

/// What flight points were given as.
#[derive(Clone, Copy)]
enum Given {
    Text,
    Parquet,
}

/// Flight points as CSV text; a Parquet file's rows are written as such first.
fn points_text(arguments: &PredictArgs) -> Result<(Vec<u8>, Given), Failure> {
    let path = &arguments.points;
    let bytes = std::fs::read(kept(path)?).map_err(|error| Failure::unreadable(path, error))?;
    if !is_parquet(&bytes) {
        return Ok((bytes, Given::Text));
    }
    let file = kept(path)?;
    let text = parquet_batches::csv_of_file(&file, MAXIMUM_TEXT_BYTES);
    let text = text.map_err(|error| Failure::bad_file(path, error))?;
    if !is_parquet_output(arguments) {
        for name in parquet_batches::unread_of_file(&file).unwrap_or_default() {
            tracing::warn!("column {name}: of a type that is not read, left empty");
        }
    }
    Ok((text, Given::Parquet))
}
