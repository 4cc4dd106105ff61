//! `cruisefit segment`: stabilised segments, no model needed.

use std::fmt::Write;

use segmenter::{Criterion, Tally};

use crate::args::SegmentArgs;
use crate::columns;
use crate::commands::{Outcome, check_refused, prepare};
use crate::failure::{Failure, show};
use crate::files::outputs::check_not_read;
use crate::progress::Progress;
use crate::reading::FlightRead;
use crate::terminal;
use pipeline::not_evaluated;
use pipeline::segments_table::{self, SegmentRow};
use pipeline::summary::{NO_SEGMENT, aligned, counted, other_files_words};

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &SegmentArgs, progress: Progress) -> Result<Outcome, Failure> {
    for read in &arguments.reports.reports {
        check_not_read(arguments.output.as_deref(), read)?;
    }
    let mut reading = prepare(&arguments.reports, progress)?;
    let files = reading.files();
    let nothing_left = reading.flights.is_empty();
    check_refused(&reading.refused, files, arguments.reports.strict, nothing_left)?;
    // Sorted by the order of flying, whatever the names of the files.
    reading.flights.sort_by(FlightRead::order);
    let explained = if arguments.explain {
        explain(&reading.flights) + &loosened(arguments, &reading.flights, progress)?
    } else {
        String::new()
    };
    let (flights, other_files) = (reading.flights.len(), reading.other_files);
    // The explanation has it in its table.
    let not_evaluated = if arguments.explain {
        String::new()
    } else {
        not_evaluated::line(&not_evaluated::of_tally(&tally_of(&reading.flights)), flights)
    };
    let rows: Vec<SegmentRow> = reading
        .flights
        .into_iter()
        .flat_map(|flight| flight.reduced.segments)
        .map(|segment| SegmentRow { segment, evaluated: None })
        .collect();
    let table = segments_table::table(&rows, segments_table::engines_of(&rows));
    let mut text = String::new();
    let json = arguments.json.json.then(|| table.to_json());
    if let Some(path) = &arguments.output {
        columns::write(&table, Some(path))?;
        text.push_str(&explained);
        let _ = writeln!(
            text,
            "{} of {} written to {}{}",
            counted(rows.len(), "segment"),
            counted(flights, "flight"),
            show(path),
            other_files_words(other_files)
        );
        text.push_str(&not_evaluated);
        if rows.is_empty() {
            text.push_str(NO_SEGMENT);
        }
    } else {
        // Standard output carries the table, so the explanation goes to standard error.
        terminal::tell(&explained);
        if !not_evaluated.is_empty() {
            terminal::tell(&not_evaluated);
        }
        if json.is_none() {
            columns::write(&table, None)?;
        }
    }
    Ok(Outcome { refused: reading.refused, json, ..Outcome::text(text) })
}

/// The limit that is tried for the criterion that costs most, times its own.
const LOOSER: f64 = 2.0;
/// More flights than this are not listed: what is told of all has to fit on a screen.
const LISTED_FLIGHTS: usize = 12;

fn tally_of(flights: &[FlightRead]) -> Tally {
    flights.iter().fold(Tally::NOTHING, |mut total, flight| {
        total += flight.reduced.tally;
        total
    })
}

/// The criterion that alone costs the most samples, and what other limits of it would give.
fn loosened(
    arguments: &SegmentArgs,
    flights: &[FlightRead],
    progress: Progress,
) -> Result<String, Failure> {
    let total = tally_of(flights);
    let costliest = Criterion::ALL.into_iter().max_by_key(|criterion| {
        (total.cost(*criterion).unsteady_alone, usize::MAX - *criterion as usize)
    });
    let Some(criterion) = costliest.filter(|one| total.cost(*one).unsteady_alone > 0) else {
        return Ok(String::new());
    };
    let mut reports = arguments.reports.clone();
    let limits = &mut reports.criteria.limits;
    let limit = limits.limit(criterion);
    *limits = limits.with_limit(criterion, LOOSER * limit);
    let looser = tally_of(&prepare(&reports, progress)?.flights);
    let unit = criterion.unit();
    if (looser.segments, looser.samples_kept) == (total.segments, total.samples_kept) {
        return Ok(format!(
            "{criterion} costs most: {} fail it alone; {} {unit} in place of {limit} {unit} would give no more.\n\n",
            counted(total.cost(criterion).unsteady_alone, "sample"),
            LOOSER * limit,
        ));
    }
    Ok(format!(
        "{criterion} costs most: {} fail it alone. {} {unit} in place of {limit} {unit} would give {} with {} of {} samples\n(now {} with {}); a looser limit lets less steady flight into the means.\n\n",
        counted(total.cost(criterion).unsteady_alone, "sample"),
        LOOSER * limit,
        counted(looser.segments, "segment"),
        looser.samples_kept,
        looser.samples,
        total.segments,
        total.samples_kept,
    ))
}

/// What each criterion cost: one line for each of a few flights, then all flights together.
fn explain(flights: &[FlightRead]) -> String {
    let mut text = String::new();
    let total = tally_of(flights);
    let listed = if flights.len() > LISTED_FLIGHTS { &[] } else { flights };
    for flight in listed {
        let _ = writeln!(
            text,
            "{} {}: {}",
            flight.reduced.identity.tail, flight.reduced.identity.flight, flight.reduced.tally
        );
        for note in &flight.reduced.notes {
            let _ = writeln!(text, "    {note}");
        }
    }
    let _ = writeln!(text, "\nAll: {total}\n");
    let head =
        ["criterion", "unsteady", "unsteady alone", "outliers", "outliers alone", "not evaluated"];
    let mut rows: Vec<Vec<String>> = vec![head.into_iter().map(str::to_owned).collect()];
    for criterion in Criterion::ALL {
        let cost = total.cost(criterion);
        let not_evaluated = total.flights - cost.flights_evaluated;
        rows.push(vec![
            criterion.name().to_owned(),
            cost.unsteady.to_string(),
            cost.unsteady_alone.to_string(),
            cost.outliers.to_string(),
            cost.outliers_alone.to_string(),
            match not_evaluated {
                0 => String::new(),
                1 => "1 flight".to_owned(),
                n => format!("{n} flights"),
            },
        ]);
    }
    text.push_str(&aligned(&rows));
    text.push_str(
        "Samples that fail a criterion (alone: and no other), and that the two-sigma filter discards in its channel.\n\n",
    );
    text
}
