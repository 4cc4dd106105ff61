//! What is diagnosed: flights with their stabilised segments.

use flight::column::Column;
use flight::{Segment, Track};
use serde::{Deserialize, Serialize};

use crate::priors::GAUGE_DEVIATION_KG;
use crate::thresholds::{LONGEST_STEP, SMALLEST_BURN_KG};

/// One flight: its stabilised segments, and what its tank gauges say.
#[derive(Clone, Copy, Debug)]
pub struct FlightRecord<'a> {
    /// Segments of this flight in order of time.
    pub segments: &'a [Segment],
    /// Fuel burned by gauges and by meters, where fuel quantity is recorded.
    pub gauges: Option<GaugeBurn>,
}

/// Fuel burned between two moments of one flight, by the tank gauges and by the flow meters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaugeBurn {
    /// Fall of the gauged fuel quantity, kg.
    pub gauged_kg: f64,
    /// Integral of the recorded fuel flow of all engines, kg.
    pub metered_kg: f64,
    /// Standard deviation of the gauged fall, kg.
    pub deviation_kg: f64,
}

impl GaugeBurn {
    /// Gauges against meters while the recording runs, from the first to the last sample with a gauge reading in each part of it
    /// that has no hole: nobody knows what flowed in a hole. `None` where fuel quantity is not recorded or too little was burned
    /// between.
    #[must_use]
    pub fn of_track(track: &Track) -> Option<Self> {
        let columns = track.report().columns();
        let quantity = columns.optional.get(Column::FuelQuantity)?;
        let time_s = &columns.time_s;
        let usual_s = usual_step_s(time_s)?;
        let is_joined =
            |i: &usize, next: &usize| time_s[*next] - time_s[*i] <= LONGEST_STEP * usual_s;
        let samples: Vec<usize> = (0..time_s.len()).collect();
        let (mut gauged_kg, mut metered_kg, mut runs) = (0.0, 0.0, 0.0);
        for run in samples.chunk_by(is_joined) {
            let mut read = run.iter().filter_map(|&i| Some((i, quantity[i]?)));
            let Some((first, full_kg)) = read.next() else { continue };
            let Some((last, left_kg)) = read.next_back() else { continue };
            gauged_kg += full_kg - left_kg;
            metered_kg += metered_between_kg(track, first, last);
            runs += 1.0;
        }
        (gauged_kg > SMALLEST_BURN_KG && metered_kg > SMALLEST_BURN_KG).then_some(Self {
            gauged_kg,
            metered_kg,
            deviation_kg: GAUGE_DEVIATION_KG * f64::sqrt(runs),
        })
    }
}

/// The usual time from one sample to the next: their median.
fn usual_step_s(time_s: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied()
}

/// Integral of the recorded fuel flow between two samples, by trapezoids.
fn metered_between_kg(track: &Track, first: usize, last: usize) -> f64 {
    let columns = track.report().columns();
    let step = |i: usize| {
        let step_s = columns.time_s[i + 1] - columns.time_s[i];
        let flows = [i, i + 1].map(|i| columns.fuel_flow.total_kg_s(i));
        0.5 * (flows[0] + flows[1]) * step_s
    };
    (first..last).map(step).sum()
}
