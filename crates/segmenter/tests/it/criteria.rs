//! Step 1 by hand: limits, their equality, neighbors at the ends of a run, engines apart, time gaps.

use flight::ReportColumns;
use segmenter::{Criterion, CriterionSet, SampleVerdict, Segmentation};
use test_support::reports::{header, steady};
use units::convert::{METERS_PER_FOOT, METERS_PER_SECOND_PER_KNOT};

use crate::support::{all, rows, segmented};

/// Samples that fail a criterion, and only that one.
fn failing(segmentation: &Segmentation, criterion: Criterion) -> Vec<usize> {
    let only: CriterionSet = [criterion].into_iter().collect();
    let mut samples = Vec::new();
    for (sample, verdict) in segmentation.verdicts.iter().enumerate() {
        match verdict {
            SampleVerdict::Unsteady(set) if *set == only => samples.push(sample),
            SampleVerdict::Unsteady(set) => panic!("sample {sample} fails {set}"),
            _ => {}
        }
    }
    samples
}

/// Ten samples with a step after the fifth, of the size given to `change` in the limit's own unit.
fn step(change: impl Fn(&mut ReportColumns, usize)) -> Segmentation {
    let mut sent = steady(60.0, 10);
    for sample in 5..10 {
        change(&mut sent, sample);
    }
    segmented(sent).1
}

fn n2(columns: &mut ReportColumns) -> &mut Vec<Vec<f64>> {
    columns.n2_percent.as_mut().unwrap()
}

#[test]
fn a_step_rejects_the_samples_on_both_sides() {
    // 0.0031 Mach, 1.01 kt, 1.01 K, 1.61 % of either engine: just beyond table 4.
    let cases: [(Criterion, Segmentation); 5] = [
        (Criterion::Mach, step(|sent, i| sent.mach[i] += 0.0031)),
        (
            Criterion::GroundSpeed,
            step(|sent, i| sent.ground_speed_m_s[i] += 1.01 * METERS_PER_SECOND_PER_KNOT),
        ),
        (
            Criterion::StaticAirTemperature,
            step(|sent, i| sent.static_air_temperature_k.as_mut().unwrap()[i] -= 1.01),
        ),
        (Criterion::N2, step(|sent, i| n2(sent)[0][i] += 1.61)),
        (Criterion::N2, step(|sent, i| n2(sent)[1][i] -= 1.61)),
    ];
    for (criterion, segmentation) in cases {
        assert_eq!(failing(&segmentation, criterion), [4, 5], "{criterion}");
        assert_eq!(rows(&segmentation), [all(0..4), all(6..10)], "{criterion}");
        let cost = segmentation.tally.cost(criterion);
        assert_eq!((cost.unsteady, cost.unsteady_alone), (2, 2));
    }
    // A step of 21 ft. Vertical speed is 21 ft/min at sample 4 alone: within 100 ft/min of its neighbors.
    let segmentation = step(|sent, i| sent.pressure_altitude_m[i] += 21.0 * METERS_PER_FOOT);
    assert_eq!(failing(&segmentation, Criterion::PressureAltitude), [4, 5]);
}

#[test]
fn one_engine_s_jump_is_enough_and_engines_are_not_mixed() {
    // Engines 5 % apart, each constant: steady.
    let mut sent = steady(60.0, 10);
    n2(&mut sent)[1] = vec![84.4; 10];
    assert_eq!(rows(&segmented(sent).1), [all(0..10)]);
    // Opposite jumps whose mean is constant: rejected.
    let opposite = step(|sent, i| {
        n2(sent)[0][i] += 1.7;
        n2(sent)[1][i] -= 1.7;
    });
    assert_eq!(failing(&opposite, Criterion::N2), [4, 5]);
}

#[test]
fn a_climb_fails_altitude_and_vertical_speed() {
    // 200 ft in the step after sample 4: 200 ft/min at sample 4, 0 around it.
    let segmentation = step(|sent, i| sent.pressure_altitude_m[i] += 200.0 * METERS_PER_FOOT);
    let set = |names: &[Criterion]| names.iter().copied().collect::<CriterionSet>();
    let (altitude, speed) = (Criterion::PressureAltitude, Criterion::VerticalSpeed);
    assert_eq!(segmentation.verdicts[3], SampleVerdict::Unsteady(set(&[speed])));
    assert_eq!(segmentation.verdicts[4], SampleVerdict::Unsteady(set(&[altitude, speed])));
    assert_eq!(segmentation.verdicts[5], SampleVerdict::Unsteady(set(&[altitude, speed])));
    assert_eq!(segmentation.tally.cost(altitude).unsteady, 2);
    assert_eq!(segmentation.tally.cost(altitude).unsteady_alone, 0);
    assert_eq!(segmentation.tally.cost(speed).unsteady, 3);
    assert_eq!(segmentation.tally.cost(speed).unsteady_alone, 1);
    assert_eq!(rows(&segmentation), [all(0..3), all(6..10)]);
}

#[test]
fn limits_are_inclusive_to_a_billionth_of_their_unit() {
    // Each change exactly on its limit but for binary rounding, then 2e-9 of its unit beyond.
    type Change = fn(&mut ReportColumns, usize, f64);
    let changes: [(Criterion, f64, Change); 5] = [
        (Criterion::PressureAltitude, 20.0, |sent, i, ft| {
            sent.pressure_altitude_m[i] = (43_000.0 + ft) * METERS_PER_FOOT;
        }),
        (Criterion::Mach, 0.003, |sent, i, mach| sent.mach[i] = 0.8025 + mach),
        (Criterion::GroundSpeed, 1.0, |sent, i, kt| {
            sent.ground_speed_m_s[i] = (451.5 + kt) * METERS_PER_SECOND_PER_KNOT;
        }),
        (Criterion::StaticAirTemperature, 1.0, |sent, i, kelvin| {
            sent.static_air_temperature_k.as_mut().unwrap()[i] = -56.5 + 273.15 + kelvin;
        }),
        (Criterion::N2, 1.6, |sent, i, percent| n2(sent)[1][i] = 89.4 + percent),
    ];
    for (criterion, limit, change) in changes {
        let on = step(|sent, i| change(sent, i, limit));
        assert_eq!(failing(&on, criterion), [] as [usize; 0], "{criterion}");
        let within = step(|sent, i| change(sent, i, limit + 0.5e-9));
        assert_eq!(failing(&within, criterion), [] as [usize; 0], "{criterion}");
        let beyond = step(|sent, i| change(sent, i, limit + 2e-9));
        assert_eq!(failing(&beyond, criterion), [4, 5], "{criterion}");
    }
}

#[test]
fn vertical_speed_on_its_limit() {
    // At one minute a step of 100 ft is a change of 100 ft/min, which ALT would reject: it is switched off.
    // The step after sample 4 gives sample 4 the rate, and 3, 4 and 5 the change.
    let mut criteria = segmenter::TrimCriteria::ghazi_2020_table_4();
    criteria.pressure_altitude_ft = f64::INFINITY;
    for (climb_ft, failing_samples) in [(100.0, 0), (100.0 + 1e-6, 3)] {
        let mut sent = steady(60.0, 10);
        for sample in 5..10 {
            sent.pressure_altitude_m[sample] += climb_ft * METERS_PER_FOOT;
        }
        let report = flight::Report::new(header(), sent).unwrap();
        let segmentation = segmenter::segment(&track::derive(report).unwrap(), &criteria);
        let cost = segmentation.tally.cost(Criterion::VerticalSpeed);
        assert_eq!(cost.unsteady, failing_samples, "{climb_ft}");
    }
}

#[test]
fn drift_and_roll_are_limited_in_size() {
    for (drift_deg, roll_deg, steady_samples) in [
        (5.0, 0.8, 10),
        (-5.0, -0.8, 10),
        (5.0 + 0.5e-9, 0.8 + 0.5e-9, 10),
        (5.1, 0.8, 9),
        (-5.0 - 2e-9, 0.0, 9),
        (0.0, 0.9, 9),
        (0.0, -0.8 - 2e-9, 9),
    ] {
        let mut sent = steady(60.0, 10);
        sent.drift_deg.as_mut().unwrap()[0] = drift_deg;
        sent.roll_deg.as_mut().unwrap()[0] = roll_deg;
        let tally = segmented(sent).1.tally;
        assert_eq!(
            tally.samples - tally.samples_unsteady,
            steady_samples,
            "{drift_deg} {roll_deg}"
        );
    }
}

#[test]
fn the_ends_of_a_run_compare_with_two_neighbors() {
    // A slow drift of 0.6 kt a sample passes in the middle but not at the ends: 1.2 kt to the second neighbor.
    let mut sent = steady(60.0, 8);
    for (sample, speed) in sent.ground_speed_m_s.iter_mut().enumerate() {
        *speed += 0.6 * METERS_PER_SECOND_PER_KNOT * sample as f64;
    }
    let (_, segmentation) = segmented(sent);
    assert_eq!(failing(&segmentation, Criterion::GroundSpeed), [0, 7]);
    assert_eq!(rows(&segmentation), [all(1..7)]);
}

#[test]
fn neighbors_do_not_reach_across_a_time_gap() {
    // Six samples, 10 min of silence and 3 kt more, six samples: no sample is rejected, the segment ends at the gap.
    let mut sent = steady(60.0, 12);
    for sample in 6..12 {
        sent.time_s[sample] += 600.0;
        sent.ground_speed_m_s[sample] += 3.0 * METERS_PER_SECOND_PER_KNOT;
    }
    let (track, segmentation) = segmented(sent);
    assert_eq!(track.runs().len(), 2);
    assert_eq!(segmentation.tally.samples_unsteady, 0);
    assert_eq!(rows(&segmentation), [all(0..6), all(6..12)]);
    // The jump of ground speed across the gap enters no rate.
    for segment in &segmentation.segments {
        assert!(segment.means.acceleration_m_s2.abs() < 1e-15);
    }
}

#[test]
fn samples_of_short_runs_are_not_judged() {
    // Gaps after samples 4 and 6: two samples between.
    let mut sent = steady(60.0, 12);
    for sample in 5..12 {
        sent.time_s[sample] += if sample < 7 { 100.0 } else { 200.0 };
    }
    let (_, segmentation) = segmented(sent);
    assert_eq!(rows(&segmentation), [all(0..5), all(7..12)]);
    assert_eq!(segmentation.verdicts[5..7], [SampleVerdict::NotJudged; 2]);
    assert_eq!(segmentation.dropped_runs.len(), 1);
    assert_eq!(segmentation.tally.samples_not_judged, 2);
    assert_eq!(segmentation.tally.samples_judged(), 10);
    assert!(segmentation.tally.to_string().ends_with("; 2 not judged (1 run too short)"));
}
