//! Reports whose rows are averaged points and not samples.

use flight::{Report, SampleRun, Sampling, Track, TrackParts};

use crate::{TrackError, mass, temperature};

/// The track of averaged points, each the mean over a stable frame of `averaged_over_s`: a run by itself.
///
/// Frames lie minutes or hours apart, so that no rate follows from them: along-path acceleration and vertical speed are
/// taken as zero, which is what the frame was selected for. Whoever judges the track must not count that as steadiness.
///
/// # Errors
/// [`TrackError`] where static air temperature is neither recorded nor assumed.
pub fn of_averaged_points(report: Report, averaged_over_s: f64) -> Result<Track, TrackError> {
    let (static_air_temperature_k, temperature_source) =
        temperature::static_air_temperature_k(&report)?;
    let mass_kg = mass::gross_mass_kg(&report);
    let runs = (0..report.len())
        .map(|point| SampleRun {
            samples: point..point + 1,
            acceleration_m_s2: vec![0.0],
            vertical_speed_m_s: vec![0.0],
        })
        .collect();
    let parts = TrackParts {
        report,
        sampling: Sampling::AveragedPoints { averaged_over_s },
        sample_interval_s: averaged_over_s,
        static_air_temperature_k,
        temperature_source,
        mass_kg,
        runs,
        dropped_runs: Vec::new(),
    };
    Ok(Track::new(parts)?)
}
