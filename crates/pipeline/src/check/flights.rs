//! Flights against each other: copies, overlaps, dates far from the others.

use std::collections::BTreeMap;

use flight::Severity;
use units::convert::{DAYS_PER_YEAR, SECONDS_PER_DAY};

use super::{DataFinding, FlightCheck};

/// A flight this many years from the middle of its tail's flights is dated wrongly.
const YEARS_APART: f64 = 15.0;

/// What the flights of a batch say of each other; `now_s` is the present, s since 1970, where it is known.
#[must_use]
pub fn check_flights(flights: &[&FlightCheck], now_s: Option<f64>) -> Vec<DataFinding> {
    let mut findings = copies(flights);
    let mut tails: BTreeMap<&str, Vec<&FlightCheck>> = BTreeMap::new();
    for flight in flights {
        tails.entry(&flight.identity.tail).or_default().push(flight);
    }
    for of_tail in tails.values_mut() {
        of_tail.sort_by(|one, other| one.identity.cmp(&other.identity));
        findings.extend(overlaps(of_tail));
        findings.extend(dates(of_tail, now_s));
    }
    findings
}

fn finding(
    flight: &FlightCheck,
    (severity, code): (Severity, &'static str),
    (size, unit): (f64, &'static str),
    [message, likely_cause, remedy]: [String; 3],
) -> DataFinding {
    DataFinding {
        severity,
        code,
        tail: flight.identity.tail.clone(),
        flight: flight.identity.flight.clone(),
        start: flight.identity.start.to_string(),
        size,
        unit,
        message,
        likely_cause,
        remedy,
    }
}

/// The same recorded columns under another name, tail or date.
fn copies(flights: &[&FlightCheck]) -> Vec<DataFinding> {
    let mut seen: BTreeMap<u64, &FlightCheck> = BTreeMap::new();
    let mut findings = Vec::new();
    for flight in flights {
        let Some(first) = seen.get(&flight.fingerprint) else {
            seen.insert(flight.fingerprint, flight);
            continue;
        };
        let [this, other] = [flight, first].map(|one| &one.identity);
        // Two tails of a made-up fleet may fly the same; one tail cannot fly twice.
        let severity = if this.tail == other.tail { Severity::Serious } else { Severity::Warning };
        findings.push(finding(
            flight,
            (severity, "flight-copied"),
            (1.0, "copies"),
            [
                format!(
                    "holds the same samples as flight {} of {} on tail {}",
                    other.flight, other.start, other.tail
                ),
                if this == other {
                    "the same report is given twice".to_owned()
                } else {
                    "one recording under two names, tails or dates".to_owned()
                },
                "give each recording once".to_owned(),
            ],
        ));
    }
    findings
}

/// One aircraft in the air twice at one time; copies are named as such already.
fn overlaps(flights: &[&FlightCheck]) -> Vec<DataFinding> {
    let mut findings = Vec::new();
    let mut latest: Option<&FlightCheck> = None;
    let mut ordered = flights.to_vec();
    ordered.sort_by(|one, other| one.instants_s.0.total_cmp(&other.instants_s.0));
    for flight in ordered {
        if let Some(before) = latest
            && flight.instants_s.0 < before.instants_s.1
            && flight.fingerprint != before.fingerprint
        {
            let common_s = before.instants_s.1.min(flight.instants_s.1) - flight.instants_s.0;
            findings.push(finding(
                flight,
                (Severity::Serious, "flights-overlap"),
                (common_s, "s"),
                [
                    format!(
                        "flies {common_s:.0} s at the same time as flight {} of {}",
                        before.identity.flight, before.identity.start
                    ),
                    "a wrong START (local time for UTC, a date without its rollover) or a wrong TAIL".to_owned(),
                    "START with its offset, or Z".to_owned(),
                ],
            ));
        }
        if latest.is_none_or(|before| flight.instants_s.1 > before.instants_s.1) {
            latest = Some(flight);
        }
    }
    findings
}

/// Dates in the future, or far from those of the tail's other flights.
fn dates(flights: &[&FlightCheck], now_s: Option<f64>) -> Vec<DataFinding> {
    let mut starts: Vec<f64> = flights.iter().map(|flight| flight.instants_s.0).collect();
    starts.sort_by(f64::total_cmp);
    let median = starts.get(starts.len() / 2).copied().unwrap_or(0.0);
    let year_s = DAYS_PER_YEAR * SECONDS_PER_DAY;
    let mut findings = Vec::new();
    for flight in flights {
        let years = (flight.instants_s.0 - median) / year_s;
        let ahead_s = now_s.map_or(f64::NEG_INFINITY, |now_s| flight.instants_s.1 - now_s);
        let (size, unit, message) = if ahead_s > SECONDS_PER_DAY {
            (ahead_s / SECONDS_PER_DAY, "days", "lies in the future".to_owned())
        } else if years.abs() > YEARS_APART {
            (years, "years", format!("lies {years:+.0} years from the tail's other flights"))
        } else {
            continue;
        };
        findings.push(finding(
            flight,
            (Severity::Serious, "date-wrong"),
            (size, unit),
            [
                message,
                "a clock that was not set, day and month exchanged, or an epoch in another unit"
                    .to_owned(),
                "START as flown".to_owned(),
            ],
        ));
    }
    findings
}
