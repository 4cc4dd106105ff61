//! Optima as JSON and as a table of columns.

use serde::Serialize;

use super::condition::{BestLevel, ConditionOptimum, LevelOptimum, SpeedOptimum};
use super::{CostIndex, Edge, Informed, NoSaving, OpenEnds, largest_against_predict_percent};
use crate::columns::Columns;
use crate::model_file::ModelFile;

/// Schema of [`OptimumDocument`].
pub const SCHEMA: &str = "cruisefit.optimum/1";

/// The optima of a model as JSON.
#[derive(Debug, Serialize)]
pub struct OptimumDocument<'a> {
    schema: &'static str,
    aircraft: &'a str,
    aircraft_type: &'a str,
    /// Whose flights were learnt; `null` for an initial model, which is its own book.
    tail: Option<&'a str>,
    flights: usize,
    cost_index_kg_min: Option<f64>,
    largest_against_predict_percent: Option<f64>,
    conditions: &'a [ConditionOptimum],
}

impl<'a> OptimumDocument<'a> {
    /// The document of a model's optima.
    #[must_use]
    pub fn new(
        model: &'a ModelFile,
        cost_index: Option<CostIndex>,
        conditions: &'a [ConditionOptimum],
    ) -> Self {
        let learnt = model.learnt.as_ref();
        Self {
            schema: SCHEMA,
            aircraft: model.initial.aircraft().name(),
            aircraft_type: model.initial.aircraft().type_code(),
            tail: learnt.map(|learnt| learnt.tail.as_str()),
            flights: learnt.map_or(0, |learnt| learnt.ledger.len()),
            cost_index_kg_min: cost_index.map(CostIndex::to_kilograms_per_minute),
            largest_against_predict_percent: largest_against_predict_percent(conditions),
            conditions,
        }
    }

    /// As JSON, with a final line end.
    ///
    /// # Errors
    /// None that is known: what JSON refuses to write.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        let mut json = serde_json::to_string_pretty(self)?;
        json.push('\n');
        Ok(json)
    }
}

/// A row of the table; `best` where its level is the best one.
struct Row<'c> {
    condition: &'c ConditionOptimum,
    level: &'c LevelOptimum,
    speed: &'c SpeedOptimum,
    best: Option<&'c BestLevel>,
}

/// One row for each condition, level and way to choose the Mach number. What is known of the best level is in its row alone.
#[must_use]
pub fn columns(conditions: &[ConditionOptimum]) -> Columns {
    let rows = rows(conditions);
    let mut columns = Columns::default();
    columns.number("mass_kg", rows.iter().map(|row| Some(row.condition.mass_kg)));
    columns.number("isa_deviation_c", rows.iter().map(|row| Some(row.condition.isa_deviation_k)));
    columns.number("tailwind_kt", rows.iter().map(|row| Some(row.condition.tailwind_kt)));
    columns.number(
        "pressure_altitude_ft",
        rows.iter().map(|row| Some(row.level.pressure_altitude_ft)),
    );
    columns.count("best_level", rows.iter().map(|row| u64::from(row.best.is_some())));
    columns.text("kind", rows.iter().map(|row| row.speed.kind.id()));
    add_speeds(&mut columns, &rows);
    add_best_levels(&mut columns, &rows);
    columns
}

fn rows(conditions: &[ConditionOptimum]) -> Vec<Row<'_>> {
    let mut rows = Vec::new();
    for condition in conditions {
        for level in &condition.levels {
            for speed in &level.speeds {
                let is_best = |best: &&BestLevel| best.kind == speed.kind && best.is(level);
                let best = condition.best.iter().find(is_best);
                rows.push(Row { condition, level, speed, best });
            }
        }
    }
    rows
}

/// The columns of optimum Mach numbers.
fn add_speeds(columns: &mut Columns, rows: &[Row<'_>]) {
    let number = |of: fn(&SpeedOptimum) -> Option<f64>| rows.iter().map(move |row| of(row.speed));
    columns.number("mach", number(|speed| Some(speed.mach)));
    columns.number("mach_ci95_low", number(|speed| speed.mach_ci95.map(|[low, _]| low)));
    columns.number("mach_ci95_high", number(|speed| speed.mach_ci95.map(|[_, high]| high)));
    columns.text("mach_ci95_open", rows.iter().map(|row| open(row.speed.mach_ci95_open)));
    columns.text("at_edge", rows.iter().map(at_edge));
    columns.text("informed_by", rows.iter().map(|row| informed(row.speed.informed_by)));
    columns.number("beyond_flights", number(|speed| speed.beyond_flights.map(flag)));
    columns.number("fuel_flow_kg_h", number(|speed| Some(speed.fuel_flow_kg_h)));
    columns.number("against_predict_percent", number(|speed| speed.against_predict_percent));
    columns.number("ground_range_m_kg", number(|speed| Some(speed.ground_range_m_kg)));
    columns.number("book_mach", number(|speed| speed.book_mach));
    columns.text("book_at_edge", rows.iter().map(|row| edge(row.speed.book_edge)));
    columns.number("saving_kg_h", number(|speed| speed.saving_kg_h));
    columns.number("saving_ci95_low", number(|speed| speed.saving_ci95.map(|[low, _]| low)));
    columns.number("saving_ci95_high", number(|speed| speed.saving_ci95.map(|[_, high]| high)));
    columns.text("no_saving", rows.iter().map(|row| row.speed.no_saving.map_or("", NoSaving::id)));
}

/// The columns of best levels, empty in the rows of others.
fn add_best_levels(columns: &mut Columns, rows: &[Row<'_>]) {
    let number =
        |of: fn(&BestLevel) -> Option<f64>| rows.iter().map(move |row| row.best.and_then(of));
    columns.number("level_ci95_low_ft", number(|best| best.pressure_altitude_ci95.map(|ft| ft[0])));
    columns
        .number("level_ci95_high_ft", number(|best| best.pressure_altitude_ci95.map(|ft| ft[1])));
    let level_open = |row: &Row<'_>| row.best.and_then(|best| best.pressure_altitude_ci95_open);
    columns.text("level_ci95_open", rows.iter().map(|row| open(level_open(row))));
    columns.number("book_level_ft", number(|best| best.book_pressure_altitude_ft));
    columns.number("book_level_mach", number(|best| best.book_mach));
    let book_at_edge = |best: &BestLevel| best.book_mach.map(|_| flag(best.book_at_edge));
    columns.number("book_level_at_edge", number(book_at_edge));
    columns.number("level_saving_kg_h", number(|best| best.saving_kg_h));
    columns.number("level_saving_ci95_low", number(|best| best.saving_ci95.map(|[low, _]| low)));
    columns.number("level_saving_ci95_high", number(|best| best.saving_ci95.map(|[_, high]| high)));
    let no_saving = |row: &Row<'_>| row.best.and_then(|best| best.no_saving);
    columns.text("level_no_saving", rows.iter().map(|row| no_saving(row).map_or("", NoSaving::id)));
}

/// The edge at which a Mach number lies, or that of the levels, for a best one.
fn at_edge(row: &Row<'_>) -> &'static str {
    match (row.speed.edge, row.best) {
        (None, Some(best)) if best.at_edge => "level",
        (of_mach, _) => edge(of_mach),
    }
}

fn flag(is: bool) -> f64 {
    f64::from(u8::from(is))
}

fn open(ends: Option<OpenEnds>) -> &'static str {
    ends.map_or("", OpenEnds::id)
}

const fn edge(edge: Option<Edge>) -> &'static str {
    match edge {
        None => "",
        Some(Edge::Lowest) => "lowest",
        Some(Edge::Highest) => "highest",
    }
}

const fn informed(by: Informed) -> &'static str {
    match by {
        Informed::Guide => "guide",
        Informed::Flights => "flights",
        Informed::GuideAndFlights => "guide_and_flights",
    }
}
