//! Tracks of averaged points: each is a segment by itself, judged by what is stated of its frame.

use flight::{Assumption, Report, ReportColumns, ReportHeader, Track};
use segmenter::{Criterion, Scatter, TrimCriteria, of_points};
use test_support::reports::{header, steady};

/// Frames of five minutes, ten minutes apart.
fn points(header: ReportHeader, columns: ReportColumns) -> Track {
    track::of_averaged_points(Report::of_points(header, columns).unwrap(), 300.0).unwrap()
}

/// By definition: a temperature of the ISA is assumed, one that was sent is not.
#[test]
fn points_know_whether_their_temperature_is_assumed() {
    let criteria = TrimCriteria::ghazi_2020_table_4();
    let recorded = of_points(&points(header(), steady(600.0, 2)), &criteria, &[]);
    assert_eq!(recorded.segments.len(), 2);
    assert!(recorded.segments.iter().all(|segment| !segment.temperature_assumed));

    let mut header = header();
    header.assumed = vec![Assumption::StaticAirTemperatureIsa { isa_deviation_k: -2.0 }];
    let sent = ReportColumns { static_air_temperature_k: None, ..steady(600.0, 2) };
    let assumed = of_points(&points(header, sent), &criteria, &[]);
    assert_eq!(assumed.segments.len(), 2);
    assert!(assumed.segments.iter().all(|segment| segment.temperature_assumed));
}

/// By hand: a scatter of 0.1 m/s, 20 ft/min, is stated for vertical speed at one of two points, and for Mach number at none; every other
/// change is not stated at all. The sizes of drift and roll are those of the means.
#[test]
fn only_the_scatter_that_is_stated_is_evaluated() {
    let track = points(header(), steady(600.0, 2));
    let stated = |criterion, standard_deviations: [f64; 2]| Scatter {
        criterion,
        standard_deviations: standard_deviations.to_vec(),
    };
    let scatter = [
        stated(Criterion::VerticalSpeed, [0.1, f64::NAN]),
        stated(Criterion::Mach, [f64::NAN, f64::NAN]),
    ];
    let found = of_points(&track, &TrimCriteria::ghazi_2020_table_4(), &scatter);
    assert_eq!(found.segments.len(), 2);
    let expected = [
        Criterion::PressureAltitude,
        Criterion::Mach,
        Criterion::GroundSpeed,
        Criterion::StaticAirTemperature,
        Criterion::N2,
    ];
    assert_eq!(found.not_evaluated(), expected.into_iter().collect());
}
