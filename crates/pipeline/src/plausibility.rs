//! Serious findings before anything is learnt from flights, and what is absurd set aside.

use std::collections::BTreeMap;

use crate::check::{CheckDocument, DataFinding, FlightCheck, book, check_flights};
use crate::evaluation::evaluate;
use crate::model_file::ModelFile;
use crate::models::Models;
use crate::not_evaluated;
use crate::segments_table::Evaluated;
use crate::summary::{RefusedSummary, ReportsSummary};
use effects::ExtendedModel;
use flight::{Segment, Severity};
use lut::Table;

use crate::reading::{FlightRead, Reading, RefusedReport};

/// Flights of a tail from whose median another flight can be told.
const FLIGHTS_THAT_TELL: usize = 3;

/// What the flights of a tail are compared with.
#[derive(Clone, Copy, Debug)]
pub struct Book<'m> {
    /// Its model.
    pub model: &'m ExtendedModel,
    /// The drag table of it.
    pub table: &'m Table,
    /// Segments that the tail has learnt, where flights are to be learnt in addition: what it is known to be off its book is no slip.
    pub learnt: Option<&'m [Segment]>,
}

impl<'m> Book<'m> {
    /// That of a model for flights which it is not to learn.
    #[must_use]
    pub fn of(model: &'m ModelFile) -> Self {
        Self { model: &model.initial, table: model.drag_coefficient(), learnt: None }
    }
}

/// All that is wrong with what was read, also against the models of the flights where there are some. `now_s` as for
/// [`findings`].
pub fn check_document(
    reading: &Reading,
    models: Option<&Models>,
    now_s: Option<f64>,
) -> CheckDocument {
    let mut findings = findings(&reading.flights, now_s);
    findings.extend(not_evaluated::findings(&reading.flights));
    if let Some(models) = models {
        let mut with_books = Vec::new();
        let mut without: BTreeMap<(&str, String), usize> = BTreeMap::new();
        for (flight, model) in reading.flights.iter().zip(models.of_each(&reading.flights)) {
            match model {
                Ok(model) => with_books.push((Book::of(model), flight)),
                Err(reason) => {
                    let tail = flight.reduced.identity.tail.as_str();
                    *without.entry((tail, reason.to_string())).or_default() += 1;
                }
            }
        }
        findings.extend(judged(with_books.into_iter()).into_iter().map(|judged| judged.finding));
        let without = without.into_iter();
        findings.extend(
            without.map(|((tail, reason), flights)| book::not_compared(tail, flights, &reason)),
        );
    }
    let reports = ReportsSummary {
        read: reading.flights.len(),
        other_files: reading.other_files,
        refused: reading.refused.iter().map(RefusedSummary::from).collect(),
        ..ReportsSummary::default()
    };
    CheckDocument::new(reports, findings)
}

/// What is wrong with flights, each by itself and with each other. `now_s` is the present, s since 1970; without it a
/// result does not depend on the day. Of flights that were read without checks it knows nothing.
pub fn findings(flights: &[FlightRead], now_s: Option<f64>) -> Vec<DataFinding> {
    let mut ordered: Vec<&FlightRead> = flights.iter().collect();
    ordered.sort_by(|one, other| one.order(other));
    let checks: Vec<&FlightCheck> =
        ordered.iter().filter_map(|flight| flight.reduced.check.as_ref()).collect();
    let mut findings: Vec<DataFinding> =
        checks.iter().flat_map(|check| check.findings.iter().cloned()).collect();
    findings.extend(check_flights(&checks, now_s));
    findings
}

/// A finding against a book.
struct Judged {
    finding: DataFinding,
    /// Whether the flights are a slip (units, mapping, another aircraft), which is not to be learnt.
    is_slip: bool,
}

/// What is wrong with the flights of each tail, all of which have one book.
fn judged<'a>(flights: impl Iterator<Item = (Book<'a>, &'a FlightRead)>) -> Vec<Judged> {
    let mut tails: BTreeMap<&str, Vec<(Book<'a>, &FlightRead)>> = BTreeMap::new();
    for (book, flight) in flights {
        tails.entry(&flight.reduced.identity.tail).or_default().push((book, flight));
    }
    let mut all = Vec::new();
    for (tail, mut of_tail) in tails {
        let Some(&(book, _)) = of_tail.first() else { continue };
        of_tail.sort_by(|(_, one), (_, other)| one.order(other));
        let flights: Vec<OfFlight<'_>> = of_tail
            .iter()
            .map(|(_, flight)| {
                (*flight, evaluate(book.model, book.table, &flight.reduced.segments))
            })
            .collect();
        let strays = strays(&book, &flights);
        let rest = flights.iter().enumerate().filter(|(place, _)| !strays.contains_key(place));
        let segments: Vec<Option<Evaluated>> =
            rest.flat_map(|(_, (_, evaluated))| evaluated.iter().copied()).collect();
        let found = book::against_book(tail, &segments);
        // All that was learnt is evaluated only where something is off.
        if !found.is_empty() {
            all.extend(in_the_light_of(&book, found, flights.len() - strays.len()));
        }
        all.extend(strays.into_values().map(|finding| Judged { finding, is_slip: true }));
    }
    all
}

/// What segments of a flight show against a book.
type OfFlight<'a> = (&'a FlightRead, Vec<Option<Evaluated>>);

/// Flights that are far from what others of their tail burn, by their place: those that it has learnt where these are enough, else
/// all. Where every flight is, it is a matter of the tail.
fn strays(book: &Book<'_>, flights: &[OfFlight<'_>]) -> BTreeMap<usize, DataFinding> {
    let off: Vec<f64> =
        flights.iter().filter_map(|(_, evaluated)| book::flight_off_percent(evaluated)).collect();
    // All that was learnt is evaluated only where flights differ from each other.
    let apart = |one: f64| off.iter().any(|other| (one - other).abs() > book::PLAUSIBLE_PERCENT);
    if !off.iter().copied().any(apart) {
        return BTreeMap::new();
    }
    let learnt = book.learnt.unwrap_or_default();
    let known: Vec<f64> = learnt
        .chunk_by(|one, other| one.identity == other.identity)
        .filter_map(|flight| book::flight_off_percent(&evaluate(book.model, book.table, flight)))
        .collect();
    let is_known = known.len() >= FLIGHTS_THAT_TELL;
    let others = if is_known { known } else { [known, off.clone()].concat() };
    if !is_known && others.len() <= FLIGHTS_THAT_TELL {
        return BTreeMap::new();
    }
    let known_percent = median(others);
    let stray = |(place, (flight, evaluated)): (usize, &OfFlight<'_>)| {
        Some((place, book::stray(&flight.reduced.identity, evaluated, known_percent)?))
    };
    let found: BTreeMap<usize, DataFinding> =
        flights.iter().enumerate().filter_map(stray).collect();
    if found.len() < off.len() { found } else { BTreeMap::new() }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { values[middle - 1].midpoint(values[middle]) }
}

/// What so many flights of a tail show, given what it has learnt before.
fn in_the_light_of(book: &Book<'_>, found: Vec<DataFinding>, flights: usize) -> Vec<Judged> {
    let learnt = book.learnt.map(|learnt| evaluate(book.model, book.table, learnt));
    let is_known_inside = learnt.as_ref().is_none_or(|learnt| learnt.iter().any(Option::is_some));
    let learnt = learnt.unwrap_or_default();
    let judge = |finding: DataFinding| {
        let is_slip = match finding.code {
            book::DEVIATION if book::is_as_far_off(&finding, &learnt) => return None,
            book::DEVIATION => true,
            // One or two flights of a known aircraft may lie where it seldom is; nothing is learnt of them.
            book::OUTSIDE => {
                finding.severity >= Severity::Serious
                    && (flights >= book::FLIGHTS_OUTSIDE || !is_known_inside)
            }
            _ => false,
        };
        Some(Judged { finding, is_slip })
    };
    found.into_iter().filter_map(judge).collect()
}

/// What happens to a tail that is absurdly far off its book.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absurd {
    /// Its flights are refused.
    Refuse,
    /// They are used nevertheless.
    Accept,
}

/// Serious findings in words, empty where there are none; unless they are accepted, the flights of tails that are absurdly
/// far off the book, single flights that are far from what others of their tail burn, or of which all lie outside its table, are moved to the refused ones. Nothing could be learnt of the latter, and
/// what is known already is refused when its mapping is corrected. `book_of` a tail: what its flights are compared with.
pub fn set_aside_absurd<'m>(
    reading: &mut Reading,
    book_of: impl Fn(&str) -> Option<Book<'m>>,
    absurd: Absurd,
) -> String {
    let mut serious = findings(&reading.flights, None);
    let with_books = reading
        .flights
        .iter()
        .filter_map(|flight| Some((book_of(&flight.reduced.identity.tail)?, flight)));
    let of_book = judged(with_books);
    serious.extend(of_book.iter().map(|judged| judged.finding.clone()));
    serious.retain(|finding| finding.severity >= Severity::Serious);
    book::decide_by_fuel_used(&mut serious);
    let told = if serious.is_empty() { String::new() } else { crate::check::to_text(&serious) };
    if absurd == Absurd::Accept {
        return told;
    }
    let refused: BTreeMap<(String, String, String), String> = of_book
        .into_iter()
        .filter(|judged| judged.is_slip)
        .map(|Judged { finding, .. }| {
            // What fuel used decides is in what is told.
            let of_it =
                |one: &&DataFinding| one.code == finding.code && whose(one) == whose(&finding);
            let cause = &serious.iter().find(of_it).unwrap_or(&finding).likely_cause;
            let reason = format!(
                "{}: {}; likely {cause}; --accept uses it nevertheless",
                finding.tail, finding.message
            );
            (whose(&finding), reason)
        })
        .collect();
    let flights = std::mem::take(&mut reading.flights);
    for flight in flights {
        let identity = &flight.reduced.identity;
        let of_tail = (identity.tail.clone(), String::new(), String::new());
        let own = (identity.tail.clone(), identity.flight.clone(), identity.start.to_string());
        match refused.get(&of_tail).or_else(|| refused.get(&own)) {
            Some(reason) => reading.refused.push(RefusedReport::whole(flight.path, reason)),
            None => reading.flights.push(flight),
        }
    }
    told
}

/// The tail of a finding, and the flight and START where it is of one alone.
fn whose(finding: &DataFinding) -> (String, String, String) {
    (finding.tail.clone(), finding.flight.clone(), finding.start.clone())
}
