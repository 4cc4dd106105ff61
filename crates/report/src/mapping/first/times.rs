//! The column and the form of time.

use super::columns::Columns;

/// Where spreadsheets begin to count days (the day before 1 January 1900 would be 0 if 1900 were no leap year, as they take it).
const SPREADSHEET_DAY_0: &str = "1899-12-30T00:00:00Z";
/// Days that spreadsheets count to 1980 and to 2100.
const SPREADSHEET_DAYS: core::ops::Range<f64> = 29_221.0..73_051.0;

/// The day on which a recording without date is taken to begin while it is looked at.
const ANY_DAY: &str = "2000-01-01";
/// What is then written, which no mapping is read with.
const NO_DAY: &str = "YYYY-MM-DD";

const TIME_NAMES: [&str; 15] = [
    "timestamp",
    "datetime",
    "utcdatetime",
    "utc",
    "plotdate",
    "time",
    "ts",
    "t",
    "seconds",
    "flighttime",
    "times",
    "lcltime",
    "localtime",
    "zeitutc",
    "zeit",
];
const DATE_NAMES: [&str; 5] = ["date", "utcdate", "lcldate", "localdate", "datum"];
const OFFSET_NAMES: [&str; 3] = ["utcofst", "utcoffset", "utcofs"];

impl Columns {
    pub(super) fn time_column(&self) -> Option<usize> {
        self.named(&TIME_NAMES).or_else(|| self.column_of_dates())
    }

    pub(super) fn date_column(&self) -> Option<usize> {
        self.named(&DATE_NAMES)
    }

    pub(super) fn time(&self) -> String {
        let Some(column) = self.time_column() else {
            return format!("Seconds(column: \"TIME\", start: \"{ANY_DAY}T00:00:00Z\"),   // ?");
        };
        let name = &self.names[column].sent;
        let date = self.date_column();
        let sample = self.texts_of(column).find(|text| !text.is_empty()).unwrap_or_default();
        let form = self.date_form(column);
        let with_zone = sample.ends_with('Z') || sample.contains('+');
        match self.number(sample) {
            Some(number) if number > 1e17 => format!("Epoch(column: {name:?}, unit: \"ns\"),"),
            Some(number) if number > 1e14 => format!("Epoch(column: {name:?}, unit: \"us\"),"),
            Some(number) if number > 1e11 => format!("Epoch(column: {name:?}, unit: \"ms\"),"),
            Some(number) if number > 1e8 => format!("Epoch(column: {name:?}, unit: \"s\"),"),
            _ if self.counts_days(column) => {
                format!("Days(column: {name:?}, start: {SPREADSHEET_DAY_0:?}),   // ?")
            }
            Some(_) => {
                format!("Seconds(column: {name:?}, start: \"{ANY_DAY}T00:00:00Z\"),   // ?")
            }
            None if sample.contains('-') => {
                let mark = if with_zone { "" } else { "   // ?" };
                format!("Timestamp(column: {name:?}, utc_offset: \"Z\"),{mark}")
            }
            None => match (form, date) {
                (Some((form, mark)), _) => format!(
                    "Timestamp(column: {name:?}, format: {form:?}, utc_offset: \"Z\"),{mark}"
                ),
                (None, Some(date)) => {
                    // Without a form the date is ISO.
                    let form = self.date_form(date);
                    let (form, of_form) = form.map_or_else(Default::default, |(form, mark)| {
                        (format!(" format: {form:?},"), mark)
                    });
                    let (offset, of_offset) = self.offset();
                    let mark = if of_form.is_empty() { of_offset } else { of_form };
                    let date = &self.names[date].sent;
                    format!("Timestamp(column: {name:?}, date: {date:?},{form} {offset}),{mark}")
                }
                (None, None) => format!(
                    "TimeOfDay(column: {name:?}, date: {ANY_DAY:?}, utc_offset: \"Z\"),   // ?"
                ),
            },
        }
    }

    /// The entry that tells how far the recording's clock is from UTC, and the mark of a guess.
    fn offset(&self) -> (String, &'static str) {
        self.named(&OFFSET_NAMES).map_or_else(
            || ("utc_offset: \"Z\"".to_owned(), "   // ?"),
            |column| (format!("utc_offset_column: {:?}", self.names[column].sent), ""),
        )
    }

    /// Whether a column's numbers are days of a spreadsheet: of these decades, with decimals as a second of a day needs them.
    pub(super) fn counts_days(&self, column: usize) -> bool {
        let is_day =
            |text: &str| self.number(text).is_some_and(|number| SPREADSHEET_DAYS.contains(&number));
        let has_decimals = |text: &str| {
            text.rsplit_once(self.decimal).is_some_and(|(_, decimals)| decimals.len() >= 5)
        };
        let known = || self.texts_of(column).filter(|text| !text.is_empty());
        known().all(is_day) && known().any(has_decimals)
    }

    /// The form of dates with slashes or points, and the mark of a guess: day first unless a number says otherwise, of twelve hours
    /// where the text ends in AM or PM. `None` of other texts.
    fn date_form(&self, column: usize) -> Option<(String, &'static str)> {
        let first = self.texts_of(column).find(|text| !text.is_empty())?;
        let mark = ['/', '.'].into_iter().find(|mark| numbers_of_date(first, *mark).is_some())?;
        let dates = || self.texts_of(column).filter_map(|text| numbers_of_date(text, mark));
        let month_first = dates().any(|[_, second, _]| second > 12);
        let day_first = dates().any(|[first, ..]| first > 12);
        let [one, other] = if month_first { ["%m", "%d"] } else { ["%d", "%m"] };
        let year = if dates().all(|[.., year]| year < 100) { "%y" } else { "%Y" };
        let clock = if first.ends_with(['M', 'm']) { "%I:%M:%S %p" } else { "%H:%M:%S" };
        let guess = if month_first || day_first {
            "   // ?"
        } else {
            "   // ? %d is the day, %m the month"
        };
        Some((format!("{one}{mark}{other}{mark}{year} {clock}"), guess))
    }
}

/// The mapping without the day that no column holds.
pub(super) fn without_day(mapping: &str) -> String {
    let any_day = format!("\"{ANY_DAY}");
    mapping.replacen(&any_day, &format!("\"{NO_DAY}"), 1)
}

/// The same mapping with seconds since a day as seconds of the day, which begin again at midnight.
pub(super) fn of_day(mapping: &str) -> String {
    let since = format!(", start: \"{ANY_DAY}T00:00:00Z\"),   // ?");
    let of_day = format!(", date: {ANY_DAY:?}, utc_offset: \"Z\"),   // ?");
    mapping.replacen("time: Seconds(", "time: TimeOfDay(", 1).replacen(&since, &of_day, 1)
}

/// The numbers of a date that have a mark between them.
fn numbers_of_date(text: &str, mark: char) -> Option<[u32; 3]> {
    let date = text.split([' ', 'T']).next()?;
    let numbers: Result<Vec<u32>, _> = date.split(mark).map(str::parse).collect();
    numbers.ok()?.try_into().ok()
}
