//! Three fleets of one type flown in JSBSim: a baseline, one with +3 % zero-lift drag, one whose Mach number reads high.

use std::fs::read_to_string;
use std::sync::Arc;

use adapt::bayes::{BayesSettings, BayesState};
use flight::{Observation, Timestamp};
use lut::{Axis, Grid, Outside, Table};
use units::convert::TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR;
use units::{PressureAltitude, Temperature, TrueAirspeed};

use crate::fleet::{Flights, SENSORS, errors_percent, mean_and_std, solved};

const WING_AREA_M2: f64 = 94.94690688;
const TSFC_STATIC_LB_LBF_H: f64 = 0.657;

struct Csv {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Csv {
    fn read(name: &str) -> Self {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/").to_owned() + name;
        let text = read_to_string(path).unwrap();
        let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let mut lines = text.lines().map(cells);
        Self { header: lines.next().unwrap(), rows: lines.collect() }
    }

    fn text(&self, row: usize, name: &str) -> &str {
        let column = self.header.iter().position(|cell| cell == name).unwrap();
        &self.rows[row][column]
    }

    fn number(&self, row: usize, name: &str) -> f64 {
        self.text(row, name).parse().unwrap()
    }

    fn column(&self, name: &str) -> Vec<f64> {
        (0..self.rows.len()).map(|row| self.number(row, name)).collect()
    }
}

/// A fleet's flights, and each segment's error against the initial table as the reference has it.
pub(crate) fn fleet(name: &str) -> (Flights, Vec<f64>) {
    let csv = Csv::read(&format!("{name}_segments.csv"));
    let mut flights: Flights = Vec::new();
    let mut previous = "";
    for row in 0..csv.rows.len() {
        let number = |column| csv.number(row, column);
        let sat = Temperature::kelvin(number("static_air_temperature_k"));
        let pressure =
            atmos::isa::pressure(PressureAltitude::meters(number("pressure_altitude_m"))).unwrap();
        let density_kg_m3 = atmos::isa::density(pressure, sat).to_kilograms_per_cubic_meter();
        let tas = TrueAirspeed::meters_per_second(number("true_airspeed_m_s"));
        let tsfc_kg_n_s = TSFC_STATIC_LB_LBF_H
            * TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR
            * atmos::isa::temperature_ratio(sat).sqrt();
        let dynamic_pressure_pa = 0.5 * density_kg_m3 * tas.to_meters_per_second().powi(2);
        if csv.text(row, "flight") != previous {
            flights.push(Vec::new());
        }
        previous = csv.text(row, "flight");
        let day = 86_400.0 * flights.len() as f64;
        #[expect(clippy::cast_possible_truncation, reason = "whole seconds are enough")]
        let seconds = (day + number("time_s")) as i64;
        flights.last_mut().unwrap().push(Observation {
            time: Timestamp::from_second(seconds).unwrap(),
            lift_coefficient: number("lift_coefficient"),
            mach: number("mach"),
            drag_coefficient: number("drag_coefficient"),
            fuel_flow_total_kg_s: number("fuel_flow_kg_s"),
            fuel_flow_per_drag_coefficient_kg_s: dynamic_pressure_pa * WING_AREA_M2 * tsfc_kg_n_s,
            variance: SENSORS,
        });
    }
    (flights, csv.column("error_percent"))
}

pub(crate) fn initial_table() -> Table {
    let csv = Csv::read("initial_wide_table.csv");
    let axis = |name| {
        let mut values = csv.column(name);
        values.sort_by(f64::total_cmp);
        values.dedup();
        Axis::new(values).unwrap()
    };
    let grid = Arc::new(Grid::new(axis("lift_coefficient"), axis("mach")));
    Table::new(grid, csv.column("drag_coefficient")).unwrap()
}

#[test]
fn errors_of_the_initial_table_are_the_reference_s() {
    let initial = initial_table();
    for name in ["SIM-01", "SIM-02", "SIM-05"] {
        let (flights, reference) = fleet(name);
        for (error, expected) in errors_percent(&initial, &flights).iter().zip(reference) {
            assert!((error - expected).abs() < 1e-5, "{name}: {error} {expected}");
        }
    }
}

/// Our goal: unseen flights within ±0.4 % in the mean and 0.85 % in the spread, on each fleet, with the defaults.
#[test]
fn ten_flights_teach_the_other_flights_mean_and_spread() {
    let initial = initial_table();
    for name in ["SIM-01", "SIM-02", "SIM-05"] {
        let (flights, _) = fleet(name);
        let (learnt, unseen) = flights.split_at(10);
        let posterior = solved(&initial, learnt);
        let before = mean_and_std(&errors_percent(&initial, unseen));
        let after = mean_and_std(&errors_percent(posterior.drag(), unseen));
        eprintln!(
            "{name}: before {:.2}/{:.2} after {:.2}/{:.2} %",
            before.0, before.1, after.0, after.1
        );
        assert!(after.0.abs() <= 0.4, "{name}: {after:?}");
        assert!(after.1 <= 0.85, "{name}: {after:?}");
        assert_eq!(posterior.guard(), None);
    }
}

/// Forty flights of a simulator with six degrees of freedom are not a draw from the prior, but their spread must stay
/// inside the stated one.
#[test]
fn stated_intervals_hold_on_fleets_that_are_not_in_the_model_class() {
    let initial = initial_table();
    for name in ["SIM-01", "SIM-02", "SIM-05"] {
        let (flights, _) = fleet(name);
        let (learnt, unseen) = flights.split_at(10);
        let posterior = solved(&initial, learnt);
        let mut inside = 0;
        let mut all = 0;
        for observation in unseen.iter().flatten() {
            let at = (observation.lift_coefficient, observation.mach);
            let cell = initial.grid().locate(at.0, at.1, Outside::Error).unwrap();
            let residual = observation.drag_coefficient / initial.interpolate(&cell) - 1.0;
            let std = posterior.segment_variance(&cell, &SENSORS).sqrt();
            let miss = residual - posterior.correction_at(&cell);
            all += 1;
            inside += i32::from(miss.abs() <= 1.96 * std);
        }
        let share = f64::from(inside) / f64::from(all);
        eprintln!("{name}: {:.1} % of unseen segments inside 95 %", 100.0 * share);
        assert!(share >= 0.92, "{name}: {share}");
    }
}

/// A run that stops after ten flights, is written and read, and continues, gives the same bits as one run.
#[test]
fn going_on_from_a_file_changes_no_bit() {
    let initial = initial_table();
    let (flights, _) = fleet("SIM-01");
    let settings = BayesSettings::physical_2026();
    let mut whole = BayesState::new(&initial, settings).unwrap();
    let mut first = BayesState::new(&initial, settings).unwrap();
    for (k, flight) in flights.iter().enumerate() {
        if k == 10 {
            let text = ron::to_string(&first.to_data()).unwrap();
            first =
                BayesState::from_data(&initial, settings, ron::from_str(&text).unwrap()).unwrap();
        }
        assert_eq!(whole.learn_flight(flight), first.learn_flight(flight));
    }
    assert_eq!(whole.to_data(), first.to_data());
    let bits = |state: &BayesState| -> Vec<u64> {
        state.solve().unwrap().drag().values().iter().map(|value| value.to_bits()).collect()
    };
    assert_eq!(bits(&whole), bits(&first));
}

/// Two hundred flights more over the same region make no larger state.
#[test]
fn the_state_grows_with_the_region_not_with_flights() {
    let initial = initial_table();
    let (flights, _) = fleet("SIM-01");
    let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
    let mut sizes = Vec::new();
    for _ in 0..6 {
        for flight in &flights {
            let _ = state.learn_flight(flight);
        }
        let numbers: usize = state.to_data().information.iter().map(Vec::len).sum();
        sizes.push((state.touched_nodes(), numbers));
    }
    eprintln!("touched nodes and numbers: {:?}", sizes[0]);
    assert!(sizes.windows(2).all(|pair| pair[0] == pair[1]), "{sizes:?}");
}
