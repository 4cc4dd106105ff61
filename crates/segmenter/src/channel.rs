//! One channel of one run with its limits converted to the stored unit, so that kernels compare plain numbers.

use flight::{SampleRun, TemperatureSource, Track};

use crate::criteria::TOLERANCE;
use crate::{Criterion, TrimCriteria};

/// The values of a channel along a run.
pub(crate) struct Channel<'a> {
    pub(crate) criterion: Criterion,
    pub(crate) values: &'a [f64],
    /// Limit plus 1e-9, both of the limit's unit, in the stored unit.
    pub(crate) limit: f64,
    /// 1e-9 of the limit's unit in the stored unit.
    pub(crate) tolerance: f64,
    /// Largest distance from the mean of a piece, in standard deviations.
    pub(crate) standard_deviations: f64,
}

/// The channels that were recorded, in the order of the criteria; N2 once per engine.
///
/// An assumed static air temperature is not a channel: it would judge pressure altitude a second time.
pub(crate) fn of_run<'a>(
    track: &'a Track,
    run: &'a SampleRun,
    criteria: &TrimCriteria,
) -> Vec<Channel<'a>> {
    let columns = track.report().columns();
    let samples = run.samples.clone();
    let engines = columns.n2_percent.as_deref().unwrap_or_default();
    let mut channels = Vec::with_capacity(Criterion::ALL.len() + engines.len());
    let mut add = |criterion: Criterion, values: &'a [f64]| {
        let stored_per_unit = criterion.stored_per_unit();
        channels.push(Channel {
            criterion,
            values,
            limit: (criteria.limit(criterion) + TOLERANCE) * stored_per_unit,
            tolerance: TOLERANCE * stored_per_unit,
            standard_deviations: criteria.outlier_standard_deviations,
        });
    };
    add(Criterion::PressureAltitude, &columns.pressure_altitude_m[samples.clone()]);
    add(Criterion::VerticalSpeed, &run.vertical_speed_m_s);
    add(Criterion::Mach, &columns.mach[samples.clone()]);
    add(Criterion::GroundSpeed, &columns.ground_speed_m_s[samples.clone()]);
    if track.temperature_source() == TemperatureSource::Recorded {
        let values_k = &track.static_air_temperature_k()[samples.clone()];
        add(Criterion::StaticAirTemperature, values_k);
    }
    for engine in engines {
        add(Criterion::N2, &engine[samples.clone()]);
    }
    if let Some(drift_deg) = &columns.drift_deg {
        add(Criterion::Drift, &drift_deg[samples.clone()]);
    }
    if let Some(roll_deg) = &columns.roll_deg {
        add(Criterion::Roll, &roll_deg[samples]);
    }
    channels
}
