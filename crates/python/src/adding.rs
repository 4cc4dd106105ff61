//! Tails that were learnt in parts, as on several machines, added up.

use std::collections::BTreeMap;
use std::path::PathBuf;

use pipeline::adaptation::{Material, StoredTail, materials};
use pipeline::merging::{self, Part};
use pipeline::reading::RefusedReport;
use pipeline::summary::{RefusedSummary, ReportsSummary, Summary};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use rayon::prelude::*;

use crate::adapted::{Adapted, Reports, Tail};
use crate::failure::Failure;
use crate::work::run;

/// What the parts of tails have learnt by law `bayes`, the table alone, as one adaptation that can be continued; `summaries` are
/// those of the calls that learnt them, also of a part of which nothing was learnt.
#[pyfunction]
pub(crate) fn added(
    py: Python<'_>,
    parts: Vec<Py<Adapted>>,
    summaries: Vec<PyBackedBytes>,
) -> PyResult<Adapted> {
    let parts: Vec<Adapted> = parts.iter().map(|part| part.get().clone()).collect();
    run(py, None, move |_| {
        let reports = reports_of(&summaries)?;
        let mut by_tail: BTreeMap<String, Vec<Tail>> = BTreeMap::new();
        for tail in parts.iter().flat_map(|part| part.tails.iter()) {
            by_tail.entry(tail.result.tail.clone()).or_default().push(tail.clone());
        }
        let tails = by_tail.into_par_iter().map(|(tail, parts)| {
            sum(parts).map_err(|reason| Failure::input(format!("tail {tail}: {reason}")))
        });
        Ok(Adapted::new(tails.collect::<Result<_, Failure>>()?, reports))
    })
}

/// What became of the reports of all calls together.
fn reports_of(summaries: &[PyBackedBytes]) -> Result<Reports, Failure> {
    let mut all = Reports::default();
    for text in summaries {
        let summary: Summary = serde_json::from_slice(text)
            .map_err(|error| Failure::input(error).in_file("summary.json"))?;
        let ReportsSummary { read, already_known, copies, other_files, refused } = summary.reports;
        all.read += read;
        all.already_known += already_known;
        all.copies += copies;
        all.other_files += other_files;
        all.refused.extend(refused.into_iter().map(|one| {
            let RefusedSummary { path, line, column, reason } = one;
            RefusedReport { path: PathBuf::from(path), line, column, reason }
        }));
    }
    Ok(all)
}

/// The sum of a tail's parts, its flights in the order of its ledger.
fn sum(parts: Vec<Tail>) -> Result<Tail, String> {
    let begun = parts.first().map(|part| part.begun.clone()).unwrap_or_default();
    if parts.iter().any(|part| part.begun != begun) {
        return Err("its parts were begun with other models or settings".to_owned());
    }
    // Sums depend on the order of their terms: `merge` takes them in that of flying. Segments are kept for what continues the tail; to
    // learn them again here would take the task that parts are to spare.
    let of_model = |part: &Tail| Part { model: part.result.model.clone(), flights: None };
    let (model, _) = merging::merge(parts.iter().map(of_model).collect())
        .map_err(|(_, error)| error.to_string())?;
    let flown: Vec<Material> = parts
        .into_iter()
        .flat_map(|part| {
            let StoredTail { segments, flights, .. } = part.stored();
            materials(flights, segments)
        })
        .collect();
    let ledger = model.learnt.as_ref().map_or(&[][..], |learnt| &learnt.ledger);
    let mut by_entry: BTreeMap<(String, String), Material> = flown
        .into_iter()
        .map(|one| ((one.known.entry.start.clone(), one.known.entry.flight.clone()), one))
        .collect();
    let (mut flights, mut segments) = (Vec::new(), Vec::new());
    for entry in ledger {
        if let Some(one) = by_entry.remove(&(entry.start.clone(), entry.flight.clone())) {
            flights.push(one.known);
            segments.extend(one.segments);
        }
    }
    let learnt = flights.len();
    let stored = StoredTail { model, segments, flights, curve: None, predicted: None };
    Ok(Tail::learnt(stored, begun, learnt, Vec::new()))
}
