//! Flights whose rows may go on: in a recording that is sorted by time alone, the rows of several aircraft alternate.
//!
//! As long as no flight has come back, the rows of each are taken to be together: a flight is kept back at its end only while
//! little is kept, and flights are given out in their order, so that a sorted recording takes no more memory than its longest
//! flight. From the first flight that comes back on, a flight ends when it has had no row for the gap between flights, by the
//! recording's own clock. What was given out is remembered by its times: a flight is never read as two without a word.
//! One aircraft does not fly twice at a time: where a column tells the tails, a flight is over when its tail has flown the next one,
//! and the same name behind that is another flight.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Recording;
use super::clock::Clock;
use crate::mapping::pieces::Piece;
use crate::refusal::FlightLimit;

/// Aircraft, tail, flight.
type Texts = Arc<[String; 3]>;

/// How much may be held.
#[derive(Clone, Copy, Debug)]
pub(in crate::mapping) struct Limits {
    /// Of flights that seem to be over, while none has come back, bytes of numbers.
    pub(in crate::mapping) kept_bytes: usize,
    /// Flights open at once.
    pub(in crate::mapping) flights: usize,
    /// Of them, bytes of numbers and text.
    pub(in crate::mapping) bytes: usize,
}

/// Text that flights which seem to be over may keep, for each byte of numbers.
const TEXT_FOR_NUMBERS: usize = 8;
/// Rows of a tail under another name for less than that are no flight that it has flown meanwhile, s. Our choice.
const SHORTEST_FLIGHT_S: f64 = 600.0;
/// What a flight takes without a row, about.
const FLIGHT_BYTES: usize = 512;

impl Default for Limits {
    fn default() -> Self {
        Self { kept_bytes: 1 << 20, flights: 1 << 14, bytes: 1 << 29 }
    }
}

/// Flights that are not the current one.
#[derive(Debug, Default)]
pub(super) struct Open {
    pub(super) limits: Limits,
    /// By when they stopped, from the longest ago on.
    order: BTreeMap<usize, Stopped>,
    /// Those that may come back.
    places: BTreeMap<Texts, usize>,
    /// How many have stopped.
    stops: usize,
    /// Bytes of numbers of all.
    numbers: usize,
    /// Pieces that may be held: first line, bytes of text.
    texts: BTreeMap<usize, usize>,
    text: usize,
    /// Whether a flight has come back.
    pub(super) alternates: bool,
    /// Whether a column tells the tails.
    pub(super) tails_are_told: bool,
    /// The flight of each tail that stopped last.
    of_tails: BTreeMap<String, Texts>,
    given_out: Vec<Recording>,
    gone: BTreeMap<Texts, Vec<Gone>>,
    /// The clock and the stops when it was last looked for flights that have ended.
    looked: Option<(f64, usize)>,
}

#[derive(Debug)]
struct Stopped {
    /// Of rows that alternate, one stops with each of them: it stays where it is.
    recording: Box<Recording>,
    /// The clock when it stopped: the end of a flight without a row.
    clock_s: Option<f64>,
    may_go_on: bool,
    /// Whether a row that is not of it has its texts: a wrong time, behind which it goes on.
    may_come_back: bool,
}

/// A flight that was given out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gone {
    span_s: (f64, f64),
    rows: usize,
    /// Of its last row.
    pub(super) line: usize,
    pub(super) limit: FlightLimit,
}

/// What a row says of the flight that it belongs to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival<'c> {
    pub(super) clock: &'c Clock,
    /// `None` where it has no time.
    pub(super) time_s: Option<f64>,
    /// Rows that make a flight.
    pub(super) fewest: usize,
}

impl Arrival<'_> {
    /// Whether a flight of this span goes on with the row. A row before its first one, or within, does: its time is refused. One
    /// that begins at the same instant again is a copy, or of a recording that counts time from the start of each flight.
    fn is_of(self, span_s: (f64, f64), rows: usize) -> bool {
        let Some(time_s) = self.time_s else { return true };
        let after_first_s = self.clock.since_s(time_s, span_s.0);
        let after_last_s = self.clock.since_s(time_s, span_s.1);
        let begins_again = after_first_s == 0.0 && rows >= self.fewest;
        !begins_again && -after_first_s <= self.clock.gap_s && after_last_s <= self.clock.gap_s
    }
}

impl Open {
    /// A piece that was read.
    pub(super) fn read(&mut self, piece: &Piece) {
        let bytes = piece.text_bytes();
        if bytes > 0 {
            self.texts.insert(piece.first_line, bytes);
            self.text += bytes;
        }
    }

    /// A flight stops being the current one, for good or not.
    pub(super) fn stop(&mut self, recording: Box<Recording>, may_go_on: bool, clock: &Clock) {
        self.stops += 1;
        self.numbers += bytes_of(&recording);
        if self.tails_are_told {
            self.end_before_of_tail(&recording, clock);
        }
        if may_go_on {
            self.places.insert(Arc::clone(&recording.texts), self.stops);
        } else {
            self.remember(&recording, FlightLimit::Gap { gap_s: clock.gap_s });
        }
        let clock_s = clock.now_s();
        let stopped = Stopped { recording, clock_s, may_go_on, may_come_back: false };
        self.order.insert(self.stops, stopped);
    }

    /// The flight with these texts, if it goes on with the row.
    ///
    /// # Errors
    /// It was given out already.
    pub(super) fn take(
        &mut self,
        texts: &Texts,
        arrival: Arrival<'_>,
    ) -> Result<Option<Box<Recording>>, Gone> {
        if let Some(place) = self.places.remove(texts) {
            let goes_on = self.order.get(&place).is_some_and(|stopped| {
                let recording = &stopped.recording;
                recording
                    .span_s()
                    .is_none_or(|span_s| arrival.is_of(span_s, recording.time_s.len()))
            });
            if goes_on {
                self.alternates = true;
                return Ok(self.remove(place).map(|stopped| stopped.recording));
            }
            // It is over, whether or not it was given out.
            if let Some(mut stopped) = self.order.remove(&place) {
                (stopped.may_go_on, stopped.may_come_back) = (false, true);
                let limit = FlightLimit::Gap { gap_s: arrival.clock.gap_s };
                self.remember(&stopped.recording, limit);
                self.order.insert(place, stopped);
            }
        }
        match self.refuse_gone(texts, arrival) {
            Ok(()) => Ok(None),
            Err(gone) => self.come_back(texts, arrival).map(Some).ok_or(gone),
        }
    }

    /// The flight with these texts that seemed to be over by a row with a wrong time, if it is still held and goes on with this one.
    fn come_back(&mut self, texts: &Texts, arrival: Arrival<'_>) -> Option<Box<Recording>> {
        let goes_on = |stopped: &Stopped| {
            let recording = &stopped.recording;
            let span_s = recording.span_s().filter(|_| recording.texts == *texts);
            stopped.may_come_back
                && span_s.is_some_and(|span_s| arrival.is_of(span_s, recording.time_s.len()))
        };
        let place = *self.order.iter().rev().find(|(_, stopped)| goes_on(stopped))?.0;
        let recording = self.remove(place)?.recording;
        if let (Some(gone), Some(line)) = (self.gone.get_mut(texts), recording.lines.last()) {
            gone.retain(|gone| gone.line != line);
        }
        self.alternates = true;
        Some(recording)
    }

    /// Refuses a row of a flight that was given out.
    ///
    /// # Errors
    /// That flight.
    pub(super) fn refuse_gone(&self, texts: &Texts, arrival: Arrival<'_>) -> Result<(), Gone> {
        let mut gone = self.gone.get(texts).into_iter().flatten();
        let found = gone.find(|gone| arrival.is_of(gone.span_s, gone.rows));
        match found {
            Some(gone) if arrival.time_s.is_some() => Err(*gone),
            _ => Ok(()),
        }
    }

    /// Gives out what has ended, and what is too much to hold.
    pub(super) fn settle(&mut self, clock: &Clock, current: &Recording) {
        let Limits { kept_bytes, flights, bytes } = self.limits;
        if !self.alternates {
            let kept_text = TEXT_FOR_NUMBERS * kept_bytes;
            while self.numbers > kept_bytes
                || (self.text > kept_text && self.held_text(current) > kept_text)
            {
                if !self.give_out_first(FlightLimit::KeptBytes(kept_bytes)) {
                    break;
                }
            }
            return;
        }
        self.give_out_ended(clock);
        while self.order.len() > flights {
            self.give_out_first(FlightLimit::OpenFlights(flights));
        }
        if self.numbers + self.text > bytes {
            // A sixteenth more, so that it is not done at every row.
            while self.numbers + self.held_text(current) > bytes - bytes / 16 {
                if !self.give_out_first(FlightLimit::OpenBytes(bytes)) {
                    break;
                }
            }
        }
    }

    /// Gives out all.
    pub(super) fn give_out_all(&mut self) {
        while self.give_out_first(FlightLimit::KeptBytes(self.limits.kept_bytes)) {}
    }

    /// The flights that were given out since the last call.
    pub(super) fn given_out(&mut self) -> Vec<Recording> {
        core::mem::take(&mut self.given_out)
    }

    /// Flights of which the clock has passed the last row by the gap. All are looked at only when it has moved by some of the gap,
    /// and about as many rows were read as there are flights.
    fn give_out_ended(&mut self, clock: &Clock) {
        let Some(now_s) = clock.now_s() else { return };
        let is_soon = self.looked.is_some_and(|(looked_s, stops)| {
            let moved_s = clock.since_s(now_s, looked_s).abs();
            moved_s < clock.gap_s / 8.0 || self.stops - stops < self.order.len() / 4
        });
        let has_ended = |stopped: &Stopped| {
            let last_s = stopped.recording.span_s().map(|(_, last_s)| last_s).or(stopped.clock_s);
            let is_past = |last_s| clock.since_s(now_s, last_s) > clock.gap_s;
            !(stopped.may_go_on || stopped.may_come_back) || last_s.is_some_and(is_past)
        };
        if is_soon {
            return;
        }
        self.looked = Some((now_s, self.stops));
        let order = self.order.iter();
        let ended: Vec<usize> =
            order.filter(|(_, stopped)| has_ended(stopped)).map(|(place, _)| *place).collect();
        for place in ended {
            self.give_out(place, FlightLimit::Gap { gap_s: clock.gap_s });
        }
    }

    fn give_out_first(&mut self, limit: FlightLimit) -> bool {
        let first = self.order.first_key_value().map(|(place, _)| *place);
        first.is_some_and(|place| self.give_out(place, limit))
    }

    fn give_out(&mut self, place: usize, limit: FlightLimit) -> bool {
        let Some(stopped) = self.remove(place) else { return false };
        let recording = stopped.recording;
        if stopped.may_go_on {
            self.places.remove(&recording.texts);
            self.remember(&recording, limit);
        }
        self.given_out.push(*recording);
        true
    }

    /// The flight of a tail that stopped before this one is over if this one began behind it, and was flown.
    fn end_before_of_tail(&mut self, recording: &Recording, clock: &Clock) {
        let Some((first_s, last_s)) = recording.span_s() else { return };
        if clock.since_s(last_s, first_s) < SHORTEST_FLIGHT_S {
            return;
        }
        let texts = &recording.texts;
        let Some(before) = self.of_tails.insert(texts[1].clone(), Arc::clone(texts)) else {
            return;
        };
        if before == *texts {
            return;
        }
        let is_behind = |(_, last_s): (f64, f64)| clock.since_s(first_s, last_s) > 0.0;
        if let Some(place) = self.places.get(&before)
            && let Some(stopped) = self.order.get_mut(place)
            && stopped.recording.span_s().is_some_and(is_behind)
        {
            stopped.may_go_on = false;
            self.places.remove(&before);
        }
        if let Some(gone) = self.gone.get_mut(&before) {
            gone.retain(|gone| !is_behind(gone.span_s));
            if gone.is_empty() {
                self.gone.remove(&before);
            }
        }
    }

    /// Keeps of a flight that is over what its rows are known by, should they come back.
    fn remember(&mut self, recording: &Recording, limit: FlightLimit) {
        if let (Some(span_s), Some(line)) = (recording.span_s(), recording.lines.last()) {
            let gone = Gone { span_s, rows: recording.time_s.len(), line, limit };
            self.gone.entry(Arc::clone(&recording.texts)).or_default().push(gone);
        }
    }

    fn remove(&mut self, place: usize) -> Option<Stopped> {
        let stopped = self.order.remove(&place)?;
        self.numbers -= bytes_of(&stopped.recording);
        Some(stopped)
    }

    /// Bytes of text from the first piece on that a flight holds.
    fn held_text(&mut self, current: &Recording) -> usize {
        let stopped = self.order.values().map(|stopped| &*stopped.recording);
        let firsts = stopped.chain([current]).filter_map(|recording| recording.pieces.first());
        let first = firsts.map(|piece| piece.first_line).min().unwrap_or(usize::MAX);
        while let Some(piece) = self.texts.first_entry()
            && *piece.key() < first
        {
            self.text -= piece.remove();
        }
        self.text
    }
}

fn bytes_of(recording: &Recording) -> usize {
    // A time and, of rows that alternate, a run of lines.
    let each = recording.numbers.bytes_of_row() + 3 * size_of::<f64>();
    let rows = recording.time_s.len() * each;
    FLIGHT_BYTES + rows + recording.pieces.len() * size_of::<Piece>()
}
