//! Serious findings before anything is learnt from flights, and what is absurd set aside.

use std::collections::BTreeMap;

use crate::check::{CheckDocument, DataFinding, FlightCheck, book, check_flights};
use crate::evaluation::evaluate;
use crate::models::Models;
use crate::summary::{RefusedSummary, ReportsSummary};
use effects::ExtendedModel;
use flight::Severity;
use lut::Table;

use crate::reading::{FlightRead, Reading, RefusedReport};

/// A model and the table of it that flights are compared with.
pub type Book<'m> = (&'m ExtendedModel, &'m Table);

/// All that is wrong with what was read, also against the models of the flights where there are some. `now_s` as for
/// [`findings`].
pub fn check_document(
    reading: &Reading,
    models: Option<&Models>,
    now_s: Option<f64>,
) -> CheckDocument {
    let mut findings = findings(&reading.flights, now_s);
    if let Some(models) = models {
        let book_of = |flight: &FlightRead| {
            let model = models.for_flight(flight).ok()?;
            Some((&model.initial, model.drag_coefficient()))
        };
        findings.extend(against_book(&reading.flights, book_of));
    }
    let reports = ReportsSummary {
        read: reading.flights.len(),
        already_known: 0,
        refused: reading.refused.iter().map(RefusedSummary::from).collect(),
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

/// What is wrong with the flights of each tail against the book of its model.
pub fn against_book<'m>(
    flights: &[FlightRead],
    model_of: impl Fn(&FlightRead) -> Option<Book<'m>>,
) -> Vec<DataFinding> {
    let mut tails: BTreeMap<&str, Vec<&FlightRead>> = BTreeMap::new();
    for flight in flights {
        tails.entry(&flight.reduced.identity.tail).or_default().push(flight);
    }
    let mut findings = Vec::new();
    for (tail, mut of_tail) in tails {
        let Some((model, table)) = of_tail.first().and_then(|flight| model_of(flight)) else {
            continue;
        };
        of_tail.sort_by(|one, other| one.order(other));
        let segments = of_tail.iter().flat_map(|flight| &flight.reduced.segments);
        let evaluated = evaluate(model, table, segments);
        findings.extend(book::against_book(tail, &evaluated));
    }
    findings
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
/// far off the book, or of which all lie outside its table, are moved to the refused ones. Nothing could be learnt of the latter, and
/// what is known already is refused when its mapping is corrected.
pub fn set_aside_absurd<'m>(
    reading: &mut Reading,
    model_of: impl Fn(&FlightRead) -> Option<Book<'m>>,
    absurd: Absurd,
) -> String {
    let mut serious = findings(&reading.flights, None);
    let of_book = against_book(&reading.flights, model_of);
    serious.extend(of_book.iter().cloned());
    serious.retain(|finding| finding.severity >= Severity::Serious);
    let told = if serious.is_empty() { String::new() } else { crate::check::to_text(&serious) };
    if absurd == Absurd::Accept {
        return told;
    }
    let refused: BTreeMap<String, String> = of_book
        .into_iter()
        .filter(|finding| {
            let flights = || reading.flights.iter().map(|flight| &flight.reduced.identity.tail);
            finding.code == book::DEVIATION
                || finding.code == book::OUTSIDE
                    && finding.severity >= Severity::Serious
                    && flights().filter(|tail| **tail == finding.tail).count()
                        >= book::FLIGHTS_OUTSIDE
        })
        .map(|finding| {
            let reason = format!(
                "{}: {}; likely {}; --accept uses it nevertheless",
                finding.tail, finding.message, finding.likely_cause
            );
            (finding.tail, reason)
        })
        .collect();
    let flights = std::mem::take(&mut reading.flights);
    for flight in flights {
        match refused.get(&flight.reduced.identity.tail) {
            Some(reason) => reading.refused.push(RefusedReport::whole(flight.path, reason)),
            None => reading.flights.push(flight),
        }
    }
    told
}
