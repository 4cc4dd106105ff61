//! Diagnoses: where models differ from flights and which effect they lack.

use std::num::NonZeroUsize;
use std::sync::Arc;

use ::diagnose::Options;
use flight::effect::EffectId;
use pipeline::diagnosed_tail::{DiagnosedTail, RunOptions};
use pipeline::diagnosis_document::{DiagnosisDocument, TailDiagnosis};
use pipeline::diagnosis_figures::DiagnosisFigures;
use pipeline::diagnosis_groups::{NoSuchEffect, effects_named, group};
use pipeline::diagnosis_text;
use pipeline::fleet_diagnosis::{DiagnosedFleet, FleetRecord, diagnose_fleets, fleet_text};
use pipeline::gaps_table;
use pipeline::monitoring::warn_of_events;
use pipeline::plausibility::{self, Book};
use pipeline::summary::{RefusedSummary, ReportsSummary};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use rayon::prelude::*;

use crate::adapting::absurd_of;
use crate::checked::events_of;
use crate::failure::Failure;
use crate::flights::Flights;
use crate::model::{Model, models_of};
use crate::plots::{chosen, drawn};
use crate::work::{run, threads_in};

/// The diagnoses of a call.
#[pyclass(frozen, module = "cruisefit._native")]
#[derive(Clone, Debug)]
pub(crate) struct Diagnosed {
    diagnoses: Arc<Vec<DiagnosedTail>>,
    figures: Arc<Vec<DiagnosisFigures>>,
    fleets: Arc<Vec<DiagnosedFleet>>,
    reports: Arc<ReportsSummary>,
    asked: Arc<RunOptions>,
    criteria: String,
    /// Serious findings in the data, in words.
    findings: String,
}

/// How flights are diagnosed, in the words of the Python files.
#[expect(clippy::struct_excessive_bools, reason = "each is a keyword of the Python function")]
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    effects: Vec<String>,
    without: Vec<String>,
    pool: bool,
    fleet: bool,
    table_only: bool,
    allow_learnt: bool,
    events: Option<PyBackedBytes>,
    absurd: String,
    threads: Option<i128>,
}

/// Diagnoses by tail, or of all tails of a type together.
#[pyfunction]
pub(crate) fn diagnose(
    py: Python<'_>,
    models: Vec<Py<Model>>,
    flights: &Flights,
    asked: Asked,
) -> PyResult<Diagnosed> {
    let options = Options {
        effects: effects_of("effects", &asked.effects)?,
        without: effects_of("without", &asked.without)?,
        ..Options::default()
    };
    let absurd = absurd_of(&asked.absurd)?;
    let threads = threads_in(asked.threads)?;
    let asked = RunOptions {
        effects: asked.effects,
        without: asked.without,
        pool: asked.pool,
        fleet: asked.fleet,
        table_only: asked.table_only,
        allow_learnt: asked.allow_learnt,
        events: asked.events.as_ref().map_or_else(|| Ok(Vec::new()), |bytes| events_of(bytes))?,
    };
    let models = models_of(&models)?;
    let flights = flights.clone();
    run(py, threads, move |caller| {
        let mut reading = flights.distinct().clone();
        let models = models.of_tails(&mut reading);
        let book_of = |tail: &str| models.get(tail).map(|model| Book::of(model));
        let findings = plausibility::set_aside_absurd(&mut reading, book_of, absurd);
        let groups = group(&models, &mut reading, &asked);
        warn_of_events(&asked.events, |tail| {
            let mut flights = groups.iter().flat_map(|group| &group.flights);
            flights.any(|flight| flight.reduced.identity.tail == tail)
        });
        let found = groups
            .par_iter()
            .map(|group| {
                caller.still_waits()?;
                group.diagnose(&options, &asked).map_err(Failure::input)
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        let (diagnoses, figures): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        caller.still_waits()?;
        let fleets = if asked.fleet {
            diagnose_fleets(&groups, &options, &asked, &|tails, reduce| {
                (0..tails).into_par_iter().map(reduce).collect()
            })
            .map_err(Failure::input)?
        } else {
            Vec::new()
        };
        reading.refused.sort_by(|one, other| one.path.cmp(&other.path));
        let reports = ReportsSummary {
            read: groups.iter().map(|group| group.flights.len()).sum(),
            refused: reading.refused.iter().map(RefusedSummary::from).collect(),
            ..ReportsSummary::default()
        };
        drop(groups);
        Ok(Diagnosed {
            diagnoses: Arc::new(diagnoses),
            figures: Arc::new(figures),
            fleets: Arc::new(fleets),
            reports: Arc::new(reports),
            asked: Arc::new(asked),
            criteria: flights.criteria.clone(),
            findings,
        })
    })
}

/// What an effect, a column, a set of criteria, a verdict or a figure of an output is; without a topic all of their names.
#[pyfunction]
#[pyo3(signature = (topic))]
pub(crate) fn explain(topic: Option<&str>) -> PyResult<String> {
    let Some(topic) = topic else { return Ok(pipeline::topics::overview()) };
    Ok(pipeline::topics::explain(topic).map_err(Failure::input)?)
}

/// The library: id, unit and perturbation of every effect that an aircraft of so many engines can have.
#[pyfunction]
pub(crate) fn effects(engines: i128) -> PyResult<Vec<(String, String, String)>> {
    let most = flight::MAXIMUM_ENGINES;
    let known = usize::try_from(engines).ok().filter(|number| (1..=most).contains(number));
    let number = known
        .ok_or_else(|| Failure::input(format!("engines: found {engines}, expected 1 to {most}")))?;
    let of_library = EffectId::library(number).into_iter().map(|effect| {
        let entry = effect.entry();
        (effect.to_string(), entry.unit.to_owned(), entry.perturbation.to_owned())
    });
    Ok(of_library.collect())
}

#[pymethods]
impl Diagnosed {
    /// `diagnosis.json`.
    fn json(&self, py: Python<'_>) -> PyResult<String> {
        let found = self.clone();
        run(py, NonZeroUsize::new(1), move |_| {
            let document = DiagnosisDocument::new(&found.asked, &found.reports, &found.diagnoses);
            document.with_fleets(&found.fleets).to_json().map_err(Failure::internal)
        })
    }

    /// `diagnosis.html`.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        let found = self.clone();
        run(py, None, move |_| {
            let words = found.asked.in_words(&found.criteria);
            let fleets: Vec<FleetRecord> = found.fleets.iter().map(FleetRecord::from).collect();
            let (diagnoses, figures) = (&found.diagnoses, &found.figures);
            Ok(page::diagnosis(&found.reports, diagnoses, figures, &fleets, &words))
        })
    }

    /// Charts of these tails' diagnoses as SVG, of these names or all; of all tails without any.
    fn plot(&self, py: Python<'_>, tails: Vec<String>, charts: Vec<String>) -> PyResult<String> {
        let found = self.clone();
        run(py, None, move |_| {
            let charts = chosen(&charts, &page::DIAGNOSIS_CHARTS)?;
            // As the command has them, which reads them from its table: to as many digits.
            let table = gaps_table::table(&found.diagnoses, &found.figures).to_csv();
            let gaps = gaps_table::read(&table).map_err(Failure::internal)?;
            let asked = |one: &&DiagnosedTail| tails.is_empty() || tails.contains(&one.tail);
            let diagnoses: Vec<TailDiagnosis> =
                found.diagnoses.iter().filter(asked).map(TailDiagnosis::from).collect();
            drawn(page::plot_diagnoses(&diagnoses, &gaps, &charts))
        })
    }

    /// The lines that the command line prints, tail by tail.
    fn lines(&self) -> Vec<(String, Vec<String>)> {
        self.diagnoses.iter().map(|one| (one.tail.clone(), diagnosis_text::lines(one))).collect()
    }

    /// What the command line prints of each fleet.
    fn fleet_texts(&self) -> Vec<String> {
        self.fleets.iter().map(fleet_text).collect()
    }

    /// Serious findings in the data, in words; empty where there are none.
    fn findings(&self) -> &str {
        &self.findings
    }
}

fn effects_of(argument: &str, names: &[String]) -> Result<Vec<EffectId>, Failure> {
    effects_named(names).map_err(|NoSuchEffect { name, known }| {
        Failure::input(format!("{argument}: found {name:?}, expected one of {known}"))
    })
}
