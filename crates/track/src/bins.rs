//! Recordings faster than the trim criteria, averaged into bins of 60 s.
//!
//! The criteria limit what may change from one sample to the next, one minute apart. At one sample a second the same
//! limits would accept everything, so the recording is averaged before anything else is derived from it.
//!
//! - A recording whose median step is below 59 s is averaged (TIME in whole seconds resolves a step to ±1 s, so 59 s
//!   is a one-minute recording as sent).
//! - The recording is first split at its holes, and bins start again with the first sample after one. A hole is a step
//!   above 1.5 median steps and above half a bin: a lost second in a recording of one sample a second costs a bin one
//!   sample, not its neighbors.
//! - A bin that holds less than half of the samples it should hold, bin length over median step, is dropped and
//!   counted; it ends the run, as a hole does. Where a recording is slower for a while, as recorders are that change
//!   their rate on the way, a sample stands for the median of the steps around it instead, if that is longer.
//! - Time, fuel used and every other number are means over the bin's samples, so that rates between bins are those
//!   between their mean times. Longitude and true heading are mean directions. In an optional column the mean is over
//!   the samples that have a value. Anti-ice bleed is the share of the samples that have it on, from 0 to 1.
//!
//! Limit: changes within a bin are not seen. A roll of ±3° within a minute passes as its mean.

use core::ops::Range;

use flight::column::Column;
use flight::{FuelFlowColumns, OptionalColumn, Report, ReportColumns};
use units::mean_direction_deg;

use crate::{GAP_INTERVALS, TrackError, interval};

/// Length of a bin, s: the sampling for which the trim criteria were published.
pub const BIN_S: f64 = 60.0;
/// A median step at least this long is a one-minute recording, s.
pub const AS_SENT_INTERVAL_MINIMUM_S: f64 = 59.0;

/// Steps before and behind a sample by which the rate around it is judged: so many that a few drop-outs are not another rate. Our
/// choice.
const STEPS_AROUND: usize = 10;

/// Bins that are summed side by side: a sum takes four steps of a processor, and two of them can begin in each. Our choice.
const BINS_AT_ONCE: usize = 8;

/// A report of bins.
pub(crate) struct Binned {
    /// One sample per bin.
    pub(crate) report: Report,
    /// Bins without a hole or a dropped bin between them.
    pub(crate) runs: Vec<Range<usize>>,
    /// Dropped bins.
    pub(crate) incomplete_bins: usize,
    /// Recorded time in them.
    pub(crate) incomplete_bins_s: f64,
}

/// Whether a recording must be averaged.
pub(crate) fn is_faster_than_bins(sample_interval_s: f64) -> bool {
    sample_interval_s < AS_SENT_INTERVAL_MINIMUM_S - interval::TIME_TOLERANCE_S
}

/// Averages a recording with the median step `recorded_interval_s`. `[steadiness.7]`
pub(crate) fn average(report: Report, recorded_interval_s: f64) -> Result<Binned, TrackError> {
    let layout = layout(&report.columns().time_s, recorded_interval_s);
    if layout.bins.len() < crate::RUN_SAMPLES_MINIMUM {
        return Err(TrackError::TooFewBins {
            bins: layout.bins.len(),
            incomplete_bins: layout.incomplete_bins,
        });
    }
    let (header, columns) = report.into_parts();
    let averaged = average_columns(&columns, &layout.bins);
    let report = Report::new(header, averaged).map_err(TrackError::Averaged)?;
    let Layout { runs, incomplete_bins, incomplete_bins_s, .. } = layout;
    Ok(Binned { report, runs, incomplete_bins, incomplete_bins_s })
}

/// Which samples make which bin, and which bins follow each other.
struct Layout {
    /// Samples of each complete bin.
    bins: Vec<Range<usize>>,
    /// Complete bins that follow each other.
    runs: Vec<Range<usize>>,
    incomplete_bins: usize,
    incomplete_bins_s: f64,
}

fn layout(time_s: &[f64], recorded_interval_s: f64) -> Layout {
    let hole_s = (GAP_INTERVALS * recorded_interval_s).max(0.5 * BIN_S);
    let mut layout =
        Layout { bins: Vec::new(), runs: Vec::new(), incomplete_bins: 0, incomplete_bins_s: 0.0 };
    for recorded in interval::split_at_gaps(time_s, hole_s) {
        let mut run_start = layout.bins.len();
        let mut bin_end_s = time_s[recorded.start] + BIN_S;
        let mut sample = recorded.start;
        while sample < recorded.end {
            let start = sample;
            while sample < recorded.end && time_s[sample] < bin_end_s - interval::TIME_TOLERANCE_S {
                sample += 1;
            }
            bin_end_s += BIN_S;
            if is_complete(time_s, &recorded, start..sample, recorded_interval_s) {
                layout.bins.push(start..sample);
            } else {
                layout.incomplete_bins += 1;
                layout.incomplete_bins_s += recorded_s(time_s, start..sample);
                end_run(&mut layout, &mut run_start);
            }
        }
        end_run(&mut layout, &mut run_start);
    }
    layout
}

/// Whether the samples of a bin stand for half of its time at least: each for the median step of the recording or of the steps around
/// it, whichever is longer. `recorded` are the samples between two holes.
fn is_complete(
    time_s: &[f64],
    recorded: &Range<usize>,
    bin: Range<usize>,
    recorded_interval_s: f64,
) -> bool {
    let is_half = |covered_s: f64| 2.0 * covered_s >= BIN_S - interval::TIME_TOLERANCE_S;
    // Nearly always: the steps around are looked at only where a bin would be dropped.
    if is_half(bin.len() as f64 * recorded_interval_s) {
        return true;
    }
    let stands_for_s = |sample: usize| {
        let first = sample.saturating_sub(STEPS_AROUND).max(recorded.start);
        let last = (sample + STEPS_AROUND).min(recorded.end - 1);
        if first == last {
            return recorded_interval_s;
        }
        interval::median_step_s(&time_s[first..=last]).max(recorded_interval_s)
    };
    is_half(bin.map(stands_for_s).sum())
}

/// The time for which samples were recorded: a sample beside a hole stands for the step on its other side.
fn recorded_s(time_s: &[f64], samples: Range<usize>) -> f64 {
    let step_s = |first: usize| Some(time_s.get(first + 1)? - time_s.get(first)?);
    let shorter_s = |sample: usize| {
        let before_s = sample.checked_sub(1).and_then(step_s).unwrap_or(BIN_S);
        before_s.min(step_s(sample).unwrap_or(BIN_S)).min(BIN_S)
    };
    samples.map(shorter_s).sum()
}

fn end_run(layout: &mut Layout, run_start: &mut usize) {
    let end = layout.bins.len();
    if end > *run_start {
        layout.runs.push(*run_start..end);
        *run_start = end;
    }
}

fn average_columns(columns: &ReportColumns, bins: &[Range<usize>]) -> ReportColumns {
    let mean = |column: &Vec<f64>| means(column, bins);
    let engines = |engines: &Vec<Vec<f64>>| -> Vec<Vec<f64>> { engines.iter().map(mean).collect() };
    ReportColumns {
        time_s: mean(&columns.time_s),
        pressure_altitude_m: mean(&columns.pressure_altitude_m),
        static_air_temperature_k: columns.static_air_temperature_k.as_ref().map(mean),
        mach: mean(&columns.mach),
        true_airspeed_m_s: mean(&columns.true_airspeed_m_s),
        ground_speed_m_s: mean(&columns.ground_speed_m_s),
        roll_deg: columns.roll_deg.as_ref().map(mean),
        drift_deg: columns.drift_deg.as_ref().map(mean),
        n2_percent: columns.n2_percent.as_ref().map(engines),
        fuel_flow: match &columns.fuel_flow {
            FuelFlowColumns::PerEngine(flows) => FuelFlowColumns::PerEngine(engines(flows)),
            FuelFlowColumns::Total(total) => FuelFlowColumns::Total(mean(total)),
        },
        fuel_used_kg: mean(&columns.fuel_used_kg),
        optional: columns
            .optional
            .iter()
            .map(|(column, values)| (column, average_optional(column, values, bins)))
            .collect(),
    }
}

/// Means over the samples of bins, summed in the order of time.
fn means(column: &[f64], bins: &[Range<usize>]) -> Vec<f64> {
    let mut means = Vec::with_capacity(bins.len());
    // Each step of a sum waits for the one before: those of several bins are made side by side, as far as all of them go.
    let (several, rest) = bins.as_chunks::<BINS_AT_ONCE>();
    for bins in several {
        let values = bins.each_ref().map(|bin| &column[bin.clone()]);
        let shortest = bins.iter().map(Range::len).min().unwrap_or(0);
        let mut sums = [-0.0; BINS_AT_ONCE];
        let fronts = values.map(|values| &values[..shortest]);
        for sample in 0..shortest {
            for (sum, front) in sums.iter_mut().zip(&fronts) {
                *sum += front[sample];
            }
        }
        for (sum, values) in sums.iter_mut().zip(values) {
            *sum = values[shortest..].iter().fold(*sum, |sum, value| sum + value);
        }
        means.extend(sums.iter().zip(bins).map(|(sum, bin)| sum / bin.len() as f64));
    }
    means.extend(rest.iter().map(|bin| {
        let values = &column[bin.clone()];
        values.iter().sum::<f64>() / values.len() as f64
    }));
    means
}

fn average_optional(
    column: Column,
    values: &OptionalColumn,
    bins: &[Range<usize>],
) -> OptionalColumn {
    if !column.is_direction() {
        return available(values, bins);
    }
    let mut means = directions(values, bins);
    if column == Column::Longitude {
        // 0 … 360 back to the −180 … 180 in which longitudes are written.
        for mean_deg in means.iter_mut().flatten().filter(|mean_deg| **mean_deg > 180.0) {
            *mean_deg -= 360.0;
        }
    }
    means
}

/// Means over the samples that have a value.
fn available(column: &OptionalColumn, bins: &[Range<usize>]) -> OptionalColumn {
    let mean_of = |bin: &Range<usize>| {
        let (mut sum, mut count) = (0.0, 0_u32);
        for value in column[bin.clone()].iter().flatten() {
            sum += value;
            count += 1;
        }
        (count > 0).then(|| sum / f64::from(count))
    };
    bins.iter().map(mean_of).collect()
}

/// Mean directions over the samples that have a value.
fn directions(column: &OptionalColumn, bins: &[Range<usize>]) -> OptionalColumn {
    bins.iter()
        .map(|bin| mean_direction_deg(column[bin.clone()].iter().flatten().copied()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand, one sample a second: a full minute, half a minute, a hole of 40 s (longer than half a bin), a full minute. Bins
    /// begin anew behind the hole, and nothing follows anything over it.
    #[test]
    fn bins_begin_anew_behind_a_hole_of_half_a_bin() {
        let time_s: Vec<f64> = (0..90).chain(129..189).map(f64::from).collect();
        let found = layout(&time_s, 1.0);
        assert_eq!(found.bins, [0..60, 60..90, 90..150]);
        assert_eq!(found.runs, [0..2, 2..3]);
        assert_eq!(found.incomplete_bins, 0);
    }

    /// By hand: 200 s at one sample a second, then 300 s at one in four, as at the top of climb. The median step is 1 s: in 15 samples
    /// of a minute half of 60 would be missing. The minute from 180 s on has 20 samples of the one rate and 10 of the other, 20 + 40 s;
    /// behind the last full minute five samples stand for 20 s.
    #[test]
    fn a_rate_that_changes_costs_no_bin() {
        let slow = (0..75).map(|sample| 200 + 4 * sample);
        let time_s: Vec<f64> = (0..200).chain(slow).map(f64::from).collect();
        let found = layout(&time_s, 1.0);
        let counts: Vec<usize> = found.bins.iter().map(Range::len).collect();
        assert_eq!(counts, [60, 60, 60, 30, 15, 15, 15, 15]);
        assert_eq!(found.runs, std::slice::from_ref(&(0..8)));
        assert_eq!((found.incomplete_bins, found.incomplete_bins_s), (1, 20.0));
        // And slower first; a minute of which one sample in twelve is left is none, whatever the rate of the rest.
        let slow = (0..75).map(|sample| 4 * sample);
        let fast = (300..800).filter(|second| !(420..480).contains(second) || second % 12 == 0);
        let time_s: Vec<f64> = slow.chain(fast).map(f64::from).collect();
        let found = layout(&time_s, 1.0);
        let counts: Vec<usize> = found.bins.iter().map(Range::len).collect();
        assert_eq!(counts, [15, 15, 15, 15, 15, 60, 60, 60, 60, 60, 60, 60]);
        // Five samples beside steps of 12 s, of which the first follows a step of 1 s, and 20 of the last minute.
        assert_eq!((found.incomplete_bins, found.incomplete_bins_s), (2, 4.0 * 12.0 + 1.0 + 20.0));
    }

    /// Oracle: each bin by itself, to the bit.
    #[test]
    fn sums_side_by_side_are_those_of_each_bin() {
        let column: Vec<f64> = (0..1000).map(|i| (f64::from(i) * 0.7).sin() / 3.0).collect();
        let ends = [
            0, 60, 119, 180, 240, 300, 301, 360, 420, 480, 541, 600, 660, 700, 760, 820, 899, 1000,
        ];
        let bins: Vec<Range<usize>> = ends.windows(2).map(|ends| ends[0]..ends[1]).collect();
        let alone = bins.iter().map(|bin| {
            let values = &column[bin.clone()];
            values.iter().sum::<f64>() / values.len() as f64
        });
        let bits = |means: Vec<f64>| means.into_iter().map(f64::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(means(&column, &bins)), bits(alone.collect()));
    }

    /// Ten seconds are no bin: where a recording begins or ends with them, there is no run without bins.
    #[test]
    fn incomplete_bins_end_runs_and_are_none() {
        let time_s: Vec<f64> = (0..10).chain(200..270).chain(400..410).map(f64::from).collect();
        let found = layout(&time_s, 1.0);
        assert_eq!(found.bins, std::slice::from_ref(&(10..70)));
        assert!(found.runs.iter().eq([&(0..1)]), "{:?}", found.runs);
        assert_eq!(found.incomplete_bins, 3);
    }
}
