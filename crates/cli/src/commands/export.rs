//! `cruisefit export`: a model's table as CSV.

use crate::args::ExportArgs;
use crate::columns::Columns;
use crate::commands::Outcome;
use crate::failure::Failure;
use crate::model_file::ModelFile;

/// Runs the command.
///
/// # Errors
/// What leaves nothing done.
pub fn run(arguments: &ExportArgs) -> Result<Outcome, Failure> {
    let model = ModelFile::read(&arguments.model)?;
    table(&model).write(arguments.output.as_deref())?;
    Ok(Outcome::default())
}

/// One row a node: coordinates, drag coefficients, confidence, and whether the guide left it extrapolated.
pub fn table(model: &ModelFile) -> Columns {
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
        nodes().map(|node| Some(confidence.map_or(1.0, |table| table.value_at_node(node)))),
    );
    let initial = model.initial.drag_table();
    columns
        .number("initial_drag_coefficient", nodes().map(|node| Some(initial.value_at_node(node))));
    columns
        .count("extrapolated", nodes().map(|node| u64::from(model.initial.extrapolated()[node])));
    columns
}
