//! Trim criteria that were not evaluated, because what they judge was not recorded: named once, with the number of flights.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use flight::{Segment, Severity, Timestamp};
use segmenter::{Criterion, Tally};
use serde::{Deserialize, Serialize};

use crate::check::DataFinding;
use crate::reading::FlightRead;

/// A trim criterion that was not evaluated.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NotEvaluated {
    /// Its name: that of the report's column, without the number of the engine.
    pub criterion: String,
    /// Flights in which it was not evaluated.
    pub flights: usize,
}

/// Name of the finding of `check`.
const CODE: &str = "not-evaluated";

/// Of flights that were read, those without a segment included.
#[must_use]
pub(crate) fn of_flights(flights: &[FlightRead]) -> Vec<NotEvaluated> {
    of_tally(&flights.iter().fold(Tally::NOTHING, |mut total, flight| {
        total += flight.reduced.tally;
        total
    }))
}

/// The same, given what became of their samples.
#[must_use]
pub fn of_tally(tally: &Tally) -> Vec<NotEvaluated> {
    let count = |criterion| tally.flights - tally.cost(criterion).flights_evaluated;
    listed(Criterion::ALL.map(|criterion| (criterion, count(criterion))))
}

/// Of flights of which only the segments are at hand: counted are those that have a segment. Of averaged points it is known what
/// was not recorded, not whose scatter was stated.
#[must_use]
pub(crate) fn of_segments(segments: &[Segment]) -> Vec<NotEvaluated> {
    let count = |lacks: fn(&Segment) -> bool| {
        let without = segments.iter().filter(|segment| lacks(segment));
        let flights: BTreeSet<(Timestamp, &str)> = without
            .map(|segment| (segment.identity.start, segment.identity.flight.as_str()))
            .collect();
        flights.len()
    };
    listed([
        (Criterion::StaticAirTemperature, count(|segment| segment.temperature_assumed)),
        (Criterion::N2, count(|segment| segment.means.n2_percent.is_empty())),
        (Criterion::Drift, count(|segment| segment.means.drift_deg.is_none())),
        (Criterion::Roll, count(|segment| segment.means.roll_deg.is_none())),
    ])
}

fn listed(counts: impl IntoIterator<Item = (Criterion, usize)>) -> Vec<NotEvaluated> {
    let some = counts.into_iter().filter(|(_, flights)| *flights > 0);
    some.map(|(criterion, flights)| NotEvaluated {
        criterion: criterion.name().to_owned(),
        flights,
    })
    .collect()
}

/// What several tails lack together, in the order of the first that lacks it.
#[must_use]
pub(crate) fn together<'n>(
    lists: impl IntoIterator<Item = &'n [NotEvaluated]>,
) -> Vec<NotEvaluated> {
    let mut all: Vec<NotEvaluated> = Vec::new();
    for one in lists.into_iter().flatten() {
        match all.iter_mut().find(|known| known.criterion == one.criterion) {
            Some(known) => known.flights += one.flights,
            None => all.push(one.clone()),
        }
    }
    all
}

/// "N2 in 3 of 40 flights; DRIFT, ROLL in 40 of 40 flights"; empty where everything was evaluated.
#[must_use]
fn in_words(list: &[NotEvaluated], flights: usize) -> String {
    let mut text = String::new();
    for alike in list.chunk_by(|one, other| one.flights == other.flights) {
        let names: Vec<&str> = alike.iter().map(|one| one.criterion.as_str()).collect();
        let separator = if text.is_empty() { "" } else { "; " };
        let without = alike[0].flights;
        let _ = write!(text, "{separator}{} in {without} of {flights} flights", names.join(", "));
    }
    text
}

/// One line for a person, with its line end; empty where everything was evaluated.
#[must_use]
pub fn line(list: &[NotEvaluated], flights: usize) -> String {
    if list.is_empty() {
        return String::new();
    }
    format!("Trim criteria not evaluated for want of data: {}.\n", in_words(list, flights))
}

/// What `check` has to say of it: one note for each tail.
#[must_use]
pub(crate) fn findings(flights: &[FlightRead]) -> Vec<DataFinding> {
    let mut tails: BTreeMap<&str, Tally> = BTreeMap::new();
    for flight in flights {
        *tails.entry(&flight.reduced.identity.tail).or_insert(Tally::NOTHING) +=
            flight.reduced.tally;
    }
    tails.into_iter().filter_map(|(tail, tally)| finding(tail, &tally)).collect()
}

fn finding(tail: &str, tally: &Tally) -> Option<DataFinding> {
    let list = of_tally(tally);
    let most = list.iter().map(|one| one.flights).max()?;
    let names: Vec<&str> = list.iter().map(|one| one.criterion.as_str()).collect();
    Some(DataFinding {
        severity: Severity::Note,
        code: CODE,
        tail: tail.to_owned(),
        flight: String::new(),
        start: String::new(),
        #[expect(clippy::cast_precision_loss, reason = "flights are far fewer than 2^53")]
        size: most as f64,
        unit: "flights",
        message: format!(
            "trim criteria not evaluated for want of data: {}",
            in_words(&list, tally.flights)
        ),
        likely_cause: "not recorded, or not in the mapping".to_owned(),
        remedy: format!("columns for {}, where they are recorded", names.join(", ")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(criterion: &str, flights: usize) -> NotEvaluated {
        NotEvaluated { criterion: criterion.to_owned(), flights }
    }

    #[test]
    fn what_is_missing_alike_is_named_together() {
        let of_tails =
            [vec![one("N2", 2), one("ROLL", 2)], vec![], vec![one("DRIFT", 4), one("ROLL", 2)]];
        let all = together(of_tails.iter().map(Vec::as_slice));
        assert_eq!(all, [one("N2", 2), one("ROLL", 4), one("DRIFT", 4)]);
        assert_eq!(in_words(&all, 9), "N2 in 2 of 9 flights; ROLL, DRIFT in 4 of 9 flights");
        assert_eq!(line(&[], 9), "");
    }
}
