//! `cruisefit tune`: settings of law `bayes` from past reports.

use std::collections::BTreeMap;
use std::fmt::Write;

use adapt::bayes::{Search, tune};

use crate::args::TuneArgs;
use crate::commands::{Outcome, check_refused, prepare};
use crate::failure::{Failure, show};
use crate::model_file::ModelFile;
use crate::reading::FlightRead;

/// Runs the command.
///
/// # Errors
/// What leaves nothing done.
pub fn run(arguments: &TuneArgs, progress: bool) -> Result<Outcome, Failure> {
    let mut model = ModelFile::read(&arguments.model)?;
    if model.learnt.is_some() {
        return Err(Failure::bad_file(
            &arguments.model,
            "has learnt already; settings are fixed in an initial model",
        ));
    }
    let mut reading = prepare(&arguments.reports, progress)?;
    let files = reading.files();
    check_refused(&reading.refused, files, arguments.reports.strict, reading.flights.is_empty())?;
    reading.flights.sort_by(FlightRead::order);
    let mut by_tail: BTreeMap<&str, usize> = BTreeMap::new();
    for flight in &reading.flights {
        *by_tail.entry(&flight.identity.tail).or_default() += 1;
    }
    if by_tail.len() > 1 {
        return Err(Failure::BadArgument {
            argument: "REPORTS",
            reason: format!(
                "reports of {} tails; settings are found on one tail at a time",
                by_tail.len()
            ),
        });
    }
    let flights: Vec<Vec<_>> = reading
        .flights
        .iter()
        .map(|flight| {
            flight
                .segments
                .iter()
                .filter_map(|segment| model.initial.observe(segment).ok())
                .collect()
        })
        .collect();
    let segments: usize = flights.iter().map(Vec::len).sum();
    let tuned =
        tune(model.initial.drag_table(), model.settings.bayes, &flights, &Search::standard())
            .map_err(|error| Failure::bad_file(&arguments.model, error))?;
    model.settings.bayes = tuned.settings;
    model.write(&arguments.output)?;
    let mut text = format!("{} flights, {segments} segments\n", flights.len());
    for step in &tuned.path {
        let _ = writeln!(text, "  ln evidence {:.2}  {}", step.log_evidence, step.changed);
    }
    let _ = writeln!(text, "Settings: {:#?}", tuned.settings.values());
    let _ = writeln!(text, "Written to {}", show(&arguments.output));
    Ok(Outcome { text, refused: reading.refused })
}
