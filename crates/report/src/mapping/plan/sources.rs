//! Sources of quantities, checked one by one as the file names them.

use flight::column::{Column, ColumnUnit};
use units::check_within;
use units::convert::{KILOGRAMS_PER_POUND, METERS_PER_FOOT};

use super::conversion::Conversion;
use super::{Fill, Input, MachSource, TemperatureSource, TrueAirspeedSource};
use crate::mapping::MappingError;
use crate::mapping::file::QuantitySource;
use crate::refusal::nearest;

/// The sources of quantities, as far as the file has been read.
#[derive(Default)]
pub(super) struct Sources {
    pub(super) inputs: Inputs,
    pub(super) recorded: Vec<(Column, Conversion)>,
    mach: Option<MachSource>,
    temperature: Option<TemperatureSource>,
    true_airspeed: Option<TrueAirspeedSource>,
}

/// Where what may be derived comes from.
pub(super) struct Derivations {
    pub(super) mach: MachSource,
    pub(super) temperature: TemperatureSource,
    pub(super) true_airspeed: TrueAirspeedSource,
}

impl Sources {
    pub(super) fn add(&mut self, name: String, source: QuantitySource) -> Result<(), MappingError> {
        let quantity = match Column::from_name(&name) {
            // Time and fuel used have entries of their own.
            None | Some(Column::Time | Column::FuelUsed) => {
                return Err(MappingError::QuantityUnknown { near: near_quantity(&name), name });
            }
            Some(quantity) => quantity,
        };
        match (quantity, source) {
            (
                _,
                QuantitySource::Recorded {
                    column,
                    unit,
                    scale,
                    offset,
                    hold_s,
                    interpolate_s,
                    values,
                    optional: _,
                },
            ) => {
                let unit = unit.ok_or(MappingError::UnitMissing { column: quantity })?;
                let mut conversion = self.inputs.conversion(quantity, column, &unit, scale)?;
                check_within("offset", "-", offset, -1e9, 1e9)?;
                // The offset is in the mapping's unit, after the scale.
                conversion.offset += offset * known_unit(quantity, &unit)?.factor;
                let input = &mut self.inputs.0[conversion.input];
                input.fill = fill(hold_s, interpolate_s)?;
                input.values.extend(values);
                self.recorded.push((quantity, conversion));
            }
            (Column::Drift, QuantitySource::Difference { column, minus, unit }) => {
                let mut conversion = self.inputs.conversion(quantity, column, &unit, 1.0)?;
                conversion.minus = Some(self.inputs.place(minus, true));
                self.recorded.push((quantity, conversion));
            }
            (
                Column::Mach,
                QuantitySource::FromCalibratedAirspeed {
                    column,
                    unit,
                    scale,
                    hold_s,
                    interpolate_s,
                },
            ) => {
                // Calibrated airspeed is not a column of the report, but is given in the units of true airspeed.
                let conversion =
                    self.inputs.conversion(Column::TrueAirspeed, column, &unit, scale)?;
                self.inputs.0[conversion.input].fill = fill(hold_s, interpolate_s)?;
                self.mach = Some(MachSource::CalibratedAirspeed(conversion));
            }
            (Column::Mach, QuantitySource::FromTrueAirspeed) => {
                self.mach = Some(MachSource::TrueAirspeed);
            }
            (Column::TrueAirspeed, QuantitySource::FromMach) => {
                self.true_airspeed = Some(TrueAirspeedSource::Mach);
            }
            (Column::StaticAirTemperature, QuantitySource::FromTrueAirspeed) => {
                self.temperature = Some(TemperatureSource::TrueAirspeed);
            }
            (
                Column::StaticAirTemperature,
                QuantitySource::FromTotalTemperature { recovery_factor },
            ) => {
                check_within("recovery factor", "-", recovery_factor, 0.5, 1.0)?;
                self.temperature = Some(TemperatureSource::TotalTemperature { recovery_factor });
            }
            (Column::StaticAirTemperature, QuantitySource::Isa { deviation_k }) => {
                check_within("deviation from the ISA", "K", deviation_k, -100.0, 100.0)?;
                self.temperature = Some(TemperatureSource::Isa { deviation_k });
            }
            (column, source) => {
                let source_name = source.name();
                return Err(MappingError::SourceNotForQuantity { column, source_name });
            }
        }
        Ok(())
    }

    pub(super) fn is_recorded(&self, wanted: Column) -> bool {
        self.recorded.iter().any(|(column, _)| *column == wanted)
    }

    fn require(&self, column: Column) -> Result<(), MappingError> {
        if self.is_recorded(column) {
            Ok(())
        } else {
            Err(MappingError::QuantityNotMapped { column })
        }
    }

    /// Every required quantity is recorded or derived, and none from itself.
    pub(super) fn derivations(&mut self) -> Result<Derivations, MappingError> {
        self.require(Column::PressureAltitude)?;
        self.require(Column::GroundSpeed)?;
        if self.mach.is_none() {
            self.require(Column::Mach)?;
        }
        if self.temperature.is_none() {
            self.require(Column::StaticAirTemperature)?;
        }
        if self.true_airspeed.is_none() {
            self.require(Column::TrueAirspeed)?;
        }
        let derivations = Derivations {
            mach: self.mach.unwrap_or(MachSource::Recorded),
            temperature: self.temperature.unwrap_or(TemperatureSource::Recorded),
            true_airspeed: self.true_airspeed.unwrap_or(TrueAirspeedSource::Recorded),
        };
        let is_temperature_of_mach =
            matches!(derivations.temperature, TemperatureSource::TotalTemperature { .. });
        if is_temperature_of_mach {
            self.require(Column::TotalAirTemperature)?;
            for (column, conversion) in &self.recorded {
                if *column == Column::TotalAirTemperature {
                    self.inputs.0[conversion.input].is_required = true;
                }
            }
        }
        let is_airspeed_of_mach = matches!(derivations.true_airspeed, TrueAirspeedSource::Mach);
        let is_mach_of_airspeed = matches!(derivations.mach, MachSource::TrueAirspeed);
        // Temperature of airspeed and Mach number needs both from elsewhere.
        let is_temperature_of_both =
            matches!(derivations.temperature, TemperatureSource::TrueAirspeed);
        if (is_mach_of_airspeed && (is_airspeed_of_mach || is_temperature_of_mach))
            || (is_temperature_of_both && (is_mach_of_airspeed || is_airspeed_of_mach))
        {
            return Err(MappingError::Circular);
        }
        Ok(derivations)
    }
}

/// The columns of numbers that are asked for.
#[derive(Default)]
pub(super) struct Inputs(pub(super) Vec<Input>);

impl Inputs {
    pub(super) fn place(&mut self, name: String, is_required: bool) -> usize {
        if let Some(place) = self.0.iter().position(|input| input.name == name) {
            self.0[place].is_required |= is_required;
            return place;
        }
        self.0.push(Input { name, is_required, fill: Fill::Not, values: Vec::new() });
        self.0.len() - 1
    }

    pub(super) fn conversion(
        &mut self,
        column: Column,
        input: String,
        unit: &str,
        scale: f64,
    ) -> Result<Conversion, MappingError> {
        let unit = known_unit(column, unit)?;
        check_within("scale", "-", scale, -1e12, 1e12)?;
        let input = self.place(input, !column.is_optional());
        Ok(Conversion { input, minus: None, factor: scale * unit.factor, offset: unit.offset })
    }
}

/// Units in which a mapping may give a quantity: those of the report's column, and some in which recorders and spreadsheets have it.
pub(in crate::mapping) fn units_of(column: Column) -> impl Iterator<Item = ColumnUnit> {
    const fn unit(name: &'static str, factor: f64, offset: f64) -> ColumnUnit {
        ColumnUnit { name, factor, offset }
    }
    const AMOUNTS: &[ColumnUnit] =
        &[unit("t", 1000.0, 0.0), unit("klb", 1000.0 * KILOGRAMS_PER_POUND, 0.0)];
    let more: &[ColumnUnit] = match column {
        Column::PressureAltitude => const { &[unit("FL", 100.0 * METERS_PER_FOOT, 0.0)] },
        Column::FuelUsed | Column::FuelQuantity => AMOUNTS,
        Column::FuelFlowTotal | Column::FuelFlowEngine(_) => {
            const { &[unit("t/h", 1000.0 / 3600.0, 0.0)] }
        }
        Column::StaticAirTemperature | Column::TotalAirTemperature => {
            const { &[unit("degF", 5.0 / 9.0, 273.15 - 32.0 * 5.0 / 9.0)] }
        }
        _ => &[],
    };
    column.units().iter().chain(more).copied()
}

pub(super) fn known_unit(column: Column, unit: &str) -> Result<ColumnUnit, MappingError> {
    let known = || units_of(column);
    known().find(|known| known.name == unit).ok_or_else(|| MappingError::UnitUnknown {
        column,
        unit: unit.to_owned(),
        near: nearest(unit, known().map(|unit| unit.name)),
    })
}

pub(super) fn fill(hold_s: Option<f64>, interpolate_s: Option<f64>) -> Result<Fill, MappingError> {
    let checked = |age_s| check_within("age of a held value", "s", age_s, 0.0, 86_400.0);
    Ok(match (hold_s, interpolate_s) {
        (None, None) => Fill::Not,
        (Some(age_s), None) => Fill::Hold(checked(age_s)?),
        (None, Some(span_s)) => Fill::Line(checked(span_s)?),
        (Some(_), Some(_)) => return Err(MappingError::HeldAndInterpolated),
    })
}

fn near_quantity(name: &str) -> Option<&'static str> {
    nearest(name, flight::column::COLUMN_NAMES.split(' '))
}
