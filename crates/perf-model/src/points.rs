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
use crate::csv_text::{Column, CsvError, CsvErrorReason, CsvText, Row, is_available};
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
    /// Their meaning; the error of a needed value that is missing ([`CsvError::is_missing_value`]).
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

impl FlightPoints {
    /// Reads flight points.
    ///
    /// Comma-separated; the header determines the columns: `weight_lb` or `mass_kg`; `pressure_altitude_ft` or `flight_level`; `mach`;
    /// optionally `isa_deviation_c` (otherwise the ISA), `fuel_flow_lb_h` or `fuel_flow_kg_h`, `date`,
    /// `cg_percent_mac`, `anti_ice`, `latitude_deg`, `true_heading_deg`. An empty field or `-` means "not available": in a column
    /// that is needed, and in `isa_deviation_c`, the row is then without a point. Columns whose name begins with `X-` are kept and
    /// have no meaning.
    ///
    /// # Errors
    /// [`CsvError`] at the first fault, as for [`Guide::from_csv`](crate::Guide::from_csv), but for values that are missing.
    pub fn from_csv(text: &[u8]) -> Result<Self, CsvError> {
        let file = CsvText::read(text, &COLUMNS)?;
        let columns = Columns::find_in(&file)?;
        let point = |row| match columns.point(&file, row) {
            Err(error) if !error.is_missing_value() => Err(error),
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
    match row.fields[index].trim() {
        "0" => Ok(Some(false)),
        "1" => Ok(Some(true)),
        found => Err(file.error(row, index, CsvErrorReason::NotZeroOrOne { found: found.into() })),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_columns_and_the_rows_as_sent() {
        let text = "date,weight_lb,pressure_altitude_ft,mach,isa_deviation_c,fuel_flow_kg_h,\
                    cg_percent_mac,anti_ice,latitude_deg,true_heading_deg,X-note\n\
                    2018-05-20, 30000,43000,0.82,-5,730.3,25.5,1,-45,270,\"first, best\"\n\
                    2018-05-20T14:14:21+02:00,30000,43000,.82,0,-,,0,,,\n";
        let points = FlightPoints::from_csv(text.as_bytes()).unwrap();
        assert_eq!(points.header().len(), 11);
        let [first, second] = points.rows() else { panic!("{points:?}") };
        assert_eq!((first.line, second.line), (2, 3));
        assert_eq!(first.fields[1], " 30000");
        assert_eq!(first.fields[10], "first, best");
        let point = first.point.clone().unwrap();
        assert_eq!(point.date, Some("2018-05-20T00:00:00Z".parse().unwrap()));
        assert!((point.mass.to_pounds() - 30_000.0).abs() < 1e-9);
        assert!((point.pressure_altitude.to_feet() - 43_000.0).abs() < 1e-9);
        assert!((point.static_air_temperature().unwrap().to_kelvin() - 211.65).abs() < 1e-9);
        let flow = point.measured_fuel_flow_total.unwrap().to_kilograms_per_hour();
        assert!((flow - 730.3).abs() < 1e-9);
        assert_eq!(point.center_of_gravity_percent_mac, Some(25.5));
        assert_eq!(point.anti_ice, Some(true));
        assert!((point.latitude.unwrap().to_degrees() + 45.0).abs() < 1e-9);
        assert!((point.true_heading.unwrap().to_degrees() - 270.0).abs() < 1e-9);
        let bare = second.point.clone().unwrap();
        assert_eq!(bare.date, Some("2018-05-20T12:14:21Z".parse().unwrap()));
        assert_eq!(
            bare,
            FlightPoint {
                date: bare.date,
                anti_ice: Some(false),
                ..FlightPoint::new(bare.mass, bare.pressure_altitude, bare.mach)
            }
        );
    }

    #[test]
    fn flight_levels_are_hundreds_of_feet() {
        let in_feet =
            FlightPoints::from_csv(b"mass_kg,pressure_altitude_ft,mach\n14000,41000,0.8").unwrap();
        let in_levels =
            FlightPoints::from_csv(b"mass_kg,flight_level,mach\n14000,410,0.8").unwrap();
        assert_eq!(in_levels.rows()[0].point, in_feet.rows()[0].point);
        let both = b"mass_kg,pressure_altitude_ft,flight_level,mach\n14000,41000,410,0.8";
        assert!(FlightPoints::from_csv(both).is_err());
    }

    #[test]
    fn the_shortest_file() {
        let points =
            FlightPoints::from_csv(b"mass_kg,pressure_altitude_ft,mach\n14000,41000,0.8").unwrap();
        let expected = FlightPoint::new(
            Mass::kilograms(14_000.0),
            PressureAltitude::feet(41_000.0),
            Mach::new(0.8),
        );
        assert_eq!(points.rows()[0].point, Ok(expected));
    }

    #[test]
    fn a_row_that_lacks_a_needed_value_is_no_point_and_no_fault() {
        let text = "mass_kg,pressure_altitude_ft,mach,isa_deviation_c\n\
                    ,41000,0.8,0\n14000,-,0.8,0\n14000,41000, ,0\n14000,41000,0.8,\n14000,41000,0.8,0\n";
        let points = FlightPoints::from_csv(text.as_bytes()).unwrap();
        let named = |row: &FlightPointRow| {
            row.point.as_ref().err().and_then(|error| error.column.as_ref()).map(|it| it.number)
        };
        let named: Vec<Option<usize>> = points.rows().iter().map(named).collect();
        assert_eq!(named, [Some(1), Some(2), Some(3), Some(4), None]);
        // A word is a fault, and so is the first one behind a value that is missing.
        assert!(FlightPoints::from_csv(text.replace('-', "none").as_bytes()).is_err());
    }

    #[test]
    fn faults_have_line_column_found_and_expected() {
        let message = |row: &str| {
            let text =
                format!("mass_kg,pressure_altitude_ft,mach,isa_deviation_c,date,anti_ice\n{row}\n");
            FlightPoints::from_csv(text.as_bytes()).unwrap_err().to_string()
        };
        for (row, expected) in [
            (
                "14000,41000,1.2,0,,",
                "line 2, column 3 (mach): found \"1.2\", expected 0.1..=0.99 Mach (Mach number)",
            ),
            (
                "14000,41000,0.8,216.65,,",
                "line 2, column 4 (isa_deviation_c): found \"216.65\", expected -50..=50 °C (deviation from the ISA)",
            ),
            (
                "14000,41000,0.8,0,20.5.2018,",
                "line 2, column 5 (date): found \"20.5.2018\", expected a date as 2018-05-20 or 2018-05-20T14:14:21Z",
            ),
            (
                "14000,41000,0.8,0,,0.5",
                "line 2, column 6 (anti_ice): found \"0.5\", expected 0 or 1",
            ),
        ] {
            assert_eq!(message(row), expected);
        }
    }
}
