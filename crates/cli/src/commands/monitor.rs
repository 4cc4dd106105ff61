//! `cruisefit monitor`: what changed, when and by how much, on the tails that a folder of `adapt` holds.

mod causes;
mod stored;

use std::fmt::Write as _;
use std::io::{BufWriter, Write as _};
use std::path::Path;

use monitor::cost::CostFactors;
use pipeline::monitoring::{
    BeforeLearning, Event, FLIGHTS, MonitorDocument, MonitorOptions, Monitored, Rows,
    flights_by_tail, monitor_tail, tables_but_flights, text, warn_of_events,
};
use rayon::prelude::*;

use crate::args::MonitorArgs;
use crate::columns;
use crate::commands::{Ending, Outcome, check_refused, events_of};
use crate::failure::{Failure, RefusedReport, refused_of, show};
use crate::files::{make_folder, write_atomically, write_streamed};
use crate::progress::Progress;
use crate::terminal::neutral;

use causes::Causes;
use stored::Tails;

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
        before_learning: BeforeLearning::left_out(arguments.quick),
        since: arguments.since,
    };
    let options = options.checked().map_err(|error| Failure::BadArgument {
        argument: error.quantity,
        reason: format!("found {}, expected {}", error.value, error.expected),
    })?;
    let events = match &arguments.events {
        Some(path) => events_of(path)?,
        None => Vec::new(),
    };
    let causes = arguments.diagnosis.as_deref().map(Causes::read).transpose()?;
    let (read, refused) = loop {
        let tails = Tails::of(&arguments.folder)?;
        let found = monitor_all(&tails, &events, &options, progress)?;
        // Otherwise another process stored a newer generation in the meantime.
        if found.1.is_empty() || !tails.is_out_of_date() {
            break found;
        }
    };
    // Nothing to monitor in a window is no damage.
    let nothing_left = read.is_empty() && !refused.is_empty();
    check_refused(&refused, read.len() + refused.len(), false, nothing_left)?;
    let mut documents = Vec::with_capacity(read.len());
    let mut alerts = Vec::new();
    for (tail, flown, fired) in read {
        documents.push((tail, flown));
        alerts.extend(fired);
    }
    documents.sort_by(|(one, _), (other, _)| one.tail.cmp(&other.tail));
    alerts.sort_by(|one, other| one.tail.cmp(&other.tail));
    warn_of_events(&events, |tail| documents.iter().any(|(known, _)| known.tail == tail));
    if let Some(causes) = &causes {
        for alert in &mut alerts {
            causes.explain(alert);
        }
    }
    let document = MonitorDocument::compared(documents, alerts);
    let mut printed = text(&document, if arguments.month { Rows::Months } else { Rows::Tails });
    if let Some(folder) = &arguments.output {
        write(folder, &document, &options.in_words(events.len()))?;
        let _ = writeln!(
            printed,
            "Written to {}: monitor.html, monitor.json, tables (.csv)",
            show(folder)
        );
    }
    let ending = if document.alerts.is_empty() { Ending::Done } else { Ending::Alerts };
    // Of a large fleet the document is hundreds of megabytes.
    let json = arguments.json.json.then(|| document.to_json());
    Ok(Outcome { refused, json, ending, ..Outcome::text(printed) })
}

fn write(folder: &Path, document: &MonitorDocument, options: &[String]) -> Result<(), Failure> {
    make_folder(folder)?;
    let file_of = |name: &str| folder.join(format!("{name}.csv"));
    let tables = tables_but_flights(document);
    for table in &tables {
        columns::check(&table.columns, &file_of(table.name))?;
    }
    write_streamed(&folder.join("monitor.json"), |to| {
        let mut to = BufWriter::new(to);
        document.write_json(&mut to)?;
        to.flush()
    })?;
    write_atomically(
        &folder.join("monitor.html"),
        neutral(&page::monitoring(document, options)).as_bytes(),
    )?;
    for table in tables {
        columns::write(&table.columns, Some(&file_of(table.name)))?;
    }
    write_streamed(&file_of(FLIGHTS), |to| {
        for (place, table) in flights_by_tail(document).enumerate() {
            to.write_all(&if place == 0 { table.to_csv() } else { table.to_csv_rows() })?;
        }
        Ok(())
    })
}

/// Every tail that has something to monitor, and those that are damaged: a tail costs itself, not the fleet.
fn monitor_all(
    tails: &Tails,
    events: &[Event],
    options: &MonitorOptions,
    progress: Progress,
) -> Result<(Vec<Monitored>, Vec<RefusedReport>), Failure> {
    let places = tails.places()?;
    let bar = progress.bar(places.len(), "reading tails");
    // One tail at a time on each thread: memory does not grow with the fleet's segments.
    let read: Vec<Result<Option<Monitored>, RefusedReport>> = places
        .par_iter()
        .map(|place| {
            let found = tails.deviations(place, options).and_then(|(tail, deviations)| {
                monitor_tail(&tail, &deviations, events, options)
                    .map_err(|error| Failure::bad_file(tails.folder(), error))
            });
            bar.step();
            found.map_err(|failure| {
                refused_of(failure, &format!("{} is not monitored", place.told()))
            })
        })
        .collect();
    bar.finish();
    let (mut found, mut refused) = (Vec::new(), Vec::new());
    for one in read {
        match one {
            Ok(tail) => found.extend(tail),
            Err(damaged) => refused.push(damaged),
        }
    }
    Ok((found, refused))
}
