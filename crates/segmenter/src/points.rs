//! Tracks whose samples are averaged points: each is a segment, unless what is stated of it says that it was not steady.

use std::sync::Arc;

use flight::{Segment, TemperatureSource, Track};

use crate::{
    Criterion, CriterionKind, CriterionSet, SampleVerdict, Segmentation, Tally, TrimCriteria,
    means, not_evaluated, row_number,
};

/// Samples of the published criteria are a minute apart: a frame of two minutes counts as two of them.
const SAMPLE_S: f64 = 60.0;

/// How much a channel moved within the frame of each point.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    /// The criterion that it judges, one of those that limit changes.
    pub criterion: Criterion,
    /// Standard deviation by point, in the track's unit; NaN where it is not stated.
    pub standard_deviations: Vec<f64>,
}

/// The segments of a track of averaged points ([`flight::Sampling::AveragedPoints`]): one each.
///
/// The criteria limit how much a channel changes from minute to minute. The rows of such a track are minutes or hours
/// apart, so that their differences say nothing about it. What was stated as scatter within a frame is held against the
/// same limit: two samples out of the frame differ by more than its standard deviation more often than not (our choice;
/// the standard deviation of their difference is 1.4 times as large). The size of drift and roll angles is judged by
/// their means. Everything else is reported as not evaluated, never as met.
#[must_use]
pub fn of_points(track: &Track, criteria: &TrimCriteria, scatter: &[Scatter]) -> Segmentation {
    let identity = Arc::new(track.report().header().identity.clone());
    let frame_samples = samples_of_frame(track.sample_interval_s());
    let mut segments = Vec::new();
    let mut verdicts = Vec::new();
    for (point, run) in track.runs().iter().enumerate() {
        let failed = failed(track, point, criteria, scatter);
        if !failed.is_empty() {
            verdicts.push(SampleVerdict::Unsteady(failed));
            continue;
        }
        verdicts.push(SampleVerdict::Kept { segment: segments.len() });
        let rows = point * frame_samples..(point + 1) * frame_samples;
        segments.push(Segment {
            identity: Arc::clone(&identity),
            means: means::over(track, run, &[point]),
            rows: rows.map(row_number).collect(),
            temperature_assumed: track.temperature_source() != TemperatureSource::Recorded,
        });
    }
    let tally = Tally::of_flight(&verdicts, &[], segments.len(), 0, not_judged(track, scatter));
    Segmentation { segments, verdicts, dropped_runs: Vec::new(), dropped_pieces: Vec::new(), tally }
}

/// Samples of the criteria that a frame counts as, one or more.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "at least 1, below 1e6"
)]
fn samples_of_frame(averaged_over_s: f64) -> usize {
    (averaged_over_s / SAMPLE_S).round().clamp(1.0, 1e6) as usize
}

fn failed(
    track: &Track,
    point: usize,
    criteria: &TrimCriteria,
    scatter: &[Scatter],
) -> CriterionSet {
    let columns = track.report().columns();
    let sizes = [(Criterion::Drift, &columns.drift_deg), (Criterion::Roll, &columns.roll_deg)];
    let sizes = sizes.into_iter().filter_map(|(one, values)| Some((one, values.as_ref()?[point])));
    let scatters = scatter.iter().map(|one| (one.criterion, one.standard_deviations[point]));
    sizes
        .chain(scatters)
        .filter(|(criterion, value)| {
            value.abs() > criteria.limit(*criterion) * criterion.stored_per_unit()
        })
        .map(|(criterion, _)| criterion)
        .collect()
}

/// Criteria that no point of the track was held against.
fn not_judged(track: &Track, scatter: &[Scatter]) -> CriterionSet {
    let absent = not_evaluated(track);
    let is_stated = |criterion: Criterion| {
        scatter.iter().any(|one| {
            one.criterion == criterion && one.standard_deviations.iter().any(|sd| !sd.is_nan())
        })
    };
    Criterion::ALL
        .into_iter()
        .filter(|criterion| match criterion.kind() {
            CriterionKind::Size => absent.contains(*criterion),
            CriterionKind::ChangeToNeighbors => !is_stated(*criterion),
        })
        .collect()
}
