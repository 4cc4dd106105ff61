//! Reduced flights as a table: one row per flight, with its segments or without, and back.
//!
//! A fleet's flights are read once, by many machines, and learnt somewhere else: what lies between is this table.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::slice;
use std::sync::Arc;

use diagnose::GaugeBurn;
use flight::{FlightIdentity, Segment};
use segmenter::Tally;

use crate::check::FlightCheck;
use crate::checksum::sha256;
use crate::columns::Columns;
use crate::csv_cell;
use crate::learnt_flights::instant_after;
use crate::reading::FlightRead;
use crate::reduction::ReducedFlight;
use crate::segments_table::{self, SegmentRow, SegmentsTableError};

/// Separates the notes of a flight, which are sentences without a line end.
const BETWEEN_NOTES: &str = "\n";

/// One row per flight, in the order given; what its reports were reduced to, without the segments.
pub fn table(flights: &[FlightRead]) -> Columns {
    let mut columns = Columns::default();
    let identity = |of: fn(&FlightIdentity) -> String| {
        flights.iter().map(move |flight| of(&flight.reduced.identity))
    };
    columns.text("path", flights.iter().map(|flight| flight.path.display().to_string()));
    columns.text("tail", identity(|identity| identity.tail.clone()));
    columns.text("flight", identity(|identity| identity.flight.clone()));
    columns.text("start", identity(|identity| identity.start.to_string()));
    columns.text("aircraft_type", flights.iter().map(|f| f.reduced.aircraft_type.clone()));
    columns.number("engines", flights.iter().map(|f| f.reduced.engines.map(|n| n as f64)));
    columns.count("samples", flights.iter().map(|flight| flight.reduced.samples as u64));
    columns.count("segments", flights.iter().map(|flight| flight.reduced.segments.len() as u64));
    columns.text("end", flights.iter().map(|flight| flight.end.to_string()));
    columns.text("content", flights.iter().map(|flight| flight.content.clone()));
    columns.text("content_of_file", flights.iter().map(|flight| flight.content_of_file.clone()));
    let gauges = |of: fn(&GaugeBurn) -> f64| {
        flights.iter().map(move |flight| flight.reduced.gauges.as_ref().map(of))
    };
    columns.number("gauged_kg", gauges(|gauges| gauges.gauged_kg));
    columns.number("metered_kg", gauges(|gauges| gauges.metered_kg));
    columns.number("gauged_std_kg", gauges(|gauges| gauges.deviation_kg));
    columns.text("notes", flights.iter().map(|flight| flight.reduced.notes.join(BETWEEN_NOTES)));
    columns
}

/// The same with a column `segments_csv`: each flight's segments as `segments_table` writes them.
pub fn table_with_segments(flights: &[FlightRead]) -> Columns {
    let mut columns = table(flights);
    columns
        .text("segments_csv", flights.iter().map(|flight| segments_text(&flight.reduced.segments)));
    columns
}

/// Flights from the text of [`table_with_segments`]. How many samples each criterion cost, and what was found
/// in the data, is not kept.
///
/// # Errors
/// A missing column or a field that is not what its column holds, with line and column; segments of another flight.
pub fn read(bytes: &[u8]) -> Result<Vec<FlightRead>, FlightsTableError> {
    let mut reader = csv::ReaderBuilder::new().from_reader(bytes);
    let header = reader.headers()?.clone();
    let mut flights = Vec::new();
    for record in reader.records() {
        let record = record?;
        let line = record.position().map_or(0, csv::Position::line);
        flights.push(Row { header: &header, record: &record, line }.flight()?);
    }
    Ok(flights)
}

/// Flights of aircraft of one type from segments alone, in any order: a flight's content, samples and end are those of its
/// segments. A row that is a copy of another is used once: exports may overlap.
pub fn from_segments(segments: Vec<Segment>, aircraft_type: &str) -> Vec<FlightRead> {
    let mut by_flight: BTreeMap<Arc<FlightIdentity>, Vec<Segment>> = BTreeMap::new();
    for segment in segments {
        by_flight.entry(Arc::clone(&segment.identity)).or_default().push(segment);
    }
    let mut copies = 0;
    let flights = by_flight.into_iter().map(|(identity, segments)| {
        let rows = segments.len();
        let segments = each_once(segments);
        copies += rows - segments.len();
        let last_s = segments.iter().map(|segment| segment.means.time_s).fold(0.0, f64::max);
        let content = sha256(segments_text(&segments).as_bytes());
        FlightRead {
            path: PathBuf::from(format!("{} {}", identity.tail, identity.flight)),
            end: instant_after(identity.start, last_s).unwrap_or(identity.start),
            content_of_file: content.clone(),
            content,
            reduced: ReducedFlight {
                check: Some(not_checked(&identity)),
                identity,
                aircraft_type: aircraft_type.to_owned(),
                engines: None,
                samples: segments.iter().map(Segment::samples).sum(),
                segments,
                gauges: None,
                tally: Tally::NOTHING,
                notes: Vec::new(),
            },
        }
    });
    let flights = flights.collect();
    match copies {
        0 => {}
        1 => tracing::warn!("1 row of a table of segments is a copy of another and used once"),
        n => tracing::warn!("{n} rows of a table of segments are copies of others and used once"),
    }
    flights
}

/// The segments of a flight in the order of flying, each once.
fn each_once(mut segments: Vec<Segment>) -> Vec<Segment> {
    segments.sort_by(|one, other| one.means.time_s.total_cmp(&other.means.time_s));
    segments.dedup_by(|one, other| {
        // Rows are compared as they are written, where one number that is missing equals another.
        one.means.time_s.total_cmp(&other.means.time_s).is_eq()
            && segments_text(slice::from_ref(one)) == segments_text(slice::from_ref(other))
    });
    segments
}

/// The check of a flight whose report is not at hand: nothing was found, and no other flight is a copy of it.
fn not_checked(identity: &FlightIdentity) -> FlightCheck {
    let mut hasher = DefaultHasher::new();
    (&identity.tail, &identity.flight, identity.start).hash(&mut hasher);
    FlightCheck {
        instants_s: (identity.start_s(), identity.start_s()),
        fingerprint: hasher.finish(),
        identity: identity.clone(),
        findings: Vec::new(),
    }
}

fn segments_text(segments: &[Segment]) -> String {
    let rows: Vec<SegmentRow> =
        segments.iter().map(|s| SegmentRow { segment: s.clone(), evaluated: None }).collect();
    let bytes = segments_table::table(&rows, segments_table::engines_of(&rows)).to_csv();
    // A table of segments is made of text.
    String::from_utf8_lossy(&bytes).into_owned()
}

struct Row<'a> {
    header: &'a csv::StringRecord,
    record: &'a csv::StringRecord,
    line: u64,
}

impl Row<'_> {
    fn text(&self, column: &'static str) -> Result<&str, FlightsTableError> {
        let place = self.header.iter().position(|name| name == column);
        place
            .and_then(|place| self.record.get(place))
            .ok_or(FlightsTableError::MissingColumn { column })
    }

    /// The text that was written to a field.
    fn plain(&self, column: &'static str) -> Result<String, FlightsTableError> {
        self.text(column).map(|cell| csv_cell::read(cell).into_owned())
    }

    fn parse<T: std::str::FromStr>(&self, column: &'static str) -> Result<T, FlightsTableError> {
        let found = self.text(column)?;
        found.parse().map_err(|_| FlightsTableError::Field {
            line: self.line,
            column,
            found: found.to_owned(),
        })
    }

    fn optional<T: std::str::FromStr>(
        &self,
        column: &'static str,
    ) -> Result<Option<T>, FlightsTableError> {
        if self.text(column)?.is_empty() { Ok(None) } else { self.parse(column).map(Some) }
    }

    fn flight(&self) -> Result<FlightRead, FlightsTableError> {
        let identity = FlightIdentity {
            tail: self.plain("tail")?,
            start: self.parse("start")?,
            flight: self.plain("flight")?,
        };
        let segments = segments_table::read(self.plain("segments_csv")?.as_bytes())
            .map_err(|source| FlightsTableError::Segments { line: self.line, source })?;
        if segments.iter().any(|segment| *segment.identity != identity) {
            return Err(FlightsTableError::OtherFlight { line: self.line });
        }
        let gauges = [
            self.optional("gauged_kg")?,
            self.optional("metered_kg")?,
            self.optional("gauged_std_kg")?,
        ];
        let gauges = match gauges {
            [Some(gauged_kg), Some(metered_kg), Some(deviation_kg)] => {
                Some(GaugeBurn { gauged_kg, metered_kg, deviation_kg })
            }
            _ => None,
        };
        let notes = self.plain("notes")?;
        Ok(FlightRead {
            path: PathBuf::from(self.plain("path")?),
            content: self.text("content")?.to_owned(),
            content_of_file: self.text("content_of_file")?.to_owned(),
            end: self.parse("end")?,
            reduced: ReducedFlight {
                check: Some(not_checked(&identity)),
                identity: Arc::new(identity),
                aircraft_type: self.plain("aircraft_type")?,
                engines: self.optional("engines")?,
                samples: self.parse("samples")?,
                segments,
                gauges,
                tally: Tally::NOTHING,
                notes: notes
                    .split(BETWEEN_NOTES)
                    .filter(|note| !note.is_empty())
                    .map(str::to_owned)
                    .collect(),
            },
        })
    }
}

/// Why a text is no table of flights.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FlightsTableError {
    /// Not a table of comma-separated values.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// A column that every table of flights has is not there.
    #[error("column {column} is missing")]
    MissingColumn {
        /// Its name.
        column: &'static str,
    },
    /// A field that is not what its column holds.
    #[error("line {line}, column {column}: found {found:?}, expected a number or an instant")]
    Field {
        /// Physical line from 1.
        line: u64,
        /// Name of the column.
        column: &'static str,
        /// The field as it is.
        found: String,
    },
    /// The segments of a flight.
    #[error("line {line}, column segments_csv: {source}")]
    Segments {
        /// Physical line from 1.
        line: u64,
        /// What is wrong with them.
        source: SegmentsTableError,
    },
    /// Segments that are not of the flight.
    #[error("line {line}, column segments_csv: found segments of another flight")]
    OtherFlight {
        /// Physical line from 1.
        line: u64,
    },
}
