//! `EVENTS.csv`: what was done to which tail, and when.

use flight::Timestamp;
use jiff::civil::Date;
use jiff::tz::TimeZone;
use monitor::Bearing;
use serde::{Deserialize, Serialize};

/// An event.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    /// When: the instant given, or the beginning of the day (UTC). Flights that begin at or after it are after the event.
    #[serde(with = "instant_text")]
    pub time: Timestamp,
    /// The tail.
    pub tail: String,
    /// What: wash, `engine_change`, weighing, …
    pub kind: String,
    /// In the operator's words; may be empty.
    pub note: String,
}

/// Words of kinds that change the airframe, or what is known of it, and no single engine.
const OF_AIRFRAME: [&str; 12] = [
    "wash", "polish", "paint", "weighing", "retrofit", "winglet", "rigging", "seal", "flap",
    "slat", "cabin", "interior",
];
/// Words of kinds that are done again and again to burn less.
const TO_BURN_LESS: [&str; 4] = ["wash", "clean", "rinse", "polish"];
/// Words of kinds and notes that change engines.
const OF_ENGINES: [&str; 4] = ["engine", "compressor", "turbine", "nacelle"];

impl Event {
    /// What the event can have to do with the fuel flow of one engine (from 1): nothing where it names others ("engine 2" in kind
    /// or note); it is likely where it is of engines.
    #[must_use]
    pub fn bearing_on_engine(&self, engine: usize) -> Bearing {
        let named = engines_named(&self.text());
        if !named.is_empty() && !named.contains(&engine) {
            Bearing::None
        } else if self.names_engines() {
            Bearing::Likely
        } else {
            Bearing::Possible
        }
    }

    /// Whether the event is known to be of the airframe: it changes the fuel flow of every engine by as much.
    #[must_use]
    pub fn is_of_airframe(&self) -> bool {
        let kind = self.kind.to_lowercase();
        OF_AIRFRAME.iter().any(|word| kind.contains(word)) && !self.names_engines()
    }

    /// Whether the event is one of those that are done again and again to burn less: what wears in between they take back.
    #[must_use]
    pub fn is_to_burn_less(&self) -> bool {
        let kind = self.kind.to_lowercase();
        TO_BURN_LESS.iter().any(|word| kind.contains(word))
    }

    pub(super) fn names_engines(&self) -> bool {
        let text = self.text();
        OF_ENGINES.iter().any(|word| text.contains(word)) || !engines_named(&text).is_empty()
    }

    fn text(&self) -> String {
        format!("{} {}", self.kind, self.note).to_lowercase()
    }
}

/// The numbers behind a word for engines: `engine 2`, `engines 1 and 2`, `ENG#1`, `engine_2_change`.
fn engines_named(text: &str) -> Vec<usize> {
    /// No aircraft has more: a longer number is that of a part.
    const MOST: usize = 8;
    let words =
        text.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty());
    let (mut named, mut is_behind) = (Vec::new(), false);
    for word in words {
        let number = word.trim_start_matches("engines").trim_start_matches("engine");
        let number = number.trim_start_matches("eng");
        let is_word = number.len() < word.len();
        let found = number.parse().ok().filter(|engine| (1..=MOST).contains(engine));
        match found {
            Some(engine) if is_word || is_behind => {
                named.push(engine);
                is_behind = true;
            }
            _ => is_behind = (is_word && number.is_empty()) || (is_behind && word == "and"),
        }
    }
    named
}

/// Names tails that have events and of which no flight is at hand: a name that is spelt otherwise would be measured nowhere.
pub fn warn_of_events(events: &[Event], is_known: impl Fn(&str) -> bool) {
    let mut warned: Vec<&str> = Vec::new();
    for event in events {
        if !is_known(&event.tail) && !warned.contains(&event.tail.as_str()) {
            warned.push(&event.tail);
            tracing::warn!(tail = event.tail, "has events, but no flight");
        }
    }
}

/// An instant as RFC 3339 text.
mod instant_text {
    use flight::Timestamp;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(value: &Timestamp, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(value)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Timestamp, D::Error> {
        String::deserialize(from)?.parse().map_err(serde::de::Error::custom)
    }
}

/// Why a text is not a table of events.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EventsError {
    /// Not comma-separated values.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// A quote that is open where the text ends: every later event would be part of a note.
    #[error(
        "line {line}: a quote opens in this row and is never closed; expected \"\" for a quote inside a field"
    )]
    QuoteOpen {
        /// Physical line from 1.
        line: u64,
    },
    /// A column is missing.
    #[error("line 1: found columns {found}, expected date,tail,kind,note")]
    Columns {
        /// The header.
        found: String,
    },
    /// A column twice.
    #[error("line 1: found column {name} twice, expected it once")]
    Doubled {
        /// Its name.
        name: &'static str,
    },
    /// A field that is not what its column holds.
    #[error("line {line}, column {column}: found {found:?}, expected {expected}")]
    Field {
        /// Physical line from 1.
        line: u64,
        /// Name of the column.
        column: &'static str,
        /// The field.
        found: String,
        /// What such a field holds.
        expected: &'static str,
    },
}

const COLUMNS: [&str; 4] = ["date", "tail", "kind", "note"];

/// Reads `date,tail,kind,note`, in any order of columns; other columns are left alone, `note` may be missing.
///
/// # Errors
/// [`EventsError`] with line, column, what was found and what is expected.
pub fn read_events(bytes: &[u8]) -> Result<Vec<Event>, EventsError> {
    if let Some(line) = perf_model::open_quote(bytes) {
        return Err(EventsError::QuoteOpen { line });
    }
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let header = reader.headers()?.clone();
    let place = |name: &str| header.iter().position(|known| known == name);
    let places = COLUMNS.map(place);
    if places[..3].iter().any(Option::is_none) {
        let found = header.iter().collect::<Vec<_>>().join(",");
        return Err(EventsError::Columns { found });
    }
    let count = |name: &&str| header.iter().filter(|known| known == name).count();
    if let Some(name) = COLUMNS.into_iter().find(|name| count(name) > 1) {
        return Err(EventsError::Doubled { name });
    }
    let mut events = Vec::new();
    for record in reader.records() {
        let record = record?;
        let line = record.position().map_or(0, csv::Position::line);
        let text = |column: usize| {
            places[column].and_then(|place| record.get(place)).unwrap_or_default().to_owned()
        };
        let wrong = |column: usize, expected| EventsError::Field {
            line,
            column: COLUMNS[column],
            found: text(column),
            expected,
        };
        let time = instant(&text(0)).ok_or_else(|| {
            wrong(0, "a date such as 2026-03-02, or an instant such as 2026-03-02T21:30Z")
        })?;
        for (column, expected) in [(1, "a tail"), (2, "a kind of event such as wash")] {
            if text(column).is_empty() {
                return Err(wrong(column, expected));
            }
        }
        events.push(Event { time, tail: text(1), kind: text(2), note: text(3) });
    }
    events.sort_by(|one, other| {
        (one.time, &one.tail, &one.kind).cmp(&(other.time, &other.tail, &other.kind))
    });
    Ok(events)
}

/// An instant as events have it: with its offset (`2026-03-02T10:00:00Z`), or a date, whose day begins at 00:00 UTC; `None` for
/// anything else.
#[must_use]
pub fn instant(text: &str) -> Option<Timestamp> {
    if let Ok(time) = text.parse() {
        return Some(time);
    }
    // A civil date with a time but without an offset would be read as a date alone: refused.
    let date: Date = if text.len() == 10 { text.parse().ok()? } else { return None };
    Some(date.to_zoned(TimeZone::UTC).ok()?.timestamp())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An inch mark in front of a note once took every later event with it.
    #[test]
    fn a_quote_that_stays_open_is_refused_with_its_line() {
        let text = "date,tail,kind,note\n2026-01-02,T,wash,\"un\n2026-01-03,T,wash,b\n";
        let error = read_events(text.as_bytes()).unwrap_err();
        assert!(error.to_string().starts_with("line 2: a quote opens"), "{error}");
    }

    #[test]
    fn what_an_event_can_change_on_an_engine() {
        let event = |kind: &str, note: &str| Event {
            time: Timestamp::UNIX_EPOCH,
            tail: "T".to_owned(),
            kind: kind.to_owned(),
            note: note.to_owned(),
        };
        for (kind, note, of_first, of_second, of_airframe) in [
            ("wash", "", Bearing::Possible, Bearing::Possible, true),
            ("wash", "compressors of both", Bearing::Likely, Bearing::Likely, false),
            ("engine_change", "", Bearing::Likely, Bearing::Likely, false),
            ("engine_change", "engine 2, serial 1", Bearing::None, Bearing::Likely, false),
            ("exchange", "ENG#1", Bearing::Likely, Bearing::None, false),
            ("engine_2_change", "", Bearing::None, Bearing::Likely, false),
            ("hot section", "engines 1 and 2", Bearing::Likely, Bearing::Likely, false),
            ("engine_wash", "hangar 3", Bearing::Likely, Bearing::Likely, false),
            ("meters", "", Bearing::Possible, Bearing::Possible, false),
        ] {
            let event = event(kind, note);
            let bearings = [1, 2].map(|engine| event.bearing_on_engine(engine));
            assert_eq!(
                (bearings, event.is_of_airframe()),
                ([of_first, of_second], of_airframe),
                "{event:?}"
            );
            assert_eq!(event.is_to_burn_less(), kind.contains("wash"), "{event:?}");
        }
    }

    #[test]
    fn events_are_read_in_order() {
        let text = "tail,date,kind,note,shop\nT-2,2026-03-02,wash,\"hangar 3, night\",X\n\
                    T-1,2026-01-31T21:30:00+01:00,engine_change,,\n";
        let events = read_events(text.as_bytes()).unwrap();
        assert_eq!(events[0].time.to_string(), "2026-01-31T20:30:00Z");
        assert_eq!((events[0].kind.as_str(), events[0].note.as_str()), ("engine_change", ""));
        assert_eq!(events[1].time.to_string(), "2026-03-02T00:00:00Z");
        assert_eq!(events[1].note, "hangar 3, night");
        assert!(read_events(b"date,tail,kind\n2026-03-02,T,wash\n").is_ok());
    }

    #[test]
    fn wrong_events_are_refused_with_their_position() {
        let error = |text: &str| read_events(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(
            error("date,tail,kind,note\n2026-03-02,T,wash,\n02.03.2026,T,wash,\n"),
            "line 3, column date: found \"02.03.2026\", expected a date such as 2026-03-02, or an instant such as \
             2026-03-02T21:30Z"
        );
        assert!(error("date,tail,kind,note\n2026-03-02,,wash,\n").contains("line 2, column tail"));
        assert!(error("date,tail\n").contains("found columns date,tail"));
        // The second one would be left out in silence.
        assert_eq!(
            error("date,date,tail,kind\n2026-03-02,2026-06-04,T,wash\n"),
            "line 1: found column date twice, expected it once"
        );
        assert!(read_events(b"date,tail,kind,X,X\n2026-03-02,T,wash,1,2\n").is_ok());
    }
}
