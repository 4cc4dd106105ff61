//! A checked mapping: every required quantity has a source, every unit is known.

mod mass;

use core::ops::Range;

use flight::column::{Column, ColumnUnit};
use flight::{MAXIMUM_ENGINES, MissingColumn, Timestamp};
use units::convert::METERS_PER_FOOT;
use units::{Mass, OutOfDomain, check_within};

use super::MappingError;
use super::file::{
    BadRows, CruiseFile, FORMAT, MappingFile, OutOfRange, QuantitySource, RowsAre, TextSource,
    TimeSource,
};
use super::level::LevelCriteria;
use super::numbers::Numbers;
use crate::cruise_text::parse_instant;
use crate::refusal::nearest;

/// The checked content of a mapping file.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) separator: u8,
    pub(super) decimal: char,
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

/// Values that are converted, then looked at: few enough that they are still at hand.
const VALUES_TOGETHER: usize = 1024;

/// From a number of the recording to the stored unit of a quantity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conversion {
    pub(super) input: usize,
    /// For the angle between two columns.
    pub(super) minus: Option<usize>,
    factor: f64,
    offset: f64,
}

impl Conversion {
    pub(super) fn apply(&self, numbers: &Numbers, row: usize) -> f64 {
        self.of(numbers.at(self.input, row), self.minus.map(|minus| numbers.at(minus, row)))
    }

    /// The same for rows that follow each other, behind what `values` holds. Gives how many of them are not so.
    pub(super) fn append_to(
        &self,
        values: &mut Vec<f64>,
        numbers: &Numbers,
        rows: Range<usize>,
        is_so: impl Fn(f64) -> bool,
    ) -> u64 {
        let mut others = 0;
        for (columns, rows) in numbers.slices(rows) {
            let sent = columns[self.input][rows.clone()].chunks(VALUES_TOGETHER);
            let mut less = self.minus.map(|minus| columns[minus][rows].chunks(VALUES_TOGETHER));
            for sent in sent {
                let from = values.len();
                match less.as_mut().and_then(Iterator::next) {
                    None => {
                        // Copied, since the compiler knows then that they stay as they are while values are written.
                        let Self { factor, offset, .. } = *self;
                        values.extend(sent.iter().map(|value| value * factor + offset));
                    }
                    Some(less) => {
                        let both = sent.iter().zip(less);
                        values.extend(both.map(|(value, less)| self.of(*value, Some(*less))));
                    }
                }
                // Counted, without a way out of the loop: nearly always all are so.
                others += values[from..].iter().map(|value| u64::from(!is_so(*value))).sum::<u64>();
            }
        }
        others
    }

    /// Of a number, or of the angle between two.
    fn of(&self, value: f64, less: Option<f64>) -> f64 {
        let value = value * self.factor + self.offset;
        less.map_or(value, |less| wrap_deg(value - less * self.factor))
    }
}

/// An angle in −180 … 180°.
fn wrap_deg(angle_deg: f64) -> f64 {
    (angle_deg + 180.0).rem_euclid(360.0) - 180.0
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
    TotalTemperature { recovery_factor: f64 },
    Isa { deviation_k: f64 },
}

#[derive(Clone, Copy, Debug)]
pub(super) enum TrueAirspeedSource {
    Recorded,
    Mach,
}

#[derive(Clone, Debug)]
pub(super) enum MassPlan {
    GrossMass { mass: Conversion, zero_fuel_mass: Option<Mass>, largest_rise_kg: f64 },
    FuelUsed { fuel_used: Conversion, zero_fuel_mass: Load, fuel_on_board: Load },
    ZeroFuelAndTanks { zero_fuel_mass: Load, tanks: Vec<Conversion>, largest_rise_kg: f64 },
    StartMass { gross_mass: Load },
}

/// A mass of the load sheet.
#[derive(Clone, Copy, Debug)]
pub(super) enum Load {
    Known(Mass),
    /// That of the first row.
    Column(Conversion),
}

/// The form of time in the recording.
#[derive(Clone, Debug)]
pub(super) enum TimeForm {
    Timestamp {
        date_column: Option<String>,
        format: Option<String>,
        utc_offset: Option<String>,
    },
    /// Number over `per_second` is seconds since `start`: a division, so that whole seconds stay whole.
    Seconds {
        start: Timestamp,
        per_second: f64,
    },
    /// Seconds of the day; `midnight` begins the day of the first row.
    TimeOfDay {
        midnight: Timestamp,
    },
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

    /// The required columns of the report that this layout does not have.
    pub(super) fn missing(&self) -> Vec<MissingColumn> {
        let is_recorded = |wanted| self.recorded.iter().any(|(column, _)| *column == wanted);
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

/// The sources of quantities, as far as the file has been read.
#[derive(Default)]
struct Sources {
    inputs: Inputs,
    recorded: Vec<(Column, Conversion)>,
    mach: Option<MachSource>,
    temperature: Option<TemperatureSource>,
    true_airspeed: Option<TrueAirspeedSource>,
}

struct Derivations {
    mach: MachSource,
    temperature: TemperatureSource,
    true_airspeed: TrueAirspeedSource,
}

impl Sources {
    fn add(&mut self, name: String, source: QuantitySource) -> Result<(), MappingError> {
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
            (Column::Mach, QuantitySource::FromCalibratedAirspeed { column, unit, scale }) => {
                // Calibrated airspeed is not a column of the report, but is given in the units of true airspeed.
                let conversion =
                    self.inputs.conversion(Column::TrueAirspeed, column, &unit, scale)?;
                self.mach = Some(MachSource::CalibratedAirspeed(conversion));
            }
            (Column::Mach, QuantitySource::FromTrueAirspeed) => {
                self.mach = Some(MachSource::TrueAirspeed);
            }
            (Column::TrueAirspeed, QuantitySource::FromMach) => {
                self.true_airspeed = Some(TrueAirspeedSource::Mach);
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
                return Err(MappingError::SourceNotForQuantity {
                    column,
                    source_name: source.name(),
                });
            }
        }
        Ok(())
    }

    fn is_recorded(&self, wanted: Column) -> bool {
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
    fn derivations(&mut self) -> Result<Derivations, MappingError> {
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
        if matches!(derivations.mach, MachSource::TrueAirspeed)
            && (is_airspeed_of_mach || is_temperature_of_mach)
        {
            return Err(MappingError::Circular);
        }
        Ok(derivations)
    }
}

#[derive(Default)]
struct Inputs(Vec<Input>);

impl Inputs {
    fn place(&mut self, name: String, is_required: bool) -> usize {
        if let Some(place) = self.0.iter().position(|input| input.name == name) {
            self.0[place].is_required |= is_required;
            return place;
        }
        self.0.push(Input { name, is_required, fill: Fill::Not, values: Vec::new() });
        self.0.len() - 1
    }

    fn conversion(
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

fn known_unit(column: Column, unit: &str) -> Result<ColumnUnit, MappingError> {
    let known = column.units().iter().find(|known| known.name == unit);
    known.copied().ok_or_else(|| MappingError::UnitUnknown {
        column,
        unit: unit.to_owned(),
        near: nearest(unit, column.units().iter().map(|unit| unit.name)),
    })
}

fn fill(hold_s: Option<f64>, interpolate_s: Option<f64>) -> Result<Fill, MappingError> {
    let checked = |age_s| check_within("age of a held value", "s", age_s, 0.0, 86_400.0);
    Ok(match (hold_s, interpolate_s) {
        (None, None) => Fill::Not,
        (Some(age_s), None) => Fill::Hold(checked(age_s)?),
        (None, Some(span_s)) => Fill::Line(checked(span_s)?),
        (Some(_), Some(_)) => return Err(MappingError::HeldAndInterpolated),
    })
}

fn decimal(decimal: char, separator: char) -> Result<char, MappingError> {
    if matches!(decimal, '.' | ',') && decimal != separator {
        Ok(decimal)
    } else {
        Err(MappingError::SeparatorUnusable { character: decimal })
    }
}

fn near_quantity(name: &str) -> Option<&'static str> {
    nearest(name, flight::column::COLUMN_NAMES.split(' '))
}

fn time_plan(source: TimeSource) -> Result<(String, TimeForm), MappingError> {
    let any_day = "2000-01-01T00:00:00";
    match source {
        TimeSource::Timestamp { column, date, format, utc_offset } => {
            if let Some(offset) = &utc_offset
                && parse_instant(&format!("{any_day}{offset}")).is_none()
            {
                return Err(MappingError::InstantMalformed { text: offset.clone() });
            }
            Ok((column, TimeForm::Timestamp { date_column: date, format, utc_offset }))
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
            Ok((column, TimeForm::Seconds { start: Timestamp::UNIX_EPOCH, per_second }))
        }
        TimeSource::TimeOfDay { column, date, utc_offset } => {
            let text = format!("{date}T00:00:00{utc_offset}");
            let midnight = parse_instant(&text).ok_or(MappingError::InstantMalformed { text })?;
            Ok((column, TimeForm::TimeOfDay { midnight }))
        }
        TimeSource::Seconds { column, start } => {
            let start: Timestamp =
                parse_instant(&start).ok_or(MappingError::InstantMalformed { text: start })?;
            Ok((column, TimeForm::Seconds { start, per_second: 1.0 }))
        }
    }
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
