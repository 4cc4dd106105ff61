//! `flights/TAIL.csv`: the flights that a tail has learnt, in the order in which it learnt them. The model's ledger
//! with the end of each flight, in a file that is read in no time.

use crate::columns::Columns;
use crate::csv_cell;
use crate::model_file::LedgerEntry;
use diagnose::GaugeBurn;
use flight::{Segment, Timestamp};

/// A flight that was learnt.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownFlight {
    /// Its entry in the model's ledger.
    pub entry: LedgerEntry,
    /// The instant of TIME 0.
    pub start: Timestamp,
    /// The instant of its last sample.
    pub end: Timestamp,
}

impl KnownFlight {
    /// Whether this flight and another interval of time have more than an instant in common.
    pub fn overlaps(&self, start: Timestamp, end: Timestamp) -> bool {
        self.start < end && start < self.end
    }
}

/// The table.
pub fn to_csv(flights: &[KnownFlight]) -> Vec<u8> {
    let mut columns = Columns::default();
    let entries = || flights.iter().map(|known| &known.entry);
    columns.text("flight", entries().map(|entry| &entry.flight));
    columns.text("start", entries().map(|entry| &entry.start));
    columns.text("end", flights.iter().map(|known| known.end.to_string()));
    columns.text("content", entries().map(|entry| &entry.content));
    columns.count("samples", entries().map(|entry| entry.samples));
    columns.count("segments", entries().map(|entry| entry.segments));
    columns.count("outside_table", entries().map(|entry| entry.outside_table));
    let gauges =
        |of: fn(&GaugeBurn) -> f64| entries().map(move |entry| entry.gauges.as_ref().map(of));
    if entries().any(|entry| entry.gauges.is_some()) {
        columns.number("gauged_kg", gauges(|gauges| gauges.gauged_kg));
        columns.number("metered_kg", gauges(|gauges| gauges.metered_kg));
        columns.number("gauged_std_kg", gauges(|gauges| gauges.deviation_kg));
    }
    columns.to_csv()
}

/// The flights of a table.
///
/// # Errors
/// What a field holds that it cannot.
pub fn read(tail: &str, bytes: &[u8]) -> Result<Vec<KnownFlight>, String> {
    begun(tail, bytes, |_| true)
}

/// Those of them that are wanted by their START: of the others nothing is read but that.
///
/// # Errors
/// As for [`read`].
pub fn begun(
    tail: &str,
    bytes: &[u8],
    is_wanted: impl Fn(&str) -> bool,
) -> Result<Vec<KnownFlight>, String> {
    let mut reader = csv::ReaderBuilder::new().from_reader(bytes);
    let mut flights = Vec::new();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(|error| error.to_string())? {
        if !record.get(1).is_some_and(&is_wanted) {
            continue;
        }
        let text = |field: usize| record.get(field).unwrap_or_default();
        let wrong = |field: usize| {
            let line = record.position().map_or(0, csv::Position::line);
            format!("line {line}, field {}: found {:?}", field + 1, text(field))
        };
        let instant = |field: usize| text(field).parse::<Timestamp>().map_err(|_| wrong(field));
        let count = |field: usize| text(field).parse::<u64>().map_err(|_| wrong(field));
        let number = |field: usize| text(field).parse::<f64>().map_err(|_| wrong(field));
        // Columns that are there where any flight has gauges.
        let gauges = if text(7).is_empty() {
            None
        } else {
            Some(GaugeBurn {
                gauged_kg: number(7)?,
                metered_kg: number(8)?,
                deviation_kg: number(9)?,
            })
        };
        flights.push(KnownFlight {
            start: instant(1)?,
            end: instant(2)?,
            entry: LedgerEntry {
                tail: tail.to_owned(),
                flight: csv_cell::read(text(0)).into_owned(),
                start: text(1).to_owned(),
                content: text(3).to_owned(),
                samples: count(4)?,
                segments: count(5)?,
                outside_table: count(6)?,
                gauges,
            },
        });
    }
    Ok(flights)
}

/// The flights of a ledger of an older folder: where each ends is known from its last segment only.
///
/// # Errors
/// A START that is no instant.
pub fn of_ledger(ledger: &[LedgerEntry], segments: &[Segment]) -> Result<Vec<KnownFlight>, String> {
    ledger
        .iter()
        .map(|entry| {
            let start: Timestamp = entry
                .start
                .parse()
                .map_err(|_| format!("START {:?} of the ledger is no instant", entry.start))?;
            let last_s = segments
                .iter()
                .filter(|segment| {
                    segment.identity.start == start && segment.identity.flight == entry.flight
                })
                .map(|segment| segment.means.time_s)
                .fold(0.0, f64::max);
            let end = instant_after(start, last_s).unwrap_or(start);
            Ok(KnownFlight { entry: entry.clone(), start, end })
        })
        .collect()
}

/// The instant some seconds after another; `None` beyond the calendar.
pub fn instant_after(start: Timestamp, seconds: f64) -> Option<Timestamp> {
    let after = std::time::Duration::try_from_secs_f64(seconds.abs()).ok()?;
    if seconds < 0.0 { start.checked_sub(after).ok() } else { start.checked_add(after).ok() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flights_read_back() {
        let known = KnownFlight {
            entry: LedgerEntry {
                tail: "T".to_owned(),
                flight: "a, \"b\"".to_owned(),
                start: "2024-03-01T10:00:00Z".to_owned(),
                content: "read:0123".to_owned(),
                samples: 12,
                segments: 3,
                outside_table: 1,
                gauges: None,
            },
            start: "2024-03-01T10:00:00Z".parse().unwrap(),
            end: "2024-03-01T12:00:00.5Z".parse().unwrap(),
        };
        let csv = to_csv(std::slice::from_ref(&known));
        assert_eq!(read("T", &csv).unwrap(), std::slice::from_ref(&known));
        let wanted = |start: &'static str| begun("T", &csv, move |text| text == start).unwrap();
        assert_eq!(wanted("2024-03-01T10:00:00Z"), std::slice::from_ref(&known));
        assert!(wanted("2024-03-01T12:00:00.5Z").is_empty());
        let changed = String::from_utf8(csv).unwrap().replace(",12,", ",x,");
        assert!(read("T", changed.as_bytes()).unwrap_err().contains("line 2, field 5"));
        let at = |text: &str| text.parse::<Timestamp>().unwrap();
        assert!(known.overlaps(at("2024-03-01T11:00:00Z"), at("2024-03-01T13:00:00Z")));
        // One flight may begin at the instant at which another ends.
        assert!(!known.overlaps(at("2024-03-01T12:00:00.5Z"), at("2024-03-01T13:00:00Z")));
    }

    #[test]
    fn instants_beyond_the_calendar_are_none() {
        let start: Timestamp = "2024-03-01T10:00:00Z".parse().unwrap();
        assert_eq!(instant_after(start, 60.0).unwrap().to_string(), "2024-03-01T10:01:00Z");
        assert_eq!(instant_after(start, -60.0).unwrap().to_string(), "2024-03-01T09:59:00Z");
        assert_eq!(instant_after(start, 1e19), None);
        assert_eq!(instant_after(start, f64::NAN), None);
    }
}
