//! What one begins with: a first mapping of a recording, and the public model of a type where there is no guide.

use std::num::NonZeroUsize;
use std::path::Path;

use arrow_array::RecordBatch;
use perf_model::poll_schumann;
use pipeline::public_guide::aircraft_text;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3_arrow::input::AnyRecordBatch;
use report::Refusal;
use report::mapping::first_mapping;

use crate::failure::Failure;
use crate::flights::batches_of;
use crate::recording::{Opening, Place};
use crate::tables::{Whose, plain, to_csv};
use crate::work::run;

/// Rows of a table that a first mapping is made of: as many as tell how a column's values go. Our choice.
const ROWS_FOR_A_MAPPING: usize = 50_000;

/// So much of a recording's text is looked at, bytes: as much as `cruisefit mapping` looks at, so that both make the same.
const LOOKED_AT_BYTES: usize = 16 << 20;

/// Type code, name, and the type codes that it also stands for.
type PublicType = (String, String, Vec<String>);

/// A first mapping for a recording: the file of this name, or these bytes.
#[pyfunction]
pub(crate) fn mapping_of_content(
    py: Python<'_>,
    name: String,
    content: Option<PyBackedBytes>,
    columnar: Py<PyAny>,
) -> PyResult<String> {
    run(py, NonZeroUsize::new(1), move |caller| {
        let opening = Opening { columnar, caller: caller.clone() };
        let place = content.as_ref().map_or(Place::File(Path::new(&name)), Place::Bytes);
        let unread = |reason: String| Failure::input(reason).in_file(name.clone());
        let beginning = opening.open(place).map_err(unread)?.beginning(LOOKED_AT_BYTES);
        let beginning = beginning.map_err(|refusal| refused(&refusal, name.clone()))?;
        mapping_of(&beginning, name)
    })
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
        mapping_of(&to_csv(&plain(first)?, Whose::Recorders)?, name)
    })
}

fn mapping_of(content: &[u8], name: String) -> Result<String, Failure> {
    first_mapping(content).map_err(|refusal| refused(&refusal, name))
}

fn refused(refusal: &Refusal, name: String) -> Failure {
    Failure::input(format!("found {}, expected {}", refusal.found, refusal.kind))
        .in_file(name)
        .at_line(refusal.line as u64)
}

/// The types that have a public model.
#[pyfunction]
pub(crate) fn public_types() -> Vec<PublicType> {
    poll_schumann::types()
        .iter()
        .map(|parameters| {
            let name = format!("{} {}", parameters.manufacturer, parameters.variant);
            let also = parameters.stands_for().map(str::to_owned).collect();
            (parameters.type_code.clone(), name, also)
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
