//! The recording's own clock: what time it is where the rows are, whatever single times say.

use flight::Timestamp;

use super::batch::instant_of;
use super::instants::DAY_S;
use super::rows::Times;
use super::{Layout, Recording, Text};
use crate::mapping::plan::{Plan, TimeForm};
use crate::refusal::{Found, Refusal, RefusalKind};

/// Without a gap that the mapping states: of samples, and of averaged points, of which a flight may have few. Our choice.
const GAP_OF_SAMPLES_S: f64 = 10_800.0;
const GAP_OF_POINTS_S: f64 = 43_200.0;
/// Of times of day, which repeat: not more than a quarter of a day.
const LONGEST_GAP_OF_DAY_S: f64 = 21_600.0;

/// The median of the last three changes of flight: one wrong time does not move it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clock {
    changes_s: [Option<f64>; 3],
    /// After this long without a row a flight has ended, s.
    pub(super) gap_s: f64,
    is_of_day: bool,
}

impl Clock {
    /// A clock for the times of a layout, before any change.
    pub(super) fn new(plan: &Plan) -> Self {
        let gap_s = plan.longest_gap_s();
        let is_of_day = matches!(plan.time, TimeForm::TimeOfDay { .. });
        let gap_s = if is_of_day { gap_s.min(LONGEST_GAP_OF_DAY_S) } else { gap_s };
        Self { changes_s: [None; 3], gap_s, is_of_day }
    }

    /// The flight changes at this time.
    pub(super) fn change(&mut self, time_s: f64) {
        self.changes_s.rotate_right(1);
        self.changes_s[0] = Some(time_s);
    }

    /// The median; `None` before three changes.
    pub(super) fn now_s(&self) -> Option<f64> {
        let [Some(newest), Some(middle), Some(oldest)] = self.changes_s else { return None };
        let (middle, oldest) = (self.since_s(middle, newest), self.since_s(oldest, newest));
        let (lower, upper) = (middle.min(oldest), middle.max(oldest));
        Some(newest + lower.max(0.0).min(upper))
    }

    /// From one time to another; of times of day at most half a day, forwards or backwards.
    pub(super) fn since_s(&self, later_s: f64, earlier_s: f64) -> f64 {
        let since_s = later_s - earlier_s;
        if self.is_of_day { since_s - DAY_S * (since_s / DAY_S).round() } else { since_s }
    }
}

impl Plan {
    /// The longest time without a row within a flight, s: as the mapping states it, or the usual one.
    pub(in crate::mapping) fn longest_gap_s(&self) -> f64 {
        let usual_s = if self.points.is_some() { GAP_OF_POINTS_S } else { GAP_OF_SAMPLES_S };
        self.new_flight_after_s.unwrap_or(usual_s)
    }
}

impl Layout {
    /// Refuses the time of a row.
    pub(in crate::mapping) fn refuse_time(
        &self,
        recording: &Recording,
        row: usize,
        found: Found,
        kind: RefusalKind,
    ) -> Refusal {
        let line = recording.lines.at(row);
        self.refuse_field((line, &recording.line(line)), self.fields.time, found, kind)
    }

    /// Where most rows of a recording lack a number that the report needs: the first of those, at the column that most of them lack.
    pub(in crate::mapping) fn lacking(&self, recording: &Recording) -> Option<Refusal> {
        let name = recording.lacking.as_ref()?;
        let input = self.plan.inputs.iter().position(|input| input.name == *name)?;
        let line = recording.first_left_out?;
        let kind = RefusalKind::SourceColumnEmpty { name: name.clone() };
        let found = Found::Rows(recording.left_out);
        let refusal = || {
            self.refuse_field((line, &recording.line(line)), self.fields.inputs[input], found, kind)
        };
        (recording.left_out > recording.time_s.len()).then(refusal)
    }

    /// Whether a column tells the tails.
    pub(super) const fn tells_tails(&self) -> bool {
        matches!(self.fields.texts[1].1, Text::Field(_))
    }

    /// The time of a row on the clock that all flights share.
    pub(super) fn clock_s(&self, times: &Times, row: usize) -> f64 {
        match (times, &self.plan.time) {
            (Times::Seconds(times), TimeForm::Seconds { start, .. }) => {
                seconds(*start) + times[row]
            }
            (Times::OfDay(times), TimeForm::TimeOfDay { midnight }) => {
                seconds(*midnight) + times[row]
            }
            (Times::Seconds(times) | Times::OfDay(times), _) => times[row],
            (Times::Instants(times), _) => seconds(times[row]),
            (Times::Nanoseconds(times), _) => seconds(instant_of(times[row]).unwrap_or_default()),
        }
    }
}

impl Recording {
    /// First and last time on the clock that all flights share.
    pub(super) fn span_s(&self) -> Option<(f64, f64)> {
        let origin_s = seconds(self.origin);
        Some((origin_s + self.time_s.first()?, origin_s + self.time_s.last()?))
    }
}

fn seconds(instant: Timestamp) -> f64 {
    instant.as_second() as f64 + f64::from(instant.subsec_nanosecond()) / 1e9
}
