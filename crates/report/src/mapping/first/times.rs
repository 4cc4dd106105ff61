//! The column and the form of time.

use super::columns::Columns;

/// Where spreadsheets begin to count days (the day before 1 January 1900 would be 0 if 1900 were no leap year, as they take it).
const SPREADSHEET_DAY_0: &str = "1899-12-30T00:00:00Z";
/// Days that spreadsheets count to 1980 and to 2100.
const SPREADSHEET_DAYS: core::ops::Range<f64> = 29_221.0..73_051.0;

const TIME_NAMES: [&str; 11] = [
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
];

impl Columns {
    pub(super) fn time_column(&self) -> Option<usize> {
        self.named(&TIME_NAMES).or_else(|| self.column_of_dates())
    }

    pub(super) fn date_column(&self) -> Option<usize> {
        self.names.iter().position(|name| name.is("date") || name.is("utcdate"))
    }

    pub(super) fn time(&self) -> String {
        let Some(column) = self.time_column() else {
            return "Seconds(column: \"TIME\", start: \"2000-01-01T00:00:00Z\"),   // ?".to_owned();
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
                format!("Seconds(column: {name:?}, start: \"2000-01-01T00:00:00Z\"),   // ?")
            }
            None if sample.contains('-') => {
                let mark = if with_zone { "" } else { "   // ?" };
                format!("Timestamp(column: {name:?}, utc_offset: \"Z\"),{mark}")
            }
            None => match (form, date) {
                (Some(form), _) => format!(
                    "Timestamp(column: {name:?}, format: {form:?}, utc_offset: \"Z\"),   // ?"
                ),
                (None, Some(date)) => format!(
                    "Timestamp(column: {name:?}, date: {:?}, format: {:?}, utc_offset: \"Z\"),   // ?",
                    self.names[date].sent,
                    self.date_form(date).unwrap_or("%Y-%m-%d %H:%M:%S")
                ),
                (None, None) => format!(
                    "TimeOfDay(column: {name:?}, date: \"2000-01-01\", utc_offset: \"Z\"),   // ?"
                ),
            },
        }
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

    /// The form of dates with slashes or points: day first unless a number says otherwise, of twelve hours where the text ends in AM
    /// or PM. `None` of other texts.
    fn date_form(&self, column: usize) -> Option<&'static str> {
        let first = self.texts_of(column).find(|text| !text.is_empty())?;
        let mark = ['/', '.'].into_iter().find(|mark| numbers_of_date(first, *mark).is_some())?;
        let month_first = self
            .texts_of(column)
            .filter_map(|text| numbers_of_date(text, mark))
            .any(|[_, second]| second > 12);
        let twelve_hours = first.ends_with(['M', 'm']);
        Some(match (mark, month_first, twelve_hours) {
            ('/', false, false) => "%d/%m/%Y %H:%M:%S",
            ('/', true, false) => "%m/%d/%Y %H:%M:%S",
            ('/', false, true) => "%d/%m/%Y %I:%M:%S %p",
            ('/', true, true) => "%m/%d/%Y %I:%M:%S %p",
            (_, false, _) => "%d.%m.%Y %H:%M:%S",
            (_, true, _) => "%m.%d.%Y %H:%M:%S",
        })
    }
}

/// The first two numbers of a date whose three numbers have a mark between them.
fn numbers_of_date(text: &str, mark: char) -> Option<[u32; 2]> {
    let date = text.split([' ', 'T']).next()?;
    let numbers: Result<Vec<u32>, _> = date.split(mark).map(str::parse).collect();
    match numbers.ok()?[..] {
        [first, second, _] => Some([first, second]),
        _ => None,
    }
}
