//! Steps 2 to 4 by hand: cutting, the 2σ filter, what is too short, and the means.

use flight::FuelFlowColumns;
use flight::column::Column;
use segmenter::{Criterion, DroppedPiece, PieceDropReason, SampleVerdict};
use test_support::reports::{header, steady};
use units::convert::{METERS_PER_FOOT, METERS_PER_SECOND_PER_KNOT};

use crate::support::{all, rows, segmented};

#[test]
fn sixteen_samples_make_ten_and_six() {
    let (_, segmentation) = segmented(steady(60.0, 16));
    assert_eq!(rows(&segmentation), [all(0..10), all(10..16)]);
    assert_eq!(segmentation.dropped_pieces, []);
}

#[test]
fn eleven_samples_make_ten_and_one_is_dropped() {
    let (_, segmentation) = segmented(steady(60.0, 11));
    assert_eq!(rows(&segmentation), [all(0..10)]);
    let reason = PieceDropReason::OneSample;
    let expected = DroppedPiece { samples: 10..11, kept: 1, needed: 3, reason };
    assert_eq!(segmentation.dropped_pieces, [expected]);
    assert_eq!(segmentation.verdicts[10], SampleVerdict::InDroppedPiece(reason));
    assert_eq!(segmentation.dropped_pieces[0].to_string(), "sample 10 alone has no spread");
    assert_eq!(segmentation.tally.pieces_of_one_sample, 1);
}

#[test]
fn twelve_samples_make_ten_and_two_are_too_few() {
    let (_, segmentation) = segmented(steady(60.0, 12));
    assert_eq!(rows(&segmentation), [all(0..10)]);
    let reason = PieceDropReason::TooShort;
    let expected = DroppedPiece { samples: 10..12, kept: 2, needed: 3, reason };
    assert_eq!(segmentation.dropped_pieces, [expected]);
    assert_eq!(
        segmentation.dropped_pieces[0].to_string(),
        "samples 10 to 11: 2 steady, 2 left by the filter, 3 needed"
    );
    assert_eq!(segmentation.tally.samples_in_dropped_pieces, 2);
}

#[test]
fn other_intervals_count_in_minutes() {
    // 75 s: pieces of ⌊600/75⌋ = 8, at least ⌈180/75⌉ = 3; 17 samples make 8 + 8 and one dropped.
    let (_, segmentation) = segmented(steady(75.0, 17));
    assert_eq!(rows(&segmentation), [all(0..8), all(8..16)]);
    // 90 s: pieces of ⌊600/90⌋ = 6, at least ⌈180/90⌉ = 2; 8 samples make 6 + 2.
    let (_, segmentation) = segmented(steady(90.0, 8));
    assert_eq!(rows(&segmentation), [all(0..6), all(6..8)]);
    // 30 s: averaged by the track to minutes; 40 samples make 20 bins, 10 + 10.
    let (track, segmentation) = segmented(steady(30.0, 40));
    assert_eq!(track.report().len(), 20);
    assert_eq!(rows(&segmentation), [all(0..10), all(10..20)]);
    // 45 s: ⌈40·45/60⌉ = 30 bins of one or two samples.
    let (_, segmentation) = segmented(steady(45.0, 40));
    assert_eq!(rows(&segmentation), [all(0..10), all(10..20), all(20..30)]);
    // 1 Hz: 25 minutes make 10 + 10 + 5.
    let (_, segmentation) = segmented(steady(1.0, 1500));
    assert_eq!(rows(&segmentation), [all(0..10), all(10..20), all(20..25)]);
}

#[test]
fn constant_channels_survive_the_filter() {
    // 0.1 ft, 0.1 m/s and 1/3 %: constants whose binary mean need not be the constant.
    for samples in 3..11 {
        let mut sent = steady(60.0, samples);
        sent.pressure_altitude_m = vec![43_000.1 * METERS_PER_FOOT; samples];
        sent.ground_speed_m_s = vec![231.1; samples];
        sent.n2_percent = Some(vec![vec![266.0 / 3.0; samples], vec![87.7; samples]]);
        let (_, segmentation) = segmented(sent);
        assert_eq!(segmentation.tally.samples_outlying, 0);
        assert_eq!(segmentation.segments.len(), 1);
    }
}

#[test]
fn one_of_ten_beyond_two_deviations() {
    // Nine samples at one value, one 0.9 kt off: |x − μ|/σ = (n − 1)/√n = 9/√10 = 2.846 > 2. At both sides ground
    // speed changes by 0.9 kt only: steady. Acceleration is not a channel.
    let mut sent = steady(60.0, 10);
    sent.ground_speed_m_s[4] += 0.9 * METERS_PER_SECOND_PER_KNOT;
    let (_, segmentation) = segmented(sent);
    let only = [Criterion::GroundSpeed].into_iter().collect();
    assert_eq!(segmentation.verdicts[4], SampleVerdict::Outlier(only));
    assert_eq!(rows(&segmentation), [vec![0, 1, 2, 3, 5, 6, 7, 8, 9]]);
    let cost = segmentation.tally.cost(Criterion::GroundSpeed);
    assert_eq!((cost.outliers, cost.outliers_alone, cost.unsteady), (1, 1, 0));
}

#[test]
fn five_samples_cannot_have_an_outlier_and_six_can() {
    // (n − 1)/√n is 1.789 for five and 2.041 for six.
    for (samples, outliers) in [(5, 0), (6, 1)] {
        let mut sent = steady(60.0, samples);
        sent.mach[2] += 0.002;
        assert_eq!(segmented(sent).1.tally.samples_outlying, outliers);
    }
}

#[test]
fn the_filter_judges_all_channels_on_the_same_piece() {
    // Sample 3 is off in Mach and by 0.9° in drift, sample 7 by 0.5° in drift, the other eight at 0.
    // On all ten: μ = 0.14, squares 8·0.14² + 0.76² + 0.36² = 0.864, σ = √(0.864/9) = 0.3098, 2σ = 0.62: sample 3
    // goes (0.76), sample 7 stays (0.36). Had sample 3 gone for its Mach number first, sample 7 would be one of nine
    // off, 8/3 = 2.67 deviations, and would go as well.
    let mut sent = steady(60.0, 10);
    sent.mach[3] += 0.002;
    let drift_deg = sent.drift_deg.as_mut().unwrap();
    drift_deg[3] -= 0.9;
    drift_deg[7] -= 0.5;
    let (_, segmentation) = segmented(sent);
    let both = [Criterion::Mach, Criterion::Drift].into_iter().collect();
    assert_eq!(segmentation.verdicts[3], SampleVerdict::Outlier(both));
    assert_eq!(rows(&segmentation), [vec![0, 1, 2, 4, 5, 6, 7, 8, 9]]);
    assert_eq!(segmentation.tally.cost(Criterion::Drift).outliers, 1);
    assert_eq!(segmentation.tally.cost(Criterion::Drift).outliers_alone, 0);
}

#[test]
fn each_channel_of_table_four_is_filtered() {
    // One of ten off by less than its limit, |x − μ|/σ = 2.846; vertical speed by a foot more at samples 5 to 9: the
    // step makes 1 ft/min at sample 4 alone.
    type Change = fn(&mut flight::ReportColumns);
    let cases: [(Criterion, Change); 8] = [
        (Criterion::PressureAltitude, |sent| sent.pressure_altitude_m[9] += METERS_PER_FOOT),
        (Criterion::VerticalSpeed, |sent| {
            for pressure_altitude_m in &mut sent.pressure_altitude_m[5..] {
                *pressure_altitude_m += METERS_PER_FOOT;
            }
        }),
        (Criterion::Mach, |sent| sent.mach[4] += 0.001),
        (Criterion::GroundSpeed, |sent| sent.ground_speed_m_s[4] -= 0.1),
        (Criterion::StaticAirTemperature, |sent| {
            sent.static_air_temperature_k.as_mut().unwrap()[4] += 0.1;
        }),
        (Criterion::N2, |sent| sent.n2_percent.as_mut().unwrap()[1][4] -= 0.1),
        (Criterion::Drift, |sent| sent.drift_deg.as_mut().unwrap()[4] += 0.1),
        (Criterion::Roll, |sent| sent.roll_deg.as_mut().unwrap()[4] -= 0.1),
    ];
    for (criterion, change) in cases {
        let mut sent = steady(60.0, 10);
        change(&mut sent);
        let (_, segmentation) = segmented(sent);
        assert_eq!(segmentation.tally.samples_unsteady, 0);
        assert_eq!(segmentation.tally.cost(criterion).outliers, 1, "{criterion}");
    }
}

#[test]
fn two_deviations_exactly_are_kept() {
    // Of n values, one at d and the others at 0: |x − μ| = d(n − 1)/n and σ = d/√n; with k = (n − 1)/√n the sample is
    // on the limit but for rounding. n = 9: k = 8/3.
    let mut criteria = segmenter::TrimCriteria::ghazi_2020_table_4();
    for (k, outliers) in [(8.0 / 3.0, 0), (8.0 / 3.0 - 1e-5, 1)] {
        criteria.outlier_standard_deviations = k;
        let mut sent = steady(60.0, 9);
        sent.mach[4] += 0.002;
        let report = flight::Report::new(header(), sent).unwrap();
        let segmentation = segmenter::segment(&track::derive(report).unwrap(), &criteria);
        assert_eq!(segmentation.tally.samples_outlying, outliers, "{k}");
    }
}

#[test]
fn a_filtered_piece_may_become_too_short() {
    // 15 samples: ten, and five of which a 2σ filter can take none; so shorten by a tighter filter. With k = 1, of
    // 0 0 0 0.002 0.002 (μ 0.0008, σ 0.001095) the two at 0.002 lie 0.0012 off: beyond. Three are left of four needed.
    let mut criteria = segmenter::TrimCriteria::ghazi_2020_table_4();
    criteria.outlier_standard_deviations = 1.0;
    criteria.segment_minimum_s = 240.0;
    let mut sent = steady(60.0, 5);
    sent.mach[3] += 0.002;
    sent.mach[4] += 0.002;
    let report = flight::Report::new(header(), sent).unwrap();
    let segmentation = segmenter::segment(&track::derive(report).unwrap(), &criteria);
    let reason = PieceDropReason::TooShort;
    let expected = DroppedPiece { samples: 0..5, kept: 3, needed: 4, reason };
    assert_eq!(segmentation.dropped_pieces, [expected]);
    assert_eq!(segmentation.tally.samples_outlying, 2);
    assert_eq!(segmentation.tally.samples_in_dropped_pieces, 3);
}

#[test]
fn means_are_over_the_kept_samples() {
    let mut sent = steady(60.0, 10);
    sent.mach[4] += 0.002; // discarded: nothing of sample 4 may enter
    let ramp = |start: f64, step: f64| (0..10).map(|i| start + step * f64::from(i)).collect();
    sent.fuel_flow = FuelFlowColumns::PerEngine(vec![ramp(0.08, 0.001), ramp(0.09, 0.0)]);
    sent.fuel_used_kg = ramp(600.0, 10.0);
    sent.optional
        .insert(Column::TrueHeading, [358.0, 2.0].into_iter().cycle().map(Some).take(10).collect());
    sent.optional.insert(
        Column::Longitude,
        [179.5, -179.5].into_iter().cycle().map(Some).take(10).collect(),
    );
    sent.optional
        .insert(Column::Latitude, (0..10).map(|i| (i != 9).then_some(f64::from(i))).collect());
    sent.optional
        .insert(Column::AntiIce, (0..10).map(|i| Some(if i < 3 { 1.0 } else { 0.0 })).collect());
    sent.optional.insert(Column::CenterOfGravity, vec![None; 10]);
    sent.optional.insert(Column::N1(2), vec![Some(81.5); 10]);
    sent.roll_deg = Some([0.5, -0.3].into_iter().cycle().take(10).collect());
    let (_, segmentation) = segmented(sent);
    assert_eq!(rows(&segmentation), [vec![0, 1, 2, 3, 5, 6, 7, 8, 9]]);
    let means = &segmentation.segments[0].means;
    let close = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    };
    // Σ i over the kept samples is 45 − 4 = 41.
    close(means.time_s, 60.0 * 41.0 / 9.0);
    close(means.fuel_flow_engine_kg_s[0], 0.08 + 0.001 * 41.0 / 9.0);
    close(means.fuel_flow_total_kg_s, 0.17 + 0.001 * 41.0 / 9.0);
    close(means.fuel_used_kg, 600.0 + 10.0 * 41.0 / 9.0);
    close(means.mass_kg, (24_283.0 + 7_219.0) * 0.453_592_37 - means.fuel_used_kg);
    close(means.mach, 0.8025);
    close(means.n2_percent[1], 89.4);
    // Four at 358° (0, 2, 6, 8) and five at 2°: by vectors atan2(sin 2°, 9 cos 2°).
    let tilt_deg = |half_deg: f64| {
        let half = half_deg.to_radians();
        half.sin().atan2(9.0 * half.cos()).to_degrees()
    };
    close(means.true_heading_deg.unwrap(), tilt_deg(2.0));
    close(means.longitude_deg.unwrap(), -180.0 + tilt_deg(0.5));
    // Latitude is missing at sample 9: Σ 0…8 without 4 is 32, over 8 samples.
    close(means.latitude_deg.unwrap(), 4.0);
    close(means.anti_ice.unwrap(), 3.0 / 9.0);
    assert_eq!(means.center_of_gravity_percent_mac, None);
    assert_eq!(means.total_air_temperature_k, None);
    assert_eq!(means.n1_percent, [None, Some(81.5), None, None]);
    // Four at 0.5 and five at −0.3.
    close(means.roll_deg.unwrap(), (4.0 * 0.5 - 5.0 * 0.3) / 9.0);
    close(means.roll_squared_deg2.unwrap(), (4.0 * 0.25 + 5.0 * 0.09) / 9.0);
}

#[test]
fn segments_of_a_flight_share_its_identity() {
    let (track, segmentation) = segmented(steady(60.0, 20));
    let [first, second] = &segmentation.segments[..] else { panic!("two segments") };
    assert!(std::sync::Arc::ptr_eq(&first.identity, &second.identity));
    assert_eq!(*first.identity, track.report().header().identity);
}
