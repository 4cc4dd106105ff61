//! `cruisefit monitor`: what changed, when and by how much, on the tails that a folder of `adapt` holds.

mod causes;
mod stored;

use std::fmt::Write;
use std::path::Path;

use monitor::cost::CostFactors;
use pipeline::monitoring::{
    AlertDocument, BeforeLearning, Event, MonitorDocument, MonitorOptions, MonitoredTail, Rows,
    TailDeviations, TailDocument, tables, text,
};
use rayon::prelude::*;

use crate::args::MonitorArgs;
use crate::columns;
use crate::commands::{Ending, Outcome, events_of, warn_of_events};
use crate::failure::{Failure, show};
use crate::files::{make_folder, write_atomically};
use crate::progress::Progress;
use crate::terminal::neutral;

use causes::Causes;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &MonitorArgs, progress: Progress) -> Result<Outcome, Failure> {
    let options = MonitorOptions {
        cost: CostFactors {
            co2_kg_per_kg: arguments.co2_factor,
            price_per_kg: arguments.fuel_price,
            flights_per_year: arguments.flights_per_year,
        },
        basic_performance_factor_percent: arguments.basic_perf_factor,
        rules: arguments.alert.clone(),
    };
    let events = match &arguments.events {
        Some(path) => events_of(path)?,
        None => Vec::new(),
    };
    let causes = arguments.diagnosis.as_deref().map(Causes::read).transpose()?;
    let before_learning =
        if arguments.quick { BeforeLearning::LeaveOut } else { BeforeLearning::Rebuild };
    let tails = stored::tails(&arguments.folder)?;
    let bar = progress.bar(tails.len(), "reading tails");
    // One tail at a time on each thread: memory does not grow with the fleet's segments.
    let read = tails
        .par_iter()
        .map(|path| {
            let found = monitor_tail(&arguments.folder, path, before_learning, &events, &options);
            bar.step();
            found
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    bar.finish();
    let mut documents = Vec::new();
    let mut alerts = Vec::new();
    for (tail, fired) in read.into_iter().flatten() {
        documents.push(tail);
        alerts.extend(fired);
    }
    documents.sort_by(|one, other| one.tail.cmp(&other.tail));
    alerts.sort_by(|one, other| one.tail.cmp(&other.tail));
    warn_of_events(&events, |tail| documents.iter().any(|known| known.tail == tail));
    if let Some(causes) = &causes {
        for alert in &mut alerts {
            alert.likely_causes = causes.of_tail(&alert.tail);
        }
    }
    let document = MonitorDocument::new(documents, alerts);
    let mut printed = text(&document, if arguments.month { Rows::Months } else { Rows::Tails });
    if let Some(folder) = &arguments.output {
        write(folder, &document, &options.in_words(events.len(), before_learning))?;
        let _ = writeln!(
            printed,
            "Written to {}: monitor.html, monitor.json, tables (.csv)",
            show(folder)
        );
    }
    let ending = if document.alerts.is_empty() { Ending::Done } else { Ending::Alerts };
    Ok(Outcome { ending, ..Outcome::with_json(printed, document.to_json()) })
}

fn write(folder: &Path, document: &MonitorDocument, options: &[String]) -> Result<(), Failure> {
    make_folder(folder)?;
    write_atomically(&folder.join("monitor.json"), &document.to_json())?;
    write_atomically(
        &folder.join("monitor.html"),
        neutral(&page::monitoring(document, options)).as_bytes(),
    )?;
    for table in tables(document) {
        columns::write(&table.columns, Some(&folder.join(format!("{}.csv", table.name))))?;
    }
    Ok(())
}

fn monitor_tail(
    folder: &Path,
    path: &Path,
    before_learning: BeforeLearning,
    events: &[Event],
    options: &MonitorOptions,
) -> Result<Option<(TailDocument, Vec<AlertDocument>)>, Failure> {
    let stored::StoredTail { tail, model, segments } = stored::read(folder, path)?;
    let deviations = TailDeviations::new(&model, &segments, before_learning)
        .map_err(|error| Failure::bad_file(path, error))?;
    drop(segments);
    let found = MonitoredTail::new(&tail, &deviations, events)
        .map_err(|error| Failure::bad_file(path, error))?;
    let Some(found) = found else {
        tracing::warn!(tail, "no segment is inside the table: there is nothing to monitor");
        return Ok(None);
    };
    Ok(Some((found.document(options), found.alerts(options))))
}
