//! Step 4: the mean state over the kept samples of a segment.

use flight::column::Column;
use flight::{FuelFlowColumns, MAXIMUM_ENGINES, OptionalColumn, SampleRun, SegmentMeans, Track};
use units::mean_direction_deg;

const ENGINES: [u8; MAXIMUM_ENGINES] = [1, 2, 3, 4];

/// Means over the samples `rows` of the track: increasing, within `run`, at least one.
///
/// Arithmetic means, summed in the order of time; mean directions for longitude (−180 … 180) and true heading
/// (0 … 360); an optional column over the samples that have a value. Total fuel flow is the sum of the engines' means.
///
/// # Source
/// `[steadiness.13]`, `[steadiness.14]`; Ghazi et al. 2020, eq. (21) for the total.
pub(crate) fn over(track: &Track, run: &SampleRun, rows: &[usize]) -> SegmentMeans {
    let columns = track.report().columns();
    let mean = |column: &[f64]| mean_of(rows.iter().map(|row| column[*row]), rows.len());
    // Rates are stored from the start of their run.
    let rate =
        |rates: &[f64]| mean_of(rows.iter().map(|row| rates[*row - run.samples.start]), rows.len());
    let optional = |column| available(columns.optional.get(column)?, rows);
    let direction = |column| {
        let values = columns.optional.get(column)?;
        mean_direction_deg(rows.iter().filter_map(|row| values[*row]))
    };
    let by_engine = |column: fn(u8) -> Column| ENGINES.map(|engine| optional(column(engine)));
    let (fuel_flow_total_kg_s, fuel_flow_engine_kg_s) = match &columns.fuel_flow {
        FuelFlowColumns::Total(total) => (mean(total), Vec::new()),
        FuelFlowColumns::PerEngine(engines) => {
            let flows: Vec<f64> = engines.iter().map(|engine| mean(engine)).collect();
            (flows.iter().sum(), flows)
        }
    };
    SegmentMeans {
        time_s: mean(&columns.time_s),
        pressure_altitude_m: mean(&columns.pressure_altitude_m),
        static_air_temperature_k: mean(track.static_air_temperature_k()),
        mach: mean(&columns.mach),
        true_airspeed_m_s: mean(&columns.true_airspeed_m_s),
        ground_speed_m_s: mean(&columns.ground_speed_m_s),
        acceleration_m_s2: rate(&run.acceleration_m_s2),
        vertical_speed_m_s: rate(&run.vertical_speed_m_s),
        mass_kg: mean(track.mass_kg()),
        fuel_flow_total_kg_s,
        fuel_flow_engine_kg_s,
        fuel_used_kg: mean(&columns.fuel_used_kg),
        drift_deg: columns.drift_deg.as_deref().map(mean),
        roll_deg: columns.roll_deg.as_deref().map(mean),
        roll_squared_deg2: columns
            .roll_deg
            .as_ref()
            .map(|roll| mean_of(rows.iter().map(|row| roll[*row] * roll[*row]), rows.len())),
        n2_percent: columns.n2_percent.iter().flatten().map(|engine| mean(engine)).collect(),
        latitude_deg: optional(Column::Latitude),
        longitude_deg: direction(Column::Longitude)
            .map(|mean_deg| if mean_deg > 180.0 { mean_deg - 360.0 } else { mean_deg }),
        true_heading_deg: direction(Column::TrueHeading),
        center_of_gravity_percent_mac: optional(Column::CenterOfGravity),
        total_air_temperature_k: optional(Column::TotalAirTemperature),
        n1_percent: by_engine(Column::N1),
        exhaust_gas_temperature_k: by_engine(Column::ExhaustGasTemperature),
        fuel_quantity_kg: optional(Column::FuelQuantity),
        anti_ice: optional(Column::AntiIce),
    }
}

fn mean_of(values: impl Iterator<Item = f64>, count: usize) -> f64 {
    values.sum::<f64>() / count as f64
}

/// Mean over the samples that have a value; `None` where none has.
fn available(column: &OptionalColumn, rows: &[usize]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0_u32);
    for value in rows.iter().filter_map(|row| column[*row]) {
        sum += value;
        count += 1;
    }
    (count > 0).then(|| sum / f64::from(count))
}
