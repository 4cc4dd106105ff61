//! The verdict on samples, pieces and the whole flight.

use core::fmt;
use core::ops::Range;

use flight::{DroppedRun, Segment};

use crate::{CriterionSet, Tally};

/// The segments of one flight and the reason for everything else.
#[derive(Clone, Debug, PartialEq)]
pub struct Segmentation {
    /// Stabilised segments in the order of time.
    pub segments: Vec<Segment>,
    /// One verdict for each sample of the track.
    pub verdicts: Vec<SampleVerdict>,
    /// Sample runs that the track could not use, with reasons.
    pub dropped_runs: Vec<DroppedRun>,
    /// Pieces of stable runs that did not become a segment, with reasons.
    pub dropped_pieces: Vec<DroppedPiece>,
    /// The verdicts counted.
    pub tally: Tally,
}

impl Segmentation {
    /// Criteria whose channel was not recorded: what they would have rejected is unknown.
    #[must_use]
    pub fn not_evaluated(&self) -> CriterionSet {
        self.tally.not_evaluated()
    }
}

/// The verdict on one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleVerdict {
    /// It is in no sample run: the track dropped its run.
    NotJudged,
    /// It fails these criteria.
    Unsteady(CriterionSet),
    /// It meets all criteria, but lies too far from the mean of its piece in these channels.
    Outlier(CriterionSet),
    /// It is steady, but its piece did not become a segment.
    InDroppedPiece(PieceDropReason),
    /// It is kept.
    Kept {
        /// Index into [`Segmentation::segments`].
        segment: usize,
    },
}

/// Why a piece of a stable run did not become a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum PieceDropReason {
    /// One sample has no standard deviation.
    OneSample,
    /// After the filter it keeps fewer samples than a segment needs.
    TooShort,
}

/// A piece of a stable run that did not become a segment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DroppedPiece {
    /// Samples of the track.
    pub samples: Range<usize>,
    /// Samples that the filter left.
    pub kept: usize,
    /// Samples that a segment needs.
    pub needed: usize,
    /// The reason.
    pub reason: PieceDropReason,
}

/// The sentence for a person; samples count from 0.
impl fmt::Display for DroppedPiece {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (first, last) = (self.samples.start, self.samples.end.saturating_sub(1));
        match self.reason {
            PieceDropReason::OneSample => write!(f, "sample {first} alone has no spread"),
            PieceDropReason::TooShort => write!(
                f,
                "samples {first} to {last}: {} steady, {} left by the filter, {} needed",
                self.samples.len(),
                self.kept,
                self.needed
            ),
        }
    }
}

/// The sentence for a person.
impl fmt::Display for SampleVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotJudged => f.write_str("not judged: too few samples between time gaps"),
            Self::Unsteady(criteria) => write!(f, "unsteady: {criteria}"),
            Self::Outlier(criteria) => write!(f, "outlier: {criteria}"),
            Self::InDroppedPiece(PieceDropReason::OneSample) => f.write_str("steady, but alone"),
            Self::InDroppedPiece(PieceDropReason::TooShort) => {
                f.write_str("steady, but not long enough")
            }
            Self::Kept { segment } => write!(f, "kept in segment {segment}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Criterion;

    /// No two verdicts read alike, and each says which criteria, or why not.
    #[test]
    fn verdicts_say_what_happened() {
        let criteria: CriterionSet = [Criterion::Mach, Criterion::Roll].into_iter().collect();
        for (verdict, sentence) in [
            (SampleVerdict::NotJudged, "not judged: too few samples between time gaps"),
            (SampleVerdict::Unsteady(criteria), "unsteady: MACH, ROLL"),
            (SampleVerdict::Outlier(criteria), "outlier: MACH, ROLL"),
            (SampleVerdict::InDroppedPiece(PieceDropReason::OneSample), "steady, but alone"),
            (
                SampleVerdict::InDroppedPiece(PieceDropReason::TooShort),
                "steady, but not long enough",
            ),
            (SampleVerdict::Kept { segment: 3 }, "kept in segment 3"),
        ] {
            assert_eq!(verdict.to_string(), sentence);
        }
    }

    /// Samples 4, 5, 6 and 7: the last is 7, not 8.
    #[test]
    fn dropped_pieces_name_their_first_and_last_sample() {
        let piece =
            DroppedPiece { samples: 4..8, kept: 2, needed: 3, reason: PieceDropReason::TooShort };
        assert_eq!(piece.to_string(), "samples 4 to 7: 4 steady, 2 left by the filter, 3 needed");
        let alone =
            DroppedPiece { samples: 4..5, kept: 1, needed: 3, reason: PieceDropReason::OneSample };
        assert_eq!(alone.to_string(), "sample 4 alone has no spread");
    }
}
