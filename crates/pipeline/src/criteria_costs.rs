//! What the trim criteria cost, as plain numbers for pages and documents.

use segmenter::{Criterion, Tally};

use crate::reading::FlightRead;

/// What became of the samples of some flights.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CriteriaCosts {
    /// Flights.
    pub flights: usize,
    /// Their samples.
    pub samples: usize,
    /// Samples in segments.
    pub kept: usize,
    /// Samples that fail a criterion.
    pub unsteady: usize,
    /// Samples that the filter discards.
    pub outlying: usize,
    /// Steady samples in pieces too short for a segment.
    pub in_dropped_pieces: usize,
    /// Each criterion.
    pub criteria: Vec<OneCriterion>,
}

/// What one criterion cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OneCriterion {
    /// Its name.
    pub name: &'static str,
    /// Flights in which its channel was not recorded.
    pub not_evaluated: usize,
    /// Samples that fail it.
    pub unsteady: usize,
    /// Samples that fail it and no other.
    pub unsteady_alone: usize,
    /// Samples that the filter discards in its channel.
    pub outliers: usize,
}

impl CriteriaCosts {
    /// Of flights that were read; `None` without flights.
    #[must_use]
    pub fn of_flights(flights: &[FlightRead]) -> Option<Self> {
        let total = flights.iter().fold(Tally::NOTHING, |mut total, flight| {
            total += flight.reduced.tally;
            total
        });
        (total.flights > 0).then(|| Self::from(&total))
    }
}

impl From<&Tally> for CriteriaCosts {
    fn from(tally: &Tally) -> Self {
        Self {
            flights: tally.flights,
            samples: tally.samples,
            kept: tally.samples_kept,
            unsteady: tally.samples_unsteady,
            outlying: tally.samples_outlying,
            in_dropped_pieces: tally.samples_in_dropped_pieces,
            criteria: Criterion::ALL
                .into_iter()
                .map(|criterion| {
                    let cost = tally.cost(criterion);
                    OneCriterion {
                        name: criterion.name(),
                        not_evaluated: tally.flights - cost.flights_evaluated,
                        unsteady: cost.unsteady,
                        unsteady_alone: cost.unsteady_alone,
                        outliers: cost.outliers,
                    }
                })
                .collect(),
        }
    }
}
