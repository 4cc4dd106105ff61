//! Instants and times of day from text.

use std::borrow::Cow;

use flight::Timestamp;

use crate::cruise_text::parse_instant;
use crate::number;

/// Seconds of a day; a leap second or the end of one is the next day's midnight.
pub(super) const DAY_S: f64 = 86_400.0;

/// The year 1950: what is recorded before it has a year of two digits, or another epoch, s since 1970. Our choice.
pub(in crate::mapping) const EARLIEST_S: i64 = -631_152_000;

/// A form of dates with the other order.
pub(super) fn with_day_and_month_exchanged(format: &str) -> String {
    format.replace("%d", "%?").replace("%m", "%d").replace("%?", "%m")
}

/// A date, a time and an offset from UTC as one text, as far as they are in columns of their own.
pub(super) fn in_one<'t>(date: Option<&str>, time: &'t str, offset: Option<&str>) -> Cow<'t, str> {
    match (date, offset) {
        (None, None) => Cow::Borrowed(time),
        (date, offset) => {
            let (date, offset) = (date.unwrap_or_default(), offset.unwrap_or_default());
            Cow::Owned(format!("{date} {time}{offset}").trim_start().to_owned())
        }
    }
}

/// An offset from UTC with its sign, which may be left away where it is east.
pub(super) fn with_sign(offset: &str) -> Cow<'_, str> {
    if offset.starts_with(|first: char| first.is_ascii_digit()) {
        Cow::Owned(format!("+{offset}"))
    } else {
        Cow::Borrowed(offset)
    }
}

/// The last minute that was read: the instants of a recording differ in their seconds for most of the time.
#[derive(Debug, Default)]
pub(super) struct InstantCache {
    /// Up to the colon before the seconds.
    to_minute: String,
    /// Behind the seconds.
    behind: String,
    /// The instant at second 0.
    minute: Option<Timestamp>,
}

impl InstantCache {
    /// Where the seconds are in `YYYY-MM-DD hh:mm:ss`.
    const SECONDS: core::ops::Range<usize> = 17..19;

    /// ISO text with `T` or a blank between date and time, with its own offset or with `utc_offset`.
    pub(super) fn instant(&mut self, text: &str, utc_offset: Option<&str>) -> Option<Timestamp> {
        let seconds = text.as_bytes().get(Self::SECONDS).and_then(|digits| match digits {
            [tens @ b'0'..=b'5', ones @ b'0'..=b'9'] => {
                Some(i64::from(10 * (tens - b'0') + (ones - b'0')))
            }
            _ => None,
        });
        let Some((seconds, parts)) =
            seconds.zip(text.get(..Self::SECONDS.start).zip(text.get(Self::SECONDS.end..)))
        else {
            return instant(text, utc_offset);
        };
        if let Some(minute) = self.minute
            && (self.to_minute.as_str(), self.behind.as_str()) == parts
        {
            return Timestamp::new(minute.as_second() + seconds, minute.subsec_nanosecond()).ok();
        }
        let instant = instant(text, utc_offset)?;
        // Before 1970 seconds and their fraction have one sign: such instants are read one by one.
        self.minute = (instant.as_second() > 60)
            .then(|| Timestamp::new(instant.as_second() - seconds, instant.subsec_nanosecond()))
            .and_then(Result::ok);
        (self.to_minute, self.behind) = (parts.0.to_owned(), parts.1.to_owned());
        Some(instant)
    }
}

/// ISO text with `T` or a blank between date and time, with its own offset or with `utc_offset`.
fn instant(text: &str, utc_offset: Option<&str>) -> Option<Timestamp> {
    let with_t = text.replacen(' ', "T", 1);
    parse_instant(&with_t).or_else(|| parse_instant(&(with_t + utc_offset?)))
}

/// Text of a form as `strptime` names it; an offset in the text counts more than `utc_offset`.
#[inline(never)]
pub(super) fn formatted(text: &str, format: &str, utc_offset: Option<&str>) -> Option<Timestamp> {
    let broken = jiff::fmt::strtime::parse(format, text).ok()?;
    if broken.offset().is_some() {
        return broken.to_timestamp().ok();
    }
    parse_instant(&(broken.to_datetime().ok()?.to_string() + utc_offset?))
}

/// Hours, minutes and seconds, separated by colons; s.
pub(super) fn time_of_day_s(text: &str) -> Option<f64> {
    let mut fields = text.split(':').map(|field| number::whole(field.as_bytes()));
    let (hours, minutes) = (fields.next()??, fields.next()??);
    let seconds = fields.next().unwrap_or(Some(0.0))?;
    let is_within = (0.0..24.0).contains(&hours)
        && (0.0..60.0).contains(&minutes)
        && (0.0..61.0).contains(&seconds)
        && fields.next().is_none();
    is_within.then_some(3600.0 * hours + 60.0 * minutes + seconds)
}
