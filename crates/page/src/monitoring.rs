//! `monitor.html`: months and fleets.

mod words;

use std::collections::BTreeSet;

use flight::Timestamp;
use maud::{Markup, html};
use pipeline::monitoring::{
    CostDocument, Figure, MonitorDocument, TailDocument, monitored_fuel_factor_percent,
};

use crate::chart::{Axis, Chart, Key, Mark, dates, legend, thinned};
use crate::frame::framed;
use crate::text::{signed, signed_tenths};
use pipeline::summary::counted;

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 320.0;
/// Points of one tail's chart, and of the whole page: about 1 MB.
const MOST_POINTS: usize = 2000;
const FEWEST_POINTS: usize = 200;
const POINTS_OF_PAGE: usize = 60_000;

/// The page of what `monitor` found; `options` says what the run was asked for.
pub fn monitoring(document: &MonitorDocument, options: &[String]) -> String {
    let order = document.by_news().into_iter();
    let tails: Vec<(usize, &TailDocument)> =
        order.map(|place| (place, &document.tails[place])).collect();
    let most = (POINTS_OF_PAGE / tails.len().max(1)).clamp(FEWEST_POINTS, MOST_POINTS);
    let body = html! {
        p.run { (head(document, options)) }
        p.note {
            "Deviations, levels, trends and steps in tables and charts: 100 ln(recorded/predicted) fuel flow by the book \
             (the rows of the guide), at each tail's mean conditions; positive, the aircraft burns more. Factors, and what is said in \
             sentences: per cent of what is predicted, 100 (recorded/predicted − 1), which is " (signed(Some(monitored_fuel_factor_percent(10.0)))) " at a \
             deviation of +10. ± is half a 95 % interval. DSR: deviation of specific range, negative is worse."
        }
        p.note {
            "Level, factor and kg/flight are of now, the last flight; the factor, to plan with, is that of the level, rounded up to \
             0.1 %. The report page of " code { "adapt" } " states the mean over all flights at the conditions flown, which is another \
             figure where a tail has changed or flies other routes. A trend is that between the events that " code { "--events" } " lists, \
             and net of what was washed or repaired without being listed."
        }
        p.note {
            "First the tails of which a rule fired, or which have changed in the last 90 days of these flights, then what burns most \
             over the mean of its type, each at the mean conditions of all tails of the type: what the model lacks at other Mach \
             numbers, masses and levels is no difference between aircraft. Where the change of one engine is that of all together, the engine's alone is told."
        }
        @if !document.alerts.is_empty() { (alerts(document)) }
        section {
            h2 { "Fleet" }
            (fleet(document))
            div.scroll { (table(&tails, document)) }
        }
        section {
            h2 { "Tails" }
            @for (place, (id, tail)) in tails.iter().enumerate() {
                details.tail id=(format!("tail-{id}")) open[place == 0] {
                    summary { h3 { (tail.tail) } span { "level " (figure(&tail.deviation_percent)) " %" } }
                    div {
                        (in_words(tail, document))
                        (chart(tail, *id, most)) (changes(tail)) (months(tail))
                    }
                }
            }
        }
    };
    framed("Months and fleets", &body)
}

fn head(document: &MonitorDocument, options: &[String]) -> String {
    let tails = &document.tails;
    let mut told = vec![format!("cruisefit {}", env!("CARGO_PKG_VERSION"))];
    if let Some((from, to)) = period(document) {
        told.push(format!("flown {from} to {to}"));
    }
    let types: BTreeSet<&str> = tails.iter().map(|tail| tail.aircraft_type.as_str()).collect();
    let types: Vec<&str> = types.into_iter().filter(|code| !code.is_empty()).collect();
    let flights: usize = tails.iter().map(|tail| tail.flights.len()).sum();
    let types = if types.is_empty() { String::new() } else { format!(" ({})", types.join(", ")) };
    told.push(format!("{}{types}", counted(tails.len(), "tail")));
    told.push(counted(flights, "flight"));
    told.extend(options.iter().cloned());
    format!("{}.", told.join("; "))
}

/// What the tail does, what to do about it, and by which model.
fn in_words(tail: &TailDocument, document: &MonitorDocument) -> Markup {
    html! {
        dl.verdict.gap[words::has_cause_to_find(tail, document)] {
            dt { "What" }
            dd {
                b { (words::found(tail)) }
                @if let Some(explained) = words::explained(tail) { " " (explained) }
                @if let Some(shared) = words::shared(tail, &document.fleet) { " " (shared) }
                @if let Some(compared) = words::compared(tail, document) { " " (compared) }
            }
            dt { "What to do" }
            dd { @for (k, advice) in words::advice(tail, document).iter().enumerate() { @if k > 0 { br; } (advice) } }
        }
        p.note { (tail.aircraft_type) ", " (tail.model) "." }
    }
}

fn period(document: &MonitorDocument) -> Option<(&str, &str)> {
    let from = document.tails.iter().map(|tail| tail.from.as_str()).min()?;
    let to = document.tails.iter().map(|tail| tail.to.as_str()).max()?;
    Some((day(from), day(to)))
}

fn figure(figure: &Figure) -> String {
    format!("{} ± {:.2}", signed(Some(figure.value)), figure.half_width())
}

/// The day of an instant as a document has it.
fn day(time: &str) -> &str {
    time.get(..10).unwrap_or(time)
}

fn alerts(document: &MonitorDocument) -> Markup {
    html! {
        section {
            h2 { "Alerts" }
            ul {
                @for alert in &document.alerts {
                    li {
                        b { (alert.tail) }
                        @if let Some(engine) = alert.engine { ", engine " (engine) }
                        ": " (figure(&alert.size)) " " (alert.unit) " since " (day(&alert.since))
                        " (" code { (alert.rule) } ")"
                        @if let Some(step) = &alert.step_in_gap {
                            ", or one step of " (figure(&step.step_percent)) " % between " (day(&step.after)) " and "
                            (day(&step.until)) ", when it did not fly"
                        }
                        @if !alert.likely_causes.is_empty() { "; likely " (words::likely(alert)) }
                        @else if let Some(reason) = &alert.no_likely_cause { "; no likely cause: " (reason) }
                    }
                }
            }
        }
    }
}

fn fleet(document: &MonitorDocument) -> Markup {
    html! {
        @for fleet in document.fleet.iter().filter(|fleet| fleet.tails > 1) {
            p {
                (fleet.aircraft_type) ": mean of " (counted(fleet.tails, "tail")) " "
                (figure(&fleet.deviation_percent)) " %, standard deviation between tails "
                (format!("{:.2}", fleet.between_tails_percent)) " %"
                @if let Some(trend) = &fleet.trend_percent_per_year { ", trend " (figure(trend)) " % a year" }
                "; at their mean conditions, " (fleet.reference.in_words()) "."
            }
        }
    }
}

/// A figure of a tail's cost, where there is one.
type OfCost = fn(&CostDocument) -> Option<f64>;

/// What fuel beyond the prediction amounts to in a year, by the present level.
const A_YEAR: [(&str, OfCost); 3] = [
    ("kg fuel/year now", |cost| cost.fuel_kg_per_year),
    ("kg CO₂/year now", |cost| cost.co2_kg_per_year),
    ("price/year now", |cost| cost.price_per_year),
];

fn table(tails: &[(usize, &TailDocument)], document: &MonitorDocument) -> Markup {
    let of_any = |of: OfCost| tails.iter().any(|(_, tail)| of(&tail.cost).is_some());
    // Fuel a year alone follows from that of a flight.
    let follows: Vec<_> = A_YEAR[1..].iter().filter(|(_, of)| of_any(*of)).collect();
    let a_year: Vec<_> =
        A_YEAR[..1].iter().filter(|_| !follows.is_empty()).chain(follows.clone()).collect();
    let several = document.has_several_types();
    let compared = tails.iter().any(|(_, tail)| document.against_type(tail).is_some());
    html! {
        table.fleet.sort.data data-name="monitor" {
            thead {
                tr {
                    th scope="col" { "tail" }
                    @if several { th scope="col" { "type" } }
                    th scope="col" { "flights" } th scope="col" { "level now, %" }
                    @if compared { th scope="col" { "against its type, %" } }
                    th scope="col" { "factor now, %" } th scope="col" { "kg/flight now" } th scope="col" { "DSR, all flights, %" }
                    @for (name, _) in &a_year { th scope="col" { (name) } }
                    th scope="col" { "trend, %/year" } th scope="col" { "last change" }
                }
            }
            tbody {
                @for (id, tail) in tails {
                    tr {
                        th scope="row" { a href=(format!("#tail-{id}")) { (tail.tail) } }
                        @if several { td { (tail.aircraft_type) } }
                        td data-v=(tail.flights.len()) { (tail.flights.len()) }
                        td data-v=(tail.deviation_percent.value) { (figure(&tail.deviation_percent)) }
                        @if compared {
                            @match document.against_type(tail) {
                                Some(against) => { td data-v=(against.value) { (figure(&against)) } }
                                None => { td { "–" } }
                            }
                        }
                        td data-v=(tail.airbus.fuel_factor_percent.value) { (signed_tenths(tail.airbus.entered_fuel_factor_percent())) }
                        td data-v=(tail.cost.fuel_kg_per_flight) { (signed_tenths(tail.cost.fuel_kg_per_flight)) }
                        td data-v=(tail.airbus.specific_range_deviation_percent) { (signed(Some(tail.airbus.specific_range_deviation_percent))) }
                        @for (_, of) in &a_year {
                            @match of(&tail.cost) {
                                Some(value) => { td data-v=(value) { (format!("{value:+.0}")) } }
                                None => { td { "–" } }
                            }
                        }
                        @match &tail.trend_percent_per_year {
                            Some(trend) => { td data-v=(trend.value) { (figure(trend)) } }
                            None => { td { "–" } }
                        }
                        td {
                            @match words::newest(tail.told_changes().into_iter()) {
                                Some(change) => {
                                    (day(&change.since)) ": "
                                    @if let Some(engine) = change.engine { "engine " (engine) " " }
                                    (signed(Some(change.step_percent.value))) " %"
                                }
                                None => "–",
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Deviations over time, the level through them, changes and events.
pub(crate) fn chart(tail: &TailDocument, id: usize, most: usize) -> Markup {
    let seconds = |time: &str| time.parse::<Timestamp>().ok().map(|time| time.as_second() as f64);
    let flights = &tail.flights;
    let points: Vec<(f64, f64)> = thinned(flights.len(), most)
        .into_iter()
        .filter_map(|k| Some((seconds(&flights[k].start)?, flights[k].deviation_percent.value)))
        .collect();
    let course: Vec<(f64, f64)> = flights
        .iter()
        .filter_map(|flight| Some((seconds(&flight.start)?, flight.level_percent.value)))
        .collect();
    let range = |of: fn(&(f64, f64)) -> f64, all: &[(f64, f64)]| {
        let low = all.iter().map(of).fold(f64::INFINITY, f64::min);
        (low, all.iter().map(of).fold(f64::NEG_INFINITY, f64::max))
    };
    let (first_s, last_s) = range(|point| point.0, &course);
    let (low, high) = range(|point| point.1, &points);
    let changes = tail.changes.iter().filter(|change| change.engine.is_none());
    let changes: Vec<f64> = changes.filter_map(|change| seconds(&change.since)).collect();
    let events: Vec<f64> = tail.events.iter().filter_map(|event| seconds(&event.time)).collect();
    let chart = Chart {
        id: format!("monitor-{id}"),
        title: format!("{}: deviation of fuel flow over time", tail.tail),
        description: format!(
            "{}, level {} % at the end, {}, {}.",
            counted(flights.len(), "flight"),
            figure(&tail.deviation_percent),
            counted(changes.len(), "change"),
            counted(events.len(), "event")
        ),
        width: WIDTH,
        height: HEIGHT,
        x: dates::axis(first_s, last_s, 10),
        y: Axis::around(low, high, 6),
        x_label: "date of the flight".to_owned(),
        y_label: "deviation, %".to_owned(),
    };
    let marks = html! {
        (chart.marks(&points, Mark::Dot, "observed"))
        @for at in &changes { (chart.vertical(*at, "initial")) }
        @for at in &events { (chart.vertical(*at, "mean")) }
        // A level ends where the next piece begins.
        @for piece in pieces(&course, &changes) { (chart.polyline(piece, "final")) }
    };
    html! {
        figure {
            (legend(&[
                (Key::Mark(Mark::Dot), "observed", "flight"),
                (Key::Line, "final", "level and trend"),
                (Key::Line, "initial", "change"),
                (Key::Line, "mean", "event"),
            ]))
            (chart.draw(&marks))
        }
    }
}

fn pieces<'a>(course: &'a [(f64, f64)], changes: &[f64]) -> Vec<&'a [(f64, f64)]> {
    let mut pieces = Vec::new();
    let mut rest = course;
    for change in changes {
        let (piece, later) = rest.split_at(rest.partition_point(|point| point.0 < *change));
        pieces.push(piece);
        rest = later;
    }
    pieces.push(rest);
    pieces
}

fn changes(tail: &TailDocument) -> Markup {
    html! {
        @if tail.flights_without_segments > 0 {
            p.note {
                (counted(tail.flights_without_segments, "learnt flight")) " beside these: no segment inside the table."
            }
        }
        @if tail.flights_without_engines > 0 {
            p.note {
                (tail.flights_without_engines) " of " (counted(tail.flights.len(), "flight"))
                " without fuel flow of each engine: in the series of no engine."
            }
        }
        @if !tail.changes.is_empty() || !tail.events.is_empty() {
            ul {
                @for change in &tail.changes {
                    li {
                        @if let Some(engine) = change.engine { "Engine " (engine) ": " }
                        (figure(&change.step_percent)) " % since " (day(&change.since)) " (95 % interval "
                        (day(&change.since_ci95[0])) " to " (day(&change.since_ci95[1])) "), probability "
                        (format!("{:.2}", change.probability))
                        @if let Some(event) = change.event_in_words() { ", " (event) }
                    }
                }
                @for event in &tail.events {
                    li {
                        (event.kind) " " (day(&event.time)) ": "
                        @match &event.effect_percent {
                            Some(effect) => { (figure(effect)) " %" }
                            None => "no flight before, or none after",
                        }
                        @if !event.together_with.is_empty() { ", together with " (event.together_with.join(", ")) }
                        @if !event.note.is_empty() { " (" (event.note) ")" }
                    }
                }
            }
        }
    }
}

fn months(tail: &TailDocument) -> Markup {
    html! {
        div.scroll {
            table.small.data data-name="months" {
                thead {
                    tr {
                        th scope="col" { "month" } th scope="col" { "flights" } th scope="col" { "deviation, %" }
                        th scope="col" { "before learning, %" } th scope="col" { "DSR, %" } th scope="col" { "fuel factor, %" }
                        th scope="col" { "mean of 3 months, rounded up, %" }
                    }
                }
                tbody {
                    @for month in &tail.months {
                        tr {
                            th scope="row" { (month.month) }
                            td { (month.flights) }
                            td { (figure(&month.deviation_percent)) }
                            td { (month.before_learning_percent.as_ref().map_or_else(|| "–".to_owned(), figure)) }
                            td { (figure(&month.specific_range_deviation_percent)) }
                            td { (figure(&month.monitored_fuel_factor_percent)) }
                            td { (signed_tenths(month.retained_fuel_factor_percent)) }
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_ends_at_a_change() {
        let course = [(0.0, 1.0), (1.0, 1.0), (2.0, 3.0), (3.0, 3.0)];
        assert_eq!(pieces(&course, &[2.0]), [&course[..2], &course[2..]]);
        assert_eq!(pieces(&course, &[]), [&course[..]]);
    }

    #[test]
    fn a_page_without_tails_is_a_page() {
        let page = monitoring(&MonitorDocument::new(Vec::new(), Vec::new()), &[]);
        assert!(page.contains("<h1>Months and fleets</h1>") && !page.contains("NaN"), "{page}");
    }
}
