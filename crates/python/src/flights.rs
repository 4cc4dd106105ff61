//! Reports and recordings reduced to flights with their stabilised segments.

use std::borrow::Cow;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use arrow_array::RecordBatch;
use pipeline::columns::Columns;
use pipeline::distinct::distinct;
use pipeline::flights_table;
use pipeline::reading::recordings::{self, Mapped};
use pipeline::reading::{Checks, FileRead, FlightRead, FlightReader, Reading, RefusedReport};
use pipeline::segments_table::{self, SegmentRow};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3_arrow::PyTable;
use pyo3_arrow::input::AnyRecordBatch;
use rayon::prelude::*;
use report::MAXIMUM_TEXT_BYTES;
use report::mapping::{Mapping, PRESETS};
use segmenter::TrimCriteria;

use crate::columnar::is_columnar;
use crate::failure::Failure;
use crate::recorded_rows;
use crate::recording::{Opening, Place, in_parallel};
use crate::tables::{Whose, plain, to_batch, to_csv};
use crate::warned::Warnings;
use crate::work::{Caller, run, threads_of};

/// How reports are read: by which mapping and which trim criteria.
#[pyclass(frozen, module = "cruisefit._native")]
#[derive(Clone, Debug)]
pub(crate) struct Source {
    mapping: Option<Mapping>,
    criteria: TrimCriteria,
    criteria_name: String,
}

/// Flights reduced to their segments, and what was refused.
#[pyclass(frozen, module = "cruisefit._native")]
#[derive(Clone, Debug)]
pub(crate) struct Flights {
    /// As read, copies among them.
    pub(crate) reading: Arc<Reading>,
    pub(crate) criteria: String,
    /// Each flight once.
    distinct: Arc<OnceLock<Reading>>,
}

/// Path, line, column and reason of a refusal.
type RefusedRow = (String, Option<usize>, Option<usize>, String);

#[pymethods]
impl Source {
    /// `mapping`: the text of a mapping file, or the name of a preset.
    #[new]
    fn new(criteria: String, mapping: Option<&str>) -> PyResult<Self> {
        let found = criteria_of(&criteria)?;
        let mapping = mapping.map(mapping_of).transpose()?;
        Ok(Self { mapping, criteria: found, criteria_name: criteria })
    }

    /// Reads files, of whose folders so many others are left; `columnar` opens those of Parquet and Arrow.
    fn files(
        &self,
        py: Python<'_>,
        paths: Vec<PathBuf>,
        other_files: usize,
        columnar: Py<PyAny>,
        #[pyo3(from_py_with = threads_of)] threads: Option<NonZeroUsize>,
    ) -> PyResult<Flights> {
        let reading = self.clone();
        run(py, threads, move |caller| {
            let opening = Opening { columnar, caller: caller.clone() };
            let read = read_all(caller, &paths, |path, reader| {
                reading.read_one(reader, path, Place::File(path), &opening)
            })?;
            Ok(reading.flights(read, other_files))
        })
    }

    /// Reads contents in memory under the names given; `columnar` opens those of Parquet and Arrow.
    fn contents(
        &self,
        py: Python<'_>,
        reports: Vec<(PathBuf, PyBackedBytes)>,
        columnar: Py<PyAny>,
        #[pyo3(from_py_with = threads_of)] threads: Option<NonZeroUsize>,
    ) -> PyResult<Flights> {
        let reading = self.clone();
        run(py, threads, move |caller| {
            let opening = Opening { columnar, caller: caller.clone() };
            let read = read_all(caller, &reports, |(name, bytes), reader| {
                reading.read_one(reader, name, Place::Bytes(bytes), &opening)
            })?;
            Ok(reading.flights(read, 0))
        })
    }

    /// Reads the rows of a recording; the mapping states which column is what.
    fn rows(
        &self,
        py: Python<'_>,
        name: PathBuf,
        table: AnyRecordBatch,
        #[pyo3(from_py_with = threads_of)] threads: Option<NonZeroUsize>,
    ) -> PyResult<Flights> {
        let Some(mapping) = self.mapping.clone() else {
            return Err(Failure::input("the rows of a recording need a mapping").into());
        };
        let batches = batches_of(table)?;
        let reading = self.clone();
        run(py, threads, move |caller| {
            let how = (&mapping, &reading.criteria);
            let read = recorded_rows::read(&name, plain(batches)?, how, caller)?;
            Ok(reading.flights(vec![read], 0))
        })
    }
}

impl Source {
    /// What `name` calls: a report or a table of segments or, with the mapping, a recording.
    fn read_one(
        &self,
        reader: &mut FlightReader,
        name: &Path,
        place: Place<'_>,
        opening: &Opening,
    ) -> FileRead {
        let read = match &self.mapping {
            Some(mapping) => opening.open(place).map(|mut source| {
                let (criteria, checks) = (&self.criteria, Checks::Made);
                let mapped = Mapped { path: name, mapping, criteria, checks };
                recordings::read(&mapped, &mut source, &in_parallel)
            }),
            None => unmapped(place, opening)
                .map(|bytes| reader.read(name, &bytes, None, &self.criteria)),
        };
        read.unwrap_or_else(|reason| {
            (Vec::new(), vec![RefusedReport::whole(name.to_owned(), reason)])
        })
    }

    fn flights(&self, read: Vec<FileRead>, other_files: usize) -> Flights {
        let mut reading = Reading { other_files, ..Reading::default() };
        for (flights, refused) in read {
            reading.flights.extend(flights);
            reading.refused.extend(refused);
        }
        Flights::new(reading, self.criteria_name.clone())
    }
}

/// The bytes of a report or of a table of segments; of one in Parquet, its rows as text.
fn unmapped<'p>(place: Place<'p>, opening: &Opening) -> Result<Cow<'p, [u8]>, String> {
    let bytes: Cow<'p, [u8]> = match place {
        Place::File(path) => std::fs::read(path).map_err(|error| error.to_string())?.into(),
        Place::Bytes(bytes) => Cow::Borrowed(bytes),
    };
    if !is_columnar(&bytes) {
        return Ok(bytes);
    }
    let text = opening.open(place)?.beginning(MAXIMUM_TEXT_BYTES);
    let text = text.map_err(|refusal| refusal.to_string())?;
    if text.len() >= MAXIMUM_TEXT_BYTES {
        let limit = MAXIMUM_TEXT_BYTES >> 20;
        return Err(format!("more than {limit} MiB as text, the most that is read"));
    }
    if !segments_table::is_table(&text) {
        return Err("no table of segments: a recording needs mapping=".to_owned());
    }
    Ok(text.into())
}

/// One after the other in each thread, results in the order given.
fn read_all<T: Sync>(
    caller: &Caller,
    reports: &[T],
    one: impl Fn(&T, &mut FlightReader) -> FileRead + Sync,
) -> Result<Vec<FileRead>, Failure> {
    reports
        .par_iter()
        .map_init(FlightReader::default, |reader, report| {
            caller.still_waits()?;
            Ok(one(report, reader))
        })
        .collect()
}

/// The trim criteria of a name.
///
/// # Errors
/// A name of none.
fn criteria_of(name: &str) -> Result<TrimCriteria, Failure> {
    TrimCriteria::preset(name).ok_or_else(|| {
        let known = TrimCriteria::PRESETS;
        Failure::input(format!("criteria: found {name:?}, expected one of {known:?}"))
    })
}

fn mapping_of(text: &str) -> Result<Mapping, Failure> {
    if let Some(preset) = Mapping::preset(text) {
        return Ok(preset);
    }
    if !text.contains('(') {
        let known = PRESETS.map(|(name, _)| name).join(", ");
        let expected = format!("a mapping file, its text, or a preset: {known}");
        return Err(Failure::input(format!("mapping: found {text:?}, expected {expected}")));
    }
    Mapping::from_ron(text).map_err(|error| Failure::input(crate::failure::chain(&error)))
}

/// The batches of a table in memory; of one without rows an empty batch, which has its columns.
pub(crate) fn batches_of(table: AnyRecordBatch) -> PyResult<Vec<RecordBatch>> {
    let (mut batches, schema) = table.into_table()?.into_inner();
    if batches.is_empty() {
        batches.push(RecordBatch::new_empty(schema));
    }
    Ok(batches)
}

/// Columns, made as any other work of a call is, as a table that Python can take.
pub(crate) fn python_table(
    py: Python<'_>,
    columns: impl FnOnce() -> Result<Columns, Failure> + Send + 'static,
) -> PyResult<PyTable> {
    table_of_batch(run(py, NonZeroUsize::new(1), move |_| to_batch(&columns()?))?)
}

/// A batch as a table that Python can take.
pub(crate) fn table_of_batch(batch: RecordBatch) -> PyResult<PyTable> {
    let schema = batch.schema();
    PyTable::try_new(vec![batch], schema)
}

#[pymethods]
impl Flights {
    /// Flights and segments from the table that [`Self::state`] gave.
    #[staticmethod]
    fn from_state(py: Python<'_>, table: AnyRecordBatch, criteria: String) -> PyResult<Self> {
        criteria_of(&criteria)?;
        let batches = batches_of(table)?;
        let flights = run(py, NonZeroUsize::new(1), move |_| {
            let text = to_csv(&plain(batches)?, Whose::Ours)?;
            flights_table::read(&text).map_err(Failure::input)
        })?;
        Ok(Self::new(Reading { flights, ..Reading::default() }, criteria))
    }

    /// Flights from a table of segments alone: a flight's content is then that of its segments.
    #[staticmethod]
    fn from_segments(
        py: Python<'_>,
        table: AnyRecordBatch,
        aircraft_type: String,
        criteria: String,
    ) -> PyResult<Self> {
        // A model states them, and is continued by them alone.
        criteria_of(&criteria)?;
        let batches = batches_of(table)?;
        let flights = run(py, NonZeroUsize::new(1), move |_| {
            let text = to_csv(&plain(batches)?, Whose::Ours)?;
            let segments = segments_table::read(&text).map_err(Failure::input)?;
            Ok(flights_table::from_segments(segments, &aircraft_type))
        })?;
        Ok(Self::new(Reading { flights, ..Reading::default() }, criteria))
    }

    /// These and others, in this order.
    fn and_(&self, others: Vec<Py<Self>>) -> Self {
        let mut all = self.reading.as_ref().clone();
        for other in &others {
            let other = &other.get().reading;
            all.flights.extend(other.flights.iter().cloned());
            all.refused.extend(other.refused.iter().cloned());
            all.other_files += other.other_files;
        }
        Self::new(all, self.criteria.clone())
    }

    /// Looks for copies and contradictions, and warns of copies.
    fn look_through(&self, py: Python<'_>) -> PyResult<()> {
        Warnings::of(py, || {
            self.distinct();
        })
    }

    /// The flights of some tails.
    fn of_tails(&self, tails: Vec<String>) -> Self {
        let of = |flight: &&FlightRead| tails.contains(&flight.reduced.identity.tail);
        let flights = self.reading.flights.iter().filter(of).cloned().collect();
        let refused = self.reading.refused.clone();
        let other_files = self.reading.other_files;
        let reading = Reading { flights, refused, copies: 0, other_files };
        Self::new(reading, self.criteria.clone())
    }

    /// Every tail once, in order.
    fn tails(&self) -> Vec<String> {
        let mut tails: Vec<String> =
            self.reading.flights.iter().map(|f| f.reduced.identity.tail.clone()).collect();
        tails.sort();
        tails.dedup();
        tails
    }

    /// The table of segments, in the order of flying.
    fn segments(&self, py: Python<'_>) -> PyResult<PyTable> {
        let flights = self.compared(py).clone();
        python_table(py, move || Ok(flights.segments_columns()))
    }

    /// The table of segments as `segment` writes it.
    fn segments_csv(&self, py: Python<'_>) -> PyResult<Vec<u8>> {
        let flights = self.compared(py).clone();
        run(py, NonZeroUsize::new(1), move |_| Ok(flights.segments_columns().to_csv()))
    }

    /// One row per flight, each once, without its segments.
    fn table(&self, py: Python<'_>) -> PyResult<PyTable> {
        let flights = self.compared(py).clone();
        python_table(py, move || Ok(flights_table::table(&flights.distinct().flights)))
    }

    /// One row per flight as read, with its segments: all that `from_state` needs.
    fn state(&self, py: Python<'_>) -> PyResult<PyTable> {
        let reading = Arc::clone(&self.reading);
        python_table(py, move || Ok(flights_table::table_with_segments(&reading.flights)))
    }

    /// What was refused: reports that cannot be read, and flights that contradict another one.
    fn refused(&self) -> Vec<RefusedRow> {
        refused_rows(&self.distinct().refused)
    }

    /// What of that is known without a comparison of flights.
    fn refused_as_read(&self) -> Vec<RefusedRow> {
        refused_rows(&self.reading.refused)
    }

    /// The same flights, of whose reading this was refused.
    fn with_refused(&self, refused: Vec<RefusedRow>) -> Self {
        let refused = refused.into_iter().map(|(path, line, column, reason)| RefusedReport {
            path: PathBuf::from(path),
            line,
            column,
            reason,
        });
        let reading = Reading { refused: refused.collect(), ..self.reading.as_ref().clone() };
        Self::new(reading, self.criteria.clone())
    }

    /// Trim criteria by which the segments were found.
    #[getter]
    fn criteria(&self) -> &str {
        &self.criteria
    }

    fn __len__(&self) -> usize {
        self.distinct().flights.len()
    }

    /// Number of segments of all flights.
    fn count_segments(&self) -> usize {
        self.distinct().flights.iter().map(|flight| flight.reduced.segments.len()).sum()
    }
}

impl Flights {
    fn new(reading: Reading, criteria: String) -> Self {
        Self { reading: Arc::new(reading), criteria, distinct: Arc::default() }
    }

    /// Each flight once; what contradicts another one is refused.
    pub(crate) fn distinct(&self) -> &Reading {
        self.distinct.get_or_init(|| distinct(self.reading.as_ref().clone()))
    }

    /// The same flights, compared with each other without the interpreter's lock. What that warns of was raised where they were read
    /// ([`Self::look_through`]): here it would be raised again of a selection.
    fn compared(&self, py: Python<'_>) -> &Self {
        py.detach(|| self.distinct());
        self
    }

    fn segments_columns(&self) -> Columns {
        let mut flights: Vec<&FlightRead> = self.distinct().flights.iter().collect();
        flights.sort_by(|one, other| one.order(other));
        let rows: Vec<SegmentRow> = flights
            .into_iter()
            .flat_map(|flight| &flight.reduced.segments)
            .map(|segment| SegmentRow { segment: segment.clone(), evaluated: None })
            .collect();
        segments_table::table(&rows, segments_table::engines_of(&rows))
    }
}

/// Refusals as Python takes them.
pub(crate) fn refused_rows(refused: &[RefusedReport]) -> Vec<RefusedRow> {
    refused
        .iter()
        .map(|one| (one.path.display().to_string(), one.line, one.column, one.reason.clone()))
        .collect()
}
