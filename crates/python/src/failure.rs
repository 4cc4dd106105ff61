//! Errors as exceptions of `cruisefit.errors`, with file, line, column, found and expected where they are known.

use std::fmt::Display;

use perf_model::CsvError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Which exception is raised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// `InputError`: a file, table or argument that is wrong.
    Input,
    /// `InternalError`: a fault of this program.
    Internal,
}

/// Why a call gave no result.
#[derive(Clone, Debug)]
pub(crate) struct Failure {
    kind: Kind,
    message: String,
    file: Option<String>,
    line: Option<u64>,
    column: Option<String>,
}

impl Failure {
    /// An argument, file or table that is wrong as a whole.
    pub(crate) fn input(message: impl Display) -> Self {
        let message = message.to_string();
        Self { kind: Kind::Input, message, file: None, line: None, column: None }
    }

    /// A fault of this program.
    pub(crate) fn internal(message: impl Display) -> Self {
        Self { kind: Kind::Internal, ..Self::input(message) }
    }

    /// The same with the name of the file, or of what stands for one.
    pub(crate) fn in_file(self, file: impl Into<String>) -> Self {
        Self { file: Some(file.into()), ..self }
    }

    /// The same with a line, or the row of a table, from 1.
    pub(crate) fn at_line(self, line: u64) -> Self {
        Self { line: Some(line), ..self }
    }

    /// What is wrong with the names of a table's columns, which are in no row.
    pub(crate) fn names(error: &CsvError) -> Self {
        Self { line: None, ..Self::table(error) }
    }

    /// What is wrong with a guide or with flight points.
    pub(crate) fn table(error: &CsvError) -> Self {
        let column = error.column.as_ref().map(|column| column.name.clone());
        Self { column, ..Self::input(&error.reason).at_line(error.line) }
    }
}

/// An error with its causes, in one sentence.
pub(crate) fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text.push_str(": ");
        text.push_str(&error.to_string());
        cause = error.source();
    }
    text
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        Python::attach(|py| failure.raised(py).unwrap_or_else(|error| error))
    }
}

impl Failure {
    fn raised(self, py: Python<'_>) -> PyResult<PyErr> {
        let class = match self.kind {
            Kind::Input => "InputError",
            Kind::Internal => "InternalError",
        };
        let fields = PyDict::new(py);
        fields.set_item("file", self.file)?;
        fields.set_item("line", self.line)?;
        fields.set_item("column", self.column)?;
        let raised =
            py.import("cruisefit.errors")?.getattr(class)?.call((self.message,), Some(&fields))?;
        Ok(PyErr::from_value(raised))
    }
}
