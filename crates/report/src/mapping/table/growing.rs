//! A flight to which rows are added.

use std::sync::Arc;

use flight::Timestamp;

use super::batch::instant_of;
use super::instants::DAY_S;
use super::rows::{Rows, Times};
use super::{Layout, Recording};
use crate::decode::MAXIMUM_TEXT_BYTES;
use crate::mapping::numbers::Block;
use crate::mapping::pieces::Piece;
use crate::mapping::plan::TimeForm;
use crate::refusal::{Found, Refusal, RefusalKind};

const HALF_A_DAY_S: f64 = 43_200.0;
/// Up to this long without a row, a day less this is a date that stayed at midnight, s. Our choice.
const LONGEST_AT_MIDNIGHT_S: f64 = 3600.0;

impl Recording {
    /// Keeps a piece that holds rows of this flight: a refusal needs the text of its line.
    pub(super) fn keep(&mut self, piece: &Piece) -> Result<(), Refusal> {
        let is_known = |last: &Piece| {
            last.first_line == piece.first_line && last.kept_bytes() == piece.kept_bytes()
        };
        if self.pieces.last().is_some_and(is_known) {
            return Ok(());
        }
        self.kept_bytes += piece.kept_bytes();
        self.pieces.push(piece.clone());
        if self.kept_bytes > MAXIMUM_TEXT_BYTES {
            let kind = RefusalKind::TooLarge { limit_bytes: MAXIMUM_TEXT_BYTES };
            return Err(Refusal {
                line: piece.first_line,
                column: 1,
                found: Found::EndOfText,
                kind,
            });
        }
        Ok(())
    }

    /// Everything but the times of rows.
    pub(super) fn extend(
        &mut self,
        (rows, numbers): (&Rows, &Arc<Block>),
        range: core::ops::Range<usize>,
    ) {
        self.lines.extend(&rows.lines, range.clone());
        self.numbers.extend(numbers, range);
    }

    /// Adds the times of all these rows, if each is later than the one before, by `longest_s` at most: nearly always. Else none
    /// is added.
    pub(super) fn extend_times(
        &mut self,
        layout: &Layout,
        times: &Times,
        range: core::ops::Range<usize>,
        longest_s: f64,
    ) -> bool {
        let before = self.time_s.len();
        // The first row sets the origin.
        let first_s = match times {
            Times::OfDay(_) => return false,
            _ if self.is_undecided() || self.days != 0.0 => return false,
            _ => self.seconds(layout, times, range.start),
        };
        self.time_s.push(first_s);
        let rest = range.start + 1..range.end;
        match times {
            Times::OfDay(_) => {}
            Times::Seconds(times) => self.time_s.extend_from_slice(&times[rest]),
            Times::Instants(times) => {
                self.time_s.extend(times[rest].iter().map(|time| since_s(*time, self.origin)));
            }
            Times::Nanoseconds(times) => {
                let since_s = nanoseconds_since(self.origin);
                self.time_s.extend(times[rest].iter().copied().map(since_s));
            }
        }
        let added = &self.time_s[before.saturating_sub(1)..];
        // Counted, without a way out of the loop: nearly always none is.
        let follows = |earlier: f64, later: f64| later > earlier && later - earlier <= longest_s;
        let pairs = added.iter().zip(&added[1..]);
        let others = pairs.map(|(earlier, later)| u64::from(!follows(*earlier, *later)));
        let follow = others.sum::<u64>() == 0;
        if !follow {
            self.time_s.truncate(before);
        }
        follow
    }

    /// A date in a column of its own may stay while the time of day passes midnight, and follow later.
    #[inline(never)]
    fn pass_midnight(&mut self, sent_s: f64) {
        let Some(last_s) = self.time_s.last() else { return };
        let since_last_s = sent_s + self.days * DAY_S - last_s;
        if since_last_s > -DAY_S && since_last_s < LONGEST_AT_MIDNIGHT_S - DAY_S {
            self.days += 1.0;
        } else if self.days > 0.0 && since_last_s > DAY_S - LONGEST_AT_MIDNIGHT_S {
            self.days -= 1.0;
        }
    }

    /// Seconds since the flight's origin, which its first instant sets.
    #[inline(never)]
    pub(super) fn seconds(&mut self, layout: &Layout, times: &Times, row: usize) -> f64 {
        match times {
            Times::Seconds(times) => {
                if let TimeForm::Seconds { start, .. } = &layout.plan.time {
                    self.origin = *start;
                }
                times[row]
            }
            Times::Instants(times) => {
                if self.time_s.is_empty() {
                    self.origin = times[row];
                }
                let sent_s = since_s(times[row], self.origin);
                if layout.fields.date.is_some() {
                    self.pass_midnight(sent_s);
                }
                sent_s + self.days * DAY_S
            }
            Times::Nanoseconds(times) => {
                if self.time_s.is_empty() {
                    self.origin = instant_of(times[row]).unwrap_or_default();
                }
                nanoseconds_since(self.origin)(times[row])
            }
            Times::OfDay(times) => {
                if let TimeForm::TimeOfDay { midnight } = &layout.plan.time {
                    self.origin = *midnight;
                }
                let seconds = times[row];
                // Later than noon and then earlier: midnight has passed.
                if seconds < self.last_time_of_day_s - HALF_A_DAY_S {
                    self.days += 1.0;
                }
                self.last_time_of_day_s = seconds;
                seconds + self.days * DAY_S
            }
        }
    }
}

fn since_s(instant: Timestamp, origin: Timestamp) -> f64 {
    let seconds = instant.as_second() - origin.as_second();
    let nanoseconds = instant.subsec_nanosecond() - origin.subsec_nanosecond();
    if nanoseconds == 0 {
        return seconds as f64;
    }
    (i128::from(seconds) * 1_000_000_000 + i128::from(nanoseconds)) as f64 / 1e9
}

/// The same of instants in nanoseconds since 1970, to the bit.
fn nanoseconds_since(origin: Timestamp) -> impl Fn(i64) -> f64 {
    /// Up to here every whole number is one of double precision, so that its quotient is rounded once.
    const EXACT: i64 = 1 << 53;
    let from = i64::try_from(origin.as_nanosecond()).ok();
    move |instant| match from.and_then(|from| instant.checked_sub(from)) {
        Some(since) if (-EXACT..EXACT).contains(&since) => since as f64 / 1e9,
        _ => since_s(instant_of(instant).unwrap_or_default(), origin),
    }
}
