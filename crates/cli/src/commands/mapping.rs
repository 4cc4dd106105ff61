//! `cruisefit mapping`: a first mapping file for a recording, from the names and values of its columns.

use std::fmt::Write;

use report::mapping::{Mapping, first_mapping};

use crate::args::MappingArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::outputs::check_replaceable;
use crate::files::write_atomically;
use crate::reading::Recording;
use pipeline::reading::RefusedReport;
use pipeline::summary::counted;

/// What marks a guess in a mapping file.
const GUESS: &str = "// ?";

/// Runs the command.
///
/// # Errors
/// A recording that cannot be read as a table, or a mapping file that would be lost.
pub(crate) fn run(arguments: &MappingArgs) -> Result<Outcome, Failure> {
    let path = &arguments.recording;
    let recording = Recording::read(path).map_err(|reason| Failure::unreadable(path, reason))?;
    let text = first_mapping(&recording.bytes).map_err(|refusal| {
        Failure::bad_file(path, RefusedReport::at(path.clone(), &refusal).reason)
    })?;
    // What comes of it is said beside it: standard output may be the mapping file.
    eprint!("{}", tried(&text, &recording, arguments));
    let Some(output) = &arguments.output else { return Ok(Outcome::text(text)) };
    check_replaceable(output, arguments.force, text.as_bytes(), |_| false)?;
    write_atomically(output, text.as_bytes())?;
    Ok(Outcome::text(format!("Mapping file written to {}.\n", show(output))))
}

/// How many lines are guesses, and what the mapping makes of the recording as it is.
fn tried(text: &str, recording: &Recording, arguments: &MappingArgs) -> String {
    let guesses = text.lines().filter(|line| line.contains(GUESS)).count() - 1;
    let mut said = format!("{} marked `{GUESS}`: check them.\n", counted(guesses, "guess"));
    let name = arguments.recording.file_name().unwrap_or_default().to_string_lossy();
    let read = Mapping::from_ron(text).map_err(|error| error.to_string()).and_then(|mapping| {
        let mapping = recording.mapped_by(&mapping);
        mapping.read_named(&recording.bytes, &name).map_err(|error| error.to_string())
    });
    let _ = match read {
        Ok(reports) => {
            let samples: usize = reports.iter().map(|parsed| parsed.report.len()).sum();
            writeln!(
                said,
                "As it is, it reads {} with {}.",
                counted(reports.len(), "flight"),
                counted(samples, "sample")
            )
        }
        Err(reason) => writeln!(said, "As it is, the recording is not read: {reason}"),
    };
    said
}
