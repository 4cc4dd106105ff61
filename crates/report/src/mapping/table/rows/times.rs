//! The time of a row, in the form that the mapping states.

use super::super::instants::{DAY_S, formatted, in_one, time_of_day_s, with_sign};
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
                let text = in_one(date, text, sent.as_deref());
                let instant = match format {
                    None => self.cache.instant(&text, offset),
                    // The form is that of date and time; what is behind them is the offset.
                    Some(format) => {
                        let text = in_one(date, row.field(field), None);
                        formatted(&text, format, sent.as_deref().or(offset))
                    }
                };
                times.push(instant.ok_or_else(malformed)?);
            }
            _ => return Err(malformed()),
        }
        Ok(())
    }
}
