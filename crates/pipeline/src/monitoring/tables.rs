//! Every result as tables of columns: one row per flight, month, change, event, tail, month of a fleet, alert.

use super::document::{Figure, MonitorDocument, StepInGapDocument, TailDocument};
use crate::columns::Columns;

/// A table and the name of its file, without ending.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedTable {
    /// Name.
    pub name: &'static str,
    /// Columns.
    pub columns: Columns,
}

/// Name of the table of flights.
pub const FLIGHTS: &str = "flights";

/// All tables of a run.
#[must_use]
pub fn tables(document: &MonitorDocument) -> Vec<NamedTable> {
    let mut tables = tables_but_flights(document);
    let columns = flights(&document.tails, engines_of(document));
    tables.insert(2, NamedTable { name: FLIGHTS, columns });
    tables
}

/// The table of flights tail by tail, with the same columns throughout, after one that has no row: of a large fleet it is half a
/// million rows.
pub fn flights_by_tail(document: &MonitorDocument) -> impl Iterator<Item = Columns> {
    let engines = engines_of(document);
    let parts = std::iter::once(&[][..]).chain(document.tails.chunks(1));
    parts.map(move |tails| flights(tails, engines))
}

/// All tables but that of flights.
#[must_use]
pub fn tables_but_flights(document: &MonitorDocument) -> Vec<NamedTable> {
    [
        ("tails", tails(document)),
        ("months", months(document)),
        ("changes", changes(document)),
        ("events", events(document)),
        ("fleet", fleet(document)),
        ("alerts", alerts(document)),
    ]
    .into_iter()
    .map(|(name, columns)| NamedTable { name, columns })
    .collect()
}

/// Adds a value and the ends of its interval.
fn figure<'a, R: 'a>(
    columns: &mut Columns,
    name: &str,
    rows: &'a [R],
    of: impl Fn(&'a R) -> Option<Figure>,
) {
    columns.number(name, rows.iter().map(|row| of(row).map(|figure| figure.value)));
    for (end, place) in [("low", 0), ("high", 1)] {
        let ends = rows.iter().map(|row| of(row).map(|figure| figure.ci95[place]));
        columns.number(format!("{name}_ci95_{end}"), ends);
    }
}

/// Adds the step that a trend may be in place of, and between which flights it is.
fn step_in_gap<'a, R: 'a>(
    columns: &mut Columns,
    rows: &'a [R],
    of: impl Fn(&'a R) -> Option<&'a StepInGapDocument> + Copy,
) {
    let flight = |which: fn(&StepInGapDocument) -> &String| {
        rows.iter().map(move |row| of(row).map(which).cloned().unwrap_or_default())
    };
    columns.text("step_in_gap_after", flight(|step| &step.after));
    columns.text("step_in_gap_until", flight(|step| &step.until));
    figure(columns, "step_in_gap_percent", rows, |row| of(row).map(|step| step.step_percent));
}

fn rows_of<'a, T>(
    tails: &'a [TailDocument],
    of: impl Fn(&'a TailDocument) -> &'a [T],
) -> Vec<(&'a str, &'a T)> {
    tails.iter().flat_map(|tail| of(tail).iter().map(|row| (tail.tail.as_str(), row))).collect()
}

fn tails(document: &MonitorDocument) -> Columns {
    let rows = &document.tails;
    let mut columns = Columns::default();
    columns.text("tail", rows.iter().map(|tail| tail.tail.clone()));
    columns.text("aircraft_type", rows.iter().map(|tail| tail.aircraft_type.clone()));
    columns.count("flights", rows.iter().map(|tail| tail.flights.len() as u64));
    columns.count(
        "flights_without_engines",
        rows.iter().map(|tail| tail.flights_without_engines as u64),
    );
    columns.count(
        "flights_without_segments",
        rows.iter().map(|tail| tail.flights_without_segments as u64),
    );
    columns.text("from", rows.iter().map(|tail| tail.from.clone()));
    columns.text("to", rows.iter().map(|tail| tail.to.clone()));
    figure(&mut columns, "deviation_percent", rows, |tail| Some(tail.deviation_percent));
    figure(&mut columns, "at_type_conditions_percent", rows, |tail| {
        tail.at_type_conditions_percent
    });
    figure(&mut columns, "trend_percent_per_year", rows, |tail| tail.trend_percent_per_year);
    step_in_gap(&mut columns, rows, |tail| tail.step_in_gap.as_ref());
    figure(&mut columns, "before_learning_percent", rows, |tail| tail.before_learning_percent);
    let number = |of: fn(&TailDocument) -> Option<f64>| rows.iter().map(of);
    columns.number("within_flight_percent", number(|t| Some(t.within_flight_percent)));
    columns.number("between_flights_percent", number(|t| Some(t.between_flights_percent)));
    columns.number("correlation", number(|t| Some(t.correlation)));
    columns.number(
        "specific_range_deviation_percent",
        number(|t| Some(t.airbus.specific_range_deviation_percent)),
    );
    columns.number(
        "specific_range_deviation_std_percent",
        number(|t| t.airbus.specific_range_deviation_std_percent),
    );
    figure(&mut columns, "fuel_factor_percent", rows, |tail| Some(tail.airbus.fuel_factor_percent));
    columns.number(
        "monitored_fuel_factor_percent",
        number(|t| Some(t.airbus.monitored_fuel_factor_percent.value)),
    );
    columns.number(
        "retained_fuel_factor_percent",
        number(|t| Some(t.airbus.retained_fuel_factor_percent)),
    );
    columns.number("performance_factor_percent", number(|t| t.airbus.performance_factor_percent));
    columns.number("flights_per_year", number(|t| t.cost.flights_per_year));
    columns.number("excess_fuel_kg_per_flight", number(|t| Some(t.cost.fuel_kg_per_flight)));
    columns.number("excess_fuel_kg_per_year", number(|t| t.cost.fuel_kg_per_year));
    columns.number("excess_co2_kg_per_year", number(|t| t.cost.co2_kg_per_year));
    columns.number("excess_price_per_year", number(|t| t.cost.price_per_year));
    columns
        .number("reference_pressure_altitude_m", number(|t| Some(t.reference.pressure_altitude_m)));
    columns.number("reference_mach", number(|t| Some(t.reference.mach)));
    columns.number(
        "reference_static_air_temperature_k",
        number(|t| Some(t.reference.static_air_temperature_k)),
    );
    columns.number("reference_mass_kg", number(|t| Some(t.reference.mass_kg)));
    columns
}

fn months(document: &MonitorDocument) -> Columns {
    let rows = rows_of(&document.tails, |tail| &tail.months);
    let mut columns = Columns::default();
    columns.text("tail", rows.iter().map(|(tail, _)| (*tail).to_owned()));
    columns.text("month", rows.iter().map(|(_, month)| month.month.clone()));
    columns.count("flights", rows.iter().map(|(_, month)| month.flights as u64));
    columns.count("segments", rows.iter().map(|(_, month)| month.segments));
    figure(&mut columns, "deviation_percent", &rows, |(_, m)| Some(m.deviation_percent));
    figure(&mut columns, "before_learning_percent", &rows, |(_, m)| m.before_learning_percent);
    figure(&mut columns, "fuel_flow_kg_s", &rows, |(_, m)| Some(m.fuel_flow_kg_s));
    figure(&mut columns, "specific_range_m_kg", &rows, |(_, m)| Some(m.specific_range_m_kg));
    figure(&mut columns, "specific_range_deviation_percent", &rows, |(_, m)| {
        Some(m.specific_range_deviation_percent)
    });
    figure(&mut columns, "monitored_fuel_factor_percent", &rows, |(_, m)| {
        Some(m.monitored_fuel_factor_percent)
    });
    columns.number(
        "retained_fuel_factor_percent",
        rows.iter().map(|(_, month)| Some(month.retained_fuel_factor_percent)),
    );
    let engines = rows.iter().map(|(_, month)| month.engines_percent.len()).max().unwrap_or(0);
    for engine in 0..engines {
        let name = format!("engine_{}_percent", engine + 1);
        figure(&mut columns, &name, &rows, |(_, m)| m.engines_percent.get(engine).copied());
    }
    columns
}

/// The largest number of engines that a flight of the document has recorded apart.
fn engines_of(document: &MonitorDocument) -> usize {
    let flights = document.tails.iter().flat_map(|tail| &tail.flights);
    flights.map(|flight| flight.engines_percent.len()).max().unwrap_or(0)
}

fn flights(tails: &[TailDocument], engines: usize) -> Columns {
    let rows = rows_of(tails, |tail| &tail.flights);
    let mut columns = Columns::default();
    columns.text("tail", rows.iter().map(|(tail, _)| (*tail).to_owned()));
    columns.text("flight", rows.iter().map(|(_, flight)| flight.flight.clone()));
    columns.text("start", rows.iter().map(|(_, flight)| flight.start.clone()));
    columns.count("segments", rows.iter().map(|(_, flight)| flight.segments as u64));
    columns.count("outside_table", rows.iter().map(|(_, flight)| flight.outside_table as u64));
    figure(&mut columns, "deviation_percent", &rows, |(_, f)| Some(f.deviation_percent));
    columns.number(
        "initial_deviation_percent",
        rows.iter().map(|(_, flight)| Some(flight.initial_deviation_percent)),
    );
    columns.number(
        "before_learning_percent",
        rows.iter().map(|(_, flight)| flight.before_learning_percent),
    );
    figure(&mut columns, "level_percent", &rows, |(_, f)| Some(f.level_percent));
    columns.number("fuel_flow_kg_s", rows.iter().map(|(_, f)| Some(f.fuel_flow_kg_s)));
    columns.number("specific_range_m_kg", rows.iter().map(|(_, f)| Some(f.specific_range_m_kg)));
    columns.number(
        "specific_range_deviation_percent",
        rows.iter().map(|(_, f)| Some(f.specific_range_deviation_percent)),
    );
    for engine in 0..engines {
        columns.number(
            format!("engine_{}_percent", engine + 1),
            rows.iter().map(|(_, flight)| flight.engines_percent.get(engine).copied()),
        );
    }
    columns.number("excess_fuel_kg", rows.iter().map(|(_, f)| Some(f.excess_fuel_kg)));
    columns
}

fn changes(document: &MonitorDocument) -> Columns {
    let rows = rows_of(&document.tails, |tail| &tail.changes);
    let mut columns = Columns::default();
    columns.text("tail", rows.iter().map(|(tail, _)| (*tail).to_owned()));
    columns.text("engine", rows.iter().map(|(_, change)| engine_name(change.engine)));
    columns.text("since", rows.iter().map(|(_, change)| change.since.clone()));
    columns.text("since_ci95_low", rows.iter().map(|(_, change)| change.since_ci95[0].clone()));
    columns.text("since_ci95_high", rows.iter().map(|(_, change)| change.since_ci95[1].clone()));
    columns.number("probability", rows.iter().map(|(_, change)| Some(change.probability)));
    figure(&mut columns, "step_percent", &rows, |(_, change)| Some(change.step_percent));
    columns.text("event", rows.iter().map(|(_, change)| change.event.clone().unwrap_or_default()));
    columns.text("other_events", rows.iter().map(|(_, change)| change.other_events.join(" ")));
    columns
}

fn events(document: &MonitorDocument) -> Columns {
    let rows = rows_of(&document.tails, |tail| &tail.events);
    let mut columns = Columns::default();
    columns.text("tail", rows.iter().map(|(tail, _)| (*tail).to_owned()));
    columns.text("time", rows.iter().map(|(_, event)| event.time.clone()));
    columns.text("kind", rows.iter().map(|(_, event)| event.kind.clone()));
    columns.text("note", rows.iter().map(|(_, event)| event.note.clone()));
    figure(&mut columns, "effect_percent", &rows, |(_, event)| event.effect_percent);
    columns.text("together_with", rows.iter().map(|(_, event)| event.together_with.join(" ")));
    columns
}

fn fleet(document: &MonitorDocument) -> Columns {
    let rows: Vec<_> = document
        .fleet
        .iter()
        .flat_map(|fleet| fleet.months.iter().map(|month| (fleet.aircraft_type.as_str(), month)))
        .collect();
    let mut columns = Columns::default();
    columns.text("aircraft_type", rows.iter().map(|(of_type, _)| (*of_type).to_owned()));
    columns.text("month", rows.iter().map(|(_, month)| month.month.clone()));
    columns.count("tails", rows.iter().map(|(_, month)| month.tails as u64));
    figure(&mut columns, "deviation_percent", &rows, |(_, month)| Some(month.deviation_percent));
    columns
}

fn alerts(document: &MonitorDocument) -> Columns {
    let rows = &document.alerts;
    let mut columns = Columns::default();
    columns.text("tail", rows.iter().map(|alert| alert.tail.clone()));
    columns.text("engine", rows.iter().map(|alert| engine_name(alert.engine)));
    columns.text("rule", rows.iter().map(|alert| alert.rule.clone()));
    figure(&mut columns, "size", rows, |alert| Some(alert.size));
    columns.text("unit", rows.iter().map(|alert| alert.unit.clone()));
    columns.text("since", rows.iter().map(|alert| alert.since.clone()));
    step_in_gap(&mut columns, rows, |alert| alert.step_in_gap.as_ref());
    columns.text("likely_causes", rows.iter().map(|alert| alert.likely_causes.join(" ")));
    columns
}

/// `all`, or an engine's number.
fn engine_name(engine: Option<usize>) -> String {
    engine.map_or_else(|| "all".to_owned(), |engine| engine.to_string())
}
