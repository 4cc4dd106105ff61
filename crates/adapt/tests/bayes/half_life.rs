//! Whether knowledge ages, from the flights themselves.

use adapt::bayes::{
    BayesSettings, SettingValues, log_evidence, log_predictive_density, search_half_life,
};
use flight::Timestamp;

use crate::fleet::{Fleet, Flights, SENSOR_NOISE, believed_drag, grid, table, times};

/// Flights ten days apart of an aircraft that ages by this much per year.
fn flights(seed: u64, count: usize, growth_a_year: f64) -> (lut::Table, Flights) {
    let initial = table(&grid(0.05, 0.95), believed_drag);
    let mut flights = Fleet::new(seed).flights(count, SENSOR_NOISE, times(&initial, 1.0));
    for (k, observation) in flights
        .iter_mut()
        .enumerate()
        .flat_map(|(k, flight)| flight.iter_mut().map(move |o| (k, o)))
    {
        let days = 10.0 * k as f64;
        observation.drag_coefficient *= 1.0 + growth_a_year * days / 365.25;
        let second = observation.time.as_second() + 9 * 86_400 * i64::try_from(k).unwrap();
        observation.time = Timestamp::from_second(second).unwrap();
    }
    (initial, flights)
}

/// The chain rule is the oracle: densities of each flight given those before multiply to the density of all, which
/// `log_evidence` computes from two determinants. With a million degrees of freedom Student's is the normal density.
#[test]
fn densities_of_flights_multiply_to_the_evidence() {
    let (initial, flights) = flights(940, 12, 0.0);
    let values = SettingValues {
        student_degrees_of_freedom: 1e6,
        ..*BayesSettings::physical_2026().values()
    };
    let settings = BayesSettings::new(values).unwrap();
    let observations = flights.iter().flatten().count() as f64;
    let constant = 0.5 * observations * std::f64::consts::TAU.ln();
    let by_flight = log_predictive_density(&initial, settings, &flights).unwrap() - constant;
    let at_once = log_evidence(&initial, settings, &flights).unwrap();
    assert!((by_flight - at_once).abs() < 0.02, "{by_flight} {at_once}");
}

#[test]
fn an_aircraft_that_ages_gets_a_half_life_and_one_that_does_not_gets_none() {
    let settings = BayesSettings::physical_2026();
    for (seed, growth_a_year) in [(941, 0.02), (942, 0.0), (943, 0.0)] {
        let (initial, flights) = flights(seed, 60, growth_a_year);
        let found = search_half_life(&initial, settings, &flights).unwrap();
        eprintln!(
            "{growth_a_year} a year: {:?} {:?}",
            found.settings.values().half_life_days,
            found.tried
        );
        assert_eq!(found.tried[0].0, None);
        assert_eq!(found.settings.values().half_life_days.is_some(), growth_a_year > 0.0);
        // All else stays.
        let values = SettingValues { half_life_days: None, ..*found.settings.values() };
        assert_eq!(values, *settings.values());
    }
}
