//! Flight points from a table in memory, whose cells are numbers rather than text.

use std::borrow::Cow;

use flight::Timestamp;
use units::{Angle, Mach, PressureAltitude, TemperatureDifference};

use super::{Columns, FlightPoint, KNOWN, on_or_off};
use crate::LevelFlights;
use crate::columns::{CG_PERCENT_MAC, ISA_DEVIATION_C, LATITUDE_DEG, MACH, TRUE_HEADING_DEG};
use crate::csv_text::{Column, CsvError, CsvErrorReason, CsvText, within};
use crate::guide::{feet_per_unit, fuel_flow_in, mass_in, pressure_altitude_in};

/// The columns of a table of flight points, found by name as in [`FlightPoints::from_csv`](super::FlightPoints::from_csv).
#[derive(Debug)]
pub struct PointTable {
    header: CsvText,
    columns: Columns<'static>,
}

/// A cell of such a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointCell<'a> {
    /// No value; NaN is none either.
    Missing,
    /// A number; 1 and 0 for true and false.
    Number(f64),
    /// Text, read as a field of a text file.
    Text(&'a str),
    /// An instant.
    Instant(Timestamp),
}

/// Flight points of a table of plain numbers, as columns.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelColumns {
    mass_kg: Vec<f64>,
    pressure_altitude_m: Vec<f64>,
    mach: Vec<f64>,
    isa_deviation_k: Vec<f64>,
    measured_fuel_flow_kg_s: Option<Vec<f64>>,
}

impl LevelColumns {
    /// The points.
    #[must_use]
    pub fn flights(&self) -> LevelFlights<'_> {
        LevelFlights {
            mass_kg: &self.mass_kg,
            pressure_altitude_m: &self.pressure_altitude_m,
            mach: &self.mach,
            isa_deviation_k: &self.isa_deviation_k,
        }
    }

    /// Measured fuel flow of all engines at each point, kg/s, NaN where none; `None` for a table without that column.
    #[must_use]
    pub fn measured_fuel_flow_kg_s(&self) -> Option<&[f64]> {
        self.measured_fuel_flow_kg_s.as_deref()
    }
}

impl PointTable {
    /// The columns of a table with these names.
    ///
    /// # Errors
    /// [`CsvError`] for a name that flight points do not have (other than one beginning with `X-` and
    /// [`PREDICTED_COLUMNS`](super::PREDICTED_COLUMNS)), that appears twice or is missing.
    pub fn new(names: Vec<String>) -> Result<Self, CsvError> {
        let header = CsvText::of_header(names, KNOWN)?;
        let columns = Columns::find_in(&header)?;
        Ok(Self { header, columns })
    }

    /// Position of the measured fuel flow, if the table has it.
    #[must_use]
    pub fn measured_fuel_flow(&self) -> Option<usize> {
        self.columns.fuel_flow.map(|(index, _)| index)
    }

    /// All points at once, of a table of plain numbers of which nothing but mass, pressure altitude, Mach number, deviation from
    /// the ISA and measured fuel flow is wanted. `numbers` gives the values of a column by its position, NaN where a cell
    /// has none, or `None` where it holds anything but numbers. `None` for every table whose cells have to be looked at one by
    /// one ([`point`](Self::point)): it then says what is wrong with them, if anything is.
    #[must_use]
    pub fn level_columns<'a>(
        &self,
        numbers: impl Fn(usize) -> Option<Cow<'a, [f64]>>,
    ) -> Option<LevelColumns> {
        let columns = &self.columns;
        let further = [columns.date, columns.center_of_gravity, columns.anti_ice, columns.latitude];
        if further.into_iter().chain([columns.true_heading]).any(|column| column.is_some()) {
            return None;
        }
        let required = |index: usize, column: &Column, si: &dyn Fn(f64) -> f64| {
            let values = numbers(index)?;
            let (minimum, maximum) = (column.minimum, column.maximum);
            // NaN is not within.
            let all_within = values.iter().all(|value| (minimum..=maximum).contains(value));
            all_within.then(|| values.iter().map(|value| si(*value)).collect::<Vec<f64>>())
        };
        let (mass, mass_column) = columns.mass;
        let (altitude, altitude_column) = columns.pressure_altitude;
        let feet = feet_per_unit(altitude_column);
        let mass_kg = required(mass, mass_column, &|v| mass_in(mass_column, v).to_kilograms())?;
        let isa_deviation_k = match columns.isa_deviation {
            Some(index) => required(index, &ISA_DEVIATION_C, &|value| {
                TemperatureDifference::kelvin(value).to_kelvin()
            })?,
            None => vec![0.0; mass_kg.len()],
        };
        let measured_fuel_flow_kg_s = match columns.fuel_flow {
            Some((index, column)) => {
                let within = |value: &f64| (column.minimum..=column.maximum).contains(value);
                let values = numbers(index)?;
                let all_within = values.iter().all(|value| value.is_nan() || within(value));
                let si = |value: &f64| fuel_flow_in(column, *value).to_kilograms_per_second();
                Some(all_within.then(|| values.iter().map(si).collect())?)
            }
            None => None,
        };
        Some(LevelColumns {
            mass_kg,
            pressure_altitude_m: required(altitude, altitude_column, &|value| {
                PressureAltitude::feet(feet * value).to_meters()
            })?,
            mach: required(columns.mach, &MACH, &|value| value)?,
            isa_deviation_k,
            measured_fuel_flow_kg_s,
        })
    }

    /// The point of a row (counted from 1, for errors), whose cells are asked for by the position of their column.
    ///
    /// # Errors
    /// [`CsvError`] with the row as its line, as for a field of a text file.
    pub fn point<'a>(
        &self,
        row: u64,
        cell: impl Fn(usize) -> PointCell<'a>,
    ) -> Result<FlightPoint, CsvError> {
        let row = TableRow { header: &self.header, row, cell };
        let columns = &self.columns;
        let (mass, mass_column) = columns.mass;
        let (altitude, altitude_column) = columns.pressure_altitude;
        let mut point = FlightPoint::new(
            mass_in(mass_column, row.number(mass, mass_column)?),
            pressure_altitude_in(altitude_column, row.number(altitude, altitude_column)?),
            Mach::new(row.number(columns.mach, &MACH)?),
        );
        if let Some(index) = columns.isa_deviation {
            point.isa_deviation =
                TemperatureDifference::kelvin(row.number(index, &ISA_DEVIATION_C)?);
        }
        if let Some((index, column)) = columns.fuel_flow {
            let flow = row.optional(Some(index), column)?;
            point.measured_fuel_flow_total = flow.map(|flow| fuel_flow_in(column, flow));
        }
        point.date = row.date(columns.date)?;
        point.center_of_gravity_percent_mac =
            row.optional(columns.center_of_gravity, &CG_PERCENT_MAC)?;
        point.anti_ice = row.anti_ice(columns.anti_ice)?;
        point.latitude = row.optional(columns.latitude, &LATITUDE_DEG)?.map(Angle::degrees);
        point.true_heading =
            row.optional(columns.true_heading, &TRUE_HEADING_DEG)?.map(Angle::degrees);
        Ok(point)
    }
}

struct TableRow<'t, F> {
    header: &'t CsvText,
    row: u64,
    cell: F,
}

impl<'a, F: Fn(usize) -> PointCell<'a>> TableRow<'_, F> {
    fn number(&self, index: usize, column: &Column) -> Result<f64, CsvError> {
        let found = match (self.cell)(index) {
            PointCell::Number(value) if !value.is_nan() => {
                return within(column, value).map_err(|domain| {
                    let found = value.to_string();
                    self.error(index, CsvErrorReason::OutOfDomain { found, domain })
                });
            }
            cell => words(cell),
        };
        // A field of text is read by the rules of a text file.
        let fields: Vec<String> = vec![found; index + 1];
        let row = crate::csv_text::Row { line: self.row, fields };
        self.header.number(&row, index, column)
    }

    fn optional(&self, index: Option<usize>, column: &Column) -> Result<Option<f64>, CsvError> {
        match index.filter(|index| is_available((self.cell)(*index))) {
            Some(index) => self.number(index, column).map(Some),
            None => Ok(None),
        }
    }

    fn date(&self, index: Option<usize>) -> Result<Option<Timestamp>, CsvError> {
        let Some(index) = index.filter(|index| is_available((self.cell)(*index))) else {
            return Ok(None);
        };
        match (self.cell)(index) {
            PointCell::Instant(instant) => Ok(Some(instant)),
            cell => {
                let found = words(cell);
                super::instant_of(found.trim())
                    .map(Some)
                    .ok_or_else(|| self.error(index, CsvErrorReason::NotADate { found }))
            }
        }
    }

    fn anti_ice(&self, index: Option<usize>) -> Result<Option<bool>, CsvError> {
        let Some(index) = index.filter(|index| is_available((self.cell)(*index))) else {
            return Ok(None);
        };
        let found = words((self.cell)(index));
        let found = found.trim();
        on_or_off(found)
            .map(Some)
            .ok_or_else(|| self.error(index, CsvErrorReason::NotZeroOrOne { found: found.into() }))
    }

    fn error(&self, index: usize, reason: CsvErrorReason) -> CsvError {
        CsvError { line: self.row, ..self.header.header_error(index, reason) }
    }
}

fn is_available(cell: PointCell<'_>) -> bool {
    match cell {
        PointCell::Missing => false,
        PointCell::Number(value) => !value.is_nan(),
        PointCell::Text(text) => crate::csv_text::is_available(text),
        PointCell::Instant(_) => true,
    }
}

fn words(cell: PointCell<'_>) -> String {
    match cell {
        PointCell::Missing => String::new(),
        PointCell::Number(value) => value.to_string(),
        PointCell::Text(text) => text.to_owned(),
        PointCell::Instant(instant) => instant.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use units::FuelFlowTotal;

    use super::super::FlightPoints;
    use super::*;

    const NAMES: &str = "mass_kg,pressure_altitude_ft,mach,isa_deviation_c,date,anti_ice,latitude_deg,fuel_flow_kg_h";

    fn table() -> PointTable {
        PointTable::new(NAMES.split(',').map(str::to_owned).collect()).unwrap()
    }

    /// The oracle is the text file of the same numbers.
    #[test]
    fn a_row_of_numbers_is_the_row_of_a_text() {
        let row = "62000,36000,0.78,-3.5,2024-03-01T10:00:00Z,1,-45.25,2400.5";
        let text = format!("{NAMES}\n{row}\n");
        let read = FlightPoints::from_csv(text.as_bytes()).unwrap();
        let cells: Vec<PointCell<'_>> = row
            .split(',')
            .enumerate()
            .map(|(column, field)| match column {
                4 => PointCell::Instant(field.parse().unwrap()),
                _ => PointCell::Number(field.parse().unwrap()),
            })
            .collect();
        let texts: Vec<PointCell<'_>> = row.split(',').map(PointCell::Text).collect();
        assert_eq!(
            table().point(1, |column| cells[column]).unwrap(),
            read.rows()[0].point.clone().unwrap()
        );
        assert_eq!(
            table().point(1, |column| texts[column]).unwrap(),
            read.rows()[0].point.clone().unwrap()
        );
    }

    #[test]
    fn a_missing_or_absurd_cell_is_named_as_in_a_text() {
        let at = |column: usize, cell: PointCell<'static>| {
            let good = [62_000.0, 36_000.0, 0.78, 0.0, f64::NAN, f64::NAN, f64::NAN, f64::NAN];
            let cells = |k: usize| if k == column { cell } else { PointCell::Number(good[k]) };
            table().point(7, cells).map_err(|error| error.to_string())
        };
        assert!(at(4, PointCell::Missing).is_ok());
        for (column, cell, expected) in [
            (
                2,
                PointCell::Number(78.0),
                "line 7, column 3 (mach): found \"78\", expected 0.1 to 0.99 Mach (Mach number)",
            ),
            (2, PointCell::Missing, "line 7, column 3 (mach): found \"\", expected a number"),
            (
                0,
                PointCell::Number(f64::INFINITY),
                "line 7, column 1 (mass_kg): found \"inf\", expected 225 to 680000 kg (gross mass)",
            ),
            (
                4,
                PointCell::Text("20.5.2018"),
                "line 7, column 5 (date): found \"20.5.2018\", expected a date as 2018-05-20 or 2018-05-20T14:14:21Z",
            ),
            (
                5,
                PointCell::Number(0.5),
                "line 7, column 6 (anti_ice): found \"0.5\", expected 0 or 1",
            ),
        ] {
            assert_eq!(at(column, cell).unwrap_err(), expected);
        }
    }

    /// The oracle is the table read cell by cell.
    #[test]
    fn columns_at_once_are_the_rows_one_by_one() {
        let names = "weight_lb,pressure_altitude_ft,mach,isa_deviation_c,fuel_flow_lb_h,X-note";
        let table = PointTable::new(names.split(',').map(str::to_owned).collect()).unwrap();
        let mut cells = vec![
            vec![66_000.0, 140_000.0],
            vec![41_000.0, 35_000.0],
            vec![0.8, 0.78],
            vec![-3.5, 10.0],
            vec![3500.0, f64::NAN],
        ];
        let at_once =
            |cells: &[Vec<f64>]| table.level_columns(|column| cells.get(column).map(Into::into));
        let found = at_once(&cells).unwrap();
        let of = |column: usize, row: usize| PointCell::Number(cells[column][row]);
        for row in [0, 1] {
            let cell = |column: usize| of(column, row);
            let point = table.point(1, cell).unwrap();
            let flights = found.flights();
            let same = |one: f64, other: f64| assert_eq!(one.to_bits(), other.to_bits());
            same(flights.mass_kg[row], point.mass.to_kilograms());
            same(flights.pressure_altitude_m[row], point.pressure_altitude.to_meters());
            same(flights.mach[row], point.mach.value());
            same(flights.isa_deviation_k[row], point.isa_deviation.to_kelvin());
            let measured = found.measured_fuel_flow_kg_s().unwrap()[row];
            let of_point = point.measured_fuel_flow_total;
            assert_eq!(
                (!measured.is_nan()).then_some(measured),
                of_point.map(FuelFlowTotal::to_kilograms_per_second)
            );
        }
        for (column, odd) in [(2, 78.0), (2, f64::NAN), (4, -1.0), (0, f64::INFINITY)] {
            let good = std::mem::replace(&mut cells[column][1], odd);
            assert_eq!(at_once(&cells), None, "{odd} in column {column}");
            cells[column][1] = good;
        }
        // Words are looked at one by one.
        assert_eq!(table.level_columns(|_| None), None);
    }

    #[test]
    fn names_are_those_of_the_text() {
        let unknown = PointTable::new(vec!["mach".into(), "altitude".into()]).unwrap_err();
        assert!(unknown.to_string().contains("column 2 (altitude): unknown column"), "{unknown}");
    }
}
