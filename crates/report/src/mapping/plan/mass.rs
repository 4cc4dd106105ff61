//! Where mass comes from, checked.

use flight::column::Column;
use units::{Mass, check_within};

use super::sources::{Inputs, fill, known_unit};
use super::{Fill, Load, MassPlan};
use crate::mapping::MappingError;
use crate::mapping::file::{Amount, MassSource, WithUnit};

fn mass(WithUnit(value, unit): &WithUnit, what: &'static str) -> Result<Mass, MappingError> {
    let unit = known_unit(Column::FuelUsed, unit)?;
    let mass_kg = check_within(what, "kg", value * unit.factor, f64::MIN_POSITIVE, 1e7)?;
    Ok(Mass::kilograms(mass_kg))
}

pub(super) fn mass_plan(source: MassSource, inputs: &mut Inputs) -> Result<MassPlan, MappingError> {
    Ok(match source {
        MassSource::GrossMass {
            column,
            unit,
            scale,
            hold_s,
            interpolate_s,
            zero_fuel_weight,
            largest_rise_kg,
        } => {
            let mass_column = inputs.conversion(Column::FuelUsed, column, &unit, scale)?;
            inputs.0[mass_column.input].fill = fill(hold_s, interpolate_s)?;
            MassPlan::GrossMass {
                mass: mass_column,
                zero_fuel_mass: zero_fuel_weight
                    .map(|value| mass(&value, "zero-fuel mass"))
                    .transpose()?,
                largest_rise_kg: largest_rise(largest_rise_kg)?,
            }
        }
        MassSource::FuelUsed { column, unit, scale, zero_fuel_weight, fuel_on_board } => {
            MassPlan::FuelUsed {
                fuel_used: vec![inputs.conversion(Column::FuelUsed, column, &unit, scale)?],
                zero_fuel_mass: Load::Known(mass(&zero_fuel_weight, "zero-fuel mass")?),
                fuel_on_board: Load::Known(mass(&fuel_on_board, "fuel on board")?),
            }
        }
        MassSource::LoadSheet { fuel_used, zero_fuel_weight, fuel_on_board } => {
            let (columns, unit) = match fuel_used {
                Amount::Column(column, unit) => (vec![column], unit),
                Amount::Columns(columns, unit) if !columns.is_empty() => (columns, unit),
                Amount::Value(..) | Amount::Columns(..) => {
                    return Err(MappingError::QuantityNotMapped { column: Column::FuelUsed });
                }
            };
            MassPlan::FuelUsed {
                fuel_used: columns
                    .into_iter()
                    .map(|column| inputs.conversion(Column::FuelUsed, column, &unit, 1.0))
                    .collect::<Result<_, _>>()?,
                zero_fuel_mass: load(zero_fuel_weight, "zero-fuel mass", inputs)?,
                fuel_on_board: load(fuel_on_board, "fuel on board", inputs)?,
            }
        }
        MassSource::ZeroFuelAndTanks { zero_fuel_weight, tanks, unit, largest_rise_kg } => {
            MassPlan::ZeroFuelAndTanks {
                zero_fuel_mass: load(zero_fuel_weight, "zero-fuel mass", inputs)?,
                tanks: tanks
                    .into_iter()
                    .map(|tank| inputs.conversion(Column::FuelUsed, tank, &unit, 1.0))
                    .collect::<Result<_, _>>()?,
                largest_rise_kg: largest_rise(largest_rise_kg)?,
            }
        }
        MassSource::StartMass { gross_weight } => {
            MassPlan::StartMass { gross_mass: load(gross_weight, "gross mass", inputs)? }
        }
    })
}

fn largest_rise(kg: f64) -> Result<f64, MappingError> {
    Ok(check_within("largest rise of gross mass", "kg", kg, 0.0, 1e5)?)
}

/// A mass of the load sheet. A column holds for the whole flight: the recorder may send it once.
fn load(amount: Amount, what: &'static str, inputs: &mut Inputs) -> Result<Load, MappingError> {
    let (columns, unit) = match amount {
        Amount::Value(value, unit) => return Ok(Load::Known(mass(&WithUnit(value, unit), what)?)),
        Amount::Column(column, unit) => (vec![column], unit),
        Amount::Columns(columns, unit) => (columns, unit),
    };
    let mut conversions = Vec::with_capacity(columns.len());
    for column in columns {
        let conversion = inputs.conversion(Column::FuelUsed, column, &unit, 1.0)?;
        let input = &mut inputs.0[conversion.input];
        if input.fill == Fill::Not {
            input.fill = Fill::Hold(f64::INFINITY);
        }
        conversions.push(conversion);
    }
    Ok(Load::Columns(conversions))
}
