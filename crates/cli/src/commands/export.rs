//! `cruisefit export`: a model's table as CSV.

use crate::args::ExportArgs;
use crate::columns;
use crate::commands::Outcome;
use crate::failure::Failure;
use crate::models::read_model;
use pipeline::model_table;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &ExportArgs) -> Result<Outcome, Failure> {
    let model = read_model(&arguments.model)?;
    if !model.applied.is_empty() {
        tracing::warn!(
            "a table holds drag alone; effects that the model contains are not in it: {}",
            model.told_effects()
        );
    }
    let columns = if arguments.polynomial {
        model_table::polynomial(&model)
            .map_err(|error| Failure::bad_file(&arguments.model, error))?
    } else {
        model_table::table(&model)
    };
    columns::write(&columns, arguments.output.as_deref())?;
    Ok(Outcome::default())
}
