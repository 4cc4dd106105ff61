//! `cruisefit convert`: recordings of another layout into cruise reports of format 1.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use flight::Report;
use pipeline::summary::counted;
use report::mapping::Mapping;
use report::{Parsed, TextLayout};

use crate::args::ConvertArgs;
use crate::commands::{Outcome, check_refused, read_mapping};
use crate::failure::{Failure, RefusedReport, show};
use crate::files::file_stem_of_tail;
use crate::files::outputs::check_replaceable;
use crate::files::{make_folder, write_atomically};
use crate::inputs;
use crate::progress::Progress;
use crate::reading::Recording;

/// Samples that a dry run shows of each flight.
const SHOWN_SAMPLES: usize = 10;
/// What ends the header of a report.
const FIRST_COLUMN: &str = "TIME ";

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &ConvertArgs, progress: Progress) -> Result<Outcome, Failure> {
    let mapping = read_mapping(&arguments.mapping)?;
    let inputs = inputs::collect(&arguments.recordings, true)?;
    let bar = progress.bar(inputs.files.len(), "reading recordings");
    let mut refused = inputs.refused;
    let mut flights = Vec::new();
    for path in &inputs.files {
        match read(&mapping, path) {
            Ok(parsed) => flights.extend(parsed),
            Err(reason) => refused.push(reason),
        }
        bar.step();
    }
    bar.finish();
    check_refused(&refused, inputs.files.len(), arguments.strict, flights.is_empty())?;
    let text = match &arguments.output {
        Some(folder) => write_all(&flights, folder, arguments.force, &mut refused)?,
        None => dry_run(&flights),
    };
    Ok(Outcome { text, refused })
}

/// A flight as it was read, and where from.
struct Converted {
    path: PathBuf,
    parsed: Parsed,
}

fn read(mapping: &Mapping, path: &Path) -> Result<Vec<Converted>, RefusedReport> {
    let recording =
        Recording::read(path).map_err(|reason| RefusedReport::whole(path.to_owned(), reason))?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let parsed = recording
        .mapped_by(mapping)
        .read_named(&recording.bytes, &name)
        .map_err(|refusal| RefusedReport::at(path.to_owned(), &refusal))?;
    Ok(parsed.into_iter().map(|parsed| Converted { path: path.to_owned(), parsed }).collect())
}

/// Writes each flight as a report of its own.
fn write_all(
    flights: &[Converted],
    folder: &Path,
    force: bool,
    refused: &mut Vec<RefusedReport>,
) -> Result<String, Failure> {
    make_folder(folder)?;
    let mut written = 0;
    for Converted { path, parsed } in flights {
        let text = match report::write(&parsed.report, &TextLayout::exact(), &[]) {
            Ok(text) => text,
            Err(error) => {
                refused.push(RefusedReport::whole(path.clone(), error));
                continue;
            }
        };
        let file = folder.join(file_name(&parsed.report));
        check_replaceable(&file, force, text.as_bytes(), |_| false)?;
        write_atomically(&file, text.as_bytes())?;
        written += 1;
    }
    Ok(format!("{} written to {}.\n", counted(written, "report"), show(folder)))
}

/// Tail, flight and START, each as a file's name may hold it.
fn file_name(report: &Report) -> String {
    let identity = &report.header().identity;
    let start = identity.start.to_string().replace(['-', ':'], "");
    let [tail, flight, start] =
        [identity.tail.as_str(), &identity.flight, &start].map(file_stem_of_tail);
    format!("{tail}_{flight}_{start}.txt")
}

/// What each column became: header, units and the first samples of each flight.
fn dry_run(flights: &[Converted]) -> String {
    let mut text = String::new();
    for Converted { path, parsed } in flights {
        let report = &parsed.report;
        let _ = writeln!(text, "# {}: {}", show(path), counted(report.len(), "sample"));
        for finding in &parsed.findings {
            let _ = writeln!(text, "# {}", finding.message);
        }
        let written = report::write(report, &TextLayout::industry(), &[])
            .or_else(|_| report::write(report, &TextLayout::exact(), &[]));
        match written {
            Ok(written) => text.push_str(first_samples(&written)),
            Err(error) => {
                let _ = writeln!(text, "# not as a report: {error}");
            }
        }
        text.push('\n');
    }
    let _ = writeln!(
        text,
        "{} read, nothing written; `-o FOLDER` writes them as reports.",
        counted(flights.len(), "flight")
    );
    text
}

/// A report's text up to its first samples.
fn first_samples(report: &str) -> &str {
    let names = report.find(&format!("\n{FIRST_COLUMN}")).unwrap_or_default();
    // The end of the line before the names, of the names, of the units, and of each sample.
    let mut ends = report[names..].match_indices('\n').map(|(at, _)| names + at + 1);
    let end = ends.nth(2 + SHOWN_SAMPLES).unwrap_or(report.len());
    &report[..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dry_run_shows_ten_samples() {
        let head = "CRUISE-REPORT 1\nTAIL X\nTIME ALT\ns ft\n";
        let rows = |count: usize| "0 1\n".repeat(count);
        assert_eq!(first_samples(&format!("{head}{}", rows(12))), format!("{head}{}", rows(10)));
        assert_eq!(first_samples(&format!("{head}{}", rows(3))), format!("{head}{}", rows(3)));
    }
}
