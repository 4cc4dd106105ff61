//! One tail's flights in the order of flying, each with its deviation.

use core::num::NonZeroU32;

use flight::Timestamp;
use units::convert::{DAYS_PER_YEAR, SECONDS_PER_DAY};

/// A Julian year, by which trends are per year.
const SECONDS_A_YEAR: f64 = DAYS_PER_YEAR * SECONDS_PER_DAY;

/// What one flight shows: the mean of its segments' deviations, and how much they scatter.
///
/// A deviation is 100·ln(recorded/predicted) fuel flow, %: positive, the aircraft burns more than predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightDeviation {
    time: Timestamp,
    deviation_percent: f64,
    segments: NonZeroU32,
    scatter_percent2: f64,
}

/// How many conditions a flight is flown at that its deviation may depend on: Mach number, lift coefficient (but for a constant
/// factor), pressure altitude (m), ISA deviation (K) and mass (kg).
pub const CONDITIONS: usize = 5;

/// What each condition is the sum, difference or ratio of: Mach number 1, a mass over pressure and squared Mach number of some kg/Pa,
/// altitudes of 10 km, temperatures of 250 K (of which the ISA deviation is the difference of two), masses of tens of tonnes. Its own
/// mean would not do: that of an ISA deviation may be 0.
const MAGNITUDES: [f64; CONDITIONS] = [1.0, 5.0, 1e4, 250.0, 5e4];

/// Standard deviation, as a share of a condition's magnitude, below which it does not vary. Our choice: 0.0001 Mach, 1 m, 0.03 K, 5 kg are
/// rounding, of print-outs and of single precision too, and change fuel flow by some hundredths of a per cent at most.
const LEAST_VARIATION: f64 = 1e-4;

/// One over the standard deviation of a condition, by its place; 0 for one that does not vary.
pub(crate) fn one_over(deviation: f64, condition: usize) -> f64 {
    if deviation > LEAST_VARIATION * MAGNITUDES[condition] { 1.0 / deviation } else { 0.0 }
}

/// Why flights are not a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SeriesError {
    /// A flight is older than the one before it.
    #[error("flight {index} of {time} is older than the flight before it")]
    Order {
        /// Its place, from 0.
        index: usize,
        /// When it began.
        time: Timestamp,
    },
    /// Conditions are not those of the flights.
    #[error("conditions of {found} flights, expected {expected}")]
    Conditions {
        /// Conditions given.
        found: usize,
        /// Flights of the series.
        expected: usize,
    },
    /// A condition is no number.
    #[error("the conditions of flight {index} are not finite")]
    NotFinite {
        /// Its place, from 0.
        index: usize,
    },
}

impl FlightDeviation {
    /// A flight from the deviations of its segments; `None` without a segment, or where a deviation is not finite.
    #[must_use]
    pub fn of_segments(time: Timestamp, deviations_percent: &[f64]) -> Option<Self> {
        let segments = NonZeroU32::new(u32::try_from(deviations_percent.len()).ok()?)?;
        let mean = deviations_percent.iter().sum::<f64>() / f64::from(segments.get());
        let scatter = deviations_percent.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        (mean.is_finite() && scatter.is_finite()).then_some(Self {
            time,
            deviation_percent: mean,
            segments,
            scatter_percent2: scatter,
        })
    }

    /// A flight whose mean and sum of squared differences (%, %²) are known; `None` where they are none: not finite, or a sum
    /// below zero.
    #[must_use]
    pub fn of_mean(
        time: Timestamp,
        deviation_percent: f64,
        segments: NonZeroU32,
        scatter_percent2: f64,
    ) -> Option<Self> {
        let holds = deviation_percent.is_finite()
            && scatter_percent2.is_finite()
            && scatter_percent2 >= 0.0;
        holds.then_some(Self { time, deviation_percent, segments, scatter_percent2 })
    }

    /// The same flight where every segment deviates by so much more, %.
    #[must_use]
    pub fn raised(self, percent: f64) -> Self {
        Self { deviation_percent: self.deviation_percent + percent, ..self }
    }

    /// When the flight began.
    #[must_use]
    pub const fn time(&self) -> Timestamp {
        self.time
    }

    /// Mean deviation of its segments, %.
    #[must_use]
    pub const fn deviation_percent(&self) -> f64 {
        self.deviation_percent
    }

    /// Number of segments.
    #[must_use]
    pub const fn segments(&self) -> u32 {
        self.segments.get()
    }

    /// Sum of the squared differences of its segments from their mean, %².
    #[must_use]
    pub const fn scatter_percent2(&self) -> f64 {
        self.scatter_percent2
    }
}

/// Flights in the order of flying.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    flights: Vec<FlightDeviation>,
    /// Of every flight, in standard deviations from their mean over the flights; empty where they are not known.
    conditions: Vec<[f64; CONDITIONS]>,
}

impl Series {
    /// A series of flights.
    ///
    /// # Errors
    /// [`SeriesError`] for a flight that is older than the one before it.
    pub fn new(flights: Vec<FlightDeviation>) -> Result<Self, SeriesError> {
        let wrong = flights.windows(2).position(|pair| pair[1].time < pair[0].time);
        match wrong {
            Some(before) => {
                Err(SeriesError::Order { index: before + 1, time: flights[before + 1].time })
            }
            None => Ok(Self { flights, conditions: Vec::new() }),
        }
    }

    /// The same where the conditions of every flight are known, as [`CONDITIONS`] has them. The model that its deviations are against
    /// has learnt how fuel flow depends on them, and may have taken for that what is a change over time. One that varies by no more
    /// than rounding changes nothing.
    ///
    /// # Errors
    /// [`SeriesError`] where there are not as many as flights, or one is not finite.
    pub fn under(mut self, conditions: &[[f64; CONDITIONS]]) -> Result<Self, SeriesError> {
        let (found, expected) = (conditions.len(), self.flights.len());
        if found != expected {
            return Err(SeriesError::Conditions { found, expected });
        }
        let is_finite = |of: &[f64; CONDITIONS]| of.iter().all(|value| value.is_finite());
        if let Some(index) = conditions.iter().position(|of| !is_finite(of)) {
            return Err(SeriesError::NotFinite { index });
        }
        self.conditions = standardised(conditions);
        Ok(self)
    }

    /// Of every flight, in standard deviations from their mean; empty where they are not known.
    #[must_use]
    pub fn conditions(&self) -> &[[f64; CONDITIONS]] {
        &self.conditions
    }

    /// What the flights would have shown at mean conditions, where a standard deviation of each changes a deviation by so much, %.
    #[must_use]
    pub(crate) fn at_mean_conditions(&self, percent: &[f64; CONDITIONS]) -> Self {
        let mut flights = self.flights.clone();
        for (flight, conditions) in flights.iter_mut().zip(&self.conditions) {
            let by: f64 = conditions.iter().zip(percent).map(|(value, by)| value * by).sum();
            *flight = flight.raised(-by);
        }
        Self { flights, conditions: Vec::new() }
    }

    /// The flights.
    #[must_use]
    pub fn flights(&self) -> &[FlightDeviation] {
        &self.flights
    }

    /// Number of flights.
    #[must_use]
    pub fn len(&self) -> usize {
        self.flights.len()
    }

    /// Whether there is no flight.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.flights.is_empty()
    }

    /// Years from the first flight to an instant; 0 without a flight.
    #[must_use]
    pub fn years(&self, time: Timestamp) -> f64 {
        self.flights.first().map_or(0.0, |first| years_between(first.time, time))
    }

    /// The first flight that began at or after an instant: its index, or the number of flights.
    #[must_use]
    pub fn first_from(&self, time: Timestamp) -> usize {
        self.flights.partition_point(|flight| flight.time < time)
    }
}

/// Each condition less its mean over its standard deviation; nothing of one that does not vary.
fn standardised(conditions: &[[f64; CONDITIONS]]) -> Vec<[f64; CONDITIONS]> {
    let count = conditions.len().max(1) as f64;
    let mut standard = conditions.to_vec();
    for k in 0..CONDITIONS {
        let mean = conditions.iter().map(|of| of[k]).sum::<f64>() / count;
        let square = conditions.iter().map(|of| (of[k] - mean).powi(2)).sum::<f64>() / count;
        let scale = one_over(square.sqrt(), k);
        for of in &mut standard {
            of[k] = scale * (of[k] - mean);
        }
    }
    standard
}

/// Years from one instant to another.
#[must_use]
pub fn years_between(from: Timestamp, to: Timestamp) -> f64 {
    to.duration_since(from).as_secs_f64() / SECONDS_A_YEAR
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_scatter_by_hand() {
        // 1, 2, 6: mean 3, squares 4 + 1 + 9.
        let flight = FlightDeviation::of_segments(Timestamp::UNIX_EPOCH, &[1.0, 2.0, 6.0]).unwrap();
        assert_eq!((flight.deviation_percent(), flight.segments()), (3.0, 3));
        assert!((flight.scatter_percent2() - 14.0).abs() < 1e-12);
        let known = |mean, scatter| {
            FlightDeviation::of_mean(
                Timestamp::UNIX_EPOCH,
                mean,
                NonZeroU32::new(3).unwrap(),
                scatter,
            )
        };
        assert_eq!(known(3.0, flight.scatter_percent2()), Some(flight));
        assert_eq!(known(1.0, flight.scatter_percent2()).unwrap().raised(2.0), flight);
        assert!(known(f64::NAN, 1.0).is_none() && known(1.0, -1.0).is_none());
        assert!(known(1.0, f64::INFINITY).is_none());
        assert!(FlightDeviation::of_segments(Timestamp::UNIX_EPOCH, &[]).is_none());
        assert!(FlightDeviation::of_segments(Timestamp::UNIX_EPOCH, &[1.0, f64::NAN]).is_none());
    }

    #[test]
    fn flights_are_in_order() {
        let at = |second| {
            FlightDeviation::of_segments(Timestamp::from_second(second).unwrap(), &[0.0]).unwrap()
        };
        assert!(Series::new(vec![at(0), at(10), at(10)]).is_ok());
        let error = Series::new(vec![at(0), at(10), at(9)]).unwrap_err();
        assert!(matches!(error, SeriesError::Order { index: 2, .. }), "{error}");
        let series = Series::new(vec![at(0), at(10), at(20)]).unwrap();
        let from = |second| series.first_from(Timestamp::from_second(second).unwrap());
        assert_eq!([from(-1), from(10), from(11), from(21)], [0, 1, 2, 3]);
    }
}
