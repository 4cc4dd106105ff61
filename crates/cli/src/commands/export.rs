//! `cruisefit export`: a model's drag for other programs.

use clap::ValueEnum;

use crate::args::{ExportArgs, ExportFormat};
use crate::columns;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::outputs::write_result;
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
    if let Some(left_out) = export::remainder_left_out(&model) {
        tracing::warn!("drag alone, as by `predict --table-only`: {}", left_out.words());
    }
    if let Some([rms, largest]) = export::rows_missed(&model) {
        tracing::warn!(
            "the table of a model that has learnt nothing is the polynomial through its guide's rows, which misses their drag by {rms:.2} % rms and {largest:.2} % at most; `optimum` plans by the rows"
        );
    }
    let of_model =
        |error: &dyn std::fmt::Display| Failure::bad_file(&arguments.model, error.to_string());
    let output = arguments.output.as_deref();
    let format = format(arguments)?;
    if arguments.mach.is_some() && format != ExportFormat::Openap {
        return Err(Failure::BadArgument {
            argument: "--mach",
            reason: "only --format openap has one Mach number".to_owned(),
        });
    }
    let text = match format {
        ExportFormat::Csv => {
            columns::write(&model_table::table(&model), output)?;
            None
        }
        ExportFormat::Polynomial => {
            let polynomial = model_table::polynomial(&model).map_err(|error| of_model(&error))?;
            columns::write(&polynomial, output)?;
            let miss = model_table::polynomial_miss(&model).map_err(|error| of_model(&error))?;
            tracing::warn!(
                "the polynomial misses the informed nodes of the table by {:.2} % rms, {:.2} % at most",
                miss.rms_percent,
                miss.maximum_percent
            );
            None
        }
        ExportFormat::Openap => {
            let polar = export::openap(&model, arguments.mach).map_err(|error| of_model(&error))?;
            Some(polar.to_yaml())
        }
        ExportFormat::Jsbsim => Some(export::jsbsim(&model)),
        ExportFormat::Json => Some(export::json(&model).map_err(|error| of_model(&error))?),
    };
    match (output, text) {
        (None, Some(text)) if format == ExportFormat::Json => {
            Ok(Outcome::with_json(text.clone(), text))
        }
        (None, text) => Ok(Outcome::text(text.unwrap_or_default())),
        (Some(path), text) => {
            if let Some(text) = text {
                write_result(path, text.as_bytes())?;
            }
            let name = format.to_possible_value().map(|value| value.get_name().to_owned());
            Ok(Outcome {
                figures: serde_json::json!({ "format": name, "written": [show(path)] }),
                ..Outcome::default()
            })
        }
    }
}

/// The format that was asked for. With `--json` and no file the model itself is the document.
fn format(arguments: &ExportArgs) -> Result<ExportFormat, Failure> {
    let asked =
        if arguments.polynomial { Some(ExportFormat::Polynomial) } else { arguments.format };
    let on_standard_output = arguments.output.is_none() && arguments.json.json;
    match (asked, on_standard_output) {
        (None | Some(ExportFormat::Json), true) => Ok(ExportFormat::Json),
        (Some(_), true) => Err(Failure::BadArgument {
            argument: "--json",
            reason:
                "standard output has room for the document alone; give the table a file with -o"
                    .to_owned(),
        }),
        (asked, false) => Ok(asked.unwrap_or(ExportFormat::Csv)),
    }
}
