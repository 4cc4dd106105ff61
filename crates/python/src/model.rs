//! A model: its file's text in and out, predictions, figures.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

use perf_model::{Aircraft, Guide};
use pipeline::evaluation::{TailCounts, TailData, TailResult};
use pipeline::model_file::ModelFile;
use pipeline::model_table;
use pipeline::models::Models;
use pipeline::prediction::{PredictedColumn, Predictor};
use pipeline::whole_model::Predicts;
use pyo3::prelude::*;
use pyo3_arrow::PyTable;
use pyo3_arrow::input::AnyRecordBatch;

use crate::failure::{Failure, chain};
use crate::flights::{batches_of, python_table};
use crate::plots::{chosen, drawn};
use crate::points::{self, Points, Returned};
use crate::work::{run, threads_of};

/// A model file.
#[pyclass(frozen, module = "cruisefit._native")]
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) file: Arc<ModelFile>,
    /// What messages call it.
    pub(crate) name: PathBuf,
}

/// The table, how many rows have no prediction, and the first of them (from 1) with the reason.
type Prediction = (PyTable, usize, Option<(u64, String)>);

#[pymethods]
impl Model {
    /// A model from the text of its file.
    #[staticmethod]
    fn from_text(py: Python<'_>, text: String, name: PathBuf) -> PyResult<Self> {
        let shown = name.display().to_string();
        let file = run(py, NonZeroUsize::new(1), move |_| {
            ModelFile::from_text(&text).map_err(|error| match error.help() {
                Some(help) => Failure::input(format!("{error} ({help})")).in_file(shown),
                None => Failure::input(error).in_file(shown),
            })
        })?;
        Ok(Self { file: Arc::new(file), name })
    }

    /// The initial model of an aircraft file and a guide, and what is worth knowing about it.
    #[staticmethod]
    fn initial(
        py: Python<'_>,
        aircraft: (String, String),
        guide: (String, String),
    ) -> PyResult<(Self, Vec<String>)> {
        let (file, findings) = run(py, NonZeroUsize::new(1), move |_| {
            let (aircraft_name, aircraft) = aircraft;
            let (guide_name, guide) = guide;
            let aircraft = Aircraft::from_ron(&aircraft).map_err(|error| {
                Failure::input(format!("not an aircraft file: {error}")).in_file(aircraft_name)
            })?;
            let guide = Guide::from_csv(guide.as_bytes())
                .map_err(|error| Failure::table(&error).in_file(guide_name.clone()))?;
            let initial = perf_model::initial_model(&aircraft, &guide)
                .map_err(|error| Failure::input(chain(&error)).in_file(guide_name))?;
            let findings: Vec<String> =
                initial.findings.iter().map(|finding| finding.message.clone()).collect();
            Ok((ModelFile::from_initial(&initial, &guide), findings))
        })?;
        let name = PathBuf::from(file.initial.aircraft().type_code());
        Ok((Self { file: Arc::new(file), name }, findings))
    }

    /// The file's text.
    fn to_text(&self) -> PyResult<String> {
        Ok(self.file.to_text().map_err(Failure::internal)?)
    }

    /// The predictions at a table's rows, and which rows have none. `predicts`: `whole` or `table`;
    /// `stated`: whether standard deviations are, columns of the prediction, all without them, and whether the columns that were
    /// given come before them.
    fn predict(
        &self,
        py: Python<'_>,
        table: AnyRecordBatch,
        predicts: &str,
        stated: (bool, Option<Vec<String>>, bool),
        #[pyo3(from_py_with = threads_of)] threads: Option<NonZeroUsize>,
    ) -> PyResult<Prediction> {
        let predicts = predicts_of(predicts)?;
        let (deviations, columns, with_given) = stated;
        let returned = if with_given { Returned::WithGiven } else { Returned::PredictionAlone };
        let columns = columns.map(|names| columns_of(&names)).transpose()?;
        let given = Points { schema: table.schema()?, batches: batches_of(table)? };
        let file = Arc::clone(&self.file);
        let (found, refused) = run(py, threads, move |caller| {
            let predictor = Predictor::new(&file, predicts).map_err(Failure::input)?;
            let predictor = if deviations { predictor } else { predictor.without_deviations() };
            let predictor = match &columns {
                Some(columns) => predictor.with_columns(columns),
                None => predictor,
            };
            let asks_error =
                columns.is_some_and(|columns| columns.contains(&PredictedColumn::ErrorPercent));
            points::predict(&predictor, given, (returned, asks_error), caller)
        })?;
        let table = PyTable::try_new(found.batches, found.schema)?;
        Ok((table, refused.rows, refused.first))
    }

    /// Charts of the model as SVG, of these names or all.
    fn plot(&self, py: Python<'_>, charts: Vec<String>) -> PyResult<String> {
        let file = self.file.as_ref().clone();
        let tail = file.tail().unwrap_or_else(|| file.initial.aircraft().name()).to_owned();
        let data = TailData {
            tail,
            model: file,
            segments: Vec::new(),
            counts: TailCounts::default(),
            notes: Vec::new(),
            curve: None,
        };
        run(py, None, move |_| {
            let charts = chosen(&charts, &page::TAIL_CHARTS)?;
            drawn(page::plot(&TailResult::as_given(data, Predicts::WholeModel), &charts))
        })
    }

    /// One row per node of the drag table.
    fn table(&self, py: Python<'_>) -> PyResult<PyTable> {
        let file = Arc::clone(&self.file);
        python_table(py, move || Ok(model_table::table(&file)))
    }

    /// The six-coefficient polynomial nearest to the drag table, with its covariance where the law provides one.
    fn polynomial(&self, py: Python<'_>) -> PyResult<PyTable> {
        let file = Arc::clone(&self.file);
        python_table(py, move || model_table::polynomial(&file).map_err(Failure::input))
    }

    #[getter]
    fn name(&self) -> String {
        self.name.display().to_string()
    }

    #[getter]
    fn tail(&self) -> Option<&str> {
        self.file.tail()
    }

    #[getter]
    fn aircraft_name(&self) -> &str {
        self.file.initial.aircraft().name()
    }

    #[getter]
    fn aircraft_type(&self) -> &str {
        self.file.initial.aircraft().type_code()
    }

    #[getter]
    fn engines(&self) -> usize {
        self.file.initial.aircraft().engines()
    }

    /// The law by which the model has learnt; none for an initial model.
    #[getter]
    fn law(&self) -> Option<&'static str> {
        self.file.learnt.as_ref().map(|learnt| learnt.law.name())
    }

    /// Number of flights in the ledger.
    #[getter]
    fn flights(&self) -> usize {
        self.file.learnt.as_ref().map_or(0, |learnt| learnt.ledger.len())
    }

    /// Share of nodes ever adapted, or with at least one effective observation.
    #[getter]
    fn informed_nodes(&self) -> f64 {
        self.file.informed_nodes()
    }

    /// Effects of applied diagnoses in words.
    #[getter]
    fn applied(&self) -> Option<String> {
        self.file.note_of_effects()
    }
}

/// `whole` or `table`.
///
/// # Errors
/// Another word.
pub(crate) fn predicts_of(word: &str) -> Result<Predicts, Failure> {
    match word {
        "whole" => Ok(Predicts::WholeModel),
        "table" => Ok(Predicts::TableOnly),
        other => Err(Failure::input(format!("found {other:?}, expected \"whole\" or \"table\""))),
    }
}

/// Columns of predictions by their names.
///
/// # Errors
/// A name of none.
fn columns_of(names: &[String]) -> Result<Vec<PredictedColumn>, Failure> {
    let column = |name: &String| {
        PredictedColumn::of_name(name).ok_or_else(|| {
            let known = PredictedColumn::ALL.map(PredictedColumn::name).join(", ");
            Failure::input(format!("found {name:?}, expected a column of predictions: {known}"))
        })
    };
    names.iter().map(column).collect()
}

/// The models of a call.
///
/// # Errors
/// Two models that claim the same tail or type.
pub(crate) fn models_of(models: &[Py<Model>]) -> Result<Models, Failure> {
    let models = models.iter().map(|model| {
        let model = model.get();
        (model.name.clone(), model.file.as_ref().clone())
    });
    Models::new(models.collect())
        .map_err(|same| Failure::input(&same).in_file(same.path.display().to_string()))
}
