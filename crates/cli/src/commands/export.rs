//! `cruisefit export`: a model's drag for other programs.

use std::path::Path;

use crate::args::{ExportArgs, ExportFormat};
use crate::columns;
use crate::commands::Outcome;
use crate::failure::Failure;
use crate::files::write_atomically;
use crate::models::read_model;
use pipeline::{export, model_table};

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
    let of_model =
        |error: &dyn std::fmt::Display| Failure::bad_file(&arguments.model, error.to_string());
    let output = arguments.output.as_deref();
    let format = if arguments.polynomial { ExportFormat::Polynomial } else { arguments.format };
    if arguments.mach.is_some() && format != ExportFormat::Openap {
        return Err(Failure::BadArgument {
            argument: "--mach",
            reason: "only --format openap has one Mach number".to_owned(),
        });
    }
    match format {
        ExportFormat::Csv => columns::write(&model_table::table(&model), output)?,
        ExportFormat::Polynomial => {
            let polynomial = model_table::polynomial(&model).map_err(|error| of_model(&error))?;
            columns::write(&polynomial, output)?;
        }
        ExportFormat::Openap => {
            let polar = export::openap(&model, arguments.mach).map_err(|error| of_model(&error))?;
            return text(polar.to_yaml(), output);
        }
        ExportFormat::Jsbsim => return text(export::jsbsim(&model), output),
        ExportFormat::Json => {
            return text(export::json(&model).map_err(|error| of_model(&error))?, output);
        }
    }
    Ok(Outcome::default())
}

/// To a file, or to standard output.
fn text(text: String, output: Option<&Path>) -> Result<Outcome, Failure> {
    match output {
        None => Ok(Outcome::text(text)),
        Some(path) => write_atomically(path, text.as_bytes()).map(|()| Outcome::default()),
    }
}
