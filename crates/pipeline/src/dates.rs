//! Whether the date of a flight can be right.
//!
//! Where knowledge ages, one wrong date ages all of it: a START in 2109 among flights of 2019 makes ninety years pass. A
//! date is judged by two witnesses: the clock of whoever runs the program, which comes as an argument, and the other
//! flights of the tail.

use flight::{FlightIdentity, Segment, Timestamp};
use units::convert::SECONDS_PER_DAY;

/// How far a flight may lie ahead of the clock, days. One day covers every time zone and a clock that was never set to
/// one.
pub const MOST_DAYS_AHEAD_OF_THE_CLOCK: f64 = 1.0;

/// Years from which digital recordings with every column can come.
pub(crate) const YEARS_OF_FLIGHTS: std::ops::Range<i32> = 1975..2100;

/// How long after START a segment may lie, days. The longest scheduled flights last less than one; a TIME column that
/// counts from another instant than START (seconds since 1970, for example) is off by years.
pub const MOST_DAYS_AFTER_START: f64 = 3.0;

/// Two flights of a tail that lie this close confirm each other's date, days: a year, and a month for storage. An aircraft
/// that returns after a longer pause is confirmed by its second flight.
pub const DAYS_THAT_CONFIRM: f64 = 400.0;

/// A flight that cannot have been flown when it says.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImpossibleDate {
    /// START is in the future.
    #[error("found START {start}, expected an instant before now ({now} by this computer's clock)")]
    Future {
        /// START of the flight.
        start: Timestamp,
        /// The clock.
        now: Timestamp,
    },
    /// START is in a year in which no aircraft recorded such reports.
    #[error("found START {start}, expected a year from {} on", YEARS_OF_FLIGHTS.start)]
    LongAgo {
        /// START of the flight.
        start: Timestamp,
    },
    /// START is possible and TIME is not.
    #[error(
        "found TIME {days:.1} days after START {start}, expected at most {MOST_DAYS_AFTER_START}: TIME is counted in seconds from START"
    )]
    LongAfterStart {
        /// START of the flight.
        start: Timestamp,
        /// How long after it the last row or segment lies, days.
        days: f64,
    },
}

/// Whether a flight can have been flown when its report says.
///
/// # Errors
/// [`ImpossibleDate`] for a START in the future or before there were such reports, or a segment or the end of the flight long after START: a flight that lasted
/// for years would overlap every later one.
pub fn possible(
    identity: &FlightIdentity,
    segments: &[Segment],
    end: Timestamp,
    now: Timestamp,
) -> Result<(), ImpossibleDate> {
    let start = identity.start;
    if days_between(now, start) > MOST_DAYS_AHEAD_OF_THE_CLOCK {
        return Err(ImpossibleDate::Future { start, now });
    }
    if year_of(start) < YEARS_OF_FLIGHTS.start {
        return Err(ImpossibleDate::LongAgo { start });
    }
    let last_s = segments.iter().map(|segment| segment.means.time_s).fold(0.0, f64::max);
    let days = (last_s / SECONDS_PER_DAY).max(days_between(start, end));
    if days > MOST_DAYS_AFTER_START {
        return Err(ImpossibleDate::LongAfterStart { start, days });
    }
    Ok(())
}

/// The year of an instant. RFC 3339 begins with it; years BC are outside what an instant of a report can be.
pub(crate) fn year_of(instant: Timestamp) -> i32 {
    instant.to_string().split('-').next().and_then(|year| year.parse().ok()).unwrap_or(0)
}

/// The date that a flight is taken to have been flown on, where its own stands alone: the nearest one that two other
/// flights of the tail confirm. `None` where its own date is as good as any.
///
/// `others` are the starts of all other flights of the tail, in any order, with repetitions.
pub fn instead_of(start: Timestamp, others: &[Timestamp]) -> Option<Timestamp> {
    let close =
        |one: Timestamp, other: Timestamp| days_between(one, other).abs() <= DAYS_THAT_CONFIRM;
    if others.iter().any(|other| close(start, *other)) {
        return None;
    }
    let confirmed = others.iter().enumerate().filter(|(position, other)| {
        others
            .iter()
            .enumerate()
            .any(|(another, date)| another != *position && close(**other, *date))
    });
    confirmed.map(|(_, other)| *other).min_by(|one, other| {
        days_between(start, *one).abs().total_cmp(&days_between(start, *other).abs())
    })
}

/// From the earlier to the later, days; negative the other way round.
fn days_between(earlier: Timestamp, later: Timestamp) -> f64 {
    later.duration_since(earlier).as_secs_f64() / SECONDS_PER_DAY
}

#[cfg(test)]
mod tests {
    use super::*;
    use flight::SegmentMeans;
    use std::sync::Arc;

    fn at(text: &str) -> Timestamp {
        text.parse().unwrap()
    }

    fn day(number: u32) -> Timestamp {
        at(&format!("2019-03-{number:02}T10:00:00Z"))
    }

    fn flight(start: &str, time_s: f64) -> (FlightIdentity, Vec<Segment>) {
        let identity =
            FlightIdentity { tail: "T".to_owned(), start: at(start), flight: "1".to_owned() };
        let cruise = SegmentMeans::cruise(&flight::Cruise {
            pressure_altitude: units::PressureAltitude::feet(35_000.0),
            static_air_temperature: units::Temperature::kelvin(220.0),
            mach: units::Mach::new(0.8),
            true_airspeed: units::TrueAirspeed::meters_per_second(240.0),
            mass: units::Mass::kilograms(30_000.0),
            fuel_flow_total: units::FuelFlowTotal::kilograms_per_second(0.4),
        });
        let segment = Segment {
            identity: Arc::new(identity.clone()),
            rows: (0..10).collect(),
            means: SegmentMeans { time_s, ..cruise },
            temperature_assumed: false,
        };
        (identity, vec![segment])
    }

    #[test]
    fn the_future_and_a_time_that_counts_from_elsewhere_are_impossible() {
        let now = at("2026-11-22T00:00:00Z");
        let judge = |start: &str, time_s: f64| {
            let (identity, segments) = flight(start, time_s);
            possible(&identity, &segments, identity.start, now)
        };
        assert_eq!(judge("2026-11-21T22:00:00Z", 7200.0), Ok(()));
        // Tomorrow's date at 14 hours ahead of UTC, by a clock without a time zone.
        assert_eq!(judge("2026-11-22T14:00:00Z", 7200.0), Ok(()));
        assert!(matches!(judge("2109-03-14T10:45:00Z", 0.0), Err(ImpossibleDate::Future { .. })));
        // 1.55e9 s after START, in 2019: 17 940 days, counted by hand (1.55e9 / 86 400 = 17 939.8).
        let error = judge("2019-03-14T10:45:00Z", 1.55e9).unwrap_err();
        assert!(error.to_string().contains("17939.8 days after START"), "{error}");
        // The last row alone: no segment lies there, and every later flight would begin before this one's end.
        let (identity, segments) = flight("2019-03-14T10:45:00Z", 7200.0);
        let error = possible(&identity, &segments, at("2303-08-06T06:14:21Z"), now).unwrap_err();
        assert!(matches!(error, ImpossibleDate::LongAfterStart { .. }), "{error}");
    }

    #[test]
    fn a_date_that_stands_alone_is_that_of_the_nearest_confirmed_flight() {
        let others: Vec<Timestamp> = (1..=9).map(day).collect();
        assert_eq!(instead_of(day(20), &others), None);
        assert_eq!(instead_of(at("2024-03-20T10:00:00Z"), &others), Some(day(9)));
        assert_eq!(instead_of(at("1919-03-20T10:00:00Z"), &others), Some(day(1)));
        // The second flight after a pause of years confirms the first one.
        let mut returned = others.clone();
        returned.push(at("2024-03-20T10:00:00Z"));
        assert_eq!(instead_of(at("2024-03-22T10:00:00Z"), &returned), None);
        assert_eq!(instead_of(at("2029-03-22T10:00:00Z"), &returned), Some(day(9)));
    }

    #[test]
    fn of_two_flights_years_apart_neither_is_the_wrong_one() {
        assert_eq!(instead_of(at("2024-03-20T10:00:00Z"), &[day(1)]), None);
        assert_eq!(instead_of(day(1), &[]), None);
    }
}
