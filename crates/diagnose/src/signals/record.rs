//! What is diagnosed: flights with their stabilised segments.

use flight::column::Column;
use flight::{Segment, Track};

use crate::priors::GAUGE_DEVIATION_KG;
use crate::thresholds::SMALLEST_BURN_KG;

/// One flight: its stabilised segments, and what its tank gauges say.
#[derive(Clone, Copy, Debug)]
pub struct FlightRecord<'a> {
    /// Segments of this flight in order of time.
    pub segments: &'a [Segment],
    /// Fuel burned by gauges and by meters, where fuel quantity is recorded.
    pub gauges: Option<GaugeBurn>,
}

/// Fuel burned between two moments of one flight, by the tank gauges and by the flow meters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaugeBurn {
    /// Fall of the gauged fuel quantity, kg.
    pub gauged_kg: f64,
    /// Integral of the recorded fuel flow of all engines, kg.
    pub metered_kg: f64,
    /// Standard deviation of the gauged fall, kg.
    pub deviation_kg: f64,
}

impl GaugeBurn {
    /// Gauges against meters from the first to the last sample with a gauge reading; `None` where fuel quantity is not
    /// recorded or too little was burned between.
    #[must_use]
    pub fn of_track(track: &Track) -> Option<Self> {
        let columns = track.report().columns();
        let quantity = columns.optional.get(Column::FuelQuantity)?;
        let first = quantity.iter().position(Option::is_some)?;
        let last = quantity.iter().rposition(Option::is_some)?;
        let gauged_kg = quantity[first]? - quantity[last]?;
        let metered_kg: f64 = (first..last)
            .map(|i| {
                let step_s = columns.time_s[i + 1] - columns.time_s[i];
                let mean =
                    0.5 * (columns.fuel_flow.total_kg_s(i) + columns.fuel_flow.total_kg_s(i + 1));
                mean * step_s
            })
            .sum();
        (gauged_kg > SMALLEST_BURN_KG && metered_kg > SMALLEST_BURN_KG).then_some(Self {
            gauged_kg,
            metered_kg,
            deviation_kg: GAUGE_DEVIATION_KG,
        })
    }
}
