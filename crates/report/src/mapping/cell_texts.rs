//! Cells of tables as texts: runs of the same, dates, times of day.

use flight::Timestamp;

/// Texts, each with the number of rows that it holds for.
pub fn text_runs<T: AsRef<str> + Into<String>>(
    texts: impl IntoIterator<Item = T>,
) -> Vec<(String, usize)> {
    let mut runs: Vec<(String, usize)> = Vec::new();
    for text in texts {
        match runs.last_mut() {
            Some((last, count)) if *last == *text.as_ref() => *count += 1,
            _ => runs.push((text.into(), 1)),
        }
    }
    runs
}

/// `YYYY-MM-DD` of seconds since 1970.
#[must_use]
pub fn date_text(seconds: i64) -> String {
    let midnight = Timestamp::from_second(seconds).ok();
    midnight.map_or_else(String::new, |instant| instant.to_string().chars().take(10).collect())
}

/// `hh:mm:ss.sss` of a time of day, of which a count is so many nanoseconds.
#[must_use]
pub fn time_of_day_text(count: i64, each: i64) -> String {
    let milliseconds = count.saturating_mul(each) / 1_000_000;
    let seconds = milliseconds / 1000;
    let (hours, minutes, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    format!("{hours:02}:{minutes:02}:{second:02}.{:03}", milliseconds % 1000)
}
