//! Patterns of paths.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use pyo3::prelude::*;

use crate::failure::Failure;
use crate::work::run;

/// What a pattern matches, as the command line has it: Python's own module leaves out names that begin with a dot.
#[pyfunction]
pub(crate) fn matches(py: Python<'_>, pattern: String) -> PyResult<Vec<PathBuf>> {
    run(py, NonZeroUsize::new(1), move |caller| {
        let found =
            glob::glob(&pattern).map_err(|error| Failure::input(error).in_file(pattern.clone()))?;
        found
            .map(|path| {
                caller.still_waits()?;
                path.map_err(|error| {
                    Failure::input(error.error()).in_file(error.path().display().to_string())
                })
            })
            .collect()
    })
}
