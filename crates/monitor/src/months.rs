//! Calendar months of a series.

use core::ops::Range;

use jiff::tz::Offset;

use crate::series::Series;

/// A calendar month, UTC.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Month {
    /// Year.
    pub year: i16,
    /// Month, 1 to 12.
    pub month: i8,
}

impl Month {
    /// The month of an instant.
    #[must_use]
    pub fn from_timestamp(time: flight::Timestamp) -> Self {
        let date = Offset::UTC.to_datetime(time);
        Self { year: date.year(), month: date.month() }
    }

    /// Months since year 0, to count by.
    #[must_use]
    pub fn number(self) -> i32 {
        12 * i32::from(self.year) + i32::from(self.month) - 1
    }
}

impl core::fmt::Display for Month {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{:04}-{:02}", self.year, self.month)
    }
}

/// The months in which a tail flew, in order, each with its flights.
#[must_use]
pub fn months(series: &Series) -> Vec<(Month, Range<usize>)> {
    let mut found: Vec<(Month, Range<usize>)> = Vec::new();
    for (index, flight) in series.flights().iter().enumerate() {
        let month = Month::from_timestamp(flight.time());
        match found.last_mut() {
            Some((last, flights)) if *last == month => flights.end = index + 1,
            _ => found.push((month, index..index + 1)),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::FlightDeviation;

    #[test]
    fn months_are_those_of_the_calendar_in_utc() {
        let flights = ["2025-12-31T23:59:59Z", "2026-01-01T00:00:00Z", "2026-01-31T12:00:00Z"]
            .map(|time| FlightDeviation::of_segments(time.parse().unwrap(), &[0.0]).unwrap());
        let found = months(&Series::new(flights.to_vec()).unwrap());
        let text: Vec<String> =
            found.iter().map(|(month, flights)| format!("{month} {flights:?}")).collect();
        assert_eq!(text, ["2025-12 0..1", "2026-01 1..3"]);
        assert_eq!(found[1].0.number() - found[0].0.number(), 1);
    }
}
