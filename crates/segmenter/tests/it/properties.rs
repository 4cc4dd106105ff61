//! Properties of every flight.

use flight::{Report, ReportColumns};
use proptest::prelude::*;
use segmenter::{SampleVerdict, Segmentation};
use test_support::reports::{header, steady};
use units::convert::{METERS_PER_FOOT, METERS_PER_SECOND_PER_KNOT};

use crate::support::segmented;

/// A cruise whose channels wander around their limits, at regular minutes but for some gaps.
fn restless() -> impl Strategy<Value = ReportColumns> {
    let sample = (-10..=10_i32, -10..=10_i32, -10..=10_i32, -10..=10_i32, -9..=9_i32, 0..10_u32);
    prop::collection::vec(sample, 3..150).prop_map(|samples| {
        let mut columns = steady(60.0, samples.len());
        let mut time_s = 0.0;
        let mut mach = 0.80;
        for (i, (altitude, step, speed, temperature, roll, gap)) in samples.into_iter().enumerate()
        {
            columns.time_s[i] = time_s;
            // At most every fourth step, so that the median stays one minute.
            time_s += if gap == 0 && i % 4 == 3 { 300.0 } else { 60.0 };
            mach = (mach + 3e-4 * f64::from(step)).clamp(0.5, 0.9);
            columns.mach[i] = mach;
            columns.pressure_altitude_m[i] += f64::from(altitude) * METERS_PER_FOOT;
            columns.ground_speed_m_s[i] += 0.06 * f64::from(speed) * METERS_PER_SECOND_PER_KNOT;
            columns.static_air_temperature_k.as_mut().unwrap()[i] += 0.05 * f64::from(temperature);
            columns.roll_deg.as_mut().unwrap()[i] = 0.1 * f64::from(roll);
        }
        columns
    })
}

fn in_verdicts(segmentation: &Segmentation, segment: usize) -> Vec<u32> {
    (0_u32..)
        .zip(&segmentation.verdicts)
        .filter(|(_, verdict)| **verdict == SampleVerdict::Kept { segment })
        .map(|(row, _)| row)
        .collect()
}

proptest! {
    #[test]
    fn verdicts_add_up(columns in restless()) {
        let (track, segmentation) = segmented(columns);
        let tally = segmentation.tally;
        prop_assert_eq!(tally.samples, track.report().len());
        prop_assert_eq!(
            tally.samples_judged(),
            tally.samples_unsteady + tally.samples_outlying + tally.samples_in_dropped_pieces
                + tally.samples_kept
        );
        prop_assert_eq!(
            tally.samples_judged(),
            track.runs().iter().map(|run| run.samples.len()).sum::<usize>()
        );
        prop_assert_eq!(tally.segments, segmentation.segments.len());
        for (index, segment) in segmentation.segments.iter().enumerate() {
            prop_assert!((3..=10).contains(&segment.samples()));
            prop_assert_eq!(&segment.rows, &in_verdicts(&segmentation, index));
        }
        prop_assert_eq!(
            segmentation.dropped_pieces.len(),
            tally.pieces_of_one_sample + tally.pieces_too_short
        );
    }

    #[test]
    fn shifting_time_changes_times_only(columns in restless(), shift in -100_000_i32..100_000) {
        let shift_s = f64::from(shift);
        let mut shifted = columns.clone();
        for time_s in &mut shifted.time_s {
            *time_s += shift_s;
        }
        let (_, here) = segmented(columns);
        let (_, there) = segmented(shifted);
        prop_assert_eq!(&here.verdicts, &there.verdicts);
        for (here, mut there) in here.segments.into_iter().zip(there.segments) {
            prop_assert!((here.means.time_s + shift_s - there.means.time_s).abs() < 1e-9);
            // At multiples of 1 s every other mean is the same to the last bit.
            there.means.time_s = here.means.time_s;
            let close = here.means.acceleration_m_s2 - there.means.acceleration_m_s2;
            prop_assert!(close.abs() < 1e-15);
            there.means.acceleration_m_s2 = here.means.acceleration_m_s2;
            let close = here.means.vertical_speed_m_s - there.means.vertical_speed_m_s;
            prop_assert!(close.abs() < 1e-13);
            there.means.vertical_speed_m_s = here.means.vertical_speed_m_s;
            prop_assert_eq!(here, there);
        }
    }

    #[test]
    fn engines_may_change_places(columns in restless(), jumps in prop::collection::vec(-10..=10_i32, 150)) {
        let mut columns = columns;
        let engines = columns.n2_percent.as_mut().unwrap();
        for (n2_percent, jump) in engines[1].iter_mut().zip(jumps) {
            *n2_percent += 0.12 * f64::from(jump);
        }
        let mut swapped = columns.clone();
        swapped.n2_percent.as_mut().unwrap().reverse();
        let (_, here) = segmented(columns);
        let (_, there) = segmented(swapped);
        prop_assert_eq!(here.verdicts, there.verdicts);
        prop_assert_eq!(here.tally, there.tally);
    }

    #[test]
    fn same_report_same_segments(columns in restless()) {
        let report = Report::new(header(), columns.clone()).unwrap();
        prop_assert_eq!(report.columns(), &columns);
        prop_assert_eq!(segmented(columns.clone()).1, segmented(columns).1);
    }
}
