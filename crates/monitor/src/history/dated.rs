//! Changes with their dates, from the probability that one begins before each flight.

use core::ops::Range;

use super::Change;
use crate::filter::ChangeFilter;
use crate::levels::Estimate;
use crate::settings::{ABOUT_FLIGHTS, DATE_INTERVAL, REPORTED_PROBABILITY};

/// Changes that are more probable than not: those of the most probable division, each with the probability of all starts nearer
/// to it than to another; and where that division has none because no single flight stands out, those that begin within a few
/// flights.
pub(super) fn changes(filter: &ChangeFilter) -> Vec<Change> {
    more_probable_than_not(&filter.probabilities(), &filter.best_division())
}

fn more_probable_than_not(probabilities: &[f64], division: &[usize]) -> Vec<Change> {
    let reported = |firsts: &[usize]| -> Vec<Change> {
        nearest(firsts, probabilities.len())
            .map(|(first, near)| change(probabilities, first, near))
            .filter(|change| change.probability >= REPORTED_PROBABILITY)
            .collect()
    };
    let mut known = reported(division);
    while let Some(first) = about(probabilities, &known) {
        let mut firsts: Vec<usize> = known.iter().map(|change| change.first_flight).collect();
        firsts.insert(firsts.partition_point(|other| *other < first), first);
        let more = reported(&firsts);
        if more.len() <= known.len() {
            break;
        }
        known = more;
    }
    known
}

fn change(probabilities: &[f64], first_flight: usize, near: Range<usize>) -> Change {
    let sum: f64 = probabilities[near.clone()].iter().sum();
    let (earliest, latest) = date_interval(probabilities, near, first_flight);
    Change {
        first_flight,
        earliest,
        latest,
        probability: sum.min(1.0),
        step_percent: Estimate { value: 0.0, deviation: 0.0 },
        event: None,
        other_events: Vec::new(),
    }
}

/// Each of some flights in order, with the flights nearer to it than to another; the first flight of all is nobody's.
pub(super) fn nearest(
    firsts: &[usize],
    flights: usize,
) -> impl Iterator<Item = (usize, Range<usize>)> {
    firsts.iter().enumerate().map(move |(place, &first)| {
        let from = place.checked_sub(1).map_or(1, |before| firsts[before].midpoint(first) + 1);
        let to = firsts.get(place + 1).map_or(flights, |after| first.midpoint(*after) + 1);
        (first, from..to)
    })
}

/// The most probable flight of the most probable [`ABOUT_FLIGHTS`] on either side of one, if a change is more probable than
/// not to begin there. Flights that near to a change that is known, and those that its date may be, are its own.
fn about(probabilities: &[f64], known: &[Change]) -> Option<usize> {
    let flights = probabilities.len();
    let window = |first: usize, last: usize| {
        first.saturating_sub(ABOUT_FLIGHTS).max(1)..(last + ABOUT_FLIGHTS + 1).min(flights)
    };
    let mut free = probabilities.to_vec();
    for change in known {
        free[window(change.first_flight, change.first_flight)].fill(0.0);
        free[change.earliest..=change.latest].fill(0.0);
    }
    let sums =
        (1..flights).map(|centre| (centre, free[window(centre, centre)].iter().sum::<f64>()));
    let (centre, sum) = sums.max_by(|one, other| one.1.total_cmp(&other.1))?;
    if sum < REPORTED_PROBABILITY {
        return None;
    }
    window(centre, centre).max_by(|one, other| free[*one].total_cmp(&free[*other]))
}

/// First and last flight of the interval that is grown from the most probable flight, always to the side that is more
/// probable, until a change lies in it with 95 % of the probability of one. What is left over is the small probability of
/// further changes, which is spread over all flights and says nothing about the date of this one.
fn date_interval(
    probabilities: &[f64],
    within: Range<usize>,
    first_flight: usize,
) -> (usize, usize) {
    let sum: f64 = probabilities[within.clone()].iter().sum();
    let needed = DATE_INTERVAL * sum.min(1.0);
    let (mut earliest, mut latest) = (first_flight, first_flight);
    let mut held = probabilities[first_flight];
    while held < needed {
        let before = (earliest > within.start).then(|| probabilities[earliest - 1]);
        let after = (latest + 1 < within.end).then(|| probabilities[latest + 1]);
        match (before, after) {
            (None, None) => break,
            (Some(before), after) if after.is_none_or(|after| before > after) => {
                earliest -= 1;
                held += before;
            }
            (_, after) => {
                latest += 1;
                held += after.unwrap_or(0.0);
            }
        }
    }
    (earliest, latest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(flights: usize, places: &[(usize, f64)]) -> Vec<f64> {
        let mut probabilities = vec![0.0; flights];
        for (place, probability) in places {
            probabilities[*place] = *probability;
        }
        probabilities
    }

    fn found(probabilities: &[f64], division: &[usize]) -> Vec<(usize, f64)> {
        let all = more_probable_than_not(probabilities, division);
        all.iter().map(|change| (change.first_flight, change.probability)).collect()
    }

    /// By hand: three neighbours of 0.2 each are one change, whose most probable flight is told; the same three 20 flights
    /// apart are none. The first flight begins a piece with probability 1 and is no change.
    #[test]
    fn a_change_whose_date_is_not_sharp() {
        let three =
            |places: [usize; 3]| with(60, &[(places[0], 0.2), (places[1], 0.21), (places[2], 0.2)]);
        let firsts = |probabilities: &[f64]| -> Vec<usize> {
            found(probabilities, &[]).into_iter().map(|(first, _)| first).collect()
        };
        assert_eq!(firsts(&three([30, 31, 32])), [31]);
        assert_eq!(firsts(&three([24, 31, 38])), [31]);
        assert_eq!(firsts(&three([11, 31, 51])), []);
        assert_eq!(firsts(&[1.0, 0.1, 0.1]), []);
        assert_eq!(firsts(&[1.0]), []);
    }

    /// What one change leaves over is not counted for another: by hand, 0.4 at flight 100 and 0.55 on the fifteen from 108 are
    /// one change, and so are twenty flights of 0.05 each.
    #[test]
    fn one_change_is_reported_once() {
        let mut probabilities = with(200, &[(100, 0.4)]);
        probabilities[108..123].fill(0.55 / 15.0);
        let one = found(&probabilities, &[100]);
        assert_eq!(one.len(), 1, "{one:?}");
        assert_eq!(one[0].0, 100);
        assert!((one[0].1 - 0.95).abs() < 1e-12);
        let mut even = vec![0.0; 200];
        even[90..110].fill(0.05);
        let one = found(&even, &[]);
        assert_eq!(one.len(), 1, "{one:?}");
        assert!((one[0].1 - 1.0).abs() < 1e-12);
    }

    /// By hand: a sharp change at 50, and 0.6 about flight 120 of which the division knows nothing.
    #[test]
    fn a_blurred_change_beside_a_sharp_one_is_another() {
        let probabilities = with(200, &[(50, 1.0), (119, 0.2), (120, 0.21), (123, 0.19)]);
        let both = found(&probabilities, &[50]);
        assert_eq!(both.iter().map(|(first, _)| *first).collect::<Vec<_>>(), [50, 120]);
        assert!((both[1].1 - 0.6).abs() < 1e-12);
        assert_eq!(found(&probabilities[..100], &[50]).len(), 1);
    }

    /// By hand: between changes at 10 and 20 the border is 15.
    #[test]
    fn flights_belong_to_the_nearest_change() {
        let of: Vec<_> = nearest(&[10, 20], 60).collect();
        assert_eq!(of, [(10, 1..16), (20, 16..60)]);
        assert_eq!(nearest(&[], 60).count(), 0);
    }
}
