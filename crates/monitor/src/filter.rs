//! The probability of every start of the current piece, flight by flight: exact, but for starts too improbable to matter.
//!
//! Flights between two changes lie on a straight line; lines of different pieces are independent, so that the density of all
//! flights is a sum over all divisions into pieces, and the sum is done by a recursion over the last start (Fearnhead 2006,
//! Statistics and Computing 16, 203–213; online as Adams and `MacKay` 2007 have it). What a flight costs does not depend on
//! how many there were: [`MOST_STARTS`] starts are remembered.

use crate::piece::RunningSums;
use crate::settings::{ChangeBeliefs, FORGOTTEN_SHARE, MOST_STARTS};

/// A flight as the filter needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FilteredFlight {
    /// Years since an instant that is the same for all flights.
    pub(crate) years: f64,
    /// Deviation less the middle of the series, %.
    pub(crate) deviation_percent: f64,
    /// One over its variance, %⁻².
    pub(crate) weight: f64,
    /// Whether an event was recorded between the flight before and this one.
    pub(crate) event_before: EventBefore,
}

/// Whether an event was recorded just before a flight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum EventBefore {
    /// None.
    #[default]
    None,
    /// One or more.
    Recorded,
    /// It is taken for certain that nothing changed, recorded or not: what the flights are worth without a change here.
    Unchanged,
}

/// A flight at which the current piece may have begun.
#[derive(Clone, Copy, Debug)]
struct Start {
    index: usize,
    /// Share of the best division of the flights before it in their density, up to a factor that all starts have in common.
    best: f64,
    /// Probability that the piece began here, given the flights so far.
    share: f64,
    /// ln of what the share is multiplied by before it is one.
    exponent: f64,
}

/// What is known after each flight about the start of the piece that it belongs to.
#[derive(Clone, Debug)]
pub(crate) struct ChangeFilter {
    beliefs: ChangeBeliefs,
    sums: RunningSums,
    /// By number of flights: ln density of the flights before, over all divisions.
    density: Vec<f64>,
    /// By number of flights: where the last piece of the best division begins.
    best: Vec<usize>,
    /// ln probability of a change before each flight, and the sum of ln probability of no change up to it.
    change: Vec<(f64, f64)>,
    /// When the last flight was.
    last_years: f64,
    /// Starts of the current piece that are remembered.
    starts: Vec<Start>,
    /// By flight: probability of each remembered start, given the flights up to then.
    shares: Vec<Vec<(u32, f64)>>,
}

impl ChangeFilter {
    /// A filter that has seen no flight.
    #[must_use]
    pub(crate) fn new(beliefs: ChangeBeliefs) -> Self {
        Self {
            beliefs,
            sums: RunningSums::new(),
            density: vec![0.0],
            best: vec![0],
            change: Vec::new(),
            last_years: f64::NEG_INFINITY,
            starts: Vec::new(),
            shares: Vec::new(),
        }
    }

    /// Takes the next flight.
    ///
    /// ```text
    /// F(t) = Σ_s F(s)·p(change at s)·Π(1 − p)·evidence(s…t),   share(s) = summand/F(t)         [monitoring.7]
    /// ```
    pub(crate) fn push(&mut self, flight: &FilteredFlight) {
        let index = self.change.len();
        let probability = match flight.event_before {
            EventBefore::None => self.beliefs.change_within(flight.years - self.last_years),
            EventBefore::Recorded => self.beliefs.change_at_event,
            EventBefore::Unchanged => 0.0,
        };
        self.last_years = flight.years;
        let stayed = self.change.last().map_or(0.0, |(_, stayed)| *stayed);
        // Nothing can change before the first flight: it begins a piece.
        self.change.push(if index == 0 {
            (0.0, 0.0)
        } else {
            (probability.ln(), stayed + (-probability).ln_1p())
        });
        self.sums.push(flight.years, flight.deviation_percent, flight.weight);
        self.starts.push(Start { index, best: 1.0, share: 0.0, exponent: 0.0 });
        let last = self.weigh(index);
        let shares = self
            .starts
            .iter()
            .map(|start| (u32::try_from(start.index).unwrap_or(u32::MAX), start.share));
        self.shares.push(shares.collect());
        self.best.push(last);
    }

    /// The density with one flight more, the share of each start in it, and the last start of the best division.
    fn weigh(&mut self, index: usize) -> usize {
        let no_change_until = self.change[index].1;
        let mut largest = f64::NEG_INFINITY;
        for start in &mut self.starts {
            let (log_change, stayed) = self.change[start.index];
            let evidence = self.sums.piece(start.index, index + 1).evidence(&self.beliefs);
            start.share = evidence.factor;
            start.exponent = evidence.exponent
                + self.density[start.index]
                + log_change
                + (no_change_until - stayed);
            largest = largest.max(start.exponent);
        }
        let mut sum = 0.0;
        let (mut best, mut last) = (0.0, 0);
        for start in &mut self.starts {
            start.share *= (start.exponent - largest).exp();
            sum += start.share;
            if start.share * start.best > best {
                (best, last) = (start.share * start.best, start.index);
            }
        }
        self.density.push(largest + sum.ln());
        for start in &mut self.starts {
            start.share /= sum;
            start.best *= sum / best;
        }
        self.starts.retain(|start| start.share >= FORGOTTEN_SHARE || start.index == index);
        forget_the_least_probable(&mut self.starts);
        last
    }

    /// Number of flights seen.
    #[must_use]
    pub(crate) fn flights(&self) -> usize {
        self.change.len()
    }

    /// Natural logarithm of the density of all flights so far, up to a factor that no belief about changes alters.
    #[must_use]
    pub(crate) fn log_density(&self) -> f64 {
        self.density[self.density.len() - 1]
    }

    /// First flights of the pieces of the most probable division, from the second piece on, in order.
    #[must_use]
    pub(crate) fn best_division(&self) -> Vec<usize> {
        let mut starts = Vec::new();
        let mut end = self.flights();
        while end > 0 {
            end = self.best[end];
            if end > 0 {
                starts.push(end);
            }
        }
        starts.reverse();
        starts
    }

    /// Probability, given all flights, that a piece begins at each flight; 1 for the first.
    ///
    /// ```text
    /// R(n) = 1,   R(s) = Σ_t R(t)·share_t(s)                                                  [monitoring.8]
    /// ```
    #[must_use]
    pub(crate) fn probabilities(&self) -> Vec<f64> {
        let mut ends = vec![0.0; self.flights() + 1];
        if let Some(last) = ends.last_mut() {
            *last = 1.0;
        }
        for (index, shares) in self.shares.iter().enumerate().rev() {
            let end = ends[index + 1];
            if end > 0.0 {
                for (start, share) in shares {
                    ends[*start as usize] += end * share;
                }
            }
        }
        ends.truncate(self.flights());
        ends
    }
}

/// Leaves at most [`MOST_STARTS`], with shares of 1. Each flight brings one start, so that at most one goes; of two that are
/// alike, the later.
fn forget_the_least_probable(starts: &mut Vec<Start>) {
    if starts.len() > MOST_STARTS {
        let places = starts.iter().enumerate();
        let least = places.min_by(|(_, one), (_, other)| {
            one.share.total_cmp(&other.share).then(other.index.cmp(&one.index))
        });
        if let Some((place, _)) = least {
            starts.remove(place);
        }
    }
    let sum: f64 = starts.iter().map(|start| start.share).sum();
    for start in starts {
        start.share /= sum;
    }
}

#[cfg(test)]
mod tests;
