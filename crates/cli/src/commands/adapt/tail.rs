//! One tail: its reports are read and sorted, its model learns, its files are written to the waiting room.

mod known;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use flight::Segment;
use pipeline::adaptation::{
    self, Contradictions, OlderFlights, Sorting, Start, StoredTail, refuse_impossible, result_of,
};
use pipeline::criteria_costs::CriteriaCosts;
use pipeline::evaluation::TailResult;
use pipeline::file_names::page_file_of_tail;
use pipeline::known_flights::KnownFlights;
use pipeline::learning::LearningError;
use pipeline::learnt_flights::{self, KnownFlight};
use pipeline::models::check_engines;
use pipeline::monitoring::{flights_of, flights_to_csv};
use pipeline::plausibility::{self, Absurd, Book};
use pipeline::segments_table;
use rayon::prelude::*;

use super::Run;
use super::other_tails::NewFlight;
use crate::commands::tell_serious;
use crate::failure::{Failure, RefusedReport, refused_of};
use crate::files::file_stem_of_tail;
use crate::folder::state::{DeviationsState, TailState};
use crate::folder::{Folder, Salvage};
use crate::reading::heads::Head;
use crate::reading::{Buffers, FlightRead, Reading, Source};
use crate::terminal::neutral;
use known::{CopyOf, Known};

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
    /// What became of the samples of the flights that this run read.
    pub(super) costs: Option<CriteriaCosts>,
    /// The first copy, and what it is a copy of.
    pub(super) first_copy: Option<(String, String)>,
    /// Flights that it learns in this run, to be looked for under other tails.
    pub(super) new_flights: Vec<NewFlight>,
}

impl TailOutcome {
    /// With the copies of its reports: a copy of a refused report is refused for the same reason, any other is counted.
    fn add_copies(&mut self, copies: Vec<CopyOf>) {
        if copies.is_empty() {
            return;
        }
        let refused: BTreeMap<PathBuf, RefusedReport> =
            self.refused.iter().map(|one| (one.path.clone(), one.clone())).collect();
        for (path, original) in copies {
            if let Some(refusal) = refused.get(&*original) {
                self.refused.push(RefusedReport { path: path.into(), ..refusal.clone() });
                continue;
            }
            self.copies += 1;
            let names = || (path.display().to_string(), original.display().to_string());
            self.first_copy.get_or_insert_with(names);
        }
    }
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
        let (found, damaged) = match self.known_or_anew(tail, start, heads, buffers) {
            Ok(found) => found,
            // A damaged tail costs itself, not the batch.
            Err(failure) => {
                self.bar.advance(paths.len());
                return Ok(self.refuse(tail, &paths, &failure.to_string()));
            }
        };
        let Known { flights: known, new, refused, learnt_before, copies, stored } = found;
        self.bar.advance(paths.len() - new.len());
        let reading = self.read(tail, start, &new, buffers, side_by_side);
        let learnt = match (&stored, &damaged) {
            (Some(stored), _) => &stored.segments[..],
            (None, Some((_, left))) => &left.segments,
            (None, None) => &[],
        };
        let reading = self.plausible(reading, start, learnt);
        if let Some((failure, left)) = damaged {
            if let Some(lost) = left.lost(&reading.flights) {
                self.bar.half(new.len());
                let mut outcome = self.refuse(tail, &paths, &format!("{failure}; {lost}"));
                for refusal in reading.refused {
                    outcome.refused.retain(|one| one.path != refusal.path);
                    outcome.refused.push(refusal);
                }
                return Ok(outcome);
            }
            tracing::warn!("{failure}; tail {tail} is learnt anew from its reports");
        }
        let mut sorting = self.sorting(tail, known, stored.as_ref());
        sorting.refused = refused;
        sorting.already_known = learnt_before.len();
        for (start, flight) in &learnt_before {
            sorting.is_at_hand(*start, flight);
        }
        sorting.refused.extend(reading.refused);
        let usable = learnt_before.len() + reading.flights.len();
        let costs = CriteriaCosts::of_flights(&reading.flights);
        for flight in reading.flights {
            sorting.sort(flight);
        }
        let outcome = TailOutcome {
            tail: tail.to_owned(),
            usable,
            already_known: sorting.already_known,
            copies: sorting.copies,
            first_copy: sorting.first_copy.take(),
            costs,
            ..TailOutcome::default()
        };
        let mut outcome = self.learn_sorted(start, sorting, stored, outcome)?;
        outcome.add_copies(copies);
        self.bar.half(new.len());
        Ok(outcome)
    }

    /// What the folder knows of a tail and which reports are new; of a damaged tail that is to be learnt anew all of them are, and
    /// what is wrong and still known of it is told beside.
    fn known_or_anew(
        &self,
        tail: &str,
        start: &Start<'_>,
        heads: Vec<Head>,
        buffers: &mut Buffers,
    ) -> Result<(Known, Option<(Failure, Salvage)>), Failure> {
        let all = self.arguments.relearn.then(|| heads.clone());
        match self.known(tail, heads, buffers) {
            Ok(found) => {
                self.keeps_remainder(found.stored.as_ref().map(|stored| &stored.model))?;
                Ok((found, None))
            }
            Err(failure) => match self.anew(tail, start, all, buffers)? {
                Some((found, left)) => Ok((found, Some((failure, left)))),
                None => Err(failure),
            },
        }
    }

    /// A tail that is left as it is, all of its reports refused.
    fn refuse(&self, tail: &str, paths: &[Box<Path>], reason: &str) -> TailOutcome {
        let reason = format!("tail {tail} is not touched: {reason}");
        let refused = paths.iter().map(|path| RefusedReport::whole(path.to_path_buf(), &reason));
        TailOutcome { refused: refused.collect(), ..self.untouched(tail) }
    }

    fn sorting(&self, tail: &str, known: Vec<KnownFlight>, stored: Option<&StoredTail>) -> Sorting {
        let mut known = KnownFlights::new(known);
        if let Some(stored) = stored {
            known.add_segments(&stored.segments);
        }
        let mut sorting = Sorting::new(tail, known);
        if self.arguments.reports.strict {
            sorting.older = OlderFlights::Refuse;
        }
        if self.arguments.relearn {
            sorting.contradictions = Contradictions::Relearn;
        }
        sorting
    }

    /// Reads a tail's reports and sets aside those that its model is not for.
    fn read(
        &self,
        tail: &str,
        start: &Start<'_>,
        heads: &[Head],
        buffers: &mut Buffers,
        side_by_side: bool,
    ) -> Reading {
        let mut reading = Reading::default();
        for some in heads.chunks(READ_AT_A_TIME) {
            self.bar.half(some.len());
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
        reading
    }

    /// Sets aside flights whose dates or figures cannot be right, as the tail is known by what it has learnt.
    fn plausible(&self, mut reading: Reading, start: &Start<'_>, learnt: &[Segment]) -> Reading {
        refuse_impossible(&mut reading, flight::Timestamp::now());
        let model = &start.model.initial;
        let book = Book { model, table: model.drag_table(), learnt: Some(learnt) };
        let absurd = if self.arguments.accept { Absurd::Accept } else { Absurd::Refuse };
        tell_serious(&plausibility::set_aside_absurd(&mut reading, |_| Some(book), absurd));
        reading
    }

    fn learn_sorted(
        &self,
        start: &Start<'_>,
        sorting: Sorting,
        stored: Option<StoredTail>,
        mut outcome: TailOutcome,
    ) -> Result<TailOutcome, Failure> {
        let new = sorting.new.iter().filter_map(|(flight, _)| NewFlight::of(flight)).collect();
        let found = adaptation::learn(
            start,
            &outcome.tail,
            sorting,
            stored,
            super::remainder_of(self.arguments),
        )
        .map_err(|error| not_correctable(&error))?;
        outcome.refused = found.refused;
        match found.learnt {
            Some(learnt) => {
                outcome.flights_new = found.flights_new;
                outcome.new_flights = new;
                self.store(&start.begun, learnt, found.notes, outcome)
            }
            None => self.rest(outcome),
        }
    }

    /// A tail to which this run adds nothing.
    fn rest(&self, outcome: TailOutcome) -> Result<TailOutcome, Failure> {
        let at_rest = self.at_rest(&outcome.tail)?;
        let mut refused = outcome.refused;
        refused.extend(at_rest.refused);
        Ok(TailOutcome { state: at_rest.state, section: at_rest.section, refused, ..outcome })
    }

    /// A tail for which this run has no report: what the folder has of it, written again only where it has to be.
    pub(super) fn at_rest(&self, tail: &str) -> Result<TailOutcome, Failure> {
        let needs_page = self.on_one_page || !self.folder.has(&page_file_of_tail(tail));
        let lacks_deviations =
            self.folder.state_of(tail).is_some_and(|state| state.deviations.is_none());
        let is_older = self.folder.is_older(tail) || lacks_deviations;
        if !self.folder.holds(tail) || !(needs_page || is_older) {
            return Ok(self.untouched(tail));
        }
        let stored = match self.folder.load(tail) {
            Ok(stored) => stored,
            // Damage is told in the night in which it is found, whatever is new.
            Err(failure) => {
                let what = format!("tail {tail} is not on the page");
                let refused = vec![refused_of(failure, &what)];
                return Ok(TailOutcome { refused, ..self.untouched(tail) });
            }
        };
        let begun = match self.folder.state_of(tail) {
            Some(state) => state.begun.clone(),
            // Known from now on only by comparing the models themselves.
            None => String::new(),
        };
        let outcome = TailOutcome { tail: tail.to_owned(), ..TailOutcome::default() };
        // Of an older program, or damaged: what follows from model and segments is written again.
        if is_older || stored.curve.is_none() {
            return self.store(&begun, stored, Vec::new(), outcome);
        }
        let result = result_of(stored, 0, Vec::new());
        let section = self.page_of(&result, None)?;
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
        let flights = learnt_flights::to_csv(&learnt.flights);
        let result = result_of(learnt, outcome.flights_new, notes);
        let section = self.page_of(&result, outcome.costs.as_ref())?;
        let state = stage(self.folder, begun, &result, &flights)?;
        Ok(TailOutcome { state: Some(state), section, ..outcome })
    }

    /// The tail's part of the page, or its own page.
    fn page_of(
        &self,
        result: &TailResult,
        costs: Option<&CriteriaCosts>,
    ) -> Result<Option<page::Section>, Failure> {
        let section = page::section(result, costs, &self.anchors);
        if self.on_one_page {
            return Ok(Some(section));
        }
        self.folder.stage_unnamed(
            &page_file_of_tail(&result.tail),
            neutral(&page::tail_page(&section)).as_bytes(),
        )?;
        Ok(None)
    }
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
    let deviations = flights_to_csv(&flights_of(result));
    let mut summary = result.summary.clone();
    summary.flights_new = 0;
    Ok(TailState {
        begun: begun.to_owned(),
        model: folder.stage(&model_file, model.as_bytes())?,
        segments: folder.stage(&format!("segments/{stem}.csv"), &segments)?,
        flights: folder.stage(&format!("flights/{stem}.csv"), flights)?,
        deviations: Some(DeviationsState::of(
            folder.stage(&format!("deviations/{stem}.csv"), &deviations)?,
            result,
        )),
        summary,
    })
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

/// An initial model whose table the law cannot correct.
pub(super) fn not_correctable(error: &LearningError) -> Failure {
    Failure::BadArgument { argument: "--model", reason: error.to_string() }
}
