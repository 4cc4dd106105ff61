//! The report with the quantities derived from it.

use core::ops::Range;

use crate::Report;

/// How the track's samples came from the recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// Sample by sample as sent.
    AsSent,
    /// Averaged into bins, because the recording is faster than the trim criteria.
    AveragedToBins {
        /// Length of a bin, s.
        bin_s: f64,
        /// Median time step of the recording, s.
        recorded_interval_s: f64,
        /// Bins that were dropped because they held fewer than half of the samples a bin should hold.
        incomplete_bins: usize,
        /// Recorded time in those bins, s: for each of their samples the shorter of the steps before and behind it, at most a bin.
        incomplete_bins_s: f64,
    },
    /// Each sample was sent as the mean over a stable frame: its neighbors are other frames.
    AveragedPoints {
        /// Length of a frame as stated, s.
        averaged_over_s: f64,
    },
}

/// Where the static air temperature comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TemperatureSource {
    /// Recorded.
    Recorded,
    /// The ISA at pressure altitude plus a deviation, as the report's header assumes.
    AssumedIsa {
        /// Deviation from the ISA, K.
        isa_deviation_k: f64,
    },
}

/// A series of samples without a time gap, and the rates along it.
#[derive(Clone, Debug, PartialEq)]
pub struct SampleRun {
    /// Samples of the track, from 0.
    pub samples: Range<usize>,
    /// Along-path acceleration at each sample of the run: rate of ground speed, m/s².
    pub acceleration_m_s2: Vec<f64>,
    /// Rate of pressure altitude at each sample of the run, m/s.
    pub vertical_speed_m_s: Vec<f64>,
}

/// Why a run of samples cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum DroppedRunReason {
    /// Fewer than three samples between time gaps: no neighbor criterion can be judged.
    FewerThanThreeSamples,
}

/// A run that was dropped, with its reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DroppedRun {
    /// Samples of the track, from 0.
    pub samples: Range<usize>,
    /// The reason.
    pub reason: DroppedRunReason,
}

/// The parts of a [`Track`].
#[derive(Clone, Debug, PartialEq)]
pub struct TrackParts {
    /// The samples: the report as sent, or averaged into bins.
    pub report: Report,
    /// How they came from the recording.
    pub sampling: Sampling,
    /// Time Δt that each sample represents, s: the median time step of `report` as sent, or the length of a bin.
    pub sample_interval_s: f64,
    /// Static air temperature of each sample, K.
    pub static_air_temperature_k: Vec<f64>,
    /// Where it comes from.
    pub temperature_source: TemperatureSource,
    /// Gross mass of each sample, kg.
    pub mass_kg: Vec<f64>,
    /// Runs in order.
    pub runs: Vec<SampleRun>,
    /// Runs that are too short.
    pub dropped_runs: Vec<DroppedRun>,
}

/// A report with mass, along-path acceleration and vertical speed; its samples split into runs at time gaps.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    parts: TrackParts,
}

/// Why parts do not make a track.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TrackDataError {
    /// A derived column of another length than the samples it belongs to.
    #[error("{column} has {found} values, expected {expected}")]
    LengthsDiffer {
        /// Field name.
        column: &'static str,
        /// Values found.
        found: usize,
        /// Values expected.
        expected: usize,
    },
    /// Runs that overlap, run backwards or leave the samples.
    #[error("runs are not ordered within the {samples} samples")]
    RunsNotOrdered {
        /// Samples of the track.
        samples: usize,
    },
}

impl Track {
    /// Checks the parts against each other.
    ///
    /// # Errors
    /// [`TrackDataError`] for lengths that differ or runs out of order.
    pub fn new(parts: TrackParts) -> Result<Self, TrackDataError> {
        let samples = parts.report.len();
        let check = |column, found, expected| {
            if found == expected {
                Ok(())
            } else {
                Err(TrackDataError::LengthsDiffer { column, found, expected })
            }
        };
        check("static_air_temperature_k", parts.static_air_temperature_k.len(), samples)?;
        check("mass_kg", parts.mass_kg.len(), samples)?;
        let mut end = 0;
        for run in &parts.runs {
            if run.samples.start < end
                || run.samples.end > samples
                || run.samples.start >= run.samples.end
            {
                return Err(TrackDataError::RunsNotOrdered { samples });
            }
            end = run.samples.end;
            check("acceleration_m_s2", run.acceleration_m_s2.len(), run.samples.len())?;
            check("vertical_speed_m_s", run.vertical_speed_m_s.len(), run.samples.len())?;
        }
        Ok(Self { parts })
    }

    /// The samples that the track is made of.
    #[must_use]
    pub const fn report(&self) -> &Report {
        &self.parts.report
    }

    /// As sent, or averaged into bins.
    #[must_use]
    pub const fn sampling(&self) -> Sampling {
        self.parts.sampling
    }

    /// Time Δt that each sample represents, s: median time step as sent, or length of a bin.
    #[must_use]
    pub const fn sample_interval_s(&self) -> f64 {
        self.parts.sample_interval_s
    }

    /// Static air temperature of each sample, K.
    #[must_use]
    pub fn static_air_temperature_k(&self) -> &[f64] {
        &self.parts.static_air_temperature_k
    }

    /// Where the static air temperature comes from.
    #[must_use]
    pub const fn temperature_source(&self) -> TemperatureSource {
        self.parts.temperature_source
    }

    /// Gross mass of each sample, kg.
    #[must_use]
    pub fn mass_kg(&self) -> &[f64] {
        &self.parts.mass_kg
    }

    /// Runs without a time gap, in order.
    #[must_use]
    pub fn runs(&self) -> &[SampleRun] {
        &self.parts.runs
    }

    /// Runs that are too short, with reasons.
    #[must_use]
    pub fn dropped_runs(&self) -> &[DroppedRun] {
        &self.parts.dropped_runs
    }
}
