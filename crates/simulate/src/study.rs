//! The data of the paper's study: its ten flights, its static points, and a flight-planning guide that is wrong in a
//! known way.
//!
//! Numbers are those of Ghazi et al. (2020), table 5 and section IV, as far as they are legible; the others (routes,
//! dates, fuel loads, when levels and speeds change) are our choice and marked as such.

mod guide;

use flight::Timestamp;
use serde::Serialize;
use units::{Mach, Mass, PressureAltitude};

use crate::aircraft::{AircraftTruth, TruthPhysics};
use crate::plan::{
    AircraftChoice, FleetDesign, Flights, Plan, PlanError, Recording, Scatter, SensorChoice,
    TailPlan,
};
use crate::route::{Change, Earth, FlightPlan, Loading};
use crate::simulation::{Simulation, SimulationError};
use crate::trim::{TrimError, TrimPoint, Trimmed};
use crate::weather::Weather;

pub use guide::{DragError, GuideGrid, GuideRow, flight_planning_guide, guide_csv};

/// A row of table 5: number, pressure altitude in ft, Mach number, gross mass in lb, minutes; whether levels and speeds
/// change ("a" and "b").
const TABLE_5: [(u32, f64, f64, f64, f64, bool, bool); 10] = [
    (1, 25_000.0, 0.58, 31_100.0, 83.0, false, false),
    (2, 38_500.0, 0.79, 28_700.0, 95.0, false, false),
    (3, 32_500.0, 0.79, 32_300.0, 105.0, false, false),
    (4, 27_000.0, 0.55, 33_800.0, 116.0, false, false),
    (5, 28_000.0, 0.61, 29_800.0, 150.0, false, false),
    (6, 28_000.0, 0.71, 30_200.0, 152.0, true, false),
    (7, 31_000.0, 0.84, 33_600.0, 158.0, true, false),
    (8, 41_000.0, 0.78, 33_400.0, 160.0, false, true),
    (9, 39_000.0, 0.84, 34_100.0, 166.0, false, false),
    (10, 40_000.0, 0.73, 34_200.0, 220.0, true, true),
];

/// Start of every route, degrees: Montréal, where the paper's laboratory is. Our choice, as are the tracks.
const ROUTE_START_DEG: (f64, f64) = (45.5, -73.7);
/// Approximate zero-fuel mass of every flight, lb: our choice, a little above the operating empty mass.
const ZERO_FUEL_MASS_LB: f64 = 22_800.0;
/// Approximate fuel used before the recording, lb: as in the report format's example.
const USED_BEFORE_LB: f64 = 1_300.0;
/// 2018-05-20 14:14:21 UTC, the start of the report format's example, s.
const FIRST_START_S: i64 = 1_526_825_661;

/// The ten flights of table 5. Step climbs of 2 000 ft at two fifths of the way, and back at four fifths on flights 7 and
/// 10; speed changes of 0.02 (printed as 0.2, which no aircraft could fly) up at a third and back at two thirds.
#[must_use]
pub fn table_5_flights() -> Vec<FlightPlan> {
    TABLE_5
        .iter()
        .map(|(number, feet, mach, pounds, minutes, levels, speeds)| {
            let duration_s = 60.0 * minutes;
            let mut changes = Vec::new();
            let mut change = |share: f64, change: fn(f64, f64) -> Change, value: f64| {
                changes.push(change((share * duration_s).round(), value));
            };
            if *levels {
                change(0.4, |at_s, feet| Change::PressureAltitude { at_s, feet }, feet + 2000.0);
                if *number != 6 {
                    change(0.8, |at_s, feet| Change::PressureAltitude { at_s, feet }, *feet);
                }
            }
            if *speeds {
                change(1.0 / 3.0, |at_s, mach| Change::Mach { at_s, mach }, mach + 0.02);
                change(2.0 / 3.0, |at_s, mach| Change::Mach { at_s, mach }, *mach);
            }
            changes.sort_by(|a, b| a.at_s().total_cmp(&b.at_s()));
            let (latitude_deg, longitude_deg) = ROUTE_START_DEG;
            // Tracks all around the compass, a golden angle apart.
            let track_deg = 137.5 * f64::from(*number);
            let end = crate::vector::Place::at(latitude_deg, longitude_deg, track_deg)
                .ahead(250.0 * (duration_s + 1500.0));
            FlightPlan {
                flight: format!("{number:04}"),
                start: start(*number),
                duration_s,
                waypoints: vec![
                    ROUTE_START_DEG,
                    (end.latitude_rad().to_degrees(), end.longitude_rad().to_degrees()),
                ],
                pressure_altitude_ft: *feet,
                mach: *mach,
                loading: Loading::AtRecording {
                    gross_mass_kg: Mass::pounds(*pounds).to_kilograms(),
                    fuel_on_board_kg: Mass::pounds(pounds + USED_BEFORE_LB - ZERO_FUEL_MASS_LB)
                        .to_kilograms(),
                },
                center_of_gravity_percent_mac: 27.0,
                center_of_gravity_travel_percent_mac_h: 0.0,
                changes,
                anti_ice: Vec::new(),
            }
        })
        .collect()
}

/// Flights two days apart.
fn start(number: u32) -> Timestamp {
    let seconds = FIRST_START_S + i64::from(number - 1) * 2 * 86_400;
    Timestamp::from_second(seconds).unwrap_or(Timestamp::UNIX_EPOCH)
}

/// The plan of the paper's study: table 5 on a Citation X with all of the truth's physics, wind, temperature and
/// turbulence along the way, sensors without noise but rounded (the paper calls noise and rounding negligible), one
/// fuel.
#[must_use]
pub fn paper_study_plan(seed: u64) -> Plan {
    Plan {
        sensors: SensorChoice::Rounded,
        scatter: Scatter::none(),
        tails: vec![TailPlan {
            tail: "SIM-750".to_owned(),
            effects: Vec::new(),
            engine_deterioration_percent: Vec::new(),
            references: None,
            flights: Flights::Listed(table_5_flights()),
        }],
        ..Plan::of_one_tail(seed, "SIM-750", FleetDesign::default())
    }
}

/// A condition of a static test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StaticCondition {
    /// Gross mass, lb.
    pub weight_lb: f64,
    /// Pressure altitude, ft.
    pub pressure_altitude_ft: f64,
    /// Mach number.
    pub mach: f64,
}

/// The 45 static conditions: three masses at fifteen pairs of level and Mach number.
#[must_use]
pub fn static_conditions() -> Vec<StaticCondition> {
    const LEVELS: [(f64, &[f64]); 6] = [
        (300.0, &[0.60, 0.70, 0.80]),
        (330.0, &[0.65, 0.75]),
        (360.0, &[0.70, 0.80, 0.88]),
        (390.0, &[0.72, 0.82, 0.90]),
        (420.0, &[0.75, 0.85]),
        (450.0, &[0.78, 0.85]),
    ];
    let mut conditions = Vec::new();
    for weight_lb in [25_000.0, 30_000.0, 35_000.0] {
        for (flight_level, machs) in LEVELS {
            for mach in machs {
                conditions.push(StaticCondition {
                    weight_lb,
                    pressure_altitude_ft: 100.0 * flight_level,
                    mach: *mach,
                });
            }
        }
    }
    conditions
}

/// A static point: the truth, and the measurement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StaticPoint {
    /// Where.
    pub condition: StaticCondition,
    /// The trimmed truth, standard gravity.
    pub trimmed: Trimmed,
    /// Mean of six readings of the total fuel flow, 10 s apart, kg/s.
    pub measured_fuel_flow_kg_s: f64,
}

/// Why a static point has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StaticPointError {
    /// It cannot be trimmed.
    #[error(transparent)]
    Trim(#[from] TrimError),
    /// Its plan is invalid.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// It cannot be flown.
    #[error(transparent)]
    Flight(#[from] SimulationError),
}

/// Trims the aircraft at a point of the standard day and flies it there for a minute in still air, with rounded sensors
/// and standard gravity, reading the fuel flow every 10 s as in the paper.
///
/// # Errors
/// [`StaticPointError`] where the aircraft cannot be flown there.
pub fn static_point(
    aircraft: &AircraftTruth,
    physics: TruthPhysics,
    condition: &StaticCondition,
) -> Result<StaticPoint, StaticPointError> {
    let pressure_altitude = PressureAltitude::feet(condition.pressure_altitude_ft);
    let center_of_gravity_percent_mac = aircraft.airframe.trim.reference_percent_mac;
    let mass = Mass::pounds(condition.weight_lb);
    let sat = atmos::isa::temperature(pressure_altitude).map_err(TrimError::from)?;
    let point = TrimPoint {
        mass,
        pressure_altitude,
        mach: Mach::new(condition.mach),
        sat,
        center_of_gravity_percent_mac,
    };
    let trimmed = aircraft.trim(&point, physics)?;
    let plan = Plan {
        aircraft: AircraftChoice::Custom(Box::new(aircraft.clone())),
        physics,
        earth: Earth::plain(),
        weather: Weather::still(),
        sensors: SensorChoice::Rounded,
        scatter: Scatter::none(),
        recording: Recording { interval_s: 10.0, ..Recording::default() },
        tails: vec![TailPlan {
            tail: "STATIC".to_owned(),
            effects: Vec::new(),
            engine_deterioration_percent: Vec::new(),
            references: None,
            flights: Flights::Listed(vec![FlightPlan {
                flight: "static".to_owned(),
                start: start(1),
                duration_s: 50.0,
                waypoints: vec![ROUTE_START_DEG, (ROUTE_START_DEG.0 + 10.0, ROUTE_START_DEG.1)],
                pressure_altitude_ft: condition.pressure_altitude_ft,
                mach: condition.mach,
                loading: Loading::AtRecording {
                    gross_mass_kg: mass.to_kilograms(),
                    fuel_on_board_kg: aircraft.masses.maximum_fuel_kg,
                },
                center_of_gravity_percent_mac,
                center_of_gravity_travel_percent_mac_h: 0.0,
                changes: Vec::new(),
                anti_ice: Vec::new(),
            }]),
        }],
        ..Plan::of_one_tail(0, "STATIC", FleetDesign::default())
    };
    let flown = Simulation::new(plan)?.fly(0)?;
    let flows = &flown.report.columns().fuel_flow;
    let samples = flows.len();
    let measured_fuel_flow_kg_s =
        (0..samples).map(|sample| flows.total_kg_s(sample)).sum::<f64>() / samples as f64;
    Ok(StaticPoint { condition: *condition, trimmed, measured_fuel_flow_kg_s })
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use super::*;
    use crate::aircraft::Preset;

    #[test]
    fn table_5_lift_coefficients() {
        // The column that a reconstruction of the paper computed for table 5, ISA.
        let expected = [0.319, 0.296, 0.250, 0.421, 0.316, 0.236, 0.215, 0.399, 0.319, 0.444];
        for ((_, feet, mach, pounds, ..), expected) in TABLE_5.into_iter().zip(expected) {
            let static_pressure_pa =
                atmos::isa::pressure(PressureAltitude::feet(feet)).unwrap().to_pascals();
            let lift_coefficient = Mass::pounds(pounds).to_kilograms() * 9.80665
                / (0.7 * static_pressure_pa * mach * mach * 48.96);
            assert!((lift_coefficient - expected).abs() < 6e-4, "{feet}: {lift_coefficient}");
        }
        // Total of the table: 23 h 25 min.
        assert_eq!(TABLE_5.iter().map(|row| row.4).sum::<f64>(), 23.0 * 60.0 + 25.0);
    }

    #[test]
    fn the_ten_flights_fly_at_their_mass() {
        let simulation = Simulation::new(paper_study_plan(2020)).unwrap();
        assert_eq!(simulation.len(), 10);
        for (index, (_, feet, _, pounds, minutes, ..)) in TABLE_5.into_iter().enumerate() {
            let flown = simulation.fly(index).unwrap();
            let columns = flown.report.columns();
            assert_eq!(columns.time_s.last().copied(), Some(60.0 * minutes));
            let header = flown.report.header();
            let mass_lb = (header.zero_fuel_mass + header.fuel_on_board).to_pounds()
                - Mass::kilograms(columns.fuel_used_kg[0]).to_pounds();
            assert!((mass_lb - pounds).abs() < 15.0, "{mass_lb} {pounds}");
            let first_ft = PressureAltitude::meters(columns.pressure_altitude_m[0]).to_feet();
            assert!((first_ft - feet).abs() < 5.0, "{first_ft} {feet}");
        }
    }

    #[test]
    fn static_points_measure_the_trimmed_truth() {
        let aircraft = AircraftTruth::preset(Preset::CitationX).unwrap();
        let conditions = static_conditions();
        assert_eq!(conditions.len(), 45);
        for condition in conditions {
            let point = static_point(&aircraft, TruthPhysics::full(), &condition).unwrap();
            // Rounded to 1 lb/h per engine, six times: 0.1 % of 1 200 lb/h at most.
            let ratio = point.measured_fuel_flow_kg_s / point.trimmed.fuel_flow_kg_s;
            assert!((ratio - 1.0).abs() < 1e-3, "{condition:?}: {ratio}");
        }
    }
}
