//! Faults of a recording: missing rows, missing values, stuck values.

use flight::{FuelFlowColumns, ReportColumns};

use super::Faults;
use crate::random::Stream;

/// Number of rows that a report must keep.
const LEAST_ROWS: usize = 3;

/// Applies the faults to finished columns. Nothing is drawn for a fault that does not occur.
pub(crate) fn apply(rows: &mut ReportColumns, faults: &Faults, random: &mut Stream) {
    if faults.stuck_per_h > 0.0 {
        stick(rows, faults, random);
    }
    if faults.drop_out > 0.0 {
        for column in rows.optional.values_mut() {
            for value in column.iter_mut() {
                if random.chance(faults.drop_out) {
                    *value = None;
                }
            }
        }
    }
    if faults.missing_sample > 0.0 {
        let keep: Vec<bool> =
            rows.time_s.iter().map(|_| !random.chance(faults.missing_sample)).collect();
        if keep.iter().filter(|kept| **kept).count() >= LEAST_ROWS {
            for column in full_columns(rows) {
                retain(column, &keep);
            }
            for column in rows.optional.values_mut() {
                retain(column, &keep);
            }
            retain(&mut rows.time_s, &keep);
        }
    }
}

fn retain<T>(column: &mut Vec<T>, keep: &[bool]) {
    let mut kept = keep.iter();
    column.retain(|_| kept.next().copied().unwrap_or(true));
}

/// A Poisson process of stuck values over the flight, each in one required channel.
fn stick(rows: &mut ReportColumns, faults: &Faults, random: &mut Stream) {
    let times = rows.time_s.clone();
    let Some(end_s) = times.last().copied() else { return };
    let mean_gap_s = 3600.0 / faults.stuck_per_h;
    let mut from_s = times[0] + random.exponential(mean_gap_s);
    while from_s < end_s {
        let to_s = from_s + random.exponential(60.0 * faults.stuck_min);
        // Fuel used does not get stuck: a totalizer that stops is another fault.
        let mut columns = full_columns(rows);
        columns.remove(FUEL_USED);
        let which = random.below(columns.len());
        let mut held = None;
        for (time_s, value) in times.iter().zip(columns[which].iter_mut()) {
            if (from_s..to_s).contains(time_s) {
                *value = *held.get_or_insert(*value);
            }
        }
        from_s = to_s + random.exponential(mean_gap_s);
    }
}

/// Index of fuel used in [`full_columns`].
const FUEL_USED: usize = 0;

/// Every required column but time.
fn full_columns(rows: &mut ReportColumns) -> Vec<&mut Vec<f64>> {
    let ReportColumns {
        pressure_altitude_m,
        mach,
        true_airspeed_m_s,
        ground_speed_m_s,
        static_air_temperature_k,
        roll_deg,
        drift_deg,
        n2_percent,
        fuel_flow,
        fuel_used_kg,
        ..
    } = rows;
    let mut all =
        vec![fuel_used_kg, pressure_altitude_m, mach, true_airspeed_m_s, ground_speed_m_s];
    all.extend(static_air_temperature_k.as_mut());
    all.extend(roll_deg.as_mut());
    all.extend(drift_deg.as_mut());
    all.extend(n2_percent.iter_mut().flatten());
    match fuel_flow {
        FuelFlowColumns::PerEngine(engines) => all.extend(engines),
        FuelFlowColumns::Total(total) => all.push(total),
    }
    all
}
