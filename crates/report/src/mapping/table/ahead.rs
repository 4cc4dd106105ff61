//! Rows whose time is far ahead of those before them, behind which the flight goes on where it was.
//!
//! All of this is rare, and kept out of what reads every row. Which of the two is wrong is known when as many rows went on in line
//! as there were ahead: the fewer ones are left out.

use core::ops::Range;
use std::sync::Arc;

use super::flights::field_of;
use super::rows::Times;
use super::{Layout, Recording};
use crate::mapping::file::BadRows;
use crate::mapping::numbers::Block;
use crate::refusal::{Found, Refusal, RefusalKind};

/// Where a recording goes back behind a step of more than this, times before it may be wrong and not those behind, s: clocks are set
/// back by less. Our choice.
const FAR_AHEAD_S: f64 = 600.0;
/// Rows ahead up to which another flight is not begun with them, where the mapping begins one behind a gap. Our choice.
const MOST_AHEAD: usize = 1000;

/// Rows that are far ahead of the one before them, and of those behind them, which may yet be fewer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ahead {
    from: usize,
    to: usize,
}

/// Rows that are left out: how many, and why the first of them is.
pub(super) type LeftOut = (usize, Refusal);

/// Whether a time goes on behind the row before others that are ahead of both: by no more than these last.
fn is_in_line(time_s: f64, before_s: f64, (first_s, last_s): (f64, f64)) -> bool {
    time_s > before_s
        && time_s < first_s
        && (first_s >= last_s || time_s - before_s <= last_s - first_s + FAR_AHEAD_S)
}

impl Recording {
    /// Whether rows are held that may be left out for those behind them, or these for them.
    pub(super) const fn is_undecided(&self) -> bool {
        self.ahead.is_some()
    }

    /// Whether the flight goes on at a time that is not behind its last row, because the last rows are ahead; these are then held.
    #[inline(never)]
    pub(super) fn goes_on_at(&mut self, time_s: f64, layout: &Layout) -> bool {
        let rows = self.time_s.as_slice();
        let from = rows.partition_point(|row_s| *row_s < time_s);
        let (Some(before_s), Some(first_s), Some(last_s)) =
            (from.checked_sub(1).map(|row| rows[row]), rows.get(from), rows.last())
        else {
            return false;
        };
        let goes_on = self.ahead.is_none()
            && layout.plan.bad_rows == BadRows::LeaveRowOut
            && first_s - before_s > FAR_AHEAD_S
            && is_in_line(time_s, before_s, (*first_s, *last_s));
        if goes_on {
            self.ahead = Some(Ahead { from, to: rows.len() });
        }
        goes_on
    }

    /// Whether the row of this time, behind a gap, and those with it are ahead of the rows that come next, and not more than these.
    #[inline(never)]
    pub(super) fn is_ahead_for_a_while(
        &mut self,
        layout: &Layout,
        times: &Times,
        (first_s, behind): (f64, Range<usize>),
    ) -> bool {
        let day = (self.days, self.last_time_of_day_s);
        let before_s = self.time_s.last().copied().unwrap_or(f64::NEG_INFINITY);
        let (mut ahead, mut last_s) = (1, first_s);
        let mut in_line: Option<(usize, f64)> = None;
        for row in behind {
            let time_s = self.seconds(layout, times, row);
            match in_line {
                Some((rows, line_s)) if time_s > line_s && time_s < first_s => {
                    in_line = Some((rows + 1, time_s));
                }
                None if ahead == 1 && time_s <= first_s => in_line = Some((1, time_s)),
                None if is_in_line(time_s, before_s, (first_s, last_s)) => {
                    in_line = Some((1, time_s));
                }
                None if time_s > last_s => (ahead, last_s) = (ahead + 1, time_s),
                _ => {}
            }
            if ahead > MOST_AHEAD || in_line.is_some_and(|(rows, _)| rows >= ahead) {
                break;
            }
        }
        (self.days, self.last_time_of_day_s) = day;
        in_line.is_some_and(|(rows, _)| rows >= ahead)
    }

    /// Leaves out the rows ahead where as many went on behind them, and those behind where one of them is past the rows ahead or, at
    /// the flight's end, as they are fewer.
    #[inline(never)]
    pub(super) fn decide(&mut self, layout: &Layout, is_end: bool) -> Option<LeftOut> {
        let Ahead { from, to } = self.ahead?;
        let last = self.time_s.len().checked_sub(1)?;
        let behind_s = *self.time_s.get(to)?;
        let (ahead, behind) = (to - from, last + 1 - to);
        let caught_up = self.time_s[last] >= self.time_s[to - 1];
        let (rows, kind) = if caught_up || (is_end && behind < ahead) {
            let previous = self.time_s[to - 1];
            let end = if caught_up { last } else { last + 1 };
            (to..end, RefusalKind::TimeNotIncreasing { previous, unit: "s" })
        } else if behind >= ahead {
            (from..to, RefusalKind::TimeAhead { next: behind_s, unit: "s" })
        } else {
            return None;
        };
        self.ahead = None;
        let line = self.lines.at(rows.start);
        let text = self.line(line).into_owned();
        let found = Found::text(&field_of(layout, &text, layout.fields.time));
        let refusal = layout.refuse_field((line, &text), layout.fields.time, found, kind);
        let left_out = (rows.len(), refusal);
        self.take_out(rows);
        Some(left_out)
    }

    /// Counts rows that are left out, and keeps why the first is.
    pub(super) fn leave_out(&mut self, (rows, refusal): LeftOut) {
        self.bad += rows;
        self.first_bad.get_or_insert(refusal);
    }

    /// Takes out rows that are among the last ones.
    fn take_out(&mut self, rows: Range<usize>) {
        let behind = rows.end..self.time_s.len();
        let lines: Vec<usize> = behind.clone().map(|row| self.lines.at(row)).collect();
        let inputs = 0..self.numbers.inputs();
        let column = |input| behind.clone().map(|row| self.numbers.at(input, row)).collect();
        let kept = Arc::new(Block::new(inputs.map(column).collect()));
        for _ in rows.start..self.time_s.len() {
            self.numbers.pop();
            self.lines.pop();
        }
        self.numbers.extend(&kept, 0..lines.len());
        for line in lines {
            self.lines.push(line);
        }
        self.time_s.drain(rows);
    }
}
