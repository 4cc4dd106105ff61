//! `cruisefit tune`: settings of law `bayes` fitted to past reports.

mod shown;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use adapt::bayes::{BayesSettings, Search, SettingValues, search_half_life, tune};
use flight::Observation;

use crate::args::{HalfLifeChoice, TuneArgs};
use crate::commands::{Outcome, check_refused, prepare};
use crate::failure::{Failure, show};
use crate::models::{check_model_replaceable, read_model, write_model};
use crate::progress::Progress;
use crate::reading::{FlightRead, Reading};
use pipeline::adaptation::refuse_impossible;
use pipeline::model_file::{LawSettings, ModelFile};
use pipeline::models::Models;
use pipeline::summary::counted;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &TuneArgs, progress: Progress) -> Result<Outcome, Failure> {
    let mut model = read_model(&arguments.model)?;
    if model.learnt.is_some() {
        return Err(Failure::bad_file(
            &arguments.model,
            "has learnt already; settings are fixed in an initial model",
        ));
    }
    // What `tune` made before was an initial model, of other settings than those of a fresh one.
    check_model_replaceable(&arguments.output, arguments.force, None, |known| {
        known.learnt.is_none()
            && known.applied.is_empty()
            && known.settings != LawSettings::published()
    })?;
    let mut reading = prepare(&arguments.reports, progress)?;
    let files = reading.files();
    refuse_impossible(&mut reading, flight::Timestamp::now());
    refuse_other_types(&mut reading, &model, &arguments.model)?;
    check_refused(&reading.refused, files, arguments.reports.strict, reading.flights.is_empty())?;
    reading.flights.sort_by(FlightRead::order);
    let mut by_tail: BTreeMap<&str, usize> = BTreeMap::new();
    for flight in &reading.flights {
        *by_tail.entry(&flight.reduced.identity.tail).or_default() += 1;
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
    let flights: Vec<Vec<Observation>> = reading
        .flights
        .iter()
        .map(|flight| {
            flight
                .reduced
                .segments
                .iter()
                .filter_map(|segment| model.initial.observe(segment).ok())
                .collect()
        })
        .collect();
    let segments: usize = flights.iter().map(Vec::len).sum();
    check_enough(&flights, segments)?;
    let mut text =
        format!("{}, {}\n", counted(flights.len(), "flight"), counted(segments, "segment"));
    let steps = search(arguments, &mut model, &flights, &mut text)?;
    write_model(&model, &arguments.output)?;
    let figures = serde_json::json!({
        "flights": flights.len(),
        "segments": segments,
        "search": steps,
        "settings": model.settings.bayes.values(),
        "written": [show(&arguments.output)],
    });
    text.push_str(&shown::settings(model.settings.bayes.values()));
    let _ = writeln!(text, "Written to {}", show(&arguments.output));
    Ok(Outcome { refused: reading.refused, ..Outcome::with_figures(text, figures) })
}

/// Finds the settings and puts them into the model: a line of text and an entry of the document for each step.
fn search(
    arguments: &TuneArgs,
    model: &mut ModelFile,
    flights: &[Vec<Observation>],
    text: &mut String,
) -> Result<Vec<serde_json::Value>, Failure> {
    let mut steps = Vec::new();
    let initial = model.initial.drag_table();
    let start = model.settings.bayes;
    let of_model = |error| Failure::bad_file(&arguments.model, error);
    let aged = match arguments.half_life {
        None => start,
        Some(HalfLifeChoice::Never) => with_half_life(start, None)?,
        Some(HalfLifeChoice::Days(days)) => with_half_life(start, Some(days))?,
        Some(HalfLifeChoice::Search) => {
            let found = search_half_life(initial, start, flights).map_err(of_model)?;
            for (days, log_density) in &found.tried {
                steps
                    .push(serde_json::json!({ "half_life_days": days, "ln_density": log_density }));
                let days = days.map_or_else(|| "none".to_owned(), |days| format!("{days} days"));
                let _ = writeln!(text, "  ln density {log_density:.2}  half-life {days}");
            }
            found.settings
        }
    };
    if aged.values().half_life_days.is_some() {
        // The evidence assumes knowledge that does not age: it would mistake ageing for noise of flights.
        model.settings.bayes = aged;
        text.push_str("Noise stays as it is: with a half-life it is not searched\n");
    } else {
        let tuned = tune(initial, aged, flights, &Search::standard()).map_err(of_model)?;
        for step in &tuned.path {
            let _ = writeln!(text, "  ln evidence {:.2}  {}", step.log_evidence, step.changed);
            steps.push(serde_json::json!({ "ln_evidence": step.log_evidence, "changed": step.changed.to_string() }));
        }
        text.push_str(
            "What is maximised is the evidence times a prior that keeps each setting near its start: ln evidence alone may fall from step \
             to step.\n",
        );
        model.settings.bayes = tuned.settings;
        let span_days = span_days(flights);
        if arguments.half_life.is_none() && span_days > DAYS_IN_WHICH_AIRCRAFT_AGE {
            let _ = writeln!(
                text,
                "The reports span {span_days:.0} days and knowledge does not age: see --half-life search"
            );
        }
    }
    Ok(steps)
}

/// Moves the flights of other aircraft than the model's to the refused ones.
fn refuse_other_types(
    reading: &mut Reading,
    model: &ModelFile,
    path: &Path,
) -> Result<(), Failure> {
    let models = Models::new(vec![(path.to_owned(), model.clone())])
        .map_err(|same| Failure::bad_file(path, &same))?;
    models.of_tails(reading);
    Ok(())
}

/// Flights below which what is found is the prior rather than the fleet: the scatter of so many is known to a sixth.
const FEW_FLIGHTS: usize = 20;

/// Refuses flights that show nothing of the noise, and warns of few.
fn check_enough(flights: &[Vec<Observation>], segments: usize) -> Result<(), Failure> {
    let used = flights.iter().filter(|segments| !segments.is_empty()).count();
    if segments == 0 {
        return Err(Failure::BadArgument {
            argument: "REPORTS",
            reason: format!(
                "{} and no segment inside the model's table: nothing to find settings from",
                counted(flights.len(), "flight")
            ),
        });
    }
    if used < FEW_FLIGHTS {
        tracing::warn!(
            "{} with {}: settings found from fewer than {FEW_FLIGHTS} flights are little more than those it begins with",
            counted(used, "flight"),
            counted(segments, "segment")
        );
    }
    Ok(())
}

/// Over half a year an aircraft's engines lose about what a flight's own errors amount to, 1 %, at 2 % a year.
const DAYS_IN_WHICH_AIRCRAFT_AGE: f64 = 180.0;

fn with_half_life(settings: BayesSettings, days: Option<f64>) -> Result<BayesSettings, Failure> {
    BayesSettings::new(SettingValues { half_life_days: days, ..*settings.values() }).map_err(
        |error| Failure::BadArgument { argument: "--half-life", reason: error.to_string() },
    )
}

/// From the first observation to the last, days.
fn span_days(flights: &[Vec<Observation>]) -> f64 {
    let times = || flights.iter().flatten().map(|observation| observation.time);
    match (times().min(), times().max()) {
        (Some(first), Some(last)) => {
            last.duration_since(first).as_secs_f64() / units::convert::SECONDS_PER_DAY
        }
        _ => 0.0,
    }
}
