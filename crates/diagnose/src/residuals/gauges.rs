//! Tank gauges against flow meters, flight by flight.

use effects::EffectModel;
use flight::effect::EffectId;

use crate::library::Library;
use crate::residuals::rows::{GaugeRow, SegmentRow};
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
