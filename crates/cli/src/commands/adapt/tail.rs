//! One tail: its reports are read and sorted, its model learns, its files are written to the waiting room.

use std::borrow::Cow;
use std::path::Path;

use flight::Segment;
use pipeline::evaluation::{TailCounts, TailData, TailResult};
use pipeline::learning::{self, FlightToLearn, LearningError};
use pipeline::model_file::{Learnt, LedgerEntry, ModelFile};
use pipeline::segments_table;
use rayon::prelude::*;

use super::Run;
use super::begun::Start;
use super::dates::{self, Dates};
use super::sorting::{Contradictions, Sorting};
use crate::failure::{Failure, RefusedReport};
use crate::files::file_stem_of_tail;
use crate::folder::flights::{self, KnownFlight};
use crate::folder::state::TailState;
use crate::folder::{Folder, StoredTail};
use crate::models::check_engines;
use crate::plausibility;
use crate::reading::heads::Head;
use crate::reading::known::{KnownFlights, entry_of};
use crate::reading::{Buffers, FlightRead, Reading, Source};

/// So many reports of a tail are read before the first of them is learnt.
pub(super) const READ_AT_A_TIME: usize = 64;

/// What a tail came to.
#[derive(Debug, Default)]
pub(super) struct TailOutcome {
    pub(super) tail: String,
    /// What the folder's state has of it; `None` where nothing is stored.
    pub(super) state: Option<TailState>,
    /// Its part of the page, where the page holds the tails' charts.
    pub(super) section: Option<page::Section>,
    pub(super) refused: Vec<RefusedReport>,
    /// Reports that could be read and have a model.
    pub(super) usable: usize,
    pub(super) flights_new: usize,
    pub(super) already_known: usize,
    pub(super) copies: usize,
    /// The first copy, and what it is a copy of.
    pub(super) first_copy: Option<(String, String)>,
}

/// A flight with its segments: what a model is rebuilt from.
#[derive(Clone, Debug)]
pub(crate) struct Material {
    /// The flight.
    pub(crate) known: KnownFlight,
    /// Its segments.
    pub(crate) segments: Vec<Segment>,
}

impl Run<'_> {
    /// Reads, sorts and learns a tail's reports.
    ///
    /// # Errors
    /// A file that cannot be written. What is wrong with this tail alone is in its outcome.
    pub(super) fn learn(
        &self,
        tail: &str,
        start: &Start<'_>,
        heads: Vec<Head>,
        buffers: &mut Buffers,
        side_by_side: bool,
    ) -> Result<TailOutcome, Failure> {
        let paths: Vec<Box<Path>> = heads.iter().map(|head| head.path.clone()).collect();
        let attempt = self.folder.flights(tail).and_then(|known| {
            let (new, refused, already_known) = unknown(heads, &known, buffers);
            let stored = match (self.folder.holds(tail), new.is_empty()) {
                (true, false) => Some(self.folder.load(tail)?),
                _ => None,
            };
            Ok((known, new, refused, already_known, stored))
        });
        let (known, new, refused, already_known, stored) = match attempt {
            Ok(found) => found,
            // A damaged tail costs itself, not the batch.
            Err(failure) => {
                let refuse = |path: Box<Path>| {
                    let reason = format!("tail {tail} is not touched: {failure}");
                    RefusedReport::whole(path.into(), reason)
                };
                let refused = paths.into_iter().map(refuse).collect();
                return Ok(TailOutcome { refused, ..self.untouched(tail) });
            }
        };
        let mut known = KnownFlights::new(known);
        if let Some(stored) = &stored {
            known.add_segments(&stored.segments);
        }
        let mut sorting = Sorting::new(tail, known);
        sorting.strict = self.arguments.reports.strict;
        if self.arguments.relearn {
            sorting.contradictions = Contradictions::Relearn;
        }
        sorting.refused = refused;
        sorting.already_known = already_known;
        let reading = self.plausible(tail, start, &new, buffers, side_by_side);
        sorting.refused.extend(reading.refused);
        let usable = already_known + reading.flights.len();
        for flight in reading.flights {
            sorting.next(flight);
        }
        let outcome = TailOutcome {
            tail: tail.to_owned(),
            usable,
            already_known: sorting.already_known,
            copies: sorting.copies,
            first_copy: sorting.first_copy.take(),
            ..TailOutcome::default()
        };
        self.learn_sorted(start, sorting, stored, outcome)
    }

    /// Reads a tail's reports and sets aside those that its model is not for, or whose dates or figures cannot be right.
    fn plausible(
        &self,
        tail: &str,
        start: &Start<'_>,
        heads: &[Head],
        buffers: &mut Buffers,
        side_by_side: bool,
    ) -> Reading {
        let mut reading = Reading::default();
        for some in heads.chunks(READ_AT_A_TIME) {
            for (flights, refused) in read_some(self.source, some, buffers, side_by_side) {
                reading.refused.extend(refused);
                for flight in flights {
                    if flight.reduced.identity.tail != tail {
                        let reason = "it changed while it was read: another tail than before";
                        reading.refused.push(RefusedReport::whole(flight.path, reason));
                    } else if let Err(reason) = check_engines(start.model, &flight) {
                        reading.refused.push(RefusedReport::whole(flight.path, reason));
                    } else {
                        reading.flights.push(flight);
                    }
                }
            }
        }
        dates::refuse_impossible(&mut reading, flight::Timestamp::now());
        let book = (&start.model.initial, start.model.initial.drag_table());
        plausibility::set_aside_absurd(&mut reading, |_| Some(book), self.arguments.accept);
        reading
    }

    fn learn_sorted(
        &self,
        start: &Start<'_>,
        sorting: Sorting<'_>,
        stored: Option<StoredTail>,
        mut outcome: TailOutcome,
    ) -> Result<TailOutcome, Failure> {
        let tail = outcome.tail.clone();
        outcome.refused = sorting.refused;
        if sorting.new.is_empty() {
            return self.rest(outcome);
        }
        let mut work = Work::new(sorting.warnings);
        let learnt = if sorting.replaced.is_empty() {
            let new = sorting.new.into_iter().map(|(flight, _)| flight).collect();
            work.continued(start, &tail, stored, new)?
        } else {
            work.relearnt(start, &tail, stored, sorting.new, &sorting.replaced)?
        };
        outcome.refused.append(&mut work.refused);
        match learnt {
            Some(learnt) if work.flights_new > 0 => {
                outcome.flights_new = work.flights_new;
                let remember = !self.arguments.no_remainder;
                let mut notes = work.notes;
                let learnt = settled(learnt, remember, &mut notes);
                self.store(&start.begun, learnt, notes, outcome)
            }
            _ => self.rest(outcome),
        }
    }

    /// A tail to which this run adds nothing.
    fn rest(&self, outcome: TailOutcome) -> Result<TailOutcome, Failure> {
        let at_rest = self.at_rest(&outcome.tail)?;
        Ok(TailOutcome { state: at_rest.state, section: at_rest.section, ..outcome })
    }

    /// A tail for which this run has no report: what the folder has of it, written again only where it has to be.
    pub(super) fn at_rest(&self, tail: &str) -> Result<TailOutcome, Failure> {
        let needs_page = self.on_one_page || !self.folder.has(&page_file(tail));
        if !self.folder.holds(tail) || !(needs_page || self.folder.is_older(tail)) {
            return Ok(self.untouched(tail));
        }
        let stored = match self.folder.load(tail) {
            Ok(stored) => stored,
            Err(failure) => {
                tracing::warn!("tail {tail} is not on the page: {failure}");
                return Ok(self.untouched(tail));
            }
        };
        let begun = match self.folder.state_of(tail) {
            Some(state) => state.begun.clone(),
            // Known from now on only by comparing the models themselves.
            None => String::new(),
        };
        let outcome = TailOutcome { tail: tail.to_owned(), ..TailOutcome::default() };
        if self.folder.is_older(tail) {
            return self.store(&begun, stored, Vec::new(), outcome);
        }
        let result = result_of(stored, 0, Vec::new());
        let section = self.page_of(&result)?;
        Ok(TailOutcome { section, ..self.untouched(tail) })
    }

    fn untouched(&self, tail: &str) -> TailOutcome {
        TailOutcome {
            tail: tail.to_owned(),
            state: self.folder.state_of(tail).cloned(),
            ..TailOutcome::default()
        }
    }

    fn store(
        &self,
        begun: &str,
        learnt: StoredTail,
        notes: Vec<String>,
        outcome: TailOutcome,
    ) -> Result<TailOutcome, Failure> {
        let flights = flights::to_csv(&learnt.flights);
        let result = result_of(learnt, outcome.flights_new, notes);
        let section = self.page_of(&result)?;
        let state = stage(self.folder, begun, &result, &flights)?;
        Ok(TailOutcome { state: Some(state), section, ..outcome })
    }

    /// The tail's part of the page, or its own page.
    fn page_of(&self, result: &TailResult) -> Result<Option<page::Section>, Failure> {
        let section = page::section(result, &self.anchors);
        if self.on_one_page {
            return Ok(Some(section));
        }
        self.folder.stage(&page_file(&result.tail), page::tail_page(&section).as_bytes())?;
        Ok(None)
    }
}

/// Reports of flights that are not known, or known with other content; and how many are known.
fn unknown(
    heads: Vec<Head>,
    known: &[KnownFlight],
    buffers: &mut Buffers,
) -> (Vec<Head>, Vec<RefusedReport>, usize) {
    if known.is_empty() {
        return (heads, Vec::new(), 0);
    }
    let known = KnownFlights::new(known.to_vec());
    let mut new = Vec::new();
    let mut refused = Vec::new();
    let mut already_known = 0;
    for head in heads {
        let Some(flight) = known.find(head.start, &head.flight) else {
            new.push(head);
            continue;
        };
        let same = match &head.read {
            Some(read) => Ok(read.has_content(&flight.entry.content)),
            None => buffers.content_of(&head.path).map(|content| content == flight.entry.content),
        };
        match same {
            Ok(true) => already_known += 1,
            Ok(false) => new.push(head),
            Err(refusal) => refused.push(refusal),
        }
    }
    (new, refused, already_known)
}

/// Path of a tail's own page below the folder.
pub(super) fn page_file(tail: &str) -> String {
    format!("pages/{}.html", file_stem_of_tail(tail))
}

/// Writes a tail's files to the folder's waiting room.
///
/// # Errors
/// A file that cannot be written.
pub(crate) fn stage(
    folder: &Folder,
    begun: &str,
    result: &TailResult,
    flights: &[u8],
) -> Result<TailState, Failure> {
    let stem = file_stem_of_tail(&result.tail);
    let model_file = format!("models/{stem}.ron");
    let model = result
        .model
        .to_text()
        .map_err(|error| Failure::unwritable(Path::new(&model_file), error))?;
    let engines = result.model.initial.aircraft().engines();
    let segments = segments_table::table(&result.rows, engines).to_csv();
    let mut summary = result.summary.clone();
    summary.flights_new = 0;
    Ok(TailState {
        begun: begun.to_owned(),
        model: folder.stage(&model_file, model.as_bytes())?,
        segments: folder.stage(&format!("segments/{stem}.csv"), &segments)?,
        flights: folder.stage(&format!("flights/{stem}.csv"), flights)?,
        summary,
    })
}

/// The figures of a tail.
pub(crate) fn result_of(stored: StoredTail, flights_new: usize, notes: Vec<String>) -> TailResult {
    let StoredTail { model, segments, flights } = stored;
    let tail = model.tail().unwrap_or_default().to_owned();
    let counts = TailCounts {
        flights: flights.len(),
        flights_new,
        samples: flights.iter().map(|flight| flight.entry.samples).sum(),
    };
    TailResult::adapted(TailData { tail, model, segments, counts, notes })
}

/// Brings the model up to date with what it has learnt.
pub(crate) fn settled(
    mut stored: StoredTail,
    remember_remainder: bool,
    notes: &mut Vec<String>,
) -> StoredTail {
    let model = &mut stored.model;
    let Some(learnt) = &mut model.learnt else { return stored };
    if let Err(error) = learning::settle(learnt) {
        // Cannot happen to a state that was read whole.
        tracing::error!(tail = learnt.tail, "{error}");
    }
    if remember_remainder {
        learning::remember_remainder(&model.initial, learnt, &stored.segments);
    } else if learnt.baseline.take().is_some() {
        notes.push(
            "the remainder of an earlier run is dropped: it belonged to the table before these flights"
                .to_owned(),
        );
    }
    stored
}

/// Learns flights anew, one after the other, into a model that has learnt nothing.
///
/// # Errors
/// A flight that cannot be learnt.
pub(crate) fn rebuild(
    mut model: ModelFile,
    flights: Vec<Material>,
) -> Result<StoredTail, LearningError> {
    let mut segments = Vec::new();
    let mut known = Vec::new();
    let starts = flights.iter().map(|flight| flight.known.start).collect();
    let dated = Dates::of_starts(&model, starts);
    for flight in flights {
        let Some(learnt) = &mut model.learnt else { break };
        let as_dated = match flight.segments.first() {
            Some(first) => dated.segments_as_dated(&first.identity, &flight.segments),
            None => Cow::Borrowed(&flight.segments[..]),
        };
        known.push(learn_one(&model.initial, learnt, flight.known, &as_dated)?);
        segments.extend(flight.segments);
    }
    Ok(StoredTail { model, segments, flights: known })
}

/// A tail's learning in this run.
#[derive(Debug)]
struct Work {
    notes: Vec<String>,
    refused: Vec<RefusedReport>,
    flights_new: usize,
}

impl Work {
    const fn new(notes: Vec<String>) -> Self {
        Self { notes, refused: Vec::new(), flights_new: 0 }
    }

    /// New flights after those that the tail has learnt.
    fn continued(
        &mut self,
        start: &Start<'_>,
        tail: &str,
        stored: Option<StoredTail>,
        new: Vec<FlightRead>,
    ) -> Result<Option<StoredTail>, Failure> {
        let mut stored = match stored {
            Some(stored) => stored,
            None => {
                StoredTail { model: start.fresh(tail)?, segments: Vec::new(), flights: Vec::new() }
            }
        };
        self.notes.extend(stored.model.note_of_effects());
        let dated = Dates::of_learnt_and_new(&stored.model, &new);
        for flight in new {
            let Some(learnt) = &mut stored.model.learnt else { break };
            let known = known_of(&flight);
            let as_dated = dated.as_dated(&flight).into_owned();
            match learn_one(&stored.model.initial, learnt, known, &as_dated) {
                Ok(known) => {
                    self.flights_new += 1;
                    flight.add_notes(&mut self.notes);
                    stored.flights.push(known);
                    stored.segments.extend(flight.reduced.segments);
                }
                Err(error) => self.refused.push(RefusedReport::whole(flight.path, error)),
            }
        }
        Ok(Some(stored))
    }

    /// The tail from its first flight on, with other versions of some.
    fn relearnt(
        &mut self,
        start: &Start<'_>,
        tail: &str,
        stored: Option<StoredTail>,
        new: Vec<(FlightRead, Option<usize>)>,
        replaced: &[usize],
    ) -> Result<Option<StoredTail>, Failure> {
        let Some(stored) = stored else { return Ok(None) };
        let mut slots: Vec<Option<Material>> =
            materials(stored.flights, stored.segments).into_iter().map(Some).collect();
        for index in replaced {
            slots[*index] = None;
        }
        let mut paths = Vec::new();
        let mut last = Vec::new();
        for (flight, replaces) in new {
            flight.add_notes(&mut self.notes);
            let material = Material { known: known_of(&flight), segments: flight.reduced.segments };
            paths.push(flight.path);
            match replaces {
                Some(index) => slots[index] = Some(material),
                None => last.push(material),
            }
        }
        let flights = slots.into_iter().flatten().chain(last).collect();
        match rebuild(start.fresh(tail)?, flights) {
            Ok(rebuilt) => {
                self.notes.extend(rebuilt.model.note_of_effects());
                self.flights_new = paths.len();
                Ok(Some(rebuilt))
            }
            Err(error) => {
                let refuse = |path| {
                    RefusedReport::whole(path, format!("the tail cannot be learnt anew: {error}"))
                };
                self.refused.extend(paths.into_iter().map(refuse));
                Ok(None)
            }
        }
    }
}

/// Flights with their segments, in the order in which they were learnt.
pub(crate) fn materials(flights: Vec<KnownFlight>, segments: Vec<Segment>) -> Vec<Material> {
    let mut segments = segments.into_iter().peekable();
    flights
        .into_iter()
        .map(|known| {
            let mut own = Vec::new();
            while let Some(segment) = segments.next_if(|segment| {
                segment.identity.start == known.start
                    && segment.identity.flight == known.entry.flight
            }) {
                own.push(segment);
            }
            Material { known, segments: own }
        })
        .collect()
}

fn known_of(flight: &FlightRead) -> KnownFlight {
    KnownFlight { entry: entry_of(flight), start: flight.reduced.identity.start, end: flight.end }
}

/// Learns one flight; returns it with what learning counted.
fn learn_one(
    initial: &effects::ExtendedModel,
    learnt: &mut Learnt,
    known: KnownFlight,
    segments: &[Segment],
) -> Result<KnownFlight, LearningError> {
    let entry = LedgerEntry { segments: 0, outside_table: 0, ..known.entry.clone() };
    let result = learning::learn_flight(initial, learnt, &FlightToLearn { entry, segments })?;
    let entry = learnt.ledger.last().cloned().unwrap_or(known.entry);
    tracing::debug!(
        tail = entry.tail,
        flight = entry.flight,
        segments = segments.len(),
        adapted = result.adapted,
        outside = result.outside_table,
        refitted = result.refitted,
        "learnt"
    );
    Ok(KnownFlight { entry, ..known })
}

type Read = Vec<(Vec<FlightRead>, Vec<RefusedReport>)>;

fn read_some(source: &Source, heads: &[Head], buffers: &mut Buffers, side_by_side: bool) -> Read {
    let read = |head: &Head, buffers: &mut Buffers| match &head.read {
        Some(flight) => (vec![(**flight).clone()], Vec::new()),
        None => source.read_file(&head.path, buffers),
    };
    if side_by_side {
        heads.par_iter().map_init(Buffers::default, |buffers, head| read(head, buffers)).collect()
    } else {
        heads.iter().map(|head| read(head, buffers)).collect()
    }
}
