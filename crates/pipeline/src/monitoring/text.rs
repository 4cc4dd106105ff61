//! What a person reads in a terminal, at most 80 columns wide but for long tails and kinds of events.

use core::fmt::Write;

use super::document::{Figure, MonitorDocument, StepInGapDocument, TailDocument};
use crate::summary::{aligned, counted};

/// What the table has a row for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows {
    /// Each tail.
    Tails,
    /// Each month of each tail.
    Months,
}

/// The text for standard output; nothing where no tail has shown anything, which is told tail by tail.
#[must_use]
pub fn text(document: &MonitorDocument, rows: Rows) -> String {
    if document.tails.is_empty() {
        return String::new();
    }
    let mut text =
        "Deviation of fuel flow from the book, 100 ln(recorded/predicted), %\n".to_owned();
    text.push_str(&match rows {
        Rows::Tails => tails(document),
        Rows::Months => months(document),
    });
    for tail in &document.tails {
        append_performance_factor(tail, &mut text);
        append_cost(tail, &mut text);
    }
    for fleet in document.fleet.iter().filter(|fleet| fleet.tails > 1) {
        let _ = writeln!(
            text,
            "Fleet {}: {}, mean {} %, std between tails {:.2} %,\n  trend {} %/year; at {}.",
            fleet.aircraft_type,
            counted(fleet.tails, "tail"),
            signed(&fleet.deviation_percent),
            fleet.between_tails_percent,
            or_dash(fleet.trend_percent_per_year.as_ref()),
            fleet.reference.in_words(),
        );
    }
    for tail in &document.tails {
        append_changes(tail, &mut text);
    }
    for alert in &document.alerts {
        let causes = match &alert.no_likely_cause {
            _ if !alert.likely_causes.is_empty() => {
                format!("\n  likely: {}", alert.likely_causes.join(", "))
            }
            Some(reason) => format!("\n  no likely cause: {reason}"),
            None => String::new(),
        };
        let _ = writeln!(
            text,
            "ALERT {}{}: {} {} since {} ({}){}{causes}",
            alert.tail,
            of_engine(alert.engine),
            signed(&alert.size),
            alert.unit,
            date(&alert.since),
            alert.rule,
            alert.step_in_gap.as_ref().map_or_else(String::new, or_step),
        );
    }
    text.push_str(SIGNS);
    text.push_str(match rows {
        Rows::Tails => {
            "now: at the last flight. all: mean and standard deviation of all flights.\n\
             Factor: of the level, to plan with, per cent of predicted, rounded up to 0.1.\n\
             Trend: beside the events that --events lists; it is net of other washes.\n"
        }
        Rows::Months => "Factor: mean of three months' fuel factors, rounded up to 0.1 %.\n",
    });
    if document.fleet.iter().any(|fleet| fleet.tails > 1) {
        text.push_str(
            "A fleet's levels, and the order of its tails (after what is new): at the\n\
             mean conditions of its tails, counted alike.\n",
        );
    }
    text.push_str(
        "A change has the 95 % interval of its date and the probability p of a change.\n",
    );
    text
}

const SIGNS: &str = "At each tail's mean conditions; positive: burns more than predicted;\n\
     ± is half a 95 % interval. DSR: deviation of specific range, negative is worse.\n";

fn tails(document: &MonitorDocument) -> String {
    // What is of the last flight comes first, then what is of all of them.
    let mut head = vec!["tail"];
    head.extend(document.has_several_types().then_some("type"));
    head.extend(["flights", "now: level", "factor", "kg/flight", "all: DSR", "std", "trend/year"]);
    let mut rows = vec![head.into_iter().map(str::to_owned).collect()];
    for tail in document.by_news().into_iter().map(|place| &document.tails[place]) {
        let airbus = &tail.airbus;
        let mut row = vec![tail.tail.clone()];
        row.extend(document.has_several_types().then(|| tail.aircraft_type.clone()));
        row.extend([
            tail.flights.len().to_string(),
            signed(&tail.deviation_percent),
            plain(airbus.entered_fuel_factor_percent(), 1),
            plain(tail.cost.fuel_kg_per_flight, 0),
            plain(airbus.specific_range_deviation_percent, 2),
            airbus
                .specific_range_deviation_std_percent
                .map_or_else(|| "–".to_owned(), |std| format!("{std:.2}")),
            or_dash(tail.trend_percent_per_year.as_ref()),
        ]);
        rows.push(row);
    }
    aligned(&rows)
}

/// Where the basic factor is given.
fn append_performance_factor(tail: &TailDocument, text: &mut String) {
    let Some(percent) = tail.airbus.performance_factor_percent else { return };
    let factor = tail.airbus.entered_fuel_factor_percent();
    let _ = writeln!(
        text,
        "{}: PERF FACTOR {} %, basic {} and factor {}",
        tail.tail,
        plain(percent, 1),
        plain(percent - factor, 1),
        plain(factor, 1)
    );
}

fn append_cost(tail: &TailDocument, text: &mut String) {
    let cost = &tail.cost;
    let figures: Vec<String> =
        [(cost.fuel_kg_per_year, "kg fuel"), (cost.co2_kg_per_year, "kg CO₂")]
            .into_iter()
            .filter_map(|(value, unit)| value.map(|value| format!("{} {unit}", plain(value, 0))))
            .collect();
    // The currency is that of the price asked with.
    let price = cost
        .price_per_year
        .map_or_else(String::new, |price| format!(" at a cost of {}", plain(price, 0)));
    // Fuel a year alone follows from the table; it is printed where it was asked for what follows from it.
    if figures.len() > 1 || !price.is_empty() {
        let _ = writeln!(
            text,
            "{}: {} a year{price}, by the present level",
            tail.tail,
            figures.join(" and ")
        );
    }
}

fn months(document: &MonitorDocument) -> String {
    let head =
        ["tail", "month", "flights", "deviation", "before learning", "DSR", "3-month factor"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for tail in &document.tails {
        for month in &tail.months {
            rows.push(vec![
                tail.tail.clone(),
                month.month.clone(),
                month.flights.to_string(),
                signed(&month.deviation_percent),
                or_dash(month.before_learning_percent.as_ref()),
                plain(month.specific_range_deviation_percent.value, 2),
                plain(month.retained_fuel_factor_percent, 1),
            ]);
        }
    }
    aligned(&rows)
}

fn append_changes(tail: &TailDocument, text: &mut String) {
    if tail.flights_without_segments > 0 {
        let _ = writeln!(
            text,
            "{}: {} beside these, no segment inside the table",
            tail.tail,
            counted(tail.flights_without_segments, "learnt flight")
        );
    }
    if tail.flights_without_engines > 0 {
        let _ = writeln!(
            text,
            "{}: {} of {} without fuel flow of each engine:\n  they are in the series of no engine",
            tail.tail,
            tail.flights_without_engines,
            counted(tail.flights.len(), "flight"),
        );
    }
    if let Some(step) = &tail.step_in_gap {
        let trend = or_dash(tail.trend_percent_per_year.as_ref());
        let _ = writeln!(text, "{}: trend {trend} %/year{}", tail.tail, or_step(step));
    }
    for change in &tail.changes {
        let _ = writeln!(
            text,
            "{}{}: {} % on {} ({} to {}), p {:.2}",
            tail.tail,
            of_engine(change.engine),
            signed(&change.step_percent),
            date(&change.since),
            date(&change.since_ci95[0]),
            date(&change.since_ci95[1]),
            change.probability,
        );
        if let Some(event) = change.event_in_words() {
            let _ = writeln!(text, "  with the recorded event: {event}");
        }
    }
    for event in &tail.events {
        let effect = event.effect_percent.as_ref().map_or_else(
            || "no flight before, or none after".to_owned(),
            |effect| format!("{} %", signed(effect)),
        );
        let together = if event.together_with.is_empty() {
            String::new()
        } else {
            format!(", together with {}", event.together_with.join(", "))
        };
        let _ = writeln!(
            text,
            "{}: {} {}: {effect}{together}",
            tail.tail,
            event.kind,
            date(&event.time)
        );
    }
}

/// What a trend may be in place of, on a line of its own.
fn or_step(step: &StepInGapDocument) -> String {
    format!(
        ",\n  or one step of {} % between {} and {}",
        signed(&step.step_percent),
        date(&step.after),
        date(&step.until),
    )
}

fn of_engine(engine: Option<usize>) -> String {
    engine.map_or_else(String::new, |engine| format!(" engine {engine}"))
}

/// `+1.23 ± 0.20`.
fn signed(figure: &Figure) -> String {
    format!("{} ± {:.2}", plain(figure.value, 2), figure.half_width())
}

/// The same, or a dash.
fn or_dash(figure: Option<&Figure>) -> String {
    figure.map_or_else(|| "–".to_owned(), signed)
}

/// With its sign.
fn plain(value: f64, decimals: usize) -> String {
    format!("{value:+.decimals$}")
}

/// The day of an instant as it is written in a document.
fn date(time: &str) -> &str {
    time.get(..10).unwrap_or(time)
}
