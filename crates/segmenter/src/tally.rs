//! Verdicts counted, over one flight or many.

use core::fmt;
use core::ops::AddAssign;

use crate::{Criterion, CriterionSet, DroppedPiece, PieceDropReason, SampleVerdict};

/// What one criterion cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CriterionCost {
    /// Which.
    pub criterion: Criterion,
    /// Flights in which its channel was recorded.
    pub flights_evaluated: usize,
    /// Samples that fail it.
    pub unsteady: usize,
    /// Samples that fail it and no other: without it they would be steady.
    pub unsteady_alone: usize,
    /// Samples that the filter discards in its channel.
    pub outliers: usize,
    /// Samples that the filter discards in its channel and in no other.
    pub outliers_alone: usize,
}

/// Share of the recorded time from which minutes with too few samples are worth a word. Our choice.
pub const INCOMPLETE_SHARE: f64 = 0.05;

/// The verdicts of one flight, or of several flights together, counted.
///
/// ```text
/// samples        = not judged + judged
/// samples judged = unsteady + outliers + in dropped pieces + kept
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tally {
    /// Flights.
    pub flights: usize,
    /// Samples of their tracks.
    pub samples: usize,
    /// Samples in runs that the tracks dropped.
    pub samples_not_judged: usize,
    /// Samples that fail a criterion.
    pub samples_unsteady: usize,
    /// Samples that the filter discards.
    pub samples_outlying: usize,
    /// Steady samples of pieces that did not become a segment.
    pub samples_in_dropped_pieces: usize,
    /// Samples in segments.
    pub samples_kept: usize,
    /// Segments.
    pub segments: usize,
    /// Runs that the tracks dropped.
    pub dropped_runs: usize,
    /// Minutes of fast recordings that the tracks dropped, because they held too few samples: no samples of the tracks.
    pub incomplete_bins: usize,
    /// Recorded time in them, in whole seconds.
    pub incomplete_bins_s: usize,
    /// Pieces of one sample.
    pub pieces_of_one_sample: usize,
    /// Pieces that were too short, or became so by the filter.
    pub pieces_too_short: usize,
    /// What each criterion cost, in the order of [`Criterion::ALL`].
    pub costs: [CriterionCost; 8],
}

impl Tally {
    /// Of no flight: the start of a sum.
    pub const NOTHING: Self = Self {
        flights: 0,
        samples: 0,
        samples_not_judged: 0,
        samples_unsteady: 0,
        samples_outlying: 0,
        samples_in_dropped_pieces: 0,
        samples_kept: 0,
        segments: 0,
        dropped_runs: 0,
        incomplete_bins: 0,
        incomplete_bins_s: 0,
        pieces_of_one_sample: 0,
        pieces_too_short: 0,
        costs: no_costs(),
    };

    pub(crate) fn of_flight(
        verdicts: &[SampleVerdict],
        dropped_pieces: &[DroppedPiece],
        segments: usize,
        dropped_runs: usize,
        not_evaluated: CriterionSet,
    ) -> Self {
        let one_sample = |piece: &&DroppedPiece| piece.reason == PieceDropReason::OneSample;
        let pieces_of_one_sample = dropped_pieces.iter().filter(one_sample).count();
        let mut tally = Self {
            flights: 1,
            samples: verdicts.len(),
            segments,
            dropped_runs,
            pieces_of_one_sample,
            pieces_too_short: dropped_pieces.len() - pieces_of_one_sample,
            ..Self::NOTHING
        };
        for cost in &mut tally.costs {
            cost.flights_evaluated = usize::from(!not_evaluated.contains(cost.criterion));
        }
        for verdict in verdicts {
            match verdict {
                SampleVerdict::NotJudged => tally.samples_not_judged += 1,
                SampleVerdict::InDroppedPiece(_) => tally.samples_in_dropped_pieces += 1,
                SampleVerdict::Kept { .. } => tally.samples_kept += 1,
                SampleVerdict::Unsteady(criteria) => {
                    tally.samples_unsteady += 1;
                    for criterion in criteria.iter() {
                        let cost = &mut tally.costs[criterion as usize];
                        cost.unsteady += 1;
                        cost.unsteady_alone += usize::from(criteria.len() == 1);
                    }
                }
                SampleVerdict::Outlier(criteria) => {
                    tally.samples_outlying += 1;
                    for criterion in criteria.iter() {
                        let cost = &mut tally.costs[criterion as usize];
                        cost.outliers += 1;
                        cost.outliers_alone += usize::from(criteria.len() == 1);
                    }
                }
            }
        }
        tally
    }

    /// Samples that were judged.
    #[must_use]
    pub const fn samples_judged(&self) -> usize {
        self.samples - self.samples_not_judged
    }

    /// Share of the recorded time that lies in minutes with too few samples. The last minute before a hole is seldom whole, and counts
    /// by its samples.
    #[must_use]
    pub fn incomplete_share(&self) -> f64 {
        let dropped_s = self.incomplete_bins_s as f64;
        if dropped_s > 0.0 { dropped_s / (dropped_s + track_s(self.samples)) } else { 0.0 }
    }

    /// What one criterion cost.
    #[must_use]
    pub const fn cost(&self, criterion: Criterion) -> CriterionCost {
        self.costs[criterion as usize]
    }

    /// Criteria that were not evaluated in at least one flight, because their channel was not recorded.
    #[must_use]
    pub fn not_evaluated(&self) -> CriterionSet {
        self.costs
            .iter()
            .filter(|cost| cost.flights_evaluated < self.flights)
            .map(|cost| cost.criterion)
            .collect()
    }
}

/// Time of a track's samples where it is averaged to minutes.
fn track_s(samples: usize) -> f64 {
    60.0 * samples as f64
}

const fn no_costs() -> [CriterionCost; 8] {
    let mut costs = [CriterionCost {
        criterion: Criterion::PressureAltitude,
        flights_evaluated: 0,
        unsteady: 0,
        unsteady_alone: 0,
        outliers: 0,
        outliers_alone: 0,
    }; 8];
    let mut index = 0;
    while index < costs.len() {
        costs[index].criterion = Criterion::ALL[index];
        index += 1;
    }
    costs
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.flights += other.flights;
        self.samples += other.samples;
        self.samples_not_judged += other.samples_not_judged;
        self.samples_unsteady += other.samples_unsteady;
        self.samples_outlying += other.samples_outlying;
        self.samples_in_dropped_pieces += other.samples_in_dropped_pieces;
        self.samples_kept += other.samples_kept;
        self.segments += other.segments;
        self.dropped_runs += other.dropped_runs;
        self.incomplete_bins += other.incomplete_bins;
        self.incomplete_bins_s += other.incomplete_bins_s;
        self.pieces_of_one_sample += other.pieces_of_one_sample;
        self.pieces_too_short += other.pieces_too_short;
        for (cost, other) in self.costs.iter_mut().zip(other.costs) {
            cost.flights_evaluated += other.flights_evaluated;
            cost.unsteady += other.unsteady;
            cost.unsteady_alone += other.unsteady_alone;
            cost.outliers += other.outliers;
            cost.outliers_alone += other.outliers_alone;
        }
    }
}

/// One line: "113 samples: 27 kept in 3 segments; 80 unsteady (ALT 12, 3 alone; GSPD 30, 20 alone); …". Criteria that
/// cost nothing are left out, those that could not be evaluated are listed.
impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", counted(self.samples, "sample"))?;
        if self.flights != 1 {
            write!(f, " of {}", counted(self.flights, "flight"))?;
        }
        write!(f, ": {} kept in {}", self.samples_kept, counted(self.segments, "segment"))?;
        write!(f, "; {} unsteady", self.samples_unsteady)?;
        write_costs(
            f,
            self.costs.map(|cost| (cost.criterion, cost.unsteady, cost.unsteady_alone)),
        )?;
        write!(f, "; {} filtered out", self.samples_outlying)?;
        write_costs(
            f,
            self.costs.map(|cost| (cost.criterion, cost.outliers, cost.outliers_alone)),
        )?;
        write!(f, "; {} in dropped pieces", self.samples_in_dropped_pieces)?;
        if self.pieces_too_short + self.pieces_of_one_sample > 0 {
            write!(
                f,
                " ({} too short, {} of one sample)",
                counted(self.pieces_too_short, "piece"),
                self.pieces_of_one_sample
            )?;
        }
        if self.dropped_runs > 0 {
            let runs = counted(self.dropped_runs, "run");
            write!(f, "; {} not judged ({runs} too short)", self.samples_not_judged)?;
        }
        if self.incomplete_share() > INCOMPLETE_SHARE {
            let minutes = counted(self.incomplete_bins, "minute");
            write!(f, "; {minutes} dropped for too few samples")?;
        }
        for (index, criterion) in self.not_evaluated().iter().enumerate() {
            f.write_str(if index == 0 { "; not evaluated: " } else { ", " })?;
            f.write_str(criterion.name())?;
            let without = self.flights - self.cost(criterion).flights_evaluated;
            if self.flights != 1 {
                write!(f, " in {}", counted(without, "flight"))?;
            }
        }
        Ok(())
    }
}

fn write_costs(f: &mut fmt::Formatter<'_>, costs: [(Criterion, usize, usize); 8]) -> fmt::Result {
    let mut open = false;
    for (criterion, all, alone) in costs.into_iter().filter(|(_, all, _)| *all > 0) {
        write!(f, "{}{criterion} {all}, {alone} alone", if open { "; " } else { " (" })?;
        open = true;
    }
    f.write_str(if open { ")" } else { "" })
}

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: of 40 minutes five with too few samples, in which 150 s were recorded: 150/(150 + 2400) = 1/17 is worth a word; of
    /// twice as many minutes, 1/33, it is none.
    #[test]
    fn minutes_with_too_few_samples_are_told_from_a_twentieth_on() {
        let mut tally = Tally { flights: 1, samples: 40, ..Tally::NOTHING };
        tally.incomplete_bins = 5;
        tally.incomplete_bins_s = 150;
        assert!((tally.incomplete_share() - 1.0 / 17.0).abs() < 1e-12);
        let told = tally.to_string();
        assert!(told.contains("; 5 minutes dropped for too few samples"), "{told}");
        tally += Tally { flights: 1, samples: 40, ..Tally::NOTHING };
        assert!((tally.incomplete_share() - 1.0 / 33.0).abs() < 1e-12);
        assert!(!tally.to_string().contains("too few samples"), "{tally}");
        assert!(Tally::NOTHING.incomplete_share() < f64::MIN_POSITIVE);
    }
}
