//! `cruisefit convert`: recordings of another layout into cruise reports of format 1.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use flight::Report;
use pipeline::reading::warn_of;
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
use crate::progress::{Bar, Progress};
use crate::reading::open;

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
    let inputs = inputs::collect(&arguments.recordings, Some(&arguments.mapping))?;
    let mut refused = inputs.refused;
    if arguments.strict {
        let mut checked = Conversion::new(&mapping, Output::Nowhere);
        checked.read_all(&inputs.files, &progress.bar(inputs.files.len(), "checking recordings"));
        refused.append(&mut checked.refused);
        check_refused(&refused, inputs.files.len(), true, checked.flights == 0)?;
    }
    let output = match &arguments.output {
        Some(folder) => Output::Folder(folder, arguments.force),
        None => Output::Shown(String::new()),
    };
    let mut conversion = Conversion::new(&mapping, output);
    conversion.read_all(&inputs.files, &progress.bar(inputs.files.len(), "reading recordings"));
    if let Some(failure) = conversion.failure {
        return Err(failure);
    }
    refused.append(&mut conversion.refused);
    let flights = conversion.flights;
    check_refused(&refused, inputs.files.len(), arguments.strict, flights == 0)?;
    let text = match conversion.output {
        Output::Folder(folder, _) => {
            format!("{} written to {}.\n", counted(conversion.written, "report"), show(folder))
        }
        Output::Shown(shown) => {
            let read = counted(flights, "flight");
            shown + &format!("{read} read, nothing written; `-o FOLDER` writes them as reports.\n")
        }
        Output::Nowhere => String::new(),
    };
    let figures = serde_json::json!({ "flights": flights, "reports_written": conversion.written });
    Ok(Outcome { refused, ..Outcome::with_figures(text, figures) })
}

/// Where flights go, one after the other: a month of a fleet does not fit into memory.
enum Output<'a> {
    /// Reports of their own; whether what is there is replaced.
    Folder(&'a Path, bool),
    /// What each column became.
    Shown(String),
    /// Nowhere: only what is refused is wanted.
    Nowhere,
}

struct Conversion<'a> {
    mapping: &'a Mapping,
    output: Output<'a>,
    flights: usize,
    written: usize,
    refused: Vec<RefusedReport>,
    /// What stopped the writing.
    failure: Option<Failure>,
}

impl<'a> Conversion<'a> {
    const fn new(mapping: &'a Mapping, output: Output<'a>) -> Self {
        Self { mapping, output, flights: 0, written: 0, refused: Vec::new(), failure: None }
    }

    fn read_all(&mut self, files: &[PathBuf], bar: &Bar) {
        for path in files {
            let mapping = self.mapping;
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let refusal = match open(path) {
                Ok(mut source) => mapping
                    .each(&mut source, Some(&name), |parsed| self.take(path, &parsed))
                    .err()
                    .map(|refusal| RefusedReport::at(path.clone(), &refusal)),
                Err(reason) => Some(RefusedReport::whole(path.clone(), reason)),
            };
            self.refused.extend(refusal);
            bar.step();
        }
        bar.finish();
    }

    fn take(&mut self, path: &Path, parsed: &Parsed) {
        self.flights += 1;
        // What was left out of a recording is in no report that is made of it.
        if let Output::Folder(..) = self.output {
            warn_of(path, &parsed.findings);
        }
        match &mut self.output {
            Output::Shown(shown) => show_flight(path, parsed, shown),
            Output::Folder(folder, force) if self.failure.is_none() => {
                match report::write(&parsed.report, &TextLayout::exact(), &[]) {
                    Ok(text) => match write_report(folder, *force, &parsed.report, text.as_bytes())
                    {
                        Ok(()) => self.written += 1,
                        Err(failure) => self.failure = Some(failure),
                    },
                    Err(error) => {
                        self.refused.push(RefusedReport::whole(path.to_owned(), error));
                    }
                }
            }
            Output::Folder(..) | Output::Nowhere => {}
        }
    }
}

fn write_report(folder: &Path, force: bool, report: &Report, text: &[u8]) -> Result<(), Failure> {
    make_folder(folder)?;
    let file = folder.join(file_name(report));
    check_replaceable(&file, force, text, |_| false)?;
    write_atomically(&file, text)
}

/// Tail, flight and START, each as a file's name may hold it.
fn file_name(report: &Report) -> String {
    let identity = &report.header().identity;
    let start = identity.start.to_string().replace(['-', ':'], "");
    let [tail, flight, start] =
        [identity.tail.as_str(), &identity.flight, &start].map(file_stem_of_tail);
    format!("{tail}_{flight}_{start}.txt")
}

/// What each column became: header, units and the first samples of a flight.
fn show_flight(path: &Path, parsed: &Parsed, text: &mut String) {
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
