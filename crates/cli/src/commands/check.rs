//! `cruisefit check`: what is wrong with reports, before any modelling.

use std::time::{SystemTime, UNIX_EPOCH};

use pipeline::plausibility;
use pipeline::reading::Checks;

use crate::args::CheckArgs;
use crate::commands::{Outcome, check_refused, read_reports};
use crate::failure::Failure;
use crate::models::read_models;
use crate::progress::Progress;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &CheckArgs, progress: Progress) -> Result<Outcome, Failure> {
    let models =
        if arguments.models.is_empty() { None } else { Some(read_models(&arguments.models)?) };
    let reading = read_reports(&arguments.reports, Checks::Made, progress)?;
    let files = reading.files();
    let nothing_left = reading.flights.is_empty();
    check_refused(&reading.refused, files, arguments.reports.strict, nothing_left)?;
    let now_s = SystemTime::now().duration_since(UNIX_EPOCH).ok().map(|since| since.as_secs_f64());
    let document = plausibility::check_document(&reading, models.as_ref(), now_s);
    Ok(Outcome {
        refused: reading.refused,
        ..Outcome::with_json(document.to_text(), document.to_json())
    })
}
