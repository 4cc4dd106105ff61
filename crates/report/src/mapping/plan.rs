//! A checked mapping: every required quantity has a source, every unit is known.

mod conversion;
mod mass;
mod sources;

use flight::column::Column;
use flight::{MAXIMUM_ENGINES, MissingColumn, Timestamp};
use units::convert::METERS_PER_FOOT;
use units::{Mass, OutOfDomain, check_within};

use super::MappingError;
use super::file::{
    BadRows, CruiseFile, FORMAT, MappingFile, OutOfRange, RowsAre, TextSource, TimeSource,
};
use super::level::LevelCriteria;
use crate::cruise_text::parse_instant;

use sources::{Derivations, Inputs, Sources, known_unit};

pub(super) use conversion::Conversion;
pub(super) use sources::units_of;

/// The checked content of a mapping file.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) separator: u8,
    pub(super) decimal: char,
    /// Character between groups of three digits.
    pub(super) thousands: Option<char>,
    pub(super) units_row: bool,
    pub(super) comment: Option<u8>,
    pub(super) not_available: Vec<String>,
    pub(super) aircraft: TextSource,
    pub(super) tail: TextSource,
    pub(super) flight: TextSource,
    pub(super) lower_heating_value_mj_kg: Option<f64>,
    pub(super) notes: Vec<(String, String)>,
    pub(super) time_column: String,
    pub(super) time: TimeForm,
    /// Columns of the recording that hold numbers; other fields refer to them by their index here.
    pub(super) inputs: Vec<Input>,
    pub(super) recorded: Vec<(Column, Conversion)>,
    pub(super) mach: MachSource,
    pub(super) temperature: TemperatureSource,
    pub(super) true_airspeed: TrueAirspeedSource,
    pub(super) mass: MassPlan,
    pub(super) out_of_range: OutOfRange,
    pub(super) bad_rows: BadRows,
    pub(super) only: Vec<(String, Vec<String>)>,
    pub(super) new_flight_after_s: Option<f64>,
    pub(super) cruise: Option<LevelCriteria>,
    /// Where the rows are averaged points.
    pub(super) points: Option<PointsPlan>,
}

/// Rows that are means over stable frames.
#[derive(Clone, Debug)]
pub(super) struct PointsPlan {
    pub(super) averaged_over_s: f64,
    /// Standard deviations within a frame.
    pub(super) scatter: Vec<(Column, Conversion)>,
}

/// A column of numbers in the recording.
#[derive(Clone, Debug)]
pub(super) struct Input {
    pub(super) name: String,
    /// Whether a row without it is left out.
    pub(super) is_required: bool,
    /// How rows without it are filled.
    pub(super) fill: Fill,
    /// Texts that stand for numbers.
    pub(super) values: Vec<(String, f64)>,
}

/// What stands in a row that lacks a slow parameter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Fill {
    /// Nothing.
    #[default]
    Not,
    /// The last value, where it is no older than this, s.
    Hold(f64),
    /// A straight line between values no farther apart than this, s.
    Line(f64),
}

#[derive(Clone, Copy, Debug)]
pub(super) enum MachSource {
    Recorded,
    CalibratedAirspeed(Conversion),
    TrueAirspeed,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum TemperatureSource {
    Recorded,
    TotalTemperature {
        recovery_factor: f64,
    },
    /// From true airspeed and Mach number.
    TrueAirspeed,
    Isa {
        deviation_k: f64,
    },
}

#[derive(Clone, Copy, Debug)]
pub(super) enum TrueAirspeedSource {
    Recorded,
    Mach,
}

#[derive(Clone, Debug)]
pub(super) enum MassPlan {
    GrossMass { mass: Conversion, zero_fuel_mass: Option<Mass>, largest_rise_kg: f64 },
    FuelUsed { fuel_used: Vec<Conversion>, zero_fuel_mass: Load, fuel_on_board: Load },
    ZeroFuelAndTanks { zero_fuel_mass: Load, tanks: Vec<Conversion>, largest_rise_kg: f64 },
    StartMass { gross_mass: Load },
}

/// A mass of the load sheet.
#[derive(Clone, Debug)]
pub(super) enum Load {
    Known(Mass),
    /// The sum of these in the first row.
    Columns(Vec<Conversion>),
}

/// The form of time in the recording.
#[derive(Clone, Debug)]
pub(super) enum TimeForm {
    Timestamp {
        date_column: Option<String>,
        format: Option<String>,
        utc_offset: Option<String>,
        /// Where the offset is in a column of its own.
        offset_column: Option<String>,
    },
    /// A count of seconds or of something else since `start`.
    Seconds { start: Timestamp, count: Count },
    /// Seconds of the day; `midnight` begins the day of the first row.
    TimeOfDay { midnight: Timestamp },
}

/// What a number that tells the time counts.
#[derive(Clone, Copy, Debug)]
pub(super) enum Count {
    /// So many a second. The number is divided, so that whole seconds stay whole.
    PerSecond(f64),
    /// Days with their fraction: of ten decimals, so that they are rounded to the millisecond.
    Days,
}

impl Count {
    /// Seconds that a number means.
    pub(super) fn seconds(self, number: f64) -> f64 {
        match self {
            Self::PerSecond(count) => number / count,
            Self::Days => (number * 86_400e3).round() / 1e3,
        }
    }
}

impl Plan {
    pub(super) fn new(file: MappingFile) -> Result<Self, MappingError> {
        if file.format != FORMAT {
            return Err(MappingError::VersionUnknown { found: file.format });
        }
        let mut sources = Sources::default();
        for (name, source) in file.quantities.0 {
            sources.add(name, source)?;
        }
        let Derivations { mach, temperature, true_airspeed } = sources.derivations()?;
        check_engines(|column| sources.is_recorded(column))?;
        let mut inputs = sources.inputs;
        let mass = mass::mass_plan(file.mass, &mut inputs)?;
        let points = points_plan(file.rows, &mut inputs)?;
        if points.is_some() {
            refuse_for_points("cruise", file.cruise.is_some())?;
            refuse_for_points("StartMass", matches!(mass, MassPlan::StartMass { .. }))?;
        }
        let (time_column, time) = time_plan(file.time)?;
        Ok(Self {
            separator: ascii(file.separator)?,
            decimal: decimal(file.decimal, file.separator)?,
            thousands: file.thousands.map(|mark| thousands(mark, file.decimal)).transpose()?,
            units_row: file.units_row,
            comment: file.comment.map(ascii).transpose()?,
            not_available: file.not_available,
            aircraft: file.aircraft,
            tail: file.tail,
            flight: file.flight,
            lower_heating_value_mj_kg: file
                .lower_heating_value_mj_kg
                .map(|value| check_within("lower heating value", "MJ/kg", value, 1.0, 200.0))
                .transpose()?,
            notes: file.notes,
            time_column,
            time,
            inputs: inputs.0,
            recorded: sources.recorded,
            mach,
            temperature,
            true_airspeed,
            mass,
            out_of_range: file.out_of_range,
            bad_rows: file.bad_rows,
            only: file.only,
            new_flight_after_s: file
                .new_flight_after_s
                .map(|gap_s| check_within("gap between flights", "s", gap_s, 1.0, 1e7))
                .transpose()?,
            cruise: file.cruise.as_ref().map(level_criteria).transpose()?,
            points,
        })
    }

    /// Rows that make a flight.
    pub(super) const fn fewest_rows(&self) -> usize {
        if self.points.is_some() { 1 } else { 3 }
    }

    /// A recorded gross mass.
    pub(super) const fn gross_mass(&self) -> Option<&Conversion> {
        match &self.mass {
            MassPlan::GrossMass { mass, .. } => Some(mass),
            _ => None,
        }
    }

    /// How a column that is recorded is converted.
    pub(super) fn recorded_as(&self, wanted: Column) -> Option<&Conversion> {
        let found = self.recorded.iter().find(|(column, _)| *column == wanted);
        found.map(|(_, conversion)| conversion)
    }

    /// The required columns of the report that this layout does not have.
    pub(super) fn missing(&self) -> Vec<MissingColumn> {
        let is_recorded = |wanted| self.recorded_as(wanted).is_some();
        let is_assumed = matches!(self.temperature, TemperatureSource::Isa { .. });
        MissingColumn::ALL
            .into_iter()
            .filter(|column| match column {
                MissingColumn::StaticAirTemperature => is_assumed,
                MissingColumn::N2 => !is_recorded(Column::N2(1)),
                MissingColumn::Roll => !is_recorded(Column::Roll),
                MissingColumn::Drift => !is_recorded(Column::Drift),
            })
            .collect()
    }
}

fn points_plan(rows: RowsAre, inputs: &mut Inputs) -> Result<Option<PointsPlan>, MappingError> {
    let RowsAre::AveragedPoints { averaged_over_s, scatter } = rows else { return Ok(None) };
    let scatter = scatter.into_iter().map(|(name, column, unit)| {
        // What the trim criteria limit the changes of.
        let Some(
            quantity @ (Column::PressureAltitude
            | Column::Mach
            | Column::GroundSpeed
            | Column::StaticAirTemperature
            | Column::N2(_)),
        ) = Column::from_name(&name)
        else {
            return Err(MappingError::ScatterUnknown { name });
        };
        let factor = known_unit(quantity, &unit)?.factor;
        let input = inputs.place(column, false);
        Ok((quantity, Conversion { input, minus: None, factor, offset: 0.0 }))
    });
    Ok(Some(PointsPlan {
        scatter: scatter.collect::<Result<_, _>>()?,
        averaged_over_s: check_within("averaging time", "s", averaged_over_s, 1.0, 3600.0)?,
    }))
}

/// What asks for the samples between the points.
const fn refuse_for_points(entry: &'static str, is_there: bool) -> Result<(), MappingError> {
    if is_there { Err(MappingError::NeedsSamples { entry }) } else { Ok(()) }
}

fn decimal(decimal: char, separator: char) -> Result<char, MappingError> {
    if matches!(decimal, '.' | ',') && decimal != separator {
        Ok(decimal)
    } else {
        Err(MappingError::SeparatorUnusable { character: decimal })
    }
}

/// What is no digit, letter or sign, and not the decimal character. A field with the separator in it has quotes.
fn thousands(mark: char, decimal: char) -> Result<char, MappingError> {
    if mark == decimal || mark.is_alphanumeric() || "+-\"".contains(mark) {
        return Err(MappingError::SeparatorUnusable { character: mark });
    }
    Ok(mark)
}

fn time_plan(source: TimeSource) -> Result<(String, TimeForm), MappingError> {
    let any_day = "2000-01-01T00:00:00";
    match source {
        TimeSource::Timestamp { column, date, format, utc_offset, utc_offset_column } => {
            if let Some(offset) = &utc_offset
                && parse_instant(&format!("{any_day}{offset}")).is_none()
            {
                return Err(MappingError::InstantMalformed { text: offset.clone() });
            }
            let (date_column, offset_column) = (date, utc_offset_column);
            Ok((column, TimeForm::Timestamp { date_column, format, utc_offset, offset_column }))
        }
        TimeSource::Epoch { column, unit } => {
            let per_second = match unit.as_str() {
                "s" => 1.0,
                "ms" => 1e3,
                "us" => 1e6,
                "ns" => 1e9,
                _ => {
                    return Err(MappingError::UnitUnknown {
                        column: Column::Time,
                        near: None,
                        unit,
                    });
                }
            };
            let count = Count::PerSecond(per_second);
            Ok((column, TimeForm::Seconds { start: Timestamp::UNIX_EPOCH, count }))
        }
        TimeSource::TimeOfDay { column, date, utc_offset } => {
            let text = format!("{date}T00:00:00{utc_offset}");
            let midnight = parse_instant(&text).ok_or(MappingError::InstantMalformed { text })?;
            Ok((column, TimeForm::TimeOfDay { midnight }))
        }
        TimeSource::Seconds { column, start } => {
            let start = instant(start)?;
            Ok((column, TimeForm::Seconds { start, count: Count::PerSecond(1.0) }))
        }
        TimeSource::Days { column, start } => {
            Ok((column, TimeForm::Seconds { start: instant(start)?, count: Count::Days }))
        }
    }
}

fn instant(text: String) -> Result<Timestamp, MappingError> {
    parse_instant(&text).ok_or(MappingError::InstantMalformed { text })
}

/// Engines count from 1 without a gap; rotor speed and fuel flow are of the same engines.
fn check_engines(is_recorded: impl Fn(Column) -> bool) -> Result<(), MappingError> {
    let count = |column: fn(u8) -> Column| -> Result<u8, MappingError> {
        let engines: Vec<u8> =
            (1..).take(MAXIMUM_ENGINES).filter(|k| is_recorded(column(*k))).collect();
        match (1..).zip(&engines).find(|(expected, engine)| expected != *engine) {
            Some((expected, _)) => {
                Err(MappingError::QuantityNotMapped { column: column(expected) })
            }
            None => Ok((1..).take(engines.len()).last().unwrap_or(0)),
        }
    };
    let flows = count(Column::FuelFlowEngine)?;
    let rotor_speeds = count(Column::N2)?;
    let is_total = is_recorded(Column::FuelFlowTotal);
    if flows == 0 && !is_total {
        return Err(MappingError::QuantityNotMapped { column: Column::FuelFlowTotal });
    }
    if flows > 0 && is_total {
        return Err(MappingError::FuelFlowTwice);
    }
    if flows > 0 && rotor_speeds > 0 && flows != rotor_speeds {
        let column = if flows > rotor_speeds {
            Column::N2(flows)
        } else {
            Column::FuelFlowEngine(rotor_speeds)
        };
        return Err(MappingError::QuantityNotMapped { column });
    }
    Ok(())
}

fn level_criteria(file: &CruiseFile) -> Result<LevelCriteria, OutOfDomain> {
    let altitude_ft =
        check_within("pressure altitude", "ft", file.minimum_pressure_altitude_ft, -2e3, 6e4)?;
    let band_ft = check_within("band of pressure altitude", "ft", file.band_ft, 0.0, 6e4)?;
    Ok(LevelCriteria {
        minimum_pressure_altitude_m: altitude_ft * METERS_PER_FOOT,
        band_m: band_ft * METERS_PER_FOOT,
        minimum_duration_s: check_within("duration", "s", file.minimum_duration_s, 0.0, 1e6)?,
        trim_s: check_within("trimmed time", "s", file.trim_s, 0.0, 1e6)?,
    })
}

fn ascii(character: char) -> Result<u8, MappingError> {
    match u8::try_from(character) {
        Ok(byte) if byte.is_ascii() && !byte.is_ascii_alphanumeric() && byte != b'"' => Ok(byte),
        _ => Err(MappingError::SeparatorUnusable { character }),
    }
}
