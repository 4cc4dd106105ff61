//! `cruisefit diagnose`: where a model differs from flight and which effect it lacks.

mod apply;
mod fleet;

use std::fmt::Write;

use diagnose::Options;
use effects::OUTSIDE;
use flight::effect::EffectId;
use page::FleetRun;
use rayon::prelude::*;

use self::apply::Outside;
use crate::args::DiagnoseArgs;
use crate::commands::{Outcome, check_refused, events_of, read_reports, tell_serious};
use crate::failure::{Failure, show};
use crate::files::{make_folder, write_atomically};
use crate::models::read_models;
use crate::progress::Progress;
use crate::terminal::kinds::Told;
use crate::terminal::neutral;
use pipeline::diagnosed_tail::{DiagnosedTail, RunOptions};
use pipeline::diagnosis_document::DiagnosisDocument;
use pipeline::diagnosis_figures::DiagnosisFigures;
use pipeline::diagnosis_groups::{Group, NoSuchEffect, effects_named, group};
use pipeline::diagnosis_text;
use pipeline::distinct::distinct;
use pipeline::gaps_table;
use pipeline::monitoring::warn_of_events;
use pipeline::plausibility::{self, Absurd, Book};
use pipeline::reading::Checks;
use pipeline::summary::{RefusedSummary, ReportsSummary, counted, other_files_words};

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &DiagnoseArgs, progress: Progress) -> Result<Outcome, Failure> {
    let outside = Outside::of(arguments)?;
    let asked = asked(arguments)?;
    let options = Options {
        effects: effects("--effects", &asked.effects)?,
        without: effects("--without", &asked.without)?,
        ..Options::default()
    };
    let models = read_models(&arguments.models.models)?;
    let mut reading = distinct(read_reports(&arguments.reports, Checks::Made, progress)?);
    let files = reading.files();
    let models = models.of_tails(&mut reading);
    let book_of = |tail: &str| models.get(tail).map(|model| Book::of(model));
    let absurd = if arguments.accept { Absurd::Accept } else { Absurd::Refuse };
    tell_serious(&plausibility::set_aside_absurd(&mut reading, book_of, absurd));
    let groups = group(&models, &mut reading, &asked);
    check_refused(&reading.refused, files, arguments.reports.strict, groups.is_empty())?;
    warn_of_events(&asked.events, |tail| {
        let mut flights = groups.iter().flat_map(|group| &group.flights);
        flights.any(|flight| flight.reduced.identity.tail == tail)
    });
    make_folder(&arguments.output)?;
    let read = groups.iter().map(|group| group.flights.len()).sum();
    let diagnoses = diagnose_all(&groups, (&options, &asked), progress)?;
    let (diagnoses, figures): (Vec<_>, Vec<_>) = diagnoses.into_iter().unzip();
    let fleets = fleet::diagnose(&groups, &options, &asked)?;
    reading.refused.sort_by(|one, other| one.path.cmp(&other.path));
    let reports = ReportsSummary {
        read,
        copies: reading.copies,
        other_files: reading.other_files,
        refused: reading.refused.iter().map(RefusedSummary::from).collect(),
        ..ReportsSummary::default()
    };
    let path = arguments.output.join("diagnosis.json");
    let document = DiagnosisDocument::new(&asked, &reports, &diagnoses).with_fleets(&fleets);
    let json = document.to_json().map_err(|error| Failure::unwritable(&path, error))?;
    let gaps = (gaps_table::table(&diagnoses, &figures), arguments.output.join("gaps.csv"));
    crate::columns::check(&gaps.0, &gaps.1)?;
    fleet::check(&fleets, &arguments.output)?;
    write_atomically(&path, json.as_bytes())?;
    let options = asked.in_words(&arguments.reports.criteria.name);
    let html = page::diagnosis(&reports, &diagnoses, &figures, document.fleets(), &options);
    write_atomically(&arguments.output.join("diagnosis.html"), neutral(&html).as_bytes())?;
    crate::columns::write(&gaps.0, Some(&gaps.1))?;
    let mut text = String::new();
    for diagnosed in &diagnoses {
        append_lines(diagnosed, &mut text);
    }
    let refused_reports = reading.refused.len();
    let run = FleetRun {
        reports: &reports,
        fleets: document.fleets(),
        diagnoses: document.diagnoses(),
        figures: &figures,
        options: &options,
    };
    text.push_str(&fleet::write(&fleets, &run, &arguments.output)?);
    if let Some(folder) = &arguments.apply {
        let applied = if arguments.fleet {
            fleet::apply(folder, &groups, &fleets)?
        } else {
            apply::apply(folder, &groups, &diagnoses, outside)?
        };
        text.push_str(&applied.text);
        reading.refused.extend(applied.refused);
    }
    let _ = writeln!(
        text,
        "{} read, {} refused{}. Written to {}: diagnosis.json, diagnosis.html, gaps.csv{}",
        counted(read, "report"),
        refused_reports,
        other_files_words(reading.other_files),
        show(&arguments.output),
        if arguments.fleet { ", fleet.html, fleet.csv" } else { "" }
    );
    Ok(Outcome { refused: reading.refused, ..Outcome::with_json(text, json) })
}

/// One diagnosis for each group, side by side, with the charts' figures.
fn diagnose_all(
    groups: &[Group<'_>],
    (options, asked): (&Options, &RunOptions),
    progress: Progress,
) -> Result<Vec<(DiagnosedTail, DiagnosisFigures)>, Failure> {
    let flights = groups.iter().map(|group| group.flights.len()).sum();
    let bar = progress.bar(flights, "diagnosing flights");
    let diagnoses = groups
        .par_iter()
        .map(|group| {
            let diagnosed = group.diagnose(options, asked).map_err(|error| Failure::BadArgument {
                argument: "--model",
                reason: error.to_string(),
            });
            bar.advance(group.flights.len());
            diagnosed
        })
        .collect();
    bar.finish();
    diagnoses
}

/// What the run is asked for.
fn asked(arguments: &DiagnoseArgs) -> Result<RunOptions, Failure> {
    Ok(RunOptions {
        effects: arguments.effects.iter().filter(|name| *name != OUTSIDE).cloned().collect(),
        without: arguments.without.clone(),
        pool: arguments.pool,
        fleet: arguments.fleet,
        table_only: arguments.table_only,
        allow_learnt: arguments.allow_learnt,
        events: arguments.events.as_deref().map_or_else(|| Ok(Vec::new()), events_of)?,
    })
}

fn effects(argument: &'static str, names: &[String]) -> Result<Vec<EffectId>, Failure> {
    effects_named(names).map_err(|NoSuchEffect { name, known }| Failure::BadArgument {
        argument,
        reason: format!("no effect {name:?}; known are {known}"),
    })
}

/// The diagnosis in a dozen lines, and what was assumed.
fn append_lines(diagnosed: &DiagnosedTail, text: &mut String) {
    for (place, line) in diagnosis_text::lines(diagnosed).into_iter().enumerate() {
        let _ = writeln!(text, "{}{line}", if place == 0 { "" } else { "  " });
    }
    let mut told = Told::new(1);
    let notes = diagnosed.notes();
    let first: Vec<&String> = notes.iter().filter(|note| told.is_told(note)).collect();
    for note in first {
        let _ = match told.count(note) {
            1 => writeln!(text, "  Note: {note}."),
            count => writeln!(text, "  Note: {note} (and {} more of this kind).", count - 1),
        };
    }
    text.push('\n');
}
