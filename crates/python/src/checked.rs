//! What is wrong with recorded data, and what changed on tails over months: documents of the command line.

use std::num::NonZeroUsize;
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use arrow_array::RecordBatch;
use monitor::cost::CostFactors;
use pipeline::monitoring::{
    self, BeforeLearning, Event, MonitorDocument, MonitorOptions, NamedTable, TailDeviations,
    monitor_tail, read_events, tables, warn_of_events,
};
use pipeline::plausibility;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3_arrow::PyTable;
use rayon::prelude::*;

use crate::adapted::{Adapted, Tail};
use crate::failure::Failure;
use crate::flights::{Flights, table_of_batch};
use crate::model::{Model, models_of};
use crate::plots::drawn;
use crate::tables::to_batch;
use crate::work::{run, threads_in};

/// JSON and text of `cruisefit check`.
#[pyfunction]
pub(crate) fn check(
    py: Python<'_>,
    models: Vec<Py<Model>>,
    flights: &Flights,
) -> PyResult<(Vec<u8>, String)> {
    let models = if models.is_empty() { None } else { Some(models_of(&models)?) };
    let flights = flights.clone();
    run(py, NonZeroUsize::new(1), move |_| {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).ok();
        let now_s = now.map(|since| since.as_secs_f64());
        let document = plausibility::check_document(&flights.reading, models.as_ref(), now_s);
        Ok((document.to_json(), document.to_text()))
    })
}

/// What changed on tails: the document of `cruisefit monitor`.
#[pyclass(frozen, module = "cruisefit._native")]
#[derive(Debug)]
pub(crate) struct Monitored {
    document: Arc<MonitorDocument>,
    /// What was asked for, in words.
    options: Arc<[String]>,
}

/// How tails are monitored, in the words of the Python files.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct MonitorAsked {
    events: Option<PyBackedBytes>,
    rules: Vec<String>,
    co2_kg_per_kg: Option<f64>,
    fuel_price: Option<f64>,
    flights_per_year: Option<f64>,
    basic_performance_factor_percent: Option<f64>,
    quick: bool,
    since: Option<String>,
    threads: Option<i128>,
}

/// Deviations, changes, events, fuel factors and costs of every tail that has learnt.
#[pyfunction]
pub(crate) fn monitor_tails(
    py: Python<'_>,
    adapted: &Adapted,
    asked: MonitorAsked,
) -> PyResult<Monitored> {
    let tails = Arc::clone(&adapted.tails);
    let (document, options) = run(py, threads_in(asked.threads)?, move |caller| {
        let events = match &asked.events {
            Some(bytes) => events_of(bytes)?,
            None => Vec::new(),
        };
        let options = options_of(&asked)?;
        let found = tails
            .par_iter()
            .map(|tail| {
                caller.still_waits()?;
                Ok(monitored(tail, &events, &options))
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        let (mut documents, mut alerts) = (Vec::new(), Vec::new());
        for (tail, flown, fired) in found.into_iter().flatten() {
            documents.push((tail, flown));
            alerts.extend(fired);
        }
        documents.sort_by(|(one, _), (other, _)| one.tail.cmp(&other.tail));
        alerts.sort_by(|one, other| one.tail.cmp(&other.tail));
        warn_of_events(&events, |tail| documents.iter().any(|(known, _)| known.tail == tail));
        let words = options.in_words(events.len());
        Ok((MonitorDocument::compared(documents, alerts), words))
    })?;
    Ok(Monitored { document: Arc::new(document), options: options.into() })
}

fn date(text: &str) -> Result<flight::Timestamp, Failure> {
    monitoring::instant(text).ok_or_else(|| {
        Failure::input(format!(
            "found since = {text:?}, expected a date like 2026-03-02, or an instant like 2026-03-02T10:00:00Z"
        ))
    })
}

fn options_of(asked: &MonitorAsked) -> Result<MonitorOptions, Failure> {
    let rules = asked.rules.iter().map(|rule| rule.parse().map_err(Failure::input));
    let options = MonitorOptions {
        cost: CostFactors {
            co2_kg_per_kg: asked.co2_kg_per_kg,
            price_per_kg: asked.fuel_price,
            flights_per_year: asked.flights_per_year,
        },
        basic_performance_factor_percent: asked.basic_performance_factor_percent,
        rules: rules.collect::<Result<Vec<_>, Failure>>()?,
        before_learning: BeforeLearning::left_out(asked.quick),
        since: asked.since.as_deref().map(date).transpose()?,
    };
    options.checked().map_err(Failure::input)
}

/// What a tail shows. One that cannot be monitored costs itself, with a warning, and not the fleet.
fn monitored(
    tail: &Tail,
    events: &[Event],
    options: &MonitorOptions,
) -> Option<monitoring::Monitored> {
    let result = &tail.result;
    let deviations =
        TailDeviations::of_result(result, options.before_learning).since(options.since);
    monitor_tail(&result.tail, &deviations, events, options).unwrap_or_else(|error| {
        tracing::warn!(tail = result.tail, "is not monitored: {error}");
        None
    })
}

#[pymethods]
impl Monitored {
    /// `monitor.json`.
    fn json(&self, py: Python<'_>) -> PyResult<Vec<u8>> {
        let document = Arc::clone(&self.document);
        run(py, NonZeroUsize::new(1), move |_| Ok(document.to_json()))
    }

    /// Numbers of tails, flights and changes.
    fn counts(&self) -> (usize, usize, usize) {
        let tails = &self.document.tails;
        let flights = tails.iter().map(|tail| tail.flights.len()).sum();
        (tails.len(), flights, tails.iter().map(|tail| tail.changes.len()).sum())
    }

    /// `monitor.html`.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        let (document, options) = (Arc::clone(&self.document), Arc::clone(&self.options));
        run(py, None, move |_| Ok(page::monitoring(&document, &options)))
    }

    /// Deviations over time of these tails as SVG; of all without any.
    fn plot(&self, py: Python<'_>, tails: Vec<String>) -> PyResult<String> {
        let document = Arc::clone(&self.document);
        run(py, None, move |_| {
            let mut documents = document.tails.clone();
            documents.retain(|one| tails.is_empty() || tails.contains(&one.tail));
            drawn(page::plot_months(&documents))
        })
    }

    /// The tables of `cruisefit monitor`, by the names of their files.
    fn tables(&self, py: Python<'_>) -> PyResult<Vec<(String, PyTable)>> {
        let document = Arc::clone(&self.document);
        let batches = run(py, None, move |_| {
            let batch = |table: NamedTable| Ok((table.name, to_batch(&table.columns)?));
            tables(&document).into_par_iter().map(batch).collect::<Result<Vec<_>, Failure>>()
        })?;
        let python =
            |(name, batch): (&str, RecordBatch)| Ok((name.to_owned(), table_of_batch(batch)?));
        batches.into_iter().map(python).collect()
    }
}

/// What was done to which tail.
pub(crate) fn events_of(bytes: &[u8]) -> Result<Vec<Event>, Failure> {
    read_events(bytes).map_err(|error| Failure::input(error).in_file("events"))
}
