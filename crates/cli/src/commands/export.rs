//! `cruisefit export`: a model's table as CSV.

use adapt::bayes::polynomial_export;
use lut::surface;

use crate::args::ExportArgs;
use crate::columns;
use crate::commands::Outcome;
use crate::failure::Failure;
use crate::models::read_model;
use pipeline::columns::Columns;
use pipeline::model_file::ModelFile;

/// Runs the command.
///
/// # Errors
/// What leaves nothing done.
pub(crate) fn run(arguments: &ExportArgs) -> Result<Outcome, Failure> {
    let model = read_model(&arguments.model)?;
    if !model.applied.is_empty() {
        tracing::warn!(
            "a table holds drag alone; effects that the model contains are not in it: {}",
            model.told_effects()
        );
    }
    let columns = if arguments.polynomial {
        polynomial(&model).map_err(|reason| Failure::bad_file(&arguments.model, reason))?
    } else {
        table(&model)
    };
    columns::write(&columns, arguments.output.as_deref())?;
    Ok(Outcome::default())
}

/// One row a node: coordinates, drag coefficients, confidence, and whether the guide left it extrapolated.
pub(crate) fn table(model: &ModelFile) -> Columns {
    let drag = model.drag_coefficient();
    let grid = model.grid();
    let nodes = || 0..grid.nodes();
    let mut columns = Columns::default();
    columns.number("lift_coefficient", nodes().map(|node| Some(grid.coordinates(node).0)));
    columns.number("mach", nodes().map(|node| Some(grid.coordinates(node).1)));
    columns.number("drag_coefficient", nodes().map(|node| Some(drag.value_at_node(node))));
    let confidence = model.confidence();
    columns.number(
        "confidence",
        nodes().map(|node| Some(confidence.map_or(1.0, |confidence| confidence[node]))),
    );
    let initial = model.initial.drag_table();
    columns
        .number("initial_drag_coefficient", nodes().map(|node| Some(initial.value_at_node(node))));
    columns
        .count("extrapolated", nodes().map(|node| u64::from(model.initial.extrapolated()[node])));
    columns
}

/// One row a coefficient: its value and, where the law knows it, its covariance with each of the six.
fn polynomial(model: &ModelFile) -> Result<Columns, String> {
    let basis = model.initial.polynomial().basis;
    let (surface, covariance) = if let Some(posterior) = model.posterior() {
        let export = polynomial_export(posterior, basis).map_err(|error| error.to_string())?;
        (export.surface, Some(export.covariance))
    } else {
        let grid = model.grid();
        let points: Vec<_> = (0..grid.nodes())
            .map(|node| {
                let (x, y) = grid.coordinates(node);
                (x, y, model.drag_coefficient().value_at_node(node), 1.0)
            })
            .collect();
        (surface::fit(basis, &points).map_err(|error| error.to_string())?.surface, None)
    };
    let mut columns = Columns::default();
    columns.count("coefficient", 0..surface.coefficients.len() as u64);
    columns.number("value", surface.coefficients.iter().map(|value| Some(*value)));
    if let Some(covariance) = covariance {
        for other in 0..surface.coefficients.len() {
            columns.number(
                format!("covariance_{other}"),
                covariance.iter().map(|row| Some(row[other])),
            );
        }
    }
    Ok(columns)
}
