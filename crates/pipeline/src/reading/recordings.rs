//! A recording of another layout, read flight by flight: what is held at a time is some text and the flights in it, so
//! that a month of a fleet fits into little memory.

mod content;
mod workers;

use std::io::BufRead;
use std::path::Path;
use std::sync::mpsc::{self, Receiver};

use report::mapping::{Converter, MappedFlight, MappedReport, Mapping, Piece, Pieces, Rows};
use report::mapping::{Source, Stream};
use report::{Refusal, RefusalKind};
use segmenter::TrimCriteria;

use super::{Checks, FileRead, FlightRead, RefusedReport, reduce, reduce_points};
use content::content_as_read;
use workers::{Delivery, InOrder, Queue};
pub use workers::{Spread, Workers, one_by_one};

/// Pieces, and flights, that wait or are worked on for each worker: enough that none has nothing to do while the next is read, few
/// enough that they fit into little memory.
const WAITING_PER_WORKER: usize = 2;
/// And however few workers there are.
const WAITING_AT_LEAST: usize = 4;

/// How a recording is read.
#[derive(Clone, Copy, Debug)]
pub struct Mapped<'a> {
    /// What results call it; a mapping may take a text of the header from its file name.
    pub path: &'a Path,
    /// Its layout.
    pub mapping: &'a Mapping,
    /// Which samples are steady.
    pub criteria: &'a TrimCriteria,
    /// Whether its flights are checked.
    pub checks: Checks,
}

/// Work that does not depend on other work.
#[derive(Debug)]
enum Task {
    /// A piece to read into rows.
    Piece(usize, Piece),
    /// A flight to reduce.
    Flight(usize, Box<MappedFlight>),
}

/// What came of a task.
#[derive(Debug)]
enum Done {
    /// Rows of a piece.
    Rows(usize, Box<Rows>),
    /// A flight.
    Flight(usize, Box<Reduced>),
}

/// What came of a flight.
#[derive(Debug)]
enum Reduced {
    /// It is used.
    Flight(Box<FlightRead>),
    /// Its report cannot be reduced.
    Unusable(String),
    /// It gave no report.
    NoReport(MappedReport),
}

/// The flights in a recording, and what of it was refused. The result does not depend on `spread`.
pub fn read(mapped: &Mapped<'_>, source: &mut Source<'_>, spread: &Spread<'_>) -> FileRead {
    let mut read = Read { mapped: *mapped, flights: Vec::new(), refused: Vec::new() };
    match read.all(source, spread) {
        Ok(()) => (read.flights, read.refused),
        Err(refusal) => (Vec::new(), vec![RefusedReport::at(mapped.path.to_owned(), &refusal)]),
    }
}

/// The same of a recording's pieces, which may be those of a table in memory; that none begins is a refusal.
pub fn read_pieces(
    mapped: &Mapped<'_>,
    pieces: Result<Pieces<Box<dyn BufRead>>, Refusal>,
    spread: &Spread<'_>,
) -> FileRead {
    match pieces {
        Ok(pieces) => read(mapped, &mut Source::Text(pieces), spread),
        Err(refusal) => (Vec::new(), vec![RefusedReport::at(mapped.path.to_owned(), &refusal)]),
    }
}

struct Read<'a> {
    mapped: Mapped<'a>,
    flights: Vec<FlightRead>,
    refused: Vec<RefusedReport>,
}

impl Read<'_> {
    fn all(&mut self, source: &mut Source<'_>, spread: &Spread<'_>) -> Result<(), Refusal> {
        let name = self.mapped.path.file_name().unwrap_or_default().to_string_lossy();
        let stream = source.begin(self.mapped.mapping, Some(&name))?;
        let (mapped, converter, queue) = (self.mapped, stream.converter(), Queue::default());
        let (sender, done) = mpsc::channel();
        let work = || {
            if let Some(task) = queue.take() {
                let mut delivery = Delivery::of(&sender);
                delivery.done = Some(mapped.work(&converter, task));
            }
        };
        let flow = Flow {
            read: self,
            stream,
            queue: &queue,
            done,
            pieces: InOrder::default(),
            flights: InOrder::default(),
            stopped: Ok(()),
            is_read: false,
            has_refused_row: false,
            is_lost: false,
        };
        let (mut flow, mut result) = (Some(flow), Ok(()));
        spread(&work, &mut |workers| {
            if let Some(flow) = flow.take() {
                result = flow.run(source, workers, &work);
            }
        });
        result
    }

    /// A flight without a report while the others of its recording are used.
    fn dropped(&self, flight: &str, refusal: &Refusal) -> RefusedReport {
        let mut refused = RefusedReport::at(self.mapped.path.to_owned(), refusal);
        refused.reason = format!("flight {flight}: {}", refused.reason);
        if let RefusalKind::NoLevelPart { .. } | RefusalKind::TooFewRows = refusal.kind {
            // No row of it is at fault.
            (refused.line, refused.column) = (None, None);
        }
        refused
    }
}

/// A recording on its way through the workers: what has an order is done here in it, as soon as its turn has come.
struct Flow<'f, 'a> {
    read: &'f mut Read<'a>,
    stream: Stream,
    queue: &'f Queue<Task>,
    /// What workers have done.
    done: Receiver<Option<Done>>,
    pieces: InOrder<Box<Rows>>,
    flights: InOrder<Box<Reduced>>,
    /// Why reading stops, if a row or the source is refused: flights that ended before come first.
    stopped: Result<(), Refusal>,
    /// Whether no piece follows.
    is_read: bool,
    /// Whether a row was refused, behind which none is used.
    has_refused_row: bool,
    /// Whether a worker has panicked, so that no result is to come.
    is_lost: bool,
}

impl Flow<'_, '_> {
    fn run(
        mut self,
        source: &mut Source<'_>,
        workers: &Workers<'_>,
        work: &dyn Fn(),
    ) -> Result<(), Refusal> {
        let most = (WAITING_PER_WORKER * workers.count).max(WAITING_AT_LEAST);
        let mut has_finished = false;
        while !self.is_lost {
            while let Ok(done) = self.done.try_recv() {
                self.sort_in(done);
            }
            self.use_in_order(workers)?;
            if !self.is_read && self.pieces.missing() < most && self.flights.missing() < most {
                self.read_piece(source, workers);
            } else if self.pieces.missing() + self.flights.missing() > 0 {
                self.wait(work);
            } else if has_finished {
                break;
            } else {
                // What is kept back ended before the refusal.
                let stops = self.stopped.is_err();
                let ended = if stops { self.stream.stop() } else { self.stream.finish() };
                self.start_flights(ended, workers);
                has_finished = true;
            }
        }
        self.stopped?;
        // What it finds are flights without a report, each of which is refused by name already.
        self.stream.end().map(drop)
    }

    fn read_piece(&mut self, source: &mut Source<'_>, workers: &Workers<'_>) {
        match source.next_piece(&mut self.stream) {
            Ok(Some(piece)) => {
                self.queue.add(Task::Piece(self.pieces.number(), piece));
                (workers.call)();
            }
            Ok(None) => self.is_read = true,
            Err(refusal) => {
                self.is_read = true;
                self.stopped = Err(refusal);
            }
        }
    }

    /// Does a task that nobody has begun; where there is none, others are at work, and the next result is theirs.
    fn wait(&mut self, work: &dyn Fn()) {
        if !self.queue.is_empty() {
            work();
        } else if let Ok(done) = self.done.recv() {
            self.sort_in(done);
        }
    }

    fn sort_in(&mut self, done: Option<Done>) {
        match done {
            Some(Done::Rows(number, rows)) => self.pieces.put(number, rows),
            Some(Done::Flight(number, reduced)) => self.flights.put(number, reduced),
            None => self.is_lost = true,
        }
    }

    fn use_in_order(&mut self, workers: &Workers<'_>) -> Result<(), Refusal> {
        while let Some(reduced) = self.flights.next() {
            self.count(*reduced)?;
        }
        while let Some(rows) = self.pieces.next() {
            if self.has_refused_row {
                continue;
            }
            let (ended, added) = self.stream.add(*rows);
            self.start_flights(ended, workers);
            if let Err(refusal) = added {
                (self.stopped, self.is_read, self.has_refused_row) = (Err(refusal), true, true);
            }
        }
        Ok(())
    }

    fn start_flights(&mut self, ended: Vec<MappedFlight>, workers: &Workers<'_>) {
        for flight in ended {
            self.queue.add(Task::Flight(self.flights.number(), Box::new(flight)));
            (workers.call)();
        }
    }

    fn count(&mut self, reduced: Reduced) -> Result<(), Refusal> {
        match reduced {
            Reduced::Flight(flight) => {
                self.stream.count_report();
                self.read.flights.push(*flight);
            }
            Reduced::Unusable(reason) => {
                self.stream.count_report();
                let path = self.read.mapped.path.to_owned();
                self.read.refused.push(RefusedReport::whole(path, reason));
            }
            Reduced::NoReport(report) => {
                let dropped = self.stream.dropped(&report);
                self.stream.count(report)?;
                let dropped = dropped.map(|(flight, refusal)| self.read.dropped(&flight, &refusal));
                self.read.refused.extend(dropped);
            }
        }
        Ok(())
    }
}

impl Mapped<'_> {
    fn work(&self, converter: &Converter, task: Task) -> Done {
        match task {
            Task::Piece(number, piece) => Done::Rows(number, Box::new(converter.rows(piece))),
            Task::Flight(number, flight) => {
                Done::Flight(number, Box::new(self.reduce(converter.report(*flight))))
            }
        }
    }

    fn reduce(&self, mapped: MappedReport) -> Reduced {
        match mapped {
            MappedReport::Report(parsed) => {
                let content = content_as_read(&parsed.report);
                reduced(reduce(self.path, *parsed, content, (self.criteria, self.checks)))
            }
            MappedReport::Points(points) => {
                let how = (self.criteria, self.checks);
                reduced(reduce_points(self.path, *points, how, content_as_read))
            }
            other => Reduced::NoReport(other),
        }
    }
}

fn reduced(flight: Result<FlightRead, String>) -> Reduced {
    match flight {
        Ok(flight) => Reduced::Flight(Box::new(flight)),
        Err(reason) => Reduced::Unusable(reason),
    }
}
