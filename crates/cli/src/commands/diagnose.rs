//! `cruisefit diagnose`: where a model differs from flight and which effect it lacks.

mod apply;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use diagnose::{FlightRecord, Input, Options, diagnose};
use flight::effect::EffectId;
use rayon::prelude::*;

use crate::args::DiagnoseArgs;
use crate::commands::{Outcome, check_refused, predicts, prepare};
use crate::failure::{Failure, RefusedReport, show};
use crate::files::{make_folder, write_atomically};
use crate::models::Models;
use crate::plausibility;
use crate::progress::Progress;
use crate::reading::{FlightRead, Reading};
use pipeline::diagnosed_tail::{Compared, DiagnosedTail, POOL, RunOptions};
use pipeline::diagnosis_document::DiagnosisDocument;
use pipeline::diagnosis_figures::DiagnosisFigures;
use pipeline::model_file::ModelFile;
use pipeline::summary::{RefusedSummary, ReportsSummary, counted};
use pipeline::{diagnosis_text, table_uncertainty};

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &DiagnoseArgs, progress: Progress) -> Result<Outcome, Failure> {
    let options = Options {
        effects: effects("--effects", &arguments.effects)?,
        without: effects("--without", &arguments.without)?,
        ..Options::default()
    };
    let asked = RunOptions {
        effects: arguments.effects.clone(),
        without: arguments.without.clone(),
        pool: arguments.pool,
        table_only: arguments.table_only,
        allow_learnt: arguments.allow_learnt,
    };
    let models = Models::read(&arguments.models.models)?;
    let mut reading = prepare(&arguments.reports, progress)?;
    let files = reading.files();
    let book_of = |flight: &FlightRead| {
        let model = models.for_flight(flight).ok()?;
        Some((&model.initial, model.drag_coefficient()))
    };
    plausibility::set_aside_absurd(&mut reading, book_of, arguments.accept);
    let groups = group(&models, &mut reading, arguments);
    check_refused(&reading.refused, files, arguments.reports.strict, groups.is_empty())?;
    make_folder(&arguments.output)?;
    let read = groups.iter().map(|group| group.flights.len()).sum();
    let diagnoses = groups
        .par_iter()
        .map(|group| diagnose_group(group, &options, &asked))
        .collect::<Result<Vec<_>, Failure>>()?;
    let (diagnoses, figures): (Vec<_>, Vec<_>) = diagnoses.into_iter().unzip();
    reading.refused.sort_by(|one, other| one.path.cmp(&other.path));
    let reports = ReportsSummary {
        read,
        already_known: 0,
        refused: reading.refused.iter().map(RefusedSummary::from).collect(),
    };
    let path = arguments.output.join("diagnosis.json");
    let json = DiagnosisDocument::new(&asked, &reports, &diagnoses)
        .to_json()
        .map_err(|error| Failure::unwritable(&path, error))?;
    write_atomically(&path, json.as_bytes())?;
    let html = page::diagnosis(&reports, &diagnoses, &figures, &in_words(arguments));
    write_atomically(&arguments.output.join("diagnosis.html"), html.as_bytes())?;
    let mut text = String::new();
    for diagnosed in &diagnoses {
        append_lines(diagnosed, &mut text);
    }
    let refused_reports = reading.refused.len();
    if let Some(folder) = &arguments.apply {
        let applied = apply::apply(folder, &groups, &diagnoses)?;
        text.push_str(&applied.text);
        reading.refused.extend(applied.refused);
    }
    let _ = writeln!(
        text,
        "{} read, {} refused. Written to {}: diagnosis.json, diagnosis.html",
        counted(read, "report"),
        refused_reports,
        show(&arguments.output)
    );
    Ok(Outcome { text, refused: reading.refused })
}

fn effects(argument: &'static str, names: &[String]) -> Result<Vec<EffectId>, Failure> {
    names
        .iter()
        .map(|name| {
            EffectId::from_name(name).ok_or_else(|| {
                let known: Vec<String> = EffectId::library(flight::MAXIMUM_ENGINES)
                    .iter()
                    .map(ToString::to_string)
                    .collect();
                Failure::BadArgument {
                    argument,
                    reason: format!("no effect {name:?}; known are {}", known.join(", ")),
                }
            })
        })
        .collect()
}

/// Flights that are diagnosed together, and the model that they are compared with.
struct Group<'a> {
    name: String,
    model: &'a ModelFile,
    flights: Vec<FlightRead>,
}

/// Flights by tail (or all of one model in a pool); those that their model has learnt are refused by name.
fn group<'a>(
    models: &'a Models,
    reading: &mut Reading,
    arguments: &DiagnoseArgs,
) -> Vec<Group<'a>> {
    let mut groups: BTreeMap<String, Group<'a>> = BTreeMap::new();
    let mut flights = std::mem::take(&mut reading.flights);
    flights.sort_by(FlightRead::order);
    for flight in flights {
        let model = match models.for_flight(&flight) {
            Ok(model) => model,
            Err(reason) => {
                reading.refused.push(RefusedReport::whole(flight.path, reason));
                continue;
            }
        };
        if has_learnt(model, &flight) {
            let finding = format!(
                "tail {} flight {} of {} is in the model's ledger: what it has learnt hides the gap",
                flight.reduced.identity.tail,
                flight.reduced.identity.flight,
                flight.reduced.identity.start
            );
            if !arguments.allow_learnt {
                let reason = format!("{finding} (--allow-learnt diagnoses it anyway)");
                reading.refused.push(RefusedReport::whole(flight.path, reason));
                continue;
            }
            tracing::warn!("{finding}; diagnosed anyway, as asked");
        }
        // A pool has one model: a difference between models is not a gap of either.
        let (key, name) = if arguments.pool {
            (model.initial.aircraft().type_code().to_owned(), POOL.to_owned())
        } else {
            (flight.reduced.identity.tail.clone(), flight.reduced.identity.tail.clone())
        };
        let group = groups.entry(key).or_insert_with(|| Group { name, model, flights: Vec::new() });
        if std::ptr::eq(group.model, model) {
            group.flights.push(flight);
        } else {
            reading.refused.push(RefusedReport::whole(
                flight.path,
                "its tail has a model of its own: a pool is diagnosed against one model",
            ));
        }
    }
    groups.into_values().collect()
}

fn has_learnt(model: &ModelFile, flight: &FlightRead) -> bool {
    let start = flight.reduced.identity.start.to_string();
    model.learnt.as_ref().is_some_and(|learnt| {
        learnt.ledger.iter().any(|entry| {
            entry.tail == flight.reduced.identity.tail
                && entry.flight == flight.reduced.identity.flight
                && entry.start == start
        })
    })
}

fn diagnose_group(
    group: &Group<'_>,
    options: &Options,
    asked: &RunOptions,
) -> Result<(DiagnosedTail, DiagnosisFigures), Failure> {
    let wrong = |reason: &dyn std::fmt::Display| Failure::BadArgument {
        argument: "--model",
        reason: format!("tail {}: {reason}", group.name),
    };
    let records: Vec<FlightRecord<'_>> = group
        .flights
        .iter()
        .filter(|flight| !flight.reduced.segments.is_empty())
        .map(|flight| FlightRecord {
            segments: &flight.reduced.segments,
            gauges: flight.reduced.gauges,
        })
        .collect();
    let predicts = predicts(asked.table_only);
    let table = table_uncertainty::of_model(group.model, predicts, &records)
        .map_err(|error| wrong(&error))?;
    let baseline = group.model.learnt.as_ref().and_then(|learnt| learnt.baseline.as_ref());
    let input = Input {
        model: &group.model.initial,
        drag_table: group.model.reference_table(predicts),
        flights: &records,
        baseline: if asked.table_only { None } else { baseline },
        table: table.as_ref(),
        references: baseline.map(|baseline| *baseline.references()),
    };
    let diagnosis = diagnose(&input, options).map_err(|error| wrong(&error))?;
    let mut run_notes = asked.restrictions();
    if baseline.is_none() && !asked.table_only {
        run_notes.push(
            "the model has learnt no remainder (law bayes learns one from five flights): everything that a table cannot hold \
             counts as gap"
                .to_owned(),
        );
    }
    let mut seen = BTreeSet::new();
    for note in group.flights.iter().flat_map(|flight| &flight.reduced.notes) {
        if seen.insert(note) {
            run_notes.push(note.clone());
        }
    }
    let figures =
        DiagnosisFigures::new(group.model, &input, &diagnosis).map_err(|error| wrong(&error))?;
    let compared = compared(group);
    Ok((DiagnosedTail { tail: group.name.clone(), diagnosis, compared, run_notes }, figures))
}

/// The options that an answer depends on, for the page.
fn in_words(arguments: &DiagnoseArgs) -> Vec<String> {
    let mut words = vec![format!("trim criteria {}", arguments.reports.criteria)];
    if !arguments.effects.is_empty() {
        words.push(format!("only these effects looked for: {}", arguments.effects.join(", ")));
    }
    if !arguments.without.is_empty() {
        words.push(format!("not looked for: {}", arguments.without.join(", ")));
    }
    let modes = [
        (arguments.pool, "all tails of a type together (--pool)"),
        (arguments.table_only, "against the table alone (--table-only)"),
        (arguments.allow_learnt, "flights that the model has learnt included (--allow-learnt)"),
    ];
    words.extend(modes.iter().filter(|(is, _)| *is).map(|(_, words)| (*words).to_owned()));
    words
}

fn compared(group: &Group<'_>) -> Compared {
    let starts = || group.flights.iter().map(|flight| flight.reduced.identity.start);
    let learnt = group.model.learnt.as_ref();
    Compared {
        aircraft: group.model.initial.aircraft().name().to_owned(),
        law: learnt.map(|learnt| learnt.law.told()),
        flights_learnt: learnt.map_or(0, |learnt| learnt.ledger.len()),
        first_flight: starts().min().map(|start| start.to_string()),
        last_flight: starts().max().map(|start| start.to_string()),
    }
}

/// The diagnosis in a dozen lines, and what was assumed.
fn append_lines(diagnosed: &DiagnosedTail, text: &mut String) {
    for (place, line) in diagnosis_text::lines(diagnosed).into_iter().enumerate() {
        let _ = writeln!(text, "{}{line}", if place == 0 { "" } else { "  " });
    }
    for note in diagnosed.notes() {
        let _ = writeln!(text, "  Note: {note}.");
    }
    text.push('\n');
}
