//! Optima as JSON and as a table of columns.

use serde::Serialize;

use super::condition::{ConditionOptimum, LevelOptimum, SpeedOptimum};
use super::{CostIndex, Edge, Informed, NoSaving};
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

/// One row for each condition, level and way to choose the Mach number.
#[must_use]
pub fn columns(conditions: &[ConditionOptimum]) -> Columns {
    let rows: Vec<(&ConditionOptimum, &LevelOptimum, &SpeedOptimum)> = conditions
        .iter()
        .flat_map(|condition| {
            condition.levels.iter().flat_map(move |level| {
                level.speeds.iter().map(move |speed| (condition, level, speed))
            })
        })
        .collect();
    let is_best =
        |(condition, level, speed): &(&ConditionOptimum, &LevelOptimum, &SpeedOptimum)| {
            condition.best.iter().any(|best| {
                best.kind == speed.kind
                    && best.pressure_altitude_ft.total_cmp(&level.pressure_altitude_ft).is_eq()
            })
        };
    let mut columns = Columns::default();
    columns.number("mass_kg", rows.iter().map(|row| Some(row.0.mass_kg)));
    columns.number("isa_deviation_c", rows.iter().map(|row| Some(row.0.isa_deviation_k)));
    columns.number("tailwind_kt", rows.iter().map(|row| Some(row.0.tailwind_kt)));
    columns.number("pressure_altitude_ft", rows.iter().map(|row| Some(row.1.pressure_altitude_ft)));
    columns.count("best_level", rows.iter().map(|row| u64::from(is_best(row))));
    columns.text("kind", rows.iter().map(|row| row.2.kind.id().to_owned()));
    let number = |of: fn(&SpeedOptimum) -> Option<f64>| rows.iter().map(move |row| of(row.2));
    columns.number("mach", number(|speed| Some(speed.mach)));
    columns.number("mach_ci95_low", number(|speed| speed.mach_ci95.map(|[low, _]| low)));
    columns.number("mach_ci95_high", number(|speed| speed.mach_ci95.map(|[_, high]| high)));
    columns.text("at_edge", rows.iter().map(|row| edge(row.2.edge).to_owned()));
    columns.text("informed_by", rows.iter().map(|row| informed(row.2.informed_by).to_owned()));
    columns.number("fuel_flow_kg_h", number(|speed| Some(speed.fuel_flow_kg_h)));
    columns.number("ground_range_m_kg", number(|speed| Some(speed.ground_range_m_kg)));
    columns.number("book_mach", number(|speed| speed.book_mach));
    columns.text("book_at_edge", rows.iter().map(|row| edge(row.2.book_edge).to_owned()));
    columns.number("saving_kg_h", number(|speed| speed.saving_kg_h));
    columns.number("saving_ci95_low", number(|speed| speed.saving_ci95.map(|[low, _]| low)));
    columns.number("saving_ci95_high", number(|speed| speed.saving_ci95.map(|[_, high]| high)));
    columns.text(
        "no_saving",
        rows.iter().map(|row| row.2.no_saving.map_or("", NoSaving::id).to_owned()),
    );
    columns
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
