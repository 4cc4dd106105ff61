//! What a person reads in a terminal, at most 80 columns wide but for long tails and kinds of events.

use core::fmt::Write;

use super::document::{Figure, MonitorDocument, TailDocument};
use crate::summary::{aligned, counted};

/// What the table has a row for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows {
    /// Each tail.
    Tails,
    /// Each month of each tail.
    Months,
}

/// The text for standard output.
#[must_use]
pub fn text(document: &MonitorDocument, rows: Rows) -> String {
    let mut text =
        "Fuel flow against the initial model, at each tail's mean conditions, %\n".to_owned();
    text.push_str(&match rows {
        Rows::Tails => tails(document),
        Rows::Months => months(document),
    });
    for fleet in document.fleet.iter().filter(|fleet| fleet.tails > 1) {
        let _ = writeln!(
            text,
            "Fleet {}: {}, mean {} %, std between tails {:.2} %,\n  trend {} %/year.",
            fleet.aircraft_type,
            counted(fleet.tails, "tail"),
            signed(&fleet.deviation_percent),
            fleet.between_tails_percent,
            signed(&fleet.trend_percent_per_year),
        );
    }
    for tail in &document.tails {
        append_changes(tail, &mut text);
    }
    for alert in &document.alerts {
        let causes = if alert.likely_causes.is_empty() {
            String::new()
        } else {
            format!("\n  likely: {}", alert.likely_causes.join(", "))
        };
        let _ = writeln!(
            text,
            "ALERT {}: {} {} since {} ({}){causes}",
            alert.tail,
            signed(&alert.size),
            alert.unit,
            date(&alert.since),
            alert.rule,
        );
    }
    text.push_str(LEGEND);
    text
}

const LEGEND: &str = "Positive: burns more than predicted; ± is half a 95 % interval.\n\
     DSR: deviation of specific range, negative is worse.\n\
     Factor: mean of three months' fuel factors, rounded up to 0.1 %.\n\
     A change has the 95 % interval of its date and the probability p of a change.\n";

fn tails(document: &MonitorDocument) -> String {
    let head = ["tail", "flights", "level", "trend/year", "DSR", "std", "factor", "kg/flight"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for tail in &document.tails {
        let airbus = &tail.airbus;
        rows.push(vec![
            tail.tail.clone(),
            tail.flights.len().to_string(),
            signed(&tail.deviation_percent),
            signed(&tail.trend_percent_per_year),
            plain(airbus.specific_range_deviation_percent, 2),
            airbus
                .specific_range_deviation_std_percent
                .map_or_else(|| "–".to_owned(), |std| format!("{std:.2}")),
            plain(airbus.retained_fuel_factor_percent, 1),
            plain(tail.cost.fuel_kg_per_flight, 0),
        ]);
    }
    let mut text = aligned(&rows);
    for tail in &document.tails {
        append_cost(tail, &mut text);
    }
    text
}

fn append_cost(tail: &TailDocument, text: &mut String) {
    let cost = &tail.cost;
    let figures: Vec<String> = [
        (cost.fuel_kg_per_year, "kg fuel"),
        (cost.co2_kg_per_year, "kg CO₂"),
        (cost.price_per_year, "in price"),
    ]
    .into_iter()
    .filter_map(|(value, unit)| value.map(|value| format!("{} {unit}", plain(value, 0))))
    .collect();
    // Fuel a year alone follows from the table; it is printed where it was asked for what follows from it.
    if figures.len() > 1 {
        let _ = writeln!(text, "{}: {} a year", tail.tail, figures.join(", "));
    }
}

fn months(document: &MonitorDocument) -> String {
    let head = ["tail", "month", "flights", "deviation", "before learning", "DSR", "factor"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for tail in &document.tails {
        for month in &tail.months {
            rows.push(vec![
                tail.tail.clone(),
                month.month.clone(),
                month.flights.to_string(),
                signed(&month.deviation_percent),
                month.before_learning_percent.as_ref().map_or_else(|| "–".to_owned(), signed),
                plain(month.specific_range_deviation_percent.value, 2),
                plain(month.retained_fuel_factor_percent, 1),
            ]);
        }
    }
    aligned(&rows)
}

fn append_changes(tail: &TailDocument, text: &mut String) {
    for change in &tail.changes {
        let engine = change.engine.map_or_else(String::new, |engine| format!(" engine {engine}"));
        let _ = writeln!(
            text,
            "{}{engine}: {} % on {} ({} to {}), p {:.2}",
            tail.tail,
            signed(&change.step_percent),
            date(&change.since),
            date(&change.since_ci95[0]),
            date(&change.since_ci95[1]),
            change.probability,
        );
        if let Some(kind) = &change.event {
            let _ = writeln!(text, "  with the recorded event: {kind}");
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

/// `+1.23 ± 0.20`.
fn signed(figure: &Figure) -> String {
    format!("{} ± {:.2}", plain(figure.value, 2), figure.half_width())
}

/// With its sign.
fn plain(value: f64, decimals: usize) -> String {
    format!("{value:+.decimals$}")
}

/// The day of an instant as it is written in a document.
fn date(time: &str) -> &str {
    time.get(..10).unwrap_or(time)
}
