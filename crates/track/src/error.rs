//! Why a report does not give a track.

use flight::{ReportDataError, TrackDataError};
use units::OutOfDomain;

use crate::{SAMPLE_INTERVAL_MAXIMUM_S, bins};

/// Why a report does not give a track, worded for the person who sent it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrackError {
    /// The recording is too slow for neighbor criteria.
    #[error(
        "median time step {sample_interval_s} s is above {SAMPLE_INTERVAL_MAXIMUM_S} s: \
         samples too far apart to judge steadiness, not segmented"
    )]
    SamplesTooFarApart {
        /// Median time step, s.
        sample_interval_s: f64,
    },
    /// Static air temperature is neither recorded nor assumed.
    #[error(
        "static air temperature is neither recorded nor assumed: \
         add a header line such as 'ASSUMED SAT=ISA+0' (deviation from the ISA in K)"
    )]
    StaticAirTemperatureMissing,
    /// The assumed static air temperature has no value at this pressure altitude.
    #[error("sample {sample}: no static air temperature to assume")]
    AssumedTemperatureUndefined {
        /// Sample from 0.
        sample: usize,
        /// The error of the atmosphere.
        source: OutOfDomain,
    },
    /// A fast recording too short or too patchy for three bins.
    #[error(
        "{bins} bins of {} s hold at least half of their samples, 3 are needed \
         ({incomplete_bins} incomplete)",
        bins::BIN_S
    )]
    TooFewBins {
        /// Bins with at least half of their samples.
        bins: usize,
        /// Bins with fewer.
        incomplete_bins: usize,
    },
    /// The averaged columns do not make a report.
    #[error("samples averaged into bins do not make a report")]
    Averaged(#[source] ReportDataError),
    /// The derived columns do not fit the samples.
    #[error("derived columns do not make a track")]
    Derived(#[from] TrackDataError),
}
