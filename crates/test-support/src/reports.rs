//! Cruise reports: a text that all readers know, and reports made from a few numbers or read from well-formed text.
#![expect(clippy::unwrap_used, clippy::panic, reason = "what is broken stops the test")]

use flight::column::Column;
use flight::{
    FlightIdentity, FuelFlowColumns, OptionalColumn, OptionalColumns, Report, ReportColumns,
    ReportHeader,
};
use units::Mass;
use units::convert::{KELVIN_AT_ZERO_CELSIUS, METERS_PER_FOOT, METERS_PER_SECOND_PER_KNOT};

/// The sample on the format's page of the book: three samples of a twin, with all optional columns that it shows.
pub const FORMAT_SAMPLE: &str = "\
CRUISE-REPORT 1
AIRCRAFT C750
TAIL     T-001
FLIGHT   0007
START    2018-05-20T14:14:21Z
ZFW      24283 lb
FOB      7219 lb
TIME ALT SAT MACH VTAS GSPD ROLL DRIFT N2(1) N2(2) WF(1) WF(2) FU LAT LON HDG CG A/I
s ft degC - kt kt deg deg % % lb/h lb/h lb deg deg deg %MAC -
0 43008 -56.6 0.8030 460.5 451.5 -0.1 4.2 89.4 89.4 654 658 1353 41.516 -69.976 118.7 27.2 0
60 43003 -56.5 0.8025 460.5 451.0 0.0 4.4 89.4 89.3 653 648 1375 41.456 -69.829 118.7 27.2 0
120 43003 -56.8 0.8025 460.0 450.5 0.0 4.6 89.5 89.5 659 658 1396 41.395 -69.683 118.7 27.1 0
";

/// The header of [`FORMAT_SAMPLE`].
///
/// # Panics
///
/// Never: its date is a constant.
#[must_use]
pub fn header() -> ReportHeader {
    ReportHeader {
        aircraft_type: "C750".to_owned(),
        identity: FlightIdentity {
            tail: "T-001".to_owned(),
            start: "2018-05-20T14:14:21Z".parse().unwrap(),
            flight: "0007".to_owned(),
        },
        zero_fuel_mass: Mass::pounds(24_283.0),
        fuel_on_board: Mass::pounds(7_219.0),
        lower_heating_value_mj_kg: None,
        missing: vec![],
        assumed: vec![],
        notes: vec![],
    }
}

/// A twin in perfectly steady cruise at FL430: 460.5 kt TAS, Mach 0.8025.
#[must_use]
pub fn steady(step_s: f64, samples: usize) -> ReportColumns {
    let of = |value: f64| vec![value; samples];
    ReportColumns {
        time_s: (0..samples).map(|sample| step_s * sample as f64).collect(),
        pressure_altitude_m: of(43_000.0 * METERS_PER_FOOT),
        static_air_temperature_k: Some(of(-56.5 + KELVIN_AT_ZERO_CELSIUS)),
        mach: of(0.8025),
        true_airspeed_m_s: of(460.5 * METERS_PER_SECOND_PER_KNOT),
        ground_speed_m_s: of(451.5 * METERS_PER_SECOND_PER_KNOT),
        roll_deg: Some(of(0.1)),
        drift_deg: Some(of(4.2)),
        n2_percent: Some(vec![of(89.4), of(89.4)]),
        fuel_flow: FuelFlowColumns::PerEngine(vec![of(0.083), of(0.083)]),
        fuel_used_kg: of(600.0),
        optional: OptionalColumns::default(),
    }
}

/// Reads a report that is known to be well-formed, for crates that do not depend on the reader.
///
/// # Panics
///
/// Where the report is not well-formed, or holds a header key or a column that no such report has.
#[must_use]
pub fn read(text: &str) -> Report {
    let mut header = header();
    let mut lines = text
        .lines()
        .map(|line| line.split('#').next().unwrap().trim())
        .filter(|line| !line.is_empty());
    assert_eq!(lines.next(), Some("CRUISE-REPORT 1"));
    let names = loop {
        let line = lines.next().unwrap();
        if line.starts_with("TIME ") {
            break line;
        }
        let (key, value) = line.split_once(char::is_whitespace).unwrap();
        let value = value.trim();
        let pounds = || Mass::pounds(value.strip_suffix(" lb").unwrap().parse().unwrap());
        match key {
            "AIRCRAFT" => value.clone_into(&mut header.aircraft_type),
            "TAIL" => value.clone_into(&mut header.identity.tail),
            "FLIGHT" => value.clone_into(&mut header.identity.flight),
            "START" => header.identity.start = value.parse().unwrap(),
            "ZFW" => header.zero_fuel_mass = pounds(),
            "FOB" => header.fuel_on_board = pounds(),
            _ => panic!("{key} is not expected here"),
        }
    };
    let units: Vec<&str> = lines.next().unwrap().split_whitespace().collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split_whitespace().collect()).collect();
    let mut columns = steady(60.0, rows.len());
    for (index, name) in names.split_whitespace().enumerate() {
        let column = Column::from_name(name).unwrap();
        let unit = column.units().iter().find(|unit| unit.name == units[index]).unwrap();
        let optional: OptionalColumn = rows
            .iter()
            .map(|row| row[index].parse::<f64>().ok())
            .map(|number| number.map(|number| number * unit.factor + unit.offset))
            .collect();
        put(&mut columns, column, optional);
    }
    Report::new(header, columns).unwrap()
}

fn put(columns: &mut ReportColumns, column: Column, optional: OptionalColumn) {
    let full = || -> Vec<f64> { optional.iter().map(|value| value.unwrap()).collect() };
    let engine = |k: u8| usize::from(k) - 1;
    match column {
        Column::Time => columns.time_s = full(),
        Column::PressureAltitude => columns.pressure_altitude_m = full(),
        Column::StaticAirTemperature => columns.static_air_temperature_k = Some(full()),
        Column::Mach => columns.mach = full(),
        Column::TrueAirspeed => columns.true_airspeed_m_s = full(),
        Column::GroundSpeed => columns.ground_speed_m_s = full(),
        Column::Roll => columns.roll_deg = Some(full()),
        Column::Drift => columns.drift_deg = Some(full()),
        Column::N2(k) => columns.n2_percent.as_mut().unwrap()[engine(k)] = full(),
        Column::FuelFlowEngine(k) => {
            let FuelFlowColumns::PerEngine(flows) = &mut columns.fuel_flow else { unreachable!() };
            flows[engine(k)] = full();
        }
        Column::FuelUsed => columns.fuel_used_kg = full(),
        Column::Latitude => columns.optional.insert(Column::Latitude, optional),
        Column::Longitude => columns.optional.insert(Column::Longitude, optional),
        Column::TrueHeading => columns.optional.insert(Column::TrueHeading, optional),
        Column::CenterOfGravity => columns.optional.insert(Column::CenterOfGravity, optional),
        _ => panic!("{column:?} is not expected here"),
    }
}
