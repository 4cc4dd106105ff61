//! What tails learn from flights, and how far a model is off on them.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

use pipeline::adaptation::{self, StoredTail};
use pipeline::columns::Columns;
use pipeline::criteria_costs::CriteriaCosts;
use pipeline::evaluation::TailResult;
use pipeline::file_names::{file_stem_of_tail, link_to, page_file_of_tail};
use pipeline::folder_state::{self, DeviationsState, FileState, State, TailState};
use pipeline::learnt_flights::{self, KnownFlight};
use pipeline::monitoring::{flights_of, flights_to_csv};
use pipeline::reading::RefusedReport;
use pipeline::segments_table;
use pipeline::summary::{RefusedSummary, ReportsSummary, SCHEMA, Summary};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3_arrow::PyTable;
use rayon::prelude::*;

use crate::failure::Failure;
use crate::flights::{python_table, refused_rows};
use crate::model::Model;
use crate::plots::{chosen, drawn};
use crate::work::run;

/// A tail with what it has learnt.
#[derive(Clone, Debug)]
pub(crate) struct Tail {
    /// Model, segments, figures.
    pub(crate) result: TailResult,
    /// The flights in its ledger; empty in an evaluation.
    pub(crate) flights: Vec<KnownFlight>,
    /// SHA-256 of what it was begun with; empty where that is not known.
    pub(crate) begun: String,
    /// What the trim criteria cost in the flights of this call.
    pub(crate) costs: Option<CriteriaCosts>,
}

impl Tail {
    /// A tail that has learnt, with what this call added to it.
    pub(crate) fn learnt(
        stored: StoredTail,
        begun: String,
        flights_new: usize,
        notes: Vec<String>,
    ) -> Self {
        let flights = stored.flights.clone();
        let result = adaptation::result_of(stored, flights_new, notes);
        Self { result, flights, begun, costs: None }
    }

    /// What is learnt on.
    pub(crate) fn stored(self) -> StoredTail {
        let segments = self.result.rows.into_iter().map(|row| row.segment).collect();
        let TailResult { model, curve, .. } = self.result;
        StoredTail { model, segments, flights: self.flights, curve, predicted: None }
    }

    fn segments(&self) -> Columns {
        let engines = self.result.model.initial.aircraft().engines();
        segments_table::table(&self.result.rows, engines)
    }
}

/// Tails with what they have learnt or, of an evaluation, with their models as given.
#[pyclass(frozen, module = "cruisefit._native")]
#[derive(Clone, Debug)]
pub(crate) struct Adapted {
    pub(crate) tails: Arc<Vec<Tail>>,
    refused: Arc<Vec<RefusedReport>>,
    summary: Arc<Summary>,
    /// Serious findings in the data, in words.
    findings: Arc<String>,
}

/// What became of the reports of a call.
#[derive(Debug, Default)]
pub(crate) struct Reports {
    pub(crate) read: usize,
    pub(crate) already_known: usize,
    pub(crate) copies: usize,
    pub(crate) other_files: usize,
    pub(crate) refused: Vec<RefusedReport>,
    /// Serious findings in the data, in words.
    pub(crate) findings: String,
}

/// Model, `segments/TAIL.csv` and `flights/TAIL.csv`, and what the tail was begun with.
type StoredFiles = (Py<Model>, PyBackedBytes, PyBackedBytes, String);

/// Tail, what it was begun with, and path and SHA-256 of its model, segments and flights.
type NamedFiles = (String, String, [(String, String); 3]);

#[pymethods]
impl Adapted {
    /// Tails, in order.
    fn tails(&self) -> Vec<String> {
        self.tails.iter().map(|tail| tail.result.tail.clone()).collect()
    }

    /// A tail's model.
    fn model(&self, tail: &str) -> PyResult<Model> {
        let model = self.tail(tail)?.result.model.clone();
        Ok(Model { file: Arc::new(model), name: PathBuf::from(tail) })
    }

    /// A tail's segments with what its initial (or given) table says of them.
    fn segments(&self, py: Python<'_>, tail: String) -> PyResult<PyTable> {
        let adapted = self.clone();
        python_table(py, move || Ok(adapted.tail(&tail)?.segments()))
    }

    /// The same as the text of `segments/TAIL.csv`.
    fn segments_csv(&self, py: Python<'_>, tail: String) -> PyResult<Vec<u8>> {
        let adapted = self.clone();
        run(py, NonZeroUsize::new(1), move |_| Ok(adapted.tail(&tail)?.segments().to_csv()))
    }

    /// The text of `flights/TAIL.csv`.
    fn flights_csv(&self, py: Python<'_>, tail: String) -> PyResult<Vec<u8>> {
        let adapted = self.clone();
        run(py, NonZeroUsize::new(1), move |_| {
            Ok(learnt_flights::to_csv(&adapted.tail(&tail)?.flights))
        })
    }

    /// SHA-256 of what the tail was begun with.
    fn begun(&self, tail: &str) -> PyResult<String> {
        Ok(self.tail(tail)?.begun.clone())
    }

    /// What is worth knowing about a tail's data.
    fn notes(&self, tail: &str) -> PyResult<Vec<String>> {
        Ok(self.tail(tail)?.result.notes.clone())
    }

    /// `summary.json`.
    fn summary_json(&self) -> Vec<u8> {
        self.summary.to_json()
    }

    /// The summary as a table for a person.
    fn summary_text(&self) -> String {
        self.summary.to_text()
    }

    /// Serious findings in the data, in words; empty where there are none.
    fn findings(&self) -> &str {
        &self.findings
    }

    /// `report.html`: with the charts of all tails, or of a large fleet with links to a page per tail.
    fn page(&self, py: Python<'_>, title: String) -> PyResult<String> {
        let adapted = self.clone();
        run(py, None, move |_| Ok(adapted.report(&adapted.sections(), &title)))
    }

    /// Charts of a tail as SVG, of these names or all.
    fn plot(&self, py: Python<'_>, tail: String, charts: Vec<String>) -> PyResult<String> {
        let adapted = self.clone();
        run(py, None, move |_| {
            let charts = chosen(&charts, &page::TAIL_CHARTS)?;
            drawn(page::plot(&adapted.tail(&tail)?.result, &charts))
        })
    }

    /// Path below the folder and bytes of every file that `cruisefit adapt` writes into a new folder.
    fn files(&self, py: Python<'_>, title: String) -> PyResult<Vec<(String, Vec<u8>)>> {
        let adapted = self.clone();
        run(py, None, move |_| adapted.all_files(&title))
    }

    /// What was refused.
    fn refused(&self) -> Vec<(String, Option<usize>, Option<usize>, String)> {
        refused_rows(&self.refused)
    }

    /// What tails had learnt when their files were made; the begin of their next night.
    #[staticmethod]
    fn stored(py: Python<'_>, tails: Vec<StoredFiles>) -> PyResult<Self> {
        let tails: Vec<(Model, PyBackedBytes, PyBackedBytes, String)> = tails
            .into_iter()
            .map(|(model, segments, flights, begun)| {
                (model.get().clone(), segments, flights, begun)
            })
            .collect();
        run(py, None, move |_| {
            let tails = tails
                .into_par_iter()
                .map(|(model, segments, flights, begun)| {
                    stored_tail(&model, &segments, &flights, begun)
                })
                .collect::<Result<Vec<_>, Failure>>()?;
            Ok(Self::new(tails, Reports::default()))
        })
    }

    /// The files of each tail that the text of a `STATE.ron` names.
    #[staticmethod]
    fn state(text: &str) -> PyResult<Vec<NamedFiles>> {
        let state = State::from_text(text)
            .map_err(|error| Failure::input(error).in_file(folder_state::NAME))?;
        let pair = |file: FileState| (file.file, file.sha256);
        let tails = state.tails.into_iter().map(|(tail, of)| {
            (tail, of.begun, [pair(of.model), pair(of.segments), pair(of.flights)])
        });
        Ok(tails.collect())
    }
}

fn stored_tail(
    model: &Model,
    segments: &[u8],
    flights: &[u8],
    begun: String,
) -> Result<Tail, Failure> {
    let named = |error: &dyn std::fmt::Display| {
        Failure::input(error).in_file(model.name.display().to_string())
    };
    let Some(learnt) = &model.file.learnt else {
        return Err(named(&"has not learnt anything"));
    };
    let segments = segments_table::read(segments).map_err(|error| named(&error))?;
    let flights = learnt_flights::read(&learnt.tail, flights).map_err(|error| named(&error))?;
    if flights.iter().map(|flight| &flight.entry).ne(&learnt.ledger) {
        return Err(named(&"found a table of other flights than its ledger, expected the same"));
    }
    let stored = StoredTail {
        model: model.file.as_ref().clone(),
        segments,
        flights,
        // Not among what is kept from night to night here; made again where it is needed.
        curve: None,
        predicted: None,
    };
    Ok(Tail::learnt(stored, begun, 0, Vec::new()))
}

impl Adapted {
    /// The result of a call.
    pub(crate) fn new(mut tails: Vec<Tail>, mut reports: Reports) -> Self {
        tails.sort_by(|one, other| one.result.tail.cmp(&other.result.tail));
        reports.refused.sort_by(|one, other| one.path.cmp(&other.path));
        let summary = Summary {
            schema: SCHEMA,
            reports: ReportsSummary {
                read: reports.read,
                already_known: reports.already_known,
                copies: reports.copies,
                other_files: reports.other_files,
                refused: reports.refused.iter().map(RefusedSummary::from).collect(),
            },
            tails: tails.iter().map(|tail| tail.result.summary.clone()).collect(),
        };
        Self {
            tails: Arc::new(tails),
            refused: Arc::new(reports.refused),
            summary: Arc::new(summary),
            findings: Arc::new(reports.findings),
        }
    }

    fn tail(&self, name: &str) -> Result<&Tail, Failure> {
        let tails = || self.tails.iter().map(|tail| tail.result.tail.as_str());
        self.tails.iter().find(|tail| tail.result.tail == name).ok_or_else(|| {
            Failure::input(format!(
                "found tail {name:?}, expected one of {:?}",
                tails().collect::<Vec<_>>()
            ))
        })
    }

    fn all_files(&self, title: &str) -> Result<Vec<(String, Vec<u8>)>, Failure> {
        let of_tails = self
            .tails
            .par_iter()
            .map(|tail| files_of_tail(tail).map(|files| (tail, files)))
            .collect::<Result<Vec<_>, Failure>>()?;
        let mut state = State { generation: 1, ..State::default() };
        let mut files = Vec::new();
        for (tail, of_tail) in of_tails {
            let named = |place: usize| {
                let (file, bytes): &(String, Vec<u8>) = &of_tail[place];
                FileState { file: file.clone(), sha256: pipeline::checksum::sha256(bytes) }
            };
            let mut summary = tail.result.summary.clone();
            summary.flights_new = 0;
            let of_state = TailState {
                begun: tail.begun.clone(),
                model: named(0),
                segments: named(1),
                flights: named(2),
                deviations: Some(DeviationsState::of(named(3), &tail.result)),
                summary,
            };
            state.tails.insert(tail.result.tail.clone(), of_state);
            files.extend(of_tail);
        }
        files.extend(self.pages(title));
        files.push(("summary.json".to_owned(), self.summary.to_json()));
        let text = state.to_text().map_err(Failure::internal)?;
        files.push((folder_state::NAME.to_owned(), text.into_bytes()));
        Ok(files)
    }

    /// A section of a page per tail.
    fn sections(&self) -> Vec<page::Section> {
        let names = self.tails.iter().map(|tail| tail.result.tail.as_str());
        let anchors = page::Anchors::new(names);
        self.tails
            .par_iter()
            .map(|tail| page::section(&tail.result, tail.costs.as_ref(), &anchors))
            .collect()
    }

    fn is_on_one_page(&self) -> bool {
        self.tails.len() <= page::TAILS_ON_ONE_PAGE
    }

    /// One page with the charts of all tails, or of a large fleet with links to a page per tail.
    fn report(&self, sections: &[page::Section], title: &str) -> String {
        if self.is_on_one_page() {
            let sections: Vec<&page::Section> = sections.iter().collect();
            return page::report_of_sections(&self.summary, &sections, title);
        }
        let links = sections
            .iter()
            .map(|section| (section.tail.as_str(), link_to(&page_file_of_tail(&section.tail))));
        page::fleet_report(&self.summary, &links.collect(), title)
    }

    /// That page and, of a large fleet, a page per tail.
    fn pages(&self, title: &str) -> Vec<(String, Vec<u8>)> {
        let sections = self.sections();
        let report = self.report(&sections, title);
        let mut pages = vec![("report.html".to_owned(), report.into_bytes())];
        if !self.is_on_one_page() {
            pages.extend(sections.iter().map(|section| {
                (page_file_of_tail(&section.tail), page::tail_page(section).into_bytes())
            }));
        }
        pages
    }
}

/// Model, segments, flights and deviations.
fn files_of_tail(tail: &Tail) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let stem = file_stem_of_tail(&tail.result.tail);
    let model = tail.result.model.to_text().map_err(Failure::internal)?;
    let deviations = flights_of(&tail.result);
    Ok(vec![
        (format!("models/{stem}.ron"), model.into_bytes()),
        (format!("segments/{stem}.csv"), tail.segments().to_csv()),
        (format!("flights/{stem}.csv"), learnt_flights::to_csv(&tail.flights)),
        (format!("deviations/{stem}.csv"), flights_to_csv(&deviations)),
    ])
}
