//! Flight points: conditions for which a prediction is wanted.

use atmos::isa;
use flight::Timestamp;
use units::{
    Angle, FuelFlowTotal, Mach, Mass, OutOfDomain, PressureAltitude, Temperature,
    TemperatureDifference,
};

use crate::columns::{
    ANTI_ICE, CG_PERCENT_MAC, DATE, FLIGHT_LEVEL, FUEL_FLOW_KG_H, FUEL_FLOW_LB_H, ISA_DEVIATION_C,
    LATITUDE_DEG, MACH, MASS_KG, PRESSURE_ALTITUDE_FT, TRUE_HEADING_DEG, WEIGHT_LB,
};
use crate::csv_text::{
    Column, CsvError, CsvErrorReason, CsvText, Known, Row, is_available, parse_number,
};
use crate::guide::{fuel_flow_in, mass_in, pressure_altitude_in};

mod table;

pub use table::{LevelColumns, PointCell, PointTable};

/// A file of flight points, with every row as it was sent.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightPoints {
    header: Vec<String>,
    rows: Vec<FlightPointRow>,
}

/// A row of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightPointRow {
    /// Line of the file, from 1.
    pub line: u64,
    /// Fields as sent, as many as the header has names.
    pub fields: Vec<String>,
    /// Their meaning, or why they have none ([`CsvError::costs_its_row`]).
    pub point: Result<FlightPoint, CsvError>,
}

/// A condition of level, unaccelerated flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightPoint {
    /// Gross mass ("weight").
    pub mass: Mass,
    /// Pressure altitude.
    pub pressure_altitude: PressureAltitude,
    /// Mach number.
    pub mach: Mach,
    /// Deviation from the ISA.
    pub isa_deviation: TemperatureDifference,
    /// Fuel flow of all engines that was measured there.
    pub measured_fuel_flow_total: Option<FuelFlowTotal>,
    /// Instant; a date alone is its first instant in UTC.
    pub date: Option<Timestamp>,
    /// Center of gravity, % of the mean aerodynamic chord.
    pub center_of_gravity_percent_mac: Option<f64>,
    /// Whether anti-ice bleed is on.
    pub anti_ice: Option<bool>,
    /// Latitude, north positive.
    pub latitude: Option<Angle>,
    /// True heading.
    pub true_heading: Option<Angle>,
}

/// Columns that flight points may have.
const COLUMNS: [Column; 13] = [
    WEIGHT_LB,
    MASS_KG,
    PRESSURE_ALTITUDE_FT,
    FLIGHT_LEVEL,
    MACH,
    ISA_DEVIATION_C,
    FUEL_FLOW_LB_H,
    FUEL_FLOW_KG_H,
    DATE,
    CG_PERCENT_MAC,
    ANTI_ICE,
    LATITUDE_DEG,
    TRUE_HEADING_DEG,
];

/// Columns that a prediction adds to its flight points: when its result is given again they have no meaning.
pub const PREDICTED_COLUMNS: [&str; 9] = [
    "fuel_flow_kg_s",
    "fuel_flow_std_kg_s",
    "specific_range_m_kg",
    "lift_coefficient",
    "drag_coefficient",
    "extrapolated",
    "error_percent",
    "remainder_percent",
    "beyond_flights",
];

const KNOWN: Known<'_> = Known { columns: &COLUMNS, without_meaning: &PREDICTED_COLUMNS };

impl FlightPoints {
    /// Reads flight points.
    ///
    /// Comma-separated; the header determines the columns: `weight_lb` or `mass_kg`; `pressure_altitude_ft` or `flight_level`; `mach`;
    /// optionally `isa_deviation_c` (otherwise the ISA), `fuel_flow_lb_h` or `fuel_flow_kg_h`, `date`,
    /// `cg_percent_mac`, `anti_ice`, `latitude_deg`, `true_heading_deg`. An empty field, `-` or NaN means "not available": in a column
    /// that is needed, and in `isa_deviation_c`, the row is then without a point, as with a deviation out of its limits. Columns
    /// whose name begins with `X-`, and [`PREDICTED_COLUMNS`], are kept and have no meaning.
    ///
    /// # Errors
    /// [`CsvError`] at the first fault, as for [`Guide::from_csv`](crate::Guide::from_csv), but for those that cost a row alone
    /// ([`CsvError::costs_its_row`]).
    pub fn from_csv(text: &[u8]) -> Result<Self, CsvError> {
        let file = CsvText::read(text, KNOWN)?;
        let columns = Columns::find_in(&file)?;
        let point = |row| match columns.point(&file, row) {
            Err(error) if !error.costs_its_row() => Err(error),
            point => Ok(point),
        };
        let points = file.rows.iter().map(point).collect::<Result<Vec<_>, _>>()?;
        let CsvText { header, rows, .. } = file;
        let rows = rows
            .into_iter()
            .zip(points)
            .map(|(Row { line, fields }, point)| FlightPointRow { line, fields, point })
            .collect();
        Ok(Self { header, rows })
    }

    /// Column names as sent.
    #[must_use]
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// The rows, in the file's order; one or more.
    #[must_use]
    pub fn rows(&self) -> &[FlightPointRow] {
        &self.rows
    }
}

impl FlightPoint {
    /// A point of the standard day with no further data.
    #[must_use]
    pub const fn new(mass: Mass, pressure_altitude: PressureAltitude, mach: Mach) -> Self {
        Self {
            mass,
            pressure_altitude,
            mach,
            isa_deviation: TemperatureDifference::kelvin(0.0),
            measured_fuel_flow_total: None,
            date: None,
            center_of_gravity_percent_mac: None,
            anti_ice: None,
            latitude: None,
            true_heading: None,
        }
    }

    /// Static air temperature: that of the ISA plus the deviation.
    ///
    /// # Errors
    /// [`OutOfDomain`] for a pressure altitude outside the atmosphere's domain.
    pub fn static_air_temperature(&self) -> Result<Temperature, OutOfDomain> {
        Ok(isa::temperature(self.pressure_altitude)? + self.isa_deviation)
    }
}

/// Index of each column.
#[derive(Clone, Debug)]
struct Columns<'c> {
    mass: (usize, &'c Column),
    pressure_altitude: (usize, &'c Column),
    mach: usize,
    isa_deviation: Option<usize>,
    fuel_flow: Option<(usize, &'c Column)>,
    date: Option<usize>,
    center_of_gravity: Option<usize>,
    anti_ice: Option<usize>,
    latitude: Option<usize>,
    true_heading: Option<usize>,
}

impl Columns<'static> {
    fn find_in(file: &CsvText) -> Result<Self, CsvError> {
        Ok(Self {
            mass: file.require_one_of(&[&WEIGHT_LB, &MASS_KG])?,
            pressure_altitude: file.require_one_of(&[&PRESSURE_ALTITUDE_FT, &FLIGHT_LEVEL])?,
            mach: file.require(&MACH)?,
            isa_deviation: file.find(&ISA_DEVIATION_C),
            fuel_flow: file.find_either([&FUEL_FLOW_LB_H, &FUEL_FLOW_KG_H])?,
            date: file.find(&DATE),
            center_of_gravity: file.find(&CG_PERCENT_MAC),
            anti_ice: file.find(&ANTI_ICE),
            latitude: file.find(&LATITUDE_DEG),
            true_heading: file.find(&TRUE_HEADING_DEG),
        })
    }

    fn point(&self, file: &CsvText, row: &Row) -> Result<FlightPoint, CsvError> {
        let (mass, mass_column) = self.mass;
        let (altitude, altitude_column) = self.pressure_altitude;
        Ok(FlightPoint {
            mass: mass_in(mass_column, file.number(row, mass, mass_column)?),
            pressure_altitude: pressure_altitude_in(
                altitude_column,
                file.number(row, altitude, altitude_column)?,
            ),
            mach: Mach::new(file.number(row, self.mach, &MACH)?),
            isa_deviation: TemperatureDifference::kelvin(match self.isa_deviation {
                Some(index) => file.number(row, index, &ISA_DEVIATION_C)?,
                None => 0.0,
            }),
            measured_fuel_flow_total: match self.fuel_flow {
                Some((index, column)) => file
                    .optional_number(row, Some(index), column)?
                    .map(|flow| fuel_flow_in(column, flow)),
                None => None,
            },
            date: date(file, row, self.date)?,
            center_of_gravity_percent_mac: file.optional_number(
                row,
                self.center_of_gravity,
                &CG_PERCENT_MAC,
            )?,
            anti_ice: anti_ice(file, row, self.anti_ice)?,
            latitude: file.optional_number(row, self.latitude, &LATITUDE_DEG)?.map(Angle::degrees),
            true_heading: file
                .optional_number(row, self.true_heading, &TRUE_HEADING_DEG)?
                .map(Angle::degrees),
        })
    }
}

/// `2018-05-20`, or an instant as in a report's START.
fn date(file: &CsvText, row: &Row, index: Option<usize>) -> Result<Option<Timestamp>, CsvError> {
    let Some(index) = index.filter(|&index| is_available(&row.fields[index])) else {
        return Ok(None);
    };
    let found = row.fields[index].trim();
    instant_of(found)
        .map(Some)
        .ok_or_else(|| file.error(row, index, CsvErrorReason::NotADate { found: found.into() }))
}

/// An instant, or the first one of a date in UTC.
fn instant_of(text: &str) -> Option<Timestamp> {
    text.parse().or_else(|_| format!("{text}T00:00:00Z").parse()).ok()
}

fn anti_ice(file: &CsvText, row: &Row, index: Option<usize>) -> Result<Option<bool>, CsvError> {
    let Some(index) = index.filter(|&index| is_available(&row.fields[index])) else {
        return Ok(None);
    };
    let found = row.fields[index].trim();
    on_or_off(found)
        .map(Some)
        .ok_or_else(|| file.error(row, index, CsvErrorReason::NotZeroOrOne { found: found.into() }))
}

/// 0 and 1 however they are written (`1.0`), and the words for them.
fn on_or_off(text: &str) -> Option<bool> {
    let number = parse_number(text).map(f64::to_bits);
    let is =
        |value: f64, word: &str| number == Some(value.to_bits()) || text.eq_ignore_ascii_case(word);
    match (is(0.0, "false"), is(1.0, "true")) {
        (true, _) => Some(false),
        (_, true) => Some(true),
        _ => None,
    }
}

impl CsvError {
    /// Whether the fault is one of a row alone, and not of a file: a value that is missing, or a deviation from the ISA out of its
    /// limits, which a wrong temperature makes. Other absurd values are those of a column in another unit.
    #[must_use]
    pub fn costs_its_row(&self) -> bool {
        let is_of_deviation = || {
            self.column.as_ref().is_some_and(|column| column.name == ISA_DEVIATION_C.name)
                && match &self.reason {
                    CsvErrorReason::OutOfDomain { .. } => true,
                    // Infinite.
                    CsvErrorReason::NotANumber { found } => found.parse::<f64>().is_ok(),
                    _ => false,
                }
        };
        self.is_missing_value() || is_of_deviation()
    }
}

#[cfg(test)]
mod tests;
