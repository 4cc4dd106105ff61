//! Static air temperature of each sample: recorded, or by the header's assumption.

use flight::{Assumption, Report, TemperatureSource};
use units::PressureAltitude;

use crate::TrackError;

/// Static air temperature of each sample, K, and its source. A recording takes precedence over an assumption.
pub(crate) fn static_air_temperature_k(
    report: &Report,
) -> Result<(Vec<f64>, TemperatureSource), TrackError> {
    let columns = report.columns();
    if let Some(recorded_k) = &columns.static_air_temperature_k {
        return Ok((recorded_k.clone(), TemperatureSource::Recorded));
    }
    let assumed = report.header().assumed.iter().find_map(|assumption| match assumption {
        Assumption::StaticAirTemperatureIsa { isa_deviation_k } => Some(*isa_deviation_k),
        Assumption::Other { .. } => None,
    });
    let Some(isa_deviation_k) = assumed else {
        return Err(TrackError::StaticAirTemperatureMissing);
    };
    let mut values_k = Vec::with_capacity(columns.pressure_altitude_m.len());
    for (sample, pressure_altitude_m) in columns.pressure_altitude_m.iter().enumerate() {
        let isa = atmos::isa::temperature(PressureAltitude::meters(*pressure_altitude_m))
            .map_err(|source| TrackError::AssumedTemperatureUndefined { sample, source })?;
        values_k.push(isa.to_kelvin() + isa_deviation_k);
    }
    Ok((values_k, TemperatureSource::AssumedIsa { isa_deviation_k }))
}
