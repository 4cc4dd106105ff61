//! Tank gauges against flow meters, flight by flight.

use effects::EffectModel;
use flight::effect::EffectId;

use crate::baseline::gauge_level::{GaugeLevel, GaugedFlight};
use crate::library::Library;
use crate::residuals::rows::{FlightRows, GaugeRow, SegmentRow};
use crate::signals::record::GaugeBurn;

pub(crate) fn gauge_row(
    burn: GaugeBurn,
    model: &EffectModel<'_>,
    library: &Library,
    segments: &[SegmentRow],
) -> GaugeRow {
    let count = segments.len().max(1) as f64;
    // Meter errors that the model contains are undone here as they are in the segments' fuel flow.
    let metered_too_much: f64 =
        segments.iter().map(|row| model.metered_over_burnt(&row.point).ln()).sum::<f64>() / count;
    let share = |engine: u8| {
        let index = usize::from(engine).wrapping_sub(1);
        segments
            .iter()
            .map(|row| row.point.fuel_flow_share.get(index).copied().unwrap_or(0.0))
            .sum::<f64>()
            / count
    };
    let signatures = library
        .columns
        .iter()
        .map(|column| match library.effects[column.effect].id {
            EffectId::FuelFlowGain => -0.01,
            EffectId::FuelFlowGainEngine(engine) => -0.01 * share(engine),
            _ => 0.0,
        })
        .collect();
    GaugeRow {
        residual: (burn.gauged_kg / burn.metered_kg).ln() + metered_too_much,
        deviation: (burn.deviation_kg / burn.metered_kg).max(1e-6),
        signatures,
    }
}

/// What flights with gauges have in common; `None` of flights without.
pub(crate) fn level_of(flights: &[FlightRows]) -> Option<GaugeLevel> {
    let gauged: Vec<GaugedFlight> = flights.iter().filter_map(gauged).collect();
    GaugeLevel::of(&gauged)
}

/// Flights' gauges against what is known of them: the level taken off, the scatter what it was, and what lies far from the other
/// flights weighed down.
pub(crate) fn calibrate(flights: &mut [FlightRows], learnt: Option<&GaugeLevel>) {
    let Some(own) = level_of(flights) else { return };
    let mean = learnt.map_or(0.0, |learnt| learnt.mean);
    let scatter = learnt.map_or(own.scatter, |learnt| learnt.scatter);
    for flight in flights {
        let weight = gauged(flight).map_or(1.0, |gauged| own.weight(&gauged));
        if let Some(gauge) = &mut flight.gauge {
            gauge.residual -= mean;
            gauge.deviation *= scatter / weight.sqrt();
        }
    }
}

fn gauged(flight: &FlightRows) -> Option<GaugedFlight> {
    let GaugeRow { residual, deviation, .. } = flight.gauge.as_ref()?;
    Some(GaugedFlight { value: *residual, deviation: *deviation, share: flight.share })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flight(residual: f64) -> FlightRows {
        let gauge = GaugeRow { residual, deviation: 0.004, signatures: vec![] };
        FlightRows { segments: 0..1, gauge: Some(gauge), start_s: 0.0, share: 1.0 }
    }

    /// By hand: twelve flights 1 % above what was learnt, one of which says 70 %.
    #[test]
    fn the_learnt_level_is_taken_off_and_an_absurd_flight_counts_little() {
        let learnt = GaugeLevel { flights: 20, mean: 0.015, deviation: 0.001, scatter: 2.0 };
        let mut flights = vec![flight(0.025); 11];
        flights.push(flight(0.7));
        calibrate(&mut flights, Some(&learnt));
        let told = |k: usize| flights[k].gauge.as_ref().map(|row| (row.residual, row.deviation));
        let (residual, deviation) = told(0).unwrap();
        // Twice as much as stated, and a flight in the middle counts 5/4: 0.008/√1.25 = 0.00716.
        assert!((residual - 0.010).abs() < 1e-12 && (deviation - 0.00716).abs() < 1e-4);
        let (residual, deviation) = told(11).unwrap();
        assert!((residual - 0.685).abs() < 1e-12 && residual < 3.0 * deviation, "{deviation}");
        let mut without = vec![FlightRows { gauge: None, ..flight(0.0) }];
        calibrate(&mut without, Some(&learnt));
        assert!(level_of(&without).is_none());
    }
}
