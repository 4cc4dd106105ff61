//! Flight points from a table in memory, whose cells are numbers rather than text.

use flight::Timestamp;
use units::{Angle, Mach, PressureAltitude, TemperatureDifference};

use super::{COLUMNS, Columns, FlightPoint};
use crate::columns::{
    CG_PERCENT_MAC, ISA_DEVIATION_C, LATITUDE_DEG, MACH, PRESSURE_ALTITUDE_FT, TRUE_HEADING_DEG,
};
use crate::csv_text::{Column, CsvError, CsvErrorReason, CsvText, within};
use crate::guide::{fuel_flow_in, mass_in};

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

impl PointTable {
    /// The columns of a table with these names.
    ///
    /// # Errors
    /// [`CsvError`] for a name that flight points do not have (other than one beginning with `X-`), that appears twice or is
    /// missing.
    pub fn new(names: Vec<String>) -> Result<Self, CsvError> {
        let header = CsvText::of_header(names, &COLUMNS)?;
        let columns = Columns::find_in(&header)?;
        Ok(Self { header, columns })
    }

    /// Position of the measured fuel flow, if the table has it.
    #[must_use]
    pub fn measured_fuel_flow(&self) -> Option<usize> {
        self.columns.fuel_flow.map(|(index, _)| index)
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
        let mut point = FlightPoint::new(
            mass_in(mass_column, row.number(mass, mass_column)?),
            PressureAltitude::feet(row.number(columns.pressure_altitude, &PRESSURE_ALTITUDE_FT)?),
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
        match words((self.cell)(index)).trim() {
            "0" => Ok(Some(false)),
            "1" => Ok(Some(true)),
            found => Err(self.error(index, CsvErrorReason::NotZeroOrOne { found: found.into() })),
        }
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
        assert_eq!(table().point(1, |column| cells[column]).unwrap(), read.rows()[0].point);
        assert_eq!(table().point(1, |column| texts[column]).unwrap(), read.rows()[0].point);
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
                "line 7, column 3 (mach): found \"78\", expected 0.1..=0.99 Mach (Mach number)",
            ),
            (2, PointCell::Missing, "line 7, column 3 (mach): found \"\", expected a number"),
            (
                0,
                PointCell::Number(f64::INFINITY),
                "line 7, column 1 (mass_kg): found \"inf\", expected 225..=680000 kg (gross mass)",
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

    #[test]
    fn names_are_those_of_the_text() {
        let unknown = PointTable::new(vec!["mach".into(), "altitude".into()]).unwrap_err();
        assert!(unknown.to_string().contains("column 2 (altitude): unknown column"), "{unknown}");
    }
}
