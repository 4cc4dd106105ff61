//! Rows put together into flights, in the order of the recording.

use std::sync::Arc;

use super::ahead::LeftOut;
use super::clock::Clock;
#[cfg(test)]
use super::open::Limits;
use super::open::{Arrival, Gone, Open};
use super::rows::{Event, Rows};
use super::{Layout, Recording, Text};
use crate::mapping::file::BadRows;
use crate::mapping::numbers::Block;
use crate::mapping::pieces::Piece;
use crate::refusal::{Found, Refusal, RefusalKind};

/// The flights that are not yet at their end, and where the rows end.
#[derive(Debug, Default)]
pub(in crate::mapping) struct Assembly {
    current: Option<Box<Recording>>,
    open: Open,
    /// `None` before the first change of flight.
    clock: Option<Clock>,
    /// The numbers of the piece that is being added.
    numbers: Arc<Block>,
    /// Flights that have ended.
    ended: Vec<Recording>,
    /// Number of the last line, and its length in characters.
    end: (usize, usize),
    /// Rows of the longest flight.
    pub(in crate::mapping) longest: usize,
    /// Of all flights that have ended: rows, those that could not be read, and the first refusal.
    rows: usize,
    bad: usize,
    first_bad: Option<Refusal>,
}

impl Assembly {
    /// For a recording that begins with this piece.
    pub(in crate::mapping) fn new(first: &Piece) -> Self {
        Self { end: first.end(), ..Self::default() }
    }

    /// The same with other limits.
    #[cfg(test)]
    pub(in crate::mapping) const fn limit(&mut self, limits: Limits) {
        self.open.limits = limits;
    }

    /// Adds the rows of the next piece. The flights before a refusal are among the ended ones.
    ///
    /// # Errors
    /// The first row that is bad, where the mapping refuses such rows.
    pub(in crate::mapping) fn add(
        &mut self,
        layout: &Layout,
        mut rows: Rows,
    ) -> Result<(), Refusal> {
        self.numbers = Arc::new(core::mem::take(&mut rows.block));
        let added = self.add_piece(layout, &rows);
        if added.is_err() {
            self.stop(layout);
        }
        added
    }

    /// Reading stops before the recording's end: gives out the flights that are over.
    pub(in crate::mapping) fn stop(&mut self, layout: &Layout) {
        if !self.open.alternates {
            self.open.give_out_all();
            self.end_given_out(layout);
        }
    }

    fn add_piece(&mut self, layout: &Layout, rows: &Rows) -> Result<(), Refusal> {
        self.open.read(&rows.piece);
        if !rows.piece.is_empty() {
            self.end = rows.piece.end();
        } else if let Some(line) = rows.lines.last() {
            self.end = (line, 0);
        }
        if let Some(current) = &mut self.current {
            current.keep(&rows.piece)?;
        }
        let mut from = 0;
        for (index, (before, event)) in rows.events.iter().enumerate() {
            self.add_rows(layout, rows, from..*before)?;
            from = *before;
            match event {
                Event::Texts(texts) => {
                    let mut behind = rows.events[index + 1..].iter();
                    let next = behind.find(|(_, event)| matches!(event, Event::Texts(_)));
                    let end = next.map_or(rows.times.len(), |next| next.0);
                    let row = (end > *before).then_some(*before);
                    self.go_on_with(layout, texts, (rows, row))?;
                }
                Event::WithoutTime(line) => {
                    let recording = self.current(layout);
                    recording.left_out += 1;
                    recording.first_left_out.get_or_insert(*line);
                }
                Event::Bad(refusal) => self.leave_out(layout, (1, Refusal::clone(refusal)))?,
            }
        }
        self.add_rows(layout, rows, from..rows.times.len())
    }

    /// The flights that have ended since the last call.
    pub(in crate::mapping) fn take_ended(&mut self) -> Vec<Recording> {
        core::mem::take(&mut self.ended)
    }

    /// Ends all flights.
    pub(in crate::mapping) fn finish(&mut self, layout: &Layout) {
        self.open.give_out_all();
        self.end_given_out(layout);
        if let Some(current) = self.current.take() {
            self.end_flight(layout, *current);
        }
    }

    /// Why the first bad row was left out, where most rows were: what is wrong is then the mapping, and not the rows.
    pub(in crate::mapping) fn most_are_bad(&self) -> Option<Refusal> {
        self.first_bad.clone().filter(|_| self.bad > self.rows)
    }

    /// Refuses behind the last line.
    pub(in crate::mapping) fn refuse_end(&self, found: Found, kind: RefusalKind) -> Refusal {
        Refusal { line: self.end.0.max(1), column: self.end.1 + 1, found, kind }
    }

    fn end_flight(&mut self, layout: &Layout, mut recording: Recording) {
        if let Some(left_out) = recording.decide(layout, true) {
            recording.leave_out(left_out);
        }
        self.longest = self.longest.max(recording.time_s.len());
        self.rows += recording.time_s.len();
        self.bad += recording.bad;
        if self.first_bad.is_none() {
            self.first_bad.clone_from(&recording.first_bad);
        }
        self.ended.push(recording);
    }

    fn end_given_out(&mut self, layout: &Layout) {
        for recording in self.open.given_out() {
            self.end_flight(layout, recording);
        }
    }

    /// The rows from here on are of the flight with these texts, the first of them at `row`.
    fn go_on_with(
        &mut self,
        layout: &Layout,
        texts: &Arc<[String; 3]>,
        (rows, row): (&Rows, Option<usize>),
    ) -> Result<(), Refusal> {
        let same = self.current.as_ref().filter(|current| current.is_of(texts));
        if same.is_some_and(|current| !current.time_s.is_empty()) {
            return Ok(());
        }
        let time_s = row.map(|row| layout.clock_s(&rows.times, row));
        let mut clock = self.clock.unwrap_or_else(|| Clock::new(&layout.plan));
        let fewest = layout.plan.fewest_rows();
        let refused = |gone: Gone| refuse_coming_back(layout, (rows, row), texts, gone);
        if same.is_some() {
            // It began with lines without a time.
            let arrival = Arrival { clock: &clock, time_s, fewest };
            return self.open.refuse_gone(texts, arrival).map_err(refused);
        }
        if let Some(time_s) = time_s {
            clock.change(time_s);
        }
        self.clock = Some(clock);
        self.open.tails_are_told = layout.tells_tails();
        if let Some(before) = self.current.take() {
            self.open.stop(before, true, &clock);
        }
        let arrival = Arrival { clock: &clock, time_s, fewest };
        let found = self.open.take(texts, arrival).map_err(refused)?;
        let mut next =
            found.unwrap_or_else(|| Recording::new(Arc::clone(texts), layout.plan.inputs.len()));
        next.keep(&rows.piece)?;
        self.open.settle(&clock, &next);
        self.current = Some(next);
        self.end_given_out(layout);
        Ok(())
    }

    /// Another flight with the same texts, as long after the one before as the mapping asks for.
    fn begin(
        &mut self,
        layout: &Layout,
        texts: &Arc<[String; 3]>,
        rows: &Rows,
    ) -> Result<(), Refusal> {
        let mut next = Recording::new(Arc::clone(texts), layout.plan.inputs.len());
        next.keep(&rows.piece)?;
        if let Some(before) = self.current.take() {
            let clock = self.clock.unwrap_or_else(|| Clock::new(&layout.plan));
            self.open.stop(before, false, &clock);
            self.open.settle(&clock, &next);
            self.end_given_out(layout);
        }
        self.current = Some(next);
        Ok(())
    }

    /// The flight to which a row belongs; of rows that say none, one without a name.
    fn current(&mut self, layout: &Layout) -> &mut Recording {
        self.current.get_or_insert_with(|| Recording::new(Arc::default(), layout.plan.inputs.len()))
    }

    #[inline(never)]
    fn leave_out(&mut self, layout: &Layout, left_out: LeftOut) -> Result<(), Refusal> {
        // A recording that breaks off in a row is still being copied: its last flight is not whole.
        let is_cut_off = matches!(left_out.1.kind, RefusalKind::LastRowUnfinished { .. });
        if is_cut_off || layout.plan.bad_rows == BadRows::Refuse {
            return Err(left_out.1);
        }
        self.current(layout).leave_out(left_out);
        Ok(())
    }

    /// Adds rows one behind the other, as far as their time follows.
    fn add_rows(
        &mut self,
        layout: &Layout,
        rows: &Rows,
        range: core::ops::Range<usize>,
    ) -> Result<(), Refusal> {
        if range.is_empty() {
            return Ok(());
        }
        let longest_s = layout.plan.new_flight_after_s.unwrap_or(f64::INFINITY);
        let numbers = Arc::clone(&self.numbers);
        let read = (rows, &numbers);
        let recording = self.current(layout);
        if recording.extend_times(layout, &rows.times, range.clone(), longest_s) {
            recording.extend(read, range);
            return Ok(());
        }
        let mut from = range.start;
        for row in range.clone() {
            let recording = self.current(layout);
            let mut time_s = recording.seconds(layout, &rows.times, row);
            let previous_s = recording.time_s.last().copied();
            let gap_s = previous_s.map_or(0.0, |previous| time_s - previous);
            let is_gap = layout.plan.new_flight_after_s.is_some_and(|longest_s| gap_s > longest_s);
            // A gap behind which rows go back is none: one of the two is left out.
            let behind = (time_s, row + 1..range.end);
            if is_gap && !recording.is_ahead_for_a_while(layout, &rows.times, behind) {
                recording.extend(read, from..row);
                from = row;
                let texts = Arc::clone(&recording.texts);
                self.begin(layout, &texts, rows)?;
                time_s = self.current(layout).seconds(layout, &rows.times, row);
            } else if let Some(previous) = previous_s
                && time_s <= previous
            {
                recording.extend(read, from..row);
                from = row;
                if !recording.goes_on_at(time_s, layout) {
                    from = row + 1;
                    let refusal = not_increasing(layout, rows, row, previous);
                    self.leave_out(layout, (1, refusal))?;
                    continue;
                }
            }
            let recording = self.current(layout);
            recording.time_s.push(time_s);
            if recording.is_undecided() {
                recording.extend(read, from..row + 1);
                from = row + 1;
                if let Some(left_out) = recording.decide(layout, false) {
                    self.leave_out(layout, left_out)?;
                }
            }
        }
        self.current(layout).extend(read, from..range.end);
        Ok(())
    }
}

/// Refuses a row of a flight that was given out, at the text by which the flight is known.
fn refuse_coming_back(
    layout: &Layout,
    (rows, row): (&Rows, Option<usize>),
    texts: &[String; 3],
    gone: Gone,
) -> Refusal {
    // A row without a time is not refused.
    let line = row.map_or(rows.piece.first_line, |row| rows.lines.at(row));
    let field = layout.fields.texts.iter().rev().find_map(|(_, text)| match text {
        Text::Field(field) => Some(*field),
        Text::Constant(_) => None,
    });
    let field = field.unwrap_or_default();
    let found = Found::text(&format!("{} {}", texts[1], texts[2]));
    let kind = RefusalKind::FlightCameBack { last_line: gone.line, limit: gone.limit };
    layout.refuse_field((line, &rows.piece.line(line)), field, found, kind)
}

fn not_increasing(layout: &Layout, rows: &Rows, row: usize, previous: f64) -> Refusal {
    let line = rows.lines.at(row);
    let text = rows.piece.line(line);
    let field = layout.fields.time;
    let found = Found::text(&field_of(layout, &text, field));
    let kind = RefusalKind::TimeNotIncreasing { previous, unit: "s" };
    layout.refuse_field((line, &text), field, found, kind)
}

pub(super) fn field_of(layout: &Layout, line: &str, field: usize) -> String {
    let mut reader = super::reader(layout.form(), line);
    let record = reader.records().next().and_then(Result::ok).unwrap_or_default();
    record.get(field).unwrap_or_default().to_owned()
}
