//! From a [`Report`] to a [`Track`]: sample runs, mass, along-path acceleration and vertical speed.
//!
//! What it is: everything that is known about the samples of one cruise before any of them is judged. What it is not:
//! there is no trim criterion here and no performance model; samples are dropped only in runs too short for a rate, and
//! those are listed in [`Track::dropped_runs`].
//!
//! The one design decision: rates are taken before anything is discarded. A forward difference belongs to the start of
//! its step, so the last kept sample of a stable piece still has the true rate of the step that follows it. The
//! acceleration of an averaged bin is the rate at the bin's own mean time instead, which is that of its fuel flow.
//!
//! Limits: a step above 1.5 Δt ends a run, Δt being the median step. A recording with Δt below 59 s is averaged into
//! bins of 60 s ([`bins`]); one with Δt above 90 s is refused, because its neighbors do not indicate steadiness. Static
//! air temperature that was not recorded is taken from the header's assumption or refused, never guessed.
//!
//! ```
//! use flight::{FlightIdentity, FuelFlowColumns, Report, OptionalColumns, ReportColumns, ReportHeader, Timestamp};
//! use units::Mass;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let header = ReportHeader {
//!     aircraft_type: "C750".to_owned(),
//!     identity: FlightIdentity {
//!         tail: "T-001".to_owned(),
//!         start: "2018-05-20T14:14:21Z".parse()?,
//!         flight: "0007".to_owned(),
//!     },
//!     zero_fuel_mass: Mass::kilograms(11_000.0),
//!     fuel_on_board: Mass::kilograms(3_000.0),
//!     lower_heating_value_mj_kg: None,
//!     missing: vec![],
//!     assumed: vec![],
//!     notes: vec![],
//! };
//! let columns = ReportColumns {
//!     time_s: vec![0.0, 60.0, 120.0],
//!     pressure_altitude_m: vec![12_000.0; 3],
//!     static_air_temperature_k: Some(vec![217.0; 3]),
//!     mach: vec![0.80; 3],
//!     true_airspeed_m_s: vec![236.0; 3],
//!     ground_speed_m_s: vec![230.0, 230.6, 231.2],
//!     roll_deg: Some(vec![0.0; 3]),
//!     drift_deg: Some(vec![2.0; 3]),
//!     n2_percent: Some(vec![vec![89.4; 3]; 2]),
//!     fuel_flow: FuelFlowColumns::PerEngine(vec![vec![0.083; 3]; 2]),
//!     fuel_used_kg: vec![600.0, 610.0, 620.0],
//!     optional: OptionalColumns::default(),
//! };
//! let track = track::derive(Report::new(header, columns)?)?;
//! assert_eq!(track.mass_kg(), [13_400.0, 13_390.0, 13_380.0]);
//! assert!((track.runs()[0].acceleration_m_s2[0] - 0.01).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```

pub mod bins;
mod error;
mod interval;
mod mass;
mod points;
mod rate;
mod temperature;

use core::ops::Range;

use flight::{DroppedRun, DroppedRunReason, Report, SampleRun, Sampling, Track, TrackParts};

pub use error::TrackError;
pub use interval::{GAP_INTERVALS, SAMPLE_INTERVAL_MAXIMUM_S};
pub use mass::gross_mass;
pub use points::of_averaged_points;

/// Fewest samples of a run: a neighbor criterion compares a run's first sample with the next two.
pub const RUN_SAMPLES_MINIMUM: usize = 3;

/// The track of a report: samples as sent or averaged into bins, split into runs, with mass and rates.
///
/// # Errors
/// [`TrackError`] where the samples are too far apart, where static air temperature is neither recorded nor assumed,
/// and where averaging leaves fewer than three bins.
///
/// # Source
/// `[steadiness.1]` to `[steadiness.7]` and `[steadiness.15]`; Ghazi et al. 2020, eqs. (16) to (18).
pub fn derive(report: Report) -> Result<Track, TrackError> {
    let recorded_interval_s = interval::median_step_s(&report.columns().time_s);
    interval::check_interval(recorded_interval_s)?;
    let (report, sampling, sample_interval_s, pieces) =
        if bins::is_faster_than_bins(recorded_interval_s) {
            let binned = bins::average(report, recorded_interval_s)?;
            let sampling = Sampling::AveragedToBins {
                bin_s: bins::BIN_S,
                recorded_interval_s,
                incomplete_bins: binned.incomplete_bins,
                incomplete_bins_s: binned.incomplete_bins_s,
            };
            (binned.report, sampling, bins::BIN_S, binned.runs)
        } else {
            let pieces = interval::split_at_gaps(
                &report.columns().time_s,
                GAP_INTERVALS * recorded_interval_s,
            );
            (report, Sampling::AsSent, recorded_interval_s, pieces)
        };
    let (static_air_temperature_k, temperature_source) =
        temperature::static_air_temperature_k(&report)?;
    let mass_kg = mass::gross_mass_kg(&report);
    let acceleration = match sampling {
        Sampling::AveragedToBins { .. } => rate::at_own_times,
        Sampling::AsSent | Sampling::AveragedPoints { .. } => rate::along_run,
    };
    let (runs, dropped_runs) = runs(&report, pieces, acceleration);
    let parts = TrackParts {
        report,
        sampling,
        sample_interval_s,
        static_air_temperature_k,
        temperature_source,
        mass_kg,
        runs,
        dropped_runs,
    };
    Ok(Track::new(parts)?)
}

/// Rates along each piece that is long enough for them; the others with their reason.
fn runs(
    report: &Report,
    pieces: Vec<Range<usize>>,
    acceleration: fn(&[f64], &[f64]) -> Vec<f64>,
) -> (Vec<SampleRun>, Vec<DroppedRun>) {
    let columns = report.columns();
    let (mut runs, mut dropped) = (Vec::new(), Vec::new());
    for samples in pieces {
        if samples.len() < RUN_SAMPLES_MINIMUM {
            let reason = DroppedRunReason::FewerThanThreeSamples;
            dropped.push(DroppedRun { samples, reason });
            continue;
        }
        let time_s = &columns.time_s[samples.clone()];
        runs.push(SampleRun {
            acceleration_m_s2: acceleration(time_s, &columns.ground_speed_m_s[samples.clone()]),
            // A trim criterion looks at it: which samples are steady does not depend on how acceleration is taken.
            vertical_speed_m_s: rate::along_run(
                time_s,
                &columns.pressure_altitude_m[samples.clone()],
            ),
            samples,
        });
    }
    (runs, dropped)
}
