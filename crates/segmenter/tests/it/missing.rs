//! Channels that were not recorded: their criterion is not evaluated, and nothing else changes.

use flight::{Assumption, FuelFlowColumns, Report};
use segmenter::{Criterion, Tally, TrimCriteria, segment};
use test_support::reports::{header, steady};

use crate::support::{all, rows, segmented};

#[test]
fn a_missing_channel_is_not_evaluated() {
    // Each channel is wild after sample 5; without it the flight is steady.
    let mut wild = steady(60.0, 10);
    wild.n2_percent.as_mut().unwrap()[0][6] = 70.0;
    wild.roll_deg.as_mut().unwrap()[6] = 30.0;
    wild.drift_deg.as_mut().unwrap()[6] = 20.0;
    let (_, segmentation) = segmented(wild.clone());
    assert!(segmentation.not_evaluated().is_empty());
    assert_eq!(segmentation.tally.samples_unsteady, 3);

    wild.n2_percent = None;
    wild.roll_deg = None;
    wild.drift_deg = None;
    let (_, segmentation) = segmented(wild);
    let expected = [Criterion::N2, Criterion::Drift, Criterion::Roll].into_iter().collect();
    assert_eq!(segmentation.not_evaluated(), expected);
    assert_eq!(rows(&segmentation), [all(0..10)]);
    let means = &segmentation.segments[0].means;
    assert_eq!((means.roll_deg, means.roll_squared_deg2, means.drift_deg), (None, None, None));
    assert!(means.n2_percent.is_empty());
    assert!(segmentation.tally.to_string().ends_with("; not evaluated: N2, DRIFT, ROLL"));
}

#[test]
fn an_assumed_temperature_is_not_evaluated() {
    let mut sent = steady(60.0, 10);
    sent.static_air_temperature_k = None;
    let mut header = header();
    header.assumed = vec![Assumption::StaticAirTemperatureIsa { isa_deviation_k: -2.0 }];
    let track = track::derive(Report::new(header, sent).unwrap()).unwrap();
    let segmentation = segment(&track, &TrimCriteria::ghazi_2020_table_4());
    let expected = [Criterion::StaticAirTemperature].into_iter().collect();
    assert_eq!(segmentation.not_evaluated(), expected);
    assert!(segmentation.segments[0].temperature_assumed);
    // ISO 2533: 216.65 K at 43 000 ft.
    let found_k = segmentation.segments[0].means.static_air_temperature_k;
    assert!((found_k - 214.65).abs() < 1e-9, "{found_k}");
}

#[test]
fn total_fuel_flow_alone() {
    let mut sent = steady(60.0, 4);
    sent.fuel_flow = FuelFlowColumns::Total(vec![0.16, 0.17, 0.18, 0.19]);
    let (_, segmentation) = segmented(sent);
    let means = &segmentation.segments[0].means;
    assert!((means.fuel_flow_total_kg_s - 0.175).abs() < 1e-12);
    assert!(means.fuel_flow_engine_kg_s.is_empty());
    assert!(!segmentation.segments[0].temperature_assumed);
}

#[test]
fn tallies_of_flights_add_up() {
    let mut without_roll = steady(60.0, 11);
    without_roll.roll_deg = None;
    without_roll.mach[5] += 0.0031;
    let mut sum = Tally::NOTHING;
    sum += segmented(without_roll).1.tally;
    sum += segmented(steady(60.0, 16)).1.tally;
    assert_eq!((sum.flights, sum.samples, sum.segments), (2, 27, 4));
    // Mach of sample 5 rejects 4, 5 and 6: pieces 0…3 and 7…10.
    assert_eq!(
        sum.to_string(),
        "27 samples of 2 flights: 24 kept in 4 segments; 3 unsteady (MACH 3, 3 alone); \
         0 filtered out; 0 in dropped pieces; not evaluated: ROLL in 1 flight"
    );
}
