//! Whether the recording is within the ranges of the report's format: absurd effects make absurd recordings.

use flight::column::Column;
use flight::{FuelFlowColumns, Report};

/// A recorded value that the format refuses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OutOfRange {
    pub(super) column: Column,
    pub(super) value: f64,
    pub(super) words: &'static str,
}

/// Fuel quantity may exceed fuel on board by this factor: a rule of the format.
const FUEL_QUANTITY_FACTOR: f64 = 1.02;

/// The first value out of range, column by column.
pub(super) fn check_ranges(report: &Report) -> Result<(), OutOfRange> {
    let columns = report.columns();
    let required: [(Column, Option<&Vec<f64>>); 7] = [
        (Column::PressureAltitude, Some(&columns.pressure_altitude_m)),
        (Column::StaticAirTemperature, columns.static_air_temperature_k.as_ref()),
        (Column::Mach, Some(&columns.mach)),
        (Column::TrueAirspeed, Some(&columns.true_airspeed_m_s)),
        (Column::GroundSpeed, Some(&columns.ground_speed_m_s)),
        (Column::Roll, columns.roll_deg.as_ref()),
        (Column::Drift, columns.drift_deg.as_ref()),
    ];
    for (column, values) in required {
        for value in values.into_iter().flatten() {
            check(column, *value)?;
        }
    }
    for (engine, values) in (1..).zip(columns.n2_percent.iter().flatten()) {
        for value in values {
            check(Column::N2(engine), *value)?;
        }
    }
    let engines = report.engines().unwrap_or(1) as f64;
    match &columns.fuel_flow {
        FuelFlowColumns::PerEngine(flows) => {
            for (engine, values) in (1..).zip(flows) {
                for value in values {
                    check(Column::FuelFlowEngine(engine), *value)?;
                }
            }
        }
        FuelFlowColumns::Total(values) => {
            for value in values {
                check(Column::FuelFlowTotal, *value / engines)?;
            }
        }
    }
    let fuel_on_board_kg = report.header().fuel_on_board.to_kilograms();
    for value in &columns.fuel_used_kg {
        check_up_to(Column::FuelUsed, *value, fuel_on_board_kg)?;
    }
    for (column, values) in columns.optional.iter() {
        for value in values.iter().flatten() {
            if column == Column::FuelQuantity {
                check_up_to(column, *value, FUEL_QUANTITY_FACTOR * fuel_on_board_kg)?;
            } else {
                check(column, *value)?;
            }
        }
    }
    Ok(())
}

fn check(column: Column, value: f64) -> Result<(), OutOfRange> {
    let range = column.range();
    let low = range
        .minimum
        .is_some_and(|minimum| value < minimum || (range.minimum_excluded && value <= minimum));
    let high = range.maximum.is_some_and(|maximum| value > maximum);
    if low || high || value.is_nan() {
        return Err(OutOfRange { column, value, words: range.words });
    }
    Ok(())
}

fn check_up_to(column: Column, value: f64, maximum: f64) -> Result<(), OutOfRange> {
    check(column, value)?;
    if value > maximum {
        return Err(OutOfRange { column, value, words: column.range().words });
    }
    Ok(())
}
