//! The flight-planning guide: fuel flow by weight, pressure altitude and true airspeed.

use atmos::{airspeed, isa};
use units::{
    FuelFlowTotal, Mach, Mass, OutOfDomain, PressureAltitude, Temperature, TemperatureDifference,
    TrueAirspeed, check_within,
};

use crate::columns::{
    FLIGHT_LEVEL, FUEL_FLOW_KG_H, FUEL_FLOW_LB_H, FUEL_FLOW_PER_ENGINE_KG_H,
    FUEL_FLOW_PER_ENGINE_LB_H, ISA_DEVIATION_C, MACH, MASS_KG, MAXIMUM_MACH, MINIMUM_MACH,
    PRESSURE_ALTITUDE_FT, TRUE_AIRSPEED_KT, WEIGHT_LB,
};
use crate::csv_text::{Column, CsvError, CsvErrorReason, CsvText, Known, Row};

/// A flight-planning guide: level, unaccelerated cruise, one row per condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    points: Vec<GuidePoint>,
}

/// A row of a guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuidePoint {
    /// Line of the file, from 1.
    pub line: u64,
    /// Gross mass ("weight").
    pub mass: Mass,
    /// Pressure altitude.
    pub pressure_altitude: PressureAltitude,
    /// True airspeed.
    pub true_airspeed: TrueAirspeed,
    /// Fuel flow of all engines.
    pub fuel_flow_total: FuelFlowTotal,
    /// Deviation from the ISA; zero where the guide states none.
    pub isa_deviation: TemperatureDifference,
}

/// Columns that a guide may have.
const COLUMNS: [Column; 11] = [
    WEIGHT_LB,
    MASS_KG,
    PRESSURE_ALTITUDE_FT,
    FLIGHT_LEVEL,
    TRUE_AIRSPEED_KT,
    MACH,
    FUEL_FLOW_LB_H,
    FUEL_FLOW_KG_H,
    FUEL_FLOW_PER_ENGINE_LB_H,
    FUEL_FLOW_PER_ENGINE_KG_H,
    ISA_DEVIATION_C,
];

impl Guide {
    /// Reads a guide.
    ///
    /// Comma-separated; the header determines the columns, in any order: `weight_lb` or `mass_kg`;
    /// `pressure_altitude_ft` or `flight_level`; `true_airspeed_kt` or `mach`; `fuel_flow_lb_h` or `fuel_flow_kg_h`, all
    /// engines; optionally `isa_deviation_c`. Columns whose name begins with `X-` are ignored. For a flow per engine see
    /// [`from_csv_of_engines`](Self::from_csv_of_engines).
    ///
    /// ```
    /// use perf_model::Guide;
    ///
    /// let guide = Guide::from_csv(b"weight_lb,pressure_altitude_ft,true_airspeed_kt,fuel_flow_lb_h\n\
    ///     30000,43000,470,1610\n")?;
    /// assert_eq!(guide.points()[0].line, 2);
    ///
    /// let error = Guide::from_csv(b"weight_lb,pressure_altitude_ft,true_airspeed_kt,fuel_flow_lb_h\n\
    ///     30000,43000,470,l610\n").unwrap_err();
    /// assert_eq!(error.to_string(), "line 2, column 4 (fuel_flow_lb_h): found \"l610\", expected a number");
    /// # Ok::<(), perf_model::CsvError>(())
    /// ```
    ///
    /// # Errors
    /// [`CsvError`] at the first fault: an unknown, missing or repeated column, a row with too few or too many fields,
    /// a field that is not a number or outside the quantity's limits, an airspeed outside Mach 0.1 to 0.99.
    pub fn from_csv(text: &[u8]) -> Result<Self, CsvError> {
        read(text, None)
    }

    /// The same where the flow may also be that of one engine, as an aircraft's manual prints it:
    /// `fuel_flow_per_engine_lb_h` or `fuel_flow_per_engine_kg_h`.
    ///
    /// # Errors
    /// As [`from_csv`](Self::from_csv).
    pub fn from_csv_of_engines(text: &[u8], engines: u8) -> Result<Self, CsvError> {
        read(text, Some(engines))
    }

    /// The rows, in the file's order; one or more.
    #[must_use]
    pub fn points(&self) -> &[GuidePoint] {
        &self.points
    }
}

impl GuidePoint {
    /// Static air temperature: that of the ISA plus the deviation.
    ///
    /// # Errors
    /// [`OutOfDomain`] for a pressure altitude outside the atmosphere's domain.
    pub fn static_air_temperature(&self) -> Result<Temperature, OutOfDomain> {
        Ok(isa::temperature(self.pressure_altitude)? + self.isa_deviation)
    }

    /// Mach number: M = V/√(γ R SAT).
    ///
    /// # Errors
    /// [`OutOfDomain`] outside Mach 0.1 to 0.99, and for a pressure altitude outside the atmosphere's domain.
    pub fn mach(&self) -> Result<Mach, OutOfDomain> {
        let mach =
            airspeed::true_airspeed_to_mach(self.true_airspeed, self.static_air_temperature()?);
        check_within("Mach number", "Mach", mach.value(), MINIMUM_MACH, MAXIMUM_MACH)?;
        Ok(mach)
    }
}

/// A gross mass in the unit of its column.
pub(crate) fn mass_in(column: &Column, value: f64) -> Mass {
    if column.name == WEIGHT_LB.name { Mass::pounds(value) } else { Mass::kilograms(value) }
}

/// A fuel flow in the unit of its column.
pub(crate) fn fuel_flow_in(column: &Column, value: f64) -> FuelFlowTotal {
    if [FUEL_FLOW_LB_H.name, FUEL_FLOW_PER_ENGINE_LB_H.name].contains(&column.name) {
        FuelFlowTotal::pounds_per_hour(value)
    } else {
        FuelFlowTotal::kilograms_per_hour(value)
    }
}

fn read(text: &[u8], engines: Option<u8>) -> Result<Guide, CsvError> {
    let file = CsvText::read(text, Known { columns: &COLUMNS, without_meaning: &[] })?;
    let columns = Columns {
        mass: file.require_one_of(&[&WEIGHT_LB, &MASS_KG])?,
        altitude: file.require_one_of(&[&PRESSURE_ALTITUDE_FT, &FLIGHT_LEVEL])?,
        speed: file.require_one_of(&[&TRUE_AIRSPEED_KT, &MACH])?,
        flow: file.require_one_of(&[
            &FUEL_FLOW_LB_H,
            &FUEL_FLOW_KG_H,
            &FUEL_FLOW_PER_ENGINE_LB_H,
            &FUEL_FLOW_PER_ENGINE_KG_H,
        ])?,
        isa_deviation: file.find(&ISA_DEVIATION_C),
    };
    let (index, flow) = columns.flow;
    if is_per_engine(flow) && engines.is_none() {
        return Err(file.header_error(index, CsvErrorReason::EnginesUnknown));
    }
    let points = file
        .rows
        .iter()
        .map(|row| columns.point(&file, row, f64::from(engines.unwrap_or(1))))
        .collect::<Result<_, _>>()?;
    Ok(Guide { points })
}

/// A pressure altitude as its column has it: in feet, or in flight levels.
pub(crate) fn pressure_altitude_in(column: &Column, value: f64) -> PressureAltitude {
    PressureAltitude::feet(feet_per_unit(column) * value)
}

/// Feet in a unit of a column of pressure altitude.
pub(crate) fn feet_per_unit(column: &Column) -> f64 {
    if column.name == FLIGHT_LEVEL.name { 100.0 } else { 1.0 }
}

/// Where a file has its columns, and which of each meaning.
struct Columns {
    mass: (usize, &'static Column),
    altitude: (usize, &'static Column),
    speed: (usize, &'static Column),
    flow: (usize, &'static Column),
    isa_deviation: Option<usize>,
}

impl Columns {
    fn point(&self, file: &CsvText, row: &Row, engines: f64) -> Result<GuidePoint, CsvError> {
        let number = |(index, column): (usize, &'static Column)| file.number(row, index, column);
        let pressure_altitude = pressure_altitude_in(self.altitude.1, number(self.altitude)?);
        let isa_deviation = TemperatureDifference::kelvin(match self.isa_deviation {
            Some(index) => file.number(row, index, &ISA_DEVIATION_C)?,
            None => 0.0,
        });
        let speed = number(self.speed)?;
        let inconsistent =
            |domain| file.error(row, self.speed.0, CsvErrorReason::Inconsistent { domain });
        let true_airspeed = if self.speed.1.name == MACH.name {
            let sat = isa::temperature(pressure_altitude).map_err(inconsistent)? + isa_deviation;
            airspeed::mach_to_true_airspeed(Mach::new(speed), sat)
        } else {
            TrueAirspeed::knots(speed)
        };
        let flow = number(self.flow)?;
        let times = if is_per_engine(self.flow.1) { engines } else { 1.0 };
        let point = GuidePoint {
            line: row.line,
            mass: mass_in(self.mass.1, number(self.mass)?),
            pressure_altitude,
            true_airspeed,
            fuel_flow_total: fuel_flow_in(self.flow.1, times * flow),
            isa_deviation,
        };
        point.mach().map_err(inconsistent)?;
        Ok(point)
    }
}

fn is_per_engine(column: &Column) -> bool {
    [FUEL_FLOW_PER_ENGINE_LB_H.name, FUEL_FLOW_PER_ENGINE_KG_H.name].contains(&column.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "weight_lb,pressure_altitude_ft,true_airspeed_kt,fuel_flow_lb_h";

    fn read(text: &str) -> Result<Guide, CsvError> {
        Guide::from_csv(text.as_bytes())
    }

    fn message(text: &str) -> String {
        read(text).unwrap_err().to_string()
    }

    #[test]
    fn units_follow_the_header_in_any_order() {
        let pounds = read(&format!("{HEADER}\n30000,41000,470,1688\n")).unwrap();
        let point = pounds.points()[0];
        assert!((point.mass.to_kilograms() - 13_607.771_1).abs() < 1e-9); // 30 000 × 0.453 592 37
        assert!((point.pressure_altitude.to_meters() - 12_496.8).abs() < 1e-9); // 41 000 × 0.3048
        assert!((point.true_airspeed.to_meters_per_second() - 241.788_889).abs() < 1e-6);
        assert!((point.fuel_flow_total.to_kilograms_per_second() - 0.212_684_4).abs() < 1e-7);
        // 470 kt in the stratosphere (a = 573.57 kt, the standard's 295.07 m/s) is Mach 0.8194.
        assert!((point.mach().unwrap().value() - 470.0 / 573.57).abs() < 1e-4);

        let kilograms = read(
            "X-page,fuel_flow_kg_h,isa_deviation_c,true_airspeed_kt,mass_kg,pressure_altitude_ft\n\
             12,765.66392056,10,470,13607.7711,41000\n",
        )
        .unwrap();
        let other = kilograms.points()[0];
        assert!((other.mass.to_kilograms() - point.mass.to_kilograms()).abs() < 1e-9);
        assert!(
            (other.fuel_flow_total - point.fuel_flow_total).to_kilograms_per_second().abs() < 1e-9
        );
        assert!((other.static_air_temperature().unwrap().to_kelvin() - 226.65).abs() < 1e-9);
    }

    #[test]
    fn as_a_manual_prints_it() {
        // FL 410, Mach 0.8194 is 470 kt within 0.02 kt (previous test); 844 lb/h for each of two engines are 1688 lb/h.
        let text = "weight_lb,flight_level,mach,fuel_flow_per_engine_lb_h\n30000,410,0.81943,844\n";
        let manual = Guide::from_csv_of_engines(text.as_bytes(), 2).unwrap();
        let plain = read(&format!("{HEADER}\n30000,41000,470,1688\n")).unwrap();
        let (manual, plain) = (manual.points()[0], plain.points()[0]);
        assert!((manual.true_airspeed.to_knots() - 470.0).abs() < 0.02);
        assert_eq!(manual.pressure_altitude, plain.pressure_altitude);
        assert_eq!(manual.fuel_flow_total, plain.fuel_flow_total);
        assert_eq!(
            message(text),
            "line 1, column 4 (fuel_flow_per_engine_lb_h): fuel flow per engine needs the number of \
             engines, as an aircraft file states it"
        );
    }

    #[test]
    fn faults_of_the_header() {
        assert_eq!(
            message("weight_lb,pressure_altitude_ft,tas_kt,fuel_flow_lb_h\n1,2,3,4\n"),
            "line 1, column 3 (tas_kt): unknown column, expected one of weight_lb, mass_kg, \
             pressure_altitude_ft, flight_level, true_airspeed_kt, mach, fuel_flow_lb_h, fuel_flow_kg_h, \
             fuel_flow_per_engine_lb_h, fuel_flow_per_engine_kg_h, isa_deviation_c, or a name beginning with X-"
        );
        assert_eq!(
            message(&format!("{HEADER},weight_lb\n1,2,3,4,5\n")),
            "line 1, column 5 (weight_lb): column appears twice, first as column 1"
        );
        assert_eq!(
            message(&format!("{HEADER},mass_kg\n1,2,3,4,5\n")),
            "line 1, column 5 (mass_kg): column is the same quantity as weight_lb, expected only one of the two"
        );
        assert_eq!(
            message("weight_lb,pressure_altitude_ft,true_airspeed_kt\n1,2,3\n"),
            "line 1: missing column fuel_flow_lb_h or fuel_flow_kg_h or fuel_flow_per_engine_lb_h or \
             fuel_flow_per_engine_kg_h"
        );
        assert_eq!(
            message("\n\nmass_kg,true_airspeed_kt,fuel_flow_kg_h\n1,2,3\n"),
            "line 3: missing column pressure_altitude_ft or flight_level"
        );
        assert!(message("").starts_with("line 1: no header, expected column names: weight_lb"));
        assert_eq!(message(&format!("{HEADER}\n")), "line 1: no rows after the header");
        assert_eq!(
            message("weight_lb;pressure_altitude_ft\n1;2\n"),
            "line 1, column 1 (weight_lb;pressure_altitude_ft): names with ';' between them, expected ','"
        );
    }

    #[test]
    fn faults_of_a_row() {
        let row = |row: &str| message(&format!("{HEADER}\n30000,41000,470,1688\n{row}\n"));
        for (text, expected) in [
            ("30000,41000,470", "line 3: 3 fields, expected 4 as in the header"),
            ("30000,41000,470,1688,", "line 3: 5 fields, expected 4 as in the header"),
            (
                "30000,41000,,1688",
                "line 3, column 3 (true_airspeed_kt): found \"\", expected a number",
            ),
            (
                "30000,41000,470,inf",
                "line 3, column 4 (fuel_flow_lb_h): found \"inf\", expected a number",
            ),
            (
                "30000,41000,470,1e999",
                "line 3, column 4 (fuel_flow_lb_h): found \"1e999\", expected a number",
            ),
            (
                "30000,41000,470,1.688.0",
                "line 3, column 4 (fuel_flow_lb_h): found \"1.688.0\", expected a number",
            ),
            (
                "-30000,41000,470,1688",
                "line 3, column 1 (weight_lb): found \"-30000\", expected 500 to 1500000 lb (gross weight)",
            ),
            (
                "30000,410000,470,1688",
                "line 3, column 2 (pressure_altitude_ft): found \"410000\", expected -2000 to 60000 ft (pressure altitude)",
            ),
            (
                "30000,41000,470,0",
                "line 3, column 4 (fuel_flow_lb_h): found \"0\", expected 1 to 400000 lb/h (total fuel flow)",
            ),
        ] {
            assert_eq!(row(text), expected);
        }
        // 600 kt at 41 000 ft is Mach 1.046: each field is possible, the combination is not.
        let error = row("30000,41000,600,1688");
        assert!(
            error.starts_with("line 3, column 3 (true_airspeed_kt): together with the row's other fields: Mach number 1.04"),
            "{error}"
        );
    }

    #[test]
    fn lines_are_physical_whatever_ends_them() {
        let text =
            format!("\u{feff}{HEADER}\r\n\r\n30000, 41000 ,470,1688\r\n\r\n\r\n30000,41000,x,1688");
        assert!(message(&text).starts_with("line 6, column 3"), "{}", message(&text));
        let guide = read(&text.replace('x', "450")).unwrap();
        assert_eq!(guide.points().iter().map(|p| p.line).collect::<Vec<_>>(), [3, 6]);
        let broken = [HEADER.as_bytes(), b"\n30000,41000,\xff,1688\n"].concat();
        let error = Guide::from_csv(&broken).unwrap_err();
        assert_eq!((error.line, error.column.unwrap().number), (2, 3));
        assert_eq!(error.reason, CsvErrorReason::NotUtf8);
    }
}
