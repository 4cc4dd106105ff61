//! Gross outliers: two segments of a hundred, 10 % off; and a flight with a wrong load sheet.

use adapt::bayes::{BayesSettings, BayesState, ObservationUpdate};
use lut::Outside;

use crate::fleet::{Fleet, Flights, SENSOR_NOISE, believed_drag, grid, solved, table, times};
use crate::golden;

/// The largest change of a prediction in the flown region, % of drag.
fn largest_change(initial: &lut::Table, clean: &Flights, soiled: &Flights) -> f64 {
    let (clean_posterior, soiled_posterior) = (solved(initial, clean), solved(initial, soiled));
    clean
        .iter()
        .flatten()
        .map(|segment| {
            let at = (segment.lift_coefficient, segment.mach);
            let cell = initial.grid().locate(at.0, at.1, Outside::Error).unwrap();
            let after = soiled_posterior.drag().interpolate(&cell);
            100.0 * (after / clean_posterior.drag().interpolate(&cell) - 1.0).abs()
        })
        .fold(0.0, f64::max)
}

/// Every fiftieth segment reads 10 % high.
fn soiled(clean: &Flights, first: usize) -> Flights {
    let mut flights = clean.clone();
    for segment in flights.iter_mut().flatten().skip(first).step_by(50) {
        segment.drag_coefficient *= 1.10;
        segment.fuel_flow_total_kg_s *= 1.10;
    }
    flights
}

#[test]
fn two_per_cent_of_gross_outliers_hardly_change_predictions() {
    let grid = grid(0.05, 0.95);
    let initial = table(&grid, believed_drag);
    let truth = times(&initial, 1.04);
    let mut worst: f64 = 0.0;
    for seed in 0..8 {
        let clean = Fleet::new(700 + seed).flights(40, SENSOR_NOISE, &truth);
        let first = 7 * usize::try_from(seed).unwrap() % 50;
        worst = worst.max(largest_change(&initial, &clean, &soiled(&clean, first)));
    }
    eprintln!("virtual fleets, 2 % outliers of 10 %: {worst:.3} % at worst");
    assert!(worst < 0.2, "{worst}");
}

#[test]
fn two_per_cent_of_gross_outliers_hardly_change_golden_fleets() {
    let initial = golden::initial_table();
    for name in ["SIM-01", "SIM-02", "SIM-05"] {
        let (clean, _) = golden::fleet(name);
        let changes =
            [5, 17, 29, 41].map(|first| largest_change(&initial, &clean, &soiled(&clean, first)));
        eprintln!("{name}, 2 % outliers of 10 %: {changes:.3?} %");
        assert!(changes.iter().all(|change| *change < 0.2), "{name}: {changes:?}");
    }
}

#[test]
fn outliers_and_only_outliers_are_named() {
    let grid = grid(0.05, 0.95);
    let initial = table(&grid, believed_drag);
    let truth = times(&initial, 1.04);
    let clean = Fleet::new(720).flights(40, SENSOR_NOISE, &truth);
    let flights = soiled(&clean, 30);
    let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
    let (mut found, mut wrong) = (0, 0);
    for (flight, before) in flights.iter().zip(&clean) {
        let update = state.learn_flight(flight);
        for ((observation, segment), original) in update.observations.iter().zip(flight).zip(before)
        {
            let ObservationUpdate::Learnt { weight, .. } = observation else { panic!() };
            let light = *weight < 0.1;
            if segment == original {
                wrong += usize::from(light);
            } else {
                found += usize::from(light);
            }
        }
    }
    let planted = flights.iter().flatten().skip(30).step_by(50).count();
    assert_eq!((found, wrong), (planted, 0));
}

/// A whole flight 10 % off (a wrong load sheet) gets a low weight as a flight.
#[test]
fn a_wrong_load_sheet_is_one_flight_s_matter() {
    let grid = grid(0.05, 0.95);
    let initial = table(&grid, believed_drag);
    let clean = Fleet::new(730).flights(30, SENSOR_NOISE, times(&initial, 1.0));
    let mut flights = clean.clone();
    for segment in &mut flights[20] {
        segment.drag_coefficient *= 1.10;
    }
    let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
    let weights: Vec<f64> =
        flights.iter().map(|flight| state.learn_flight(flight).flight_weight.unwrap()).collect();
    assert!(weights[20] < 0.3, "{weights:?}");
    assert!(weights.iter().enumerate().all(|(k, weight)| k == 20 || *weight > 0.5), "{weights:?}");
    assert!(largest_change(&initial, &clean, &flights) < 0.2);
}
