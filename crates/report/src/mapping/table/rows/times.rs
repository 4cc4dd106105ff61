//! The time of a row, in the form that the mapping states.

use flight::Timestamp;

use super::super::instants::{
    DAY_S, EARLIEST_S, formatted, in_one, time_of_day_s, with_day_and_month_exchanged, with_sign,
};
use super::{FARTHEST_S, Row, Rows, Times};
use crate::mapping::plan::TimeForm;
use crate::refusal::{Found, Refusal, RefusalKind};

impl Rows {
    /// Adds the time of a row.
    pub(super) fn add_time(&mut self, row: Row<'_>) -> Result<(), Refusal> {
        let layout = row.layout;
        let field = layout.fields.time;
        let text = row.field(field);
        let place = (row.line, &self.piece);
        let malformed =
            || row.refuse(place, field, Found::text(text), RefusalKind::SourceInstantMalformed);
        match (&mut self.times, &layout.plan.time) {
            (Times::Seconds(times), TimeForm::Seconds { count, .. }) => {
                let number = row.number(field, &layout.plan.time_column, place)?;
                let seconds = count.seconds(number);
                if seconds.abs() > FARTHEST_S {
                    return Err(malformed());
                }
                times.push(seconds);
            }
            (Times::OfDay(times), _) if text.contains(':') => {
                times.push(time_of_day_s(text).ok_or_else(malformed)?);
            }
            (Times::OfDay(times), _) => {
                let seconds = row.number(field, &layout.plan.time_column, place)?;
                if !(0.0..=DAY_S).contains(&seconds) {
                    return Err(malformed());
                }
                times.push(seconds);
            }
            (Times::Instants(times), TimeForm::Timestamp { format, utc_offset, .. }) => {
                let offset = utc_offset.as_deref();
                let date = layout.fields.date.map(|date| row.field(date));
                let sent = layout.fields.offset.map(|offset| with_sign(row.field(offset)));
                let joined = in_one(date, text, sent.as_deref());
                // The form is that of date and time; what is behind them is the offset.
                let by_form = |format: &str| {
                    formatted(&in_one(date, text, None), format, sent.as_deref().or(offset))
                };
                let instant = match format {
                    None => self.cache.instant(&joined, offset),
                    Some(format) => by_form(format),
                };
                let refused = || {
                    let swapped = format.as_deref().map(with_day_and_month_exchanged);
                    let is_swapped = swapped.is_some_and(|format| by_form(&format).is_some());
                    let kind = if is_swapped {
                        RefusalKind::SourceDayAndMonth
                    } else {
                        RefusalKind::SourceInstantMalformed
                    };
                    // Where the time of day can be read it is the date that is wrong.
                    match (date, layout.fields.date) {
                        (Some(date), Some(field)) if time_of_day_s(text).is_some() => {
                            row.refuse(place, field, Found::text(date), kind)
                        }
                        _ => row.refuse(place, field, Found::text(text), kind),
                    }
                };
                let is_of_flights = |instant: &Timestamp| instant.as_second() >= EARLIEST_S;
                times.push(instant.filter(is_of_flights).ok_or_else(refused)?);
            }
            _ => return Err(malformed()),
        }
        Ok(())
    }
}
