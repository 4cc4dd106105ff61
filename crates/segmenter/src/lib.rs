//! From a [`Track`] to stabilised [`Segment`]s: eight trim criteria, pieces of at most ten minutes, a 2σ filter, and
//! the reason for everything that is left out.
//!
//! What it is: the decision which samples of a cruise are steady enough to compare with a performance model. What it is
//! not: it knows no model, computes no rate (a track has them already) and repairs nothing.
//!
//! The one design decision: every sample of the track gets exactly one [`SampleVerdict`], and the [`Tally`] of them
//! adds up. Anyone who asks why a flight gave so few segments finds what each criterion cost, alone and together with
//! others.
//!
//! Limits: neighbor criteria bound the change from sample to sample, so a slow drift passes (20 ft a minute is 180 ft
//! along a piece of ten samples). A channel that was not recorded is not judged: its criterion is reported as not
//! evaluated, and the segments are only as steady as the others can establish. The criteria are meant for samples one
//! minute apart; `track` averages faster recordings.
//!
//! ```
//! use segmenter::{Criterion, TrimCriteria};
//!
//! let criteria = TrimCriteria::ghazi_2020_table_4();
//! assert_eq!(criteria.limit(Criterion::GroundSpeed), 1.0);
//! assert_eq!(Criterion::GroundSpeed.unit(), "kt");
//! // Ten samples of a minute make a full piece, three make a segment.
//! assert_eq!(criteria.piece_samples_maximum(60.0), 10);
//! assert_eq!(criteria.segment_samples_minimum(60.0), 3);
//! ```

mod channel;
mod criteria;
mod criterion;
mod means;
mod outliers;
mod points;
mod steadiness;
mod tally;
mod verdict;

use core::ops::Range;
use std::sync::Arc;

use flight::{FlightIdentity, SampleRun, Sampling, Segment, TemperatureSource, Track};

pub use criteria::TrimCriteria;
pub use criterion::{Criterion, CriterionKind, CriterionSet};
pub use points::{Scatter, of_points};
pub use tally::{CriterionCost, INCOMPLETE_SHARE, Tally};
pub use verdict::{DroppedPiece, PieceDropReason, SampleVerdict, Segmentation};

/// The stabilised segments of a track, and the verdict on every sample.
///
/// 1. Samples that meet all criteria make stable runs of neighbors.
/// 2. A stable run is cut from its start into pieces of at most [`TrimCriteria::piece_samples_maximum`] samples.
/// 3. In a piece, samples more than two standard deviations from the mean of any channel are discarded, all at once.
/// 4. A piece that keeps [`TrimCriteria::segment_samples_minimum`] samples is a segment: the means over its kept
///    samples.
///
/// # Source
/// `[steadiness.8]` to `[steadiness.14]`; Ghazi et al. 2020, table 4 and eq. (19).
#[must_use]
pub fn segment(track: &Track, criteria: &TrimCriteria) -> Segmentation {
    let mut cut = Cut::new(track, criteria);
    for run in track.runs() {
        let channels = channel::of_run(track, run, criteria);
        let mut failed = steadiness::failed_criteria(&channels, run.samples.len());
        let mut start = 0;
        while start < failed.len() {
            if !failed[start].is_empty() {
                cut.verdicts[run.samples.start + start] = SampleVerdict::Unsteady(failed[start]);
                start += 1;
                continue;
            }
            let steady = failed[start..].iter().take_while(|failed| failed.is_empty()).count();
            let end = start + steady;
            while start < end {
                let piece = start..end.min(start.saturating_add(cut.piece_samples_maximum));
                start = piece.end;
                outliers::mark(&channels, piece.clone(), &mut failed);
                cut.piece(run, piece.clone(), &failed[piece]);
            }
        }
    }
    cut.finish()
}

/// The segmentation of one track in progress.
struct Cut<'a> {
    track: &'a Track,
    identity: Arc<FlightIdentity>,
    piece_samples_maximum: usize,
    segment_samples_minimum: usize,
    segments: Vec<Segment>,
    verdicts: Vec<SampleVerdict>,
    dropped_pieces: Vec<DroppedPiece>,
}

impl<'a> Cut<'a> {
    fn new(track: &'a Track, criteria: &TrimCriteria) -> Self {
        let interval_s = track.sample_interval_s();
        Self {
            track,
            identity: Arc::new(track.report().header().identity.clone()),
            piece_samples_maximum: criteria.piece_samples_maximum(interval_s),
            segment_samples_minimum: criteria.segment_samples_minimum(interval_s),
            segments: Vec::new(),
            verdicts: vec![SampleVerdict::NotJudged; track.report().len()],
            dropped_pieces: Vec::new(),
        }
    }

    /// Keeps one piece of a run as a segment if enough of it is left. `outlying` has the piece's length.
    fn piece(&mut self, run: &SampleRun, piece: Range<usize>, outlying: &[CriterionSet]) {
        let samples = run.samples.start + piece.start..run.samples.start + piece.end;
        let kept = outlying.iter().filter(|outlying| outlying.is_empty()).count();
        let dropped = if samples.len() == 1 {
            Some(PieceDropReason::OneSample)
        } else if kept < self.segment_samples_minimum {
            Some(PieceDropReason::TooShort)
        } else {
            None
        };
        let verdict = match dropped {
            Some(reason) => SampleVerdict::InDroppedPiece(reason),
            None => SampleVerdict::Kept { segment: self.segments.len() },
        };
        for (sample, outlying) in samples.clone().zip(outlying) {
            self.verdicts[sample] =
                if outlying.is_empty() { verdict } else { SampleVerdict::Outlier(*outlying) };
        }
        if let Some(reason) = dropped {
            let needed = self.segment_samples_minimum;
            self.dropped_pieces.push(DroppedPiece { samples, kept, needed, reason });
            return;
        }
        let mut rows = Vec::with_capacity(kept);
        rows.extend(samples.zip(outlying).filter(|(_, out)| out.is_empty()).map(|(row, _)| row));
        self.segments.push(Segment {
            identity: Arc::clone(&self.identity),
            means: means::over(self.track, run, &rows),
            rows: rows.into_iter().map(row_number).collect(),
            temperature_assumed: self.track.temperature_source() != TemperatureSource::Recorded,
        });
    }

    fn finish(self) -> Segmentation {
        let mut tally = Tally::of_flight(
            &self.verdicts,
            &self.dropped_pieces,
            self.segments.len(),
            self.track.dropped_runs().len(),
            not_evaluated(self.track),
        );
        if let Sampling::AveragedToBins { incomplete_bins, incomplete_bins_s, .. } =
            self.track.sampling()
        {
            tally.incomplete_bins = incomplete_bins;
            tally.incomplete_bins_s = whole(incomplete_bins_s);
        }
        Segmentation {
            segments: self.segments,
            verdicts: self.verdicts,
            dropped_runs: self.track.dropped_runs().to_vec(),
            dropped_pieces: self.dropped_pieces,
            tally,
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "no cruise lasts 4e9 s, and none is negative"
)]
const fn whole(time_s: f64) -> usize {
    time_s.round() as usize
}

#[expect(clippy::cast_possible_truncation, reason = "no cruise has 4e9 samples")]
const fn row_number(sample: usize) -> u32 {
    sample as u32
}

/// Criteria whose channel was not recorded.
fn not_evaluated(track: &Track) -> CriterionSet {
    let columns = track.report().columns();
    let mut set = CriterionSet::EMPTY;
    if track.temperature_source() != TemperatureSource::Recorded {
        set.insert(Criterion::StaticAirTemperature);
    }
    if columns.n2_percent.is_none() {
        set.insert(Criterion::N2);
    }
    if columns.drift_deg.is_none() {
        set.insert(Criterion::Drift);
    }
    if columns.roll_deg.is_none() {
        set.insert(Criterion::Roll);
    }
    set
}
