//! The track of hand-made reports. Every expected number is computed by hand in the comment next to it.

#![expect(clippy::unwrap_used, reason = "helpers of tests; clippy.toml covers test functions only")]

use flight::column::Column;
use flight::{
    Assumption, DroppedRun, DroppedRunReason, FuelFlowColumns, OptionalColumns, Report,
    ReportColumns, ReportHeader, Sampling, TemperatureSource, Track,
};
use proptest::prelude::*;
use track::{TrackError, derive};
use units::Mass;

fn header() -> ReportHeader {
    ReportHeader {
        zero_fuel_mass: Mass::kilograms(11_000.0),
        fuel_on_board: Mass::kilograms(3_000.0),
        ..test_support::reports::header()
    }
}

/// A steady cruise at these times.
fn columns(time_s: Vec<f64>) -> ReportColumns {
    let samples = time_s.len();
    let of = |value: f64| vec![value; samples];
    ReportColumns {
        fuel_used_kg: of(600.0),
        time_s,
        pressure_altitude_m: of(12_000.0),
        static_air_temperature_k: Some(of(217.0)),
        mach: of(0.80),
        true_airspeed_m_s: of(236.0),
        ground_speed_m_s: of(230.0),
        roll_deg: Some(of(0.2)),
        drift_deg: Some(of(2.0)),
        n2_percent: Some(vec![of(89.4), of(89.6)]),
        fuel_flow: FuelFlowColumns::PerEngine(vec![of(0.083), of(0.084)]),
        optional: OptionalColumns::default(),
    }
}

fn every(step_s: f64, samples: u32) -> Vec<f64> {
    (0..samples).map(|sample| step_s * f64::from(sample)).collect()
}

fn track(columns: ReportColumns) -> Track {
    derive(Report::new(header(), columns).unwrap()).unwrap()
}

fn refusal(columns: ReportColumns) -> TrackError {
    derive(Report::new(header(), columns).unwrap()).unwrap_err()
}

fn close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found_value, expected) in found.iter().zip(expected) {
        assert!((found_value - expected).abs() < 1e-9, "{found:?}");
    }
}

#[test]
fn each_averaged_point_is_a_run_of_its_own() {
    let report = Report::new(header(), columns(every(600.0, 4))).unwrap();
    let track = track::of_averaged_points(report, 60.0).unwrap();
    let samples: Vec<_> = track.runs().iter().map(|run| run.samples.clone()).collect();
    assert_eq!(samples, [0..1, 1..2, 2..3, 3..4]);
    close(&[track.sample_interval_s()], &[60.0]);
}

#[test]
fn one_minute_recordings_stay_as_sent() {
    let mut sent = columns(every(60.0, 4));
    // 230, 230.6, 231.8, 234.2 m/s: rates 0.01, 0.02, 0.04, and −2/3·0.01 + 1/3·0.02 + 4/3·0.04 = 4/75.
    sent.ground_speed_m_s = vec![230.0, 230.6, 231.8, 234.2];
    // Rates 0.1, 0.2, 0.3 m/s, extrapolated 0.4.
    sent.pressure_altitude_m = vec![12_000.0, 12_006.0, 12_018.0, 12_036.0];
    sent.fuel_used_kg = vec![600.0, 610.5, 621.0, 631.5];
    let report = Report::new(header(), sent).unwrap();
    let track = derive(report.clone()).unwrap();
    assert_eq!(track.report(), &report, "the report is never overwritten");
    assert_eq!(track.sampling(), Sampling::AsSent);
    close(&[track.sample_interval_s()], &[60.0]);
    close(track.mass_kg(), &[13_400.0, 13_389.5, 13_379.0, 13_368.5]);
    assert_eq!(track.runs().len(), 1);
    close(&track.runs()[0].acceleration_m_s2, &[0.01, 0.02, 0.04, 4.0 / 75.0]);
    close(&track.runs()[0].vertical_speed_m_s, &[0.1, 0.2, 0.3, 0.4]);
    assert_eq!(track.temperature_source(), TemperatureSource::Recorded);
}

#[test]
fn gaps_split_runs_and_short_runs_say_why() {
    // Steps: 60 60 | 91 60 | 150 60 90 60: the first run has 3 samples, the second 2, the third 4.
    let time_s = vec![0.0, 60.0, 120.0, 211.0, 271.0, 421.0, 481.0, 571.0, 631.0];
    let mut sent = columns(time_s);
    // The jump across the gap must not enter a rate: 1 m/s a step within runs, 100 m/s across.
    sent.ground_speed_m_s = vec![100.0, 101.0, 102.0, 200.0, 201.0, 300.0, 301.0, 302.0, 303.0];
    let track = track(sent);
    let samples: Vec<_> = track.runs().iter().map(|run| run.samples.clone()).collect();
    assert_eq!(samples, [0..3, 5..9]);
    let reason = DroppedRunReason::FewerThanThreeSamples;
    assert_eq!(track.dropped_runs(), [DroppedRun { samples: 3..5, reason }]);
    close(&track.runs()[0].acceleration_m_s2, &[1.0 / 60.0; 3]);
    // Rates 1/60, 1/90, 1/60 at t = 0, 60, 150 of the run: t̄ = 70, Σ(t−t̄)² = 4900 + 100 + 6400 = 11400,
    // r̄ = 2/135, Σ(t−t̄)(r−r̄) = (−70 + 80)/540 + 10·2/540 = 30/540 = 1/18, at t = 210: 2/135 + 140/18/11400.
    let last = 2.0 / 135.0 + 140.0 / 18.0 / 11_400.0;
    close(&track.runs()[1].acceleration_m_s2, &[1.0 / 60.0, 1.0 / 90.0, 1.0 / 60.0, last]);
}

#[test]
fn slow_recordings_up_to_ninety_seconds() {
    close(&[track(columns(every(75.0, 5))).sample_interval_s()], &[75.0]);
    close(&[track(columns(every(90.0, 5))).sample_interval_s()], &[90.0]);
    let refused = refusal(columns(every(91.0, 5)));
    assert_eq!(refused, TrackError::SamplesTooFarApart { sample_interval_s: 91.0 });
}

#[test]
fn a_missing_temperature_needs_an_assumption() {
    let mut sent = columns(every(60.0, 3));
    sent.static_air_temperature_k = None;
    let refused = refusal(sent.clone());
    assert_eq!(refused, TrackError::StaticAirTemperatureMissing);
    assert!(refused.to_string().contains("'ASSUMED SAT=ISA+0'"), "{refused}");

    let mut header = header();
    header.assumed = vec![
        Assumption::Other { key: "N2".to_owned(), value: "?".to_owned() },
        Assumption::StaticAirTemperatureIsa { isa_deviation_k: 3.0 },
    ];
    // ISO 2533: 216.65 K at 12 000 m, 255.65 K at 5 000 m.
    sent.pressure_altitude_m = vec![12_000.0, 12_000.0, 5_000.0];
    let track = derive(Report::new(header.clone(), sent.clone()).unwrap()).unwrap();
    close(track.static_air_temperature_k(), &[219.65, 219.65, 258.65]);
    let source = TemperatureSource::AssumedIsa { isa_deviation_k: 3.0 };
    assert_eq!(track.temperature_source(), source);
    assert_eq!(track.report().columns().static_air_temperature_k, None);

    sent.pressure_altitude_m[1] = 50_000.0;
    let refused = derive(Report::new(header.clone(), sent.clone()).unwrap()).unwrap_err();
    assert!(
        matches!(refused, TrackError::AssumedTemperatureUndefined { sample: 1, .. }),
        "{refused}"
    );

    // A recording takes precedence over an assumption.
    sent.static_air_temperature_k = Some(vec![220.0; 3]);
    let track = derive(Report::new(header, sent).unwrap()).unwrap();
    assert_eq!(track.temperature_source(), TemperatureSource::Recorded);
}

/// 220 s at 1 Hz: bins of seconds 0–59, 60–119, 120–179 and 180–219 (40 of 60 samples: complete enough).
fn one_hertz() -> ReportColumns {
    let mut sent = columns(every(1.0, 220));
    let of = |value: &dyn Fn(f64) -> f64| sent.time_s.iter().map(|t| value(*t)).collect();
    sent.ground_speed_m_s = of(&|t| 230.0 + 0.01 * t);
    sent.fuel_used_kg = of(&|t| 600.0 + 0.2 * t);
    sent.roll_deg = Some(of(&|t| if t % 2.0 < 0.5 { 3.0 } else { -2.0 }));
    sent.fuel_flow = FuelFlowColumns::PerEngine(vec![of(&|_| 0.1), of(&|t| 0.1 + 0.001 * t)]);
    // North: second t of each pair at 350° and 20°.
    let pairs = |low: f64, high: f64| -> Vec<Option<f64>> {
        (0..220).map(|t| Some(if t % 2 == 0 { low } else { high })).collect()
    };
    sent.optional.insert(Column::TrueHeading, pairs(350.0, 20.0));
    sent.optional.insert(Column::Longitude, pairs(179.0, -177.0));
    // On during the first 15 s; unknown in the third bin; one value in the last.
    sent.optional.insert(
        Column::AntiIce,
        (0..220)
            .map(|t| match t {
                0..15 | 219 => Some(1.0),
                15..120 => Some(0.0),
                _ => None,
            })
            .collect(),
    );
    sent
}

#[test]
fn one_hertz_is_averaged_to_minutes() {
    let track = track(one_hertz());
    let sampling = Sampling::AveragedToBins {
        bin_s: 60.0,
        recorded_interval_s: 1.0,
        incomplete_bins: 0,
        incomplete_bins_s: 0.0,
    };
    assert_eq!(track.sampling(), sampling);
    close(&[track.sample_interval_s()], &[60.0]);
    let columns = track.report().columns();
    // Means of 0…59, 60…119, 120…179, 180…219.
    close(&columns.time_s, &[29.5, 89.5, 149.5, 199.5]);
    close(&columns.ground_speed_m_s, &[230.295, 230.895, 231.495, 231.995]);
    close(&columns.fuel_used_kg, &[605.9, 617.9, 629.9, 639.9]);
    close(track.mass_kg(), &[13_394.1, 13_382.1, 13_370.1, 13_360.1]);
    close(columns.roll_deg.as_ref().unwrap(), &[0.5; 4]);
    let FuelFlowColumns::PerEngine(flows) = &columns.fuel_flow else { panic!("two engines") };
    close(&flows[0], &[0.1; 4]);
    close(&flows[1], &[0.1295, 0.1895, 0.2495, 0.2995]);
    // A ramp of 0.01 m/s a second stays one, although the last step is 50 s.
    assert_eq!(track.runs().len(), 1);
    close(&track.runs()[0].acceleration_m_s2, &[0.01; 4]);
    let all = |column: Column| -> Vec<f64> {
        columns.optional.get(column).unwrap().iter().map(|value| value.unwrap()).collect()
    };
    close(&all(Column::TrueHeading), &[5.0; 4]);
    close(&all(Column::Longitude), &[-179.0; 4]);
    let anti_ice = columns.optional.get(Column::AntiIce).unwrap();
    assert_eq!(*anti_ice, [Some(0.25), Some(0.0), None, Some(1.0)]);
}

/// Oracle: the derivative of V = 230 + 3 sin ωt, one turn an hour, at the mean time of each bin. Differences over two steps of
/// 60 s are within (ωh)²/6 = 0.2 % of the largest acceleration, the lines at both ends within 0.8 (ωh)² = 0.9 %; forward
/// differences lie 30 s late, 2 sin(½ ωh) = 5 %.
#[test]
fn acceleration_of_a_bin_is_that_of_its_own_minute() {
    let turn_s = 3600.0;
    let omega = core::f64::consts::TAU / turn_s;
    let mut sent = columns(every(1.0, 5400));
    let speed = |t: &f64| 230.0 + 3.0 * (omega * t).sin();
    sent.ground_speed_m_s = sent.time_s.iter().map(speed).collect();
    let altitude = |t: &f64| 12_000.0 + 3.0 * (omega * t).sin();
    sent.pressure_altitude_m = sent.time_s.iter().map(altitude).collect();
    let track = track(sent);
    let time_s = &track.report().columns().time_s;
    let run = &track.runs()[0];
    let largest = 3.0 * omega;
    let worst = |rates: &[f64], late_s: f64| {
        let errors = time_s.iter().zip(rates);
        let errors = errors.map(|(t, rate)| rate - largest * (omega * (t + late_s)).cos());
        errors.fold(0.0_f64, |worst, error| worst.max(error.abs())) / largest
    };
    let found = worst(&run.acceleration_m_s2, 0.0);
    assert!(found < 0.01, "{found}");
    // Vertical speed, of which the same sine is made, stays the forward difference: half a step late.
    let of_climb = worst(&run.vertical_speed_m_s, 0.0);
    assert!((0.04..0.06).contains(&of_climb), "{of_climb}");
    assert!(worst(&run.vertical_speed_m_s[..89], 30.0) < 0.01);
}

#[test]
fn incomplete_bins_are_dropped_and_counted() {
    // 200 s: the last bin holds 20 of 60 samples.
    let track = track(columns(every(1.0, 200)));
    close(&track.report().columns().time_s, &[29.5, 89.5, 149.5]);
    assert!(matches!(track.sampling(), Sampling::AveragedToBins { incomplete_bins: 1, .. }));

    // Half of the samples is enough: 210 s leave 30 of 60.
    assert_eq!(self::track(columns(every(1.0, 210))).report().len(), 4);

    // Two bins are not enough for a track.
    let refused = refusal(columns(every(1.0, 149)));
    assert_eq!(refused, TrackError::TooFewBins { bins: 2, incomplete_bins: 1 });
}

#[test]
fn a_lost_second_costs_one_sample_and_a_hole_begins_anew() {
    // Second 70 is lost: the bin's mean time is (60 + … + 119 − 70)/59 = (5370 − 70)/59.
    let mut time_s = every(1.0, 240);
    time_s.remove(70);
    let lost = track(columns(time_s));
    assert_eq!(lost.runs().len(), 1);
    close(&lost.report().columns().time_s, &[29.5, 5300.0 / 59.0, 149.5, 209.5]);

    // Three minutes, then 31 s of silence, then three minutes: bins start again at 211 s.
    let time_s = (0..180).chain(211..391).map(f64::from).collect();
    let hole = track(columns(time_s));
    close(&hole.report().columns().time_s, &[29.5, 89.5, 149.5, 240.5, 300.5, 360.5]);
    let samples: Vec<_> = hole.runs().iter().map(|run| run.samples.clone()).collect();
    assert_eq!(samples, [0..3, 3..6]);

    // 30 s of silence are bridged: bin 180–239 has only 209–239, 31 samples of 60.
    let time_s = (0..180).chain(209..391).map(f64::from).collect();
    assert_eq!(track(columns(time_s)).runs().len(), 1);

    // Twice silent for 25 and 15 s within one minute: 10 + 10 of 60 samples, and the dropped bin ends the run.
    let time_s = (0..190).chain(215..225).chain(240..420).map(f64::from).collect();
    let patchy = track(columns(time_s));
    assert!(matches!(patchy.sampling(), Sampling::AveragedToBins { incomplete_bins: 1, .. }));
    let samples: Vec<_> = patchy.runs().iter().map(|run| run.samples.clone()).collect();
    assert_eq!(samples, [0..3, 3..6]);
}

#[test]
fn thirty_and_forty_five_seconds_are_averaged_too() {
    let half = track(columns(every(30.0, 8)));
    close(&half.report().columns().time_s, &[15.0, 75.0, 135.0, 195.0]);

    // 0 45 | 90 | 135 | 180 225 | 270 | 315: bins of unequal count, each representing 60 s, in one run.
    let uneven = track(columns(every(45.0, 8)));
    close(&uneven.report().columns().time_s, &[22.5, 90.0, 135.0, 202.5, 270.0, 315.0]);
    close(&[uneven.sample_interval_s()], &[60.0]);
    assert_eq!(uneven.runs().len(), 1);

    // Whole seconds resolve a step to ±1 s: 59 s is a one-minute recording, 58 s is not.
    assert_eq!(track(columns(every(59.0, 5))).sampling(), Sampling::AsSent);
    assert_ne!(track(columns(every(58.0, 5))).sampling(), Sampling::AsSent);
}

proptest! {
    #[test]
    fn samples_are_in_one_run_or_one_dropped_run(steps in prop::collection::vec(1_u32..200, 2..60)) {
        let mut time_s = vec![0.0];
        for step in steps {
            time_s.push(time_s.last().unwrap() + f64::from(step));
        }
        let report = Report::new(header(), columns(time_s)).unwrap();
        if let Ok(track) = derive(report) {
            let mut covered: Vec<_> = track.runs().iter().map(|run| run.samples.clone())
                .chain(track.dropped_runs().iter().map(|run| run.samples.clone()))
                .collect();
            covered.sort_by_key(|samples| samples.start);
            let mut end = 0;
            for samples in covered {
                prop_assert_eq!(samples.start, end);
                end = samples.end;
            }
            prop_assert_eq!(end, track.report().len());
        }
    }

    #[test]
    fn shifting_time_changes_times_only(shift in -100_000_i32..100_000, step in 1_u32..91) {
        let shift_s = f64::from(shift);
        let at = |shift_s: f64| {
            let mut sent = columns(every(f64::from(step), 300));
            sent.ground_speed_m_s = sent.time_s.iter().map(|t| 230.0 + (t / 700.0).sin()).collect();
            for time_s in &mut sent.time_s {
                *time_s += shift_s;
            }
            track(sent)
        };
        let (here, there) = (at(0.0), at(shift_s));
        prop_assert_eq!(here.sampling(), there.sampling());
        prop_assert_eq!(here.report().len(), there.report().len());
        prop_assert_eq!(here.runs().len(), there.runs().len());
        for (here_s, there_s) in
            here.report().columns().time_s.iter().zip(&there.report().columns().time_s)
        {
            prop_assert!((here_s + shift_s - there_s).abs() < 1e-9);
        }
        for (here, there) in here.runs().iter().zip(there.runs()) {
            for (a, b) in here.acceleration_m_s2.iter().zip(&there.acceleration_m_s2) {
                prop_assert!((a - b).abs() < 1e-12);
            }
        }
    }
}
