//! What one begins with: a first mapping of a recording, and the public model of a type where there is no guide.

use std::num::NonZeroUsize;

use arrow_array::RecordBatch;
use perf_model::poll_schumann;
use pipeline::public_guide::aircraft_text;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3_arrow::input::AnyRecordBatch;
use report::mapping::first_mapping;

use crate::failure::Failure;
use crate::flights::batches_of;
use crate::tables::{Zoneless, plain, to_csv};
use crate::work::run;

/// Rows of a table that a first mapping is made of: as many as tell how a column's values go. Our choice.
const ROWS_FOR_A_MAPPING: usize = 50_000;

/// Type code, name, and the type codes that it also stands for.
type PublicType = (String, String, Vec<String>);

/// A first mapping for a recording, from its bytes.
#[pyfunction]
pub(crate) fn mapping_of_bytes(
    py: Python<'_>,
    name: String,
    content: PyBackedBytes,
) -> PyResult<String> {
    run(py, NonZeroUsize::new(1), move |_| mapping_of(&content, name))
}

/// A first mapping for a recording whose samples are the rows of a table.
#[pyfunction]
pub(crate) fn mapping_of_table(
    py: Python<'_>,
    name: String,
    table: AnyRecordBatch,
) -> PyResult<String> {
    let batches = batches_of(table)?;
    run(py, NonZeroUsize::new(1), move |_| {
        let mut left = ROWS_FOR_A_MAPPING;
        let first: Vec<RecordBatch> = batches
            .into_iter()
            .map(|batch| {
                let rows = batch.num_rows().min(left);
                left -= rows;
                batch.slice(0, rows)
            })
            .collect();
        mapping_of(&to_csv(&plain(first)?, Zoneless::Local)?, name)
    })
}

fn mapping_of(content: &[u8], name: String) -> Result<String, Failure> {
    first_mapping(content).map_err(|refusal| {
        Failure::input(format!("found {}, expected {}", refusal.found, refusal.kind))
            .in_file(name)
            .at_line(refusal.line as u64)
    })
}

/// The types that have a public model.
#[pyfunction]
pub(crate) fn public_types() -> Vec<PublicType> {
    let also = |code: &str| {
        poll_schumann::synonyms()
            .filter(|(_, by)| *by == code)
            .map(|(synonym, _)| synonym.to_owned())
            .collect()
    };
    poll_schumann::types()
        .iter()
        .map(|parameters| {
            let name = format!("{} {}", parameters.manufacturer, parameters.variant);
            (parameters.type_code.clone(), name, also(&parameters.type_code))
        })
        .collect()
}

/// Aircraft file and guide of the public model of a type, as texts.
#[pyfunction]
pub(crate) fn public_guide(type_code: &str) -> PyResult<(String, String)> {
    let Some(parameters) = poll_schumann::find(type_code) else {
        let found = format!("type: found {type_code:?}, expected one of cruisefit.types()");
        return Err(Failure::input(found).into());
    };
    let code = type_code.to_ascii_uppercase();
    let guide = poll_schumann::guide::guide(&code, parameters).map_err(Failure::input)?;
    let aircraft = aircraft_text(&guide, parameters).map_err(Failure::internal)?;
    Ok((aircraft, guide.to_csv()))
}
