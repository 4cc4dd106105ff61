//! `cruisefit mapping`: a first mapping file for a recording, from the names and values of its columns.

use std::fmt::Write;
use std::path::Path;

use report::mapping::{Mapping, PRESETS, first_mapping};

use crate::args::MappingArgs;
use crate::commands::{Outcome, no_such_mapping};
use crate::criteria::NamedCriteria;
use crate::failure::{Failure, show};
use crate::files::outputs::check_replaceable;
use crate::files::write_atomically;
use crate::reading::{Buffers, Source, open};
use pipeline::reading::{Checks, RefusedReport};
use pipeline::summary::counted;

/// What marks a guess in a mapping file.
const GUESS: &str = "// ?";
/// Rows of a table of averaged points, in the document.
const POINTS: &str = "averaged_points";
/// So much of a recording is looked at: the cruise of a first flight of hundreds of columns each second.
const LOOKED_AT_BYTES: usize = 16 << 20;

/// Runs the command.
///
/// # Errors
/// A recording that cannot be read as a table, or a mapping file that would be lost.
pub(crate) fn run(arguments: &MappingArgs) -> Result<Outcome, Failure> {
    let (text, tried) = match (&arguments.presets, &arguments.recording) {
        (None, Some(path)) => first_mapping_of(path)?,
        (presets, _) => return presets_as_text(presets.as_deref().unwrap_or_default()),
    };
    let mut figures = serde_json::json!({
        "guesses": tried.guesses, "flights": tried.flights, tried.of_rows: tried.rows, "refused": tried.refused,
    });
    // To `-` the mapping alone, so that it can be read from there.
    let output = arguments.output.as_ref().filter(|output| output.as_os_str() != "-");
    let Some(output) = output else { return Ok(Outcome::with_figures(text, figures)) };
    check_replaceable(output, arguments.force, text.as_bytes(), |_| false)?;
    write_atomically(output, text.as_bytes())?;
    figures["written"] = serde_json::json!([show(output)]);
    Ok(Outcome::with_figures(format!("Mapping file written to {}.\n", show(output)), figures))
}

/// The built-in mappings with what they are for, or the text of one.
fn presets_as_text(name: &str) -> Result<Outcome, Failure> {
    if let Some((_, text)) = PRESETS.iter().find(|(known, _)| *known == name) {
        return Ok(Outcome::with_figures(*text, serde_json::json!({ "preset": name })));
    }
    if !name.is_empty() {
        return Err(no_such_mapping("--presets", name));
    }
    let mut listed = String::new();
    for (name, text) in PRESETS {
        let _ = writeln!(listed, "{name}");
        for line in text.lines().map_while(|line| line.strip_prefix("// ")) {
            let _ = writeln!(listed, "    {line}");
        }
    }
    listed.push_str("Tables of segments that this program wrote need no mapping.\n");
    let names: Vec<&str> = PRESETS.iter().map(|(name, _)| *name).collect();
    Ok(Outcome::with_figures(listed, serde_json::json!({ "presets": names })))
}

fn first_mapping_of(path: &Path) -> Result<(String, Tried), Failure> {
    let recording = open(path).map_err(|reason| Failure::unreadable(path, reason))?;
    let refused =
        |refusal| Failure::bad_file(path, RefusedReport::at(path.to_owned(), &refusal).reason);
    let beginning = recording.beginning(LOOKED_AT_BYTES).map_err(refused)?;
    if beginning.starts_with(b"CRUISE-REPORT") {
        return Err(Failure::bad_file(path, "a cruise report, which is read without a mapping"));
    }
    let text = first_mapping(&beginning).map_err(refused)?;
    // What comes of it is said beside it: standard output may be the mapping file.
    let tried = tried(&text, path);
    crate::terminal::tell(&tried.words());
    Ok((text, tried))
}

/// What a mapping makes of the recording it was written for.
struct Tried {
    /// Lines marked as guesses.
    guesses: usize,
    flights: usize,
    rows: usize,
    /// What a row is, for the document.
    of_rows: &'static str,
    /// Why the recording is not read as it is.
    refused: Option<String>,
}

impl Tried {
    fn words(&self) -> String {
        let guesses = counted(self.guesses, "guess");
        let of = if self.of_rows == POINTS { "averaged point" } else { "sample" };
        match &self.refused {
            None => format!(
                "{guesses} marked `{GUESS}`: check them.\nAs it is, it reads {} with {}.\n",
                counted(self.flights, "flight"),
                counted(self.rows, of)
            ),
            Some(reason) => {
                format!(
                    "{guesses} marked `{GUESS}`: check them.\nAs it is, the recording is not read: {reason}\n"
                )
            }
        }
    }
}

/// How many lines are guesses, and what the mapping makes of the recording as it is.
fn tried(text: &str, path: &Path) -> Tried {
    let guesses = text.lines().filter(|line| line.contains(GUESS)).count() - 1;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let (mut flights, mut rows, mut of_rows) = (0, 0, "samples");
    let read = Mapping::from_ron(text).map_err(|error| error.to_string()).and_then(|mapping| {
        if mapping.is_of_points() {
            let criteria = NamedCriteria::default().limits;
            let source = Source { mapping: Some(mapping), criteria, checks: Checks::LeftOut };
            let (read, refused) = source.read_file(path, &mut Buffers::default());
            flights = read.len();
            rows = read.iter().map(|flight| flight.reduced.samples).sum();
            of_rows = POINTS;
            return refused.into_iter().next().map_or(Ok(()), |refused| Err(refused.reason));
        }
        let read = mapping.each(&mut open(path)?, Some(&name), |parsed| {
            flights += 1;
            rows += parsed.report.len();
        });
        read.map(|_| ()).map_err(|error| error.to_string())
    });
    Tried { guesses, flights, rows, of_rows, refused: read.err() }
}
