//! A recording of another layout, read flight by flight: what is held at a time is some text and the flights in it, so
//! that a month of a fleet fits into little memory.

use std::io::BufRead;
use std::path::Path;

use flight::{Report, ReportColumns};
use report::mapping::{MappedFlight, MappedReport, Mapping, Piece, Pieces, Rows, Source, Stream};
use report::{Refusal, RefusalKind};
use segmenter::TrimCriteria;

use super::{FileRead, FlightRead, RefusedReport, reduce, reduce_points};
use crate::checksum::sha256;

/// Pieces that are read into rows at a time, of about a megabyte each.
pub const PIECES_AT_A_TIME: usize = 4;

/// How a recording is read.
#[derive(Clone, Copy, Debug)]
pub struct Mapped<'a> {
    /// What results call it; a mapping may take a text of the header from its file name.
    pub path: &'a Path,
    /// Its layout.
    pub mapping: &'a Mapping,
    /// Which samples are steady.
    pub criteria: &'a TrimCriteria,
}

/// Work that does not depend on other work.
#[derive(Debug)]
pub enum Job {
    /// A piece to read into rows.
    Piece(Piece),
    /// A flight to reduce.
    Flight(Box<MappedFlight>),
}

/// What came of a job.
#[derive(Debug)]
pub enum Done {
    /// Rows of a piece.
    Rows(Box<Rows>),
    /// A flight.
    Flight(Box<Reduced>),
}

/// What came of a flight.
#[derive(Debug)]
pub enum Reduced {
    /// It is used.
    Flight(Box<FlightRead>),
    /// Its report cannot be reduced.
    Unusable(String),
    /// It gave no report.
    NoReport(MappedReport),
}

/// Does jobs, in any order, and gives what came of them in theirs.
pub type Spread<'a> = dyn Fn(Vec<Job>, &(dyn Fn(Job) -> Done + Sync)) -> Vec<Done> + 'a;

/// Does one job after the other.
pub fn one_by_one(jobs: Vec<Job>, work: &(dyn Fn(Job) -> Done + Sync)) -> Vec<Done> {
    jobs.into_iter().map(work).collect()
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
        let mut stream = source.begin(self.mapped.mapping, Some(&name))?;
        let mut waiting: Vec<MappedFlight> = Vec::new();
        let mut has_ended = false;
        while !has_ended {
            let mut jobs: Vec<Job> = waiting.drain(..).map(Box::new).map(Job::Flight).collect();
            let flights = jobs.len();
            let mut stopped = Ok(());
            while jobs.len() - flights < PIECES_AT_A_TIME {
                match source.next_piece(&mut stream) {
                    Ok(Some(piece)) => jobs.push(Job::Piece(piece)),
                    Ok(None) => {
                        has_ended = true;
                        break;
                    }
                    Err(refusal) => {
                        stopped = Err(refusal);
                        break;
                    }
                }
            }
            // Refusals are those of the first line at fault: flights that ended before come first.
            for done in spread(jobs, &|job| self.mapped.work(&stream, job)) {
                match done {
                    Done::Flight(reduced) => self.count(&mut stream, *reduced)?,
                    Done::Rows(rows) => {
                        let (ended, added) = stream.add(&rows);
                        waiting.extend(ended);
                        if let Err(refusal) = added {
                            self.finish(&mut stream, waiting, spread)?;
                            return Err(refusal);
                        }
                    }
                }
            }
            if stopped.is_err() {
                waiting.extend(stream.stop());
                self.finish(&mut stream, waiting, spread)?;
                return stopped;
            }
        }
        waiting.extend(stream.finish());
        self.finish(&mut stream, waiting, spread)?;
        // What it finds are flights without a report, each of which is refused by name already.
        stream.end().map(drop)
    }

    /// The flights that are still waiting.
    fn finish(
        &mut self,
        stream: &mut Stream,
        waiting: Vec<MappedFlight>,
        spread: &Spread<'_>,
    ) -> Result<(), Refusal> {
        let jobs = waiting.into_iter().map(Box::new).map(Job::Flight).collect();
        for done in spread(jobs, &|job| self.mapped.work(stream, job)) {
            if let Done::Flight(reduced) = done {
                self.count(stream, *reduced)?;
            }
        }
        Ok(())
    }

    fn count(&mut self, stream: &mut Stream, reduced: Reduced) -> Result<(), Refusal> {
        match reduced {
            Reduced::Flight(flight) => {
                stream.count_report();
                self.flights.push(*flight);
            }
            Reduced::Unusable(reason) => {
                stream.count_report();
                self.refused.push(RefusedReport::whole(self.mapped.path.to_owned(), reason));
            }
            Reduced::NoReport(report) => {
                let dropped = stream.dropped(&report);
                stream.count(report)?;
                self.refused
                    .extend(dropped.map(|(flight, refusal)| self.dropped(&flight, &refusal)));
            }
        }
        Ok(())
    }
}

impl Read<'_> {
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

impl Mapped<'_> {
    fn work(&self, stream: &Stream, job: Job) -> Done {
        match job {
            Job::Piece(piece) => Done::Rows(Box::new(stream.rows(piece))),
            Job::Flight(flight) => Done::Flight(Box::new(self.reduce(stream.report(*flight)))),
        }
    }

    fn reduce(&self, mapped: MappedReport) -> Reduced {
        match mapped {
            MappedReport::Report(parsed) => {
                let content = content_as_read(&parsed.report);
                reduced(reduce(self.path, *parsed, content, self.criteria))
            }
            MappedReport::Points(points) => {
                reduced(reduce_points(self.path, *points, self.criteria, content_as_read))
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

/// By what a flight out of a recording is known again: header and every sample, to the bit.
fn content_as_read(report: &Report) -> String {
    let header = report.header();
    let mut content = format!(
        "{}\n{}\n{}\n{}\n",
        header.aircraft_type, header.identity.tail, header.identity.flight, header.identity.start
    )
    .into_bytes();
    for (key, text) in &header.notes {
        content.extend(format!("{key} {text}\n").into_bytes());
    }
    let heating_value = header.lower_heating_value_mj_kg.unwrap_or(f64::NAN);
    let masses = [header.zero_fuel_mass, header.fuel_on_board].map(units::Mass::to_kilograms);
    let numbers = [masses[0], masses[1], heating_value];
    content.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    each_column(report.columns(), |name, values| {
        content.extend_from_slice(name.as_bytes());
        content.extend(values.iter().flat_map(|word| word.to_le_bytes()));
    });
    format!("flight:{}", sha256(&content))
}

/// Each column's name and two words that stand for its values.
fn each_column(columns: &ReportColumns, mut each: impl FnMut(&str, [u64; 2])) {
    // Each step of a sum waits for the one before: of several columns they are made side by side.
    let mut together: Vec<(&str, &[f64])> = Vec::with_capacity(16);
    let mut one = |name, values| together.push((name, values));
    one("TIME", &columns.time_s);
    one("ALT", &columns.pressure_altitude_m);
    one("SAT", columns.static_air_temperature_k.as_deref().unwrap_or_default());
    one("MACH", &columns.mach);
    one("VTAS", &columns.true_airspeed_m_s);
    one("GSPD", &columns.ground_speed_m_s);
    one("ROLL", columns.roll_deg.as_deref().unwrap_or_default());
    one("DRIFT", columns.drift_deg.as_deref().unwrap_or_default());
    for speeds in columns.n2_percent.iter().flatten() {
        one("N2", speeds);
    }
    match &columns.fuel_flow {
        flight::FuelFlowColumns::Total(total) => one("WF", total),
        flight::FuelFlowColumns::PerEngine(flows) => {
            for flow in flows {
                one("WF()", flow);
            }
        }
    }
    one("FU", &columns.fuel_used_kg);
    for columns in together.chunks(COLUMNS_AT_ONCE) {
        let words = folded_together(columns);
        for ((name, _), words) in columns.iter().zip(words) {
            each(name, words);
        }
    }
    for (column, values) in columns.optional.iter() {
        let values = values.iter().map(|value| value.unwrap_or(f64::NAN));
        each(&column.name(), folded(values));
    }
}

/// 128 bits that depend on every bit of every value and on their order: two sums, one multiplied by an odd number and
/// rotated at each step, so that no exchange of values leaves both. Against accident, not against intent.
fn folded(values: impl Iterator<Item = f64>) -> [u64; 2] {
    values.fold([0; 2], with)
}

/// The same of a few columns; one that is shorter than the others by itself.
fn folded_together(columns: &[(&str, &[f64])]) -> [[u64; 2]; COLUMNS_AT_ONCE] {
    let mut words = [[0; 2]; COLUMNS_AT_ONCE];
    let [(_, a), (_, b), (_, c)] = columns else {
        for (words, (_, values)) in words.iter_mut().zip(columns) {
            *words = folded(values.iter().copied());
        }
        return words;
    };
    let rows = a.len().min(b.len()).min(c.len());
    for ((a, b), c) in a.iter().zip(*b).zip(*c) {
        words = [with(words[0], *a), with(words[1], *b), with(words[2], *c)];
    }
    for (words, (_, values)) in words.iter_mut().zip(columns) {
        *words = values[rows..].iter().copied().fold(*words, with);
    }
    words
}

/// Columns whose sums are made side by side: as many as the registers of a processor hold.
const COLUMNS_AT_ONCE: usize = 3;

fn with(words: [u64; 2], value: f64) -> [u64; 2] {
    // The golden ratio and the square root of three, as odd 64-bit fractions.
    const FACTORS: [u64; 2] = [0x9e37_79b9_7f4a_7c15, 0xbb67_ae85_84ca_a73b];
    let bits = value.to_bits();
    [
        (words[0] ^ bits).wrapping_mul(FACTORS[0]).rotate_left(29),
        words[1].wrapping_mul(FACTORS[1]).wrapping_add(bits ^ (bits >> 31)),
    ]
}
